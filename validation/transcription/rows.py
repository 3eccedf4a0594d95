"""Rows of the nonlinear program: blocks of constraints with exact, sparse derivatives."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Protocol

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ...core.arrays import FloatArray, IntArray

Places = tuple[IntArray, IntArray]


class Rows(Protocol):
    """A block of C constraints lower ≤ c(x) ≤ upper.

    Attributes:
        lower, upper: (C,).
        jacobian_places: rows (from 0 in this block) and columns (k,) of the Jacobian's values.
        hessian_places: rows and columns (h,) of the values of multipliers·∇²c; values at one place
            add up.
    """

    lower: FloatArray
    upper: FloatArray
    jacobian_places: Places
    hessian_places: Places

    def values(self, x: FloatArray) -> FloatArray:
        """c (C,)."""
        ...

    def slopes(self, x: FloatArray) -> FloatArray:
        """Values (k,) of the Jacobian."""
        ...

    def curvatures(self, x: FloatArray, multipliers: FloatArray) -> FloatArray:
        """Values (h,) of the Hessian of multipliers (C,)·c."""
        ...


class Quadratic:
    """Rows c = Σ f x_a x_b + Σ f x_a, collected term by term."""

    def __init__(self) -> None:
        self._count = 0
        self._lower: list[FloatArray] = []
        self._upper: list[FloatArray] = []
        self._linear: list[tuple[IntArray, IntArray, FloatArray]] = []
        self._products: list[tuple[IntArray, IntArray, IntArray, FloatArray]] = []

    def add(self, shape: int, lower: float, upper: float) -> IntArray:
        """``shape`` new rows (shape,) without terms."""
        rows = np.arange(self._count, self._count + shape)
        self._count += shape
        self._lower.append(np.full(shape, lower))
        self._upper.append(np.full(shape, upper))
        return rows

    def linear(self, rows: IntArray, a: ArrayLike, factor: ArrayLike) -> None:
        """Add factor x_a to rows; all broadcast."""
        row, first, f = np.broadcast_arrays(rows, a, factor)
        self._linear.append((row.ravel(), first.ravel(), f.ravel().astype(np.float64)))

    def product(self, rows: IntArray, a: ArrayLike, b: ArrayLike, factor: ArrayLike) -> None:
        """Add factor x_a x_b to rows; all broadcast."""
        row, first, second, f = np.broadcast_arrays(rows, a, b, factor)
        self._products.append(
            (row.ravel(), first.ravel(), second.ravel(), f.ravel().astype(np.float64))
        )

    def distance(self, rows: IntArray, a: IntArray, b: IntArray) -> None:
        """Add Σⱼ (x_aⱼ − x_bⱼ)² to rows (C,), of index arrays (C, k)."""
        for first, second, factor in ((a, a, 1.0), (b, b, 1.0), (a, b, -2.0)):
            self.product(rows[:, None], first, second, factor)

    def finish(self) -> Rows:
        """The block."""
        return _Quadratic(
            np.concatenate(self._lower),
            np.concatenate(self._upper),
            _joined(self._linear, 3),
            _joined(self._products, 4),
        )


def _joined(parts: Sequence[tuple[NDArray[np.generic], ...]], width: int) -> tuple[NDArray, ...]:  # type: ignore[type-arg]
    return tuple(np.concatenate([part[k] for part in parts]) for k in range(width))


class _Quadratic:
    def __init__(
        self,
        lower: FloatArray,
        upper: FloatArray,
        linear: tuple[NDArray, ...],  # type: ignore[type-arg]
        products: tuple[NDArray, ...],  # type: ignore[type-arg]
    ) -> None:
        self.lower, self.upper = lower, upper
        self._row, self._at, self._factor = linear
        self._rows, self._a, self._b, self._factors = products
        self.jacobian_places = (
            np.concatenate([self._row, self._rows, self._rows]),
            np.concatenate([self._at, self._a, self._b]),
        )
        self.hessian_places = (
            np.concatenate([self._a, self._b]),
            np.concatenate([self._b, self._a]),
        )

    def values(self, x: FloatArray) -> FloatArray:
        """See `Rows`."""
        count = len(self.lower)
        products = self._factors * x[self._a] * x[self._b]
        return np.asarray(
            np.bincount(self._row, self._factor * x[self._at], count)
            + np.bincount(self._rows, products, count)
        )

    def slopes(self, x: FloatArray) -> FloatArray:
        """See `Rows`."""
        return np.concatenate(
            [self._factor, self._factors * x[self._b], self._factors * x[self._a]]
        )

    def curvatures(self, x: FloatArray, multipliers: FloatArray) -> FloatArray:
        """See `Rows`."""
        values = self._factors * multipliers[self._rows]
        return np.concatenate([values, values])


class SpeedMatch:
    """Where a line meets a blend, both drive at one speed (equation 5, see `grids`).

        (ℓ − r_A − r_B) w_L / t_L − k r w_S / t_S = 0,     w = ṡ t

    Args:
        length, cuts: (C,), (C, 2) indices of the line's leg.
        near: (C,) index of the blend's own cut, one of ``cuts``.
        line, blend: (C, 2) indices of w and t on either side.
        slope: (C,) k, |q′|/r of the blend at that end.
    """

    def __init__(
        self,
        length: IntArray,
        cuts: IntArray,
        near: IntArray,
        line: IntArray,
        blend: IntArray,
        slope: FloatArray,
    ) -> None:
        count = len(length)
        self.lower = self.upper = np.zeros(count)
        self._at = np.column_stack([length, cuts, line, near, blend])
        self._slope = slope
        width = self._at.shape[1]
        self.jacobian_places = (np.repeat(np.arange(count), width), self._at.ravel())
        self.hessian_places = (
            np.repeat(self._at, width, axis=1).ravel(),
            np.tile(self._at, (1, width)).ravel(),
        )

    def values(self, x: FloatArray) -> FloatArray:
        """See `Rows`."""
        length, behind, ahead, w, t, near, v, u = x[self._at].T
        return np.asarray((length - behind - ahead) * w / t - self._slope * near * v / u)

    def slopes(self, x: FloatArray) -> FloatArray:
        """See `Rows`."""
        length, behind, ahead, w, t, near, v, u = x[self._at].T
        free = length - behind - ahead
        k = self._slope
        columns = (
            *(w / t, -w / t, -w / t, free / t, -free * w / t**2),
            *(-k * v / u, -k * near / u, k * near * v / u**2),
        )
        return np.stack(columns, axis=1).ravel()

    def curvatures(self, x: FloatArray, multipliers: FloatArray) -> FloatArray:
        """See `Rows`."""
        length, behind, ahead, w, t, near, v, u = x[self._at].T
        free, k = length - behind - ahead, self._slope
        H = np.zeros((len(w), 8, 8))
        for j, sign in enumerate((1.0, -1.0, -1.0)):
            H[:, j, 3], H[:, j, 4] = sign / t, -sign * w / t**2
        H[:, 3, 4] = -free / t**2
        H[:, 5, 6], H[:, 5, 7], H[:, 6, 7] = -k / u, k * v / u**2, k * near / u**2
        H += np.swapaxes(H, 1, 2)
        H[:, 4, 4], H[:, 7, 7] = 2.0 * free * w / t**3, -2.0 * k * near * v / u**3
        return np.asarray((multipliers[:, None, None] * H).ravel())
