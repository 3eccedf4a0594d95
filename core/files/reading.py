"""Files that are read: every file of a user's comes in here, with a bound on what it may cost.

No more than so many bytes are read, only of regular files (a pipe or a device has no end), and no
deeper nesting, longer numbers or larger arrays are built from them than files of the kind have.
What an interrupted write has left beside a file is settled before the file is read.
"""

from __future__ import annotations

import json
import math
import os
import re
import stat
import tomllib
import zipfile
from collections.abc import Iterable
from pathlib import Path
from typing import Any, BinaryIO

from ..errors import InputError
from .recovery import recover

MOST_TOML_BYTES = 2_000_000
"""The largest that are written, motion models with their fits, have some 20 000."""
MOST_JSON_BYTES = 50_000_000
MOST_DEPTH = 30
"""Of tables and lists in one another."""
_MOST_DOTS = 100
"""In one dotted key; reading one takes time with the square of it."""
_LARGEST_INTEGER = 2**63
_LARGER = "holds an integer of more than 64 bits"
_STRIDE = 1_000_000


def read_bytes(path: str | Path, most: int) -> bytes:
    """A file's bytes.

    Args:
        path: the file.
        most: bytes that it may have.

    Raises:
        InputError: it cannot be read, is no regular file or larger.
    """
    path = Path(path)
    try:
        settle(path)
        # A pipe without a writer would hold up an ordinary open.
        descriptor = os.open(path, os.O_RDONLY | os.O_NONBLOCK | os.O_CLOEXEC)
        with open(descriptor, "rb") as file:
            state = os.fstat(descriptor)
            kind = state.st_mode
            if stat.S_ISDIR(kind):
                raise InputError(f"{path}: cannot be read: Is a directory")
            if not stat.S_ISREG(kind):
                raise InputError(
                    f"{path}: cannot be read: is no regular file but a pipe, a device or the "
                    "like; save what it gives as a file"
                )
            data = b"" if state.st_size > most else _all(file, state.st_size, most)
    except OSError as error:
        raise InputError(f"{_shown(path)}: cannot be read: {error.strerror or error}") from None
    except ValueError as error:  # a NUL in the name
        raise InputError(f"{str(path)!r}: cannot be read: {error}") from None
    if max(len(data), state.st_size) > most:
        raise InputError(
            f"{path}: is larger than {most:,} bytes, the most that is read of its kind"
        )
    return data


def settle(path: str | Path) -> None:
    """Have what an interrupted write has left beside a file, or in a folder, ended.

    Raises:
        InputError: see `recover`.
    """
    real = Path(os.path.realpath(path))
    for folder in (real, real.parent):
        recover(folder)


def _all(file: BinaryIO, size: int, most: int) -> bytes:
    """All that a file holds, or one byte more than the most; files of /proc tell no size."""
    parts, left = [], most + 1
    while left > 0 and (part := file.read(min(left, max(size, _STRIDE) + 1))):
        parts.append(part)
        left -= len(part)
    return b"".join(parts)


def read_text(path: str | Path, most: int) -> str:
    """A file's text, which is UTF-8; see `read_bytes`.

    Raises:
        InputError: it is not; or as `read_bytes`.
    """
    try:
        return read_bytes(path, most).decode("utf-8")
    except UnicodeDecodeError as error:
        raise InputError(f"{path}: cannot be read: is no UTF-8 text: {error}") from None


def read_toml(path: str | Path, largest: float = math.inf) -> dict[str, Any]:
    """The outermost table of a TOML file.

    Args:
        path: the file.
        largest: number that it may hold; what is not finite is left to who asks for it.

    Raises:
        InputError: it is no TOML, nests more than `MOST_DEPTH` deep, or holds an integer of more
            than 64 bits; or as `read_text`.
    """
    text = read_text(path, MOST_TOML_BYTES)
    for number, line in enumerate(text.split("\n"), 1):
        if line.count(".") > _MOST_DOTS and not line.lstrip().startswith("#"):
            dots = max(part.count(".") for part in re.split(r"[=,{}\[\]]", line))
            if dots > _MOST_DOTS:
                raise InputError(f"{path}:{number}: more than {_MOST_DOTS} dots in a key")
    try:
        data = tomllib.loads(text)
    except RecursionError:
        raise InputError(f"{path}: is nested more than {MOST_DEPTH} deep") from None
    except tomllib.TOMLDecodeError as error:
        raise InputError(f"{path}: is not TOML: {error}") from None
    except ValueError:  # Python's own bound on digits
        raise InputError(f"{path}: {_LARGER}") from None
    _check_values(data, path, largest)
    return data


def read_json(path: str | Path) -> Any:
    """What a JSON file holds.

    Raises:
        InputError: as `read_toml`.
    """
    text = read_text(path, MOST_JSON_BYTES)
    try:
        data = json.loads(text)
    except RecursionError:
        raise InputError(f"{path}: is nested more than {MOST_DEPTH} deep") from None
    except json.JSONDecodeError as error:
        raise InputError(f"{path}: is not JSON: {error}") from None
    except ValueError:
        raise InputError(f"{path}: {_LARGER}") from None
    _check_values(data, path)
    return data


def check_unpacked(path: Path, infos: Iterable[zipfile.ZipInfo], most: int) -> None:
    """Refuse an archive that grows beyond bounds when it is unpacked.

    Raises:
        InputError: its files are more than ``most`` bytes.
    """
    size = sum(info.file_size for info in infos)
    if size > most:
        raise InputError(f"{path}: unpacks to {size:,} bytes; at most {most:,} are read")


def _check_values(data: object, path: str | Path, largest: float = math.inf) -> None:
    """Refuse what no reader is prepared for; without recursion, whatever the depth."""
    pending = [(data, 1)]
    while pending:
        value, depth = pending.pop()
        if depth > MOST_DEPTH:
            raise InputError(f"{path}: is nested more than {MOST_DEPTH} deep")
        if isinstance(value, dict):
            pending += [(inner, depth + 1) for inner in value.values()]
        elif isinstance(value, list):
            pending += [(inner, depth + 1) for inner in value]
        elif isinstance(value, int) and not -_LARGEST_INTEGER <= value < _LARGEST_INTEGER:
            raise InputError(f"{path}: {_LARGER}")
        elif isinstance(value, float) and largest < abs(value) < math.inf:
            raise InputError(f"{path}: holds the number {value:g}; at most {largest:g} is taken")


def _shown(path: Path) -> str:
    """A name as messages show it; of a name too long for any file, its beginning."""
    text = str(path)
    return text if len(text) <= 300 else f"{text[:120]}… ({len(text)} characters)"
