"""What takes parts and lets go of them: statements, calls, and what happens along moves."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import NamedTuple

from ..cell.workpiece import Workpiece
from ..errors import InputError, Span
from ..program.event import EventAnchor
from ..program.move import Move, Opaque
from ..program.program import Program
from ..source.execution.answers import key, stands_at


class Cue(NamedTuple):
    """What a statement does to parts.

    Args:
        text: of the statement, in one line.
        span: where it stands.
        attach, release: kinds of parts that it takes, and lets go of.
        statement: index of the program's statement that it is, is called before, or happens on.
    """

    text: str
    span: Span | None
    attach: tuple[Workpiece, ...]
    release: tuple[Workpiece, ...]
    statement: int


def in_order(program: Program, parts: Sequence[Workpiece]) -> Iterator[Cue | Move]:
    """The moves of a program and what takes parts between them.

    What happens a distance before a target counts at the target, where the part is meant to be
    taken; what counts from a move's beginning, before the move.

    Raises:
        InputError: a statement both takes a part and lets go of it.
    """
    cues = _Cues(parts)
    calls = list(reversed(program.calls))
    for index, statement in enumerate(program.statements):
        while calls and calls[-1].before <= index:
            call = calls.pop()
            yield from cues.of(call.text, call.span, index)
        if isinstance(statement, Move):
            for event in statement.events:
                if event.anchor is EventAnchor.START:
                    yield from cues.of(event.text, event.span, index)
            yield statement
            for event in statement.events:
                if event.anchor is EventAnchor.END:
                    yield from cues.of(event.text, event.span, index)
        elif isinstance(statement, Opaque):
            yield from cues.of(statement.text, statement.span, index)
    for call in reversed(calls):
        yield from cues.of(call.text, call.span, len(program.statements))


class _Cues:
    """Looks texts up; a line in a loop is looked up once."""

    def __init__(self, parts: Sequence[Workpiece]) -> None:
        self._parts = [
            (part, tuple(map(key, part.attach)), tuple(map(key, part.release))) for part in parts
        ]
        self._known: dict[
            tuple[str, str, int], tuple[tuple[Workpiece, ...], tuple[Workpiece, ...]]
        ] = {}

    def of(self, text: str, span: Span | None, statement: int) -> Iterator[Cue]:
        place = (text, "", 0) if span is None else (text, span.file, span.line)
        if place not in self._known:
            self._known[place] = self._look_up(text, span)
        attach, release = self._known[place]
        if attach or release:
            yield Cue(" ".join(text.split()).rstrip(";"), span, attach, release, statement)

    def _look_up(
        self, text: str, span: Span | None
    ) -> tuple[tuple[Workpiece, ...], tuple[Workpiece, ...]]:
        attach, release = [], []
        for part, taking, letting_go in self._parts:
            takes, lets_go = (
                any(stands_at(k, text, span) for k in ks) for ks in (taking, letting_go)
            )
            if takes and lets_go:
                where = "" if span is None else f"{span}: "
                raise InputError(
                    f"{where}{' '.join(text.split())!r} both attaches and releases {part.name!r}: "
                    "say more of the statement in the cell file, such as its value too"
                )
            attach += [part] if takes else []
            release += [part] if lets_go else []
        return tuple(attach), tuple(release)
