"""Programs without an end are stopped, others are not."""

from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st

from flyby.core.door import Shell, command_line
from flyby.core.errors import SourceError, Span
from flyby.core.source.execution.limits import ExecutionLimits, Meter

SPAN = Span("a.mod", 7, 3, 60, 65)
STEPS = st.lists(st.sampled_from(["statement", "move"]), max_size=60)


@given(STEPS, st.integers(1, 6), st.integers(1, 6))
def test_the_meter_stops_at_its_limits_and_not_before(
    steps: list[str], statements: int, moves: int
) -> None:
    meter = Meter(ExecutionLimits(statements, moves, calls=3))
    row = driven = 0
    for step in steps:
        row, driven = (0, driven + 1) if step == "move" else (row + 1, driven)
        if row > statements or driven - 1 > moves:  # a move counts when it is driven again
            with pytest.raises(SourceError, match=r"a\.mod:7:3.*has not ended") as caught:
                getattr(meter, step)(SPAN)
            assert caught.value.span == SPAN
            return
        getattr(meter, step)(SPAN)


@given(st.lists(st.booleans(), max_size=60), st.integers(1, 5))
def test_calls_that_come_back_do_not_count(enters: list[bool], calls: int) -> None:
    meter = Meter(ExecutionLimits(calls=calls))
    depth = 0
    for enter in enters:
        if not enter:
            if depth:
                meter.back()
                depth -= 1
            continue
        depth += 1
        if depth > calls:
            with pytest.raises(SourceError, match=f"weld: {calls} routines"):
                meter.call("weld", SPAN)
            return
        meter.call("weld", SPAN)


@given(st.lists(st.integers(1, 3), max_size=40), st.integers(1, 5))
def test_one_move_is_not_repeated_for_ever(lines: list[int], repeats: int) -> None:
    meter = Meter(ExecutionLimits(repeats=repeats))
    for position, line in enumerate(lines):
        span = Span("a.mod", line, 3, 60, 65)
        if lines[: position + 1].count(line) > repeats:
            with pytest.raises(SourceError, match=f"executed {repeats} times.*has not ended"):
                meter.move(span)
            return
        meter.move(span)


def test_the_remedy_is_one_where_the_program_is_read() -> None:
    with pytest.raises(SourceError, match=r"\(entry=NAME\), or .*ReadOptions\(limits=…\)$"):
        Meter(ExecutionLimits(repeats=0)).move(SPAN)
    with (
        command_line(Shell({}, {})),
        pytest.raises(SourceError, match=r"without it \(--entry NAME\)$"),
    ):
        Meter(ExecutionLimits(repeats=0)).move(SPAN)
