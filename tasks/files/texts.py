"""Texts of changed programs: own files patched, or written anew, and always read back."""

from __future__ import annotations

import tempfile
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING

from ...core.errors import FlybyError

if TYPE_CHECKING:
    from ...core.language import Sources
    from ...core.program.program import Program
    from ...core.source.reading import Files
    from ..setup import Setup

OWN = {"shared": "own", "derived": "own"}
"""Moves get data of their own where one datum would hold for several."""


class ProgramTexts:
    """Makes texts of changed programs and keeps those of the last one, or of all.

    A program with the moves that there are is patched into its own files; one with others is
    written anew.

    Args:
        setup: whose programs.
        original: as it was read.
        own: whether moves get data of their own where the text has no place for a change.
        anew: whether a change that has no place even so (accelerations in RAPID) has the program
            written anew.
        keep: whether the texts of all programs are kept.
    """

    def __init__(
        self,
        setup: Setup,
        original: Program,
        *,
        own: bool,
        anew: bool = False,
        keep: bool = False,
    ) -> None:
        self._setup = setup
        self._original = original
        self._options = OWN if own else {}
        self._anew = anew
        self._keep = keep
        self._known: list[tuple[Program, Files]] = []

    @property
    def last(self) -> Files:
        """Of the last program that was read back; nothing if none was."""
        return self._known[-1][1] if self._known else {}

    def of(self, program: Program) -> Files:
        """Of a program that was read back; nothing of any other one, such as the original."""
        return next((files for known, files in self._known if known is program), {})

    def read_back(self, program: Program) -> Program:
        """The program as it is read from its new text.

        Raises:
            FlybyError: a change has no place in the text, or the language cannot say what the
                program holds.
        """
        read, files = self._made(program)
        self._known = [*self._known, (read, files)] if self._keep else [(read, files)]
        return read

    def _made(self, program: Program) -> tuple[Program, Files]:
        from ...core.source.patch.edits import reading_of

        old, new = ([move.origin for move in p.moves] for p in (self._original, program))
        if old == new:
            try:
                vendor, robot = self._setup.vendor, self._setup.robot
                files = vendor.patch(program, robot, self._options)
                return reading_of(program).again(files), files
            except FlybyError:
                if not self._anew:
                    raise
        return self._written(program)

    def _written(self, program: Program) -> tuple[Program, Files]:
        from ...core.source.text.files import SourceFile

        # Where the user says that the robot stands is no part of the program.
        own = replace(program, start=self._original.start)
        read, sources = written_anew(self._setup, own)
        return read, {file: SourceFile(file, text) for file, text in sources.items()}


def written_anew(setup: Setup, program: Program) -> tuple[Program, Sources]:
    """The program as it is read from the text that the vendor's writer makes of it, and the text.

    Raises:
        FlybyError: the language cannot say what the program holds.
    """
    sources = setup.vendor.write(program, setup.robot)
    return read_again(setup, sources), sources


def read_again(setup: Setup, sources: Sources) -> Program:
    """The program that source files hold, which are nowhere on the disk.

    Raises:
        FlybyError: it cannot be read.
    """
    vendor = setup.vendor
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        for file, text in sources.items():
            (folder / file).write_bytes(text.encode())
        first = next(file for file in sources if Path(file).suffix.lower() in vendor.suffixes)
        return vendor.read_file(folder / first, robot=setup.robot)
