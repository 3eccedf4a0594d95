"""What a collision engine answers, whichever library is behind it.

python-fcl answers whether two bodies touch (`fcl_engine`), coal how far they are apart
(`coal_engine`). Simple shapes in batches need neither (`closed_form`).
"""

from __future__ import annotations

from typing import NamedTuple, Protocol

from ...arrays import FloatArray


class BodyPoses(NamedTuple):
    """World poses of all bodies at one configuration.

    Args:
        rotation: (B, 3, 3).
        translation: (B, 3) m.
    """

    rotation: FloatArray
    translation: FloatArray


class Witness(NamedTuple):
    """How two bodies a and b stand to each other: point_a - point_b = distance · normal.

    Args:
        distance: m; negative by the depth where they overlap.
        point_a: (3,) m, the point of a nearest to b (deepest in b), in the world.
        point_b: (3,) m, the same of b.
        normal: (3,), unit vector that leads a away from b.
        measured: False where they overlap in a way that has no depth; ``distance`` is then the
            least depth that they can have, and ``normal`` a likely way out.
    """

    distance: float
    point_a: FloatArray
    point_b: FloatArray
    normal: FloatArray
    measured: bool = True


class ContactEngine(Protocol):
    """Answers whether bodies touch."""

    def touch(self, a: int, b: int, places: BodyPoses) -> bool:
        """Whether bodies a and b touch, overlap, or lie one inside the other."""
        ...


class DistanceEngine(Protocol):
    """Answers how far bodies are apart."""

    def distance(self, a: int, b: int, places: BodyPoses, within: float) -> Witness | None:
        """Signed distance of bodies a and b, None if it is ``within`` m or more."""
        ...
