"""Two rules of a plant: no long waits, and no corner that stops the tool."""

from __future__ import annotations

from collections.abc import Iterator
from itertools import pairwise

import numpy as np

from flyby.core.hookspec import RuleRegister, hookimpl
from flyby.core.lint.finding import Hit, ProgramSubject, Rule, RunSubject, Severity
from flyby.core.program.move import Wait
from flyby.core.program.zone import Fine

LONGEST = 2.0
"""s that a robot may wait."""
SLOWEST = 0.2
"""Share of its speed that a tool keeps in a zone."""


def long_waits(subject: ProgramSubject) -> Iterator[Hit]:
    """Waits that are longer than the plant allows."""
    for statement in subject.program.statements:
        if isinstance(statement, Wait) and statement.duration > LONGEST:
            yield Hit(
                f"the robot waits {statement.duration:g} s, {LONGEST:g} s are allowed",
                "wait for a signal instead",
                span=statement.span,
            )


def slow_corners(subject: RunSubject) -> Iterator[Hit]:
    """Zones in which the tool all but stops."""
    made = subject.run.trajectory
    step = np.diff(made.position, axis=0)
    speed = np.linalg.norm(step, axis=1) / np.diff(made.t)
    moves = subject.program.moves
    for index, (before, after) in enumerate(pairwise(moves)):
        at = np.flatnonzero(np.diff((made.move > index).astype(int)))
        passed = not isinstance(before.zone, Fine)
        slow = passed and before.speed.tcp and after.speed.tcp and len(at)
        if slow and speed[at[0]] < SLOWEST * min(before.speed.tcp, after.speed.tcp):
            yield Hit("the tool all but stops in this zone", "make the zone larger", index)


@hookimpl
def flyby_register_rules(register: RuleRegister) -> None:
    """Hand over the rules."""
    warning = Severity.WARNING
    waits = Rule("extensions.long-wait", warning, "waits of more than 2 s", long_waits)
    corners = Rule("extensions.slow-corner", warning, "zones that all but stop", slow_corners)
    register.add_program_rule(waits, api=1)
    register.add_run_rule(corners, api=1)
