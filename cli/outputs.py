"""Output files: refused before any work is done, written whole or not at all."""

from __future__ import annotations

import os
from collections.abc import Iterable, Iterator, Mapping
from contextlib import contextmanager
from pathlib import Path

from ..core.errors import InputError


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
