"""How a script is written."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from enum import StrEnum

from ....core.source.options import check_names, choice


class ZoneStyle(StrEnum):
    """Which zones a script uses. URScript has no predefined ones."""

    OWN = "own"
    """The program's zones as they are: ``r=`` in m."""


class ShareStyle(StrEnum):
    """How joint moves are written whose speed is a share of what the robot can do."""

    MOVEJ = "movej"
    """As ``movej`` with the speed and acceleration of the leading joint that come to the same."""
    OPTIMOVE = "optimove"
    """As ``optimovej``, and lines as ``optimovel``: for PolyScope 5.21 and 10.8 or later."""


class OpaqueStyle(StrEnum):
    """What becomes of statements that were kept as text, and of events along a move."""

    KEEP = "keep"
    """Statements are written as they stand: for programs that were read from URScript. What they
    name must exist in the script or on the controller. Events are refused: URScript has none."""
    COMMENT = "comment"
    """Both become comments: for programs from another language."""


@dataclass(frozen=True, slots=True)
class ScriptOptions:
    """How a script is written.

    Args:
        zones: see `ZoneStyle`.
        opaque: see `OpaqueStyle`.
        shares: see `ShareStyle`.
    """

    zones: ZoneStyle = ZoneStyle.OWN
    opaque: OpaqueStyle = OpaqueStyle.KEEP
    shares: ShareStyle = ShareStyle.MOVEJ

    @classmethod
    def of(cls, options: Mapping[str, str]) -> ScriptOptions:
        """The options by name.

        Raises:
            InputError: an unknown name or value.
        """
        check_names(options, ("zones", "opaque", "shares"), "URScript writer")
        return cls(
            choice(options, "zones", ZoneStyle.OWN),
            choice(options, "opaque", OpaqueStyle.KEEP),
            choice(options, "shares", ShareStyle.MOVEJ),
        )
