"""IF, TEST, FOR and WHILE: carried out where their conditions are known, and decided by rule
(`Course`) where only the running controller knows them."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field
from typing import NoReturn, Protocol

from ....core.errors import InputError, SourceError, Span
from ....core.source.execution.answers import Course
from ....core.source.execution.limits import Meter
from ....core.source.execution.transcript import Transcript
from ..syntax.traversal import calls_in, labels_of
from ..syntax.tree import Block, Expression, For, If, Routine, Test, While
from ..values.evaluator import Evaluator
from ..values.operators import OperandError, apply
from ..values.scope import Cell, Home, Scope
from ..values.types import NUM, Unknown, Value, find_unknown
from .analysis import Flow

_SKIPPED = "a branch whose condition is not known"


@dataclass(eq=False, slots=True)
class Frame:
    """A routine that is being run.

    Args:
        routine: which.
        home: the module it stands in.
        main: whether the program starts in it.
        labels: offsets of its labels, when somebody has asked.
        exits: branches that leave a loop and were not taken, as their conditions are not known:
            offset and block, by the block's id. Each is there once, however often it is met.
    """

    routine: Routine
    home: Home
    main: bool
    labels: dict[str, int] | None = None
    exits: dict[int, tuple[int, Block]] = field(default_factory=dict)

    def label_offsets(self) -> dict[str, int]:
        """See ``labels``."""
        if self.labels is None:
            self.labels = labels_of(self.routine)
        return self.labels


class Carrying(Protocol):
    """What branches and loops need of a run."""

    evaluator: Evaluator
    out: Transcript
    course: Course
    meter: Meter
    flow: Flow

    @property
    def frame(self) -> Frame:
        """The routine that is being run."""

    def run_block(self, block: Block, scope: Scope) -> None:
        """Execute statements in order."""

    def finish(self, message: str, span: Span) -> NoReturn:
        """End the program here, with a note."""


def run_if(run: Carrying, statement: If, scope: Scope) -> None:
    """``IF``: the first branch whose condition holds."""
    for number, branch in enumerate(statement.branches):
        value = run.evaluator.evaluate(branch.condition, scope)
        if isinstance(value, Unknown):
            possible = [*[False] * number, True, *_possible(run, statement, number + 1, scope)]
            blocks = [b.body for b in statement.branches]
            _choose(run, blocks, statement.otherwise, possible, branch.condition, value, scope)
            return
        if run.evaluator.truth(value, "IF", branch.condition.span):
            run.run_block(branch.body, scope)
            return
    if statement.otherwise is not None:
        run.run_block(statement.otherwise, scope)


def run_test(run: Carrying, test: Test, scope: Scope) -> None:
    """``TEST``: the first case that has the value."""
    subject = run.evaluator.evaluate(test.subject, scope)
    for number, case in enumerate(test.cases):
        for expression in case.values:
            value = run.evaluator.evaluate(expression, scope)
            unknown = find_unknown(subject) or find_unknown(value)
            if unknown is not None:
                possible = [n >= number for n in range(len(test.cases) + 1)]
                blocks = [c.body for c in test.cases]
                _choose(run, blocks, test.otherwise, possible, test.subject, unknown, scope)
                return
            if _equal(subject, value, expression):
                run.run_block(case.body, scope)
                return
    if test.otherwise is not None:
        run.run_block(test.otherwise, scope)


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
    frame = run.frame
    everything = [*blocks, *([otherwise] if otherwise is not None else [])]
    candidates = list(zip(everything, possible, strict=False))
    asked = (frame.home, frame.label_offsets(), frame.main)
    returning = [may and run.flow.comes_back(block, *asked) for block, may in candidates]
    if not any(returning) and otherwise is not None and run.flow.ends(otherwise, *asked):
        returning = [may and not run.flow.ends(block, *asked) for block, may in candidates]
    try:
        taken = run.course.branch(condition.span, unknown.reason, returning)
    except InputError as error:
        raise SourceError(str(error), condition.span) from None
    chosen = otherwise if taken == 0 else everything[taken - 1]
    at = condition.span.start
    for block, may in candidates:
        if may and block is not chosen:
            frame.exits.setdefault(id(block), (at, block))
    if chosen is not None:
        run.run_block(chosen, scope)


def run_for(run: Carrying, loop: For, scope: Scope) -> None:
    """``FOR``; without STEP the controller counts down where it has to."""
    bounds = [run.evaluator.evaluate(e, scope) for e in (loop.start, loop.stop)]
    given = run.evaluator.evaluate(loop.step, scope) if loop.step is not None else None
    counter = Cell(loop.name, NUM, constant=True)  # programs may only read it
    inner = Scope(scope.where, {loop.name: counter}, scope, scope.home)
    for value in _counts(run, loop, bounds[0], bounds[1], given):
        counter.value = value
        run.run_block(loop.body, inner)
        run.meter.statement(loop.span)


def _counts(
    run: Carrying, loop: For, start: Value, stop: Value, given: Value | None
) -> Iterator[Value]:
    """The values that the loop's variable takes."""
    values = (start, stop, 0.0 if given is None else given)
    unknown = next((v for v in values if isinstance(v, Unknown)), None)
    first, last, step = (_number_or_none(run, value, loop) for value in values)
    if given is None:
        step = -1.0 if first is not None and last is not None and first > last else 1.0
    if step == 0:
        raise SourceError("STEP is zero: the loop has no end", loop.span)
    if unknown is None:
        assert first is not None and last is not None and step is not None
        while first <= last if step > 0 else first >= last:
            yield first
            first += step
        return
    moving = run.flow.moves(loop.body, run.frame.home)
    for number in range(run.course.passes(loop.stop.span, unknown.reason, moving)):
        yield unknown if first is None or step is None else first + number * step


