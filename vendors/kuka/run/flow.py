"""IF, SWITCH, loops and jumps: carried out where their conditions are known, and decided by rule
(`core.source.execution.control_flow.flow`) where only the running controller knows them."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from contextlib import nullcontext
from dataclasses import replace

from ....core.errors import SourceError, Span
from ....core.source.execution.control_flow import flow, loops
from ....core.source.execution.course import Course
from ....core.source.execution.host import Undecided
from ....core.source.execution.transcript import STEPLESS, Notes
from ..syntax.traversal import calls_in
from ..syntax.tree import (
    Block,
    Call,
    Constant,
    Exit,
    Expression,
    For,
    Goto,
    If,
    Label,
    Loop,
    Name,
    Number,
    Operation,
    Repeat,
    Return,
    Routine,
    Switch,
    Text,
    Truth,
    While,
)
from ..values.data import Data
from ..values.evaluator import Evaluator
from ..values.operators import OperandError, apply
from ..values.scope import Scope
from ..values.values import Unknown, Value, find_unknown, shown, unplaced
from .analysis import KrlTree
from .exits import Jump, Left, Returned
from .waiting import Waited

Evaluated = Callable[[Expression, Scope, Span], Value]
"""A value; if reading it stops the advance run, the robot stops at the statement's place."""


