"""Statements that are no moves, in another language's words: signals by the map, else comments."""

from __future__ import annotations

from dataclasses import dataclass, replace

from ..errors import Span
from ..program.event import Event, EventAnchor
from ..program.move import Move, Opaque, Statement, Wait
from ..program.program import Program
from ..program.section import moved
from ..program.signal import SetSignal, SignalAction, WaitSignal, names
from ..program.zone import Fine
from .emulation import Party
from .losses import Losses
from .signals import SignalMap, renamed
from .ties import Ties


@dataclass
class Rewording:
    """Says the statements of one program.

    Args:
        source, target: whose languages they are.
        signals: what the old robot's signals are called on the new one.
        losses: takes what has no words.
        ties: of the program.
    """

    source: Party
    target: Party
    signals: SignalMap
    losses: Losses
    ties: Ties

    def of(self, program: Program) -> Program:
        """The program in the new language."""
        found: list[Statement] = []
        places = []
        rests = self._rests(program)
        for index, statement in enumerate(program.statements):
            places.append(len(found))
            if isinstance(statement, Wait):
                found.append(statement)
            elif isinstance(statement, Opaque):
                found += self._statement(statement, found, self.ties.of(index) in rests)
            else:
                found += self._move(statement)
        sections = moved(program.sections, [*places, len(found)])
        return replace(program, statements=tuple(found), sections=sections)

    def _rests(self, program: Program) -> set[int]:
        """Statements that stop the robot behind a zone, where they are tied: the first of them."""
        found, passing = set(), False
        for index, statement in enumerate(program.statements):
            if isinstance(statement, Opaque):
                if statement.stops and passing:
                    found.add(self.ties.of(index))
                passing = passing and not statement.stops
            elif isinstance(statement, Wait):
                passing = False
            else:
                passing = not isinstance(statement.zone, Fine)
        return found

    # --------------------------------------------------------------------- statements

    def _statement(
        self, statement: Opaque, before: list[Statement], rests: bool
    ) -> list[Statement]:
        action = self._action(statement.text, statement.span)
        if action is None:
            return [
                *self._comments(statement),
                *([Wait(0.0, statement.span)] if rests else []),
            ]
        words = self.target.vendor.speaks
        assert words is not None and words.signals is not None
        last = before[-1] if before else None
        if words.signals.stops and not statement.stops and isinstance(action, SetSignal):
            event = self._on_the_way(action, statement.span)
            if event is not None and isinstance(last, Move) and not isinstance(last.zone, Fine):
                before[-1] = replace(last, events=(*last.events, event))
                return []
        stops = isinstance(action, WaitSignal) or words.signals.stops
        said = words.signals.said(action)
        assert said is not None
        rest = [Wait(0.0, statement.span)] if rests and not stops else []
        lines = [Opaque(line, stops, statement.span) for line in said.splitlines()]
        return [*rest, *lines]

    def _action(self, text: str, span: Span | None) -> SignalAction | None:
        """What a statement does with signals, by their names on the new robot; None if that has no
        words."""
        old, new = self.source.vendor.speaks, self.target.vendor.speaks
        if old is None or new is None or old.signals is None or new.signals is None:
            return None
        action = old.signals.read(text)
        if action is None:
            return None
        others: dict[str, str] = {}
        for name in names(action):
            other = self.signals.name(name, old.signals, new.signals)
            if other is None:
                self.losses.unmapped(name, new.signals.example(action))
            else:
                others[name] = other
        if set(names(action)) - others.keys():
            return None
        settable = new.signals.example(action) if isinstance(action, SetSignal) else None
        action = renamed(action, others)
        if isinstance(action, SetSignal) and new.signals.said(replace(action, pulse=None)) is None:
            (old_name,) = others
            self.losses.statement(
                span,
                f"no program sets {action.name!r}, which the answers call {old_name!r}: "
                f"name an output, such as {settable!r}",
            )
        if isinstance(action, WaitSignal) and action.longest is not None:
            self.losses.statement(
                span, f"waits without an end: the longest time ({action.longest:g} s) has no words"
            )
            action = replace(action, longest=None)
        return None if new.signals.said(action) is None else action

    def _comments(self, statement: Opaque) -> list[Opaque]:
        if statement.text.strip():
            shown = statement.text.strip().splitlines()[0][:60]
            self.losses.statement(statement.span, f"becomes a comment: {shown}")
        return self._commented(statement.text, statement.span)

    def _commented(self, text: str, span: Span | None) -> list[Opaque]:
        """A comment for each line, in ASCII: controllers do not agree on any other encoding."""
        dialect = self.target.vendor.speaks
        if dialect is None:
            return [Opaque(text, span=span)]
        lines = text.encode("ascii", "replace").decode().splitlines() or [""]
        return [Opaque(dialect.comment + line.strip(), span=span) for line in lines]

    # -------------------------------------------------------------------------- moves

    def _move(self, move: Move) -> list[Statement]:
        events, found, behind = list[Event](), list[Statement](), list[Statement]()
        for event in move.events:
            action = self._action_of(event)
            said = None if action is None else self._on_the_way(action, event.span)
            if said is None and action is not None and _at_target(event):
                behind += self._behind(action, event.span)
            elif said is None or not self._takes(event, move, len(events)):
                found += self._event(event)
            else:
                events.append(replace(event, text=said.text))
        return [*found, replace(move, events=tuple(events)), *behind]

    def _behind(self, action: SetSignal, span: Span | None) -> list[Opaque]:
        """An output of a move's target, in a language that has no words for the way to it."""
        words = self.target.vendor.speaks
        assert words is not None and words.signals is not None
        said = words.signals.said(action)
        assert said is not None  # it has been asked for
        return [Opaque(said, words.signals.stops, span)]

    def _action_of(self, event: Event) -> SetSignal | None:
        old = self.source.vendor.speaks
        read = None if old is None or old.signals is None else old.signals.event
        text = event.text if read is None else read(event.text)
        action = self._action(text, event.span)
        return action if isinstance(action, SetSignal) and action.pulse is None else None

    def _on_the_way(self, action: SetSignal, span: Span | None) -> Event | None:
        """An output set at a move's target, if the new language has words for it."""
        dialect = self.target.vendor.speaks
        if dialect is None or dialect.outputs is None or action.pulse is not None:
            return None
        if isinstance(action.value, bool):
            return Event(dialect.outputs.switch(action.name, action.value), span=span)
        return Event(dialect.outputs.level(action.name, action.value), span=span)

    def _takes(self, event: Event, move: Move, others: int) -> bool:
        """Whether the new language has words for an event's place beside others of the move."""
        dialect = self.target.vendor.speaks
        assert dialect is not None and dialect.outputs is not None
        return others < dialect.outputs.most and dialect.outputs.takes(event, move)

    def _event(self, event: Event) -> list[Opaque]:
        self.losses.statement(event.span, f"an event on the way becomes a comment: {event.text}")
        return self._commented(event.text, event.span)


def _at_target(event: Event) -> bool:
    return event.anchor is EventAnchor.END and event.distance == 0 and event.time == 0
