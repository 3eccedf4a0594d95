"""The table of what a change of a program brings."""

from __future__ import annotations

from pathlib import Path

import pytest

from flyby.cli.output.solution_report import ChangedMove, changed_rows, percent
from flyby.core.errors import Span
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


def test_a_line_that_runs_several_times_is_one_row_with_all_that_it_gains() -> None:
    main, spans = Path("a.mod"), [Span("a.mod", line, 1, 0, 0) for line in (7, 9)]
    moves = [ChangedMove(k, spans[k % 2], ("z10", f"{k % 2} mm"), 0.1) for k in range(8)]
    moves += [ChangedMove(8, spans[0], ("z10", "other"), None), ChangedMove(9, None, ("", ""), 0.2)]
    moves += [ChangedMove(10, None, ("", ""), 0.2)]
    assert list(changed_rows(main, moves)) == [
        ("1, 3, 5, …", "7 ×4", ("z10", "0 mm"), "0.400"),
        ("2, 4, 6, …", "9 ×4", ("z10", "1 mm"), "0.400"),
        ("9", "7", ("z10", "other"), ""),
        ("10", "", ("", ""), "0.200"),
        ("11", "", ("", ""), "0.200"),
    ]
