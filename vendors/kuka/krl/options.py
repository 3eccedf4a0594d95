"""How a KRL program is written."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from enum import StrEnum

from ....core.source.options import check_names, choice


class ZoneStyle(StrEnum):
    """Which approximation a program uses."""

    OWN = "own"
    """The program's zones as they are; KUKA has no predefined ones."""


class OpaqueStyle(StrEnum):
    """What becomes of statements that were kept as text."""

    KEEP = "keep"
    """They are written as they stand: for programs that were read from KRL. The data and signals
    that they name must exist on the controller."""
    COMMENT = "comment"
    """They become comments: for programs from another language."""


@dataclass(frozen=True, slots=True)
class KrlOptions:
    """How a program is written.

    Args:
        zones: see `ZoneStyle`.
        opaque: see `OpaqueStyle`.
    """

    zones: ZoneStyle = ZoneStyle.OWN
    opaque: OpaqueStyle = OpaqueStyle.KEEP

    @classmethod
    def of(cls, options: Mapping[str, str]) -> KrlOptions:
        """From options by name.

        Raises:
            InputError: an unknown option, or a value that it does not take.
        """
        check_names(options, ("zones", "opaque"), "KRL writer")
        return cls(
            choice(options, "zones", ZoneStyle.OWN), choice(options, "opaque", OpaqueStyle.KEEP)
        )
