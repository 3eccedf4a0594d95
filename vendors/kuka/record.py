"""Program → KRL files that drive it and log the axes with time.

The submit interpreter, which runs beside the robot program, takes samples into arrays; when the
motion has ended, the robot program writes them to a file of comma-separated values, ``t`` in s and
``q1 …`` in rad (m for linear axes), as the package reads logs.

KUKA, "CREAD/CWRITE, Programming CREAD/CWRITE and Related Statements for KSS 8.2": ``SWRITE``,
``CWRITE($FCT_CALL, …, "krl_fopen" | "krl_fwriteln" | "krl_fclose", …)``.
"""

from __future__ import annotations

import math

from ...core.errors import InputError
from ...core.program.program import Program
from ...core.robot.joint import JointKind
from ...core.robot.model import Robot
from ...core.source.write.options import OpaqueStyle
from .write.numbers import number
from .write.options import KrlOptions
from .write.writer import HEADER, TextAround, compose, source_text

SHORTEST_PERIOD = 0.012
"""s. The controller's interpolation cycle; the submit interpreter comes round no sooner."""
LOGGER = "FLYBY_LOG"
SAMPLER = "FLYBY_REC"
LOG = "flyby_log.csv"
CAPACITY = 5000
"""Samples that the arrays hold: a minute at the shortest period."""
_TIMER = 16


def record(program: Program, robot: Robot, period: float) -> dict[str, str]:
    """The program's own two files, a logger with its data list, and the submit program.

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
        header=_instructions(period),
        before=(f"{LOGGER}(#FB_BEGIN)",),
        after=("WAIT SEC 0.5", f"{LOGGER}(#FB_END)"),
    )
    return {
        **compose(program, robot, KrlOptions(opaque=OpaqueStyle.COMMENT), around),
        f"{LOGGER.lower()}.src": _logger(robot),
        f"{LOGGER.lower()}.dat": _data(),
        f"{SAMPLER.lower()}.sub": source_text(f"{SAMPLER}( )", _sampler(period)),
    }


def _instructions(period: float) -> tuple[str, ...]:
    return (
        f"; Drives and logs the axes every {number(period)} s.",
        f"; 1. Copy all files to KRC:\\R1\\Program; {SAMPLER.lower()}.sub to KRC:\\R1\\System.",
        f"; 2. Start {SAMPLER.lower()}.sub in the submit interpreter, then this program, in the",
        ";    mode and with the override ($OV_PRO) that are to be measured.",
        f"; 3. Fetch C:\\KRC\\ROBOTER\\UserFiles\\{LOG}.",
        f"; Longer than {number(CAPACITY * period)} s: enlarge FB_MAX, FB_T and FB_Q in the data",
        f"; list {LOGGER.lower()}.dat. For exact 12 ms use the trace function of the controller.",
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
        f'CWRITE($FCT_CALL,STAT,MODE,"krl_fopen","{LOG}","w",HANDLE)',
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
        f"FB_Q[I].E{k}*{'0.001' if axis.joint.kind is linear else _RAD}"
        for k, axis in enumerate(robot.external_axes, 1)
    ]


_RAD = f"{math.radians(1):.10f}"
