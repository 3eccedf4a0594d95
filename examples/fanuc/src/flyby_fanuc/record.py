"""TP programs that drive runs, and a KAREL program that logs the joints meanwhile."""

from __future__ import annotations

from importlib.resources import files

from flyby.core.language import Sources
from flyby.core.recording import Recording, cycles_in, listed, routine
from flyby.core.robot.model import Robot
from flyby.core.source.lines.language import LineLanguage
from flyby.core.source.write.options import OpaqueStyle, WriterOptions

from .writer import Writer, whole

STEP = 0.008
"""s between positions that the controller computes."""
USUAL_PERIOD = 3 * STEP
"""s. A KAREL program writes a line to a stick in less."""
_SETTLE = "  WAIT .5(sec)"
_RUN = 100
"""The register that says which run is logged."""


def record(recording: Recording, robot: Robot, period: float, language: LineLanguage) -> Sources:
    """The programs of the runs, one that calls them if there are several, and the logger.

    Raises:
        InputError: the period is no whole number of steps of the controller.
        MotionError: TP cannot say a move.
    """
    cycles_in(period, STEP, robot.name)
    logger = {"flyby_log.kl": _logger(recording, period)}
    name = language.named(recording.name)
    if recording.alone:
        return {f"{name}.ls": _logged(recording, 0, name, language), **logger}
    names = [language.named(routine(k)) for k, _ in enumerate(recording.runs, 1)]
    called = []
    for number, run in enumerate(names, 1):
        called += ["  PAUSE"] if number in recording.jogged else []
        called.append(f"  CALL {run}")
    made = {f"{name}.ls": whole(name, called, [])}
    made |= {f"{run}.ls": _logged(recording, k, run, language) for k, run in enumerate(names)}
    return {**made, **logger}


def _logged(recording: Recording, index: int, name: str, language: LineLanguage) -> str:
    which = () if recording.alone else (f"  R[{_RUN}]={index + 1}",)
    writer = Writer((*which, "  RUN FLYBY_LOG", _SETTLE), (_SETTLE, "  FLG[1]=OFF"))
    program, quiet = recording.runs[index].program, WriterOptions(OpaqueStyle.COMMENT)
    return language.written(program, name, quiet, writer)


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


def _logger(recording: Recording, period: float) -> str:
    """The KAREL program."""
    opened = [f"OPEN FILE log_file ('RW', 'UD1:{run.log}')" for run in recording.runs]
    if not recording.alone:
        cases = [f"  CASE ({k}): {file}" for k, file in enumerate(opened, 1)]
        read = f"GET_REG({_RUN}, is_real, run, share, status)"
        opened = [read, "SELECT run OF", *cases, "ENDSELECT"]
    text = files(__package__).joinpath("data/flyby_log.kl").read_text("utf-8")
    return text.format(ms=round(1000 * period), opened="\n".join(f"  {one}" for one in opened))
