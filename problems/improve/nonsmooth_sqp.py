"""Sequential quadratic programming for objectives with many kinks.

The cycle time of a driven program is piecewise smooth: which joint limits the motion where changes
with every variable, and a good program sits on such kinks. One gradient says nothing there. So a
step is found from the gradients at several points nearby, each a lower bound of a convex kink:

    minimise   t + μ s + ½ ρ |d|²
    subject to t ≥ fⱼ − f + gⱼ·(x + d − xⱼ)    for the points j that are remembered
               c + J d + s ≥ 0                  constraints, linearised anew at every point
               |d| ≤ Δ, within the bounds       trust box
               s ≥ 0

and is taken by how far the exact penalty f + μ max(−c, 0), of true values, falls. A step that the
constraints' curvature spoils is corrected once with their true values (second-order correction).
The subproblems are solved by `flyby.core.sqp`. See M. Mäkelä, "Survey of bundle methods for
nonsmooth optimization" (2002), and Nocedal and Wright, section 18.5.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Generic, Protocol, TypeVar

import numpy as np

from ...core.arrays import FloatArray, IntArray
from ...core.sqp.qp.dual_active_set import DiagonalProgram, minimum

_FIRST_PRICE, _PRICE_MARGIN, _LARGEST_PRICE = 10.0, 2.0, 1e5
_TAKEN, _GOOD, _POOR = 0.05, 0.6, 0.25
_GROWTH, _CUT, _SHRINK = 1.7, 0.6, 0.55
_REACH = 8.0
"""Trust boxes within which a remembered gradient counts."""
_MOST_KINKS = 30
_DAMPING = 1e-3
_NO_BEND = 1e-6
"""Curvature along t and s, which the subproblem's solver needs; it changes nothing that counts."""
_TINY_BOX = 2e-4
_SECOND_ORDER = 0.5
"""Share of the promised fall below which a violated step is corrected."""
_STALLS = 3
_AROUND = 0.05
"""How far a search that is stuck looks around, in units of the scale. Looking again, closer, costs
more than it finds."""
_BOX_AROUND = 5.0
_ABOVE = 1e-4
"""Height above the objective from which on a remembered plane is no kink's."""


class SearchPoint(Protocol):
    """Where the problem has been evaluated."""

    @property
    def x(self) -> FloatArray:
        """(n,)."""
        ...

    @property
    def objective(self) -> float:
        """f."""
        ...

    @property
    def constraints(self) -> FloatArray:
        """(m,), c, wanted to be zero or more."""
        ...


P = TypeVar("P", bound=SearchPoint)


class SearchModel(Protocol[P]):
    """What the search asks of a problem.

    Attributes:
        lower, upper: (n,) bounds; variables without any room between them stay.
        scale: (n,), change of each variable that matters about equally.
    """

    lower: FloatArray
    upper: FloatArray
    scale: FloatArray

    def point(self, x: FloatArray) -> P | None:
        """Values at x; None where there are none."""
        ...

    def gradient(self, point: P) -> FloatArray:
        """∇f (n,)."""
        ...

    def jacobian(self, point: P, rows: IntArray) -> FloatArray:
        """∂c/∂x (len(rows), n) of some constraints; zero by variables that stay."""
        ...

    def candidates(self, point: P, box: FloatArray) -> IntArray:
        """Indices, rising, of constraints that a step of at most ``box`` (n,) could violate."""
        ...


@dataclass(frozen=True, slots=True)
class SearchEffort:
    """How long to search.

    Args:
        iterations: at most.
        box: first trust box, in units of the variables' scale; it grows to four times as much.
        tolerance: promised fall of the objective at which the search ends.
        feasible: violation that counts as none.
    """

    iterations: int = 60
    box: float = 1.0
    tolerance: float = 2e-5
    feasible: float = 1e-6


@dataclass(frozen=True, slots=True)
class SearchStand(Generic[P]):
    """Where a search stands.

    Args:
        point: there.
        gradient: ∇f (n,) there.
    """

    point: P
    gradient: FloatArray


@dataclass(frozen=True, slots=True)
class SearchResult(Generic[P]):
    """Where a search ended.

    Args:
        point: the best one: the lowest among those without violation, or the least violated.
        violation: largest one there.
        finished: whether no better point is to be expected nearby.
        memory: with which the search can go on.
        stand: at which it can.
    """

    point: P
    violation: float
    finished: bool
    memory: Memory
    stand: SearchStand[P]


@dataclass(frozen=True, slots=True)
class Kink:
    """A remembered gradient.

    Args:
        x: (n,) where.
        objective: there.
        gradient: (n,) there.
    """

    x: FloatArray
    objective: float
    gradient: FloatArray


