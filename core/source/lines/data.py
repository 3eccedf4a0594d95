"""Registers, settings and points of a run, and the literals that their numbers stand in."""

from __future__ import annotations

from collections.abc import Sequence

from ...errors import SourceError, Span
from ..execution.provenance import MovePart
from ..execution.scopes import unknown_name
from .expressions import Datum, Expression, Number, Operation
from .program import Grammar, LineProgram
from .statements import AssignAll, Numbers, Operand, Set
from .values import ONCE, Literal, Unknown, Values, element


class Data:
    """What the statements of one run set, and its moves read.

    Args:
        program: whose points, and what registers hold at first.
        grammar: of the language.
        values: of the run.
    """

    def __init__(self, program: LineProgram, grammar: Grammar, values: Values) -> None:
        self._program = program
        self._grammar = grammar
        self.values = values
        for setting in grammar.settings:
            held = setting.initial
            each = held if isinstance(held, Sequence) else [held] * setting.count
            for name, value in zip(setting.names, each, strict=True):
                if value is not None:
                    values.put(name, value)
                    values.kinds[name] = setting.unit
        for (word, number), held in {**grammar.initial, **program.data}.items():
            name = word if number is None else f"{word}[{number}]"
            if isinstance(held, Numbers):
                values.put_all(name, held)
            else:
                values.put(name, held)

    def hold(
        self, name: str, expression: Expression, datum: str = "", place: Span | None = None
    ) -> None:
        """Give a register the value of an expression, and the literal that states it.

        Args:
            datum: that the literal belongs to; ``""`` for the register.
            place: of the literal; None for that of the number.
        """
        source = self.values.source_of(expression)
        if isinstance(expression, Number):
            span = place or expression.span
            source = Literal(span, datum or name, (span,))
        self.values.put(name, self.values.value(expression), source)

    def set(self, statement: Set) -> None:
        """Give a setting what a line says."""
        for name, value in zip(statement.names, statement.values, strict=True):
            held = f"{name}{ONCE}" if statement.once else name
            self.hold(held, value, statement.names[0], statement.place)
            self.values.kinds[held] = statement.unit

    def moved(self) -> None:
        """Forget what held for one move alone."""
        for name in (name for one in self._grammar.settings for name in one.names):
            self.values.registers.pop(f"{name}{ONCE}", None)

    def assign_all(self, statement: AssignAll) -> None:
        name = self.values.name(statement.target)
        if name is None:
            raise SourceError(
                "nobody knows which one this is: answer its number in the table [values] of the "
                "answers",
                statement.target.span,
            )
        try:
            found = [(sign, *self._read(term, name)) for sign, term in statement.terms]
            why = f"{name}, which is {statement.reason}"
        except SourceError as error:
            found, why = [], str(error)
        if not found:
            for k in range(self._grammar.vectors[statement.target.word]):
                self.values.put(element(name, k), Unknown(why))
            return
        if len(found) == 1 and found[0][0] == 1.0:
            _, numbers, sources = found[0]
            whole = sources[0] if sources else None
            if whole is not None and len(whole.numbers) == len(numbers) > 1:
                sources = whole.each()
            self.values.put_all(name, numbers, sources)
            return
        sums = (
            sum(sign * numbers[k] for sign, numbers, _ in found)
            for k in range(min(len(numbers) for _, numbers, _ in found))
        )
        self.values.put_all(name, Numbers.of(sums, found[0][1].kind))

    def operand(self, operand: Operand) -> tuple[Numbers, MovePart]:
        """The numbers of a part of a move, and where they stand."""
        if operand.point is None:
            units = tuple(map(self._unit, operand.numbers))
            kind = units if operand.kind is None else operand.kind
            numbers = Numbers.of(map(self.values.number, operand.numbers), kind)
            sources = tuple(map(self.values.source_of, operand.numbers)) or (
                Literal(operand.span, None, ()),
            )
            computed = any(isinstance(one, Operation) for one in operand.numbers)
            known = any(sources) and not computed
            return numbers, MovePart(operand.span, sources if known else ())
        numbers, sources = self._read(operand)
        point = sources[:1] if len({id(source) for source in sources}) == 1 else sources
        return numbers, MovePart(operand.span, point if any(sources) else ())

    def _read(self, term: Operand, name: str = "") -> tuple[Numbers, tuple[Literal | None, ...]]:
        """The numbers of a datum, a point, or of a position that is written out, and the literal of
        each; ``name``: of what is given these numbers."""
        if term.point is not None:
            return self.point(term.point)
        numbers = Numbers.of(map(self.values.number, term.numbers), term.kind)
        spans = tuple(one.span if isinstance(one, Number) else None for one in term.numbers)
        return numbers, (Literal(term.span, name, spans),) * len(numbers)

    def _unit(self, one: Expression) -> str:
        held = isinstance(one, Datum) and one.word in self._grammar.settings
        name = self.values.name(one) if isinstance(one, Datum) and held else None
        return "" if name is None else self.values.kinds.get(name, "")

    def point(self, datum: Datum) -> tuple[Numbers, tuple[Literal | None, ...]]:
        """The numbers of a point, or of a datum of several, and the literal of each."""
        if datum.word in self._grammar.vectors:
            numbers = self.values.all_of(datum)
            own = self.values.name(datum) or ""
            every = [self.values.sources.get(element(own, k)) for k in range(len(numbers))]
            return numbers, tuple(every)
        index = None if datum.index is None else self.values.number(datum.index)
        if index is not None and not index.is_integer():
            raise SourceError("points have whole numbers", datum.span)
        key = datum.span.file, datum.word, None if index is None else int(index)
        point = self._program.points.get(key)
        text = _point_name(*key[1:])
        if point is None:
            known = [_point_name(*at[1:]) for at in self._program.points if at[0] == key[0]]
            raise SourceError(unknown_name("point", text, known, "define it"), datum.span)
        numbers = Numbers.of((self.values.number(one) for one in point.numbers), point.kind)
        spans = tuple(one.span if isinstance(one, Number) else None for one in point.numbers)
        return numbers, (Literal(point.span, text, spans),) * max(1, len(numbers))


def _point_name(word: str, number: int | None) -> str:
    return word if number is None else f"{word}[{number}]"
