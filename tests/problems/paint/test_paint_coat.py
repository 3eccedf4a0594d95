"""Figures of a coat."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from flyby.core.errors import InputError
from flyby.problems.paint.coating.coat import Coat, coat

from .paint_cases import TARGET, plate_case

numbers = st.lists(st.tuples(st.floats(1e-6, 1e-4), st.floats(0.01, 1.0)), min_size=1, max_size=30)


@given(numbers, st.integers(2, 5))
def test_a_point_of_twice_the_area_is_two_points(points, times):
    thickness, areas = map(np.array, zip(*points, strict=True))
    whole = Coat(thickness, areas * times, TARGET, 1.0, 1.0).by_area
    parts = Coat(np.repeat(thickness, times), np.repeat(areas, times), TARGET, 1.0, 1.0).by_area
    for name in ("mean", "std", "least", "most", "within_10_percent", "within_5_percent"):
        assert getattr(whole, name) == pytest.approx(getattr(parts, name), abs=1e-15)


@given(numbers)
def test_areas_count_by_area_only(points):
    thickness, areas = map(np.array, zip(*points, strict=True))
    found = Coat(thickness, areas, TARGET, 1.0, 1.0)
    assert found.by_point.mean == pytest.approx(thickness.mean())
    assert found.by_point.std == pytest.approx(thickness.std(), abs=1e-15)
    assert found.by_area.mean == pytest.approx(np.average(thickness, weights=areas))
    assert found.deposited == pytest.approx(areas.sum() * found.by_area.mean)
    spread = found.by_area
    error = areas.sum() * (spread.std**2 + (spread.mean - TARGET) ** 2)
    assert found.squared_error == pytest.approx(error, rel=1e-6, abs=1e-24)


def test_limits_of_tolerance_are_within_it():
    thickness = TARGET * np.array((0.9, 0.95, 1.0, 1.05, 1.1, 1.2))
    spread = Coat(thickness, np.ones(6), TARGET, 1.0, 1.0).by_point
    assert spread.within_10_percent == pytest.approx(5 / 6)
    assert spread.within_5_percent == pytest.approx(3 / 6)


def test_paint_is_where_it_is_counted():
    deposition, trajectory = plate_case(0.25, 31)
    found = coat(deposition, trajectory, TARGET)
    assert found.paint == pytest.approx(deposition.footprint.rate * trajectory.total_duration)
    assert 0.5 < found.transfer_efficiency < 0.8
    assert found.by_area.mean == pytest.approx(TARGET)


def test_a_target_is_above_zero():
    with pytest.raises(InputError, match="target"):
        Coat(np.ones(1), np.ones(1), 0.0, 1.0, 1.0)
