"""Rules on the emulated motion."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from ..motion.emulator.binding_limits import limit_shares
from ..motion.emulator.move_figures import lengths_and_speeds, zone_reaches
from ..motion.geometry.corners import STOP
from ..motion.geometry.segments import JOINT_SEGMENT, LINE_SEGMENT
from ..motion.path.building import NEAR_SINGULAR
from ..program.move import MoveC, MoveJ
from ..program.zone import ROOM, Fine, Radius
from ..robot.joint import JointKind
from .finding import Hit, Rule, RunSubject, Severity
from .program_rules import has_no_size

_CUT = 0.01
"""Share by which a zone is smaller than programmed before that is reported."""
_STILL = 1e-6
"""m below which the TCP stays where it is."""
_FLIP = np.radians(120.0)
"""rad of a wrist axis between neighbouring points that makes a flip."""
_NEAR = 0.3
"""m between points within which a flip is a surprise."""
_NEAR_TURN = np.radians(60.0)
"""rad of the tool's turn, likewise."""
_REACHED = 0.95
"""Share of a programmed speed that counts as reached."""
_HELD = 0.1
"""Share of a move's time for which a joint's speed must hold it to be the reason."""
_MET = 1e-3
_MARGIN_ANGLE = np.radians(2.0)
_MARGIN_LENGTH = 5e-3
"""rad and m of a joint's range within which a path is near its end."""
_HALF_TURN = np.radians(179.9)
"""rad of turn from which on rounding decides the way round."""


def _zone_cut(subject: RunSubject) -> Iterator[Hit]:
    path = subject.run.path
    reaches = zone_reaches(path)
    for i, move in enumerate(path.route.zone_moves):
        zone = path.route.zones[i]
        if not isinstance(zone, Radius) or zone == ROOM or path.corners.kind[i] == STOP:
            continue
        reach = min(reaches[i])
        # Where the tool merely turns, the zone's angle counts and no distance. Of one that is made
        # smaller for its speed a note says so: a smaller radius would be made smaller likewise.
        made = i in path.corners.kept
        if not made and _STILL < reach < zone.tcp * (1 - _CUT):
            yield Hit(
                f"the zone of {1e3 * zone.tcp:.4g} mm reaches only {1e3 * reach:.4g} mm: it would "
                "overlap its neighbours",
                f"program at most {1e3 * reach:.4g} mm, or move the points apart",
                move,
                size=zone.tcp / reach,
            )


def _left_out(subject: RunSubject) -> Iterator[Hit]:
    for move in subject.run.path.route.left_out:
        yield Hit(
            "the controller leaves this waypoint out: its blend overlaps a neighbouring one",
            "make the blend radii smaller, so that both fit between the points",
            move,
        )


def _zone_stops(subject: RunSubject) -> Iterator[Hit]:
    """Stops at zones that no statement switches off: the controller has no corner there."""
    path = subject.run.path
    for i, move in enumerate(path.route.zone_moves):
        zone = path.route.zones[i]
        if path.corners.kind[i] == STOP and not isinstance(zone, Fine) and not has_no_size(zone):
            yield Hit(
                "the robot stops at this zone: the controller makes no corner between these moves, "
                "of which one only turns the tool",
                "program a stop point, or turn the tool along with the TCP's motion",
                move,
            )


def _zero_length(subject: RunSubject) -> Iterator[Hit]:
    route = subject.run.path.route
    driven = {*route.moves, *route.left_out}
    for i in range(1, len(subject.program.moves)):
        if i not in driven:
            yield Hit(
                "goes nowhere: the robot is at the target already",
                "remove the move, or correct its target",
                i,
            )


def _flips(subject: RunSubject) -> Iterator[Hit]:
    ends = subject.run.path.route.ends
    robot = subject.robot
    for k, move in enumerate(subject.run.path.route.moves):
        if ends.kind[k] != JOINT_SEGMENT or robot.arm_size < 6:
            continue
        way = float(np.linalg.norm(ends.position[k, 1] - ends.position[k, 0]))
        if way > _NEAR or _turn(ends.rotation[k]) > _NEAR_TURN:
            continue
        change = np.abs(ends.q[k, 1] - ends.q[k, 0])[: robot.arm_size]
        axis = robot.arm_size - 3 + int(np.argmax(change[-3:]))
        if change[axis] > _FLIP:
            yield Hit(
                f"turns {robot.axis_names[axis]} by {np.degrees(change[axis]):.0f}° between points "
                f"only {1e3 * way:.0f} mm and {np.degrees(_turn(ends.rotation[k])):.0f}° apart",
                "give both targets the same configuration",
                move,
                size=float(change[axis]),
            )


def _turn(rotation: np.ndarray) -> float:
    """rad between two rotations (2, 3, 3)."""
    trace = float(np.trace(rotation[0].T @ rotation[1]))
    return float(np.arccos(np.clip(0.5 * (trace - 1.0), -1.0, 1.0)))


def _half_turns(subject: RunSubject) -> Iterator[Hit]:
    ends = subject.run.path.route.ends
    for k, move in enumerate(subject.run.path.route.moves):
        if ends.kind[k] == LINE_SEGMENT and _turn(ends.rotation[k]) > _HALF_TURN:
            yield Hit(
                "turns the tool by half a turn on a line: rounding decides the way round",
                "put a target between",
                move,
            )


