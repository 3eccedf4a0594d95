"""How far a zone may reach towards a neighbouring point: no further than half the way to it.

The emulator cuts zones there, and what makes zones larger asks here how large they may be. The
share of the way is the model's ``neighbour_fraction``.
"""

from __future__ import annotations

import math
from collections.abc import Sequence

from ...arrays import FloatArray
from ...robot.kinematics.chain import Chain
from .reach import Part, Reach
from .segments import ARC_SEGMENT, JOINT_SEGMENT, Segments
from .zone_exits import ways

STILL = 1e-7
"""m of TCP path below which a segment counts as pure reorientation."""


class NeighbourWays:
    """TCP distances (m) up to which zones may reach along the segments on both their sides.

    Args:
        segments: of the path.
        chains: of each segment.
        share: of the way to the neighbouring point.
    """

    def __init__(self, segments: Segments, chains: Sequence[Chain], share: float) -> None:
        self._segments, self._chains, self._share = segments, chains, share
        # Plain numbers: asked for one by one.
        self._kinds: list[int] = segments.ends.kind.tolist()
        self._lengths: list[float] = segments.length.tolist()
        self._lines: dict[int, tuple[FloatArray, FloatArray]] = {}
        self._known: dict[tuple[int, int], Reach | None] = {}

    def way(self, segment: int, corner: int) -> Reach | None:
        """Along a segment, from the corner between segments ``corner`` and ``corner + 1``.

        Returns:
            None where the TCP stands still, so that no distance says how far.
        """
        key = segment, corner
        if key not in self._known:
            self._known[key] = self._made(segment, corner)
        return self._known[key]

    def _made(self, segment: int, corner: int) -> Reach | None:
        segments, share = self._segments, self._share
        kind, length = self._kinds[segment], self._lengths[segment]
        if kind == JOINT_SEGMENT:
            return self._on_joint_line(segment, corner)
        if length < STILL:
            return None
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

    def _on_joint_line(self, segment: int, corner: int) -> Reach | None:
        chain, near = self._chains[segment], int(segment == corner)
        if id(chain) not in self._lines:
            self._lines[id(chain)] = ways(chain, self._segments.ends.q, self._share)
        distance, slopes = self._lines[id(chain)]
        if distance[segment, near] < STILL:
            return None
        by_near, by_far = slopes[segment, near]
        parts = (f"q{near}", segment, by_near), (f"q{1 - near}", segment, by_far)
        return Reach(float(distance[segment, near]), parts)
