"""Reads, writes, patches and records TP programs."""

from __future__ import annotations

import math
import re
from collections.abc import Iterator, Mapping
from dataclasses import replace
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
from flyby.core.source.lines.files import with_called
from flyby.core.source.lines.interpreter import run_lines
from flyby.core.source.lines.patcher import patch_lines
from flyby.core.source.lines.program import LineProgram, read_lines
from flyby.core.source.lines.statements import Numbers
from flyby.core.source.patch.edits import Edit
from flyby.core.source.patch.uses import MovePart, Use, UseKind
from flyby.core.source.reading import Files, ReadOptions, read_with
from flyby.core.source.text.files import SourceFile
from flyby.core.source.write.options import PatcherOptions, WriterOptions
from flyby.core.source.write.refusals import check_said

from .dialect import TP
from .grammar import Grammar, lines
from .moves import Place, numbers_of
from .record import USUAL_PERIOD, record, steps
from .writer import (
    Writer,
    amount,
    number,
    program_name,
    speed_text,
    zone_text,
)

_CALLED = re.compile(r"\b(?:CALL|RUN)\s+([\w-]+)", re.IGNORECASE)
_VARIABLES = {
    "framevar.va": {"$MNUFRAME": "UFRAME", "$MNUTOOL": "UTOOL"},
    "posreg.va": {"$POSREG": "PR"},
}
_VARIABLE = re.compile(
    r"^\[[^\]\r\n]*\](?P<name>\$\w+)|^\s*\[1,(?P<index>\d+)\]\s*=(?P<value>[^\[]*)", re.M
)
_COORDINATE = re.compile(r"\b([XYZWPR])\s*:\s*(-?[\d.]+)")


class Language:
    """Reader, writer, patcher and recorder."""

    def read(self, text: str, file: str, options: ReadOptions) -> Program:
        """See `flyby.core.language.Reader`."""
        return read_with({file: SourceFile(file, text)}, file, options, _read)

    def read_file(self, path: Path, options: ReadOptions) -> Program:
        """The same of a file, of the programs beside it that it calls, and of the frames and
        position registers of the backup that it stands in."""
        files = with_called(path, options, (".ls",), _CALLED.findall, tuple(_VARIABLES))
        return read_with(files, str(path), options, _read)

    def write(self, program: Program, robot: Robot, options: Mapping[str, str]) -> Sources:
        """See `flyby.core.language.Writer`; the option is ``opaque``."""
        name = program_name(program.name)
        return {f"{name}.ls": Writer(WriterOptions.of(options, "TP writer")).text(program, name)}

    def patch(self, program: Program, robot: Robot, options: Mapping[str, str]) -> Files:
        """See `flyby.core.language.Patcher`."""
        chosen = PatcherOptions.of(options, "TP patcher")
        return patch_lines(program, chosen, _numbers_of, _number, _own)

    def record(self, recording: Recording, robot: Robot, period: float) -> Sources:
        """See `flyby.core.language.Recorder`."""
        return record(recording, robot, period)

    def usual_period(self, robot: Robot) -> float:
        """See `flyby.core.language.Recorder`."""
        return USUAL_PERIOD

    def steps(self, recording: Recording, period: float) -> list[str]:
        """See `flyby.core.language.Recorder`."""
        return steps(recording)


def _read(files: Files, main: str, options: ReadOptions) -> Program:
    own: LineProgram | None = None
    data: dict[tuple[str, int], Numbers] = {}
    for file, source in files.items():
        words = _VARIABLES.get(Path(file).name.lower())
        if words is not None:
            data.update(_variables(source.text, words))
            continue
        read = read_lines(source.text, file, Grammar(), "TP", lines)
        own = read if own is None else own.with_file(read)
    if own is None:
        raise InputError(f"{main}: holds variables and no program: name a program (.ls)")
    return run_lines(replace(own, data=data), Grammar(), options)


def _variables(text: str, words: Mapping[str, str]) -> Iterator[tuple[tuple[str, int], Numbers]]:
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


def _numbers_of(kind: UseKind, part: MovePart, move: Move) -> tuple[float, ...]:
    check_said(move, TP, "TP")
    if isinstance(part, Speed):
        texts = re.match(r"[\d.]+", speed_text(move, part))
        shown = () if texts is None else (float(texts[0]),)
        own = part.acceleration_override
        return (*shown, 100 * own) if own != 1.0 else shown
    if isinstance(part, JointTarget | PoseTarget):
        return numbers_of(part)
    if not isinstance(part, VendorZone):
        return ()
    sizes = (1.0, part.ratio) if part.ratio != 1.0 else (1.0,)
    return tuple(part.size * s / part.kind.unit for s in sizes)


def _number(value: float) -> str:
    return amount(value) if math.isclose(value, round(value, 3), abs_tol=1e-10) else number(value)


def _own(use: Use) -> Iterator[Edit]:
    """Other words at the move; a position of its own is not given."""
    if isinstance(use.new, Speed):
        if use.new.acceleration_override != use.old.acceleration_override:
            raise InputError("ACC is not put in or taken out in place: write the program anew")
        yield Edit(use.origin.span, speed_text(use.move, use.new), use.index)
    elif isinstance(use.new, JointTarget | PoseTarget):
        raise InputError("a position of its own is not put in: change it for all that use it")
    else:
        yield Edit(use.origin.span, zone_text(use.new), use.index)
