"""The family of curves that replaces the corner inside a zone.

Inside a zone, with s from 0 to 1 (thesis, section 4.1; design family of "Controller Light"),

    x(s) = x₁(s) + α(s) (x₂(s) − x₁(s)) + β(s) u,    β(s) = s² (1 − s)² Σ βᵢ sⁱ,

where the leg x₁ runs on from the zone's entry to the waypoint, x₂ from the waypoint to the
exit and u = (x_exit − x_wp) − (x_wp − x_entry). With E and X the legs' tangents at the edges
times the legs' lengths this is

    x(s) = e + E f(s) + X g(s) + c h(s) + K₁ k₁(s) + K₂ k₂(s),
    f = s + α (1 − s) − β,   g = s α + β,

exact for straight legs (c = K = 0). On curved legs c = x_exit − e − E − X closes the gap
between the two tangents. Where α' vanishes at both ends h = α and the legs' curvatures enter
by k₁ = s² (1 − α) / 2, k₂ = (1 − s)² α / 2, so that the blend meets its legs to second order;
where it does not, h = 3s² − 2s³ and K = 0, so that the edge is not bent.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import Literal

import numpy as np
from numpy.polynomial import polynomial as P

from ...arrays import FloatArray
from ...errors import InputError
from .figures import FitRange, Stage, check_figures, figure
from .kinds import Choice, Row

BASIS = 6
"""Control vectors of a blend: e, E, X, c, K₁, K₂."""
_SMOOTHSTEP = np.array([0.0, 0.0, 3.0, -2.0])
_BUMP = np.array([0.0, 0.0, 1.0, -2.0, 1.0])
HERMITE = np.array(
    [
        [1.0, 0.0, 0.0, 0.0, 0.0, 0.0],
        [0.0, 1.0, 0.0, -6.0, 8.0, -3.0],
        [0.0, 0.0, 0.0, -4.0, 7.0, -3.0],
        [0.0, 0.0, 0.0, 10.0, -15.0, 6.0],
        [0.0, 0.0, 0.5, -1.5, 1.5, -0.5],
        [0.0, 0.0, 0.0, 0.5, -1.0, 0.5],
    ]
)
"""Power-basis coefficients (6, 6) of a quintic: of its first value, its first derivatives at 0 and
1, what it changes by, and its second derivatives at 0 and 1."""


@dataclass(frozen=True)
class Blend:
    """One blend law.

    Raises:
        InputError: α does not run from 0 to 1, or a leg would be driven backwards at its edge.
    """

    kind: Literal["polynomial", "arc", "quintic"] = figure(
        "kind",
        Choice(("polynomial", "arc", "quintic")),
        Stage.PATH,
        "polynomial; the circle tangent to both legs (positions on straight legs only); or the "
        "quintic in time that meets both legs (corners of joint moves with programmed speeds and "
        "accelerations only); everything else then follows the polynomial",
        default="polynomial",
        always=True,
    )
    alpha: tuple[float, ...] = figure(
        "alpha",
        Row(per="power of s"),
        Stage.PATH,
        "coefficients of α by rising powers of s, α(0) = 0 and α(1) = 1",
        unit="1",
        default=(0.0, 1.0),
        always=True,
    )
    beta: tuple[float, ...] = figure(
        "beta",
        Row(per="power of s"),
        Stage.PATH,
        "coefficients of the polynomial that multiplies s² (1 − s)²",
        unit="1",
        default=(),
        always=True,
        fit=FitRange(-8.0, 8.0, 0.5),
    )

    def __post_init__(self) -> None:
        check_figures(self, "blend.")
        if not self.alpha or self.alpha[0] != 0 or abs(sum(self.alpha) - 1) > 1e-9:
            raise InputError(f"α must run from 0 to 1, but its coefficients are {self.alpha}")
        if min(self.entry_slope, self.exit_slope) <= 0:
            raise InputError(f"α' below −1 at an end drives the leg backwards: {self.alpha}")
        if self.kind == "quintic" and (self.alpha != (0.0, 1.0) or any(self.beta)):
            raise InputError("a quintic blend has the parabola beside it: α = s, and no β")

    @cached_property
    def entry_slope(self) -> float:
        """f'(0) = 1 + α'(0): how fast the entry leg is left, per s."""
        return 1.0 + (self.alpha[1] if len(self.alpha) > 1 else 0.0)

    @cached_property
    def exit_slope(self) -> float:
        """g'(1) = 1 + α'(1)."""
        return 1.0 + sum(i * a for i, a in enumerate(self.alpha))

    @cached_property
    def meets_curvature(self) -> bool:
        """Whether the legs' curvatures enter (α' vanishes at both ends)."""
        return abs(self.entry_slope - 1.0) < 1e-12 and abs(self.exit_slope - 1.0) < 1e-12

    @cached_property
    def coefficients(self) -> FloatArray:
        """Power-basis coefficients (6, D) of 1, f, g, h, k₁, k₂."""
        alpha = np.array(self.alpha)
        beta = P.polymul(_BUMP, np.array(self.beta)) if self.beta else np.zeros(1)
        one_minus_s = np.array([1.0, -1.0])
        f = P.polysub(P.polyadd([0.0, 1.0], P.polymul(alpha, one_minus_s)), beta)
        g = P.polyadd(P.polymul([0.0, 1.0], alpha), beta)
        h = alpha if self.meets_curvature else _SMOOTHSTEP
        k1 = P.polymul([0.0, 0.0, 0.5], P.polysub([1.0], alpha))
        k2 = P.polymul(P.polymul(one_minus_s, one_minus_s) / 2, alpha)
        rows = [np.ones(1), f, g, h, k1, k2]
        # As wide as the laws' own lengths ask for: a coefficient that is zero has its column too.
        width = max(4, len(self.alpha) + 2, len(self.beta) + len(_BUMP) - 1)
        table = np.zeros((BASIS, width))
        for row, polynomial in zip(table, rows, strict=True):
            row[: len(polynomial)] = polynomial
        return table

    def slopes(self, count: int) -> FloatArray:
        """(count, 2), how fast so many blends leave their entry legs and join their exit legs."""
        return np.tile(np.array([self.entry_slope, self.exit_slope]), (count, 1))

    @property
    def flat(self) -> bool:
        """Whether α' vanishes at both ends, and the law is followed."""
        return self.kind == "polynomial" and self.meets_curvature

    def pull_coefficients(self, gradient: FloatArray) -> tuple[FloatArray, FloatArray]:
        """The gradient (6, D) of `coefficients`, carried back to ``alpha`` and ``beta``."""
        to_alpha, to_beta = self._pulls
        flat = gradient.ravel()
        return to_alpha @ flat, to_beta @ flat

    @cached_property
    def _pulls(self) -> tuple[FloatArray, FloatArray]:
        """The derivative of `coefficients`, flat, with respect to ``alpha`` and ``beta``."""
        size = self.coefficients.shape[1]
        alpha = np.zeros((len(self.alpha), BASIS, size))
        beta = np.zeros((len(self.beta), BASIS, size))

        def add(row: FloatArray, factor: FloatArray, power: int) -> None:
            part = factor[: max(size - power, 0)]
            row[power : power + len(part)] += part

        for i, table in enumerate(alpha):
            add(table[1], np.array([1.0, -1.0]), i)
            add(table[2], np.array([0.0, 1.0]), i)
            if self.meets_curvature:
                add(table[3], np.ones(1), i)
                add(table[4], np.array([0.0, 0.0, -0.5]), i)
                add(table[5], np.array([0.5, -1.0, 0.5]), i)
        for i, table in enumerate(beta):
            add(table[1], -_BUMP, i)
            add(table[2], _BUMP, i)
        return alpha.reshape(len(alpha), BASIS * size), beta.reshape(len(beta), BASIS * size)


@dataclass
class BlendGradient:
    """Gradient with respect to a blend's numbers: basis coefficients (6, C) and slopes (2,)."""

    coefficients: FloatArray
    slopes: FloatArray

    @classmethod
    def zeros(cls, blend: Blend) -> BlendGradient:
        """A gradient to add to."""
        return cls(np.zeros_like(blend.coefficients), np.zeros(2))

    def alpha_beta(self, blend: Blend) -> tuple[FloatArray, FloatArray]:
        """The gradient of the coefficients of α and β."""
        if not (self.coefficients.any() or self.slopes.any()):
            return np.zeros(len(blend.alpha)), np.zeros(len(blend.beta))
        alpha, beta = blend.pull_coefficients(self.coefficients)
        powers = np.arange(len(alpha))
        return alpha + self.slopes[0] * (powers == 1) + self.slopes[1] * powers, beta


PARABOLA = Blend()
TANGENT_ARC = Blend(kind="arc")
