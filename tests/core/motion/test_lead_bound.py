"""What slack adds to leads at most, where gears hold weights, and splines of them."""

from __future__ import annotations

import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as st

from flyby.core.motion.elasticity import LEAD_STEP, derivatives_of
from flyby.core.motion.lead_bound import SPLINE_BY_SLOPE, Held


@settings(max_examples=60, deadline=None)
@given(
    slack=st.floats(1e-5, 1e-3),
    lead=st.floats(0.0, 3e-3),
    held=st.tuples(st.floats(0.0, 3e-3), st.floats(0.0, 3e-3)).map(sorted),
)
def test_slack_adds_no_more_than_reckoned_and_reaches_it(slack, lead, held) -> None:
    least, most = np.array(held)[:, None, None]
    bound = Held(least, most, np.zeros((1, 1))).taken(np.array([slack]), np.array([[lead]]))
    x, h = np.meshgrid(np.linspace(-lead, lead, 41), np.linspace(*held, 401))
    added = np.abs(slack * (np.tanh((x + h) / slack) - np.tanh(h / slack))).max()
    assert bound.shape == (1, 1)
    assert added <= bound[0, 0] + 1e-15
    assert bound[0, 0] <= min(lead, 2 * slack) + 1e-15
    # The grid of h, 7.5 µrad wide, may pass by the greatest.
    assert added >= bound[0, 0] - (held[1] - held[0]) / 400


def test_splines_are_off_by_no_more_than_their_kernel_allows_and_reach_it() -> None:
    """Of all values with slopes within ±1, zigzags against the spline's kernel are the worst."""
    count, middle, fine = 61, 30.5, 200
    t = np.arange(count) * LEAD_STEP
    weights = derivatives_of(t, np.eye(count), np.array([middle * LEAD_STEP]))[0][0]
    at = (np.arange((count - 1) * fine) + 0.5) / fine
    passed = at[:, None] < np.arange(count)
    zigzag = np.sign((at < middle) - passed @ weights)
    values = np.concatenate([[0.0], np.cumsum(zigzag)]) * LEAD_STEP / fine
    off = values[round(middle * fine)] - weights @ values[::fine]
    assert off <= SPLINE_BY_SLOPE * LEAD_STEP
    assert off > 0.995 * SPLINE_BY_SLOPE * LEAD_STEP
