"""Readers, writers and patchers with a fault between them and their vendor's own."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from contextlib import suppress
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

from ...core.errors import FlybyError
from ...core.language import Patcher, Reader, Recorder, Sources, Writer
from ...core.program.move import Move
from ...core.program.program import Program
from ...core.recording import Recording
from ...core.robot.model import Robot
from ...core.source.reading import Files, Reading, ReadOptions
from ...core.vendor import Vendor

Fault = Callable[[Program], Program]
Plant = Callable[[Vendor], Vendor]


@dataclass(frozen=True)
class _FaultyRead:
    """A vendor's function from files to a program, with a fault behind it."""

    sound: Callable[[Files, str, ReadOptions], Program]
    fault: Fault

    def __call__(self, files: Files, main: str, options: ReadOptions) -> Program:
        return self.fault(self.sound(files, main, options))


@dataclass(frozen=True)
class FaultyReader:
    """Reads, and hands out another program; reading again does the same."""

    sound: Reader
    fault: Fault

    @property
    def depends(self) -> bool:
        """Whether it reads for an arm (`core.source.lines.language.LineLanguage.depends`)."""
        return bool(getattr(self.sound, "depends", False))

    def read(self, text: str, file: str, options: ReadOptions) -> Program:
        """See `flyby.core.language.Reader`."""
        return self._faulty(self.sound.read(text, file, options))

    def read_file(self, path: Path, options: ReadOptions) -> Program:
        """See `flyby.core.language.Reader`."""
        return self._faulty(self.sound.read_file(path, options))

    def _faulty(self, program: Program) -> Program:
        made = self.fault(program)
        if not isinstance(program.reading, Reading):
            return made
        read = _FaultyRead(program.reading.read, self.fault)
        return replace(made, reading=replace(program.reading, read=read))


@dataclass(frozen=True)
class LenientReader(FaultyReader):
    """Passes over what its vendor's own refuses."""

    def read(self, text: str, file: str, options: ReadOptions) -> Program:
        """See `flyby.core.language.Reader`."""
        with suppress(FlybyError):
            return super().read(text, file, options)
        return Program(())

    def read_file(self, path: Path, options: ReadOptions) -> Program:
        """See `flyby.core.language.Reader`."""
        with suppress(FlybyError):
            return super().read_file(path, options)
        return Program(())


@dataclass(frozen=True)
class FaultyWriter:
    """Writes another program than it gets."""

    sound: Writer
    fault: Fault

    def write(self, program: Program, robot: Robot, options: Mapping[str, str]) -> Sources:
        """See `flyby.core.language.Writer`."""
        return self.sound.write(self.fault(program), robot, options)


@dataclass(frozen=True)
class FaultyPatcher:
    """Patches another program than it gets, reading as its vendor's own reader does."""

    sound: Patcher
    fault: Fault

    def patch(self, program: Program, robot: Robot, options: Mapping[str, str]) -> Files:
        """See `flyby.core.language.Patcher`."""
        return self.sound.patch(_soundly_read(self.fault(program)), robot, options)


@dataclass(frozen=True)
class FaultyFiles:
    """Patches, and hands out other files: ``fault`` gets them, and what they were before."""

    sound: Patcher
    fault: Callable[[Files, Files], Files]

    def patch(self, program: Program, robot: Robot, options: Mapping[str, str]) -> Files:
        """See `flyby.core.language.Patcher`."""
        files = self.sound.patch(program, robot, options)
        reading = program.reading
        return self.fault(files, reading.files) if isinstance(reading, Reading) else files


def _soundly_read(program: Program) -> Program:
    reading = program.reading
    if isinstance(reading, Reading) and isinstance(reading.read, _FaultyRead):
        return replace(program, reading=replace(reading, read=reading.read.sound))
    return program


def in_reading(fault: Fault) -> Plant:
    """The reader makes a fault."""

    def plant(vendor: Vendor) -> Vendor:
        reader = vendor.reader
        return vendor if reader is None else replace(vendor, reader=FaultyReader(reader, fault))

    return plant


def in_writing(fault: Fault) -> Plant:
    """The writer makes a fault."""

    def plant(vendor: Vendor) -> Vendor:
        writer = vendor.writer
        return vendor if writer is None else replace(vendor, writer=FaultyWriter(writer, fault))

    return plant


def in_patching(fault: Fault) -> Plant:
    """The patcher makes a fault."""

    def plant(vendor: Vendor) -> Vendor:
        patcher = vendor.patcher
        if patcher is None:
            return vendor
        return replace(vendor, patcher=FaultyPatcher(patcher, fault))

    return plant


def in_patched_files(fault: Callable[[Files, Files], Files]) -> Plant:
    """The patcher hands out other files than it should."""

    def plant(vendor: Vendor) -> Vendor:
        patcher = vendor.patcher
        if patcher is None:
            return vendor
        return replace(vendor, patcher=FaultyFiles(patcher, fault))

    return plant


@dataclass(frozen=True)
class FaultyRecorder:
    """Records otherwise than its vendor's own."""

    sound: Recorder
    fault: Callable[[Recorder, Recording, Robot, float], Sources]

    def record(self, recording: Recording, robot: Robot, period: float) -> Sources:
        """See `flyby.core.language.Recorder`."""
        return self.fault(self.sound, recording, robot, period)

    def usual_period(self, robot: Robot) -> float:
        """See `flyby.core.language.Recorder`."""
        return self.sound.usual_period(robot)

    def steps(self, recording: Recording, period: float) -> Sequence[str]:
        """See `flyby.core.language.Recorder`."""
        return self.sound.steps(recording, period)


def everywhere(read: Fault, write: Fault) -> Plant:
    """Reader, writer and patcher are wrong alike, so that what is written comes back.

    Args:
        read: what the reader makes of a program.
        write: the way back.
    """
    faults = in_reading(read), in_writing(write), in_patching(write)

    def plant(vendor: Vendor) -> Vendor:
        for one in faults:
            vendor = one(vendor)
        return vendor

    return plant


def each_move(change: Callable[[Move], Move]) -> Fault:
    """A fault of single moves."""
    return lambda program: program.with_moves(tuple(map(change, program.moves)))


def without(kinds: type | tuple[type, ...]) -> Fault:
    """The statements of some kinds are lost."""

    def fault(program: Program) -> Program:
        left = tuple(s for s in program.statements if not isinstance(s, kinds))
        return with_statements(program, left)

    return fault


def with_statements(program: Program, statements: tuple[Any, ...]) -> Program:
    """The program with other statements, and without what counts them."""
    return replace(program, statements=statements, sections=(), calls=(), cycle=None)
