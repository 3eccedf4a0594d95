"""The circle tangent to both legs of a corner (URScript: "blend circular").

For a deflection δ and a zone of radius r it has the radius r / tan(δ/2); orientation and
prescribed axes follow the polynomial blend.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ...arrays import FloatArray
from ...spatial.rotation import angle_between
from .corners import POSITION, TCP_CORNER, Corners
from .curves import ARC, Curves
from .segments import LINE_SEGMENT, Segments, SegmentsGradient

_STRAIGHT, _REVERSAL = 1e-4, np.pi - 1e-2
"""rad of deflection below and above which the circle degenerates and the polynomial is kept."""


@dataclass(frozen=True)
class TangentArcs:
    """The arcs of a path's corners; rows where ``live`` is False are not used.

    Args:
        live: (C,) bool, corners of two straight legs that deflect by neither 0 nor π.
        reach: (C, 2), the shares of the legs inside the zones.
        step: (C, 2, 3) m, the legs' own vectors.
        scale: (C, 2), Λ of the legs.
        start: (C, 3) m, where the arcs begin.
    """

    live: NDArray[np.bool_]
    reach: FloatArray
    step: FloatArray
    scale: FloatArray
    start: FloatArray

    def write(self, position: Curves, slopes: FloatArray, count: int) -> None:
        """Put the arcs in place of the polynomial blends of curves ``count`` and on."""
        for i in np.flatnonzero(self.live):
            arc = CornerArc.of(self.reach[i], self.step[i])
            position.kind[count + i] = ARC
            position.angle[count + i] = arc.deflection
            position.control[count + i] = 0.0
            position.control[count + i, 0] = self.start[i] + arc.radius * arc.inward
            position.control[count + i, 1] = -arc.radius * arc.inward
            position.control[count + i, 2] = arc.radius * arc.first
            # d(position)/ds over what one extent on σ of each leg is worth.
            speed = arc.radius * arc.deflection
            slopes[i] = speed / (self.reach[i] * arc.lengths)


@dataclass(frozen=True)
class CornerArc:
    """One arc: unit leg directions, leg lengths, zone radius, deflection, radius, inward normal."""

    lengths: FloatArray
    first: FloatArray
    second: FloatArray
    zone: float
    cosine: float
    deflection: float
    radius: float
    inward: FloatArray

    @classmethod
    def of(cls, reach: FloatArray, step: FloatArray) -> CornerArc:
        lengths = np.linalg.norm(step, axis=1)
        first, second = step[0] / lengths[0], step[1] / lengths[1]
        cosine = float(first @ second)
        zone = float(reach[0] * lengths[0])
        deflection = angle_between(first, second)
        inward = (second - cosine * first) / np.sin(deflection)
        radius = zone / np.tan(0.5 * deflection)
        return cls(lengths, first, second, zone, cosine, deflection, float(radius), inward)


def tangent_arcs(
    segments: Segments, corners: Corners, start: FloatArray, into: FloatArray, out: FloatArray
) -> TangentArcs:
    """Which corners become arcs.

    Args:
        segments: M segments.
        corners: the C = M − 1 corners.
        start: (C, 3) m, where the zones begin.
        into, out: (C, 3) m, the legs' own vectors, before and after the waypoints.
    """
    straight = segments.ends.kind == LINE_SEGMENT
    live = (corners.kind == TCP_CORNER) & straight[:-1] & straight[1:]
    step = np.stack([into, out], 1)
    lengths = np.linalg.norm(step, axis=2)
    live &= (lengths > 1e-9).all(1)
    safe = np.where(lengths > 1e-9, lengths, 1.0)
    unit = step / safe[..., None]
    turn = np.arctan2(
        np.linalg.norm(np.cross(unit[:, 0], unit[:, 1]), axis=1), np.sum(unit[:, 0] * unit[:, 1], 1)
    )
    reach = corners.reach[:, POSITION]
    radii = reach * lengths
    live &= (turn > _STRAIGHT) & (turn < _REVERSAL)
    live &= np.abs(radii[:, 0] - radii[:, 1]) < 1e-9 + 1e-6 * radii[:, 0]
    scale = np.stack([segments.scale[:-1], segments.scale[1:]], -1)
    return TangentArcs(live, reach, step, scale, start)


def pull_tangent_arcs(
    arcs: TangentArcs,
    bar: Curves,
    slopes_bar: FloatArray,
    count: int,
    reach_bar: FloatArray,
    segments_bar: SegmentsGradient,
) -> None:
    """Reverse of `TangentArcs.write`; clears the arcs' rows of ``bar`` that it has used."""
    for i in np.flatnonzero(arcs.live):
        arc = CornerArc.of(arcs.reach[i], arcs.step[i])
        centre, out, along = (bar.control[count + i, j].copy() for j in range(3))
        bar.control[count + i] = 0.0
        turn, radius, sine = arc.deflection, arc.radius, np.sin(arc.deflection)
        speed = radius * turn
        share = slopes_bar[i] / (arcs.reach[i] * arc.lengths)
        speed_bar = float(share.sum())
        reach_bar[i, POSITION] -= share * speed / arcs.reach[i]
        lengths_bar = -share * speed / arc.lengths
        start_bar = centre
        inward_bar = radius * (centre - out)
        radius_bar = float((centre - out) @ arc.inward + along @ arc.first) + speed_bar * turn
        first_bar = radius * along
        turn_bar = float(bar.angle[count + i]) + speed_bar * radius
        zone_bar = radius_bar / np.tan(0.5 * turn)
        turn_bar -= radius_bar * arc.zone * 0.5 / np.sin(0.5 * turn) ** 2
        # inward = (second − cos first) / sin, cos = first · second.
        second_bar = inward_bar / sine
        first_bar -= arc.cosine * inward_bar / sine
        cosine_bar = -float(inward_bar @ arc.first) / sine
        turn_bar -= float(inward_bar @ arc.inward) * arc.cosine / sine
        cosine_bar -= turn_bar / sine
        first_bar += cosine_bar * arc.second
        second_bar = second_bar + cosine_bar * arc.first
        reach_bar[i, POSITION, 0] += zone_bar * arc.lengths[0]
        lengths_bar[0] += zone_bar * arcs.reach[i, 0]
        # start = leg's start + (1 − ρ) step.
        reach_bar[i, POSITION, 0] -= float(start_bar @ arcs.step[i, 0])
        segments_bar.position[i, 0] += start_bar
        segments_bar.position[i, 1] += (1.0 - arcs.reach[i, 0]) * start_bar
        for side, (unit, unit_bar) in enumerate(((arc.first, first_bar), (arc.second, second_bar))):
            length = arc.lengths[side]
            step_bar = (unit_bar - unit * (unit @ unit_bar)) / length
            step_bar += lengths_bar[side] * unit
            segments_bar.position[i + side, 1] += step_bar
