"""What an author writes down so that a planted fault shows, by the fault's name."""

from __future__ import annotations

from collections.abc import Mapping

_EVENT = "a motion with an action on its way, and its row's events = [{ sets = …, to = …, "
_RECORDED = (
    "a text with recorded = { period_ms = …, lines = […] }: what begins the log, "
    "states its period and ends it"
)
_SHARED = "two motions that read one datum (a point with a name or number, a speed in a register)"
_SHEET = "[[robots]] of a robot, from its data sheet: "
_SAYS = "a golden text that says it, in a text that the dialect then refuses: "
_CHECKED = "nothing in the golden file; the check draws programs of what the dialect says: "
_DRAWN = (
    _CHECKED
    + "leave `zones`, `speeds` and their like of the suite's class to the dialect, and let "
    "the writer refuse what it has no words for (`check_said` does)"
)

BITING: Mapping[str, str] = {
    "events dropped on reading": _EVENT + "time_s = … }] stated",
    "events dropped on writing": _EVENT + "time_s = … }] stated; the text names its robot",
    "events counted from the other end": _EVENT + 'anchor = "start" or "end" }] stated',
    "events without their place": _EVENT + "time_s or distance_mm = … }] that is not 0",
    "what is to be refused is passed over": "a text in [[refused]]: an option of a motion that is "
    "not known, a position of a kind that is not read",
    "recordings log nothing": _RECORDED,
    "recordings log at another period": _RECORDED,
    "kept statements lost on reading": 'an output that is set, as a row kind = "Opaque"',
    "kept statements doubled on reading": 'an output that is set, as a row kind = "Opaque"',
    "kept statements lost on writing": 'an output that is set, as a row kind = "Opaque", in a text '
    "that names its robot",
    "comments lost": "a kept statement (an output, a print) in a text that names its robot",
    "waits dropped on reading": 'a wait for a time, as a row kind = "Wait" with duration_s',
    "waits dropped on writing": "a wait for a time, in a text that names its robot",
    "order of statements changed on reading": "a last and a last but one statement that differ",
    "order of statements changed on writing": "a last and a last but one statement that differ, in "
    "a text that names its robot",
    "start position lost by the writer": _CHECKED + "the writer drops the first joint move",
    "increments subtracted": "a motion that goes on from the position before by numbers of its own "
    "(an increment, an offset), its place stated as position_mm",
    "auxiliary point of arcs swapped with the end": "an arc with via.position_mm and position_mm",
    "arcs turn the tool otherwise": "an arc with arc = … stated (fixed_frame or follows_arc)",
    "configuration lost on reading": "a pose with its configuration = … stated",
    "accelerations ignored on reading": "a motion under an acceleration that is not the usual one, "
    "its row's speed = { …acceleration… } stated",
    "accelerations ignored on writing": _DRAWN,
    "zones lost on reading": "a motion that passes its point, with zone = { kind = …, … } stated",
    "kinds of zone lost": "a zone of each kind that the dialect has, kind = … stated",
    "tools ignored on reading": 'a motion with a tool, tool = "…" stated',
    "tools ignored on writing": _DRAWN,
    "tools hold one move too late": "two motions, one behind the other, with different tools",
    "speeds hold one move too late": "two motions, one behind the other, with different speeds, "
    "both stated",
    "frames ignored on reading": 'a motion in a frame, frame = "…" stated',
    "frames ignored on writing": _DRAWN,
    "frames of joint values ignored on reading": _CHECKED + "a frame does not change where such a "
    "move ends, but the program says it, and has to come back",
    "loads ignored on reading": 'a motion with a load, load = "…" stated',
    "zones 100 times as large": "a zone with its size stated: size_percent, size_mm or tcp_mm",
    "zones as diameters": "a zone with its size stated, and room for half of it",
    "zones a little larger": "a zone with its size stated, below the largest that there is: at the "
    "largest nothing can grow",
    "speeds of the TCP in mm/s": "a line with speed = { tcp_mm_s = … } stated",
    "speeds of turning in degrees/s": "a motion with a speed of turning stated: "
    "speed = { reorientation_deg_s = … }",
    "shares of speed halved": "a joint move with speed = { joint_fraction_percent = … } stated",
    "joints in degrees": "a motion to joint values, joints_deg stated and not all 0",
    "joints in another order": "a motion to joint values, joints_deg stated and not the same from "
    "both ends",
    "positions in mm": "a motion to a pose, position_mm stated",
    "orientations transposed": "a pose whose quaternion is stated and no half turn: turned by 90° "
    "about z, say; half turns are their own inverses",
    "quaternions with the scalar last": "a pose whose quaternion is stated, its w and x not alike",
    "tools inverted": "a tool that is its own inverse in nothing: with position_mm that is not 0",
    "waits in ms": 'a wait for a time, as a row kind = "Wait" with duration_s',
    "targets rounded too coarsely on writing": "a target with tenths of mm or of degrees, in a "
    "text that names its robot",
    "all speeds said to have words": _DRAWN,
    "a kind of zone said to have words": _DRAWN,
    "zones said to have no words": _SAYS + "a motion with a zone",
    "speeds said to have no words": _SAYS + "a motion whose speed need not be stated, stated",
    "frames said to have words": _DRAWN,
    "frames said to have no words": _SAYS + "a motion in a frame",
    "user frames said to have words": _DRAWN,
    "parts of zones said to have words": _DRAWN,
    "parts of zones said to have no words": _SAYS + "a zone wider for the tool's turn than for the "
    "TCP (reorientation_mm)",
    "stationary tools said to have words": _DRAWN,
    "no speed said to be needed": _CHECKED + "MoveWords.needs are those that the language asks for",
    "lengths said in another unit": _SAYS + "a pose and a zone with numbers that mean something in "
    "one unit only: 482.4 mm, no 0",
    "rotations said in another form": _SAYS + "a pose turned about more than one axis",
    "configurations said to have no words": _SAYS + "a pose with a configuration",
    "greatest speed too low": _SAYS + "a line faster than 10 mm/s",
    "another sign for comments": "a comment of the language's own on a line of its own",
    "outputs on the way switched the other way": _CHECKED + "`OutputWords.switch` and the "
    "`SignalWords` understand each other",
    "signals said the other way": _CHECKED + "`SignalWords.read` understands what `said` says",
    "signals understood and said the other way": "an output that is set and a signal waited for, "
    "with sets, to, waits and on stated",
    "motions count as comments": "a motion whose point is used in code that is not driven, too "
    '(a branch not taken), with not_driven = ["target"]',
    "comments count as text": "a comment on a line of its own that reads like a motion to a point "
    "that there is",
    "declarations are not found": "a motion to a declared point whose reader gives it the name",
    "names are cut": "a motion to a point whose name has three signs or more",
    "patch of another literal": "a motion that alone reads its point, with a number before it in "
    "the file",
    "patch rounded too coarsely": "a motion that alone reads its point",
    "patch of data that other moves use": _SHARED,
    "comments lost by the patcher": "a comment on a line of its own, in a text that names "
    "its robot",
    "line ends changed by the patcher": "a motion that alone reads its point, in a text of several "
    "lines that names its robot",
    "shared data taken for owned": _SHARED,
    "reads not recorded": _SHARED,
    "numbers recorded at another place": "two motions to different points",
    "joints faster than they are": _SHEET + "velocity_deg_s",
    "ranges of joints wider": _SHEET + "lower_deg and upper_deg",
    "an arm 10 mm longer": _SHEET + "poses = [{ joints_deg = …, position_mm = … }]",
    "a joint counts the other way": _SHEET + "a pose at which the second joint is not at zero",
    "a joint of the wrist counts the other way": _SHEET + "a pose with its quaternion at which the "
    "fourth joint is not at zero",
    "the last joint counts the other way": _SHEET + "a pose with its quaternion at which the sixth "
    "joint is not at zero",
    "a flange turned by half a turn": _SHEET + "a pose with its quaternion",
    "labels of another posture": "a pose with a configuration and stands_deg, in a text that names "
    "its robot",
    "provenance of a figure missing": "nothing: every figure of the motion model has a row of "
    "[provenance]",
}
