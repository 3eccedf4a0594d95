"""A user's answers to what programs ask of the world (signals, operators, clocks), by keys."""

from __future__ import annotations

import re
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field, replace

from ...errors import Span
from ...program.question import Answer
from .streams import Stream


class Fields(tuple[tuple[str, "Answer"], ...]):
    """A structure: names of components and their answers, as a table of TOML has them."""

    __slots__ = ()


TABLES = (
    *("values", "sequences", "branches", "passes", "calls", "durations", "streams"),
    "signals",
)
_ROUND_SIGNS = re.compile(r" ?([^\w\s$]) ?")
"""A sign with the blanks round it, which do not count."""


@dataclass(frozen=True)
class Answers:
    """Answers to what a program asks; keys as `key` gives them, lines as ``file:line``.

    Args:
        values: lasting answers.
        sequences: answers in turn.
        branches: number of the branch taken, 0 for none.
        passes: number of passes.
        skipped: names of routines that are not at hand and are stepped over.
        durations: s that the robot stands at statements in which a key stands, as `stands_in` says.
        streams: what is sent to the robot at such statements, once each.
        file: where they come from, for messages.
        goes_on: whether a program goes on behind what nobody knows: a routine that is not at hand
            is stepped over, a move whose target is not known is `open`. Else both are refused.
        mends: whether what is no statement of the language is stepped over. Else it is refused.
        cycles: passes of a loop without an end that moves the robot.
        closes: whether one more is read where the first cycle begins elsewhere than later ones:
            how the robot comes from the end of a cycle to its beginning is known then.
        signals: what signals are called on other robots; a reader does not ask for them.
        cut: why loops are left before their end, as they go on for more moves than are read; empty
            of a loop that has none, in which the program ends.
        stated: what the program asks of its own controller, and a backup of that states; values
            count before it.
    """

    values: Mapping[str, Answer] = field(default_factory=dict)
    sequences: Mapping[str, tuple[Answer, ...]] = field(default_factory=dict)
    branches: Mapping[str, int] = field(default_factory=dict)
    passes: Mapping[str, int] = field(default_factory=dict)
    skipped: frozenset[str] = frozenset()
    durations: Mapping[str, float] = field(default_factory=dict)
    file: str = ""
    goes_on: bool = False
    mends: bool = False
    cycles: int = 1
    closes: bool = False
    signals: Mapping[str, tuple[str, ...]] = field(default_factory=dict)
    streams: Mapping[str, Stream] = field(default_factory=dict)
    cut: Mapping[str, str] = field(default_factory=dict)
    stated: Mapping[str, float] = field(default_factory=dict)

    def names(self, table: str) -> Iterable[str]:
        """What a table of the file has answers to, in their order."""
        own: Mapping[str, Iterable[str]] = {
            "values": self.values,
            "sequences": self.sequences,
            "branches": self.branches,
            "passes": self.passes,
            "calls": sorted(self.skipped),
            "durations": self.durations,
            "streams": self.streams,
            "signals": (),
        }
        return own[table]

    def with_cut(self, loop: Span, count: int, why: str) -> Answers:
        """The same, with one more loop that is left after some passes.

        Args:
            why: see the arguments of the class.
        """
        place = placed(f"{loop.file}:{loop.line}")
        passes, cut = {**self.passes, place: count}, {**self.cut, place: why}
        return replace(self, passes=passes, cut=cut)

    def cut_short(self, loop: Span) -> str | None:
        """Why a loop is left before its end; None if it is not."""
        return self.cut.get(placed(f"{loop.file}:{loop.line}"))

    def with_branch(self, place: str, number: int) -> Answers:
        """The same, with the branch of one more condition."""
        return replace(self, branches={**self.branches, placed(place): number})

    def at(self, table: str, place: str) -> int | None:
        """The branch or the passes at a place, ``file:line``, by the file's path or name alone."""
        entries = self.branches if table == "branches" else self.passes
        file, _, line = placed(place).rpartition(":")
        found = (entries.get(f"{name}:{line}") for name in (file, file.rpartition("/")[2]))
        return next((count for count in found if count is not None), None)


def key(text: str) -> str:
    """How a name or call of a program is looked up: without blanks, in lower case."""
    return "".join(text.split()).casefold()


def stands_in(name: str, text: str) -> bool:
    """Whether a key stands in a statement, as whole words of it.

    Args:
        name: as `key` gives it.
        text: of the statement.
    """
    word = re.compile(rf"(?<![\w$]){re.escape(name)}(?!\w)")
    line = " ".join(text.split()).casefold()
    return any(map(word.search, (key(text), line, _ROUND_SIGNS.sub(r"\1", line))))


def stands_at(name: str, text: str, span: Span | None) -> bool:
    """Whether a key is a statement's place, ``file:line``, or stands in it; see `stands_in`."""
    place = "" if span is None else f"{placed(span.file)}:{span.line}"
    return name in (place, place.rpartition("/")[2]) or stands_in(name, text)


def placed(text: str) -> str:
    """How a file, or a line of it, is looked up."""
    return text.replace("\\", "/").casefold()
