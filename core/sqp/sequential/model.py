"""The quadratic model of one iteration: built, made convex, solved."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from ...arrays import FloatArray
from ..filter import NO_VIOLATION
from ..given import Given
from ..options import box_limits
from ..problem import violation
from ..problem.evaluation import Point
from ..problem.optimality import at_bounds, bound_multipliers, lagrangian_slope
from ..qp.problem import QpSolution, QpStatus, QuadraticProgram, in_units
from .convexify import ActiveSet, ConvexModel, raised
from .damping import Damping

_FIRST_RADIUS = 1e3
_DROP_RADIUS = 1e30
_ABSURD = 1e8
_GROWTH = 8.0
_FIRST_PRICE, _PRICE_GROWTH, _LARGEST_PRICE = 10.0, 10.0, 1e8
_SMALL_STEP = 1e-5
_SMALL_STEPS = 3
_MODEST = 10.0
_ROUNDING = 1e-10


class NoSubproblemError(RuntimeError):
    """No back end could solve a subproblem."""


class Model:
    """Models of one solution, and what they learn from each other.

    Attributes:
        radius: largest change of a variable in its own size; infinite while steps succeed.
        shift: what the last Hessian's diagonal was raised by.
    """

    def __init__(self, given: Given) -> None:
        problem, workspace = given.problem, given.workspace
        self._problem = problem
        self._hessian = given.hessian
        self._subproblems = workspace.subproblems
        self._step_box = given.options.step_box
        self._tolerance = given.options.tolerance
        self._convexifier = workspace.convexifier
        self._elastic = workspace.elastic
        self._price = _FIRST_PRICE
        self._bound_multipliers = np.zeros(len(problem.x_lower))
        self._last_qp: QuadraticProgram | None = None
        self._small_steps = 0
        self._largest_curvature = np.inf
        self.radius = np.inf
        self._damping = Damping()

    @property
    def shift(self) -> float:
        return self._convexifier.shift

    def step(
        self, point: Point, multipliers: FloatArray, number: int
    ) -> tuple[QpSolution | None, str]:
        """The subproblem's solution and its kind; None where only restoration is left.

        Args:
            point: with derivatives.
            multipliers: (m,).
            number: of the iteration.

        Raises:
            CallableError: the Hessian is not finite.
            NoSubproblemError: a problem without constraints has an unsolvable model.
        """
        H = self._hessian.matrix(point, self._curvature_multipliers(multipliers))
        active = self._active(point, multipliers)
        convex = self._convexifier.convex(H, point.g, point.J, active)
        found = self._solution(convex, point, multipliers, number)
        if convex.weights.any() and self._misled(found, point):
            convex = self._convexifier.cautious(H, point.g, active)
            found = self._solution(convex, point, multipliers, number)
        if found.status is QpStatus.SOLVED:
            self._bound_multipliers = found.z
            y = convex.multipliers(found.y, point.J @ found.d)
            return replace(found, y=y), "normal"
        if not len(point.c):
            raise NoSubproblemError("no back end could solve a subproblem")
        return self._elastic_step(point, multipliers), "elastic"

    def _solution(
        self, convex: ConvexModel, point: Point, multipliers: FloatArray, number: int
    ) -> QpSolution:
        """The model's solution within the bounds; where it is unbounded or too hard, within a
        region or with a raised diagonal."""
        problem, sizes = self._problem, _magnitudes(point.x)
        P = convex.P
        if not (convex.curved and self._hessian.measured):
            P = raised(P, self._damping.diagonal(self._slope(point, multipliers), sizes))
        box = self._box(point.x, number)
        qp = QuadraticProgram(
            P, convex.q, point.J, problem.c_lower - point.c, problem.c_upper - point.c, *box
        )
        guess = QpSolution(
            QpStatus.SOLVED, np.zeros(len(sizes)), multipliers, self._bound_multipliers
        )
        found = self._solve(qp, guess)
        if found.status is QpStatus.UNBOUNDED or self._absurd(found, sizes):
            self.radius = min(self.radius, _FIRST_RADIUS)
            lower, upper = self._box(point.x, number)
            qp = replace(qp, d_lower=lower, d_upper=upper)
            found = self._solve(qp, None)
        if found.status in (QpStatus.FAILED, QpStatus.UNBOUNDED):
            shift = 1e-6 * max(1.0, P.largest())
            qp = replace(qp, P=raised(P, np.full(len(sizes), shift)))
            found = self._solve(qp, None)
        self._last_qp = qp
        return found

    def _absurd(self, found: QpSolution, sizes: FloatArray) -> bool:
        """Whether a step leads further than anything that is known here can tell."""
        if found.status is not QpStatus.SOLVED or np.isfinite(self.radius):
            return False
        return float((np.abs(found.d) / sizes).max()) > _ABSURD

    def _misled(self, found: QpSolution, point: Point) -> bool:
        """Whether a step from a feasible point climbs, towards what was wrongly expected to be
        active."""
        solved = found.status is QpStatus.SOLVED
        feasible = self._problem.theta(point.c) <= NO_VIOLATION
        return solved and feasible and float(point.g @ found.d) > 0

    def corrected(self, shift: FloatArray, guess: QpSolution) -> QpSolution | None:
        """The last model with other constraint values; None if it has no solution.

        Args:
            shift: (m,) the constraints' values at d = 0.
            guess: a solution nearby.
        """
        assert self._last_qp is not None
        problem = self._problem
        qp = replace(self._last_qp, lower=problem.c_lower - shift, upper=problem.c_upper - shift)
        found = self._solve(qp, guess)
        return found if found.status is QpStatus.SOLVED else None

    def taken(self, point: Point, d: FloatArray, length: float) -> None:
        """A step was taken: the region follows.

        Args:
            point: where it began.
            d: (n,) the model's step.
            length: the share of it that was taken.
        """
        step = float((np.abs(d) / _magnitudes(point.x)).max())
        small = length * step <= _SMALL_STEP and self.shift > 0
        self._small_steps = self._small_steps + 1 if small else 0
        self._damping.taken(length)
        if length <= 1 / 16 and step > _ROUNDING:
            self.radius = 4.0 * length * step
        elif length == 1.0 and np.isfinite(self.radius):
            if step > 0.99 * self.radius:
                self.radius *= _GROWTH
            if self.radius > _DROP_RADIUS:
                self.radius = np.inf

    def shrink(self, point: Point, d: FloatArray) -> float:
        """No share of a step d (n,) was taken: look nearer by. Returns the step's size."""
        step = float((np.abs(d) / _magnitudes(point.x)).max())
        self.radius = 0.1 * min(self.radius, step)
        return step

    def forget(self) -> None:
        """The point jumped: nothing learnt holds."""
        self.radius = np.inf
        self._bound_multipliers = np.zeros_like(self._bound_multipliers)

    def expect(self, bound_multipliers: FloatArray) -> None:
        """Begin with bounds active as multipliers (n,), scaled, say."""
        self._bound_multipliers = bound_multipliers

    def _solve(self, qp: QuadraticProgram, warm: QpSolution | None) -> QpSolution:
        """The subproblem, in units of its limits where they are finite and far."""
        unit = float(np.maximum(qp.d_upper, -qp.d_lower).max())
        if not np.isfinite(self.radius) or unit <= _FIRST_RADIUS:
            return self._subproblems.solve(qp, warm)
        found = self._subproblems.solve(in_units(qp, unit))
        return replace(found, d=found.d * unit)

    def _curvature_multipliers(self, y: FloatArray) -> FloatArray:
        """The multipliers; cut down where they have blown up the Hessian so far (rows that nearly
        depend on each other do that) that every step is tiny."""
        largest = float(np.abs(y).max(initial=0.0))
        if self._small_steps >= _SMALL_STEPS:
            self._largest_curvature = max(_MODEST, 1e-2 * min(self._largest_curvature, largest))
            self._small_steps = 0
        cap = self._largest_curvature
        return y if largest <= cap else y * (cap / largest)

    def _elastic_step(self, point: Point, multipliers: FloatArray) -> QpSolution | None:
        """A step of the last model that lessens the linearised violation; None if none does."""
        qp = self._last_qp
        assert qp is not None
        theta = self._problem.theta(point.c)
        self._price = max(self._price, 2.0 * float(np.abs(multipliers).max(initial=0.0)))
        while self._price <= _LARGEST_PRICE:
            found = self._elastic.solve(qp, self._price)
            if found.status is not QpStatus.SOLVED:
                return None
            left = violation.total(qp.A @ found.d, qp.lower, qp.upper)
            if left <= 0.5 * theta or left <= self._tolerance:
                return found
            if left <= 0.9 * theta and self._price >= 1e4:
                return found
            self._price *= _PRICE_GROWTH
        self._price = _FIRST_PRICE
        return None

    def sideways(self) -> QpSolution | None:
        """The last model's step that lowers the objective where nothing lowers the linearised
        violation; None if there is none."""
        assert self._last_qp is not None
        found = self._elastic.solve(self._last_qp, _FIRST_PRICE)
        moves = float(np.abs(found.d).max()) > _SMALL_STEP
        return found if found.status is QpStatus.SOLVED and moves else None

    def _active(self, point: Point, y: FloatArray) -> ActiveSet:
        """Rows and variables that the multipliers, or the last subproblem, hold on a bound."""
        problem = self._problem
        equal = problem.c_lower == problem.c_upper
        rows = equal | (np.abs(y) > 1e-8)
        target = np.where(y > 0, problem.c_upper, problem.c_lower)
        target = np.where(equal, problem.c_lower, target)
        rows &= np.isfinite(target)
        change = np.where(rows, target - point.c, 0.0)
        slope = lagrangian_slope(point.g, point.J, y)
        at_lower, at_upper = at_bounds(point.x, problem.x_lower, problem.x_upper)
        held = (at_lower & (slope > 0)) | (at_upper & (slope < 0))
        fixed = problem.x_lower == problem.x_upper
        return ActiveSet(rows, change, np.where(equal, 0.0, np.sign(y)), held | fixed)

    def _slope(self, point: Point, y: FloatArray) -> FloatArray:
        """Slope (n,) of the Lagrangian, less what bounds hold."""
        slope = lagrangian_slope(point.g, point.J, y)
        problem = self._problem
        pushed = bound_multipliers(point.x, slope, problem.x_lower, problem.x_upper)
        return np.asarray(slope + pushed)

    def limits(self, x: FloatArray, number: int) -> tuple[FloatArray, FloatArray]:
        """Lower and upper limits (n,) of a step from x: of the bounds and the user's box.

        Args:
            x: (n,).
            number: of the iteration.

        Raises:
            NlpError: see `box_limits`.
        """
        lower, upper = self._problem.x_lower - x, self._problem.x_upper - x
        if self._step_box is not None:
            low, high = box_limits(self._step_box, number, x)
            lower, upper = np.maximum(lower, low), np.minimum(upper, high)
        return np.minimum(lower, 0.0), np.maximum(upper, 0.0)

    def _box(self, x: FloatArray, number: int) -> tuple[FloatArray, FloatArray]:
        """The limits within the region."""
        lower, upper = self.limits(x, number)
        if not np.isfinite(self.radius):
            return lower, upper
        reach = self.radius * _magnitudes(x)
        return np.maximum(lower, -reach), np.minimum(upper, reach)


def _magnitudes(x: FloatArray) -> FloatArray:
    """Sizes (n,) of variables, by which changes of them are measured."""
    return np.maximum(1.0, np.abs(x))
