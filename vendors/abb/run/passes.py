"""``main`` over and over: a controller in continuous mode begins it anew at its end.

Data of modules keep their values from pass to pass, which programs use that drive one state of a
sequence in each: ``TEST state``.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from ....core.door import spelt
from ....core.errors import SourceError
from ....core.source.execution.control_flow.analysis import Analysis
from ....core.source.execution.control_flow.steps import NOTHING
from ..syntax import tree
from ..syntax.traversal import names_in
from ..values.evaluator import Evaluator
from ..values.scope import Scope, Variable
from ..values.types import Unknown, Value

Decisive = Sequence[tuple[int, tree.Expression, Variable, Value]]
"""What a routine decides by in its own statements: in which, where, the datum, and its value."""


def decisive(evaluator: Evaluator, body: tree.Block, scope: Scope) -> Decisive:
    """Known data of modules by which a routine decides which way it goes.

    Args:
        scope: in which the routine's names are looked up.
    """
    found = []
    for index, expression in _conditions(body):
        for name in sorted(names_in(expression)):
            cell = scope.find(name)
            value = None if cell is None or cell.constant else _value(evaluator, cell)
            if cell is not None and value is not None:
                found.append((index, expression, cell, value))
    return found


def next_pass(
    evaluator: Evaluator, before: Decisive, analysis: Analysis[tree.Block], body: tree.Block
) -> tuple[tree.Expression, str] | None:
    """What decides otherwise in the next pass, and what is to be said of it; None if nothing does.

    Args:
        before: as it was at the beginning of this one.
        analysis: knows what the statements of ``body`` write: what is written in each pass before
            it is asked for does not come from the one before.
    """
    for index, expression, cell, value in before:
        if _value(evaluator, cell) not in (None, value):
            if cell.name.lower() in _written(analysis, body, index):
                continue
            said = (
                f"main ends here, and its next pass goes another way, as {cell.name} has another "
                "value now: controllers run it again and again; "
                f"{spelt('cycles')} says how many passes are driven"
            )
            return expression, said
    return None


def _value(evaluator: Evaluator, cell: Variable) -> Value | None:
    try:
        value = evaluator.settle(cell)
    except SourceError:
        return None
    return None if isinstance(value, Unknown) else value


def _conditions(body: tree.Block) -> Iterator[tuple[int, tree.Expression]]:
    for index, statement in enumerate(body.statements):
        if isinstance(statement, tree.Test):
            yield index, statement.subject
        elif isinstance(statement, tree.If):
            yield from ((index, branch.condition) for branch in statement.branches)


def _written(analysis: Analysis[tree.Block], body: tree.Block, count: int) -> frozenset[str]:
    """Names of the data that the first statements may write."""
    steps = analysis.steps(body)[:count]
    blocks = (block for step in steps for block in (*step.calls, *step.inner))
    return NOTHING.union(*(step.writes for step in steps), *map(analysis.written, blocks))
