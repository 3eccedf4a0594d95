"""Texts of several changed programs: patched where the language lets it be, else written anew."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING

from ..core.errors import FlybyError
from .emission import written_anew
from .outputs import write_in

if TYPE_CHECKING:
    from ..core.program.program import Program
    from ..core.robot.model import Robot
    from ..core.source.reading import Files
    from ..core.vendor import Vendor

_OWN = {"shared": "own", "derived": "own"}
"""Moves get data of their own where one datum would hold for several."""


class FrontFiles:
    """Makes text of programs and keeps it for those that are asked for.

    Args:
        vendor: whose language it is.
        robot: whose programs.
        original: as it was read.
    """

    def __init__(self, vendor: Vendor, robot: Robot, original: Program) -> None:
        self._vendor = vendor
        self._robot = robot
        self._original = original
        self._known: list[tuple[Program, dict[str, bytes]]] = []

    def read_back(self, program: Program) -> Program:
        """The program as it is read from its new text.

        Its own files are patched; what has no place there (accelerations in RAPID) has the program
        written anew, as the moves that are driven.

        Raises:
            FlybyError: the language cannot say what the program holds.
        """
        from ..core.source.patch.edits import reading_of

        try:
            files = self._vendor.patch(program, self._robot, _OWN)
        except FlybyError:
            # Where the user says that the robot stands is no part of the program.
            own = replace(program, start=self._original.start)
            read, sources = written_anew(self._vendor, self._robot, own)
            texts = {name: text.encode() for name, text in sources.items()}
        else:
            read, texts = reading_of(program).again(files), self._set(files)
        self._known.append((read, texts))
        return read

    def write(
        self,
        out: Path | None,
        programs: Sequence[Program],
        inputs: Iterable[Path],
        replace_existing: bool,
    ) -> list[list[Path]]:
        """Write programs that were read back, each into a folder of its own.

        Args:
            out: folder for ``point-1`` and its like; None writes nothing.
            programs: in their order; one that was not read back is the original.
            inputs, replace_existing: see `check_outputs`.

        Returns:
            The files of each program; empty if there is no folder for them.

        Raises:
            InputError: one of them must not be written; then none is.
        """
        if out is None:
            return []
        planned = {
            Path(f"point-{k + 1}") / name: data
            for k, program in enumerate(programs)
            for name, data in self._texts(program).items()
        }
        written = write_in("--out", out, planned, inputs, replace_existing)
        folders = [out / f"point-{k + 1}" for k in range(len(programs))]
        return [[path for path in written if path.parent == folder] for folder in folders]

    def _texts(self, program: Program) -> dict[str, bytes]:
        for known, texts in self._known:
            if known is program:
                return texts
        return self._set({})

    def _set(self, changed: Files) -> dict[str, bytes]:
        """The files of the original, of which some have changed, that run alone."""
        from ..core.source.patch.edits import reading_of, runnable_set
        from ..core.source.reading import named_apart

        reading = reading_of(self._original)
        files = runnable_set(self._original, changed or {reading.main: reading.files[reading.main]})
        return {name: file.data for name, file in named_apart(files).items()}
