"""``TRIGGER``: what happens on the way of the next motion."""

from __future__ import annotations

import math
from dataclasses import replace
from typing import Protocol

from ....core.errors import InputError, SourceError, Span
from ....core.program.event import Event, EventAnchor
from ....core.program.move import Opaque
from ....core.source.execution.transcript import Transcript
from ..syntax.tree import Expression, Trigger
from ..values.evaluator import Evaluator
from ..values.scope import Scope
from ..values.values import shown


class Writes(Protocol):
    """Follows the outputs that actions on the way write."""

    def triggered(self, action: str, scope: Scope) -> None:
        """An action will be carried out on the way of the next motion."""

    def driven(self) -> None:
        """That motion has been read."""


class Triggers:
    """Lays actions on the motion that comes next."""

    def __init__(self, evaluator: Evaluator, transcript: Transcript, writes: Writes) -> None:
        self._evaluator = evaluator
        self._transcript = transcript
        self._writes = writes
        self._events: list[tuple[Event, Span]] = []

    def trigger(self, statement: Trigger, scope: Scope) -> None:
        """Carry one statement out.

        Raises:
            SourceError: its place or time is no finite number.
        """
        place = self._number(statement.place, scope, statement)
        delay = 0.0
        if statement.delay is not None:
            delay = self._number(statement.delay, scope, statement) or 0.0
        if place is None:
            place, statement = 0.0, replace(statement, path=False)
        anchor, distance = EventAnchor.END, 0.0
        if not statement.path:
            anchor = EventAnchor.END if place == 1 else EventAnchor.START
        elif statement.on_start:
            anchor, distance = EventAnchor.START, place / 1000
        else:
            distance = -place / 1000
        if distance < 0:
            self._transcript.notes.once(
                "trigger behind",
                "a TRIGGER behind its target point is taken as at the point",
                statement.span,
            )
            distance = 0.0
        try:
            event = Event(statement.action, anchor, distance, -delay / 1000, statement.span)
        except InputError as error:
            raise SourceError(str(error), statement.span) from None
        self._events.append((event, statement.span))
        self._writes.triggered(statement.action, scope)

    def taken(self) -> tuple[Event, ...]:
        """What lies on the motion that comes now."""
        self._writes.driven()
        events, self._events = self._events, []
        return tuple(event for event, _ in events)

    def end(self) -> None:
        """No motion comes: actions that wait for one are kept."""
        events, self._events = self._events, []
        for event, span in events:
            self._transcript.emit(Opaque(event.text, False, span))

    def _number(self, expression: Expression, scope: Scope, statement: Trigger) -> float | None:
        value = self._evaluator.evaluate(expression, scope)
        if isinstance(value, bool) or not isinstance(value, int | float):
            self._transcript.notes.once(
                "trigger",
                f"the place or time of a TRIGGER depends on {shown(value)} and is taken as 0",
                statement.span,
            )
            return None
        if not math.isfinite(value):
            raise SourceError("a TRIGGER needs finite numbers", expression.span)
        return float(value)
