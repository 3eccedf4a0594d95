"""What is said of statements without running them."""

from __future__ import annotations

from collections.abc import Sequence

from flyby.core.source.execution.control_flow.analysis import Analysis
from flyby.core.source.execution.control_flow.steps import Step


class Routines:
    """Routines by name, which call each other."""

    def __init__(self, steps: dict[str, list[Step[str]]]) -> None:
        self._steps = steps

    def steps(self, block: str) -> Sequence[Step[str]]:
        return self._steps[block]


def test_of_routines_that_call_each_other_both_move_the_robot() -> None:
    """Whichever is asked first."""
    first, second = "first", "second"
    steps: dict[str, list[Step[str]]] = {
        first: [Step(calls=(second,)), Step(moves=True)],
        second: [Step(calls=(first,))],
    }
    for order in [(first, second), (second, first)]:
        analysis = Analysis(Routines(steps))
        assert [analysis.moves(block) for block in order] == [True, True]
