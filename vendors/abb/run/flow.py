"""IF, TEST, FOR and WHILE: carried out where their conditions are known, and decided by rule
(`core.source.execution.control_flow.flow`) where only the running controller knows them."""

from __future__ import annotations

from collections.abc import Sequence
from contextlib import nullcontext
from typing import Protocol

from ....core.errors import SourceError
from ....core.source.execution.control_flow.analysis import Analysis
from ....core.source.execution.control_flow.flow import Flow
from ....core.source.execution.control_flow.loops import Loop, to_bound
from ....core.source.execution.course import Course
from ....core.source.execution.host import Undecided
from ....core.source.execution.limits import Meter
from ....core.source.execution.transcript import STEPLESS, Transcript
from ..syntax.traversal import calls_in
from ..syntax.tree import Block, Expression, For, If, Number, Operation, Test, Text, Truth, While
from ..values.evaluator import Evaluator
from ..values.operators import OperandError, apply, operand_type
from ..values.scope import Scope, Variable
from ..values.types import NUM, Unknown, Value, find_unknown
from .analysis import RapidTree, data_read
from .waits import suppose


class Carrying(Protocol):
    """What branches and loops need of a run."""

    evaluator: Evaluator
    course: Course
    meter: Meter
    tree: RapidTree
    analysis: Analysis[Block]
    flow: Flow[Block]
    out: Transcript

    def text_of(self, expression: Expression) -> str:
        """An expression as it stands."""

    def run_block(self, block: Block, scope: Scope) -> None:
        """Execute statements in order."""


def run_if(run: Carrying, statement: If, scope: Scope) -> None:
    """``IF``: the first branch whose condition holds."""
    for number, branch in enumerate(statement.branches):
        value = run.evaluator.condition(branch.condition, scope)
        if isinstance(value, Unknown):
            possible = [*[False] * number, True, *_possible(run, statement, number + 1, scope)]
            blocks = [b.body for b in statement.branches]
            _choose(run, blocks, statement.otherwise, possible, branch.condition, value, scope)
            return
        if run.evaluator.truth(value, "IF", branch.condition.span):
            _run(run, branch.body, statement, scope)
            return
    _run(run, statement.otherwise, statement, scope)


def _run(run: Carrying, block: Block | None, statement: If | Test, scope: Scope) -> None:
    """Run the branch that the values of the data lead to."""
    supposed = run.course.supposed
    with run.flow.supposing(statement.blocks, supposed) if supposed else nullcontext():
        if block is not None:
            run.run_block(block, scope)


def run_test(run: Carrying, test: Test, scope: Scope) -> None:
    """``TEST``: the first case that has the value."""
    subject = run.evaluator.evaluate(test.subject, scope)
    for number, case in enumerate(test.cases):
        for expression in case.values:
            value = run.evaluator.evaluate(expression, scope)
            unknown = find_unknown(subject) or find_unknown(value)
            if unknown is not None:
                run.evaluator.answers.used_as(test.subject, subject, operand_type("=", value))
                for other in (one for c in test.cases for one in c.values):
                    if isinstance(other, Number | Text | Truth):
                        run.evaluator.answers.compared(subject, other.value)
                possible = [n >= number for n in range(len(test.cases) + 1)]
                blocks = [c.body for c in test.cases]
                _choose(run, blocks, test.otherwise, possible, test.subject, unknown, scope)
                return
            if _equal(subject, value, expression):
                _run(run, case.body, test, scope)
                return
    _run(run, test.otherwise, test, scope)


def _equal(subject: Value, value: Value, expression: Expression) -> bool:
    try:
        return apply("=", subject, value) is True
    except OperandError as error:
        raise SourceError(f"TEST: {error}", expression.span) from None


def _possible(run: Carrying, statement: If, first: int, scope: Scope) -> list[bool]:
    """Which of the branches from ``first`` on, and of ELSE, may be taken if none before is."""
    possible: list[bool] = []
    certain = False
    for branch in statement.branches[first:]:
        value = None if certain else _foreseen(run, branch.condition, scope)
        possible.append(not certain and value is not False)
        certain = certain or value is True
    return [*possible, not certain]


def _foreseen(run: Carrying, condition: Expression, scope: Scope) -> Value | None:
    """The value of a condition that may not come up; None if only its turn will tell."""
    if any(True for _ in calls_in(condition)):
        return None
    try:
        return run.evaluator.evaluate(condition, scope)
    except SourceError:
        return None


