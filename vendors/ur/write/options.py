"""How a script is written."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from enum import StrEnum

from ....core.source.write.options import OpaqueStyle, check_names, choice


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
        shares: see `ShareStyle`.
    """

    opaque: OpaqueStyle = OpaqueStyle.KEEP
    shares: ShareStyle = ShareStyle.MOVEJ

    @classmethod
    def of(cls, options: Mapping[str, str]) -> ScriptOptions:
        """The options by name.

        Raises:
            InputError: an unknown name or value.
        """
        check_names(options, ("opaque", "shares"), "URScript writer")
        return cls(
            choice(options, "opaque", OpaqueStyle.KEEP),
            choice(options, "shares", ShareStyle.MOVEJ),
        )
