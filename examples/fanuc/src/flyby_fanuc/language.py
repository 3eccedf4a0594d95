"""Reads, writes, patches and records TP programs."""

from __future__ import annotations

import math
import re
from collections.abc import Iterable, Iterator, Mapping
from pathlib import Path

from flyby.core.errors import InputError
from flyby.core.language import Sources
from flyby.core.program.move import Move
from flyby.core.program.program import Program
from flyby.core.program.speed import Speed
from flyby.core.program.target import JointTarget, PoseTarget
from flyby.core.program.zone import VendorZone
from flyby.core.recording import Recording
from flyby.core.robot.model import Robot
from flyby.core.source.lines.language import LineLanguage
from flyby.core.source.lines.program import LineProgram
from flyby.core.source.lines.statements import Body, Line, Numbers
from flyby.core.source.patch.edits import Edit
from flyby.core.source.patch.uses import MovePart, Use, UseKind
from flyby.core.source.text.files import SourceText
from flyby.core.source.write.options import WriterOptions

from .dialect import TP
from .grammar import Grammar, lines
from .moves import XYZ, Place
from .record import USUAL_PERIOD, record, steps
from .writer import Writer, amount, number, pace_of, program_name, remark, speed_text, zone_text

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
    positions = XYZ
    called = re.compile(r"\b(?:CALL|RUN)\s+([\w-]+)", re.IGNORECASE)
    always = tuple(_VARIABLES)

    def grammar(self) -> Grammar:
        """See `LineLanguage`."""
        return Grammar()

    def lines(self, source: SourceText) -> Iterable[Line]:
        """See `LineLanguage`."""
        return lines(source)

    def program(self, text: str, file: str) -> LineProgram:
        """See `LineLanguage`; a file of variables has data alone."""
        words = _VARIABLES.get(Path(file).name.lower())
        if words is None:
            return super().program(text, file)
        return LineProgram(file, {file: text}, {"": Body()}, data=dict(_variables(text, words)))

    def file_name(self, program: Program) -> str:
        """See `LineLanguage`."""
        return program_name(program.name)

    def writer(self, options: WriterOptions) -> Writer:
        """See `LineLanguage`."""
        return Writer(options)

    def comment(self, text: str) -> Iterator[str]:
        """See `LineLanguage`."""
        return remark(text)

    def number(self, value: float) -> str:
        """See `LineLanguage`."""
        short = math.isclose(value, round(value, 3), abs_tol=1e-10)
        return amount(value) if short else number(value)

    def settings_of(self, kind: UseKind, part: MovePart, move: Move) -> tuple[float, ...]:
        """The numbers of a motion: a speed, a share of acceleration if it is stated; a zone."""
        if isinstance(part, Speed):
            found, share = pace_of(move, part), part.acceleration_override
            shown = () if found is None else (found[1],)
            return shown if share == 1.0 else (*shown, 100 * share)
        if not isinstance(part, VendorZone):
            return ()
        sizes = (1.0, part.ratio) if part.ratio != 1.0 else (1.0,)
        return tuple(part.size * s / part.kind.unit for s in sizes)

    def own(self, use: Use) -> Iterator[Edit]:
        """Other words at the move; a position of its own is not given."""
        if isinstance(use.new, JointTarget | PoseTarget):
            raise InputError("a position of its own is not put in: change it for all that use it")
        if not isinstance(use.new, Speed):
            yield Edit(use.origin.span, zone_text(use.new), use.index)
            return
        if use.new.acceleration_override != use.old.acceleration_override:
            raise InputError("ACC is not put in or taken out in place: write the program anew")
        yield Edit(use.origin.span, speed_text(use.move, use.new), use.index)

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
