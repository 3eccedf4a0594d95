"""Trap routines: they may run at any time, and are not carried out."""

from __future__ import annotations

from typing import Protocol

from ....core.errors import Span
from ....core.source.execution.control_flow.analysis import Analysis
from ....core.source.execution.transcript import Transcript
from ..syntax.tree import Block, Name, Routine
from ..values.data import Globals
from ..values.evaluator import Evaluator
from .analysis import RapidTree


class TrapsRun(Protocol):
    """What traps ask of a run."""

    @property
    def data(self) -> Globals:
        """Modules, routines and data of the program."""

    @property
    def tree(self) -> RapidTree:
        """The statements of the program."""

    @property
    def analysis(self) -> Analysis[Block]:
        """What can be said of them without running them."""

    @property
    def evaluator(self) -> Evaluator:
        """Values of the run."""

    @property
    def out(self) -> Transcript:
        """What the run leaves."""


def connect(run: TrapsRun, trap: Routine, span: Span) -> None:
    """``CONNECT interrupt WITH trap``: what the trap writes is not known from now on."""
    body = run.tree.body(trap)
    if run.analysis.moves(body):
        run.out.notes.once(
            f"trap {trap.name}",
            f"TRAP {trap.text} moves the robot (line {trap.span.line}) whenever its interrupt "
            "comes, which nobody knows: what it drives is not in the path and the times; the "
            "program is driven as if it never came",
            span,
        )
    share_written(run, body, f"TRAP {trap.text}", span)


def share_written(run: TrapsRun, body: Block, writer: str, span: Span) -> None:
    """What a routine writes is not known from now on: nobody knows when, or with what, it runs.

    Args:
        body: of the routine.
        writer: for messages.
        span: where that comes from.
    """
    run.evaluator.outputs.share(run.analysis.outputs_written(body))
    for part, names in run.analysis.written_apart(body):
        routine = run.tree.routine(part)
        own = {d.name for d in routine.declarations} | {p.name for p in routine.parameters}
        for name in sorted(names - own):
            datum = Name(span, name, name)
            run.evaluator.share(datum, writer, run.data.scope_of(routine))
