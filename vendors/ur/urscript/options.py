"""How a script is written, and how one is patched."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from enum import StrEnum
from typing import TypeVar

from ....core.errors import InputError, UnknownNameError

Choice = TypeVar("Choice", bound=StrEnum)


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


class DatumStyle(StrEnum):
    """What becomes of numbers that a move does not have for itself."""

    KEEP = "keep"
    """They are changed where they stand if all who read them agree; else the patch is refused."""
    OWN = "own"
    """The move gets literals of its own in their place."""


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
        _check_names("option of the URScript writer", options, ("zones", "opaque", "shares"))
        return cls(
            _choice(options, "zones", ZoneStyle.OWN),
            _choice(options, "opaque", OpaqueStyle.KEEP),
            _choice(options, "shares", ShareStyle.MOVEJ),
        )


@dataclass(frozen=True, slots=True)
class PatchOptions:
    """How a script is patched.

    Args:
        shared: of numbers that several moves read; see `DatumStyle`.
        derived: of parts of a move that the script computes; see `DatumStyle`.
    """

    shared: DatumStyle = DatumStyle.KEEP
    derived: DatumStyle = DatumStyle.KEEP

    @classmethod
    def of(cls, options: Mapping[str, str]) -> PatchOptions:
        """The options by name.

        Raises:
            InputError: an unknown name or value.
        """
        _check_names("option of the URScript patcher", options, ("shared", "derived"))
        return cls(
            _choice(options, "shared", DatumStyle.KEEP),
            _choice(options, "derived", DatumStyle.KEEP),
        )


def _check_names(kind: str, options: Mapping[str, str], known: tuple[str, ...]) -> None:
    for name in options:
        if name not in known:
            raise UnknownNameError(kind, name, known)


def _choice(options: Mapping[str, str], name: str, default: Choice) -> Choice:
    kind = type(default)
    value = options.get(name, default)
    try:
        return kind(value)
    except ValueError:
        raise InputError(f"option {name}: one of {', '.join(kind)}, not {value!r}") from None
