"""TP programs that drive runs, and a KAREL program that logs the joints meanwhile."""

from __future__ import annotations

import math

from flyby.core.errors import InputError
from flyby.core.language import Sources
from flyby.core.recording import Recording, listed, routine
from flyby.core.robot.model import Robot
from flyby.core.source.lines.language import LineLanguage
from flyby.core.source.write.options import OpaqueStyle, WriterOptions

from .writer import HEAD, TAIL, Writer, program_name

STEP = 0.008
"""s between positions that the controller computes."""
USUAL_PERIOD = 3 * STEP
"""s. A KAREL program writes a line to a stick in less."""
_SETTLE = "  WAIT .5(sec)"
_RUN = 100
"""The register that says which run is logged."""
_KAREL = """\
PROGRAM flyby_log
-- Logs the joints every {ms} ms to a stick (UD1:): t in s, q1 to q6 in rad, J3 as displayed.
-- Translate it (ktrans) and load it beside the programs, which start it and end it by FLG[1].
%NOLOCKGROUP
%NOPAUSE = ERROR + COMMAND + TPENABLE
VAR
  log_file : FILE
  joints : JOINTPOS
  values : ARRAY[9] OF REAL
  status, clock, k, run : INTEGER
  is_real : BOOLEAN
  share : REAL
BEGIN
{opened}
  WRITE log_file ('t,q1,q2,q3,q4,q5,q6', CR)
  clock = 0
  CONNECT TIMER TO clock
  FLG[1] = ON
  WHILE FLG[1] DO
    joints = CURJPOS(0, 0, 1)
    CNV_JPOS_REL(joints, values, status)
    WRITE log_file (clock / 1000.0::8::3)
    FOR k = 1 TO 6 DO
      WRITE log_file (',', values[k] * 0.01745329252::10::6)
    ENDFOR
    WRITE log_file (CR)
    DELAY {ms}
  ENDWHILE
  CLOSE FILE log_file
  DISCONNECT TIMER clock
END flyby_log
"""


def record(recording: Recording, robot: Robot, period: float, language: LineLanguage) -> Sources:
    """The programs of the runs, one that calls them if there are several, and the logger.

    Raises:
        InputError: the period is no whole number of steps of the controller.
        MotionError: TP cannot say a move.
    """
    log = logger(recording, robot, period)
    name = program_name(recording.name)
    if recording.alone:
        return {f"{name}.ls": _logged(recording, 0, name, language), "flyby_log.kl": log}
    names = [program_name(routine(k)) for k, _ in enumerate(recording.runs, 1)]
    called = []
    for number, run in enumerate(names, 1):
        called += ["  PAUSE"] if number in recording.jogged else []
        called.append(f"  CALL {run}")
    numbered = "".join(f"{k:>4}:{line} ;\n" for k, line in enumerate(called, 1))
    made = {f"{name}.ls": f"{HEAD.format(name=name)}{numbered}/POS\n{TAIL}"}
    made |= {f"{run}.ls": _logged(recording, k, run, language) for k, run in enumerate(names)}
    return {**made, "flyby_log.kl": log}


def _logged(recording: Recording, index: int, name: str, language: LineLanguage) -> str:
    which = () if recording.alone else (f"  R[{_RUN}]={index + 1}",)
    before, after = (*which, "  RUN FLYBY_LOG", _SETTLE), (_SETTLE, "  FLG[1]=OFF")
    quiet = WriterOptions(OpaqueStyle.COMMENT)
    writer = Writer(quiet, before, after)
    return language.written(recording.runs[index].program, name, quiet, writer)


def steps(recording: Recording) -> list[str]:
    """See `flyby.core.language.Recorder.steps`."""
    made = [
        "Translate flyby_log.kl (ktrans flyby_log.kl) and load flyby_log.pc and the programs (.ls) "
        "onto the controller; put a USB stick into it (UD1:).",
        "Run the program in AUTO, override at 100 %. The logs stand on the stick.",
    ]
    if recording.jogged:
        made.append(
            f"Before {listed(recording.jogged)} it pauses: jog to where the run begins, and resume."
        )
    return made


def logger(recording: Recording, robot: Robot, period: float) -> str:
    """The KAREL program.

    Raises:
        InputError: the period is no whole number of steps of the controller.
    """
    steps = period / STEP if math.isfinite(period) else 0.0
    if round(steps) < 1 or abs(steps - round(steps)) > 1e-6 * steps:
        raise InputError(
            f"{robot.name} has new positions every {STEP:g} s: a log has that period or a whole "
            f"multiple of it, not {period:g} s"
        )
    files = [f"OPEN FILE log_file ('RW', 'UD1:{run.log}')" for run in recording.runs]
    opened = [f"  {files[0]}"]
    if not recording.alone:
        cases = [f"    CASE ({k}): {file}" for k, file in enumerate(files, 1)]
        read = f"  GET_REG({_RUN}, is_real, run, share, status)"
        opened = [read, "  SELECT run OF", *cases, "  ENDSELECT"]
    return _KAREL.format(ms=round(1000 * period), opened="\n".join(opened))
