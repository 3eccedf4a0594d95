"""Statements that are not carried out: kept ones, routines that are not at hand, damaged text."""

from __future__ import annotations

import re
from contextlib import suppress
from typing import Protocol

from ....core.errors import SourceError, Span
from ....core.source.execution.course import Course
from ..motion.settings import SettingsInForce
from ..syntax import tree
from ..values.defaults import nominal
from ..values.scope import Scope
from ..values.types import Scalar, Unknown
from .instructions import refusal
from .kept import KEPT, written
from .traps import TrapsRun, share_written

_HEAD = re.compile(r"\w+")


class SteppingRun(TrapsRun, Protocol):
    """What it takes to step over statements in a run."""

    @property
    def course(self) -> Course:
        """What the text leaves open."""

    @property
    def settings(self) -> SettingsInForce:
        """Settings of the motion."""

    def open_move(self, error: SourceError, span: Span) -> bool:
        """Whether the program goes on behind a move that cannot be read, which stays open."""


def keep(run: SteppingRun, statement: tree.Invoke, scope: Scope) -> None:
    """Step over an instruction that does not move the robot; it stays as it stands."""
    kept = KEPT[statement.name]
    for argument in statement.arguments:
        # Functions of the program itself may move the robot, even for a message's text.
        called = () if argument.value is None else run.tree.called(argument.value, scope.home)
        if argument.value is not None and any(map(run.analysis.moves, called)):
            run.evaluator.evaluate(argument.value, scope)
    if kept.writes:
        _fill(run, statement, scope)
    if kept.sent:
        run.course.sent(statement.text, statement.span)
    run.out.keep(statement.span, statement.text, kept.why, kept.stops)
    for argument in statement.arguments:
        flag = argument.value
        if argument.option == "timeflag" and isinstance(flag, tree.Name) and scope.find(flag.name):
            run.evaluator.assign(flag, False, scope)


def _fill(run: SteppingRun, statement: tree.Invoke, scope: Scope) -> None:
    """Data that a kept instruction writes have the user's answers, or no known value."""
    for argument in written(statement.name, statement.arguments):
        if not isinstance(argument.value, tree.Name):
            continue
        cell = scope.find(argument.value.name)
        if cell is not None and not cell.constant:
            name = argument.value.text
            unknown = Unknown(f"what {statement.text} gave {name}", statement.span, name)
            run.evaluator.fill(argument.value, unknown, scope, statement.name)


def step_over_missing(run: SteppingRun, statement: tree.Invoke, scope: Scope) -> None:
    """Step over a routine whose text is not at hand, and that is no instruction.

    Raises:
        SourceError: it is an instruction that is refused, or looks like a slip of the pen.
    """
    span = statement.span
    if statement.name in run.course.answers.skipped:
        run.course.skips(statement.text, span)
        why = "it is skipped, as the answers say"
        run.out.keep(span, statement.text, why, device=True)
    else:
        try:
            message = refusal(statement, run.data)
        except SourceError as error:
            if not run.open_move(error, span):
                raise
            return
        run.out.keep(span, statement.text, "", device=True)
        run.course.stepped_over(statement.text, span, message)
        _leave_open(run, statement, scope)
    run.evaluator.outputs.forget()


def _leave_open(run: SteppingRun, statement: tree.Invoke, scope: Scope) -> None:
    """Nobody knows what a routine that is not at hand makes of the data that it is given."""
    for argument in statement.arguments:
        name = argument.value
        cell = scope.find(name.name) if isinstance(name, tree.Name) else None
        if cell is None or cell.constant or not isinstance(cell.type, Scalar):
            continue
        assert isinstance(name, tree.Name)
        if cell.dimensions and not name.path:
            continue
        reason = f"what {statement.text} may have made of {name.text}"
        value = nominal(run.evaluator.evaluate(name, scope), cell.type)
        unknown = Unknown(reason, statement.span, name.text, value)
        run.evaluator.assign(name, unknown, scope)


def step_over_unread(run: SteppingRun, statement: tree.Unread, scope: Scope) -> None:
    """What is damaged: nobody knows what it does to what it names."""
    step = run.tree.unread(statement, scope.home)
    known_no_more = run.analysis.lost(step)
    line = f"line {statement.span.line}"
    head = _HEAD.match(run.out.text_of(statement.span))
    named = "what stands there" if head is None else head[0]
    run.settings.lose(known_no_more.settings, f"{named}, damaged in {line}")
    if isinstance(statement.target, tree.Name):
        reason = f"the value of {statement.target.text}, damaged in {line}"
        with suppress(SourceError):  # a constant stays one
            unknown = Unknown(reason, statement.span, lost=True)
            run.evaluator.assign(statement.target, unknown, scope)
    for body in step.calls:
        share_written(run, body, f"a damaged call in {line}", statement.span)
    if not known_no_more.moves or not run.open_move(statement.error, statement.span):
        run.out.keep(statement.span, "", "")
