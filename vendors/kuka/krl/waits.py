"""HALT, WAIT and TRIGGER, and statements that are kept as they stand."""

from __future__ import annotations

import math
from dataclasses import replace
from typing import TYPE_CHECKING

from ....core.errors import InputError, SourceError
from ....core.program.event import Event, EventAnchor
from ....core.program.move import Wait
from .instructions import KEYWORDS, Kept, refused
from .scope import Scope
from .syntax import Halt, Keyword, SplineBlock, Trigger, WaitFor, WaitSec
from .terms import Expression
from .values import Unknown, shown

if TYPE_CHECKING:
    from .interpreter import Interpreter


class Waits:
    """Carries these statements out.

    Args:
        run: the program run.
    """

    def __init__(self, run: Interpreter) -> None:
        self.run = run

    def halt(self, statement: Halt, scope: Scope) -> None:
        why = "taken as continued at once: waiting takes no time here"
        self.run.keep(statement.span, "HALT", Kept(why, stops=True))

    def wait_sec(self, statement: WaitSec, scope: Scope) -> None:
        value = self.run.evaluator.evaluate(statement.time, scope)
        if isinstance(value, Unknown):
            why = f"its time depends on {value.reason} and is taken as zero"
            self.run.keep(statement.span, "WAIT SEC", Kept(why, stops=True))
            return
        if isinstance(value, bool) or not isinstance(value, int | float):
            raise SourceError(f"WAIT SEC wants a number, not {shown(value)}", statement.time.span)
        # A time below zero is met as a mere stop of the advance run.
        self.run.emit(Wait(max(0.0, float(value)), statement.span))

    def wait_for(self, statement: WaitFor, scope: Scope) -> None:
        outputs = self.run.data.outputs
        mark = len(outputs.asked)
        if self.run.evaluator.evaluate(statement.condition, scope) is False:
            outputs.forget(outputs.asked[mark:])  # somebody else has changed what it waits for
        why = "taken as satisfied at once: waiting takes no time here"
        self.run.keep(statement.span, "WAIT FOR", Kept(why, stops=True))

    def trigger(self, statement: Trigger, scope: Scope) -> None:
        place = self._trigger_number(statement.place, scope, statement)
        delay = 0.0
        if statement.delay is not None:
            delay = self._trigger_number(statement.delay, scope, statement) or 0.0
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
            self.run.note_once(
                "trigger behind",
                "a TRIGGER behind its target point is taken as at the point",
                statement.span,
            )
            distance = 0.0
        try:
            event = Event(statement.action, anchor, distance, -delay / 1000, statement.span)
        except InputError as error:
            raise SourceError(str(error), statement.span) from None
        self.run.events.append((event, statement.span))
        self.run.output_writes.triggered(statement.action, scope)

    def _trigger_number(
        self, expression: Expression, scope: Scope, statement: Trigger
    ) -> float | None:
        value = self.run.evaluator.evaluate(expression, scope)
        if isinstance(value, bool) or not isinstance(value, int | float):
            self.run.note_once(
                "trigger",
                f"the place or time of a TRIGGER depends on {shown(value)} and is taken as 0",
                statement.span,
            )
            return None
        if not math.isfinite(value):
            raise SourceError("a TRIGGER needs finite numbers", expression.span)
        return float(value)

    def keyword(self, statement: Keyword, scope: Scope) -> None:
        reason = refused(statement.word)
        if reason is not None:
            raise SourceError(f"{statement.word.upper()} is refused: {reason}", statement.span)
        why = KEYWORDS[statement.word]
        if why is not None:
            if statement.word in ("global", "interrupt"):
                self.run.output_writes.interrupted(self.run.text(statement.span), scope)
            word = "INTERRUPT" if statement.word == "global" else statement.word.upper()
            self.run.keep(statement.span, word, why)

    def spline(self, statement: SplineBlock, scope: Scope) -> None:
        raise SourceError(
            f"{statement.word.upper()} blocks are not emulated: use single SLIN, SCIRC and SPTP "
            "motions, or LIN, CIRC and PTP",
            statement.span,
        )
