"""Programs → RAPID modules that drive them and log the joints with time.

Two ways, by the period asked for:

- from 10 ms on: an interrupt of the program's own task samples into arrays, which are written to a
  file when the run has ended; one module, no option of the controller.
- from 4 ms on: a second task samples beside the program (option Multitasking). Two modules; one
  tells the other by persistent data of one name when to begin and to end, and into which file.

Shorter periods are Externally Guided Motion's, which streams from the controller and is no RAPID.

Several runs are routines of one module. ``main`` drives them from the one that ``fbRun`` says,
which is persistent; before one that the robot is jogged to it ends (``EXIT``), so that the next
start goes on there.

A log is CSV, ``t`` in s and ``q1 …`` in rad (m for linear axes), as the package reads logs.

"RAPID Reference Manual": ITimer (``\\Single`` takes 10 ms at least, cyclic interrupts 0.1 s),
CONNECT, CJointT, ClkRead, NumToStr, Open, Write, EXIT. A string has at most 80 characters, so that
a line is written in pieces.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace

from ...core.errors import InputError
from ...core.recording import Recording, comments, listed
from ...core.source.text.names import Names
from ...core.source.write.options import OpaqueStyle, StructureStyle
from .values.records import ARM_AXES, NO_AXIS
from .write.formatting import NAME_RULES
from .write.numbers import number
from .write.options import RapidOptions
from .write.writer import ENTRY, SUFFIX, TextAround, module_name, write

SHORTEST_INTERRUPT = 0.01
"""s. ``ITimer \\Single`` takes no shorter time."""
SHORTEST_PERIOD = 0.004
"""s. The controllers' own cycle; a waiting task comes back no sooner."""
USUAL_PERIOD = 0.012
"""s. A little above what interrupts take, so that few come late."""
CAPACITY = 10_000
"""Samples that the arrays hold, 120 bytes each at most."""

LOGGER = "FlybyLogger"
TASK = "T_FLYBY"
_PIECE = 3
_STEP = "  "
_OWN_NAMES = (
    *("fbFile", "fbClock", "fbTimer", "fbSample", "fbOpen", "fbClose", "fbLine", "fbLogging"),
    *("fbReady", "fbNext", "fbName", "fbCount", "fbTime", "fbJoints", "fbBegin", "fbEnd", "fbRun"),
    *("fbByHand",),
)


def record(recording: Recording, options: RapidOptions, period: float) -> Mapping[str, str]:
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
    if not recording.alone:
        options = replace(options, structure=StructureStyle.KEEP)
    by = _by_interrupt if period >= SHORTEST_INTERRUPT else _by_task
    return by(recording, options, number(period))


def _by_interrupt(recording: Recording, options: RapidOptions, period: str) -> Mapping[str, str]:
    begin = [
        "fbName:=name;",
        "fbCount:=0;",
        *("ClkStop fbClock;", "ClkReset fbClock;", "ClkStart fbClock;"),
        *_armed(period),
    ]
    end = [
        *("WaitRob \\InPos;", "IDelete fbTimer;", "fbOpen;"),
        *("FOR i FROM 1 TO fbCount DO", "  fbLine fbTime{i},fbJoints{i};", "ENDFOR"),
        *("Close fbFile;", "IF fbCount=Dim(fbTime,1) THEN"),
        '  TPWrite "The arrays were full before the run had ended.";',
        "ENDIF",
    ]
    sample = [
        *_armed(period),
        "IF fbCount<Dim(fbTime,1) THEN",
        *("  fbCount:=fbCount+1;", "  fbTime{fbCount}:=ClkRead(fbClock);"),
        *("  fbJoints{fbCount}:=CJointT();", "ENDIF"),
    ]
    sampling = TextAround(
        header=(
            *_header(
                recording,
                options,
                period,
                f"Every {period} s an interrupt of this task takes a sample; one that comes late "
                "has the time at which it came. They are written when the run has ended; beyond "
                f"{CAPACITY} they are left out: enlarge fbTime and fbJoints. Shorter than "
                f"{number(SHORTEST_INTERRUPT)} s: record with a second task; every 4 ms and exact: "
                "EGM.",
            ),
        ),
        data=(
            *_run_data(recording),
            *_FILE_DATA,
            "VAR string fbName;",
            "VAR intnum fbTimer;",
            "VAR num fbCount:=0;",
            f"VAR num fbTime{{{CAPACITY}}};",
            f"VAR jointtarget fbJoints{{{CAPACITY}}};",
        ),
        main=lambda lines: _main(recording, lines),
        routines=(
            *("", *_routine("PROC fbBegin(string name)", begin)),
            *("", *_routine("PROC fbEnd()", end)),
            *_by_hand(recording),
            *_open_routine(options),
            *_line_routine(options),
            *("", *_routine("TRAP fbSample", sample)),
        ),
        names=_OWN_NAMES,
    )
    program = recording.program
    return {module_name(program) + SUFFIX: write(program, options, sampling)}


