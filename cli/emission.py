"""A changed program as text: its own files patched, or, with other moves, written anew."""

from __future__ import annotations

import tempfile
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING

from ..core.source.text.files import SourceFile
from .patching import Patching

if TYPE_CHECKING:
    from ..core.program.program import Program
    from ..core.robot.model import Robot
    from ..core.source.reading import Files
    from ..core.vendor import Sources, Vendor


class Emission:
    """Makes text of programs and keeps the last one made.

    Args:
        vendor: whose language it is.
        robot: whose program.
        original: as it was read.
        own: whether moves get data of their own where the text has no place for a change.
    """

    def __init__(self, vendor: Vendor, robot: Robot, original: Program, own: bool) -> None:
        self._vendor = vendor
        self._robot = robot
        self._original = original
        self._patching = Patching(vendor, robot, own)
        self.files: Files = {}
        self.anew = False
        """Whether the last program has been written anew."""

    def read_back(self, program: Program) -> Program:
        """The program as it is read from its new text.

        Raises:
            FlybyError: a change has no place in the text.
        """
        old, new = ([move.origin for move in p.moves] for p in (self._original, program))
        self.anew = old != new
        if not self.anew:
            read = self._patching.read_back(program)
            self.files = self._patching.files
            return read
        # Where the user says that the robot stands is no part of the program.
        own = replace(program, start=self._original.start)
        read, sources = written_anew(self._vendor, self._robot, own)
        self.files = {file: SourceFile(file, text) for file, text in sources.items()}
        return read


def written_anew(vendor: Vendor, robot: Robot, program: Program) -> tuple[Program, Sources]:
    """The program as it is read from the text that the vendor's writer makes of it, and the text.

    Raises:
        FlybyError: the language cannot say what the program holds.
    """
    sources = vendor.write(program, robot)
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        for file, text in sources.items():
            (folder / file).write_bytes(text.encode())
        first = next(file for file in sources if Path(file).suffix.lower() in vendor.suffixes)
        return vendor.read_file(folder / first, robot=robot), sources
