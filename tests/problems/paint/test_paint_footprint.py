"""Footprints: the spline, the cone, the volume, and the errors that scenarios make of them."""

from __future__ import annotations

from itertools import pairwise

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.integrate import quad

from flyby.core.errors import InputError
from flyby.problems.paint.spray.footprint import Footprint, ring

from .paint_cases import fan_footprint


def test_the_ring_goes_through_its_knots():
    footprint = ring(0.25)
    assert np.allclose(footprint((0.0, 0.15, 0.25, 0.3)), (0.1, 1.0, 0.0, 0.0))
    assert footprint.coefficients[0] == pytest.approx(
        (0.1, 0.0, 3 * 0.9 / 0.15**2, -2 * 0.9 / 0.15**3)
    )


def test_the_cone_goes_through_its_circles():
    footprint = ring(0.25)
    opening = footprint.radius / footprint.reach
    assert opening == pytest.approx((0.25 - 0.035) / 0.25)
    assert footprint.source_distance * opening == pytest.approx(0.035)


@pytest.mark.parametrize("footprint", [ring(0.25), ring(0.2), fan_footprint(1.0)])
def test_slope_is_continuous_and_zero_at_the_ends(footprint):
    r = footprint.knots
    h = 1e-6
    assert footprint(h) == pytest.approx(footprint(0.0), abs=1e-9 * footprint.values.max())
    for knot in r[1:-1]:
        before = (footprint(knot) - footprint(knot - h)) / h
        after = (footprint(knot + h) - footprint(knot)) / h
        assert after == pytest.approx(before, abs=1e-3 * footprint.values.max() / r[-1])
    assert footprint(r[-1] - h) < 1e-8 * footprint.values.max()


@given(st.floats(0.05, 0.5), st.floats(0.0, 1.0), st.floats(0.2, 0.8), st.floats(1.0, 4.0))
def test_rate_is_the_integral(radius, centre, peak_at, aspect):
    knots = np.array((0.0, peak_at, 1.0)) * radius
    footprint = Footprint.of_cone(knots, (centre, 1.0, 0.0), 0.25, 0.1 * radius, aspect=aspect)
    expected = sum(
        quad(lambda r: 2 * np.pi * r * float(footprint(r)), a, b, epsabs=1e-14)[0]
        for a, b in pairwise(knots)
    )
    assert footprint.rate == pytest.approx(expected / aspect, rel=1e-9)


@given(st.floats(-0.2, 0.2))
def test_errors_keep_the_paint(error):
    footprint = ring(0.25)
    assert footprint.with_radius_error(error).rate == pytest.approx(footprint.rate)
    assert footprint.with_radius_error(error).radius == pytest.approx(0.25 * (1 + error))
    higher = footprint.with_height_error(0.1 * error)
    assert higher.rate == pytest.approx(footprint.rate)
    assert higher.reach == pytest.approx(footprint.reach)


@pytest.mark.parametrize(
    ("changes", "message"),
    [
        ({"knots": (0.0, 0.2, 0.1)}, "rise from 0"),
        ({"knots": (0.1, 0.2, 0.3)}, "rise from 0"),
        ({"values": (1.0, 1.0, 0.5)}, "flat and zero at the rim"),
        ({"values": (0.0, 0.0, 0.0)}, "above zero"),
        ({"values": (0.1, -1.0, 0.0)}, "cannot be taken away"),
        ({"values": (0.1, 1.0)}, "equally many"),
        ({"slopes": (1.0, 0.0, 0.0)}, "flat at the centre"),
        ({"slopes": (0.0, 200.0, 0.0)}, "cannot be taken away"),
        ({"near_radius": 0.3}, "widen"),
        ({"near_distance": 0.3}, "widen"),
        ({"aspect": 0.5}, "aspect"),
        ({"values": (0.1, np.inf, 0.0)}, "finite"),
    ],
)
def test_refusals(changes, message):
    good = {
        "knots": (0.0, 0.15, 0.25),
        "values": (0.1, 1.0, 0.0),
        "reference_distance": 0.25,
        "near_radius": 0.035,
    }
    with pytest.raises(InputError, match=message):
        Footprint.of_cone(**{**good, **changes})