def _singular(subject: RunSubject) -> Iterator[Hit]:
    path = subject.run.path
    moves = path.sample_moves()
    for move in np.unique(moves[path.conditioning < NEAR_SINGULAR]):
        worst = float(path.conditioning[moves == move].min())
        yield Hit(
            f"passes near a singular configuration (conditioning {worst:.1e}): joints move fast, "
            "and small errors of the target change much",
            "go round it, turn the tool a little, or use a joint move",
            int(move),
            size=1.0 / max(worst, 1e-12),
        )


def _not_reached(subject: RunSubject) -> Iterator[Hit]:
    run, names = subject.run, subject.robot.axis_names
    _, tops = lengths_and_speeds(run)
    shares = limit_shares(run, names)
    velocities = {f"{name} velocity" for name in names}
    for k, i in enumerate(run.path.route.moves):
        move = subject.program.moves[i]
        speed = move.speed.tcp
        if isinstance(move, MoveJ) or speed is None or move.speed.duration is not None:
            continue
        held = [limit for limit in shares[k] if limit.name in velocities and limit.share > _HELD]
        if held and tops[k] < _REACHED * speed:
            yield Hit(
                f"{1e3 * speed:.4g} mm/s is programmed, the TCP reaches {1e3 * tops[k]:.4g} mm/s: "
                f"the {held[0].name} limit holds it for {held[0].share:.0%} of the move",
                f"program {1e3 * tops[k]:.3g} mm/s, or drive it in another posture",
                i,
                size=speed / max(float(tops[k]), 1e-9),
            )


def _time_not_met(subject: RunSubject) -> Iterator[Hit]:
    run = subject.run
    for k, spent in enumerate(run.timing.segment_durations()):
        i = run.path.route.moves[k]
        wanted = subject.program.moves[i].speed.duration
        if wanted is not None and spent > wanted * (1 + _MET):
            yield Hit(
                f"is to take {wanted:g} s, but the robot needs {spent:.3g} s",
                f"program at least {spent:.3g} s",
                i,
                size=float(spent) / wanted,
            )


def _straight_arcs(subject: RunSubject) -> Iterator[Hit]:
    route = subject.run.path.route
    for k, move in enumerate(route.moves):
        arc = isinstance(subject.program.moves[move], MoveC)
        if arc and route.ends.kind[k] == LINE_SEGMENT:
            yield Hit(
                "the three points of the arc lie on a line: it is driven as the line where the "
                "controller does not stop at it",
                "use a linear move, or move the auxiliary point",
                move,
            )


def _margin(subject: RunSubject) -> Iterator[Hit]:
    path, robot = subject.run.path, subject.robot
    joints = [*robot.joints, *(axis.joint for axis in robot.external_axes)]
    room = np.array(
        [_MARGIN_LENGTH if j.kind is JointKind.PRISMATIC else _MARGIN_ANGLE for j in joints]
    )
    room[[joint.held for joint in joints]] = -np.inf
    limits, moves = robot.limits, path.sample_moves()
    near = np.minimum(path.q - limits.lower, limits.upper - path.q)
    told: tuple[int, int] | None = None
    for row in np.flatnonzero((near < room).any(axis=1)):
        axis, move = int(np.argmax(room - near[row])), int(moves[row])
        # One stretch along a limit is one finding, at the move where it begins.
        if told is not None and told[0] == axis and move - told[1] <= 1:
            told = axis, move
            continue
        told = axis, move
        rows = near[moves == move, axis]
        yield Hit(
            f"{joints[axis].name} comes within {joints[axis].shown(float(rows.min()))} of the end "
            "of its range",
            "move the target, or choose another configuration",
            move,
        )


RUN_RULES = (
    Rule(
        "waypoint-left-out",
        Severity.ERROR,
        "waypoints that a controller leaves out because blends overlap",
        _left_out,
    ),
    Rule("zone-cut", Severity.WARNING, "zones that overlap, and so are cut short", _zone_cut),
    Rule(
        "zone-stops",
        Severity.WARNING,
        "zones at which the controller stops all the same",
        _zone_stops,
    ),
    Rule("zero-length", Severity.WARNING, "moves that go nowhere", _zero_length),
    Rule(
        "configuration-flip",
        Severity.WARNING,
        "joint moves between close points that turn a wrist axis by more than 120°",
        _flips,
    ),
    Rule("half-turn", Severity.WARNING, "lines that turn the tool by half a turn", _half_turns),
    Rule("straight-arc", Severity.WARNING, "arcs whose points lie on a line", _straight_arcs),
    Rule("singular", Severity.WARNING, "stretches near a singular configuration", _singular),
    Rule(
        "speed-not-reached",
        Severity.WARNING,
        "TCP speeds that a joint's speed limit keeps from being reached",
        _not_reached,
    ),
    Rule("time-not-met", Severity.WARNING, "programmed times that are too short", _time_not_met),
    Rule(
        "limit-near",
        Severity.INFO,
        "paths within 2° or 5 mm of the end of a joint's range",
        _margin,
    ),
)
