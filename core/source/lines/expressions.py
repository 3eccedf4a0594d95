"""Expressions of line-oriented languages: numbers, numbered data, sums and comparisons.

``R[1] + 1``, ``R[R[2]] * 0.5``, ``DI[1] = ON AND R[3] < 4``: numbers in the form of the text, data
as a word and an index, ``PR[1,2]`` one number of several, ``ON`` and ``OFF`` for truths; from the
tightest to the loosest ``* / DIV MOD``, ``+ -``, comparisons, ``NOT`` (``!``), ``AND``, ``OR``.
What a language writes otherwise stands in a `Spelling`.
"""

from __future__ import annotations

import math
import operator
import re
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass, field
from functools import cached_property

from ...errors import SourceError, Span
from ..text.files import SourceText

Value = float | bool
DEEPEST = 30
"""Brackets inside each other."""
LONGEST = 100
"""Signs and words between operands, and before them."""


@dataclass(frozen=True, slots=True)
class Number:
    """A number that is written out, with its sign."""

    span: Span
    value: float


@dataclass(frozen=True, slots=True)
class Truth:
    """``ON`` or ``OFF``."""

    span: Span
    value: bool


@dataclass(frozen=True, slots=True)
class Datum:
    """A datum: a register, a signal, a point, a variable, a setting.

    Args:
        word: before the bracket, in capitals.
        index: in the bracket; None of a datum that there is once (``OVERRIDE``, ``count``).
        element: which of its numbers, behind a comma; None for the whole of it.
    """

    span: Span
    word: str
    index: Expression | None
    element: Expression | None = None


@dataclass(frozen=True, slots=True)
class Operation:
    """A sign or word with its operands; ``NOT`` and a sign before a datum have one."""

    span: Span
    word: str
    operands: tuple[Expression, ...]


Expression = Number | Truth | Datum | Operation

COMPUTE: dict[str, Callable[..., Value]] = {
    "+": operator.add,
    "-": lambda a, b=None: -a if b is None else a - b,
    "*": operator.mul,
    "/": operator.truediv,
    "DIV": lambda a, b: float(int(a / b)),
    "MOD": math.fmod,
    "=": operator.eq,
    "<>": operator.ne,
    "<": operator.lt,
    ">": operator.gt,
    "<=": operator.le,
    ">=": operator.ge,
    "NOT": operator.not_,
    "AND": lambda a, b: bool(a) and bool(b),
    "OR": lambda a, b: bool(a) or bool(b),
    "ABS": abs,
    "INT": lambda a: float(int(a)),
    "SQRT": math.sqrt,
    "MIN": min,
    "MAX": max,
}
_LEVELS = (
    ("OR",),
    ("AND",),
    ("=", "<>", "<", ">", "<=", ">="),
    ("+", "-"),
    ("*", "/", "DIV", "MOD"),
)
_IN_BRACKETS = re.compile(r"\[[^\[\]]*\]|\([^()]*\)")
Function = Callable[[Span, tuple[Expression, ...]], Expression]
"""What a word with arguments in round brackets is: ``ABS(x)``, ``SIG(-1009)``."""


@dataclass(frozen=True)
class Spelling:
    """How a language writes expressions.

    Args:
        truths: the words for truths, in capitals.
        signs: other spellings of signs: ``==`` for ``=``.
        names: whether a name alone is a datum: a variable, a point that is called by its name.
        name: the form of names and words.
        datum: data that are no word and index in square brackets (``B012``, ``OT#(3)``), with
            groups ``word`` and ``index``; None where there are none.
        functions: what words with arguments in round brackets are, by word in capitals.
    """

    truths: Mapping[str, bool] = field(default_factory=lambda: {"ON": True, "OFF": False})
    signs: Mapping[str, str] = field(default_factory=dict)
    names: bool = False
    name: str = r"[A-Za-z_]\w*"
    datum: re.Pattern[str] | None = None
    functions: Mapping[str, Function] = field(default_factory=dict)

    @cached_property
    def token(self) -> re.Pattern[str]:
        """A word, number or sign, and the blanks before it."""
        own = "|".join(map(re.escape, sorted(self.signs, key=len, reverse=True)))
        other = "(?!)" if self.datum is None else self.datum.pattern
        return re.compile(
            rf"\s*(?:(?P<datum>{other})|(?P<number>(?:\d+\.?\d*|\.\d+)(?:[eE][+-]?\d+)?)"
            rf"|(?P<name>{self.name})|(?P<sign>{own or '(?!)'}|<>|<=|>=|[-+*/=<>\[\](),!]))",
            re.IGNORECASE,
        )

    def sign(self, word: str) -> str:
        """The usual spelling of a sign or word."""
        return self.signs.get(word, word)


USUAL = Spelling()


def parse(source: SourceText, start: int, end: int, spelling: Spelling = USUAL) -> Expression:
    """The expression that a stretch of a text is.

    Raises:
        SourceError: it is none.
    """
    reader = _Reader(source, start, end, spelling)
    found = reader.level(0)
    reader.finish()
    return found