@dataclass(frozen=True, slots=True)
class Memory:
    """What a search knows beside the point that it stands at.

    Args:
        x: (n,) of that point.
        box: trust box, in units of the variables' scale.
        price: μ.
        kinks: remembered gradients.
        looked: whether it has looked around where it got stuck.
    """

    x: FloatArray
    box: float
    price: float = _FIRST_PRICE
    kinks: tuple[Kink, ...] = ()
    looked: bool = False


@dataclass
class _State(Generic[P]):
    """Where a search stands.

    Attributes:
        rows, jacobian: of the constraints that were asked for at the point; None where it is new.
    """

    point: P
    gradient: FloatArray
    box: float
    price: float
    kinks: list[Kink]
    looked: bool
    stalls: int = 0
    rows: IntArray | None = None
    jacobian: FloatArray | None = None

    def slopes(self, model: SearchModel[P], rows: IntArray) -> FloatArray:
        """∂c/∂x of some constraints; once known, they need not be asked for again when a step from
        the same point is made anew, in a smaller box."""
        if self.rows is None or self.jacobian is None or not np.isin(rows, self.rows).all():
            self.rows, self.jacobian = rows, model.jacobian(self.point, rows)
        return self.jacobian[np.searchsorted(self.rows, rows)]

    def move(self, point: P, gradient: FloatArray) -> None:
        """Stand somewhere else."""
        self.point, self.gradient = point, gradient
        self.rows = self.jacobian = None


@dataclass(frozen=True, slots=True)
class _Step:
    d: FloatArray
    fall: float
    slack: float
    largest_multiplier: float


def violation(point: SearchPoint) -> float:
    """The largest violation of a constraint."""
    return max(0.0, -float(point.constraints.min(initial=0.0)))


def search(
    model: SearchModel[P],
    start: P,
    settings: SearchEffort,
    memory: Memory | None = None,
    gradient: FloatArray | None = None,
) -> SearchResult[P]:
    """The best point found from a start.

    Args:
        model: the problem.
        start: where to begin.
        settings: how long.
        memory: of a search that ended there.
        gradient: ∇f (n,) there, if it is known.
    """
    known = Memory(start.x, settings.box) if memory is None else memory
    gradient = model.gradient(start) if gradient is None else gradient
    state = _State(start, gradient, known.box, known.price, list(known.kinks), known.looked)
    best, finished = start, False
    for _ in range(settings.iterations):
        fall = _iterate(model, state, settings)
        if _better(state.point, best, settings.feasible):
            best = state.point
        settled = violation(state.point) <= settings.feasible
        state.stalls = state.stalls + 1 if settled and fall < settings.tolerance else 0
        if state.stalls >= _STALLS or state.box < _TINY_BOX:
            finished = state.looked
            if finished:
                break
            _look_around(model, state)
    memory = Memory(state.point.x, state.box, state.price, tuple(state.kinks), state.looked)
    stand = SearchStand(state.point, state.gradient)
    return SearchResult(best, violation(best), finished, memory, stand)


def _look_around(model: SearchModel[P], state: _State[P]) -> None:
    """Forget what is remembered, and take gradients at points all around instead.

    A search gets stuck where kinks meet that it has not seen from here, or where those that it
    remembers have bent away. See Burke, Lewis and Overton, "A robust gradient sampling algorithm
    for nonsmooth, nonconvex optimization" (2005).
    """
    n = len(state.point.x)
    count = np.count_nonzero(model.upper > model.lower)
    random = np.random.default_rng(n)
    state.kinks.clear()
    for direction in random.uniform(-1.0, 1.0, (count, n)):
        x = state.point.x + _AROUND * model.scale * direction
        near = model.point(np.clip(x, model.lower, model.upper))
        if near is not None:
            state.kinks.append(Kink(near.x, near.objective, model.gradient(near)))
    state.box = _BOX_AROUND * _AROUND
    state.stalls = 0
    state.looked = True


def _better(point: SearchPoint, other: SearchPoint, feasible: float) -> bool:
    mine, its = violation(point), violation(other)
    if mine > feasible or its > feasible:
        return mine < its
    return point.objective < other.objective


def _iterate(model: SearchModel[P], state: _State[P], settings: SearchEffort) -> float:
    """One trial; returns the fall that the model promised."""
    point = state.point
    box = state.box * model.scale
    rows = model.candidates(point, box)
    jacobian = state.slopes(model, rows)
    live = point.constraints[rows] < np.abs(jacobian) @ box
    rows, jacobian = rows[live], jacobian[live]
    step = _step(model, state, jacobian, point.constraints[rows], box)
    old = violation(point)
    promised = step.fall + state.price * (old - step.slack)
    trial = model.point(point.x + step.d)
    if trial is None:
        state.box *= _SHRINK**2
        return promised
    gained = _gain(point, trial, state.price)
    if gained < _SECOND_ORDER * promised and violation(trial) > step.slack + settings.feasible:
        shifted = trial.constraints[rows] - jacobian @ step.d
        second = model.point(point.x + _step(model, state, jacobian, shifted, box).d)
        if second is not None and _gain(point, second, state.price) > gained:
            trial, gained = second, _gain(point, second, state.price)
    _settle(model, state, trial, gained, promised, settings)
    if step.slack > settings.feasible and step.slack > 0.5 * old:
        state.price = min(10.0 * state.price, _LARGEST_PRICE)
    return promised


