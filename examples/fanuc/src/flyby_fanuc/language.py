"""Reads, writes, patches and records TP programs."""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator, Mapping
from importlib import resources
from pathlib import Path

from flyby.core.dialect import RoutineText, Wording
from flyby.core.language import Sources
from flyby.core.recording import Recording, cycles_in, listed, routine
from flyby.core.robot.model import Robot
from flyby.core.source.lines.driving import dialect_of
from flyby.core.source.lines.language import LineLanguage
from flyby.core.source.lines.program import LineProgram
from flyby.core.source.lines.signals import Signals
from flyby.core.source.lines.statements import Line, Numbers
from flyby.core.source.text.files import SourceText
from flyby.core.source.write.options import OpaqueStyle, WriterOptions

from .grammar import Grammar
from .words import PIECES, quiet
from .writer import Writer, whole

_SIGNALS = Signals(
    Grammar,
    digital=("DO", "RO", "F", "SO", "UO"),
    inputs=("DI", "RI", "SI", "UI"),
    analogue=("AO", "GO"),
    pulse="{signal}=PULSE,{time}sec",
    quiet=quiet,
)
_ROUTINE = re.compile(
    r"^/PROG[ \t]+(?P<name>[\w-]+)[^\r\n]*(?P<body>)(?:(?!^/PROG).)*?^/END", re.M | re.S
)


def _routines(text: str) -> Iterator[RoutineText]:
    for found in _ROUTINE.finditer(text):
        yield RoutineText(found["name"], "", found.start(), found.start("body"), found.end())


TP = dialect_of(
    Grammar,
    "!",
    configurations=True,
    length_decimals=3,
    angle_decimals=3,
    fastest=2.0,
    most={"acceleration_override": 1.5},
    outputs=_SIGNALS.outputs(longest_lead=30.0, most=1),
    signals=_SIGNALS.dialect(),
    wording=Wording(
        silent=re.compile(
            r"^[ \t]*\d*:[ \t]*(?:!|//|--eg)[^\r\n]*|'[^'\r\n]*'|(?<=\d):[^\[\]\r\n]*(?=\])", re.M
        ),
        targets=re.compile(r"^[ \t]*(?P<names>P\[\d+[ ]*\])\s*\{", re.M),
        name=re.compile(
            r"\b(?:P|A?R|PR|SR|UFRAME|UTOOL)\[\d+|\b(?:U(?:FRAME|TOOL)_NUM|OVERRIDE)\b"
        ),
        routines=_routines,
    ),
)
"""What TP programs have words for."""
_VARIABLES = {
    "framevar.va": {"$MNUFRAME": "UFRAME", "$MNUTOOL": "UTOOL"},
    "posreg.va": {"$POSREG": "PR"},
}
_VARIABLE = re.compile(
    r"^\[[^\]\r\n]*\](?P<name>\$\w+)|^\s*\[1,(?P<index>\d+)\]\s*=(?P<value>[^\[]*)", re.M
)
_STEP = 0.008
"""s between positions that the controller computes."""
_SETTLE = "  WAIT .5(sec)"
_RUN = 100
"""The register that says which run is logged."""
_COORDINATE = re.compile(r"\b([XYZWPR])\s*:\s*(-?[\d.]+)")


class Language(LineLanguage):
    """Reader, writer, patcher and recorder.

    Beside a program it reads those that it calls, and the frames and position registers of the
    backup that it stands in.
    """

    name = "TP"
    suffix = ".ls"
    dialect = TP
    grammar = Grammar
    writer = Writer
    longest_name = 36
    capitals = True
    longest_comment = 32
    pieces = PIECES
    called = re.compile(r"\b(?:CALL|RUN)\s+([\w-]+)", re.IGNORECASE)
    always = tuple(_VARIABLES)

    def lines(self, source: SourceText) -> Iterable[Line]:
        """See `LineLanguage`."""
        return super().lines(SourceText(quiet(source.text), source.file))

    def program(self, text: str, file: str) -> LineProgram:
        """See `LineLanguage`; a file of variables has data alone."""
        words = _VARIABLES.get(Path(file).name.lower())
        if words is None:
            return super().program(text, file)
        return LineProgram(file, {file: text}, {}, data=dict(_variables(text, words)))

    def comment(self, text: str) -> Iterator[str]:
        """See `LineLanguage`."""
        said = " ".join(text.removeprefix(TP.comment).replace(";", ",").split())
        yield from (f"  {line}" for line in super().comment(said))

    def record(self, recording: Recording, robot: Robot, period: float) -> Sources:
        """The programs of the runs, one that calls them if there are several, and a KAREL program
        that logs the joints meanwhile; see `flyby.core.language.Recorder`."""
        cycles_in(period, _STEP, robot.name)
        files = [f"OPEN FILE log_file ('RW', 'UD1:{run.log}')" for run in recording.runs]
        runs, main = [self.named(recording.name)], {}
        if not recording.alone:
            cases = [f"  CASE ({k}): {file}" for k, file in enumerate(files, 1)]
            read = f"GET_REG({_RUN}, is_real, run, share, status)"
            files = [read, "SELECT run OF", *cases, "ENDSELECT"]
            name, runs = runs[0], [self.named(routine(k + 1)) for k in range(len(recording.runs))]
            pauses = (["  PAUSE"] * (k in recording.jogged) for k, _ in enumerate(runs, 1))
            calls = ([*pause, f"  CALL {run}"] for pause, run in zip(pauses, runs, strict=True))
            main = {f"{name}.ls": whole(name, [line for one in calls for line in one], [])}
        for k, run in enumerate(runs):
            which = () if recording.alone else (f"  R[{_RUN}]={k + 1}",)
            writer = Writer((*which, "  RUN FLYBY_LOG", _SETTLE), (_SETTLE, "  FLG[1]=OFF"))
            quiet = WriterOptions(OpaqueStyle.COMMENT)
            main[f"{run}.ls"] = self.written(recording.runs[k].program, run, quiet, writer)
        text = resources.files(__package__).joinpath("data/flyby_log.kl").read_text("utf-8")
        opened = "\n".join(f"  {one}" for one in files)
        return {**main, "flyby_log.kl": text.format(ms=round(1000 * period), opened=opened)}

    def usual_period(self, robot: Robot) -> float:
        """See `flyby.core.language.Recorder`: a line is written to a stick in less."""
        return 3 * _STEP

    def steps(self, recording: Recording, period: float) -> list[str]:
        """See `flyby.core.language.Recorder`."""
        made = [
            "Translate flyby_log.kl (ktrans flyby_log.kl) and load flyby_log.pc and the programs "
            "(.ls) onto the controller; put a USB stick into it (UD1:).",
            "Run the program in AUTO, override at 100 %. The logs stand on the stick.",
        ]
        jogged = f"Before {listed(recording.jogged)} it pauses: jog to where the run begins, and "
        return [*made, f"{jogged}resume."] if recording.jogged else made


def _variables(
    text: str, words: Mapping[str, str]
) -> Iterator[tuple[tuple[str, int | None], Numbers]]:
    """Frames, tools and position registers as a backup lists them."""
    word = None
    for found in _VARIABLE.finditer(text):
        if found["name"]:
            word = words.get(found["name"].upper())
            continue
        values = dict(_COORDINATE.findall(found["value"]))
        if word is not None and len(values) == 6:
            numbers = (float(values[axis]) for axis in "XYZWPR")
            yield (word, int(found["index"])), Numbers.of(numbers)
