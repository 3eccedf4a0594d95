"""A footprint from measured cross sections of straight strokes.

A section is linear in the values of the spline at its knots (see `strokes`), so the inverse is a
least-squares problem. The profile is kept from falling below zero by the coefficients of its pieces
in Bernstein's basis; what is measured is made symmetric by taking its centre of gravity as centre.

How smooth it is follows from the strokes, by robust generalised cross-validation: any fixed weight
flattens the peaks of clean strokes, or lets noise through.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from scipy.interpolate import CubicSpline

from ....core.arrays import FloatArray
from ....core.errors import FlybyError, InputError
from ....core.sqp import NLP, solve
from .footprint import Footprint
from .strokes import Stroke, chord_nodes, section, spread

_LEAST_PIECES = 3
_PIECES = 10, 20
"""Fewest and most that are taken by themselves, one for three places of a stroke."""
_WEIGHTS = np.logspace(-7.0, 0.0, 29)
_ROBUST = 0.05
"""γ of robust cross-validation: with 1, the plain one, one fit in some follows the noise (M. A.
Lukas, "Robust generalized cross-validation for choosing the regularization parameter", Inverse
Problems 22, 2006)."""
_NOTABLE = {"asymmetry": 0.05, "misfit": 0.05, "outside": 0.05, "rate": 0.1}


@dataclass(frozen=True, eq=False)
class FootprintFit:
    """A fitted footprint, and how well it explains the strokes.

    Args:
        footprint: the result.
        residuals: of each stroke (p,), fitted less measured, m.
        warnings: what a user should look at, a sentence each.
    """

    footprint: Footprint
    residuals: tuple[FloatArray, ...]
    warnings: tuple[str, ...]

    @property
    def rms(self) -> float:
        """Root mean square of all residuals, m."""
        return float(np.sqrt(np.mean(np.concatenate(self.residuals) ** 2)))

    @property
    def largest(self) -> float:
        """Largest residual, m."""
        return float(np.abs(np.concatenate(self.residuals)).max())


def fit_footprint(
    strokes: Sequence[Stroke],
    reference_distance: float,
    far_radius: float,
    near_radius: float,
    near_distance: float = 0.0,
    *,
    pieces: int | None = None,
    smoothing: float | None = None,
) -> FootprintFit:
    """The footprint whose strokes are nearest to the measured ones.

    Args:
        strokes: at least one; several distances also test the cone.
        reference_distance, far_radius: the footprint's rim, m.
        near_radius, near_distance: a second circle of the cone, m.
        pieces: of the spline; its knots are even. None for 10 to 20, by the places of a stroke.
        smoothing: weight of second differences of the profile beside residuals, both as shares
            of their peak; larger values give a flatter profile. None for the one by which the
            strokes predict each other best.

    Raises:
        InputError: no strokes, too few pieces, a negative weight, a cone that does not widen.
        FlybyError: the least-squares problem could not be solved.
    """
    if not strokes:
        raise InputError("strokes: at least one is needed")
    if pieces is None:
        places = max(len(stroke.across) for stroke in strokes)
        pieces = min(max(places // 3, _PIECES[0]), _PIECES[1])
    if pieces < _LEAST_PIECES or not (smoothing is None or smoothing >= 0.0):
        raise InputError(f"at least {_LEAST_PIECES} pieces and a smoothing >= 0 are needed")
    knots = np.linspace(0.0, far_radius, pieces + 1)
    flat = np.append(np.ones(pieces), 0.0)
    cone = Footprint.of_cone(knots, flat, reference_distance, near_radius, near_distance)
    peak = max(stroke.rate for stroke in strokes) / (np.pi * far_radius**2)
    spline = CubicSpline(knots, np.eye(pieces + 1), bc_type="clamped")
    matrices = [peak * _matrix(spline, cone, stroke) for stroke in strokes]
    values = peak * _fitted(matrices, strokes, spline, smoothing)
    slopes = np.asarray(spline(knots, 1)) @ values
    slopes[[0, -1]] = 0.0
    footprint = Footprint.of_cone(
        knots, values, reference_distance, near_radius, near_distance, slopes=slopes
    )
    residuals = tuple(
        section(footprint, s.across - s.centre, s.distance, s.speed, s.flow) - s.thickness
        for s in strokes
    )
    return FootprintFit(footprint, residuals, tuple(_warnings(footprint, strokes, residuals)))


def _matrix(spline: CubicSpline, cone: Footprint, stroke: Stroke) -> FloatArray:
    """Thickness of a stroke (p,) by the values at the knots (k,): (p, k), s."""
    size = spread(cone, stroke.distance)
    radii, weights = chord_nodes(cone.knots, (stroke.across - stroke.centre) / size)
    values = np.asarray(spline(np.minimum(radii, cone.radius)))
    scale = stroke.flow / (stroke.speed * size)
    return np.asarray(scale * np.einsum("pq,pqk->pk", weights, values))


def _fitted(
    matrices: Sequence[FloatArray],
    strokes: Sequence[Stroke],
    spline: CubicSpline,
    smoothing: float | None,
) -> FloatArray:
    """Values at the knots (k,), the last one zero, as multiples of the unit of the matrices."""
    rows = [
        np.concatenate((matrix, stroke.thickness[:, None]), axis=1)
        / (stroke.thickness.max() * np.sqrt(len(matrix)))
        for matrix, stroke in zip(matrices, strokes, strict=True)
    ]
    knots = spline.x
    count = len(knots) - 1
    measured = np.concatenate(rows)
    bends = np.diff(np.eye(count + 1), 2, axis=0)[:, :count]
    if smoothing is None:
        smoothing = _cross_validated(measured[:, :count], measured[:, -1], bends)
    matrix = np.concatenate((measured[:, :count], np.sqrt(smoothing) * bends))
    wanted = np.append(measured[:, -1], np.zeros(len(bends)))
    third = np.diff(knots)[:, None] / 3.0
    slopes = np.asarray(spline(knots, 1))
    inner = np.concatenate(
        (np.eye(count + 1)[:-1] + third * slopes[:-1], np.eye(count + 1)[1:] - third * slopes[1:])
    )[:-1, :count]  # the last coefficient of the last piece is the rim's zero
    result = solve(
        NLP(
            n=count,
            m=len(inner),
            residuals=lambda x: matrix @ x - wanted,
            residual_jacobian=lambda x: matrix,
            constraints=lambda x: inner @ x,
            jacobian=lambda x: inner,
            x_lower=0.0,
            c_lower=0.0,
        ),
        np.ones(count),
        tolerance=1e-9,
    )
    if not result.success:
        raise FlybyError(f"no footprint could be fitted to the strokes: {result.message}")
    return np.append(np.maximum(result.x, 0.0), 0.0)


def _cross_validated(matrix: FloatArray, wanted: FloatArray, bends: FloatArray) -> float:
    """The weight of the bends with which measurements predict each other best.

    Args:
        matrix: (n, k), of the measurements by the values.
        wanted: (n,) measurements.
        bends: (b, k), of the bends by the values.
    """
    square, penalty, right = matrix.T @ matrix, bends.T @ bends, matrix.T @ wanted
    best, least = float(_WEIGHTS[-1]), np.inf
    for weight in _WEIGHTS:
        fitted, shares = np.hsplit(
            np.linalg.solve(
                square + weight * penalty, np.concatenate((right[:, None], square), axis=1)
            ),
            [1],
        )
        left = len(wanted) - np.trace(shares)
        followed = np.trace(shares @ shares) / len(wanted)
        error = np.sum((matrix @ fitted[:, 0] - wanted) ** 2) / left**2 if left > 0.0 else np.inf
        score = error * (_ROBUST + (1.0 - _ROBUST) * followed)
        if score < least:
            best, least = float(weight), score
    return best


def _warnings(
    footprint: Footprint, strokes: Sequence[Stroke], residuals: Sequence[FloatArray]
) -> list[str]:
    found = []
    for number, (stroke, residual) in enumerate(zip(strokes, residuals, strict=True), 1):
        peak = float(stroke.thickness.max())
        misfit = float(np.sqrt(np.mean(residual**2))) / peak
        if misfit > _NOTABLE["misfit"]:
            found.append(f"stroke {number}: the fit is off by {misfit:.0%} of the peak (rms)")
        if stroke.asymmetry > _NOTABLE["asymmetry"]:
            found.append(f"stroke {number}: its sides differ by {stroke.asymmetry:.0%} of the peak")
        rim = footprint.radius * spread(footprint, stroke.distance)
        outside = stroke.thickness[np.abs(stroke.across - stroke.centre) > rim]
        if outside.max(initial=0.0) > _NOTABLE["outside"] * peak:
            found.append(f"stroke {number}: there is paint beyond the rim; is the cone too narrow?")
    rates = [stroke.rate for stroke in strokes]
    if max(rates) > (1.0 + _NOTABLE["rate"]) * min(rates):
        found.append(
            f"the strokes hold between {min(rates):.3g} and {max(rates):.3g} m³/s of paint: "
            "do speeds and flows belong to them?"
        )
    return found
