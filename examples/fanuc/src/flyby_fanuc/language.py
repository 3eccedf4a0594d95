"""Reads, writes, patches and records TP programs."""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator, Mapping
from pathlib import Path

from flyby.core.language import Sources
from flyby.core.recording import Recording
from flyby.core.robot.model import Robot
from flyby.core.source.lines.language import LineLanguage
from flyby.core.source.lines.program import LineProgram
from flyby.core.source.lines.statements import Body, Line, Numbers
from flyby.core.source.text.files import SourceText

from .dialect import TP
from .grammar import Grammar, lines
from .moves import Place
from .record import USUAL_PERIOD, record, steps
from .writer import Writer

_VARIABLES = {
    "framevar.va": {"$MNUFRAME": "UFRAME", "$MNUTOOL": "UTOOL"},
    "posreg.va": {"$POSREG": "PR"},
}
_VARIABLE = re.compile(
    r"^\[[^\]\r\n]*\](?P<name>\$\w+)|^\s*\[1,(?P<index>\d+)\]\s*=(?P<value>[^\[]*)", re.M
)
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
    called = re.compile(r"\b(?:CALL|RUN)\s+([\w-]+)", re.IGNORECASE)
    always = tuple(_VARIABLES)

    def lines(self, source: SourceText) -> Iterable[Line]:
        """See `LineLanguage`."""
        return lines(source)

    def program(self, text: str, file: str) -> LineProgram:
        """See `LineLanguage`; a file of variables has data alone."""
        words = _VARIABLES.get(Path(file).name.lower())
        if words is None:
            return super().program(text, file)
        return LineProgram(file, {file: text}, {"": Body()}, data=dict(_variables(text, words)))

    def comment(self, text: str) -> Iterator[str]:
        """See `LineLanguage`."""
        said = " ".join(text.removeprefix(TP.comment).replace(";", ",").split())
        yield from (f"  {line}" for line in super().comment(said))

    def record(self, recording: Recording, robot: Robot, period: float) -> Sources:
        """See `flyby.core.language.Recorder`."""
        return record(recording, robot, period, self)

    def usual_period(self, robot: Robot) -> float:
        """See `flyby.core.language.Recorder`."""
        return USUAL_PERIOD

    def steps(self, recording: Recording, period: float) -> list[str]:
        """See `flyby.core.language.Recorder`."""
        return steps(recording)


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
            yield (word, int(found["index"])), Numbers.of(numbers, Place())
