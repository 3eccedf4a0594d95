"""What is to be said about a run: one note per kind."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, field

from ....core.errors import Note, Span

_SHOWN = 4


@dataclass
class _KeptCalls:
    """Calls of one kind that were kept: the first one's place, and how often each name came."""

    span: Span
    counts: dict[str, int] = field(default_factory=dict)


class Notebook:
    """Collects notes."""

    def __init__(self) -> None:
        self._notes: dict[str, Note] = {}
        self._kept: dict[str, _KeptCalls] = {}

    def once(self, kind: str, message: str, span: Span) -> None:
        """A note, unless one of this kind was taken before."""
        self._notes.setdefault(kind, Note(message, span=span))

    def kept(self, kind: str, name: str, span: Span) -> None:
        """A statement was kept and not carried out.

        Args:
            kind: what such statements do.
            name: of what is called.
        """
        counts = self._kept.setdefault(kind, _KeptCalls(span)).counts
        counts[name] = counts.get(name, 0) + 1

    def notes(self) -> Iterator[Note]:
        """All notes, those about kept statements last."""
        yield from self._notes.values()
        for kind, calls in self._kept.items():
            count = sum(calls.counts.values())
            names = list(calls.counts)
            shown = ", ".join(names[:_SHOWN]) + (", …" if len(names) > _SHOWN else "")
            times = "" if count == 1 else f" ({count} statements, here first)"
            message = f"statements that {kind} are kept and not carried out: {shown}{times}"
            yield Note(message, span=calls.span)
