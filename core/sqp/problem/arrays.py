"""Arrays of numbers from what callers and callables hand over."""

from __future__ import annotations

from typing import Any

import numpy as np
from scipy import sparse

from ...arrays import FloatArray
from .errors import NlpError

_REAL = "biuf"


def numbers(name: str, value: object) -> FloatArray:
    """``value`` as a new array of real numbers, whatever its shape.

    Raises:
        NlpError: it is something else (text, None, complex numbers, a sparse matrix, rows of
            different lengths); the message begins with ``name``.
    """
    if is_sparse(value):
        raise NlpError(f"{name}: expected a dense array, not a sparse one")
    try:
        array = np.asarray(value)
    except ValueError:
        raise NlpError(f"{name}: expected real numbers, not rows of different lengths") from None
    if array.dtype.kind == "O" and all(_is_real(entry) for entry in array.flat):
        return array.astype(np.float64)
    if array.dtype.kind not in _REAL:
        raise NlpError(f"{name}: expected real numbers, not {_described(value, array)}")
    return np.array(array, dtype=np.float64)


def vector(name: str, value: object, size: int) -> FloatArray:
    """``value`` as a new array (size,); a row or a column of a matrix serves too.

    Raises:
        NlpError: it is no array of real numbers, or has another shape.
    """
    if type(value) is np.ndarray and value.dtype == np.float64 and value.shape == (size,):
        return value.copy()  # what most give needs no further look
    array = numbers(name, value)
    if array.shape != (size,):
        if array.size != size or array.ndim > 2:
            raise NlpError(f"{name} gave shape {array.shape}, expected ({size},)")
        array = array.reshape(size)
    return array


def scalar(name: str, value: object) -> float:
    """``value`` as a number; an array of one entry serves too.

    Raises:
        NlpError: it is no real number.
    """
    if isinstance(value, float):
        return float(value)
    array = numbers(name, value)
    if array.size != 1:
        raise NlpError(f"{name} gave shape {array.shape}, expected one number")
    return float(array.reshape(()))


def matrix(name: str, value: object, shape: tuple[int, int]) -> FloatArray | sparse.csc_array:
    """``value`` as a new dense array or compressed columns, as it comes.

    Raises:
        NlpError: it is no matrix of real numbers, or has another shape.
    """
    if not is_sparse(value):
        array = numbers(name, value)
        if array.shape != shape:
            raise NlpError(f"{name} gave shape {array.shape}, expected {shape}")
        return array
    found: Any = value
    if found.shape != shape:
        raise NlpError(f"{name} gave shape {found.shape}, expected {shape}")
    if found.dtype.kind not in _REAL:
        raise NlpError(f"{name}: expected real numbers, not entries of type {found.dtype}")
    return sparse.csc_array(found, dtype=np.float64, copy=True)


def is_sparse(value: object) -> bool:
    """Whether it is one of SciPy's sparse matrices."""
    return isinstance(value, sparse.sparray | sparse.spmatrix)


def whole_number(name: str, value: object, least: int) -> int:
    """``value`` as an int of at least ``least``.

    Raises:
        NlpError: it is none.
    """
    if isinstance(value, bool) or not isinstance(value, int | np.integer) or value < least:
        raise NlpError(f"{name} is a whole number of at least {least}, not {value!r}")
    return int(value)


def _is_real(entry: object) -> bool:
    try:
        float(entry)  # type: ignore[arg-type]
    except (TypeError, ValueError):
        return False
    return not isinstance(entry, str | bytes)


def _described(value: object, array: np.ndarray) -> str:
    if array.ndim == 0 or array.dtype.kind == "O":
        return repr(value)
    return f"entries of type {array.dtype}"
