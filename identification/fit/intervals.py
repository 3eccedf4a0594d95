"""How well parameters are known: confidence intervals, and parameters that the logs do not show.

Residuals of neighbouring samples are alike, and where the model is off they are no noise at all; so
the intervals are those of a jackknife over clusters (residuals about one waypoint of one run):
leaving out cluster c moves the minimum by

    δ_c = (A − A_c)⁻¹ g_c,     A = Σ_c Σ ρ″ J Jᵀ,     g_c = Σ ρ′ J,

and the covariance is (G − 1)/G Σ δ_c δ_cᵀ with G clusters (MacKinnon and White, "Some
heteroskedasticity-consistent covariance matrix estimators", J. Econometrics 29, 1985; for clusters
Bell and McCaffrey, Survey Methodology 28, 2002). It allows for any correlation within a cluster and
for any spread.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from ...core.arrays import FloatArray
from .emulation import Rows
from .loss import curvature, influence, square_root
from .parameters import ParameterSet
from .runs import PreparedRun

CONFIDENCE = 0.95
SEEN = 1e-3
"""Weighted residuals that a parameter, moved by its scale, must change somewhere to be seen."""
FEWEST_IN_ZONES = 10
"""Samples that all logs together must have in zones to show the form of corners."""
ALONE = 1e-7
"""Share of a parameter's curvature that must be left when all others give way."""
LOOSE = 0.5
"""Share of what a parameter may be, beyond which an interval says nothing."""
_RIDGE = 1e-10


@dataclass(frozen=True)
class Interval:
    """What a parameter is, and how well that is known.

    Args:
        name: of the parameter.
        value: of the fit.
        deviation: its standard deviation.
        lower, upper: ends of the interval that holds the true value with `CONFIDENCE`.
    """

    name: str
    value: float
    deviation: float
    lower: float
    upper: float


NO_RUN = "no log changes with it: no run uses what it stands for"


@dataclass(frozen=True)
class Unseen:
    """A parameter that the logs say nothing about; it stays where it was.

    Args:
        name: of the parameter.
        reason: in a sentence.
        unused: whether no run comes to where it matters.
    """

    name: str
    reason: str
    unused: bool = False


@dataclass(frozen=True)
class Cluster:
    """Sums over residuals that are not independent of each other.

    Args:
        curvature: (n, n), A_c.
        pull: (n,), g_c.
    """

    curvature: FloatArray
    pull: FloatArray


def clusters_of(
    runs: Sequence[PreparedRun], linearised: Sequence[tuple[Rows, FloatArray]]
) -> list[Cluster]:
    """The clusters of all runs, from their residuals and derivatives (K, M, n)."""
    found = []
    for run, (rows, J) in zip(runs, linearised, strict=True):
        for one in np.unique(run.cluster):
            mine = run.cluster == one
            r, j = rows.values[mine].ravel(), J[mine].reshape(-1, J.shape[-1])
            found.append(Cluster((j * curvature(r)[:, None]).T @ j, j.T @ influence(r)))
    return found


def unseen(
    parameters: ParameterSet,
    runs: Sequence[PreparedRun],
    linearised: Sequence[tuple[Rows, FloatArray]],
) -> list[Unseen]:
    """The parameters that no log shows by itself, with the reason.

    Of several that only their combination shows, the first to be left out is named; once it stays,
    the others may be seen.
    """
    found = []
    few = _samples_in_zones(runs) < FEWEST_IN_ZONES
    for k, one in enumerate(parameters.parameters):
        most = max(float(np.abs(J[..., k]).max()) for _, J in linearised)
        if all(key.startswith("blend.") for key in one.keys) and few:
            found.append(Unseen(one.name, _too_small(runs)))
        elif most < SEEN:
            found.append(Unseen(one.name, NO_RUN, unused=True))
    if found:
        return found
    entangled = _entangled(
        parameters, np.sum([c.curvature for c in clusters_of(runs, linearised)], axis=0)
    )
    return [] if entangled is None else [entangled]


