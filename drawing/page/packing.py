"""Arrays of a page in few bytes: whole steps, their differences, planes of bytes, deflated."""

from __future__ import annotations

import base64
import dataclasses
import json
import math
import zlib
from collections.abc import Mapping, Sequence
from enum import StrEnum
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ...core.arrays import FloatArray
from ...core.display import shown
from ...core.errors import InputError

_LARGEST = 2**31 - 1
"""Of a whole number of steps, and of the differences of such: 4 bytes."""
_ORDERS = (0, 1, 2)
"""How often differences may be taken."""


@dataclasses.dataclass(frozen=True, eq=False)
class Quantised:
    """Numbers of which the page has no more than the nearest whole steps.

    Args:
        values: (n,) or (n, k); those that are not finite are left out.
        step: of them; errors are half of it.
    """

    values: FloatArray
    step: float


def whole(values: Any) -> Quantised:
    """Whole numbers, kept as they are."""
    return Quantised(np.asarray(values, dtype=float), 1.0)


class Packer:
    """Packs values for a page: JSON, and beside it all arrays in one text.

    What is packed as JSON is a tree of dataclasses, mappings, sequences, texts and numbers; fields
    that hold their default are left out.
    """

    def __init__(self) -> None:
        self._chunks: list[bytes] = []
        self._size = 0

    def json(self, value: Any) -> str:
        """A value as JSON that may stand in a script element: it holds no ``<``."""
        text = json.dumps(self._plain(value), ensure_ascii=False, allow_nan=False)
        return text.replace("<", "\\u003c")

    def arrays(self) -> str:
        """All arrays that were met so far: deflated, base64."""
        return base64.b64encode(zlib.compress(b"".join(self._chunks), 9)).decode()

    def _plain(self, value: Any) -> Any:
        if isinstance(value, Quantised):
            return self._columns(value)
        if isinstance(value, StrEnum):
            return str(value)
        if dataclasses.is_dataclass(value) and not isinstance(value, type):
            return self._fields(value)
        if isinstance(value, str):
            return shown(value)
        if isinstance(value, bool | int | None):
            return value
        if isinstance(value, float):
            return float(f"{value:.12g}") if math.isfinite(value) else None
        if isinstance(value, np.ndarray):
            return [self._plain(float(one)) for one in value.ravel()]
        if isinstance(value, Mapping):
            return {shown(str(key)): self._plain(one) for key, one in value.items()}
        if isinstance(value, Sequence):
            return [self._plain(one) for one in value]
        raise TypeError(f"a page holds no {type(value).__name__}")

    def _fields(self, value: Any) -> dict[str, Any]:
        made = {}
        for f in dataclasses.fields(value):
            one = getattr(value, f.name)
            usual = f.default
            if one is None or (isinstance(one, str | int | float | tuple) and one == usual):
                continue
            made[f.name] = self._plain(one)
        return made

    def _columns(self, column: Quantised) -> dict[str, Any]:
        values = np.asarray(column.values, dtype=float)
        columns = values[:, None] if values.ndim == 1 else values
        parts = [self._column(one, column.step) for one in columns.T]
        if values.ndim == 1:
            return parts[0]
        return {"n": len(values), "columns": parts}

    def _column(self, values: FloatArray, step: float) -> dict[str, Any]:
        finite = np.isfinite(values)
        offset = float(values[finite].min()) if finite.any() else 0.0
        filled = values if finite.all() else _filled(values, finite, offset)
        steps = np.rint((filled - offset) / step)
        if len(steps) and steps.max() > _LARGEST:
            raise InputError(f"numbers up to {steps.max() * step:g} do not fit steps of {step:g}")
        order, stored = _least(steps.astype(np.int64))
        width = max(1, (int(stored.max(initial=0)).bit_length() + 7) // 8)
        planes = [(stored >> (8 * k)).astype(np.uint8).tobytes() for k in range(width)]
        made: dict[str, Any] = {"at": self._size, "n": len(values), "w": width}
        made |= {"d": order, "s": step} | ({"o": offset} if offset else {})
        if not finite.all():
            made["gaps"] = _runs(~finite)
        self._chunks += planes
        self._size += width * len(values)
        return made


def _filled(values: FloatArray, finite: NDArray[np.bool_], start: float) -> FloatArray:
    """Values with the last finite one in the place of each that is not."""
    last = np.maximum.accumulate(np.where(finite, np.arange(len(values)), -1))
    return np.where(last < 0, start, values[np.maximum(last, 0)])


def _least(steps: NDArray[np.int64]) -> tuple[int, NDArray[np.int64]]:
    """The order of differences that takes least room, and these, the signs in the lowest bit."""
    best: tuple[float, int, NDArray[np.int64]] | None = None
    taken = steps
    for order in _ORDERS:
        if order:
            taken = np.diff(taken, prepend=0)
        signed = np.where(taken < 0, -2 * taken - 1, 2 * taken)
        if signed.max(initial=0) > 2 * _LARGEST:
            break
        room = float(np.log2(1.0 + signed).sum())
        if best is None or room < best[0]:
            best = room, order, signed
    assert best is not None
    return best[1], best[2]


def _runs(mask: NDArray[np.bool_]) -> list[list[int]]:
    """First and one past the last index of each run of true values."""
    edges = np.flatnonzero(np.diff(np.concatenate([[0], mask.astype(np.int8), [0]])))
    return [list(map(int, pair)) for pair in edges.reshape(-1, 2)]
