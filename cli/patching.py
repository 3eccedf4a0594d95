"""Changed programs in the user's own files: patched, read again, written where the user says."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

from ..core.errors import InputError
from .outputs import check_folder, check_outputs, writing

if TYPE_CHECKING:
    from ..core.program.program import Program
    from ..core.robot.model import Robot
    from ..core.source.reading import Files
    from ..core.vendor import Vendor


class Patching:
    """Patches a program's files and keeps what the last patch made of them.

    Args:
        vendor: whose language it is.
        robot: whose program.
        own: whether moves get data of their own where the text has no place for a change.
    """

    def __init__(self, vendor: Vendor, robot: Robot, own: bool) -> None:
        self._vendor = vendor
        self._robot = robot
        self._options = {"shared": "own", "derived": "own"} if own else {}
        self.files: Files = {}

    def read_back(self, program: Program) -> Program:
        """Patch the files of a program and read them again.

        Raises:
            FlybyError: a change has no place in the text.
        """
        from ..core.source.patching import reading_of

        self.files = self._vendor.patch(program, self._robot, self._options)
        return reading_of(program).again(self.files)


@dataclass(frozen=True)
class Places:
    """Where patched files go.

    Args:
        out: folder for them, made if it is missing; None for none.
        in_place: whether they take the place of what is read.
        inputs: files that are read, the program first.
        replace_existing: see `check_outputs`; with ``in_place`` inputs are replaced.
    """

    out: Path | None
    in_place: bool
    inputs: Sequence[Path]
    replace_existing: bool

    @property
    def anywhere(self) -> bool:
        """Whether there is a place at all."""
        return self.in_place or self.out is not None

    def check(self) -> None:
        """Refuse, before work begins, places that patched files cannot go to.

        Raises:
            InputError: both places are asked for, or the folder cannot take the program's file.
        """
        check_folder("--out", self.out)
        if self.out is None:
            return
        if self.in_place:
            raise InputError("--out and --in-place: the files go to one place or the other")
        if self.out.is_dir():
            path = self.out / self.inputs[0].name
            check_outputs({f"--out: {path.name}": path}, self.inputs, self.replace_existing)

    def write(self, files: Files, read: Files) -> list[Path]:
        """Write patched files.

        Args:
            files: by the names they were read by.
            read: the files as they were read.

        Returns:
            The files that were written; none if there is no place for them.

        Raises:
            InputError: one of them must not be written, cannot be encoded, or has changed since
                it was read; then none is.
        """
        from ..core.motion.trajectory import write_whole

        if not self.anywhere:
            return []
        option = "--in-place" if self.out is None else "--out"
        paths = self._paths(files)
        if self.out is None:
            _check_unchanged(paths, read)
        else:
            _check_apart(paths)
            with writing(option, self.out):
                self.out.mkdir(exist_ok=True)
            named = {f"{option}: {path.name}": path for path in paths.values()}
            check_outputs(named, self.inputs, self.replace_existing)
        encoded = {path: files[name].data for name, path in paths.items()}
        for path, data in encoded.items():
            with writing(option, path):
                write_whole(path, data)
        return list(paths.values())

    def _paths(self, files: Files) -> dict[str, Path]:
        if self.out is None:
            return {name: Path(name) for name in files}
        return {name: self.out / Path(name).name for name in files}


def _check_unchanged(paths: Mapping[str, Path], read: Files) -> None:
    """Refuse to write over what somebody has saved since the files were read."""
    for name, path in paths.items():
        try:
            now = path.read_bytes()
        except OSError as error:
            raise InputError(f"--in-place: {path} cannot be read any more: {error}") from error
        if name in read and now != read[name].data:
            raise InputError(
                f"--in-place: {path} has changed since it was read, and stays as it is: run again, "
                "or name a folder by --out"
            )


def _check_apart(paths: Mapping[str, Path]) -> None:
    taken: dict[Path, str] = {}
    for name, path in paths.items():
        if path in taken:
            raise InputError(
                f"--out: {taken[path]} and {name} are called alike; use --in-place for these files"
            )
        taken[path] = name
