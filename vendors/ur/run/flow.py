"""Loops, and when they end where the text alone does not say it.

A loop whose condition is not known runs as often as `Course.passes` says. One whose condition
stays fulfilled is followed while it gets on: while something that its condition or one of its
exits reads changes from pass to pass. If nothing does, it ends by an exit that was not taken since
its condition is not known, or by nothing, and then the program ends there.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

from ....core.errors import Span
from ....core.program.move import Opaque
from ..syntax.traversal import way_out
from ..syntax.tree import Block, Constant, Expression, Number, While
from ..values.located import Located
from ..values.scope import Scope
from ..values.values import Unknown, Value
from .exits import Break, Continue, Finished, Returned

if TYPE_CHECKING:
    from .interpreter import Interpreter

_PASSES = 1000
_MOVING_PASSES = 100
"""Passes after which a loop is left that an unknown condition might have ended."""


@dataclass(frozen=True, slots=True)
class OpenExit:
    """A branch that was not taken, since its condition is not known, and that may end a loop.

    Args:
        word: by what.
        written: variables that it writes; empty if it holds the ``word`` itself.
        reason: what the condition depends on.
        outputs: that it writes.
    """

    word: str
    written: frozenset[str]
    reason: Unknown
    outputs: frozenset[str] = frozenset()


class Loops:
    """The loops of one run."""

    def __init__(self, run: Interpreter) -> None:
        self._run = run
        self.exits: list[OpenExit] = []

    def open_by(self, body: Block, reason: Unknown) -> None:
        """A branch that may end a loop is not taken."""
        word, written = way_out(body), self._run.flow.writes(body)
        if word is not None:
            self.exits.append(OpenExit(word, frozenset(), reason))
            return
        outputs = frozenset(self._run.flow.outputs_written(body))
        if written or outputs:
            self.exits.append(OpenExit("break", written, reason, outputs))

    def carry_out(self, loop: While, scope: Scope) -> None:
        """``while condition: … end``"""
        outer, self.exits = self.exits, []
        _Passes(self._run, loop, scope).carry_out()
        self.exits = outer + [e for e in self.exits if e.word != "break" or e.written or e.outputs]

    def head(self, loop: While) -> Span:
        """The first word of a loop, for its line."""
        return self._run.texts.span(loop.start, loop.start + len("while"))


class _Passes:
    """One execution of a loop."""

    def __init__(self, run: Interpreter, loop: While, scope: Scope) -> None:
        self._run = run
        self._loop = loop
        self._scope = scope
        self._count = 0
        self._left: int | None = None  # passes, once the end of the loop is found to be open
        self._waits = 0  # passes that were nothing but a wait for others
        self._first_move = run.move_index
        self._waited: frozenset[str] = frozenset()  # outputs that the condition read
        self._decisive = run.flow.decisive_names(loop)

    def carry_out(self) -> None:
        run, loop = self._run, self._loop
        while True:
            run.outputs.asked.clear()
            fulfilled = run.evaluator.condition(loop.condition, self._scope)
            self._waited = frozenset(run.outputs.asked)
            if isinstance(fulfilled, Unknown):
                if self._left is None:
                    self._left = max(0, self._passes(fulfilled) - self._waits)
                if self._left == 0:
                    self._keep_if_waiting()
                    return
            elif not fulfilled:
                return
            before = self._state()
            try:
                run.run_block(loop.body, self._scope)
            except Break:
                return
            except Continue:
                pass
            run.meter.statement(run.span_of(loop))
            self._count += 1
            self._left = None if self._left is None else self._left - 1
            if fulfilled is True and self._ends(self._state() != before):
                return

    def _ends(self, changed: bool) -> bool:
        """Whether the loop ends after a pass though its condition may still be fulfilled."""
        way = self._open_exit()
        if way is None:
            self._check_endless(changed)
            return False
        if changed and self._left is None and not self._long():
            return False
        if self._left is None:
            passes = self._passes(way.reason)
            self._left = 0 if changed else max(passes, 1) - self._count
        if self._left > 0:
            return False
        if way.word == "halt":
            raise Finished
        if way.word == "return":
            raise Returned(Located(way.reason))
        return True

    def _long(self) -> bool:
        moving = self._run.move_index > self._first_move
        return self._count >= (_MOVING_PASSES if moving else _PASSES)

    def _open_exit(self) -> OpenExit | None:
        for found in self._run.loops.exits:
            if found.outputs & self._waited:
                return found
            if not found.written and found.outputs:
                continue
            if not found.written or self._decisive is None:
                return found
            if not found.written.isdisjoint(self._decisive):
                return found
        return None

    def _check_endless(self, changed: bool) -> None:
        """End the program at a loop that nothing ends."""
        loop, run = self._loop, self._run
        endless = _always(loop.condition) and way_out(loop.body) is None
        if not endless and (changed or run.course.answers.sequences):
            return
        waited = self._waited.union(run.outputs.asked)
        if waited and not endless:
            if not waited & run.flow.outputs_written(loop.body):
                run.outputs.forget(waited)  # somebody else is to change what the loop waits for
                self._waits = self._count
            return
        text = run.texts.cut(loop.condition.start, loop.condition.end)[:40]
        moving = run.move_index > self._first_move
        passes = "one pass is" if self._count == 1 else f"{self._count} passes are"
        what = f"{passes} read" if moving else "the program ends there"
        run.finish(f"nothing ends the loop 'while {text}': {what}", run.loops.head(loop))

    def _state(self) -> list[Value]:
        """What decides how the loop goes on."""
        if self._decisive is None:
            values = self._scope.values()
            self._run.work(len(values), self._run.span_of(self._loop))
            return [*values, *self._run.state()]
        cells = [self._scope.find(name) for name in self._decisive]
        return [None if cell is None else cell.value for cell in cells]

    def _passes(self, reason: Unknown) -> int:
        """How often the loop runs, where its end is not known."""
        run = self._run
        run.decisions += 1
        moving = run.flow.moves(self._loop.body)
        return run.course.passes(run.loops.head(self._loop), reason.reason, moving)

    def _keep_if_waiting(self) -> None:
        if self._count == 0:
            span = self._run.span_of(self._loop)
            text = self._run.texts.cut(self._loop.start, self._loop.end)
            self._run.emit(Opaque(text, stops=True, span=span))


def _always(condition: Expression) -> bool:
    if isinstance(condition, Constant):
        return condition.value is True
    return isinstance(condition, Number) and condition.value != 0
