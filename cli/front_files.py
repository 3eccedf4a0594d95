"""Texts of several changed programs: patched where the language lets it be, else written anew."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from pathlib import Path
from typing import TYPE_CHECKING

from ..core.errors import FlybyError
from .emission import written_anew
from .outputs import check_outputs, writing

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
        from ..core.source.patching import reading_of

        try:
            files = self._vendor.patch(program, self._robot, _OWN)
        except FlybyError:
            read, sources = written_anew(self._vendor, self._robot, program)
            texts = {name: text.encode() for name, text in sources.items()}
        else:
            reading = reading_of(program)
            read, texts = reading.again(files), _bytes({**reading.files, **files})
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
        from ..core.motion.trajectory import write_whole

        if out is None:
            return []
        planned = {
            out / f"point-{k + 1}" / name: data
            for k, program in enumerate(programs)
            for name, data in self._texts(program).items()
        }
        for path in planned:
            with writing("--out", path.parent):
                path.parent.mkdir(parents=True, exist_ok=True)
        check_outputs({f"--out: {path}": path for path in planned}, inputs, replace_existing)
        for path, data in planned.items():
            with writing("--out", path):
                write_whole(path, data)
        folders = [out / f"point-{k + 1}" for k in range(len(programs))]
        return [[path for path in planned if path.parent == folder] for folder in folders]

    def _texts(self, program: Program) -> dict[str, bytes]:
        from ..core.source.patching import reading_of

        for known, texts in self._known:
            if known is program:
                return texts
        return _bytes(reading_of(self._original).files)


def _bytes(files: Files) -> dict[str, bytes]:
    return {Path(name).name: file.data for name, file in files.items()}