def _armed(period: str) -> list[str]:
    """The next sample is ordered; an interrupt is deleted before it is ordered again (ITimer)."""
    return [
        "IDelete fbTimer;",
        "CONNECT fbTimer WITH fbSample;",
        f"ITimer \\Single,{period},fbTimer;",
    ]


def _by_task(recording: Recording, options: RapidOptions, period: str) -> Mapping[str, str]:
    program = recording.program
    module = module_name(program)
    logger = _logger_name(recording)
    begin = ["fbName:=name;", "fbLogging:=TRUE;", "WaitUntil fbReady;"]
    end = ["WaitRob \\InPos;", "fbLogging:=FALSE;", "WaitUntil NOT fbReady;"]
    driving = TextAround(
        header=(*_header(recording, options, period),),
        data=(*_run_data(recording), *_SHARED_DATA),
        main=lambda lines: _main(recording, lines),
        routines=(
            *("", *_routine("PROC fbBegin(string name)", begin)),
            *("", *_routine("PROC fbEnd()", end)),
            *_by_hand(recording),
        ),
        names=_OWN_NAMES,
    )
    return {
        module + SUFFIX: write(program, options, driving),
        logger + SUFFIX: _logger(logger, module, options, period),
    }


_SHARED_DATA = (
    "PERS bool fbLogging:=FALSE;",
    "PERS bool fbReady:=FALSE;",
    'PERS string fbName:="";',
)
_FILE_DATA = ("VAR iodev fbFile;", "VAR clock fbClock;")


def _run_data(recording: Recording) -> tuple[str, ...]:
    return () if recording.alone else ("PERS num fbRun:=1;",)


def _main(recording: Recording, lines: list[str]) -> list[str]:
    """One run as it is, or those from ``fbRun`` on, up to one that the robot is jogged to.

    Args:
        lines: the instructions of the one run, or the calls of all.
    """
    first = recording.runs[0]
    if recording.alone:
        return [f'fbBegin "{first.log}";', *lines, "fbEnd;"]
    count = len(recording.runs)
    made = [f"IF fbRun<1 OR fbRun>{count} fbRun:=1;"]
    for index, (run, call) in enumerate(zip(recording.runs, lines, strict=True), 1):
        following = recording.runs[index] if index < count else None
        made += [
            f"IF fbRun={index} THEN",
            f'  TPWrite "run {index} of {count}: {run.log}";',
            f'  fbBegin "{run.log}";',
            f"  {call}",
            "  fbEnd;",
            f"  fbRun:={index % count + 1};",
            *(["  fbByHand;"] if following is not None and following.by_hand else []),
            "ENDIF",
        ]
    return [*made, 'TPWrite "All runs are driven.";', "EXIT;"]


def _by_hand(recording: Recording) -> list[str]:
    if not any(run.by_hand for run in recording.runs[1:]):
        return []
    body = [
        'TPWrite "Jog to the start of run "\\Num:=fbRun;',
        'TPWrite "(page), then PP to main, start.";',
        "EXIT;",
    ]
    return ["", *_routine("PROC fbByHand()", body)]


