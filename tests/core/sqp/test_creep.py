"""Steps of sequential quadratic programming that creep."""

from __future__ import annotations

from hypothesis import given
from hypothesis import strategies as st

from flyby.core.sqp.sequential.creep import Creep

MANY = 30


@given(size=st.floats(1e-6, 1.0), gain=st.floats(1e-6, 1.0), change=st.floats(0.92, 1.08))
def test_whole_steps_that_are_alike_creep(size: float, gain: float, change: float) -> None:
    creep = Creep()
    assert any(creep.seen(size * change**k, gain * change**k, True) for k in range(MANY))


@given(faster=st.floats(0.01, 0.85))
def test_converging_steps_do_not(faster: float) -> None:
    creep = Creep()
    assert not any(creep.seen(faster**k, faster ** (2 * k), True) for k in range(MANY))


@given(size=st.floats(1e-6, 1.0))
def test_shortened_steps_do_not(size: float) -> None:
    creep = Creep()
    assert not any(creep.seen(size, size, k % 5 > 0) for k in range(MANY))


@given(size=st.floats(1e-6, 1.0))
def test_steps_that_climb_do_not(size: float) -> None:
    creep = Creep()
    assert not any(creep.seen(size, -size, True) for _ in range(MANY))