class Flow:
    """Carries out the statements that decide which statements run.

    Args:
        run_block: carries statements out.
        evaluated: evaluates what a statement depends on.
        evaluator: for counters and cases.
        data: of the program.
        tree: the program's statements.
        rules: decide what the text leaves open.
        waited: what holds when a loop has waited for others.
        notes: takes notes.
        course: what was decided.
    """

    def __init__(
        self,
        run_block: Callable[[Block, Scope], None],
        evaluated: Evaluated,
        evaluator: Evaluator,
        data: Data,
        tree: KrlTree,
        rules: flow.Flow[Block],
        waited: Waited,
        notes: Notes,
        course: Course,
    ) -> None:
        self._run_block = run_block
        self._evaluated = evaluated
        self._evaluator = evaluator
        self._data = data
        self._tree = tree
        self._rules = rules
        self._waited = waited
        self._notes = notes
        self._course = course
        self._jumps: dict[int, Block] = {}  # bodies of loops that a GOTO closes, by its id

    def run_body(self, routine: Routine, call: Call, scope: Scope) -> None:
        """The statements of a routine."""
        with self._rules.routine(routine.text, call.span):
            self._run_block(routine.body, scope)

    # ------------------------------------------------------------------- branches

    def if_(self, statement: If, scope: Scope) -> None:
        """``IF``"""
        value = self._evaluated(statement.condition, scope, statement.span)
        otherwise = statement.otherwise if statement.otherwise.statements else None
        if isinstance(statement.condition, Name):
            self._evaluator.used_as(value, "bool")
        if isinstance(value, Unknown):
            self._choose(statement.condition.span, value, [statement.body], otherwise, scope)
        elif _truth(value, statement.condition, "IF"):
            self._run(statement.body, statement, scope)
        else:
            self._run(otherwise, statement, scope)

    def _run(self, block: Block | None, statement: If | Switch, scope: Scope) -> None:
        """Run the branch that the values of the data lead to."""
        supposed = self._course.supposed
        with self._rules.supposing(statement.blocks, supposed) if supposed else nullcontext():
            if block is not None:
                self._run_block(block, scope)

    def _choose(
        self,
        span: Span,
        unknown: Unknown,
        blocks: Sequence[Block],
        otherwise: Block | None,
        scope: Scope,
        possible: Sequence[bool] | None = None,
    ) -> None:
        """Run the branch that is taken where nobody knows."""
        choice = self._rules.choose(span, unknown.reason, blocks, otherwise, possible)
        with self._rules.supposing((choice.block, *choice.skipped), choice.supposed):
            if choice.block is not None:
                self._run_block(choice.block, scope)

    def switch_(self, statement: Switch, scope: Scope) -> None:
        """``SWITCH``: of cases that nobody knows, a known one that fits is taken."""
        subject = self._evaluated(statement.subject, scope, statement.span)
        unknown = find_unknown(subject)
        possible = [unknown is not None] * len(statement.cases)
        if unknown is None:
            for number, case in enumerate(statement.cases):
                for expression in case.values:
                    equal = self._equal(subject, expression, scope)
                    if isinstance(equal, Unknown):
                        unknown, possible[number] = unknown or equal, True
                    elif equal:
                        self._run(case.body, statement, scope)
                        return
        if unknown is not None:
            for value in (one for case in statement.cases for one in case.values):
                if isinstance(value, Constant | Number | Text):
                    shown = self._evaluator.evaluate(value, scope)
                    self._evaluator.used("==", statement.subject, subject, shown)
            bodies = [case.body for case in statement.cases]
            may = [*possible, True]
            self._choose(statement.subject.span, unknown, bodies, statement.otherwise, scope, may)
        else:
            self._run(statement.otherwise, statement, scope)

    def _equal(self, subject: Value, expression: Expression, scope: Scope) -> bool | Unknown:
        value = (
            expression.value
            if isinstance(expression, Number)
            else self._evaluator.evaluate(expression, scope)
        )
        try:
            equal = apply("==", subject, value)
        except OperandError as error:
            raise SourceError(f"CASE: {error}", expression.span) from None
        return equal if isinstance(equal, Unknown) else bool(equal)

    # ---------------------------------------------------------------------- loops

    def while_(self, statement: While, scope: Scope) -> None:
        """``WHILE``"""
        condition = statement.condition
        words = f"WHILE {self._text(condition)}"
        endless = isinstance(condition, Truth) and condition.value

        def goes_on() -> bool | Undecided:
            return self._holds(condition, scope, statement.span, "WHILE")

        loop = self._loop(statement.body, condition, words, endless, scope, ended=False)
        loop = replace(loop, distance=lambda: self._distance(condition, scope))
        self._rules.loop(loop, goes_on, self._pass(scope))

    def _distance(self, condition: Expression, scope: Scope) -> float | None:
        """How far a counter is from the bound that ends a loop."""
        if not isinstance(condition, Operation) or len(condition.rest) != 1:
            return None
        symbol, bound = condition.rest[0]
        if any(True for _ in calls_in(condition)):
            return None
        sides = (condition.first, bound)
        values = (
            side.value if isinstance(side, Number) else self._evaluator.evaluate(side, scope)
            for side in sides
        )
        return loops.to_bound(symbol, *values)

    def repeat_(self, statement: Repeat, scope: Scope) -> None:
        """``REPEAT … UNTIL``"""
        condition = statement.condition
        words = f"REPEAT … UNTIL {self._text(condition)}"
        endless = isinstance(condition, Truth) and not condition.value

        def goes_on() -> bool | Undecided:
            ends = self._holds(condition, scope, statement.span, "UNTIL")
            return ends if isinstance(ends, Undecided) else not ends

        loop = self._loop(statement.body, condition, words, endless, scope, ended=True)
        loop = replace(loop, span=statement.span)  # its first line, as of all loops
        self._rules.loop(loop, goes_on, self._pass(scope), tested_first=False)

    def loop_(self, statement: Loop, scope: Scope) -> None:
        """``LOOP``"""
        loop = loops.Loop(statement.body, statement.span, "LOOP", endless=True)
        self._rules.loop(loop, lambda: True, self._pass(scope))

    def for_(self, statement: For, scope: Scope) -> None:
        """``FOR``: its bounds are evaluated once; the counter is the program's own datum, to which
        the step is added after every pass, whatever the body has made of it."""
        bounds = [statement.start, statement.stop]
        bounds += [] if statement.step is None else [statement.step]
        values = [self._evaluated(statement.start, scope, statement.span)]
        begins = self._course.supposed
        values += [self._evaluated(bound, scope, statement.span) for bound in bounds[1:]]
        ends, self._course.supposed = self._course.supposed, begins
        for value, bound in zip(values, bounds, strict=True):
            if find_unknown(value) is None and not _is_number(value):
                raise SourceError(f"FOR counts numbers, not {shown(value)}", bound.span)
        start, stop, step = (*values, 1)[:3]
        unknown = next(filter(None, map(find_unknown, values)), None)
        if step == 0:
            self._notes.once(f"step {statement.span}", STEPLESS, statement.span)
            stop, step = stop if unknown else min(start, stop), 1  # type: ignore[type-var]
        self._evaluator.assign(statement.counter, unplaced(start), scope, statement.span)
        self._course.supposed = ends
        run = self._pass(scope)

        def computed(symbol: str, left: Value, right: Value) -> Value:
            try:
                return apply(symbol, left, right)
            except OperandError as error:
                raise error.at(statement.span) from None

        def goes_on() -> bool | Undecided:
            counter = self._evaluator.names.value(statement.counter, scope)
            open_ = unknown or find_unknown(counter)
            return Undecided(open_.reason) if open_ else not _is_past(counter, stop, step)

        def run_pass() -> bool:
            stays = run(statement.body)
            if stays:
                counter = self._evaluator.names.value(statement.counter, scope)
                following = computed("+", counter, step)
                self._evaluator.assign(statement.counter, following, scope, statement.span)
            self._note_moved_bound(statement, stop, scope)
            return stays

        counted = frozenset({statement.counter.name})
        words = f"FOR {statement.counter.text}"
        span = statement.start.span

        def distance() -> float | None:
            counter = self._evaluator.names.value(statement.counter, scope)
            up = not _is_number(step) or step > 0  # type: ignore[operator]
            behind = None
            if _is_number(stop) and _is_number(step):
                behind = stop + step  # type: ignore[operator]  # the last is driven
                # No INT comes there; and no pass would show to come nearer to 1e38.
                behind = max(-(2.0**31), min(2.0**31, behind))
            return loops.to_bound("<" if up else ">", counter, behind)

        def ended() -> None:
            passes = loops.passes_to(start, stop, step)
            if passes is not None:
                end = computed("+", start, computed("*", passes, step))
                self._evaluator.assign(statement.counter, end, scope, statement.span)

        loop = loops.Loop(
            statement.body,
            span,
            words,
            reads=counted,
            writes=counted,
            distance=distance,
            ended=ended,
        )
        self._rules.loop(loop, goes_on, run, run_pass)

    def _note_moved_bound(self, loop: For, stop: Value, scope: Scope) -> None:
        """Say that the body has changed what the end of a FOR is made of."""
        if isinstance(loop.stop, Name) and not loop.stop.path and not isinstance(stop, Unknown):
            cell = self._data.find(loop.stop.name, scope)
            if cell is not None and cell.signal is None and cell.value != stop:
                self._notes.once(
                    f"bound {loop.span.start}",
                    f"the body of FOR changes {loop.stop.text}, its end: the value from before the "
                    "loop counts; count in a WHILE if it shall not",
                    loop.span,
                )

    def _loop(
        self,
        body: Block,
        condition: Expression,
        words: str,
        endless: bool,
        scope: Scope,
        ended: bool,
    ) -> loops.Loop[Block]:
        """A loop; ``ended`` is what its condition is when it has ended."""
        return loops.Loop(
            body,
            condition.span,
            words,
            self._tree.data_read([condition], scope.module),
            asks=self._tree.asks([condition], scope.module),
            endless=endless,
            ended=lambda: self._waited.ended(condition, scope, ended),
        )

    def _pass(self, scope: Scope) -> Callable[[Block], bool]:
        """Runs a block in a loop; False if EXIT leaves the loop."""

        def run(block: Block) -> bool:
            try:
                self._run_block(block, scope)
            except Left:
                return False
            return True

        return run

    def _holds(
        self, condition: Expression, scope: Scope, span: Span, what: str
    ) -> bool | Undecided:
        value = self._evaluated(condition, scope, span)
        if isinstance(condition, Name):
            self._evaluator.used_as(value, "bool")
        if isinstance(value, Unknown):
            return Undecided(value.reason)
        return _truth(value, condition, what)

    def _text(self, expression: Expression) -> str:
        return " ".join(self._data.text(expression.span).split())

    # ---------------------------------------------------------------------- jumps

    def after_jump(self, block: Block, index: int, goto: Goto, scope: Scope) -> int:
        """Index of the statement where a block goes on after a jump out of one of its statements.

        A jump back closes a loop.

        Raises:
            Jump: the label is further out.
        """

        def carry_out(way: Block) -> bool:
            self._run_block(way, scope)
            return True

        while goto.name in block.labels:
            target = block.labels[goto.name]
            if target > index:
                return target - 1  # the label itself
            always = goto is block.statements[index]
            body = self._jumps.setdefault(id(goto), Block(block.statements[target - 1 : index + 1]))
            loop = loops.Loop(body, goto.span, f"GOTO {goto.name.upper()}", endless=always)
            label = id(block.statements[target - 1])
            try:
                stays = self._rules.jump(loop, label, id(goto), carry_out)
                return target if stays else index + 1
            except Jump as jump:
                goto = jump.goto
        raise Jump(goto)

    def label(self, statement: Label) -> None:
        """A label, which a jump back does not go over again."""
        self._rules.label(id(statement), statement.name)

    def goto_(self, statement: Goto, scope: Scope) -> None:
        """``GOTO``"""
        raise Jump(statement)

    def return_(self, statement: Return, scope: Scope) -> None:
        """``RETURN``"""
        value = None
        if statement.value is not None:
            value = self._evaluated(statement.value, scope, statement.span)
        raise Returned(value)

    def exit_(self, statement: Exit, scope: Scope) -> None:
        """``EXIT``"""
        raise Left


def _truth(value: Value, condition: Expression, what: str) -> bool:
    if not isinstance(value, bool):
        raise SourceError(f"the condition of {what} is a BOOL, not {shown(value)}", condition.span)
    return value


def _is_number(value: Value) -> bool:
    return isinstance(value, int | float) and not isinstance(value, bool)


def _is_past(counter: Value, stop: Value, step: Value) -> bool:
    """Whether a FOR has counted beyond its end."""
    assert isinstance(counter, int | float) and isinstance(stop, int | float)
    assert isinstance(step, int | float)
    return counter > stop if step > 0 else counter < stop
