"""Programs → KRL files that drive them and log the axes with time.

The submit interpreter, which runs beside the robot program, takes samples into arrays; when the
motion has ended, the robot program writes them to a file of comma-separated values, ``t`` in s and
``q1 …`` in rad (m for linear axes), as the package reads logs.

Several runs are routines of one file. Its program drives them from the one that ``FB_RUN`` says,
which a data list keeps; before one that the robot is jogged to it ends, so that the next start goes
on there.

KUKA, "CREAD/CWRITE, Programming CREAD/CWRITE and Related Statements for KSS 8.2": ``SWRITE``,
``CWRITE($FCT_CALL, …, "krl_fopen" | "krl_fwriteln" | "krl_fclose", …)``.
"""

from __future__ import annotations

import math

from ...core.errors import InputError
from ...core.recording import Recording, comments, listed
from ...core.robot.joint import JointKind
from ...core.robot.model import Robot
from ...core.source.write.options import OpaqueStyle, StructureStyle
from .values.types import external_fields
from .write.numbers import number
from .write.options import KrlOptions
from .write.writer import HEADER, TextAround, compose, module_name, source_text

SHORTEST_PERIOD = 0.012
"""s. The controller's interpolation cycle; the submit interpreter comes round no sooner."""
LOGGER = "FLYBY_LOG"
SAMPLER = "FLYBY_REC"
CAPACITY = 5000
"""Samples that the arrays hold: a minute at the shortest period."""
_TIMER = 16


def record(recording: Recording, robot: Robot, period: float) -> dict[str, str]:
    """The two files of the program, a logger with its data list, and the submit program.

    Statements that were kept as text become comments: their signals and data need not exist where
    the recording is made.

    Args:
        robot: whose axes are logged.
        period: s between samples; the submit interpreter may be late, which the times show.

    Raises:
        InputError: the period is too short for KRL.
        MotionError: KRL cannot say a move.
    """
    if not SHORTEST_PERIOD <= period < math.inf:
        raise InputError(
            f"KRL cannot sample every {period:g} s: ask for {number(SHORTEST_PERIOD)} s or more; "
            "the robot sensor interface (RSI) streams the axes every 4 ms"
        )
    around = TextAround(
        header=_instructions(recording, period),
        main=lambda lines: _main(recording, lines),
    )
    structure = StructureStyle.FLAT if recording.alone else StructureStyle.KEEP
    options = KrlOptions(opaque=OpaqueStyle.COMMENT, structure=structure)
    return {
        **compose(recording.program, robot, options, around),
        f"{LOGGER.lower()}.src": _logger(robot),
        f"{LOGGER.lower()}.dat": _data(),
        f"{SAMPLER.lower()}.sub": source_text(f"{SAMPLER}( )", _sampler(period)),
    }


def _main(recording: Recording, lines: list[str]) -> list[str]:
    """One run as it is, or those from ``FB_RUN`` on, up to one that the robot is jogged to.

    Args:
        lines: the statements of the one run, or the calls of all.
    """
    runs = recording.runs
    if recording.alone:
        return _logged(runs[0].log, lines)
    count = len(runs)
    made = [f"IF (FB_RUN<1) OR (FB_RUN>{count}) THEN", "FB_RUN=1", "ENDIF", "FB_STAYS=FALSE"]
    for index, (run, call) in enumerate(zip(runs, lines, strict=True), 1):
        stays = index == count or runs[index].by_hand
        made += [
            f"IF (FB_RUN=={index}) AND NOT FB_STAYS THEN",
            *_logged(run.log, [call]),
            f"FB_RUN={index % count + 1}",
            *(["FB_STAYS=TRUE"] if stays else []),
            "ENDIF",
        ]
    return made


def _logged(log: str, lines: list[str]) -> list[str]:
    begin = [f'FB_NAME[]="{log}"', f"{LOGGER}(#FB_BEGIN)"]
    return [*begin, *lines, "WAIT SEC 0.5", f"{LOGGER}(#FB_END)"]


def steps(recording: Recording, period: float) -> list[str]:
    """See `core.language.Recorder.steps`."""
    several, data = not recording.alone, f"{LOGGER.lower()}.dat"
    begins = f" It begins with the run that FB_RUN in {data} says, 1 at first." if several else ""
    made = [
        f"Copy all files to KRC:\\R1\\Program; {SAMPLER.lower()}.sub to KRC:\\R1\\System.",
        f"Start {SAMPLER.lower()}.sub in the submit interpreter, then "
        f"{module_name(recording.program)}, in the mode and with the override ($OV_PRO) that are "
        f"to be measured: automatic, 100 %.{begins}",
    ]
    if recording.jogged:
        made.append(
            f"Before {listed(recording.jogged)} it ends: jog to where the run begins, reset the "
            "program, start again; it goes on there. To begin elsewhere, set FB_RUN."
        )
    logs = "the log of each run" if several else recording.runs[0].log
    made.append(f"Fetch {logs} from C:\\KRC\\ROBOTER\\UserFiles.")
    return made


