"""The table of what a change of a program brings."""

from __future__ import annotations

import pytest

from flyby.cli.output.solution_report import percent
from flyby.problems.improve.solution import FigureRow


@pytest.mark.parametrize(
    "before, after, shown",
    [
        (2.0, 1.5, "-25.0"),
        (2.0, 2.5, "25.0"),
        (2.0, 1.99999, "0.0"),
        (0.0, 1.0, ""),
        (3e-21, 4e-4, ""),  # no percentage of what is shown as zero
        (None, 1.0, ""),
        (1.0, None, ""),
    ],
)
def test_percent_are_of_what_is_shown(before, after, shown) -> None:
    assert percent(FigureRow("energy", "J", before, after)) == shown
