"""Conditions, loops and jumps."""

from __future__ import annotations

from collections.abc import Callable
from enum import Enum
from functools import partial
from typing import NamedTuple, NoReturn

from ....core.errors import SourceError, Span
from ....core.source.execution.answers import Course
from ....core.source.execution.limits import Meter
from ....core.source.execution.transcript import Notes
from ..motion.own_position import OwnPosition
from ..motion.position import Position
from ..syntax.expression_tree import Expression, Name, Number, Truth
from ..syntax.tree import Block, Exit, For, Goto, If, Loop, Repeat, Return, Statement, Switch, While
from ..values.data import Data
from ..values.evaluator import Evaluator
from ..values.operators import OperandError, apply
from ..values.scope import Scope
from ..values.values import Unknown, Value, find_unknown, shown, unplaced
from .analysis import Moving, Routines, guard_names, leaves, names_in, names_written
from .exits import Finished, Jump, Left, Returned
from .output_writes import OutputWrites

_WATCHED = 3
"""Passes of a loop in which it may turn out that nothing changes any more."""


_FOLLOWED = 100
"""Passes of a loop that gets on, after which it is left by a way out that nobody can decide."""
_OTHERS = "outputs that only others can change"


class After(Enum):
    """What a pass of a loop has done."""

    LEFT = "left"
    """EXIT has left the loop."""
    SAME = "same"
    """All data are as they were before it."""
    MOVED = "moved"
    """They are, and the robot stands elsewhere."""
    CHANGED = "changed"
    """Some datum has another value, or that was not looked at."""


class _Asked(NamedTuple):
    """How often the program had asked for something when a loop began.

    Args:
        position: where the robot stands.
        outputs: what outputs hold that it has set.
        skipped: or rather, how many branches had not been taken as nobody knows their conditions.
    """

    position: int
    outputs: int
    skipped: int


Evaluated = Callable[[Expression, Scope, Span], Value]
"""A value; if reading it stops the advance run, the robot stops at the statement's place."""


