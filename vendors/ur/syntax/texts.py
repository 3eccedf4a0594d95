"""The texts of a program as one stretch of offsets: a place in any of them is one number."""

from __future__ import annotations

from bisect import bisect_right
from collections.abc import Iterable, Sequence
from typing import Protocol

from ....core.errors import Note, ParseError, SourceError, Span, StopError
from ....core.source.text.damage import Damage
from ....core.source.text.files import SourceFile, SourceText


class Node(Protocol):
    """What stands between two offsets: a node of the tree."""

    @property
    def start(self) -> int:
        """Of its first character."""

    @property
    def end(self) -> int:
        """Behind its last character."""


class Texts:
    """Source texts, one behind the other.

    Args:
        files: in the order in which they are executed.
        damage: what is wrong in them and stepped over; None where an error ends their reading.

    Attributes:
        notes: on what is wrong with them and does no harm.
    """

    def __init__(self, files: Iterable[SourceFile], damage: Damage | None = None) -> None:
        self.damage = damage
        self.notes: list[Note] = []
        self.sources = [SourceText(file.text, file.name) for file in files]
        self.bases: list[int] = []
        base = 0
        for source in self.sources:
            self.bases.append(base)
            base += len(source.text) + 1
        self._spans: dict[tuple[int, int], Span] = {}
        self._only = self.sources[0] if len(self.sources) == 1 else None

    def span(self, start: int, end: int) -> Span:
        """The stretch from ``start`` to before ``end``, with its file, line and column."""
        if self._only is not None:
            return self._only.span(start, end)
        which = self._which(start)
        base = self.bases[which]
        return self.sources[which].span(start - base, end - base)

    def span_of(self, node: Node) -> Span:
        """Where a node stands; the same ones are asked for in every pass of a loop."""
        place = node.start, node.end
        span = self._spans.get(place)
        if span is None:
            span = self._spans[place] = self.span(*place)
        return span

    def spans(self, places: Sequence[tuple[int, int]]) -> tuple[Span, ...]:
        """The spans of several stretches, in order, that most often stand on one line."""
        if not places:
            return ()
        first, last = self.span(*places[0]), self.span(*places[-1])
        if first.line != last.line:
            return tuple([self.span(start, end) for start, end in places])
        file, line, ahead = first.file, first.line, places[0][0] - first.start
        left = first.start - first.column + ahead
        return tuple(
            [Span(file, line, start - left, start - ahead, end - ahead) for start, end in places]
        )

    def cut(self, start: int, end: int) -> str:
        """The text from ``start`` to before ``end``."""
        which = self._which(start)
        base = self.bases[which]
        return self.sources[which].text[start - base : end - base]

    def text(self, span: Span) -> str:
        """What stands at a place."""
        text = next(source.text for source in self.sources if source.file == span.file)
        return text[span.start : span.end]

    def text_of(self, node: Node) -> str:
        """A node as it stands."""
        return self.cut(node.start, node.end)

    def error_at(self, message: object, node: Node) -> SourceError:
        """An error at a node, to be raised."""
        return SourceError(str(message), self.span_of(node))

    def stop_at(self, message: object, node: Node) -> StopError:
        """What ends a running program at a node, to be raised."""
        return StopError(str(message), self.span_of(node))

    def error(self, message: str, start: int, end: int | None = None) -> SourceError:
        """An error at ``start``, to be raised."""
        return ParseError(message, self.span(start, start if end is None else end))

    def _which(self, offset: int) -> int:
        return bisect_right(self.bases, offset) - 1 if len(self.bases) > 1 else 0
