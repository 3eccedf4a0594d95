"""Time stamping: the fastest motion along a path whose geometry is fixed.

The path is cut into K intervals of the path parameter σ. With x = σ̇² at the knots and u = σ̈
constant in each interval, a velocity limit is a ceiling on x and an acceleration limit is a row

    lower ≤ a u + b x_e ≤ upper,        u = (x_{k+1} - x_k) / (2 Δ_k)

at both ends e of each interval (for joint j: a = q_j', b = q_j''; the same for a TCP speed, a
torque, a force). Demanding it at both ends, with the one-sided derivatives of the interval, keeps
the limits between the knots too, which rows at single knots do not.

Two sweeps find the stamp. The one from the end gives at each knot an x_k up to which the end can
be reached; the one from the start then goes as fast as that allows. Standing still must be allowed
everywhere (lower ≤ 0 ≤ upper), so only the upper end of the controllable set is needed, and the
sweep forward cannot get stuck.

Where every row lets x_k grow with x_{k+1} (|q''| Δ small against |q'|), that x_k is the greatest
possible and the stamp is the fastest of all. Where a joint reverses between two knots, a greater
x_k costs x_{k+1}: the sweep takes the greatest sum of both. On smooth paths that is faster than
the greatest x_k, and the same in both directions of travel.

Source: Pham and Pham, "A new approach to time-optimal path parameterization based on
reachability analysis", IEEE Transactions on Robotics 34 (2018); both-ends rows are the
"interpolation" scheme of its section on discretisation.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ...arrays import FloatArray, IntArray
from ...errors import InputError, MotionError
from . import stamping_kernels as kernels

# A boundary speed may miss what is possible by rounding.
BOUNDARY_TOLERANCE = 1e-9


class StampingError(MotionError):
    """A path that cannot be given times.

    Args:
        message: what is wrong and what to do.
        knot: the knot concerned, or the left knot of the interval concerned.
        row: the row concerned, if one is.
    """

    def __init__(self, message: str, knot: int, row: int | None = None) -> None:
        super().__init__(message)
        self.knot = knot
        self.row = row


class StandingStillError(StampingError):
    """Standing still on the path already breaks a limit, as gravity may with torque limits."""


class HalfPlane(NamedTuple):
    """One side of one row: ``end`` 0 left and 1 right, ``row`` in 0 … R - 1."""

    end: int
    row: int
    upper: bool


@dataclass(frozen=True, slots=True, eq=False)
class StampLimits:
    """What bounds the speed along a path of K intervals with R rows each.

    Args:
        spacing: (K,) > 0, Δσ of each interval.
        a: (K, 2, R), factor of u in row r at end e (0 left, 1 right).
        b: (K, 2, R), factor of x_e.
        lower: (K, 2, R) ≤ 0, may be -inf.
        upper: (K, 2, R) ≥ 0, may be inf.
        ceiling: (K + 1,) ≥ 0, greatest x at each knot: 0 at a stop, may be inf.
    """

    spacing: FloatArray
    a: FloatArray
    b: FloatArray
    lower: FloatArray
    upper: FloatArray
    ceiling: FloatArray

    def __post_init__(self) -> None:
        for name in self.__slots__:
            value = np.ascontiguousarray(getattr(self, name), dtype=np.float64)
            object.__setattr__(self, name, value)
        shape = self.a.shape
        if self.spacing.ndim != 1 or len(self.spacing) == 0:
            raise InputError(f"spacing has shape {self.spacing.shape}; it must be (K,), K ≥ 1")
        count = len(self.spacing)
        if len(shape) != 3 or shape[:2] != (count, 2):
            raise InputError(f"a has shape {shape}; it must be ({count}, 2, R)")
        for name in ("b", "lower", "upper"):
            if getattr(self, name).shape != shape:
                raise InputError(f"{name} has shape {getattr(self, name).shape}, a has {shape}")
        if self.ceiling.shape != (count + 1,):
            raise InputError(f"ceiling has shape {self.ceiling.shape}; it must be ({count + 1},)")

    @property
    def rows(self) -> kernels.StampRows:
        """The rows, as the kernels take them."""
        return kernels.StampRows(self.a, self.b, self.lower, self.upper)


def joint_limits(
    spacing: FloatArray,
    dq: FloatArray,
    ddq: FloatArray,
    velocity: FloatArray,
    acceleration_lower: FloatArray,
    acceleration_upper: FloatArray,
) -> StampLimits:
    """Limits from joint velocities and accelerations: q̈ = q' u + q'' x, q̇² = q'² x.

    Args:
        spacing: (K,), Δσ of each interval.
        dq: (K, 2, N), q' at both ends of each interval, one-sided.
        ddq: (K, 2, N), q'' likewise.
        velocity: (N,) > 0 rad/s, greatest joint speeds.
        acceleration_lower: (N,) ≤ 0 rad/s².
        acceleration_upper: (N,) ≥ 0 rad/s².
    """
    dq = np.ascontiguousarray(dq, dtype=np.float64)
    lower, upper, ceiling = np.empty(dq.shape), np.empty(dq.shape), np.zeros(len(dq) + 1)
    kernels.fill_joint_limits(
        dq, velocity, acceleration_lower, acceleration_upper, lower, upper, ceiling
    )
    return StampLimits(spacing, dq, ddq, lower, upper, ceiling)


@dataclass(frozen=True, slots=True, eq=False)
class Stamp:
    """Times along a path, and what its derivative needs.

    Args:
        limits: what bounded the speed (kept, not copied: leave its arrays as they are).
        x: (K + 1,), squared path speed σ̇² at each knot.
        t: (K + 1,) s, time of each knot, from 0.
        limit: (K,), what holds the speed down in each interval: the code of a half-plane (see
            ``half_plane``), ``CEILING`` (a ceiling at its left knot) or ``NEXT`` (the interval
            in which speeding up ends, cut short by what comes after it).
        at_ceiling: (K + 1,) bool, knots at which x is the ceiling.
        top: (K + 1,), the x from which the sweep back found that the end can be reached.
        partner: (K,), the x_{k+1} that goes with x_k = top_k.
        pair: (K, 2), codes of the half-planes that meet in (top_k, partner_k).
        source: (K,), code of the half-plane that gave x_{k+1} from x_k.
    """

    limits: StampLimits
    x: FloatArray
    t: FloatArray
    limit: IntArray
    at_ceiling: NDArray[np.bool_]
    top: FloatArray
    partner: FloatArray
    pair: IntArray
    source: IntArray

    @property
    def duration(self) -> float:
        """Time from the first knot to the last, s."""
        return float(self.t[-1])

    @property
    def u(self) -> FloatArray:
        """Path acceleration σ̈ in each interval, (K,)."""
        return np.diff(self.x) / (2.0 * self.limits.spacing)

    def half_plane(self, code: int) -> HalfPlane:
        """The row, end and side that a code ≥ 0 in ``limit`` stands for."""
        end, row = divmod(code >> 1, self.limits.a.shape[2])
        return HalfPlane(end, row, bool(code & 1))


def stamp(limits: StampLimits, x_start: float = 0.0, x_end: float = 0.0) -> Stamp:
    """The fastest stamp within the limits.

    Args:
        limits: what bounds the speed.
        x_start: σ̇² at the first knot.
        x_end: σ̇² at the last knot.

    Raises:
        InputError: a value is not finite or has the wrong sign.
        StandingStillError: a row forbids standing still.
        StampingError: nothing bounds the speed at a knot; the path cannot leave two neighbouring
            stops; or a boundary speed is out of reach.
    """
    _check(limits, x_start, x_end)
    count = len(limits.spacing)
    top, x, t = np.empty(count + 1), np.empty(count + 1), np.empty(count + 1)
    partner, pair = np.empty(count), np.empty((count, 2), dtype=np.int64)
    source, limit = np.empty(count, dtype=np.int64), np.empty(count, dtype=np.int64)
    planes = np.empty((4 * limits.a.shape[2] + 4, 3))
    knot = kernels.sweep_back(
        limits.spacing, limits.rows, limits.ceiling, x_end, planes, top, partner, pair
    )
    if knot >= 0:
        raise StampingError(
            f"nothing bounds the path speed at knot {knot}: give it a ceiling, or a limit on "
            "something that moves there",
            knot,
        )
    _check_boundary("start", 0, x_start, top[0])
    interval = kernels.sweep_forth(
        limits.spacing, limits.rows, x_start, top, partner, pair, x, t, source, limit
    )
    if interval >= 0:
        raise StampingError(
            f"the path stands still at both ends of interval {interval} and cannot cross it: "
            f"raise the ceiling at knot {interval} or {interval + 1}, or loosen the rows there",
            interval,
        )
    _check_boundary("end", count, x_end, x[-1])
    return Stamp(limits, x, t, limit, x == limits.ceiling, top, partner, pair, source)


def _check(limits: StampLimits, x_start: float, x_end: float) -> None:
    """Refuse values that the sweeps are not made for."""
    interval, knot, row = kernels.first_unsound(limits.spacing, limits.ceiling, limits.rows)
    if interval >= 0:
        length = limits.spacing[interval]
        raise InputError(f"interval {interval} has length {length}; it must be positive")
    if knot >= 0:
        raise InputError(f"the ceiling at knot {knot} is {limits.ceiling[knot]}; it must be ≥ 0")
    if not (0.0 <= x_start < np.inf and 0.0 <= x_end < np.inf):
        raise InputError(f"x_start = {x_start} and x_end = {x_end} must be finite and ≥ 0")
    if row >= 0:
        _refuse_row(limits, row)


def _refuse_row(limits: StampLimits, index: int) -> None:
    """Say what is wrong with a row, given its flat index in (K, 2, R)."""
    interval, end, row = (int(i) for i in np.unravel_index(index, limits.a.shape))
    at = interval, end, row
    a, b, lower, upper = limits.a[at], limits.b[at], limits.lower[at], limits.upper[at]
    where = f"row {row} at the {('left', 'right')[end]} end of interval {interval}"
    if not (np.isfinite(a) and np.isfinite(b) and lower <= upper):
        raise InputError(f"{where} is unusable: {lower} ≤ {a} u + {b} x ≤ {upper}")
    raise StandingStillError(
        f"{where} (knot {interval + end}) allows {lower} to {upper}, without zero: standing still "
        "there already breaks this limit; change the configuration, the load or the limit",
        interval + end,
        row,
    )


def _check_boundary(name: str, knot: int, wanted: float, possible: float) -> None:
    """Refuse a boundary speed that the limits do not let the path have."""
    if wanted > possible * (1.0 + BOUNDARY_TOLERANCE):
        raise StampingError(
            f"the path cannot have the squared speed {wanted} at its {name}: the limits allow "
            f"{possible}",
            knot,
        )