def intervals(
    parameters: ParameterSet, values: FloatArray, clusters: Sequence[Cluster], samples: int
) -> list[Interval]:
    """Intervals of the parameters, the first of the problem's variables.

    Args:
        parameters: that were fitted.
        values: (P,) of them.
        clusters: at the solution.
        samples: weighted residuals that they are sums of.
    """
    from scipy.stats import t as student

    size = parameters.size
    held = np.zeros(len(clusters[0].pull))
    away, slope = parameters.departures(values)
    held[:size] = samples * parameters.hold * (square_root(away)[1] * slope * parameters.scale) ** 2
    whole = np.sum([c.curvature for c in clusters], axis=0)
    alone = np.diag(np.linalg.solve(whole + np.diag(held) + _ridge(whole), np.diag(held)))[:size]
    # What runs do not tell is known as it was before.
    before = np.clip(alone, 0.0, 1.0) * np.array([p.known for p in parameters.parameters]) ** 2
    told = parameters.scale**2 * np.diag(covariance(clusters, held))[:size]
    deviation = np.sqrt(told + np.where(alone > 0.0, before, 0.0))
    reach = student.ppf(0.5 + 0.5 * CONFIDENCE, freedom(clusters, held)[:size]) * deviation
    return [
        Interval(one.name, float(v), float(d), float(v - r), float(v + r))
        for one, v, d, r in zip(parameters.parameters, values, deviation, reach, strict=True)
    ]


def freedom(clusters: Sequence[Cluster], held: FloatArray) -> FloatArray:
    """(n,), how many clusters of equal weight would tell a variable's deviation as well.

    Each cluster adds to a variable's variance in proportion to what it tells of it, w_c; that of
    the sum is known as by (Σ w)² / Σ w² squares (Satterthwaite, Biometrics Bulletin 2, 1946).
    """
    whole = np.sum([c.curvature for c in clusters], axis=0)
    inverse = np.linalg.inv(whole + np.diag(held) + _ridge(whole))
    told = np.stack([np.einsum("ij,jk,ki->i", inverse, c.curvature, inverse) for c in clusters])
    count = told.sum(axis=0) ** 2 / np.maximum((told**2).sum(axis=0), 1e-300)
    return np.asarray(np.maximum(count, 1.0))


def loose(parameters: ParameterSet, known: Sequence[Interval]) -> list[Unseen]:
    """The parameters whose intervals reach over most of what they may be."""
    return [
        Unseen(
            one.name,
            f"anything from {interval.lower:.3g} to {interval.upper:.3g} would explain the logs as "
            "well, as far as they agree with each other",
        )
        for one, interval in zip(parameters.parameters, known, strict=True)
        if interval.upper - interval.lower > LOOSE * (one.upper - one.lower)
    ]


def covariance(clusters: Sequence[Cluster], held: FloatArray) -> FloatArray:
    """(n, n), of the problem's variables, where each is held with a curvature (n,)."""
    whole = np.sum([c.curvature for c in clusters], axis=0)
    ridge = np.diag(held) + _ridge(whole)
    moves = np.stack([np.linalg.solve(whole - c.curvature + ridge, c.pull) for c in clusters])
    moves -= moves.mean(axis=0)
    count = len(clusters)
    return np.asarray((count - 1) / count * moves.T @ moves)


def _ridge(A: FloatArray) -> FloatArray:
    """What makes a matrix regular that has nothing to say of a variable."""
    return np.diag(_RIDGE * np.diag(A) + np.finfo(float).tiny)


def _entangled(parameters: ParameterSet, A: FloatArray) -> Unseen | None:
    """The parameter that is least its own, if what is its own is next to nothing."""
    size = np.sqrt(np.maximum(np.diag(A), np.finfo(float).tiny))
    unit = A / np.outer(size, size) + _RIDGE * np.eye(len(A))
    own = 1.0 / np.diag(np.linalg.inv(unit))[: parameters.size]
    if not len(own) or own.min() > ALONE:
        return None
    k = int(np.argmin(own))
    # What the others would do to make up for it.
    others = np.delete(np.arange(len(A)), k)
    answer = np.linalg.solve(unit[np.ix_(others, others)], unit[others, k])
    named = [
        (abs(a), parameters.parameters[j].name)
        for a, j in zip(answer, others, strict=True)
        if j < parameters.size and abs(a) > 0.1 * np.abs(answer).max()
    ]
    partners = ", ".join(name for _, name in sorted(named, reverse=True)[:3])
    what = f"the logs show it only together with {partners or 'the offsets in time'}"
    return Unseen(parameters.parameters[k].name, f"{what}: either would explain them")


def _samples_in_zones(runs: Sequence[PreparedRun]) -> int:
    return sum(sum(run.in_zones) for run in runs)


def _too_small(runs: Sequence[PreparedRun]) -> str:
    run = max(runs, key=lambda run: max(run.in_zones, default=0))
    if not run.in_zones:
        return "no run has a zone that the robot drives through"
    return (
        f"the zones are too small to be seen: with a sample every {1e3 * run.log.period:.2g} ms, "
        f"{_samples_in_zones(runs)} in all lie in zones, and no more than {max(run.in_zones)} in "
        f"one ({run.name})"
    )
