"""Options of writers and patchers: given as text by name, and checked here."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, fields
from enum import StrEnum
from typing import Any, TypeVar

from ...door import at_command_line, given
from ...errors import InputError, UnknownNameError

Options = TypeVar("Options", bound=Any)


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


class StructureStyle(StrEnum):
    """What becomes of the loops and routines that a program was read from."""

    FLAT = "flat"
    """All statements are written one after the other, in one routine."""
    KEEP = "keep"
    """Loops whose passes are alike are written as loops, routines as routines."""


def as_comments() -> str:
    """How a user has it done, for messages."""
    return given("opaque", OpaqueStyle.COMMENT if at_command_line() else f'"{OpaqueStyle.COMMENT}"')


@dataclass(frozen=True, slots=True)
class PatcherOptions:
    """How a program's own files are patched.

    Args:
        shared: for literals that are to say one thing for this move and another for another.
        derived: for what the program computes, and what no literal of its files states.
    """

    shared: Sharing = Sharing.REFUSE
    derived: Sharing = Sharing.REFUSE

    @classmethod
    def of(cls, options: Mapping[str, str], patcher: str) -> PatcherOptions:
        """From options by name; see `chosen`."""
        return chosen(cls, options, patcher)


@dataclass(frozen=True, slots=True)
class WriterOptions:
    """How a program is written in a language that has no choices of its own.

    Args:
        opaque: what becomes of what was kept as text.
    """

    opaque: OpaqueStyle = OpaqueStyle.KEEP

    @classmethod
    def of(cls, options: Mapping[str, str], writer: str) -> WriterOptions:
        """From options by name; see `chosen`."""
        return chosen(cls, options, writer)


def chosen(kind: type[Options], options: Mapping[str, str], part: str, **others: object) -> Options:
    """The options of a writer or patcher, from those of its fields that are choices.

    Args:
        kind: a dataclass; a field whose default is of a StrEnum may be chosen by its name.
        part: whose they are, for messages: "RAPID writer".

    Raises:
        InputError: an option is unknown, or has a value that it does not take.
    """
    known = {f.name: f.default for f in fields(kind) if isinstance(f.default, StrEnum)}
    for name, value in options.items():
        if name not in known:
            raise UnknownNameError(f"option of the {part}", name, tuple(known))
        choices = type(known[name])
        if value not in list(choices):
            raise InputError(f"option {name}: one of {', '.join(choices)}, not {value!r}")
        known[name] = choices(value)
    made: Options = kind(**known, **others)
    return made
