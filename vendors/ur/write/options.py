"""How a script is written."""

from __future__ import annotations

from dataclasses import dataclass
from enum import StrEnum

from ....core.source.write.options import OpaqueStyle, StructureStyle


class ShareStyle(StrEnum):
    """How joint moves are written whose speed is a share of what the robot can do."""

    MOVEJ = "movej"
    """As ``movej`` with the speed and acceleration of the leading joint that come to the same."""
    OPTIMOVE = "optimove"
    """As ``optimovej``, and lines as ``optimovel``: for PolyScope 5.21 and 10.8 or later."""


@dataclass(frozen=True, slots=True)
class ScriptOptions:
    """How a script is written.

    Args:
        opaque: see `core.source.options.OpaqueStyle`; actions along a move are refused where they
            are to be kept, since URScript has none.
    """

    opaque: OpaqueStyle = OpaqueStyle.KEEP
    structure: StructureStyle = StructureStyle.FLAT
    shares: ShareStyle = ShareStyle.MOVEJ
