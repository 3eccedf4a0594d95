"""A motion as polynomials: one for each joint and interval."""

from __future__ import annotations

from dataclasses import dataclass
from math import comb

import numpy as np

from .....core.arrays import FloatArray, IntArray
from .layout import VariableLayout


@dataclass(frozen=True)
class Motion:
    """K pieces in time.

    Args:
        knots: (K + 1,) s, from 0.
        coefficients: (K, C, n), of q by rising powers of the share u of the piece, 0 to 1.
        leg: (K,), the leg between waypoints.
    """

    knots: FloatArray
    coefficients: FloatArray
    leg: IntArray

    @classmethod
    def of(cls, layout: VariableLayout, scale: float, x: FloatArray) -> Motion:
        """The motion that variables describe, time in units of ``scale`` s."""
        width = layout.width(x)
        e = x[layout.e][layout.rise]
        rising = np.einsum("ic,kin->kcn", layout.scheme.position, e)
        coefficients = width[:, None, None] ** 2 * rising
        coefficients[:, 0] += x[layout.q][layout.first]
        coefficients[:, 1] += width[:, None] * x[layout.d][layout.first]
        knots = np.concatenate([[0.0], np.cumsum(width)]) * scale * np.sqrt(x[0])
        return cls(knots, coefficients, layout.grid.leg)

    def __len__(self) -> int:
        return len(self.leg)

    @property
    def duration(self) -> float:
        """s."""
        return float(self.knots[-1])

    @property
    def durations(self) -> FloatArray:
        """(K,) s, of the pieces."""
        return np.diff(self.knots)

    def on_pieces(self, shares: FloatArray, derivative: int = 0) -> FloatArray:
        """(K, U, n), q or a derivative by time at shares (U,) of every piece."""
        coefficients = self.differentiated(derivative)
        powers = shares[:, None] ** np.arange(coefficients.shape[1])
        return np.asarray(np.einsum("uc,kcn->kun", powers, coefficients))

    def differentiated(self, times: int) -> FloatArray:
        """(K, C − times, n), coefficients of a derivative by time; one row at least."""
        found = self.coefficients
        for _ in range(times):
            if found.shape[1] == 1:
                return np.zeros_like(found)
            powers = np.arange(1, found.shape[1])[:, None]
            found = powers * found[:, 1:] / self.durations[:, None, None]
        return found

    def at(self, t: FloatArray, derivative: int = 0) -> FloatArray:
        """(T, n), q or a derivative by time at times (T,); at knots, of the piece that begins."""
        piece = self.pieces(t)
        u = (t - self.knots[piece]) / self.durations[piece]
        coefficients = self.differentiated(derivative)[piece]
        powers = u[:, None] ** np.arange(coefficients.shape[1])
        return np.asarray(np.einsum("tc,tcn->tn", powers, coefficients))

    def pieces(self, t: FloatArray) -> IntArray:
        """(T,), the piece at times (T,)."""
        return np.clip(np.searchsorted(self.knots, t, side="right") - 1, 0, len(self) - 1)

    def reversed(self) -> Motion:
        """The motion driven backwards."""
        count = self.coefficients.shape[1]
        table = np.array(
            [
                [comb(j, i) * (-1.0) ** i if j >= i else 0.0 for j in range(count)]
                for i in range(count)
            ]
        )
        turned = np.einsum("ij,kjn->kin", table, self.coefficients)[::-1]
        return Motion(self.duration - self.knots[::-1], turned, self.leg[-1] - self.leg[::-1])
