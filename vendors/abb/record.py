"""Program → RAPID modules that drive it and log the joints with time.

Two ways, by the period asked for:

- from 0.1 s on: an interrupt (``ITimer``, whose least time is 0.1 s) samples in the program's own
  task; one module.
- from 4 ms on: a second task samples beside the program (option Multitasking). Two modules; one
  tells the other by persistent data of one name when to begin and to end.

Shorter periods are Externally Guided Motion's, which streams from the controller and is no RAPID.

The log is CSV, ``t`` in s and ``q1 …`` in rad (m for linear axes), as the package reads logs.

"RAPID Reference Manual": ITimer, CONNECT, CJointT, ClkRead, NumToStr, Open, Write. A string has at
most 80 characters, so that a line is written in pieces.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace

from ...core.errors import InputError
from ...core.program.program import Program
from ...core.source.text.names import Names
from ...core.source.write.options import OpaqueStyle
from .write.formatting import NAME_RULES
from .write.numbers import number
from .write.operands import ARM_AXES
from .write.options import RapidOptions
from .write.writer import ENTRY, SUFFIX, TextAround, module_name, write

SHORTEST_INTERRUPT = 0.1
"""s. ``ITimer`` takes no shorter time."""
SHORTEST_PERIOD = 0.004
"""s. The controllers' own cycle; a waiting task comes back no sooner."""

LOG = "flyby_log.csv"
LOGGER = "FlybyLogger"
TASK = "T_FLYBY"
_PIECE = 3
_STEP = "  "
_OWN_NAMES = (
    *("fbFile", "fbClock", "fbTimer", "fbSample", "fbOpen", "fbClose", "fbLine", "fbRun"),
    *("fbReady", "fbNext"),
)


def record(program: Program, options: RapidOptions, period: float) -> Mapping[str, str]:
    """Modules by file name.

    Statements that were kept as text become comments: their signals and data need not exist where
    the recording is made. Where the robot comes to rest for them, it still does.

    Args:
        period: s between samples.

    Raises:
        InputError: the period is too short for RAPID.
        MotionError: RAPID cannot say a move.
    """
    if not SHORTEST_PERIOD <= period < float("inf"):
        raise InputError(
            f"RAPID cannot sample every {period:g} s: ask for {number(SHORTEST_PERIOD)} s or more, "
            "or log by Externally Guided Motion (EGM), which streams the joints every 4 ms"
        )
    options = replace(options, opaque=OpaqueStyle.COMMENT)
    by = _by_interrupt if period >= SHORTEST_INTERRUPT else _by_task
    return by(program, options, number(period))


def _by_interrupt(program: Program, options: RapidOptions, period: str) -> Mapping[str, str]:
    sampling = TextAround(
        header=(
            *_header(options),
            f"! Every {period} s an interrupt of this task writes a line; while an instruction",
            "! holds the task up, it comes late, which the time in the line shows. Shorter than",
            f"! {number(SHORTEST_INTERRUPT)} s: record with a second task; every 4 ms and exact: "
            "EGM.",
        ),
        data=(*_FILE_DATA, "VAR intnum fbTimer;"),
        before=("fbOpen;", "CONNECT fbTimer WITH fbSample;", f"ITimer {period},fbTimer;"),
        after=("WaitRob \\InPos;", "IDelete fbTimer;", "Close fbFile;"),
        routines=(
            *_open_routine(options),
            *_line_routine(options),
            *("", "TRAP fbSample", _STEP + "fbLine CJointT();", "ENDTRAP"),
        ),
        names=_OWN_NAMES,
    )
    return {module_name(program) + SUFFIX: write(program, options, sampling)}


def _by_task(program: Program, options: RapidOptions, period: str) -> Mapping[str, str]:
    module = module_name(program)
    logger = Names(NAME_RULES, [module, ENTRY]).claim(LOGGER, LOGGER)
    driving = TextAround(
        header=(
            *_header(options),
            f"! {logger}{SUFFIX} writes the log, in a task of its own: configure (Controller /",
            f"! Task) {TASK}, type SEMISTATIC, main entry {ENTRY}, and load it there (option",
            "! Multitasking), then restart. Every 4 ms and exact: EGM.",
        ),
        data=_SHARED_DATA,
        before=("fbRun:=TRUE;", "WaitUntil fbReady;"),
        after=("WaitRob \\InPos;", "fbRun:=FALSE;", "WaitUntil NOT fbReady;"),
        names=_OWN_NAMES,
    )
    return {
        module + SUFFIX: write(program, options, driving),
        logger + SUFFIX: _logger(logger, module, options, period),
    }


