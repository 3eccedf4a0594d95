"""Options of writers and patchers: given as text by name, and checked here."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from enum import StrEnum
from typing import TypeVar

from ...errors import InputError, UnknownNameError

Choice = TypeVar("Choice", bound=StrEnum)


class Sharing(StrEnum):
    """What becomes of a change that the text as it stands has no place for."""

    REFUSE = "refuse"
    """It is an error that names the move."""
    OWN = "own"
    """The move gets numbers of its own: a datum, a literal or settings, as the language has it."""


class OpaqueStyle(StrEnum):
    """What becomes of what was kept as text: statements, and actions along a move."""

    KEEP = "keep"
    """It is written as it stands: for programs that were read from the same language. What it
    names must exist in the new program or on the controller; a writer refuses what it sees cannot
    stand there."""
    COMMENT = "comment"
    """It becomes a comment: for programs from another language, and where only the motion
    counts."""


AS_COMMENTS = f"option opaque={OpaqueStyle.COMMENT}, on the command line --opaque comment"
"""How a user has it done, for messages."""


@dataclass(frozen=True, slots=True)
class PatchOptions:
    """How a program's own files are patched.

    Args:
        shared: for literals that are to say one thing for this move and another for another.
        derived: for what the program computes, and what no literal of its files states.
    """

    shared: Sharing = Sharing.REFUSE
    derived: Sharing = Sharing.REFUSE

    @classmethod
    def of(cls, options: Mapping[str, str], patcher: str) -> PatchOptions:
        """From options by name.

        Args:
            options: ``shared`` and ``derived``, each ``refuse`` or ``own``.
            patcher: whose they are, for messages: "RAPID patcher".

        Raises:
            InputError: an unknown option or value.
        """
        check_names(options, ("shared", "derived"), patcher)
        return cls(
            choice(options, "shared", Sharing.REFUSE), choice(options, "derived", Sharing.REFUSE)
        )


def check_names(options: Mapping[str, str], known: tuple[str, ...], part: str) -> None:
    """Refuse options that there are not.

    Args:
        options: by name.
        known: the names that there are.
        part: whose they are, for messages: "RAPID writer".

    Raises:
        UnknownNameError: naming the option.
    """
    for name in options:
        if name not in known:
            raise UnknownNameError(f"option of the {part}", name, known)


def choice(options: Mapping[str, str], name: str, default: Choice) -> Choice:
    """The value of an option, or ``default``.

    Raises:
        InputError: it is none of those that there are.
    """
    kind = type(default)
    value = options.get(name, default)
    try:
        return kind(value)
    except ValueError:
        raise InputError(f"option {name}: one of {', '.join(kind)}, not {value!r}") from None
