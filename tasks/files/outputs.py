"""Output files: refused before any of them is written, written whole or not at all."""

from __future__ import annotations

import logging
import os
import tempfile
from collections.abc import Iterable, Iterator, Mapping
from contextlib import contextmanager
from pathlib import Path

from ...core.door import switched
from ...core.errors import InputError, OptionError

PAGES = (".html", ".htm")
"""Suffixes of pages."""
PICTURES = (".png", ".pdf", ".svg")
"""Suffixes of pictures that can be drawn."""
_log = logging.getLogger("flyby")


def check_outputs(
    outputs: Mapping[str, Path | Iterable[Path] | None],
    inputs: Iterable[Path],
    replace_existing: bool,
    made: Path | None = None,
) -> None:
    """Refuse output paths that cannot or must not be written.

    Args:
        outputs: by the option that names them or their folder; None where it was not given.
        inputs: files that are read; they are never written to.
        replace_existing: whether files that exist may be replaced (``--force``).
        made: folder that is made, with those in it, if it is missing.

    Raises:
        InputError: naming option and path.
    """
    taken = {_real(path): str(path) for path in inputs}
    for option, path in _one_by_one(outputs):
        real = _real(path)
        if real in taken:
            raise InputError(f"{option} {path}: would overwrite {taken[real]}; choose another name")
        taken[real] = f"the file of {option}"
        with _asked(option, path):
            there = path.exists()
            if there and not path.is_file():
                raise InputError(f"{option} {path}: is no regular file; name another")
            if not path.parent.is_dir() and (made is None or not path.is_relative_to(made)):
                raise InputError(f"{option} {path}: there is no folder {path.parent}")
            _try(path.parent)
        if there and not replace_existing:
            raise InputError(f"{option} {path}: exists already; {switched('force')} replaces it")


def _one_by_one(
    outputs: Mapping[str, Path | Iterable[Path] | None],
) -> Iterator[tuple[str, Path]]:
    for option, paths in outputs.items():
        for path in (paths,) if isinstance(paths, Path) else paths or ():
            yield option, path


def picture_kind(file: str | Path, option: str) -> str:
    """The kind of a picture by its file's name: ``png``, ``pdf`` or ``svg``.

    Raises:
        InputError: naming the option and the file: that cannot be drawn.
    """
    suffix = Path(file).suffix.lower()
    if suffix not in PICTURES:
        raise OptionError(f"{option} {file}: the name must end in {', '.join(PICTURES)}")
    return suffix[1:]


def page_name(file: str | Path, option: str) -> None:
    """Refuse the name of a page that no browser would open as one.

    Raises:
        InputError: naming the option and the file.
    """
    if Path(file).suffix.lower() not in PAGES:
        raise OptionError(f"{option} {file}: the name must end in {' or '.join(PAGES)}")


def check_folder(option: str, folder: Path | None) -> None:
    """Refuse a folder for results that cannot be one, before work begins.

    Raises:
        InputError: naming option and path.
    """
    if folder is None:
        return
    with _asked(option, folder):
        there = _nearest(folder)
        if not there.is_dir():
            which = "" if there == folder else f"{there} "
            raise InputError(f"{option} {folder}: {which}is no folder; name another")
        _try(there)


def write_in(
    option: str,
    folder: Path,
    files: Mapping[Path, bytes],
    inputs: Iterable[Path],
    replace_existing: bool,
) -> list[Path]:
    """Write files into a folder, all or none; it is made, with those round it, if it is missing.

    Args:
        option: that names the folder.
        folder: where.
        files: contents by path in the folder.
        inputs, replace_existing: see `check_outputs`.

    Returns:
        The files.

    Raises:
        InputError: one of them must not or cannot be written; then none is.
    """
    check_folder(option, folder)
    planned = {folder / name: data for name, data in files.items()}
    check_outputs({option: planned}, inputs, replace_existing, folder)
    write_all(option, planned, folder)
    return list(planned)


def encoded(sources: Mapping[str, str]) -> dict[Path, bytes]:
    """Source files as `write_in` takes them."""
    return {Path(name): text.encode() for name, text in sources.items()}


def write_all(option: str, files: Mapping[Path, bytes], made: Path | None = None) -> None:
    """`write_files`, with what the user should know logged.

    Raises:
        InputError: naming the option.
    """
    from ...core.files.disk import WriteError
    from ...core.files.writing import write_files

    try:
        notes = write_files(files, made)
    except WriteError as error:
        raise InputError(f"{option} {error}") from None
    for note in notes:
        _log.warning(str(note))


def _nearest(path: Path) -> Path:
    """The path itself, or the nearest of the folders round it that is there."""
    return next(one for one in (path, *path.absolute().parents) if one.exists())


def _try(folder: Path) -> None:
    """Write a file without a name, which says more than permissions do: disks are full, or mounted
    to be read alone.

    Raises:
        OSError: nothing can be written there.
    """
    with tempfile.TemporaryFile(dir=_nearest(folder)):
        pass


@contextmanager
def _asked(option: str, path: Path) -> Iterator[None]:
    """Say which option's file it is that the system does not take.

    Raises:
        InputError: instead of the system's own error.
    """
    try:
        yield
    except OSError as error:
        reason = error.strerror or error
        raise InputError(f"{option} {path}: cannot be written: {reason}") from None
    except ValueError as error:  # a NUL in the name
        raise InputError(f"{option} {str(path)!r}: cannot be written: {error}") from None


def _real(path: Path) -> str:
    """One name for one file, links resolved."""
    try:
        return os.path.normcase(os.path.realpath(path))
    except ValueError as error:
        raise InputError(f"{str(path)!r}: is no name of a file: {error}") from None
