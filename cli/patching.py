"""Changed programs in the user's own files: patched, read again, written where the user says."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
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


def check_places(
    out: Path | None, in_place: bool, inputs: Sequence[Path], replace_existing: bool
) -> None:
    """Refuse, before work begins, places that patched files cannot go to.

    Args:
        out: folder for them, None for none.
        in_place: whether they take the place of what is read.
        inputs: files that are read, the program first.
        replace_existing: see `check_outputs`.

    Raises:
        InputError: both places are asked for, or the folder cannot take the program's file.
    """
    check_folder("--out", out)
    if out is None:
        return
    if in_place:
        raise InputError("--out and --in-place: the files go to one place or the other")
    if out.is_dir():
        path = out / inputs[0].name
        check_outputs({f"--out: {path.name}": path}, inputs, replace_existing)


def write_patched(
    files: Files,
    read: Files,
    out: Path | None,
    in_place: bool,
    inputs: Iterable[Path],
    replace_existing: bool,
) -> list[Path]:
    """Write patched files.

    Args:
        files: by the names they were read by.
        read: the files as they were read.
        out: folder for them; it is made if it is missing.
        in_place: whether they take the place of what was read.
        inputs, replace_existing: see `check_outputs`; with ``in_place`` inputs are replaced.

    Returns:
        The files that were written; none if neither place is given.

    Raises:
        InputError: one of them must not be written, cannot be encoded, or has changed since it was
            read; then none is.
    """
    from ..core.motion.trajectory import write_whole

    if out is None and not in_place:
        return []
    option = "--in-place" if out is None else "--out"
    paths = {name: Path(name) if out is None else out / Path(name).name for name in files}
    if out is not None:
        _check_apart(paths)
        with writing(option, out):
            out.mkdir(exist_ok=True)
        check_outputs(
            {f"{option}: {path.name}": path for path in paths.values()}, inputs, replace_existing
        )
    else:
        _check_unchanged(paths, read)
    encoded = {path: files[name].data for name, path in paths.items()}
    for path, data in encoded.items():
        with writing(option, path):
            write_whole(path, data)
    return list(paths.values())


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
