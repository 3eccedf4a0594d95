"""Files of arrays, as NumPy saves them: read within bounds, and without what they could run."""

from __future__ import annotations

import io
import zipfile
import zlib
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np
from numpy.lib import format as npy
from numpy.typing import NDArray

from ..errors import InputError
from .reading import check_unpacked, read_bytes

_NUMERIC = "fiu"


def read_npz(
    path: str | Path, names: Sequence[str], most: int, further: Sequence[Sequence[str]] = ()
) -> dict[str, NDArray[Any]]:
    """Arrays of numbers out of a file of NumPy's.

    Args:
        path: the file.
        names: of the arrays.
        most: bytes that they may have together, and the file.
        further: groups of arrays of which all are there, or none.

    Raises:
        InputError: the file is damaged or lacks one; an array holds no numbers, claims more of
            them than the file has, or makes the bytes too many; or as `read_bytes`.
    """
    path = Path(path)
    data = read_bytes(path, most)
    try:
        with zipfile.ZipFile(io.BytesIO(data)) as archive:
            held = {info.filename.removesuffix(".npy"): info for info in archive.infolist()}
            for group in further:
                if any(name in held for name in group):
                    names = (*names, *group)
            missing = [name for name in names if name not in held]
            if missing:
                raise InputError(f"{path}: there is no {', '.join(missing)}")
            infos = [held[name] for name in names]
            check_unpacked(path, infos, most)
            return {
                name: _array(path, name, archive, info)
                for name, info in zip(names, infos, strict=True)
            }
    except (ValueError, EOFError, OSError, NotImplementedError, RuntimeError) as error:
        raise InputError(f"{path}: is no file of NumPy's arrays, or damaged: {error}") from None
    except (zipfile.BadZipFile, zlib.error) as error:
        raise InputError(f"{path}: is no file of NumPy's arrays, or damaged: {error}") from None


def _array(path: Path, name: str, archive: zipfile.ZipFile, info: zipfile.ZipInfo) -> NDArray[Any]:
    with archive.open(info) as file:
        version = npy.read_magic(file)
        read = npy.read_array_header_1_0 if version == (1, 0) else npy.read_array_header_2_0
        shape, fortran, dtype = read(file)
        if dtype.kind not in _NUMERIC:
            raise InputError(f"{path}: {name} holds {dtype}, not numbers")
        size = dtype.itemsize
        for length in shape:
            size *= length
        data = file.read()
    if size != len(data):
        raise InputError(f"{path}: {name} is to have {size:,} bytes, the file has {len(data):,}")
    return np.frombuffer(data, dtype).reshape(shape, order="F" if fortran else "C").copy()
