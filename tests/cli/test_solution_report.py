"""The table of what a change of a program brings."""

from __future__ import annotations

from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

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
    moves = [ChangedMove(k, spans[k % 2], ("z10", f"{k % 2} mm")) for k in range(8)]
    moves += [ChangedMove(8, spans[0], ("z10", "other"))]
    moves += [ChangedMove(k, None, ("", "")) for k in (9, 10)]
    gained = dict.fromkeys(range(8), 0.1) | {9: 0.2, 10: 0.2, 11: 0.05, 12: -0.01}
    assert list(changed_rows(main, moves, gained)) == [
        ("1, 3, 5, …", "7 ×4", ("z10", "0 mm"), "0.400"),
        ("2, 4, 6, …", "9 ×4", ("z10", "1 mm"), "0.400"),
        ("9", "7", ("z10", "other"), ""),
        ("10", "", ("", ""), "0.200"),
        ("11", "", ("", ""), "0.200"),
        ("others", "", ("", ""), "0.040"),
    ]
    assert list(changed_rows(main, moves, {0: 0.1, 12: 1e-4}))[-1][0] == "11"


@given(st.lists(st.tuples(st.integers(0, 2), st.integers(-400, 400)), max_size=12))
def test_all_rows_together_are_all_that_is_gained(waypoints: list[tuple[int, int]]) -> None:
    """Some of the waypoints changed, in two lines; times are whole milliseconds."""
    spans = [Span("a.mod", line, 1, 0, 0) for line in (7, 9)]
    gained = {k: gain / 1e3 for k, (_, gain) in enumerate(waypoints)}
    moves = [ChangedMove(k, spans[at], ("",)) for k, (at, _) in enumerate(waypoints) if at < 2]
    shown = [float(row[3]) for row in changed_rows(Path("a.mod"), moves, gained)]
    if moves:
        assert sum(shown) == pytest.approx(sum(gained.values()), abs=1e-9)
    else:
        assert shown == []
