"""How far a zone may reach towards a neighbouring point: no further than half the way to it.

The emulator cuts zones there, and what makes zones larger asks here how large they may be. The
share of the way is the model's ``neighbour_fraction``.
"""

from __future__ import annotations

import math
from collections.abc import Sequence

from ...robot.kinematics.chain import Chain
from .reach import Part, Reach
from .segments import ARC_SEGMENT, JOINT_SEGMENT, Segments
from .zone_exits import tcp_apart

STILL = 1e-7
"""m of TCP path below which a segment counts as pure reorientation."""


def way_towards_neighbour(
    segments: Segments, chains: Sequence[Chain], segment: int, corner: int, share: float
) -> Reach | None:
    """TCP distance (m) of the point of a segment up to which the zone at a corner may reach.

    Args:
        segments: of the path.
        chains: of each segment.
        segment: index of the segment, before or after the corner.
        corner: index of the corner: that between segments ``corner`` and ``corner + 1``.
        share: of the way to the neighbouring point.

    Returns:
        None where the TCP stands still, so that no distance says how far.
    """
    kind = segments.ends.kind[segment]
    if kind == JOINT_SEGMENT:
        return _on_joint_line(segments, chains[segment], segment, corner, share)
    if segments.length[segment] < STILL:
        return None
    length = float(segments.length[segment])
    if kind != ARC_SEGMENT:
        return Reach(share * length, (("length", segment, share),))
    swept = float(segments.angle[segment])
    r = length / swept
    sine, cosine = math.sin(0.5 * share * swept), math.cos(0.5 * share * swept)
    parts: tuple[Part, ...] = (
        ("length", segment, 2 * sine / swept),
        ("arc", segment, -2 * r * sine / swept + share * r * cosine),
    )
    return Reach(2 * r * sine, parts)


def _on_joint_line(
    segments: Segments, chain: Chain, segment: int, corner: int, share: float
) -> Reach | None:
    near, far = (1, 0) if segment == corner else (0, 1)
    q_wp, q_other = segments.ends.q[segment, near], segments.ends.q[segment, far]
    distance, by_near, by_far, _ = tcp_apart(chain, q_wp, q_other, share)
    if distance < STILL:
        return None
    return Reach(distance, ((f"q{near}", segment, by_near), (f"q{far}", segment, by_far)))