def parse_all(
    source: SourceText, start: int, end: int, spelling: Spelling = USUAL
) -> tuple[Expression, ...]:
    """The expressions, with commas between them, that a stretch of a text holds; where there is no
    comma the operands, with blanks between them: sums stand in brackets then.

    Raises:
        SourceError: it holds something else.
    """
    reader = _Reader(source, start, end, spelling)
    commas = "," in _IN_BRACKETS.sub("", source.text[start:end])
    return tuple(reader.listed() if commas else reader.operands())


def data_in(expression: Expression) -> Iterator[Datum]:
    """The numbered data in an expression, those in indices included."""
    if isinstance(expression, Datum):
        yield expression
        for number in (expression.index, expression.element):
            if number is not None:
                yield from data_in(number)
    elif isinstance(expression, Operation):
        for operand in expression.operands:
            yield from data_in(operand)


class _Reader:
    """Reads one expression, or several, from left to right."""

    def __init__(self, source: SourceText, start: int, end: int, spelling: Spelling) -> None:
        self._source = source
        self._spelling = spelling
        self._at = start
        self._end = end
        self._depth = 0
        self._operators = 0
        self._token: re.Match[str] | None = None
        self._advance()

    def _advance(self) -> None:
        if self._token is not None:
            self._at = self._token.end()
        self._token = self._spelling.token.match(self._source.text, self._at, self._end)

    @property
    def _word(self) -> str:
        found = self._token
        return "" if found is None else self._spelling.sign(found[0].strip().upper())

    @property
    def _start(self) -> int:
        return self._at if self._token is None else self._token.end() - len(self._token[0].strip())

    def _error(self, message: str) -> SourceError:
        return self._source.error(message, min(self._start, self._end), self._end)

    def _count(self) -> None:
        """Go past an operator."""
        self._operators += 1
        if self._operators > LONGEST:
            raise self._error(f"more than {LONGEST} operators: split the expression")
        self._advance()

    def finish(self) -> None:
        if self._token is not None or self._source.text[self._at : self._end].strip():
            raise self._error("the expression should end here")

    def operands(self) -> Iterator[Expression]:
        while self._token is not None:
            yield self._operand()
        self.finish()

    def listed(self) -> Iterator[Expression]:
        yield self.level(0)
        while self._word == ",":
            self._advance()
            yield self.level(0)
        self.finish()

    def level(self, number: int) -> Expression:
        if number == len(_LEVELS):
            return self._operand()
        start = self._start
        left = self.level(number + 1)
        while (word := self._word) in _LEVELS[number]:
            self._count()
            right = self.level(number + 1)
            left = Operation(self._source.span(start, self._at), word, (left, right))
        return left

    def _operand(self) -> Expression:
        start, word = self._start, self._word
        word = "NOT" if word == "!" else word
        if word in ("-", "+", "NOT"):
            self._count()
            inner = self._operand()
            span = self._source.span(start, self._at)
            if isinstance(inner, Number):
                return Number(span, -inner.value if word == "-" else inner.value)
            return inner if word == "+" else Operation(span, word, (inner,))
        if word == "(":
            return self._bracketed(")")[0]
        if self._token is not None and self._token["datum"]:
            return self._own_datum(self._token)
        if self._token is not None and self._token["number"]:
            self._advance()
            return Number(self._source.span(start, self._at), float(word))
        if self._token is not None and self._token["name"]:
            return self._named(start, word)
        raise self._error("a number or a datum should stand here")

    def _own_datum(self, found: re.Match[str]) -> Datum:
        start = self._start
        self._advance()
        span = self._source.span(start, self._at)
        word = found["word"].upper()
        return Datum(span, word, Number(span, float(found["index"])))

    def _named(self, start: int, word: str) -> Expression:
        self._advance()
        if word in self._spelling.truths:
            return Truth(self._source.span(start, self._at), self._spelling.truths[word])
        if self._word == "[":
            index, *element = self._bracketed("]")
            span = self._source.span(start, self._at)
            return Datum(span, word, index, element[0] if element else None)
        function = self._spelling.functions.get(word)
        if function is not None and self._word == "(":
            arguments = self._bracketed(")", LONGEST)
            return function(self._source.span(start, self._at), tuple(arguments))
        if self._spelling.names:
            return Datum(self._source.span(start, self._at), word, None)
        raise self._error(f"{word} has no index: write {word}[1]")

    def _bracketed(self, closing: str, most: int = 2) -> list[Expression]:
        """What a bracket holds: in square ones two numbers at most, in round ones one expression,
        or the arguments of a function."""
        self._depth += 1
        if self._depth > DEEPEST:
            raise self._error(f"more than {DEEPEST} brackets inside each other")
        self._advance()
        inner = [self.level(0)]
        while (closing == "]" or most > 2) and self._word == "," and len(inner) < most:
            self._advance()
            inner.append(self.level(0))
        if self._word != closing:
            raise self._error(f"a '{closing}' should stand here")
        self._advance()
        self._depth -= 1
        return inner