def _choose(
    run: Carrying,
    blocks: Sequence[Block],
    otherwise: Block | None,
    possible: Sequence[bool],
    condition: Expression,
    unknown: Unknown,
    scope: Scope,
) -> None:
    """One of the branches, or ``otherwise``, by rule or by the user's answer.

    Args:
        possible: for each branch and for ``otherwise``, whether it is not ruled out.
    """
    choice = run.flow.choose(condition.span, unknown.reason, blocks, otherwise, possible)
    with run.flow.supposing((choice.block, *choice.skipped), choice.supposed):
        if choice.block is not None:
            run.run_block(choice.block, scope)


def run_for(run: Carrying, statement: For, scope: Scope) -> None:
    """``FOR``; without STEP the controller counts down where it has to."""
    bounds = [run.evaluator.evaluate(statement.start, scope)]
    with run.course.apart():  # the counter of a pass is known all the same
        bounds.append(run.evaluator.evaluate(statement.stop, scope))
        ends = run.course.supposed
    given = 0.0 if statement.step is None else run.evaluator.evaluate(statement.step, scope)
    unknown = next((v for v in (*bounds, given) if isinstance(v, Unknown)), None)
    first, last, step = (_number_or_none(run, value, statement) for value in (*bounds, given))
    if statement.step is None:
        step = -1.0 if first is not None and last is not None and first > last else 1.0
    if step == 0:
        run.out.notes.once(f"step {statement.span}", STEPLESS, statement.span)
        last, step = None if first is None or last is None else min(first, last), 1.0
    counter = Variable(statement.name, NUM, constant=True)  # programs may only read it
    counter.supposed = run.course.supposed
    run.course.suppose(ends)
    inner = Scope(scope.where, {statement.name: counter}, scope, scope.home)
    reached = first

    def goes_on() -> bool | Undecided:
        if unknown is not None:
            return Undecided(unknown.reason)
        assert reached is not None and last is not None and step is not None
        return reached <= last if step > 0 else reached >= last

    def carry_out(block: Block) -> bool:
        run.run_block(block, inner)
        return True

    def run_pass() -> bool:
        nonlocal reached
        if reached is None or step is None:
            assert unknown is not None
            counter.value = unknown
        else:
            counter.value, reached = reached, reached + step
        run.run_block(statement.body, inner)
        return True

    def distance() -> float | None:
        behind = None if last is None or step is None else last + step  # the last one is driven
        return to_bound("<" if step is None or step > 0 else ">", reached, behind)

    words = f"FOR {statement.name}"
    loop = Loop(statement.body, statement.stop.span, words, counts=True, distance=distance)
    run.flow.loop(loop, goes_on, carry_out, run_pass)


def _number_or_none(run: Carrying, value: Value, loop: For) -> float | None:
    if isinstance(value, Unknown):
        return None
    run.evaluator.check(value, NUM, "FOR", loop.span)
    assert isinstance(value, float)
    return value


def run_while(run: Carrying, statement: While, scope: Scope) -> None:
    """``WHILE``"""
    condition = statement.condition

    def goes_on() -> bool | Undecided:
        value = run.evaluator.condition(condition, scope)
        if isinstance(value, Unknown):
            return Undecided(value.reason)
        return run.evaluator.truth(value, "WHILE", condition.span)

    def carry_out(block: Block) -> bool:
        run.run_block(block, scope)
        return True

    loop = Loop(
        statement.body,
        condition.span,
        f"WHILE {run.text_of(condition)}",
        data_read(condition),
        asks=any(run.tree.called(condition, scope.home)),
        endless=isinstance(condition, Truth) and condition.value,
        distance=lambda: _distance(run, condition, scope),
        ended=lambda: suppose(run.evaluator, condition, scope, False),
    )
    run.flow.loop(loop, goes_on, carry_out)


def _distance(run: Carrying, condition: Expression, scope: Scope) -> float | None:
    """How far a counter is from the bound that ends a loop."""
    if not isinstance(condition, Operation) or len(condition.rest) != 1:
        return None
    symbol, bound = condition.rest[0]
    if any(True for _ in calls_in(condition)):
        return None
    values = (run.evaluator.evaluate(side, scope) for side in (condition.first, bound))
    return to_bound(symbol, *values)