def _instructions(recording: Recording, period: float) -> list[str]:
    many = "a program" if recording.alone else f"{len(recording.runs)} runs"
    return comments(
        ";",
        [
            f"Drives {many} and logs the axes every {number(period)} s.",
            *steps(recording, period),
            f"A run longer than {number(CAPACITY * period)} s: enlarge FB_MAX, FB_T and FB_Q in "
            f"{LOGGER.lower()}.dat. For exact 12 ms use the trace function of the controller.",
        ],
    )


def _sampler(period: float) -> list[str]:
    """Beside the robot program: a sample as soon as the next one is due."""
    return [
        "; Submit program: samples while FB_ON is TRUE.",
        f"$TIMER_STOP[{_TIMER}]=FALSE",
        "LOOP",
        "IF FB_ON AND (FB_N<FB_MAX) THEN",
        f"IF $TIMER[{_TIMER}]>=FB_NEXT THEN",
        "FB_N=FB_N+1",
        f"FB_T[FB_N]=$TIMER[{_TIMER}]",
        "FB_Q[FB_N]=$AXIS_ACT_MEAS",
        f"FB_NEXT=FB_NEXT+{number(1000 * period)}",
        "ENDIF",
        "ENDIF",
        "ENDLOOP",
    ]


def _data() -> str:
    lines = [
        *HEADER,
        f"DEFDAT {LOGGER} PUBLIC",
        "GLOBAL ENUM FB_WHAT FB_BEGIN,FB_END",
        "DECL GLOBAL BOOL FB_ON=FALSE",
        "DECL GLOBAL CHAR FB_NAME[64]",
        "DECL GLOBAL INT FB_RUN=1",
        "DECL GLOBAL BOOL FB_STAYS=FALSE",
        "DECL GLOBAL INT FB_N=0",
        f"DECL GLOBAL INT FB_MAX={CAPACITY}",
        "DECL GLOBAL REAL FB_NEXT=0.0",
        f"DECL GLOBAL INT FB_T[{CAPACITY}]",
        f"DECL GLOBAL E6AXIS FB_Q[{CAPACITY}]",
        "ENDDAT",
    ]
    return "\n".join(lines) + "\n"


def _logger(robot: Robot) -> str:
    """Begins, and ends with the file; ``t`` counts from the first sample."""
    axes = _axes(robot)
    begin = [
        "FB_ON=FALSE",
        "FB_N=0",
        "FB_NEXT=0.0",
        f"$TIMER[{_TIMER}]=0",
        "FB_ON=TRUE",
        "WAIT SEC 0.5",
    ]
    rows = [
        "FOR I=1 TO FB_N",
        'LINE[]=" "',
        "OFFSET=0",
        'SWRITE(LINE[],STAT,OFFSET,"%1.3f",(FB_T[I]-FB_T[1])/1000.0)',
        *(f'SWRITE(LINE[],STAT,OFFSET,",%1.7f",{value})' for value in axes),
        'CWRITE($FCT_CALL,STAT,MODE,"krl_fwriteln",HANDLE,LINE[])',
        "ENDFOR",
    ]
    header = ",".join(["t", *(f"q{k}" for k in range(1, len(axes) + 1))])
    end = [
        "FB_ON=FALSE",
        "MODE=#SYNC",
        'CWRITE($FCT_CALL,STAT,MODE,"krl_fopen",FB_NAME[],"w",HANDLE)',
        f'CWRITE($FCT_CALL,STAT,MODE,"krl_fwriteln",HANDLE,"{header}")',
        *rows,
        'CWRITE($FCT_CALL,STAT,MODE,"krl_fclose",HANDLE)',
    ]
    body = [
        "DECL FB_WHAT WHAT",
        "DECL STATE_T STAT",
        "DECL MODUS_T MODE",
        "DECL INT HANDLE,OFFSET,I",
        "DECL CHAR LINE[256]",
        "; No advance run: what is said here holds when the robot is here.",
        "WAIT SEC 0.0",
        "IF WHAT==#FB_BEGIN THEN",
        *begin,
        "ELSE",
        *end,
        "ENDIF",
    ]
    return source_text(f"{LOGGER}(WHAT:IN)", body)


def _axes(robot: Robot) -> list[str]:
    """The axes of a sample in rad and m."""
    linear = JointKind.PRISMATIC
    arm = [
        f"FB_Q[I].A{k}*{'0.001' if joint.kind is linear else _RAD}"
        for k, joint in enumerate(robot.joints, 1)
    ]
    return arm + [
        f"FB_Q[I].{name.upper()}*{'0.001' if axis.joint.kind is linear else _RAD}"
        for name, axis in zip(external_fields(robot), robot.external_axes, strict=True)
    ]


_RAD = f"{math.radians(1):.10f}"
