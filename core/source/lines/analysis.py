"""Lines as the rules for branches and loops see them, and what lines set without naming it."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator, Sequence

from ...dialect import Unsaid
from ..execution.control_flow.steps import NOTHING, Exit, Step
from .expressions import Datum, Expression, Number, Operation, data_in
from .program import Grammar, LineProgram, routine_key
from .settings import Settings
from .statements import (
    Assign,
    AssignAll,
    Body,
    Call,
    Drive,
    End,
    If,
    Jump,
    Label,
    Return,
    Set,
    Statement,
)

_LONGEST = 1000
"""Characters of a line that is looked at."""


class Statements:
    """The statements of a program, for the rules of branches and loops."""

    def __init__(self, program: LineProgram, grammar: Grammar) -> None:
        self._program = program
        self._grammar = grammar
        every = (s for body in program.routines.values() for s in body.statements)
        self._all = frozenset(
            name
            for statement in every
            for expression in expressions_of(statement)
            for datum in data_in(expression)
            for name in self._names(datum, NOTHING)
        )

    def steps(self, block: Body) -> Sequence[Step[Body]]:
        """See `core.source.execution.control_flow.steps.Tree`."""
        return [self._step(statement) for statement in block.statements]

    def own(self, block: Body) -> frozenset[str]:
        """None: registers are everybody's."""
        return NOTHING

    def reads(self, expressions: Sequence[Expression]) -> frozenset[str]:
        """Names of the registers and signals that expressions read."""
        found = (self._names(d, self._all) for e in expressions for d in data_in(e))
        return NOTHING.union(*found)

    def _names(self, datum: Datum, computed: frozenset[str]) -> frozenset[str]:
        """The name of a datum; of one whose number is computed, all that it may be; of one of
        several numbers, those of each."""
        if datum.index is None:
            count = self._grammar.vectors.get(datum.word, 0)
            return frozenset([datum.word, *(f"{datum.word}[{k + 1}]" for k in range(count))])
        if not isinstance(datum.index, Number) or isinstance(datum.element, Datum | Operation):
            return computed
        index = f"{datum.index.value:g}"
        if isinstance(datum.element, Number):
            return frozenset([f"{datum.word}[{index},{datum.element.value:g}]"])
        if datum.word in self._grammar.vectors:
            return frozenset(
                f"{datum.word}[{index},{k}]"
                for k in range(1, self._grammar.vectors[datum.word] + 1)
            )
        return frozenset([f"{datum.word}[{index}]"])

    def _step(self, statement: Statement) -> Step[Body]:
        if isinstance(statement, Drive):
            return Step(moves=True)
        if isinstance(statement, Label):
            return Step(mark=statement.name)
        if isinstance(statement, Jump):
            return Step(exit=Exit.JUMP, label=statement.name)
        if isinstance(statement, Return):
            return Step(exit=Exit.ROUTINE)
        if isinstance(statement, End):
            return Step(exit=Exit.PROGRAM)
        if isinstance(statement, If):
            inner = statement.blocks
            reads = self.reads([statement.condition])
            return Step(reads=reads, inner=inner, exhaustive=len(inner) > 1)
        if isinstance(statement, Call):
            body = self._program.routines.get(routine_key(statement.routine))
            given = self.reads(statement.arguments)
            word = self._grammar.argument
            taken = frozenset(f"{word}[{k + 1}]" for k in range(len(statement.arguments)))
            calls = () if body is None else (body,)
            return Step(moves=body is None, calls=calls, writes=taken, made_of=given)
        if isinstance(statement, Assign):
            names = self._names(statement.target, self._all)
            own = statement.target.word in self._grammar.outputs
            indices = (statement.target.index, statement.target.element)
            made_of = self.reads([statement.value, *(i for i in indices if i is not None)])
            outputs = names if isinstance(statement.target.index, Number | None) else None
            return Step(writes=names, made_of=made_of, outputs=outputs if own else NOTHING)
        if isinstance(statement, Set):
            return Step(writes=frozenset(statement.names), made_of=self.reads(statement.values))
        if isinstance(statement, AssignAll):
            made_of = self.reads(_terms(statement))
            return Step(writes=self._names(statement.target, self._all), made_of=made_of)
        return Step()


def expressions_of(statement: Statement) -> list[Expression]:
    """The expressions that decide what registers, outputs and jumps become."""
    if isinstance(statement, Assign):
        return [statement.target, statement.value]
    if isinstance(statement, Set):
        return [*statement.values]
    if isinstance(statement, AssignAll):
        return [statement.target, *_terms(statement)]
    if isinstance(statement, If):
        inside = (e for b in statement.blocks for s in b.statements for e in expressions_of(s))
        return [statement.condition, *inside]
    return []


def _terms(statement: AssignAll) -> list[Expression]:
    """The expressions in the terms of a sum."""
    return [e for _, one in statement.terms for e in ((one.point,) if one.point else one.numbers)]


def unsaid(
    settings: Settings, motion: re.Pattern[str], others: Sequence[str] = ()
) -> Callable[[str], Iterator[Unsaid]]:
    """Finds where settings are set and used, for `core.dialect.Wording.unsaid`.

    Args:
        settings: of the language.
        motion: a line that drives.
        others: words that set what holds and is no number: tools and frames.
    """
    begins = [(re.compile(rf"{re.escape(w)}\b", re.IGNORECASE), w) for w in others]

    def found(text: str) -> Iterator[Unsaid]:
        for line in re.finditer(r"[^\s;][^\r\n;]*", text):
            said = line[0].rstrip()
            if len(said) > _LONGEST:
                continue
            words = [one.names[0] for one in settings if one.pattern.fullmatch(said)]
            words += [word for pattern, word in begins if pattern.match(said)]
            place = line.start(), line.start() + len(said)
            if words:
                yield Unsaid(words[0], *place, given=True)
            elif motion.match(said):
                every = (*(one.names[0] for one in settings), *others)
                yield from (Unsaid(word, *place) for word in every)

    return found
