"""Conditions, loops and jumps."""

from __future__ import annotations

from enum import Enum
from typing import TYPE_CHECKING, NoReturn

from ....core.errors import SourceError, Span
from .control import leaves
from .operators import OperandError, apply
from .scope import Scope
from .syntax import Block, Exit, For, Goto, If, Loop, Repeat, Return, Statement, Switch, While
from .terms import Expression, Number, Truth
from .values import Unknown, Value, find_unknown, shown

if TYPE_CHECKING:
    from .interpreter import Interpreter


_WATCHED = 3
"""Passes of a loop in which it may turn out that nothing changes any more."""


class Returned(Exception):
    """RETURN, with the value of a function."""

    def __init__(self, value: Value | None) -> None:
        self.value = value


class Jump(Exception):
    """GOTO a label that is not in the block."""

    def __init__(self, goto: Goto) -> None:
        self.goto = goto


class Left(Exception):
    """EXIT of the innermost loop."""


class Finished(Exception):
    """The end of the program."""


class After(Enum):
    """What a pass of a loop has done."""

    LEFT = "left"
    """EXIT has left the loop."""
    SAME = "same"
    """All data are as they were before it."""
    CHANGED = "changed"
    """Some datum has another value, or that was not looked at."""


class Flow:
    """Carries out the statements that decide which statements run.

    Args:
        run: the program run.
    """

    def __init__(self, run: Interpreter) -> None:
        self.run = run
        self.skipped_exit: str | None = None
        """What it depends on whether a loop is left, where a way out was not taken."""

    def if_(self, statement: If, scope: Scope) -> None:
        value = self.run.evaluated(statement.condition, scope, statement.span)
        if isinstance(value, Unknown):
            blocks = [statement.body, statement.otherwise]
            chosen = self._choice(statement.condition.span, value, blocks)
            if chosen is not None:
                self.run.run_block(chosen, scope)
            return
        self._check_bool(value, statement.condition, "IF")
        self.run.run_block(statement.body if value else statement.otherwise, scope)

    @staticmethod
    def _check_bool(value: Value, condition: Expression, what: str) -> None:
        if not isinstance(value, bool):
            raise SourceError(
                f"the condition of {what} is a BOOL, not {shown(value)}", condition.span
            )

    def _choice(self, span: Span, unknown: Unknown, blocks: list[Block]) -> Block | None:
        """The branch that is taken where nobody knows."""
        returning = [self.run.moving(block) and not leaves(block) for block in blocks]
        taken = self.run.course.branch(span, unknown.reason, returning)
        for number, block in enumerate(blocks, 1):
            if number != taken and leaves(block):
                self.skipped_exit = unknown.reason
        return blocks[taken - 1] if taken else None

    def switch_(self, statement: Switch, scope: Scope) -> None:
        subject = self.run.evaluated(statement.subject, scope, statement.span)
        unknown = find_unknown(subject)
        if unknown is not None:
            self._switch_unknown(statement, unknown, scope)
            return
        for case in statement.cases:
            for expression in case.values:
                equal = self._equal(subject, expression, scope)
                if isinstance(equal, Unknown):
                    unknown = unknown or equal  # cases differ: a known one that fits is the one
                elif equal:
                    self.run.run_block(case.body, scope)
                    return
        if unknown is not None:
            self._switch_unknown(statement, unknown, scope)
        elif statement.otherwise is not None:
            self.run.run_block(statement.otherwise, scope)

    def _switch_unknown(self, statement: Switch, unknown: Unknown, scope: Scope) -> None:
        blocks = [case.body for case in statement.cases]
        if statement.otherwise is not None:
            blocks.append(statement.otherwise)
        chosen = self._choice(statement.subject.span, unknown, blocks)
        if chosen is not None:
            self.run.run_block(chosen, scope)

    def _equal(self, subject: Value, expression: Expression, scope: Scope) -> bool | Unknown:
        value = (
            expression.value
            if isinstance(expression, Number)
            else self.run.evaluator.evaluate(expression, scope)
        )
        try:
            equal = apply("==", subject, value)
        except OperandError as error:
            raise SourceError(f"CASE: {error}", expression.span) from None
        return equal if isinstance(equal, Unknown) else bool(equal)

    def for_(self, loop: For, scope: Scope) -> None:
        bounds = [loop.start, loop.stop, *([loop.step] if loop.step is not None else [])]
        values = [self.run.evaluated(bound, scope, loop.span) for bound in bounds]
        unknown = next(filter(None, map(find_unknown, values)), None)
        if unknown is not None:
            self._for_unknown(loop, values[0], unknown, scope)
            return
        for value, bound in zip(values, bounds, strict=True):
            if isinstance(value, bool) or not isinstance(value, int | float):
                raise SourceError(f"FOR counts numbers, not {shown(value)}", bound.span)
        start, stop, step = (*values, 1)[:3]
        assert isinstance(start, int | float) and isinstance(stop, int | float)
        assert isinstance(step, int | float)
        if step == 0:
            raise SourceError("STEP is zero: the loop has no end", loop.span)
        counter: int | float = start + 0
        while counter <= stop if step > 0 else counter >= stop:
            self.run.evaluator.assign(loop.counter, counter, scope, loop.span)
            self.run.meter.statement(loop.span)
            if not self._pass(loop.body, scope):
                return
            counter = counter + step
        self.run.evaluator.assign(loop.counter, counter, scope, loop.span)

    def _for_unknown(self, loop: For, start: Value, unknown: Unknown, scope: Scope) -> None:
        moving = self.run.moving(loop.body)
        passes = self.run.course.passes(loop.start.span, unknown.reason, moving)
        first = start if isinstance(start, int) else 1
        for number in range(passes):
            self.run.evaluator.assign(loop.counter, first + number, scope, loop.span)
            if not self._pass(loop.body, scope):
                return

    def _pass(self, body: Block, scope: Scope) -> bool:
        """One pass of a loop; False if EXIT leaves it."""
        try:
            self.run.run_block(body, scope)
        except Left:
            return False
        return True

    def while_(self, loop: While, scope: Scope) -> None:
        if _always(loop.condition, True):
            self._forever(loop.body, loop.span, "WHILE TRUE", scope)
            return
        passes = 0
        after = After.CHANGED
        while after is not After.LEFT:
            value = self.run.evaluated(loop.condition, scope, loop.span)
            if isinstance(value, Unknown):
                if passes >= self._passes(loop.condition.span, value, loop.body):
                    return
            else:
                self._check_bool(value, loop.condition, "WHILE")
                if not value or (after is After.SAME and self._is_left(loop, passes, "WHILE")):
                    return
            passes += 1
            after = self._watched(loop.body, loop.span, passes, scope)

    def repeat_(self, loop: Repeat, scope: Scope) -> None:
        if _always(loop.condition, False):
            self._forever(loop.body, loop.span, "REPEAT … UNTIL FALSE", scope)
            return
        passes = 1
        while (after := self._watched(loop.body, loop.span, passes, scope)) is not After.LEFT:
            value = self.run.evaluated(loop.condition, scope, loop.span)
            if isinstance(value, Unknown):
                if passes >= self._passes(loop.condition.span, value, loop.body):
                    return
            else:
                self._check_bool(value, loop.condition, "UNTIL")
                if value or (after is After.SAME and self._is_left(loop, passes, "REPEAT")):
                    return
            passes += 1

    def _watched(self, body: Block, span: Span, passes: int, scope: Scope) -> After:
        """One pass of a loop, and what it has changed, as far as that is looked at."""
        self.run.meter.statement(span)
        if passes > _WATCHED or self.run.course.answers.sequences:
            return After.CHANGED if self._pass(body, scope) else After.LEFT
        changed = True
        self.run.data.journal.begin()
        try:
            stays = self._pass(body, scope)
        finally:
            changed = self.run.data.journal.end()
        if not stays:
            return After.LEFT
        return After.CHANGED if changed else After.SAME

    def _is_left(self, loop: While | Repeat, passes: int, what: str) -> bool:
        """Whether a loop that nothing changes is left: by a way out that was not taken, or because
        it only waits.

        Raises:
            Finished: it goes on for ever.
        """
        if self.skipped_exit is not None:
            return passes >= self._ends_by(loop.span, self.skipped_exit, loop.body)
        self._wait_or_finish(loop.body, loop.span, what, passes)
        return True

    def _wait_or_finish(self, body: Block, span: Span, what: str, passes: int) -> None:
        """A loop that nothing in the program changes: a wait for others, if it does not move the
        robot, and satisfied as all waits are.

        Raises:
            Finished: it moves the robot, for ever.
        """
        if self.run.moving(body):
            self._finish(_endless(what, passes), span)
        self.run.note_once(
            f"waits {span.file}:{span.start}",
            f"the loop ({what}) only waits for what the program does not change itself: it is "
            "taken as satisfied at once",
            span,
        )

    def _passes(self, span: Span, unknown: Unknown, body: Block) -> int:
        """How often a loop runs whose end nobody knows; decided once for every run of it."""
        return self.run.course.passes(span, unknown.reason, self.run.moving(body))

    def loop_(self, loop: Loop, scope: Scope) -> None:
        self._forever(loop.body, loop.span, "LOOP", scope)

    def _forever(self, body: Block, span: Span, what: str, scope: Scope) -> None:
        """A loop that ends by a statement in its body, or not at all."""
        if not leaves(body):
            self._pass(body, scope)
            self._finish(_endless(what, 1), span)
        passes = 0
        while True:
            outer, self.skipped_exit = self.skipped_exit, None
            passes += 1
            after = self._watched(body, span, passes, scope)
            skipped, self.skipped_exit = self.skipped_exit, outer
            if after is After.LEFT:
                return
            if skipped is None:
                if after is After.SAME:
                    self._wait_or_finish(body, span, what, passes)
                    return
            elif passes >= self._ends_by(span, skipped, body):
                return

    def _ends_by(self, span: Span, reason: str, body: Block) -> int:
        return max(1, self.run.course.passes(span, reason, self.run.moving(body)))

    def jump_back(self, goto: Goto, between: Block, last: Statement) -> None:
        """A jump to a label that was passed: a loop that is read once if nothing can end it."""
        if isinstance(last, Goto) and (not leaves(between) or self.skipped_exit is not None):
            self._finish(_endless(f"GOTO {goto.name.upper()}", 1), goto.span)

    def _finish(self, message: str, span: Span) -> NoReturn:
        self.run.note_once("end", message, span)
        raise Finished

    def goto_(self, statement: Goto, scope: Scope) -> None:
        raise Jump(statement)

    def return_(self, statement: Return, scope: Scope) -> None:
        value = None
        if statement.value is not None:
            value = self.run.evaluated(statement.value, scope, statement.span)
        raise Returned(value)

    def exit_(self, statement: Exit, scope: Scope) -> None:
        raise Left


def _always(condition: Expression, value: bool) -> bool:
    return isinstance(condition, Truth) and condition.value is value


def _endless(what: str, passes: int) -> str:
    count = "one pass is read" if passes == 1 else f"{passes} passes are read"
    return f"the program is an endless loop ({what}): {count}"