def _number_or_none(run: Carrying, value: Value, loop: For) -> float | None:
    if isinstance(value, Unknown):
        return None
    run.evaluator.check(value, NUM, "FOR", loop.span)
    assert isinstance(value, float)
    return value


def run_while(run: Carrying, loop: While, scope: Scope) -> None:
    """``WHILE``; a loop without an end is read for one pass."""
    left: int | None = None
    most: int | None = None
    passed = waits = 0
    home, outputs = run.frame.home, run.evaluator.outputs
    while True:
        turns = run.evaluator.answers.turns
        outputs.asked.clear()
        value = run.evaluator.evaluate(loop.condition, scope)
        if isinstance(value, Unknown):
            if left is None:
                moving = run.flow.moves(loop.body, run.frame.home)
                passes = run.course.passes(loop.condition.span, value.reason, moving)
                left = max(0, passes - waits)
            if left == 0:
                return
            left -= 1
        elif not run.evaluator.truth(value, "WHILE", loop.condition.span):
            return
        fixed = left is None and run.evaluator.answers.turns == turns
        waited = frozenset(outputs.asked)
        run.run_block(loop.body, scope)
        run.meter.statement(loop.span)
        passed += 1
        if most is None and left is None and _ends_by_what_was_skipped(run, loop):
            moving = run.flow.moves(loop.body, home)
            most = run.course.passes(loop.condition.span, _SKIPPED, moving)
        if most is not None and passed >= most:
            return
        if not fixed or not run.flow.unchanging(loop, home):
            continue
        if not waited:
            end_loop(run, loop.span, loop.body, scope)
        elif not waited & run.flow.signals_written(loop.body, home):
            outputs.forget(waited)  # somebody else is to change what it waits for
            waits = passed


def _ends_by_what_was_skipped(run: Carrying, loop: While) -> bool:
    """Whether only branches that were not taken, as their conditions are not known, end a loop."""
    span = loop.span
    skipped = [block for at, block in run.frame.exits.values() if span.start <= at < span.end]
    return bool(skipped) and run.flow.decided_by(loop, skipped, run.frame.home)


def end_loop(run: Carrying, span: Span, body: Block, scope: Scope) -> None:
    """After one pass of a loop that ends by none of its conditions.

    It is left by the way out that was not taken as its condition is not known; without any way out
    the program ends here; else it goes on.
    """
    exits = [block for at, block in run.frame.exits.values() if span.start <= at < span.end]
    out = next((block for block in exits if run.flow.may_leave(block, body)), None)
    if out is not None:
        message = "a loop ends by what is not known: one pass is read, and then its way out"
        run.out.notes.once(f"loop {span.start}", message, span)
        run.run_block(out, scope)
    elif _waits_for_others(run, body):
        _let_others_write(run)
    elif not run.flow.may_leave(body, body):
        run.finish("the program is an endless loop: one pass is read", span)


def jump_back(run: Carrying, between: Block) -> None:
    """A jump back that a condition decides: a wait, if nothing moves the robot on the way."""
    if not run.flow.moves(between, run.frame.home) and _waits_for_others(run, between):
        _let_others_write(run)


def _let_others_write(run: Carrying) -> None:
    outputs = run.evaluator.outputs
    outputs.forget(outputs.asked)
    outputs.asked.clear()


def _waits_for_others(run: Carrying, body: Block) -> bool:
    """Whether a loop reads outputs that only somebody else can change, to end or to do nothing."""
    home, asked = run.frame.home, set(run.evaluator.outputs.asked)
    if not asked or asked & run.flow.signals_written(body, home):
        return False
    return run.flow.may_leave(body, body) or not run.flow.moves(body, home)