def steps(recording: Recording, period: float) -> list[str]:
    """See `core.language.Recorder.steps`."""
    module, several = module_name(recording.program) + SUFFIX, not recording.alone
    made = [
        f"Load {module} into the robot's task (T_ROB1) in place of other modules with a PROC main."
    ]
    if period < SHORTEST_INTERRUPT:
        made.append(
            f"Configure a task (Controller / Task) {TASK}, type SEMISTATIC, main entry {ENTRY}; "
            f"load {_logger_name(recording)}{SUFFIX} there and restart (option Multitasking)."
        )
    begins = " It begins with the run that fbRun says, 1 at first." if several else ""
    made.append(f"PP to main, automatic mode, speed 100 %, start.{begins}")
    if recording.jogged:
        made.append(
            f"Before {listed(recording.jogged)} it ends: jog to where the run begins, PP to main, "
            "start again; it goes on there. To begin elsewhere, set fbRun."
        )
    logs = "the log of each run" if several else recording.runs[0].log
    made.append(f"Fetch {logs} from HOME:.")
    return made


def _header(recording: Recording, options: RapidOptions, period: str, *further: str) -> list[str]:
    many = f"{len(recording.runs)} runs, each into a file of its own"
    columns = f"t,{','.join(_columns(options))}"
    return comments(
        "!",
        [
            f"Drives and logs {many if not recording.alone else 'a program'}; columns {columns}: t "
            "in s, q in rad (m for linear axes). Statements that do not move the robot are "
            "comments here.",
            *steps(recording, float(period)),
            *further,
        ],
    )


def _logger_name(recording: Recording) -> str:
    return Names(NAME_RULES, [module_name(recording.program), ENTRY]).claim(LOGGER, LOGGER)


def _logger(logger: str, module: str, options: RapidOptions, period: str) -> str:
    """The module of the second task: a line every ``period`` s while ``fbLogging`` holds."""
    loop = [
        "fbLogging:=FALSE;",
        "WHILE TRUE DO",
        "  WaitUntil fbLogging;",
        "  fbOpen;",
        *("  ClkStop fbClock;", "  ClkReset fbClock;", "  ClkStart fbClock;"),
        "  fbNext:=0;",
        "  fbReady:=TRUE;",
        "  WHILE fbLogging DO",
        '    fbLine ClkRead(fbClock),CJointT(\\TaskName:="T_ROB1");',
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
    """A new log with its head."""
    pieces = ["," + ",".join(piece) for piece in _pieces(_columns(options))]
    body = [
        'Open "HOME:"\\File:=fbName,fbFile\\Write;',
        *(f'Write fbFile,"{piece}"\\NoNewLine;' for piece in ["t", *pieces]),
        'Write fbFile,"";',
    ]
    return ["", *_routine("PROC fbOpen()", body)]


def _line_routine(options: RapidOptions) -> list[str]:
    """One line of the log."""
    values = [f"NumToStr(at.robax.rax_{n}*pi/180,6)" for n in range(1, ARM_AXES + 1)]
    for axis, kind in zip("abcdef", options.external_axes, strict=False):
        if kind == NO_AXIS:
            continue
        unit = "/1000" if kind == "linear" else "*pi/180"
        values.append(f"NumToStr(at.extax.eax_{axis}{unit},6)")
    pieces = ['","+' + '+","+'.join(piece) for piece in _pieces(values)]
    body = [
        "Write fbFile,NumToStr(time,3)\\NoNewLine;",
        *(f"Write fbFile,{piece}\\NoNewLine;" for piece in pieces),
        'Write fbFile,"";',
    ]
    return ["", *_routine("PROC fbLine(num time,jointtarget at)", body)]


def _columns(options: RapidOptions) -> list[str]:
    external = sum(kind != NO_AXIS for kind in options.external_axes)
    return [f"q{n}" for n in range(1, ARM_AXES + external + 1)]


def _pieces(values: Sequence[str]) -> list[Sequence[str]]:
    return [values[at : at + _PIECE] for at in range(0, len(values), _PIECE)]


def _routine(head: str, body: Sequence[str]) -> list[str]:
    return [head, *_indented(body), f"END{head.split()[0]}"]


def _indented(lines: Sequence[str]) -> list[str]:
    return [_STEP + line if line else line for line in lines]
