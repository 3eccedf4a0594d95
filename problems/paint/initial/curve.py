"""The first curve: sweeps to and fro over the part, turns between, maybe a second coat across."""

from __future__ import annotations

import itertools
import math
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from ....core.arrays import BoolArray, FloatArray
from ....core.errors import InputError, Note
from ..spray.footprint import Footprint
from ..spray.trajectory import PaintTrajectory
from ..surface.part import Part
from .fan import fan_across
from .guide import Guide
from .plan import Coats, Gun, Method, SweepPlan
from .projection import Projector, SprayFrames
from .raster import Rectangle, raster, rectangle_round, view_of
from .remarks import missed_notes, ripple_notes, spacing_notes
from .sideways import sideways
from .spacing import Ripple, predicted_ripple
from .sweep import Sweep, fit

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
        ripple: predicted for a plane; None without a footprint.
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
        footprint: of the gun, to predict how even the coat gets, and to hold the long axis of an
            elliptic one across the sweeps; None to leave that out.

    Raises:
        InputError: the part cannot be seen as planned, or no sweep meets it.
    """
    guide = Guide(part, plan.holes, view_of(part, plan))
    first = rectangle_round(part, guide, plan)
    rectangles = (first,) if plan.coats is Coats.ONE else (first, first.crossed)
    projector = Projector(guide, plan, first.spray)
    coats = [_sweeps(part, projector, rectangle) for rectangle in rectangles]
    driven = [_to_and_fro(coats[0])]
    for coat in coats[1:]:
        driven.append(_nearest_begin(coat, driven[-1][-1]))
    frames, painting, number = _strung(plan, driven)
    position = frames.point - plan.distance * frames.spray
    length = np.linalg.norm(np.diff(position, axis=0), axis=1)
    plain = footprint is None or footprint.aspect == 1.0
    trajectory = PaintTrajectory(
        position,
        frames.spray,
        np.maximum(length / plan.speed, SHORTEST),
        painting.astype(float),
        None if plain else fan_across(frames, number),
    )
    ripple = None
    if footprint is not None:
        ripple = predicted_ripple(footprint, plan.distance, plan.sweep_width)
    spacing = [note for coat in coats for note in spacing_notes(part, plan, coat, footprint)]
    sweeps = [sweep for coat in driven for sweep in coat]
    notes = (
        *part.notes,
        *spacing,
        *ripple_notes(plan, footprint, ripple),
        *missed_notes(part, plan, sweeps),
    )
    return InitialCurve(trajectory, frames.point, number, tuple(sweeps), ripple, notes)


def _sweeps(part: Part, projector: Projector, rectangle: Rectangle) -> list[Sweep]:
    """The sweeps of one coat, side by side, all in one direction.

    Raises:
        InputError: none meets the surface.
    """
    plan = projector.plan
    projected = [fit(projector, line, math.inf) for line in raster(rectangle, plan)]
    sweeps = [sweep for sweep in projected if sweep is not None]
    if not sweeps:
        raise InputError(
            f"{part.name}: no sweep meets the surface; check the view, and that the sweep width of "
            f"{plan.sweep_width:g} m and the edge offset of {plan.offset:g} m suit its size"
        )
    return sideways(projector, sweeps) if plan.method is Method.SIDEWAYS else sweeps


def _to_and_fro(sweeps: list[Sweep]) -> list[Sweep]:
    """Every second sweep driven back."""
    return [sweep if k % 2 == 0 else sweep.reversed() for k, sweep in enumerate(sweeps)]


def _nearest_begin(sweeps: list[Sweep], last: Sweep) -> list[Sweep]:
    """The sweeps to and fro, from that of their four corners that is nearest to a sweep's end."""
    back = [sweep.reversed() for sweep in sweeps]
    ways = [_to_and_fro(side[::order]) for side in (sweeps, back) for order in (1, -1)]
    here = last.frames.point[-1]
    return min(ways, key=lambda way: float(np.linalg.norm(way[0].frames.point[0] - here)))


def _strung(
    plan: SweepPlan, coats: list[list[Sweep]]
) -> tuple[SprayFrames, BoolArray, NDArray[np.int64]]:
    """Sweeps with turns between: waypoints, whether segments are painted, sweeps' numbers."""
    pieces: list[SprayFrames] = []
    flags: list[BoolArray] = []
    numbers: list[NDArray[np.int64]] = []
    number = itertools.count()
    for coat in coats:
        for k, sweep in enumerate(coat):
            if pieces:
                turn = _turn(plan, pieces[-1], sweep.frames)
                flags.append(np.full(len(turn.point) + 1, plan.turns is Gun.ON and k > 0))
                pieces.append(turn)
                numbers.append(np.full(len(turn.point), -1))
            pieces.append(sweep.frames)
            over = sweep.feasible[1:] & sweep.feasible[:-1]
            flags.append(over | (plan.gaps is Gun.ON))
            numbers.append(np.full(len(sweep.feasible), next(number)))
    frames = SprayFrames(*(np.concatenate(values) for values in zip(*pieces, strict=True)))
    return frames, np.concatenate(flags), np.concatenate(numbers)


def _turn(plan: SweepPlan, one: SprayFrames, two: SprayFrames) -> SprayFrames:
    """Waypoints straight from the end of a sweep to the start of the next, without both.

    Neither the gun nor its place on the surface moves by more than a longest segment between them.
    """
    start, end = one.at([-1]), two.at([0])
    way = end.point - start.point
    gun = way - plan.distance * (end.spray - start.spray)
    gap = max(float(np.linalg.norm(way)), float(np.linalg.norm(gun)))
    count = max(1, math.ceil(gap / plan.longest_segment * (1.0 - 1e-6)))
    share = (np.arange(1, count) / count)[:, None]
    spray = (1.0 - share) * start.spray + share * end.spray
    spray /= np.maximum(np.linalg.norm(spray, axis=1, keepdims=True), 1e-12)
    tangent = way - np.einsum("ij,kj->ik", spray, way) * spray
    tangent /= np.maximum(np.linalg.norm(tangent, axis=1, keepdims=True), 1e-12)
    return SprayFrames(start.point + share * way, tangent, spray)