_SHARED_DATA = ("PERS bool fbRun:=FALSE;", "PERS bool fbReady:=FALSE;")
_FILE_DATA = ("VAR iodev fbFile;", "VAR clock fbClock;")


def _header(options: RapidOptions) -> list[str]:
    columns = f"t,{','.join(_columns(options))}"
    return [
        f"! Drives the program and logs it to HOME:/{LOG}, columns {columns}:",
        "! t in s, q in rad (m for linear axes); hand the file to the identification as it is.",
        "! Load into the robot's task (T_ROB1) in place of other modules with a PROC main;",
        "! automatic mode, speed 100 %. Statements that do not move the robot are comments here.",
    ]


def _logger(logger: str, module: str, options: RapidOptions, period: str) -> str:
    """The module of the second task: a line every ``period`` s while ``fbRun`` holds."""
    loop = [
        "fbRun:=FALSE;",
        "WHILE TRUE DO",
        "  WaitUntil fbRun;",
        "  fbOpen;",
        "  fbNext:=0;",
        "  fbReady:=TRUE;",
        "  WHILE fbRun DO",
        '    fbLine CJointT(\\TaskName:="T_ROB1");',
        f"    fbNext:=fbNext+{period};",
        "    IF fbNext<ClkRead(fbClock) THEN",
        f"      fbNext:=ClkRead(fbClock)+{number(SHORTEST_PERIOD)};",
        "    ENDIF",
        "    WaitTime fbNext-ClkRead(fbClock);",
        "  ENDWHILE",
        "  Close fbFile;",
        "  fbReady:=FALSE;",
        "ENDWHILE",
    ]
    lines = [
        f"! Written by flyby. Logs every {period} s while {module}{SUFFIX} runs in T_ROB1;",
        f"! belongs into task {TASK}, type SEMISTATIC, main entry {ENTRY} (option Multitasking).",
        *_SHARED_DATA,
        *_FILE_DATA,
        "VAR num fbNext:=0;",
        "",
        *_routine(f"PROC {ENTRY}()", loop),
        *_open_routine(options),
        *_line_routine(options),
    ]
    return "\n".join([f"MODULE {logger}", *_indented(lines), "ENDMODULE", ""])


def _open_routine(options: RapidOptions) -> list[str]:
    """A new log with its head, and the clock at zero."""
    pieces = ["," + ",".join(piece) for piece in _pieces(_columns(options))]
    body = [
        f'Open "HOME:"\\File:="{LOG}",fbFile\\Write;',
        *(f'Write fbFile,"{piece}"\\NoNewLine;' for piece in ["t", *pieces]),
        'Write fbFile,"";',
        "ClkReset fbClock;",
        "ClkStart fbClock;",
    ]
    return ["", *_routine("PROC fbOpen()", body)]


def _line_routine(options: RapidOptions) -> list[str]:
    """One line of the log."""
    values = [f"NumToStr(at.robax.rax_{n}*pi/180,6)" for n in range(1, ARM_AXES + 1)]
    for axis, kind in zip("abcdef", options.external_axes, strict=False):
        unit = "/1000" if kind == "linear" else "*pi/180"
        values.append(f"NumToStr(at.extax.eax_{axis}{unit},6)")
    pieces = ['","+' + '+","+'.join(piece) for piece in _pieces(values)]
    body = [
        "Write fbFile,NumToStr(ClkRead(fbClock),3)\\NoNewLine;",
        *(f"Write fbFile,{piece}\\NoNewLine;" for piece in pieces),
        'Write fbFile,"";',
    ]
    return ["", *_routine("PROC fbLine(jointtarget at)", body)]


def _columns(options: RapidOptions) -> list[str]:
    return [f"q{n}" for n in range(1, ARM_AXES + len(options.external_axes) + 1)]


def _pieces(values: Sequence[str]) -> list[Sequence[str]]:
    return [values[at : at + _PIECE] for at in range(0, len(values), _PIECE)]


def _routine(head: str, body: Sequence[str]) -> list[str]:
    return [head, *_indented(body), f"END{head.split()[0]}"]


def _indented(lines: Sequence[str]) -> list[str]:
    return [_STEP + line if line else line for line in lines]
