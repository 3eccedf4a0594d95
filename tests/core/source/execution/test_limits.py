"""Programs without an end are stopped, others are not."""

from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st

from flyby.core.door import Shell, command_line
from flyby.core.errors import SourceError, Span
from flyby.core.source.execution.limits import EndlessError, ExecutionLimits, Meter

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


@given(st.integers(1, 9), st.integers(1, 9), st.booleans())
def test_only_a_loop_that_nears_no_end_is_stopped(limit: int, count: int, nears: bool) -> None:
    meter = Meter(ExecutionLimits(passes=limit))
    if count == limit and not nears:
        with pytest.raises(EndlessError, match=f"has run {count} times") as caught:
            meter.passed(count, lambda: nears, "LOOP", SPAN)
        assert caught.value.loop == SPAN
    else:
        meter.passed(count, lambda: nears, "LOOP", SPAN)


def test_the_remedy_is_one_where_the_program_is_read() -> None:
    def stop() -> None:
        Meter(ExecutionLimits(passes=0)).passed(0, lambda: False, "LOOP", SPAN)

    with pytest.raises(SourceError, match=r"\(entry=NAME\), or .*ReadOptions\(limits=…\)$"):
        stop()
    with (
        command_line(Shell({}, {})),
        pytest.raises(SourceError, match=r"without it \(--entry NAME\)$"),
    ):
        stop()
