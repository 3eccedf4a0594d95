"""Conditions on digital signals, as texts: ``di1=1 AND NOT (di2=0 OR di3=1)``."""

from __future__ import annotations

import re
from collections.abc import Callable
from dataclasses import dataclass

from ...program.signal import Condition, Joined, Level, negated

_OPEN, _CLOSE = re.compile(r"\s*\("), re.compile(r"\s*\)")


class NoConditionError(ValueError):
    """A text that is no condition on signals alone."""


@dataclass(frozen=True)
class ConditionWords:
    """How a language says conditions.

    Args:
        level: a signal, alone or compared with a value; ``name`` gives the signal of a match, and
            whether it is to be on.
        every, either, without: the words for and, or and not.
    """

    level: re.Pattern[str]
    name: Callable[[re.Match[str]], Level]
    every: str
    either: str
    without: str

    def read(self, text: str) -> Condition:
        """The condition that a text is.

        Raises:
            NoConditionError: it is none, or about other things than signals.
        """
        condition, at = self._joined(text, 0, False)
        if text[at:].strip():
            raise NoConditionError(text)
        return condition

    def said(self, condition: Condition, level: Callable[[Level], str]) -> str:
        """The text of a condition.

        Args:
            level: of one signal.
        """
        if isinstance(condition, Level):
            return level(condition)
        parts = (
            f"({self.said(p, level)})" if isinstance(p, Joined) else level(p)
            for p in condition.parts
        )
        return f" {self.every if condition.every else self.either} ".join(parts)

    def _joined(self, text: str, at: int, every: bool) -> tuple[Condition, int]:
        inner = self._negated if every else (lambda t, a: self._joined(t, a, True))
        word = self.every if every else self.either
        part, at = inner(text, at)
        parts = [part]
        while (found := self._word(word).match(text, at)) is not None:
            part, at = inner(text, found.end())
            parts.append(part)
        return (parts[0] if len(parts) == 1 else Joined(tuple(parts), every)), at

    def _negated(self, text: str, at: int) -> tuple[Condition, int]:
        if (found := self._word(self.without).match(text, at)) is not None:
            part, at = self._negated(text, found.end())
            return negated(part), at
        if (level := self.level.match(text, at)) is not None:
            return self.name(level), level.end()
        if (opened := _OPEN.match(text, at)) is not None:
            part, at = self._joined(text, opened.end(), False)
            if (closed := _CLOSE.match(text, at)) is not None:
                return part, closed.end()
        raise NoConditionError(text)

    @staticmethod
    def _word(word: str) -> re.Pattern[str]:
        return re.compile(rf"\s*{word}\b", re.IGNORECASE)
