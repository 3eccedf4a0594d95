"""Outputs that are set and signals that are waited for, as a language's own grammar reads them.

The statements are known already: an assignment to an output, a wait for a condition. What is left
to say is which words are signals, and how the statements are written.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field

from ...dialect import OutputWords, SignalWords
from ...errors import InputError
from ...program.signal import Condition, Joined, Level, SetSignal, SignalAction, WaitSignal, negated
from ..text.files import SourceText
from .expressions import Datum, Expression, Number, Operation, Truth
from .program import Grammar, several
from .statements import Assign, Kept, Line, Pause

_ENOUGH = 1000
"""Characters of a statement that is looked at."""


@dataclass(frozen=True)
class Signals:
    """The signals of a language, called ``DO[1]``: word and number.

    Args:
        grammar: reads the statements.
        digital: words of digital outputs as they are written, the usual one first.
        inputs: of digital inputs, likewise.
        analogue: of outputs that have a level.
        written: how a signal is written: ``OT#({number})``.
        first: by word, what is added to numbers in the text: ``{"WX": 1000}`` where inputs are
            ``1001`` and so on. Signals themselves are counted from 1 (`spelt`).
        switch: the statement that sets an output, of its ``signal`` and ``value``.
        pulse: that of a pulse, of its ``signal`` and ``time``, s; ``""`` for none.
        wait: that waits for a ``condition``.
        level: a signal in a condition, of its ``signal`` and ``value``.
        truths: how on and off are written.
        words: how and, or are written.
        quiet: a statement without its comments.
    """

    grammar: Callable[[], Grammar]
    digital: tuple[str, ...]
    inputs: tuple[str, ...]
    analogue: tuple[str, ...] = ()
    written: str = "{word}[{number}]"
    first: Mapping[str, int] = field(default_factory=dict)
    switch: str = "{signal}={value}"
    pulse: str = ""
    wait: str = "WAIT {condition}"
    level: str = "{signal}={value}"
    truths: Mapping[bool, str] = field(default_factory=lambda: {True: "ON", False: "OFF"})
    words: tuple[str, str] = ("AND", "OR")
    quiet: Callable[[str], str] = str

    def dialect(self, stops: bool = False) -> SignalWords:
        """What the dialect says of them; ``stops``: whether the robot stops where one is set."""
        return SignalWords(self.read, self.said, self.spelt, self.example, stops=stops)

    def outputs(self, longest_lead: float, most: int) -> OutputWords:
        """What it says of them on the way of a move, from whose end on places count.

        Args:
            longest_lead: s of an event at most.
            most: events of a move.
        """
        return OutputWords(
            self._switched,
            self._switched,
            longest_lead,
            from_start=False,
            at_start=False,
            both=False,
            most=most,
        )

    def read(self, text: str) -> SignalAction | None:
        """What a statement does with signals; None if that is not known, or nothing."""
        quiet = self.quiet(text).strip()
        line = Line(SourceText(quiet, ""), 0, len(quiet))
        try:
            told = several(self.grammar().statement(line)) if len(quiet) <= _ENOUGH else ()
        except InputError:
            return None
        said = told[0] if len(told) == 1 else None
        if isinstance(said, Kept):
            return said.signal
        if isinstance(said, Pause) and said.condition is not None:
            condition = self._condition(said.condition)
            return None if condition is None else WaitSignal(condition)
        if isinstance(said, Assign) and isinstance(said.value, Number | Truth):
            on, digital = self._truth(said.value), self._name(said.target, self.digital)
            if digital is not None:
                return SetSignal(digital, said.value.value if on is None else on)
            name = self._name(said.target, self.analogue)
            return None if name is None else SetSignal(name, said.value.value)
        return None

    def _truth(self, one: Expression) -> bool | None:
        """On or off, by the words or numbers of the language; None for neither."""
        if isinstance(one, Truth):
            return one.value
        numbers = {word: value for value, word in self.truths.items()}
        return numbers.get(f"{one.value:g}") if isinstance(one, Number) else None

    def said(self, action: SignalAction) -> str | None:
        """The statement; None if there is none."""
        if isinstance(action, WaitSignal):
            if action.longest is not None:
                return None
            inner = self._said(action.condition)
            whole = f"({inner})" if isinstance(action.condition, Joined) else inner
            return self.wait.format(condition=whole)
        if action.pulse is None:
            return self._switched(action.name, action.value)
        if not self.pulse or action.value is not True:
            return None
        return self.pulse.format(signal=self._written(action.name), time=f"{action.pulse:g}")

    def spelt(self, name: str) -> str | None:
        """The canonical name of a signal, ``DO[1]``, by which answers, links and maps of signals
        know it, however it is `written`; None for what is no name of one."""
        words = "|".join(self._every)
        found = re.fullmatch(rf"\s*({words})\W{{0,3}}(\d+)\W{{0,3}}", name, re.IGNORECASE)
        return None if found is None else f"{found[1].upper()}[{found[2]}]"

    def example(self, action: SignalAction) -> str:
        """What a signal of such an action is called."""
        if isinstance(action, WaitSignal):
            return f"{self.inputs[0].upper()}[?]"
        words = self.digital if isinstance(action.value, bool) else self.analogue
        return f"{(words or self.digital)[0].upper()}[?]"

    def _switched(self, name: str, value: bool | float) -> str:
        shown = self.truths[value] if isinstance(value, bool) else f"{value:g}"
        return self.switch.format(signal=self._written(name), value=shown)

    def _written(self, name: str) -> str:
        called, _, number = name.rstrip("]").partition("[")
        word = next((one for one in self._every if one.upper() == called), called)
        first = {one.upper(): value for one, value in self.first.items()}
        return self.written.format(word=word, number=int(number) + first.get(called, 0))

    @property
    def _every(self) -> tuple[str, ...]:
        return *self.digital, *self.inputs, *self.analogue

    @staticmethod
    def _name(datum: Expression, words: tuple[str, ...]) -> str | None:
        known = {word.upper() for word in words}
        if not isinstance(datum, Datum) or datum.word not in known or datum.element is not None:
            return None
        index = datum.index
        return f"{datum.word}[{index.value:g}]" if isinstance(index, Number) else None

    def _condition(self, one: Expression) -> Condition | None:
        name = self._name(one, (*self.digital, *self.inputs))
        if name is not None:
            return Level(name, True)
        if not isinstance(one, Operation):
            return None
        if one.word == "NOT":
            inner = self._condition(one.operands[0])
            return None if inner is None else negated(inner)
        if one.word in ("=", "<>") and (truth := self._truth(one.operands[1])) is not None:
            name = self._name(one.operands[0], (*self.digital, *self.inputs))
            return None if name is None else Level(name, truth == (one.word == "="))
        parts = [self._condition(operand) for operand in one.operands]
        if one.word not in ("AND", "OR") or None in parts:
            return None
        every, joined = one.word == "AND", list[Condition]()
        for part in parts:
            assert part is not None
            same = isinstance(part, Joined) and part.every == every
            joined += part.parts if same else [part]  # type: ignore[union-attr]
        return Joined(tuple(joined), every)

    def _said(self, condition: Condition) -> str:
        if isinstance(condition, Level):
            signal = self._written(condition.name)
            return self.level.format(signal=signal, value=self.truths[condition.on])
        parts = (
            f"({self._said(p)})" if isinstance(p, Joined) else self._said(p)
            for p in condition.parts
        )
        return f" {self.words[0 if condition.every else 1]} ".join(parts)
