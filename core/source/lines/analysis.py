"""Lines as the rules for branches and loops see them."""

from __future__ import annotations

from collections.abc import Sequence

from ..execution.steps import NOTHING, Exit, Step
from .expressions import Datum, Expression, Number, data_in
from .program import (
    Assign,
    Body,
    Call,
    Drive,
    End,
    Grammar,
    If,
    Jump,
    Label,
    LineProgram,
    Return,
    Statement,
)


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
        """See `core.source.execution.steps.Tree`."""
        return [self._step(statement) for statement in block.statements]

    def reads(self, expressions: Sequence[Expression]) -> frozenset[str]:
        """Names of the registers and signals that expressions read."""
        found = (self._names(d, self._all) for e in expressions for d in data_in(e))
        return NOTHING.union(*found)

    def _names(self, datum: Datum, computed: frozenset[str]) -> frozenset[str]:
        """The name of a datum; of one whose number is computed, all that it may be."""
        if isinstance(datum.index, Number):
            return frozenset([f"{datum.word}[{datum.index.value:g}]"])
        return computed

    def _step(self, statement: Statement) -> Step[Body]:
        if isinstance(statement, Drive):
            return Step(moves=True)
        if isinstance(statement, Label):
            return Step(mark=statement.name)
        if isinstance(statement, Jump):
            return Step(exit=Exit.JUMP, label=statement.label)
        if isinstance(statement, Return):
            return Step(exit=Exit.ROUTINE)
        if isinstance(statement, End):
            return Step(exit=Exit.PROGRAM)
        if isinstance(statement, If):
            return Step(reads=self.reads([statement.condition]), inner=(statement.then,))
        if isinstance(statement, Call):
            body = self._program.routines.get(statement.routine.lower())
            return Step(moves=body is None, calls=() if body is None else (body,))
        if isinstance(statement, Assign):
            names = self._names(statement.target, self._all)
            own = statement.target.word in self._grammar.outputs
            made_of = self.reads([statement.value, statement.target.index])
            outputs = names if isinstance(statement.target.index, Number) else None
            return Step(writes=names, made_of=made_of, outputs=outputs if own else NOTHING)
        return Step()


def expressions_of(statement: Statement) -> list[Expression]:
    """The expressions that decide what registers, outputs and jumps become."""
    if isinstance(statement, Assign):
        return [statement.target, statement.value]
    if isinstance(statement, If):
        inside = (e for s in statement.then.statements for e in expressions_of(s))
        return [statement.condition, *inside]
    return []