def _gain(point: SearchPoint, trial: SearchPoint, price: float) -> float:
    fall = point.objective - trial.objective
    return float(fall + price * (violation(point) - violation(trial)))


def _settle(
    model: SearchModel[P],
    state: _State[P],
    trial: P,
    gained: float,
    promised: float,
    settings: SearchEffort,
) -> None:
    """Take the trial or leave it, and remember its gradient either way."""
    ratio = gained / max(promised, 1e-12)
    gradient = model.gradient(trial)
    if ratio > _TAKEN and gained > 0.0:
        state.kinks.append(Kink(state.point.x, state.point.objective, state.gradient))
        state.move(trial, gradient)
        if ratio > _GOOD:
            state.box = min(_GROWTH * state.box, 4.0 * settings.box)
        elif ratio < _POOR:
            state.box *= _CUT
    else:
        state.kinks.append(Kink(trial.x, trial.objective, gradient))
        state.box *= _SHRINK
    del state.kinks[:-_MOST_KINKS]


def _step(
    model: SearchModel[P],
    state: _State[P],
    jacobian: FloatArray,
    constraints: FloatArray,
    box: FloatArray,
) -> _Step:
    """The subproblem's solution; the price is raised until it outweighs the multipliers."""
    for _ in range(3):
        step = _subproblem(model, state, jacobian, constraints, box)
        if step.slack <= 0.0 or state.price >= _PRICE_MARGIN * step.largest_multiplier:
            break
        state.price = min(2.0 * _PRICE_MARGIN * step.largest_multiplier, _LARGEST_PRICE)
    return step


def _subproblem(
    model: SearchModel[P],
    state: _State[P],
    jacobian: FloatArray,
    constraints: FloatArray,
    box: FloatArray,
) -> _Step:
    """Over (d, t, s), with d of what is free in units of the box, t in units of what the steepest
    plane falls there, and s in units of what constraints change: everything is of size one."""
    point, free = state.point, np.flatnonzero(model.upper > model.lower)
    n, box = len(free), box[free]
    slopes, heights = _planes(model, state)
    slopes, jacobian = slopes[:, free] * box, jacobian[:, free] * box
    size = float(np.abs(slopes).max(initial=0.0)) or 1.0
    depth = float(np.abs(jacobian).max(initial=0.0)) or 1.0
    price = state.price * depth / size
    k = len(heights)
    rows = np.zeros((k + len(constraints), n + 2))
    rows[:k, :n] = slopes / -size
    rows[:k, n] = 1.0
    rows[k:, :n] = jacobian / depth
    rows[k:, n + 1] = 1.0
    below, above = ((bound - point.x)[free] / box for bound in (model.lower, model.upper))
    program = DiagonalProgram(
        np.concatenate([np.full(n, _DAMPING), [_NO_BEND, _NO_BEND * max(price, 1.0)]]),
        np.concatenate([np.zeros(n), [1.0, price]]),
        rows,
        np.concatenate([heights / size, -constraints / depth]),
        np.concatenate([np.clip(below, -1.0, 0.0), [-np.inf, 0.0]]),
        np.concatenate([np.clip(above, 0.0, 1.0), [np.inf, np.inf]]),
    )
    found = minimum(program)
    d = np.zeros(len(point.x))
    if found is None:
        return _Step(d, 0.0, 0.0, 0.0)
    values, multipliers = found
    d[free] = values[:n] * box
    largest = float(multipliers[k:].sum()) * size / depth
    return _Step(d, -float(values[n]) * size, float(values[n + 1]) * depth, largest)


def _planes(model: SearchModel[P], state: _State[P]) -> tuple[FloatArray, FloatArray]:
    """Slopes (k, n) and heights (k,) over the point's objective of its own gradient and of those
    remembered nearby, none above it."""
    point, reach = state.point, _REACH * state.box * model.scale
    slopes, heights = [state.gradient], [0.0]
    for kink in state.kinks:
        if np.all(np.abs(kink.x - point.x) <= reach):
            height = kink.objective - point.objective + kink.gradient @ (point.x - kink.x)
            if height > _ABOVE:
                continue
            slopes.append(kink.gradient)
            heights.append(min(float(height), 0.0))
    return np.array(slopes), np.array(heights)