class Flow:
    """Carries out the statements that decide which statements run.

    Args:
        run_block: carries statements out.
        evaluated: evaluates what a statement depends on.
        evaluator: for counters and cases.
        data: of the program.
        course: decides what nobody knows.
        meter: counts passes.
        body: of the routine that a call means.
        position: follows the robot.
        own_position: is asked by the program.
        writes: which outputs statements write.
        notes: takes notes.
    """

    def __init__(
        self,
        run_block: Callable[[Block, Scope], None],
        evaluated: Evaluated,
        evaluator: Evaluator,
        data: Data,
        course: Course,
        meter: Meter,
        body: Routines,
        position: Position,
        own_position: OwnPosition,
        writes: OutputWrites,
        notes: Notes,
    ) -> None:
        self._run_block = run_block
        self._evaluated = evaluated
        self._evaluator = evaluator
        self._data = data
        self._course = course
        self._meter = meter
        self._body = body
        self._position = position
        self._own_position = own_position
        self._output_writes = writes
        self._notes = notes
        self._moving = Moving(body)
        self.skipped_exit: str | None = None
        """What it depends on whether a loop is left, where a way out was not taken."""
        self._jumped = 0
        self._skips = 0
        self._skipped: dict[int, tuple[int, Block, str]] = {}
        # By the block's id: which skip was its last, the block, and why. Each once, however often.
        self._writes: dict[int, set[str]] = {}

    def run_body(self, body: Block, scope: Scope) -> None:
        """The statements of a routine: a way out that is not taken in it leaves no loop outside."""
        skipped = self.skipped_exit
        try:
            self._run_block(body, scope)
        finally:
            self.skipped_exit = skipped

    def if_(self, statement: If, scope: Scope) -> None:
        value = self._evaluated(statement.condition, scope, statement.span)
        if isinstance(value, Unknown):
            blocks = [statement.body, statement.otherwise]
            chosen = self._choice(statement.condition.span, value, blocks)
            if chosen is not None:
                self._run_block(chosen, scope)
            return
        self._check_bool(value, statement.condition, "IF")
        self._run_block(statement.body if value else statement.otherwise, scope)

    @staticmethod
    def _check_bool(value: Value, condition: Expression, what: str) -> None:
        if not isinstance(value, bool):
            raise SourceError(
                f"the condition of {what} is a BOOL, not {shown(value)}", condition.span
            )

    def _choice(self, span: Span, unknown: Unknown, blocks: list[Block]) -> Block | None:
        """The branch that is taken where nobody knows."""
        returning = [self._moving(block) and not leaves(block) for block in blocks]
        taken = self._course.branch(span, unknown.reason, returning)
        for number, block in enumerate(blocks, 1):
            if number != taken:
                self._skips += 1
                self._skipped[id(block)] = (self._skips, block, unknown.reason)
            if number != taken and leaves(block):
                self.skipped_exit = unknown.reason
        return blocks[taken - 1] if taken else None

    def switch_(self, statement: Switch, scope: Scope) -> None:
        subject = self._evaluated(statement.subject, scope, statement.span)
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
                    self._run_block(case.body, scope)
                    return
        if unknown is not None:
            self._switch_unknown(statement, unknown, scope)
        elif statement.otherwise is not None:
            self._run_block(statement.otherwise, scope)

    def _switch_unknown(self, statement: Switch, unknown: Unknown, scope: Scope) -> None:
        blocks = [case.body for case in statement.cases]
        if statement.otherwise is not None:
            blocks.append(statement.otherwise)
        chosen = self._choice(statement.subject.span, unknown, blocks)
        if chosen is not None:
            self._run_block(chosen, scope)

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

    def for_(self, loop: For, scope: Scope) -> None:
        """``FOR``: its bounds are evaluated once; the counter is the program's own datum, to which
        the step is added after every pass, whatever the body has made of it."""
        bounds = [loop.start, loop.stop, *([loop.step] if loop.step is not None else [])]
        values = [self._evaluated(bound, scope, loop.span) for bound in bounds]
        for value, bound in zip(values, bounds, strict=True):
            if find_unknown(value) is None and not _is_number(value):
                raise SourceError(f"FOR counts numbers, not {shown(value)}", bound.span)
        start, stop, step = (*values, 1)[:3]
        if step == 0:
            raise SourceError("STEP is zero: the loop has no end", loop.span)
        unknown = next(filter(None, map(find_unknown, values)), None)
        first = 1 if isinstance(start, Unknown) else unplaced(start)
        self._evaluator.assign(loop.counter, first, scope, loop.span)
        passes, asked = 0, self._asked()
        after = After.CHANGED
        while after is not After.LEFT:
            counter = self._evaluator.names.value(loop.counter, scope)
            open_ = unknown or find_unknown(counter)
            if open_ is not None:
                if passes >= self._passes(loop.start.span, open_, loop.body):
                    return
            elif _is_past(counter, stop, step) or (
                self._stays(after, asked) and self._is_left(loop, passes, "FOR", asked, scope)
            ):
                return
            passes += 1
            run_pass = partial(self._counted, loop, step, scope)
            after = self._watched(run_pass, loop.span, passes)
            self._note_moved_bound(loop, stop, scope)

    def _counted(self, loop: For, step: Value, scope: Scope) -> bool:
        """One pass of a FOR, and its counter counted on; False if EXIT leaves it."""
        if not self._pass(loop.body, scope):
            return False
        counter = self._evaluator.names.value(loop.counter, scope)
        following = apply("+", counter, 1 if isinstance(step, Unknown) else step)
        self._evaluator.assign(loop.counter, following, scope, loop.span)
        return True

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

    def _pass(self, body: Block, scope: Scope) -> bool:
        """One pass of a loop; False if EXIT leaves it."""
        try:
            self._run_block(body, scope)
        except Left:
            return False
        return True

    def while_(self, loop: While, scope: Scope) -> None:
        if _always(loop.condition, True):
            self._forever(loop.body, loop.span, "WHILE TRUE", scope)
            return
        passes, asked = 0, self._asked()
        after = After.CHANGED
        while after is not After.LEFT:
            value = self._evaluated(loop.condition, scope, loop.span)
            if isinstance(value, Unknown):
                if passes >= self._passes(loop.condition.span, value, loop.body):
                    return
            else:
                self._check_bool(value, loop.condition, "WHILE")
                if not value or self._ends(loop, after, passes, "WHILE", asked, scope):
                    return
            passes += 1
            run_pass = partial(self._pass, loop.body, scope)
            after = self._watched(run_pass, loop.span, passes)

    def repeat_(self, loop: Repeat, scope: Scope) -> None:
        if _always(loop.condition, False):
            self._forever(loop.body, loop.span, "REPEAT … UNTIL FALSE", scope)
            return
        passes, asked = 1, self._asked()
        run_pass = partial(self._pass, loop.body, scope)
        while (after := self._watched(run_pass, loop.span, passes)) is not After.LEFT:
            value = self._evaluated(loop.condition, scope, loop.span)
            if isinstance(value, Unknown):
                if passes >= self._passes(loop.condition.span, value, loop.body):
                    return
            else:
                self._check_bool(value, loop.condition, "UNTIL")
                if value or self._ends(loop, after, passes, "REPEAT", asked, scope):
                    return
            passes += 1

    def _watched(self, run_pass: Callable[[], bool], span: Span, passes: int) -> After:
        """One pass of a loop, and what it has changed, as far as that is looked at.

        Args:
            run_pass: False if the loop is left.
        """
        self._meter.statement(span)
        if passes > _WATCHED or self._course.answers.sequences:
            return After.CHANGED if run_pass() else After.LEFT
        changed = True
        place = self._position.last_move_numbers
        held = self._data.outputs.held()
        self._data.journal.begin()
        try:
            stays = run_pass()
        finally:
            changed = self._data.journal.end()
        if not stays:
            return After.LEFT
        if changed or self._data.outputs.held() != held:
            return After.CHANGED
        return After.SAME if self._position.last_move_numbers == place else After.MOVED

    def _asked(self) -> _Asked:
        return _Asked(self._own_position.asked, len(self._data.outputs.asked), self._skips)

    def _stays(self, after: After, asked: _Asked) -> bool:
        """Whether a pass shows that the loop gets no further.

        Where the program asks for it, it is for the robot's position to end the loop.
        """
        return after is After.SAME or (
            after is After.MOVED and self._own_position.asked == asked.position
        )

    def _leave_to_others(self, body: Block, first: int, scope: Scope) -> bool:
        """Whether a loop has read outputs that only others can change; they have from now on.

        Args:
            first: of the outputs asked for, from which on the loop read them.
        """
        outputs = self._data.outputs
        asked = set(outputs.asked[first:])
        written = self._output_writes.written(body, scope)
        if not asked or written is None or asked & written:
            return False
        outputs.forget(asked)
        return True

    def _ends(
        self,
        loop: While | Repeat,
        after: After,
        passes: int,
        what: str,
        asked: _Asked,
        scope: Scope,
    ) -> bool:
        """Whether a loop ends after a pass though its condition says that it goes on.

        Raises:
            Finished: it goes on for ever.
        """
        reason = self._decided_by_what_was_skipped(names_in(loop.condition), loop.body, asked)
        if reason is not None and passes:
            return passes >= self._ends_by(loop.span, reason, loop.body)
        return self._stays(after, asked) and self._is_left(loop, passes, what, asked, scope)

    def _decided_by_what_was_skipped(
        self, read: set[str], body: Block, asked: _Asked
    ) -> str | None:
        """What it depends on whether a loop ends, if the data that decide it are written in
        branches of it that were not taken, and nowhere else in it.

        Args:
            read: names of the data.
        """
        skipped = self._skipped_since(asked)
        found = (why for block, why in skipped if read & self._written_in(block))
        reason = next(found, None)
        if reason is None:
            return None
        left_out = frozenset(id(block) for block, _ in skipped)
        return None if read & names_written(body, self._body, left_out) else reason

    def _skipped_since(self, asked: _Asked) -> list[tuple[Block, str]]:
        """Branches that were not taken since a loop began, and what they depend on."""
        return [(block, why) for at, block, why in self._skipped.values() if at > asked.skipped]

    def _written_in(self, block: Block) -> set[str]:
        """See `names_written`; kept, since loops ask it of every pass."""
        found = self._writes.get(id(block))
        if found is None:
            found = self._writes[id(block)] = names_written(block, self._body)
        return found

    def _gets_on(self, body: Block, asked: _Asked) -> bool:
        """Whether a loop writes what decides of ways out of it that are known, and the user does
        not say how often loops run."""
        if self._course.answers.passes:
            return False
        left_out = frozenset(id(block) for block, _ in self._skipped_since(asked))
        written = names_written(body, self._body, left_out)
        return bool(guard_names(body, left_out) & written)

    def _is_left(
        self, loop: For | While | Repeat, passes: int, what: str, asked: _Asked, scope: Scope
    ) -> bool:
        """Whether a loop that nothing changes is left: by a way out that was not taken, or because
        it only waits.

        Raises:
            Finished: it goes on for ever.
        """
        if self.skipped_exit is not None:
            return passes >= self._ends_by(loop.span, self.skipped_exit, loop.body)
        if self._leave_to_others(loop.body, asked.outputs, scope):
            return passes >= self._ends_by(loop.span, _OTHERS, loop.body)
        self._wait_or_finish(loop.body, loop.span, what, passes)
        return True

    def _wait_or_finish(self, body: Block, span: Span, what: str, passes: int) -> None:
        """A loop that nothing in the program changes: a wait for others, if it does not move the
        robot, and satisfied as all waits are.

        Raises:
            Finished: it moves the robot, for ever.
        """
        if self._moving(body):
            self._finish(_endless(what, passes), span)
        self._notes.once(
            f"waits {span.file}:{span.start}",
            f"the loop ({what}) only waits for what the program does not change itself: it is "
            "taken as satisfied at once",
            span,
        )

    def _passes(self, span: Span, unknown: Unknown, body: Block) -> int:
        """How often a loop runs whose end nobody knows; decided once for every run of it."""
        return self._course.passes(span, unknown.reason, self._moving(body))

    def loop_(self, loop: Loop, scope: Scope) -> None:
        self._forever(loop.body, loop.span, "LOOP", scope)

    def _forever(self, body: Block, span: Span, what: str, scope: Scope) -> None:
        """A loop that ends by a statement in its body, or not at all."""
        if not leaves(body):
            self._pass(body, scope)
            self._finish(_endless(what, 1), span)
        passes, asked = 0, self._asked()
        while True:
            outer, self.skipped_exit = self.skipped_exit, None
            passes += 1
            after = self._watched(partial(self._pass, body, scope), span, passes)
            skipped, self.skipped_exit = self.skipped_exit, outer
            if after is After.LEFT:
                return
            if skipped is None:
                skipped = self._decided_by_what_was_skipped(guard_names(body), body, asked)
            elif after is After.CHANGED and passes < _FOLLOWED and self._gets_on(body, asked):
                continue
            if skipped is None:
                if self._stays(after, asked):
                    if self._leave_to_others(body, asked.outputs, scope):
                        continue
                    self._wait_or_finish(body, span, what, passes)
                    return
            elif passes >= self._ends_by(span, skipped, body):
                return

    def _ends_by(self, span: Span, reason: str, body: Block) -> int:
        return max(1, self._course.passes(span, reason, self._moving(body)))

    def jump_back(self, goto: Goto, between: Block, last: Statement, scope: Scope) -> None:
        """A jump to a label that was passed: a loop that is read once if nothing can end it."""
        if not self._moving(between):
            self._leave_to_others(Block((*between.statements, last)), self._jumped, scope)
        self._jumped = len(self._data.outputs.asked)
        if isinstance(last, Goto) and (not leaves(between) or self.skipped_exit is not None):
            self._finish(_endless(f"GOTO {goto.name.upper()}", 1), goto.span)

    def _finish(self, message: str, span: Span) -> NoReturn:
        self._notes.once("end", message, span)
        raise Finished

    def goto_(self, statement: Goto, scope: Scope) -> None:
        raise Jump(statement)

    def return_(self, statement: Return, scope: Scope) -> None:
        value = None
        if statement.value is not None:
            value = self._evaluated(statement.value, scope, statement.span)
        raise Returned(value)

    def exit_(self, statement: Exit, scope: Scope) -> None:
        raise Left


def _is_number(value: Value) -> bool:
    return isinstance(value, int | float) and not isinstance(value, bool)


def _is_past(counter: Value, stop: Value, step: Value) -> bool:
    """Whether a FOR has counted beyond its end."""
    assert isinstance(counter, int | float) and isinstance(stop, int | float)
    assert isinstance(step, int | float)
    return counter > stop if step > 0 else counter < stop


def _always(condition: Expression, value: bool) -> bool:
    return isinstance(condition, Truth) and condition.value is value


def _endless(what: str, passes: int) -> str:
    count = "one pass is read" if passes == 1 else f"{passes} passes are read"
    return f"the program is an endless loop ({what}): {count}"
