"""Rows of the transcription that are polynomials of x: what links nodes, and kinematic limits.

Every kind of rows gives values, Jacobian entries at fixed places, and the entries of its share of
the Lagrangian's Hessian (lower and upper triangle).
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Protocol

import numpy as np

from .....core.arrays import FloatArray, IntArray
from ..motion.layout import VariableLayout

Places = tuple[IntArray, IntArray]
"""Rows and columns of entries; entries at one place add up."""

Terms = tuple[IntArray, FloatArray]
"""Columns of x, and what each is multiplied by."""

NOTHING: Places = (np.zeros(0, dtype=np.int64), np.zeros(0, dtype=np.int64))


class ConstraintRows(Protocol):
    """A block of m constraints."""

    @property
    def lower(self) -> FloatArray: ...
    @property
    def upper(self) -> FloatArray: ...
    @property
    def jacobian_places(self) -> Places: ...
    @property
    def hessian_places(self) -> Places: ...
    def values(self, x: FloatArray) -> FloatArray: ...
    def jacobian(self, x: FloatArray) -> FloatArray: ...
    def hessian(self, x: FloatArray, multipliers: FloatArray) -> FloatArray: ...


class MotionRows:
    """Linear forms of interval polynomials, with their dependence on the interval's width w.

    A row is Σ a q + w Σ b d + w² Σ c e, with the columns of x that are given for each sum.

    Args:
        layout: the variables.
        interval: (m,), the interval of each row.
        plain: columns (m, a) and coefficients (m, a) of what does not depend on the width.
        once: columns and coefficients (m, b) of what is multiplied by w; None for nothing.
        twice: of what is multiplied by w².
        lower, upper: bounds of the rows, (m,) or one for all.
    """

    def __init__(
        self,
        layout: VariableLayout,
        interval: IntArray,
        plain: Terms,
        once: Terms | None = None,
        twice: Terms | None = None,
        lower: FloatArray | float = 0.0,
        upper: FloatArray | float = 0.0,
    ) -> None:
        count = len(interval)
        nothing = np.zeros((count, 0), dtype=np.int64), np.zeros((count, 0))
        self._layout = layout
        self._interval = interval
        self._parts = (plain, once or nothing, twice or nothing)
        self._columns = np.concatenate([part[0] for part in self._parts], axis=1)
        self._free = bool(layout.stretches)
        self._width_column = layout.stretch[interval] if self._free else None
        self.lower, self.upper = np.full(count, lower), np.full(count, upper)

    def __len__(self) -> int:
        return len(self._interval)

    @property
    def jacobian_places(self) -> Places:
        columns = self._columns
        if self._width_column is not None:
            columns = np.hstack([columns, self._width_column[:, None]])
        rows = np.repeat(np.arange(len(self)), columns.shape[1])
        return rows, columns.ravel()

    def _sums(self, x: FloatArray) -> tuple[FloatArray, FloatArray, FloatArray, FloatArray]:
        width = self._layout.width(x)[self._interval]
        plain, once, twice = (np.sum(c * x[columns], axis=1) for columns, c in self._parts)
        return width, plain, once, twice

    def values(self, x: FloatArray) -> FloatArray:
        width, plain, once, twice = self._sums(x)
        return np.asarray(plain + width * once + width**2 * twice)

    def jacobian(self, x: FloatArray) -> FloatArray:
        width, _, once, twice = self._sums(x)
        (_, a), (_, b), (_, c) = self._parts
        entries = [a, width[:, None] * b, width[:, None] ** 2 * c]
        if self._free:
            rate = self._layout.grid.width[self._interval]
            entries.append((rate * (once + 2 * width * twice))[:, None])
        return np.hstack(entries).ravel()

    @property
    def hessian_places(self) -> Places:
        if self._width_column is None:
            return NOTHING
        columns = np.hstack([self._parts[1][0], self._parts[2][0]])
        own = np.repeat(self._width_column, columns.shape[1])
        other, w = columns.ravel(), self._width_column
        return np.concatenate([own, other, w]), np.concatenate([other, own, w])

    def hessian(self, x: FloatArray, multipliers: FloatArray) -> FloatArray:
        if not self._free:
            return np.zeros(0)
        width, _, _, twice = self._sums(x)
        rate = self._layout.grid.width[self._interval] * multipliers
        (_, b), (_, c) = self._parts[1:]
        cross = np.hstack([rate[:, None] * b, (2 * rate * width)[:, None] * c]).ravel()
        bend = 2 * rate * self._layout.grid.width[self._interval] * twice
        return np.concatenate([cross, cross, bend])


class Stack:
    """Blocks of rows one below the other."""

    def __init__(self, blocks: Sequence[ConstraintRows]) -> None:
        self._blocks = blocks
        self._sizes = [len(block.lower) for block in blocks]
        self.lower = np.concatenate([block.lower for block in blocks])
        self.upper = np.concatenate([block.upper for block in blocks])

    @property
    def jacobian_places(self) -> Places:
        starts = np.cumsum([0, *self._sizes[:-1]])
        places = [block.jacobian_places for block in self._blocks]
        rows = [row + start for (row, _), start in zip(places, starts, strict=True)]
        return np.concatenate(rows), np.concatenate([column for _, column in places])

    @property
    def hessian_places(self) -> Places:
        places = [block.hessian_places for block in self._blocks]
        return np.concatenate([p[0] for p in places]), np.concatenate([p[1] for p in places])

    def values(self, x: FloatArray) -> FloatArray:
        return np.concatenate([block.values(x) for block in self._blocks])

    def jacobian(self, x: FloatArray) -> FloatArray:
        return np.concatenate([block.jacobian(x) for block in self._blocks])

    def hessian(self, x: FloatArray, multipliers: FloatArray) -> FloatArray:
        shares = np.split(multipliers, np.cumsum(self._sizes)[:-1])
        pairs = zip(self._blocks, shares, strict=True)
        return np.concatenate([block.hessian(x, share) for block, share in pairs])


def link_rows(layout: VariableLayout) -> Stack:
    """Position and velocity at the nodes of an interval follow from those at its beginning:

    q_b − q₀ − u w d₀ − w² Σ A_i(u) e_i = 0,     d_b − d₀ − w Σ B_i(u) e_i = 0.
    """
    scheme, n = layout.scheme, layout.joints
    positions, velocities = [], []
    interval = np.repeat(np.arange(len(layout.grid)), n)
    e = np.moveaxis(layout.e[layout.rise], 1, 2).reshape(len(interval), -1)
    signs = np.tile([1.0, -1.0], (len(interval), 1))
    for step in range(1, scheme.steps + 1):
        share = step / scheme.steps
        start, end = layout.first, layout.first + step
        q = np.stack([layout.q[end].ravel(), layout.q[start].ravel()], 1)
        d = np.stack([layout.d[end].ravel(), layout.d[start].ravel()], 1)
        once = d[:, 1:], np.full((len(interval), 1), -share)
        twice = e, np.tile(-scheme.position_at(share), (len(interval), 1))
        positions.append(MotionRows(layout, interval, (q, signs), once, twice))
        once = e, np.tile(-scheme.velocity_at(share), (len(interval), 1))
        velocities.append(MotionRows(layout, interval, (d, signs), once))
    return Stack([*positions, *velocities])


def place_rows(
    layout: VariableLayout,
    interval: IntArray,
    share: FloatArray,
    normal: FloatArray,
    least: FloatArray,
) -> MotionRows:
    """Linearised distances at places of the motion: n · q(u) ≥ least.

    Args:
        layout: the variables.
        interval, share: (m,), where in which interval.
        normal: (m, n).
        least: (m,).
    """
    scheme, count = layout.scheme, len(interval)
    powers = share[:, None] ** np.arange(scheme.position.shape[1])
    weights = powers @ scheme.position.T
    start = layout.first[interval]
    e = layout.e[layout.rise[interval]].reshape(count, -1)
    return MotionRows(
        layout,
        interval,
        (layout.q[start], normal),
        (layout.d[start], share[:, None] * normal),
        (e, (weights[:, :, None] * normal[:, None, :]).reshape(count, -1)),
        least,
        np.inf,
    )


class HullRows:
    """Both signs of a limit on Bernstein coefficients, ± Σ … ≤ L w^s S^r: it holds between nodes.

    Args:
        motion: the coefficients.
        layout: the variables.
        limit: (m,), L of each coefficient, in units of scaled time; finite.
        power: r.
        interval: (m,) whose width multiplies the limit (s = 1); None for none (s = 0).
    """

    def __init__(
        self,
        motion: MotionRows,
        layout: VariableLayout,
        limit: FloatArray,
        power: float,
        interval: IntArray | None = None,
    ) -> None:
        self._motion = motion
        self._layout = layout
        self._limit = limit
        self._power = power
        self._interval = interval
        count = 2 * len(motion)
        self.lower, self.upper = np.full(count, -np.inf), np.zeros(count)
        free = interval is not None and layout.stretches
        self._stretch = layout.stretch[interval] if free else None

    def _bound(self, x: FloatArray, power: float) -> FloatArray:
        width = 1.0 if self._interval is None else self._layout.width(x)[self._interval]
        return np.asarray(self._limit * width * x[0] ** power)

    @property
    def jacobian_places(self) -> Places:
        rows, columns = self._motion.jacobian_places
        count = len(self._motion)
        own = np.arange(count)
        extra = [(own, np.zeros(count, dtype=np.int64))]
        if self._stretch is not None:
            extra.append((own, self._stretch))
        r = np.concatenate([rows, *(e[0] for e in extra)])
        c = np.concatenate([columns, *(e[1] for e in extra)])
        return np.concatenate([r, r + count]), np.concatenate([c, c])

    def values(self, x: FloatArray) -> FloatArray:
        value, bound = self._motion.values(x), self._bound(x, self._power)
        return np.concatenate([value - bound, -value - bound])

    def jacobian(self, x: FloatArray) -> FloatArray:
        motion = self._motion.jacobian(x)
        rest = [-self._power * self._bound(x, self._power - 1.0)]
        if self._stretch is not None:
            assert self._interval is not None
            rate = self._layout.grid.width[self._interval]
            rest.append(-self._limit * rate * x[0] ** self._power)
        tail = np.concatenate(rest)
        return np.concatenate([motion, tail, -motion, tail])

    @property
    def hessian_places(self) -> Places:
        rows, columns = self._motion.hessian_places
        s = np.zeros(1, dtype=np.int64)
        if self._stretch is None:
            return np.concatenate([rows, s]), np.concatenate([columns, s])
        zero = np.zeros(len(self._stretch), dtype=np.int64)
        return (
            np.concatenate([rows, s, zero, self._stretch]),
            np.concatenate([columns, s, self._stretch, zero]),
        )

    def hessian(self, x: FloatArray, multipliers: FloatArray) -> FloatArray:
        above, below = np.split(multipliers, 2)
        both, r = above + below, self._power
        motion = self._motion.hessian(x, above - below)
        bend = -r * (r - 1.0) * np.sum(both * self._bound(x, r - 2.0))
        if self._stretch is None:
            return np.append(motion, bend)
        assert self._interval is not None
        rate = self._layout.grid.width[self._interval]
        cross = -r * both * self._limit * rate * x[0] ** (r - 1.0)
        return np.concatenate([motion, [bend], cross, cross])


def _coefficients(
    layout: VariableLayout, limit: FloatArray, hull: FloatArray
) -> tuple[IntArray, IntArray, IntArray]:
    """Interval, Bernstein coefficient and joint of every row of the limits (n,) that there are."""
    chosen = np.flatnonzero(np.isfinite(limit))
    interval, which, joint = (
        index.ravel() for index in np.indices((len(layout.grid), len(hull), len(chosen)))
    )
    return interval, which, chosen[joint]


def velocity_rows(layout: VariableLayout, limit: FloatArray) -> HullRows | None:
    """|q̇| ≤ limit (n,), everywhere."""
    # The last coefficient of an interval is the first one of the next.
    hull = layout.scheme.velocity_hull[:-1]
    interval, which, joint = _coefficients(layout, limit, hull)
    if not len(joint):
        return None
    start = layout.d[layout.first[interval], joint][:, None]
    e = layout.e[layout.rise[interval], joint[:, None]]
    ones = np.ones((len(interval), 1))
    motion = MotionRows(layout, interval, (start, ones), (e, hull[which]))
    return HullRows(motion, layout, limit[joint], 0.5)


def acceleration_rows(layout: VariableLayout, limit: FloatArray) -> HullRows | None:
    """|q̈| ≤ limit (n,), everywhere."""
    hull = layout.scheme.acceleration_hull
    interval, which, joint = _coefficients(layout, limit, hull)
    if not len(joint):
        return None
    if len(hull) > 1:
        # An end that is the next interval's beginning is looked at there.
        follows = np.append(layout.rise[1:, 0] == layout.rise[:-1, -1], False)
        keep = (which < len(hull) - 1) | ~follows[interval]
        interval, which, joint = interval[keep], which[keep], joint[keep]
    e = layout.e[layout.rise[interval], joint[:, None]]
    return HullRows(MotionRows(layout, interval, (e, hull[which])), layout, limit[joint], 1.0)


def jerk_rows(layout: VariableLayout, limit: FloatArray) -> HullRows | None:
    """|q⃛| ≤ limit (n,) within the intervals."""
    hull = layout.scheme.jerk_hull
    interval, which, joint = _coefficients(layout, limit, hull)
    if not len(joint):
        return None
    e = layout.e[layout.rise[interval], joint[:, None]]
    motion = MotionRows(layout, interval, (e, hull[which]))
    return HullRows(motion, layout, limit[joint], 1.5, interval)


class DurationRow:
    """The stretched widths sum to one."""

    def __init__(self, layout: VariableLayout) -> None:
        grid = layout.grid
        self._share = np.bincount(grid.group, grid.width, grid.groups)
        self._columns = 1 + np.arange(grid.groups)
        self.lower = self.upper = np.ones(1)
        self.jacobian_places = np.zeros(grid.groups, dtype=np.int64), self._columns
        self.hessian_places = NOTHING

    def values(self, x: FloatArray) -> FloatArray:
        return np.array([self._share @ x[self._columns]])

    def jacobian(self, x: FloatArray) -> FloatArray:
        return np.asarray(self._share, dtype=np.float64)

    def hessian(self, x: FloatArray, multipliers: FloatArray) -> FloatArray:
        return np.zeros(0)


class GivenVelocity:
    """d = v T₀ √S at a node where a velocity other than rest is wanted.

    Args:
        places: (n,), of d in x.
        velocity: (n,), v T₀.
    """

    def __init__(self, places: IntArray, velocity: FloatArray) -> None:
        self._places, self._velocity = places, velocity
        count = len(places)
        self.lower = self.upper = np.zeros(count)
        own = np.arange(count)
        zero = np.zeros(count, dtype=np.int64)
        self.jacobian_places = np.concatenate([own, own]), np.concatenate([places, zero])
        self.hessian_places = np.zeros(1, dtype=np.int64), np.zeros(1, dtype=np.int64)

    def values(self, x: FloatArray) -> FloatArray:
        return np.asarray(x[self._places] - self._velocity * np.sqrt(x[0]))

    def jacobian(self, x: FloatArray) -> FloatArray:
        return np.concatenate([np.ones(len(self._places)), -0.5 * self._velocity / np.sqrt(x[0])])

    def hessian(self, x: FloatArray, multipliers: FloatArray) -> FloatArray:
        return np.array([0.25 * float(multipliers @ self._velocity) * x[0] ** -1.5])
