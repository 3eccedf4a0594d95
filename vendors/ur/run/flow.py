"""``if`` and ``while``: carried out where their conditions are known, and decided by rule
(`core.source.execution.control_flow.flow`) where only the running controller knows them."""

from __future__ import annotations

from contextlib import nullcontext, suppress
from typing import Protocol

from ....core.errors import SourceError
from ....core.program.move import Opaque
from ....core.source.execution.control_flow.flow import Flow
from ....core.source.execution.control_flow.loops import Loop, to_bound
from ....core.source.execution.host import Undecided
from ....core.source.execution.outputs import Outputs
from ....core.source.execution.transcript import Transcript
from ..syntax.traversal import assigned, calls_in, calls_written, methods_in, returns
from ..syntax.tree import Block, Constant, Expression, If, Number, Operation, While
from ..values.evaluator import Evaluation, condition, evaluate
from ..values.scope import Scope
from ..values.values import Unknown
from .analysis import ScriptTree
from .exits import Break, Continue, Frame
from .waiting import has_ended


class FlowRun(Evaluation, Protocol):
    """What branches and loops ask of a run.

    Attributes:
        decisions: how often something was decided that is not known.
    """

    decisions: int

    @property
    def tree(self) -> ScriptTree:
        """The statements of the program."""

    @property
    def flow(self) -> Flow[Block]:
        """Decides what is not known."""

    @property
    def outputs(self) -> Outputs:
        """What the program has set."""

    @property
    def frames(self) -> list[Frame]:
        """The functions that run."""

    @property
    def out(self) -> Transcript:
        """What the run leaves."""

    def run_block(self, block: Block, scope: Scope) -> None:
        """Execute statements in order."""


def branch(run: FlowRun, statement: If, scope: Scope) -> None:
    """``if … elif … else … end``"""
    for index, one in enumerate(statement.branches):
        fulfilled = condition(run, one.condition, scope)
        if isinstance(fulfilled, Unknown):
            _undecided(run, statement, index, fulfilled, scope)
            return
        if fulfilled:
            _run(run, one.body, statement, scope)
            return
    _run(run, statement.otherwise, statement, scope)


def _run(run: FlowRun, block: Block | None, statement: If, scope: Scope) -> None:
    """Run the branch that the values of the variables lead to."""
    supposed = run.course.supposed
    with run.flow.supposing(statement.blocks, supposed) if supposed else nullcontext():
        if block is not None:
            run.run_block(block, scope)


def _undecided(run: FlowRun, statement: If, first: int, reason: Unknown, scope: Scope) -> None:
    """The condition of branch ``first`` is not known."""
    run.decisions += 1
    head = run.texts.span(statement.start, statement.start + len("if"))
    blocks = [one.body for one in statement.branches]
    possible = [k >= first for k in range(len(blocks) + 1)]
    for k, one in enumerate(statement.branches[first + 1 :], first + 1):
        called = (*calls_written(one.condition), *methods_in(one.condition))
        if not called:  # those may do something
            with suppress(SourceError):
                possible[k] = condition(run, one.condition, scope) is not False
    choice = run.flow.choose(head, reason.reason, blocks, statement.otherwise, possible)
    frame = run.frames[-1] if run.frames else None
    for body in (*choice.skipped, *([] if choice.block is None else [choice.block])):
        if frame is not None and frame.open is None and returns(body):
            frame.open = reason  # what the function returns depends on it
    for body in choice.skipped:
        for name in assigned(body):
            if scope.find(name) is None:
                scope.own(name).value = reason
    with run.flow.supposing((choice.block, *choice.skipped), choice.supposed):
        if choice.block is not None:
            run.run_block(choice.block, scope)


def loop(run: FlowRun, statement: While, scope: Scope) -> None:
    """``while condition: … end``"""
    entered = False
    reason: Unknown | None = None

    def goes_on() -> bool | Undecided:
        nonlocal reason
        value = condition(run, statement.condition, scope)
        if not isinstance(value, Unknown):
            return value
        if reason is None:
            reason = value
            run.decisions += 1
        return Undecided(value.reason)

    def carry_out(block: Block) -> bool:
        nonlocal entered
        entered = True
        try:
            run.run_block(block, scope)
        except Break:
            return False
        except Continue:
            pass
        return True

    run.flow.loop(
        Loop(
            statement.body,
            run.texts.span(statement.start, statement.start + len("while")),
            f"while {' '.join(run.texts.text_of(statement.condition).split())}",
            run.tree.reads(statement.condition),
            asks=run.tree.asks(statement.condition),
            endless=_always(statement.condition),
            distance=lambda: _distance(run, statement.condition, scope),
            ended=lambda: has_ended(run, run.outputs, statement.condition, scope),
        ),
        goes_on,
        carry_out,
    )
    if reason is not None and not entered:
        # It waits for what is not known.
        span = run.texts.span_of(statement)
        run.out.emit(Opaque(run.texts.text_of(statement), stops=True, span=span))


def _distance(run: FlowRun, condition: Expression, scope: Scope) -> float | None:
    """How far a counter is from the bound that ends a loop."""
    if not isinstance(condition, Operation) or len(condition.rest) != 1:
        return None
    symbol, bound = condition.rest[0]
    if any(calls_in(condition)):
        return None
    return to_bound(symbol, *(evaluate(run, side, scope) for side in (condition.first, bound)))


def _always(expression: Expression) -> bool:
    if isinstance(expression, Constant):
        return expression.value is True
    return isinstance(expression, Number) and expression.value != 0
