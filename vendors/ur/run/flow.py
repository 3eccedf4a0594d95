"""Branches and loops, and when a loop ends where the text alone does not say it.

Of the branches whose condition is not known, `Course.branch` takes one.

A loop whose condition is not known runs as often as `Course.passes` says. One whose condition
stays fulfilled is followed while it gets on: while something that its condition or one of its
exits reads changes from pass to pass. If nothing does, it ends by an exit that was not taken since
its condition is not known, or by nothing, and then the program ends there.
"""

from __future__ import annotations

from typing import NoReturn, Protocol

from ....core.errors import Span
from ....core.source.execution.limits import Meter
from ....core.source.execution.outputs import Outputs
from ....core.source.execution.transcript import Transcript
from ..syntax.traversal import returns, way_out
from ..syntax.tree import Block, Constant, Expression, If, Number, While
from ..values.evaluator import Evaluation, condition
from ..values.located import Located
from ..values.scope import Scope
from ..values.values import Unknown, Value
from .analysis import Analysis
from .exits import Break, Continue, Finished, Frame, OpenExit, Returned

_PASSES = 1000
_MOVING_PASSES = 100
"""Passes after which a loop is left that an unknown condition might have ended."""


class FlowRun(Evaluation, Protocol):
    """What branches and loops ask of a run.

    Attributes:
        exits: branches not taken that may end the loop that runs.
        decisions: how often something was decided that is not known.
    """

    exits: list[OpenExit]
    decisions: int

    @property
    def analysis(self) -> Analysis:
        """What can be said of statements without running them."""

    @property
    def meter(self) -> Meter:
        """Counts what is executed."""

    @property
    def outputs(self) -> Outputs:
        """What the program has set."""

    @property
    def frames(self) -> list[Frame]:
        """The functions that run."""

    @property
    def out(self) -> Transcript:
        """What the run leaves."""

    def state(self) -> list[Value]:
        """What, beside variables, decides how the program goes on."""

    def run_block(self, block: Block, scope: Scope) -> None:
        """Execute statements in order."""

    def finish(self, message: str, span: Span) -> NoReturn:
        """End the program here, with a note."""


# ---------------------------------------------------------------------------- branches


def branch(run: FlowRun, statement: If, scope: Scope) -> None:
    """``if … elif … else … end``"""
    for index, one in enumerate(statement.branches):
        fulfilled = condition(run, one.condition, scope)
        if isinstance(fulfilled, Unknown):
            _undecided(run, statement, index, fulfilled, scope)
            return
        if fulfilled:
            run.run_block(one.body, scope)
            return
    if statement.otherwise is not None:
        run.run_block(statement.otherwise, scope)


def _undecided(run: FlowRun, statement: If, first: int, reason: Unknown, scope: Scope) -> None:
    """The condition of branch ``first`` is not known."""
    bodies = [one.body for one in statement.branches]
    if statement.otherwise is not None:
        bodies.append(statement.otherwise)
    main = len(run.frames) <= 1
    possible = [
        k >= first and run.analysis.can_be_taken(body) and not run.analysis.ends(body, main)
        for k, body in enumerate(bodies)
    ]
    run.decisions += 1
    head = run.texts.span(statement.start, statement.start + len("if"))
    taken = run.course.branch(head, reason.reason, possible)
    otherwise = statement.otherwise
    if taken == 0 and otherwise is not None and not run.analysis.ends(otherwise, main):
        taken = len(bodies)
    for k, body in enumerate(bodies[first:], first + 1):
        if returns(body) and run.frames and run.frames[-1].open is None:
            run.frames[-1].open = reason
        if k != taken:
            _leave_open(run, body, reason, scope)
    if taken:
        run.run_block(bodies[taken - 1], scope)


def _leave_open(run: FlowRun, body: Block, reason: Unknown, scope: Scope) -> None:
    """A branch is not taken: it may end a loop, and what only it makes is not known."""
    word, written = way_out(body), run.analysis.writes(body)
    outputs = frozenset(run.analysis.outputs_written(body))
    if word is not None:
        run.exits.append(OpenExit(word, frozenset(), reason))
    elif written or outputs:
        run.exits.append(OpenExit("break", written, reason, outputs))
    for name in run.analysis.assigns(body):
        if scope.find(name) is None:
            scope.own(name).value = reason


# ------------------------------------------------------------------------------- loops


def loop(run: FlowRun, statement: While, scope: Scope) -> None:
    """``while condition: … end``"""
    outer, run.exits = run.exits, []
    _Passes(run, statement, scope).carry_out()
    run.exits = outer + [e for e in run.exits if e.word != "break" or e.written or e.outputs]


class _Passes:
    """One execution of a loop."""

    def __init__(self, run: FlowRun, loop: While, scope: Scope) -> None:
        self._run = run
        self._loop = loop
        self._scope = scope
        self._head = run.texts.span(loop.start, loop.start + len("while"))
        self._count = 0
        self._left: int | None = None  # passes, once the end of the loop is found to be open
        self._waits = 0  # passes that were nothing but a wait for others
        self._first_move = run.out.move_index
        self._waited: frozenset[str] = frozenset()  # outputs that the condition read
        self._decisive = run.analysis.decisive_names(loop)

    def carry_out(self) -> None:
        run, loop = self._run, self._loop
        while True:
            run.outputs.asked.clear()
            fulfilled = condition(run, loop.condition, self._scope)
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
            run.meter.statement(run.texts.span_of(loop))
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
        moving = self._run.out.move_index > self._first_move
        return self._count >= (_MOVING_PASSES if moving else _PASSES)

    def _open_exit(self) -> OpenExit | None:
        for found in self._run.exits:
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
            if not waited & run.analysis.outputs_written(loop.body):
                run.outputs.forget(waited)  # somebody else is to change what the loop waits for
                self._waits = self._count
            return
        text = run.texts.text_of(loop.condition)[:40]
        moving = run.out.move_index > self._first_move
        passes = "one pass is" if self._count == 1 else f"{self._count} passes are"
        what = f"{passes} read" if moving else "the program ends there"
        run.finish(f"nothing ends the loop 'while {text}': {what}", self._head)

    def _state(self) -> list[Value]:
        """What decides how the loop goes on."""
        if self._decisive is None:
            values = self._scope.values()
            self._run.work(len(values), self._run.texts.span_of(self._loop))
            return [*values, *self._run.state()]
        cells = [self._scope.find(name) for name in self._decisive]
        return [None if cell is None else cell.value for cell in cells]

    def _passes(self, reason: Unknown) -> int:
        """How often the loop runs, where its end is not known."""
        run = self._run
        run.decisions += 1
        moving = run.analysis.moves(self._loop.body)
        return run.course.passes(self._head, reason.reason, moving)

    def _keep_if_waiting(self) -> None:
        if self._count == 0:
            self._run.out.keep(self._run.texts.span_of(self._loop), "while", "", stops=True)


def _always(condition: Expression) -> bool:
    if isinstance(condition, Constant):
        return condition.value is True
    return isinstance(condition, Number) and condition.value != 0
