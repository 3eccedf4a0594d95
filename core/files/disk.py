"""Single steps on the disk that the writing of files is made of."""

from __future__ import annotations

import contextlib
import errno
import hashlib
import os
import stat
from collections.abc import Iterator
from pathlib import Path

from ..errors import InputError


class WriteError(InputError):
    """A file cannot be written; then none of its set is.

    Args:
        path: the file.
        reason: why not.
    """

    def __init__(self, path: Path, reason: str) -> None:
        super().__init__(f"{path}: cannot be written: {reason}")


@contextlib.contextmanager
def blaming(path: Path) -> Iterator[None]:
    """Say which file it is that cannot be written."""
    try:
        yield
    except OSError as error:
        raise WriteError(path, error.strerror or str(error)) from None


def there(path: Path) -> bool:
    """Whether a name stands for anything; where the disk cannot tell, neither can this."""
    try:
        os.lstat(path)
    except (FileNotFoundError, NotADirectoryError):
        return False
    return True


def digest(path: Path) -> str | None:
    """Of a file's content; None if there is none, nothing if it is no file."""
    try:
        if not stat.S_ISREG(os.lstat(path).st_mode):
            return ""
        with open(path, "rb") as file:
            return hashlib.file_digest(file, "sha256").hexdigest()
    except FileNotFoundError:
        return None


def write_new(path: Path, data: bytes) -> None:
    """A file that must not be there yet, on the disk when this returns."""
    with open(path, "xb") as file:
        file.write(data)
        file.flush()
        os.fsync(file.fileno())


def open_folder(folder: Path) -> int:
    """A descriptor of a folder."""
    return os.open(folder, os.O_RDONLY | os.O_DIRECTORY)


def sync(folder: Path) -> None:
    """Have what happened in a folder on the disk, where the file system can say so of folders."""
    try:
        descriptor = open_folder(folder)
    except PermissionError:  # a folder to write in, not to be listed
        return
    try:
        os.fsync(descriptor)
    except OSError as error:
        if error.errno not in (errno.EINVAL, errno.ENOTSUP):
            raise
    finally:
        os.close(descriptor)
