"""The first curve: sweeps to and fro over the part, turns between them, a second coat across."""

from __future__ import annotations

import math
from dataclasses import dataclass, field, replace

import numpy as np
from numpy.typing import NDArray

from ....core.errors import InputError, Note
from ..footprint import Footprint
from ..part import Part
from ..trajectory import PaintTrajectory
from .guide import Guide
from .plan import Gun, Method, SweepPlan
from .projection import Frames, Projector
from .raster import raster, rectangle_round, view_of
from .remarks import missed_notes, ripple_notes, spacing_notes
from .sideways import sideways
from .spacing import Ripple, predicted_ripple
from .sweep import Sweep, fit

FloatArray = NDArray[np.float64]
BoolArray = NDArray[np.bool_]

SHORTEST = 1e-3
"""s; no segment takes less, even where the gun only turns."""


@dataclass(frozen=True, eq=False)
class InitialCurve:
    """A first curve.

    Args:
        trajectory: the gun's motion, at one speed.
        base: (W, 3) m, the waypoints' places on the surface or its extension.
        sweep: (W,) index of the sweep that each waypoint belongs to; -1 in turns.
        sweeps: in the order in which they are driven.
        ripple: predicted for a plane; None without a symmetric footprint.
        notes: what a user should know.
    """

    trajectory: PaintTrajectory
    base: FloatArray
    sweep: NDArray[np.int64]
    sweeps: tuple[Sweep, ...]
    ripple: Ripple | None = None
    notes: tuple[Note, ...] = field(default=(), repr=False)


def initial_curve(part: Part, plan: SweepPlan, footprint: Footprint | None = None) -> InitialCurve:
    """The first curve over a part.

    Args:
        part: the part.
        plan: the coat wanted.
        footprint: of the gun, to predict how even the coat gets; None to leave that out.

    Raises:
        InputError: the part cannot be seen as planned, or no sweep meets it.
    """
    guide = Guide(part, plan.holes, view_of(part, plan))
    rectangle = rectangle_round(part, guide, plan)
    projector = Projector(guide, plan, rectangle.spray)
    lines = raster(rectangle, plan)
    projected = [fit(projector, line, math.inf) for line in lines]
    sweeps = [sweep for sweep in projected if sweep is not None]
    if not sweeps:
        raise InputError(
            f"{part.name}: no sweep meets the surface; check the view, and that the sweep width of "
            f"{plan.sweep_width:g} m and the edge offset of {plan.offset:g} m suit its size"
        )
    if plan.method is Method.SIDEWAYS:
        sweeps = sideways(projector, sweeps)
    driven = [sweep if k % 2 == 0 else sweep.reversed() for k, sweep in enumerate(sweeps)]
    frames, painting, number = _strung(plan, driven)
    position = frames.point - plan.distance * frames.spray
    length = np.linalg.norm(np.diff(position, axis=0), axis=1)
    trajectory = PaintTrajectory(
        position,
        frames.spray,
        np.maximum(length / plan.speed, SHORTEST),
        painting.astype(float),
    )
    ripple = None
    if footprint is not None and footprint.aspect == 1.0:
        ripple = predicted_ripple(footprint, plan.distance, plan.sweep_width)
    notes = (
        *part.notes,
        *spacing_notes(part, plan, sweeps, footprint),
        *ripple_notes(plan, footprint, ripple),
        *missed_notes(part, plan, sweeps),
    )
    return InitialCurve(trajectory, frames.point, number, tuple(driven), ripple, notes)


def cross_hatched(
    part: Part, plan: SweepPlan, footprint: Footprint | None = None, speed: float | None = None
) -> tuple[InitialCurve, InitialCurve, PaintTrajectory]:
    """Two coats, the second across the first, and both in one motion with the gun off between.

    Each coat is half as thick as one alone would be at the same speed and flow: plan for twice the
    speed.

    Args:
        part, plan, footprint: as in `initial_curve`; the plan's heading is that of the first coat.
        speed: m/s on the way from one coat to the other; None for the plan's.

    Raises:
        InputError: as `initial_curve`.
    """
    rectangle = rectangle_round(part, Guide(part, plan.holes, view_of(part, plan)), plan)
    headings = (_as_direction(rectangle.along), _as_direction(rectangle.across))
    one, two = (initial_curve(part, replace(plan, heading=h), footprint) for h in headings)
    ends = (two.trajectory, two.trajectory.reversed())
    here = one.trajectory.position[-1]
    second = min(ends, key=lambda t: float(np.linalg.norm(t.position[0] - here)))
    way = float(np.linalg.norm(second.position[0] - here))
    duration = max(way / (speed or plan.speed), SHORTEST)
    return one, two, one.trajectory.followed_by(second, duration)


def _as_direction(vector: FloatArray) -> tuple[float, float, float]:
    x, y, z = (float(v) for v in vector)
    return x, y, z


def _strung(plan: SweepPlan, sweeps: list[Sweep]) -> tuple[Frames, BoolArray, NDArray[np.int64]]:
    """Sweeps with turns between: waypoints, whether segments are painted, sweeps' numbers."""
    pieces, flags, numbers = [], [], []
    for k, sweep in enumerate(sweeps):
        if k > 0:
            turn = _turn(plan, sweeps[k - 1], sweep)
            pieces.append(turn)
            flags.append(np.full(len(turn.point) + 1, plan.turns is Gun.ON))
            numbers.append(np.full(len(turn.point), -1))
        pieces.append(sweep.frames)
        over = sweep.feasible[1:] & sweep.feasible[:-1]
        flags.append(over | (plan.gaps is Gun.ON))
        numbers.append(np.full(len(sweep.feasible), k))
    frames = Frames(*(np.concatenate(values) for values in zip(*pieces, strict=True)))
    return frames, np.concatenate(flags), np.concatenate(numbers)


def _turn(plan: SweepPlan, one: Sweep, two: Sweep) -> Frames:
    """Waypoints straight from the end of a sweep to the start of the next, without both.

    Neither the gun nor its place on the surface moves by more than a longest segment between them.
    """
    start, end = one.frames.at([-1]), two.frames.at([0])
    way = end.point - start.point
    gun = way - plan.distance * (end.spray - start.spray)
    gap = max(float(np.linalg.norm(way)), float(np.linalg.norm(gun)))
    count = max(1, math.ceil(gap / plan.longest_segment * (1.0 - 1e-6)))
    share = (np.arange(1, count) / count)[:, None]
    spray = (1.0 - share) * start.spray + share * end.spray
    spray /= np.maximum(np.linalg.norm(spray, axis=1, keepdims=True), 1e-12)
    tangent = way - np.einsum("ij,kj->ik", spray, way) * spray
    tangent /= np.maximum(np.linalg.norm(tangent, axis=1, keepdims=True), 1e-12)
    return Frames(start.point + share * way, tangent, spray)
