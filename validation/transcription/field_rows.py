"""Rows on where the robot is: functions of q(s) at nodes or of the points themselves."""

from __future__ import annotations

from typing import Protocol

import numpy as np

from ...core.arrays import FloatArray, IntArray
from .curves import Weights


class Field(Protocol):
    """K functions of the joints that move.

    Attributes:
        size: K.
    """

    @property
    def size(self) -> int:
        """K."""
        ...

    def values(self, q: FloatArray) -> FloatArray:
        """(R, K) at q (R, n)."""
        ...

    def jacobian(self, q: FloatArray) -> FloatArray:
        """(R, K, n)."""
        ...

    def hessian(self, q: FloatArray, multipliers: FloatArray) -> FloatArray:
        """(R, n, n) of Σ_k multipliers[:, k] F_k, multipliers (R, K)."""
        ...


class ConfigurationRows(Protocol):
    """Configurations q = Σ_p P_p c_p(θ) (R,).

    Attributes:
        points: (R, p, n) indices of the points' joint values.
        theta: (R, E) indices of θ.
    """

    @property
    def points(self) -> IntArray:
        """(R, p, n)."""
        ...

    @property
    def theta(self) -> IntArray:
        """(R, E)."""
        ...

    def at(self, x: FloatArray, order: int) -> Weights:
        """The weights, for ``order`` 0."""
        ...


class AtPoints:
    """The points themselves: c = 1, without θ.

    Args:
        points: (R, n) indices of their joint values.
    """

    def __init__(self, points: IntArray) -> None:
        self.points = points[:, None]
        self.theta = np.zeros((len(points), 0), dtype=np.int64)

    def at(self, x: FloatArray, order: int) -> Weights:
        """See `ConfigurationRows`."""
        rows = len(self.points)
        return Weights(np.ones((rows, 1)), np.zeros((rows, 1, 0)), np.zeros((rows, 1, 0, 0)))


class FieldRows:
    """Rows lower ≤ F(q) − x[subtracted] ≤ upper.

    Args:
        places: where (R).
        field: F.
        lower, upper: of every row.
        subtracted: (R, K) indices of variables, None for no such term.
    """

    def __init__(
        self,
        places: ConfigurationRows,
        field: Field,
        lower: float,
        upper: float,
        subtracted: IntArray | None = None,
    ) -> None:
        self._places, self._field, self._subtracted = places, field, subtracted
        rows = len(places.points)
        count = rows * field.size
        self.lower, self.upper = np.full(count, lower), np.full(count, upper)
        columns = np.concatenate([places.points.reshape(rows, -1), places.theta], axis=1)
        every = np.repeat(columns[:, None], field.size, axis=1).ravel()
        owner = np.repeat(np.arange(count), columns.shape[1])
        if subtracted is not None:
            owner = np.concatenate([owner, np.arange(count)])
            every = np.concatenate([every, subtracted.ravel()])
        self.jacobian_places = owner, every
        size = columns.shape[1]
        self.hessian_places = (
            np.repeat(columns, size, axis=1).ravel(),
            np.tile(columns, (1, size)).ravel(),
        )

    def configurations(self, x: FloatArray) -> FloatArray:
        """q (R, n)."""
        weights = self._places.at(x, 0).value
        return np.asarray(np.einsum("rpj,rp->rj", x[self._places.points], weights))

    def values(self, x: FloatArray) -> FloatArray:
        """See `Rows`."""
        found = self._field.values(self.configurations(x)).ravel()
        return found if self._subtracted is None else found - x[self._subtracted].ravel()

    def slopes(self, x: FloatArray) -> FloatArray:
        """See `Rows`."""
        J = self._field.jacobian(self.configurations(x))
        found = (J @ self._spread(x)).ravel()
        if self._subtracted is None:
            return np.asarray(found)
        return np.concatenate([found, np.full(self._subtracted.size, -1.0)])

    def curvatures(self, x: FloatArray, multipliers: FloatArray) -> FloatArray:
        """See `Rows`."""
        P, q = x[self._places.points], self.configurations(x)
        rows, p, n = P.shape
        mu = multipliers.reshape(rows, self._field.size)
        spread = self._spread(x)
        H = np.swapaxes(spread, 1, 2) @ self._field.hessian(q, mu) @ spread
        if self._places.theta.shape[1]:
            weights = self._places.at(x, 0)
            g = np.einsum("rk,rkj->rj", mu, self._field.jacobian(q))
            mixed = (g[:, None, :, None] * weights.slope[:, :, None]).reshape(rows, p * n, -1)
            H[:, : p * n, p * n :] += mixed
            H[:, p * n :, : p * n] += np.swapaxes(mixed, 1, 2)
            pulls = np.einsum("rpj,rj->rp", P, g)
            H[:, p * n :, p * n :] += np.einsum("rp,rpab->rab", pulls, weights.curvature)
        return np.asarray(H.ravel())

    def _spread(self, x: FloatArray) -> FloatArray:
        """∂q/∂(P, θ), (R, n, p n + E)."""
        P = x[self._places.points]
        rows, p, n = P.shape
        weights = self._places.at(x, 0)
        by_points = weights.value[:, None, :, None] * np.eye(n)[:, None]
        by_theta = np.einsum("rpj,rpa->rja", P, weights.slope)
        return np.concatenate([by_points.reshape(rows, n, p * n), by_theta], axis=2)
