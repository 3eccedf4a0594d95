"""Output files: refused before any of them is written, written whole or not at all."""

from __future__ import annotations

import os
from collections.abc import Iterable, Iterator, Mapping
from contextlib import contextmanager
from pathlib import Path

from ..core.errors import InputError

PLOT_FORMATS = (".png", ".pdf", ".svg")


def check_outputs(
    outputs: Mapping[str, Path | None], inputs: Iterable[Path], replace_existing: bool
) -> None:
    """Refuse output paths that cannot or must not be written.

    Args:
        outputs: by the option that names each; None where the option was not given.
        inputs: files that are read; they are never written to.
        replace_existing: whether files that exist may be replaced (``--force``).

    Raises:
        InputError: naming option and path.
    """
    taken = {_real(path): str(path) for path in inputs}
    for option, path in outputs.items():
        if path is None:
            continue
        real = _real(path)
        if real in taken:
            raise InputError(f"{option} {path}: would overwrite {taken[real]}; choose another name")
        taken[real] = f"the file of {option}"
        if path.exists() and not path.is_file():
            raise InputError(f"{option} {path}: is no regular file; name another")
        if not path.parent.is_dir():
            raise InputError(f"{option} {path}: there is no folder {path.parent}")
        if path.exists() and not replace_existing:
            raise InputError(f"{option} {path}: exists already; --force replaces it")


def check_plot_name(plot: Path | None) -> None:
    """Refuse a drawing in a form that cannot be drawn.

    Raises:
        InputError: naming the path that ``--plot`` gives.
    """
    if plot is not None and plot.suffix.lower() not in PLOT_FORMATS:
        raise InputError(f"--plot {plot}: the name must end in {', '.join(PLOT_FORMATS)}")


def check_folder(option: str, folder: Path | None) -> None:
    """Refuse a folder for results that cannot be one, before work begins.

    Raises:
        InputError: naming option and path.
    """
    if folder is None:
        return
    if folder.exists() and not folder.is_dir():
        raise InputError(f"{option} {folder}: is no folder; name another")
    if not folder.absolute().parent.is_dir():
        raise InputError(f"{option} {folder}: there is no folder {folder.parent}")


def write_sources(
    option: str,
    folder: Path,
    sources: Mapping[str, str],
    inputs: Iterable[Path],
    replace_existing: bool,
) -> list[Path]:
    """Write source files into a folder, which is made if it is missing.

    Args:
        option: that names the folder.
        folder: where.
        sources: texts by file name.
        inputs, replace_existing: see `check_outputs`.

    Returns:
        The files.

    Raises:
        InputError: one of them must not be written; then none is.
    """
    from ..core.motion.trajectory import write_whole

    check_folder(option, folder)
    paths = [folder / name for name in sources]
    with writing(option, folder):
        folder.mkdir(exist_ok=True)
    check_outputs({f"{option}: {path.name}": path for path in paths}, inputs, replace_existing)
    for path, text in zip(paths, sources.values(), strict=True):
        with writing(option, path):
            write_whole(path, text.encode())
    return paths


@contextmanager
def writing(option: str, path: Path) -> Iterator[None]:
    """Say which option's file it is that cannot be written.

    Raises:
        InputError: instead of the system's own error.
    """
    try:
        yield
    except OSError as error:
        reason = error.strerror or error
        raise InputError(f"{option} {path}: cannot be written: {reason}") from None


def _real(path: Path) -> str:
    """One name for one file, links resolved."""
    return os.path.normcase(os.path.realpath(path))
