"""Numbers of a changed program: few digits in the text, and never beyond what they may be."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from flyby.core.dialect import Orientation
from flyby.core.program.zone import FINE, Angle, ContourFraction, Radius
from flyby.core.registry import find_vendor
from flyby.core.source.text.numerals import shortest
from flyby.core.spatial.pose import Pose
from flyby.problems.improve.rounding import Rounding

SI = Rounding(in_si=True)
MM = Rounding()
sizes = st.floats(2e-4, 2.0)
anything = st.floats(-3.0, 3.0)


def as_mm(value: float) -> str:
    """The shortest text in mm that is read as a length, as readers do it."""
    return shortest(value, 1000 * value, lambda mm: mm / 1000)


def as_degrees(value: float) -> str:
    return shortest(value, math.degrees(value), math.radians)


def decimals(text: str) -> int:
    return len(text.partition(".")[2])


@given(sizes)
def test_zones_are_no_larger_and_have_two_decimals(size: float) -> None:
    zone = MM.zone(Radius(size, 1.5 * size, 1.5 * size, size, 1.5 * size, size))
    assert isinstance(zone, Radius)
    assert zone.tcp <= size * (1 + 1e-11) and size - zone.tcp <= 1e-5
    assert decimals(as_mm(zone.tcp)) <= (2 if size >= 1e-3 else 3)
    assert decimals(as_mm(zone.reorientation)) <= 3 and decimals(as_mm(zone.external_linear)) <= 3
    assert decimals(as_degrees(zone.angle)) <= 6
    assert zone.reorientation >= zone.tcp and zone.external >= zone.tcp
    assert zone.reorientation / zone.tcp == pytest.approx(1.5, rel=2e-2 if size < 1e-3 else 1e-3)


@given(sizes)
def test_rounding_a_zone_again_changes_nothing(size: float) -> None:
    for rounding in (SI, MM):
        once = rounding.zone(Radius(size, 1.5 * size, 1.5 * size))
        assert rounding.zone(once) == once


@given(sizes)
def test_metres_stay_metres(size: float) -> None:
    zone = SI.zone(Radius(size))
    assert (isinstance(zone, Radius) and decimals(repr(zone.tcp)) <= 6) or zone == FINE


def test_other_zones_and_what_is_none() -> None:
    assert MM.zone(ContourFraction(0.4599999)) == ContourFraction(0.45)
    assert MM.zone(Angle(math.radians(3.21987))) == Angle(math.radians(3.219))
    assert MM.zone(Radius(9e-5)) == FINE and MM.zone(ContourFraction(0.004)) == FINE
    assert MM.zone(FINE) == FINE


def test_predefined_zones_are_the_largest_below() -> None:
    zones = (Radius(0.05, name="z50"), Radius(0.01, name="z10"), Radius(0.0, name="z"))
    rounding = Rounding(predefined=zones)
    assert rounding.zone(Radius(0.049)) == zones[1]
    assert rounding.zone(Radius(0.05)) == zones[0]
    assert rounding.zone(Radius(0.009)) == FINE
    assert rounding.zone(ContourFraction(0.456)) == ContourFraction(0.45)


@given(anything, anything, anything)
def test_angles_stay_within_their_bounds(value: float, one: float, other: float) -> None:
    lower, upper = min(one, other), max(one, other)
    value = min(max(value, lower), upper)
    for rounding in (SI, MM):
        rounded = rounding.angle(value, lower, upper)
        assert lower <= rounded <= upper
        assert rounded == pytest.approx(value, abs=2e-6)
    free = MM.angle(value)
    assert free == pytest.approx(value, abs=9e-7) and decimals(as_degrees(free)) <= 4
    assert decimals(repr(SI.angle(value))) <= 6 or "e" in repr(SI.angle(value))


@given(st.tuples(anything, anything, anything), st.floats(0.0, 0.1))
def test_positions_stay_within_their_bounds(place: tuple[float, float, float], half: float) -> None:
    value = np.array(place)
    for rounding in (SI, MM):
        found = np.array(rounding.position(place, value - half, value + half))
        assert np.all(np.abs(found - value) <= min(half, 1.1e-5) + 1e-15)
    free = MM.position(place, np.full(3, -np.inf), np.full(3, np.inf))
    assert all(decimals(as_mm(x)) <= 2 for x in free)


@given(st.tuples(anything, anything, anything, anything))
def test_rotations_have_few_digits_in_every_form(numbers: tuple[float, ...]) -> None:
    vector = np.array(numbers)
    norm = float(np.linalg.norm(vector))
    if norm < 0.1:
        return
    w, x, y, z = (float(v) for v in vector / norm)
    matrix = Pose(quaternion=(w, x, y, z)).matrix()
    for form in Orientation:
        for in_si in (False, True):
            rounded = Rounding(in_si, form).quaternion((w, x, y, z))
            assert Pose(quaternion=rounded).matrix() == pytest.approx(matrix, abs=4e-6)
    again = MM.quaternion((w, x, y, z))
    assert all(v == round(v, 8) for v in again)


@pytest.mark.parametrize(("vendor", "in_si"), [("abb", False), ("kuka", False), ("ur", True)])
def test_languages_say_how(vendor: str, in_si: bool) -> None:
    assert Rounding.of(find_vendor(vendor).speaks).in_si is in_si
    assert Rounding.of(None) == Rounding()


@given(value=st.floats(-3.0, 3.0))
def test_no_more_decimals_are_written_than_controllers_keep(value: float) -> None:
    rounding = Rounding(decimals=(1, 2))
    degrees = math.degrees(rounding.angle(value))
    assert degrees == pytest.approx(round(degrees, 2), abs=1e-9)
    assert abs(degrees - math.degrees(value)) <= 0.005 + 1e-9
    free = np.full(3, np.inf)
    (x, *_) = rounding.position((value, 0.0, 0.0), -free, free)
    assert 1000 * x == pytest.approx(round(1000 * x, 1), abs=1e-9)
