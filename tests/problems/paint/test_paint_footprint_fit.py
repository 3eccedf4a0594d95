"""Fitting footprints: strokes of a known footprint give it back, noise and all."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from flyby.core.errors import InputError
from flyby.problems.paint.coating.deposition import Deposition
from flyby.problems.paint.spray.footprint import Footprint, ring
from flyby.problems.paint.spray.footprint_fit import fit_footprint
from flyby.problems.paint.spray.strokes import Stroke, section
from flyby.problems.paint.spray.trajectory import PaintTrajectory
from flyby.problems.paint.surface.samples import SurfaceSamples

from .paint_cases import fan_footprint

CONE = {"reference_distance": 0.25, "far_radius": 0.25, "near_radius": 0.035}


def measured(footprint: Footprint, distance: float, offset: float, noise: float) -> Stroke:
    across = np.linspace(-0.36, 0.36, 73)
    rng = np.random.default_rng(int(1000 * distance))
    found = section(footprint, across, distance, 0.3)
    found = np.maximum(found + noise * found.max() * rng.normal(size=len(across)), 0.0)
    return Stroke(across + offset, found, distance, 0.3)


@settings(max_examples=10)
@given(st.floats(0.0, 1.0), st.floats(0.3, 0.8), st.floats(-0.1, 0.1))
def test_clean_strokes_give_the_footprint_back(centre, peak_at, offset):
    """With a fixed weight of smoothness peaks were flattened by 9 %."""
    true = ring(0.25, centre=centre, peak_at=peak_at).scaled(3e-5)
    strokes = [measured(true, h, offset, 0.0) for h in (0.2, 0.25, 0.3)]
    fit = fit_footprint(strokes, **CONE)
    r = np.linspace(0.0, 0.25, 101)
    assert np.abs(fit.footprint(r) - true(r)).max() < 0.012 * 3e-5
    assert fit.footprint.rate == pytest.approx(true.rate, rel=1e-3)
    assert fit.rms < 1e-3 * strokes[0].thickness.max()
    assert not fit.warnings


@settings(max_examples=10)
@given(st.integers(0, 99), st.sampled_from((21, 41, 73)))
def test_noise_is_not_followed(seed, places):
    rng = np.random.default_rng(seed)
    true = ring(0.25, centre=rng.uniform(), peak_at=rng.uniform(0.3, 0.8)).scaled(3e-5)
    across = np.linspace(-0.36, 0.36, places)
    strokes = []
    for distance in (0.2, 0.3):
        clean = section(true, across, distance, 0.3)
        noisy = clean + 0.02 * clean.max() * rng.normal(size=places)
        strokes.append(Stroke(across, np.maximum(noisy, 0.0), distance, 0.3))
    fit = fit_footprint(strokes, **CONE)
    r = np.linspace(0.0, 0.25, 101)
    assert np.sqrt(np.mean((fit.footprint(r) - true(r)) ** 2)) < 0.1 * 3e-5


def test_noise_is_left_in_the_residuals():
    true = ring(0.25).scaled(3e-5)
    strokes = [measured(true, h, 0.02, 0.02) for h in (0.2, 0.3)]
    fit = fit_footprint(strokes, **CONE)
    r = np.linspace(0.0, 0.25, 101)
    assert np.sqrt(np.mean((fit.footprint(r) - true(r)) ** 2)) < 0.08 * 3e-5
    noise = 0.02 * np.mean([s.thickness.max() for s in strokes])
    assert 0.3 * noise < fit.rms < 1.5 * noise
    assert fit.rms <= fit.largest == max(np.abs(res).max() for res in fit.residuals)


@settings(max_examples=8)
@given(st.floats(0.18, 0.35))
def test_sections_are_those_of_the_deposition(distance):
    footprint = fan_footprint(1.0)
    y = np.linspace(-0.3, 0.3, 41)
    plate = SurfaceSamples(
        np.column_stack((np.zeros((41, 1)), y, np.zeros(41))),
        np.tile((0.0, 0.0, 1.0), (41, 1)),
        np.ones(41),
    )
    ends = np.array([[-1.0, 0.0, distance], [1.0, 0.0, distance]])
    stroke = PaintTrajectory.at_speed(ends, np.tile((0.0, 0.0, -1.0), (2, 1)), 0.4, 1.3)
    expected = Deposition(plate, footprint, 2000).thickness(stroke)
    found = section(footprint, y, distance, 0.4, 1.3)
    assert np.allclose(found, expected, rtol=1e-4, atol=1e-5 * expected.max())


def test_warnings_name_what_is_odd():
    true = ring(0.25).scaled(3e-5)
    good = measured(true, 0.25, 0.0, 0.0)
    lopsided = Stroke(
        good.across, good.thickness * (1.0 + 2.0 * np.clip(good.across, -0.4, 0.4)), 0.25, 0.3
    )
    assert any("sides differ" in w for w in fit_footprint([lopsided], **CONE).warnings)
    hurried = Stroke(good.across, good.thickness, 0.25, 0.4)
    assert any("hold between" in w for w in fit_footprint([good, hurried], **CONE).warnings)
    narrow = fit_footprint([good], 0.25, 0.18, 0.035)
    assert any("beyond the rim" in w for w in narrow.warnings)


@pytest.mark.parametrize(
    ("changes", "message"),
    [
        ({"across": (0.0, 1.0)}, "four places"),
        ({"across": (0.0, 0.1, 0.1, 0.2)}, "rise"),
        ({"thickness": (0.0, 0.0, 0.0, 0.0)}, "without paint"),
        ({"thickness": (0.0, 30.0, 30.0, 0.0)}, "µm"),
        ({"thickness": (0.0, np.nan, 1e-5, 0.0)}, "finite"),
        ({"speed": 0.0}, "speed"),
        ({"distance": -1.0}, "distance"),
    ],
)
def test_strokes_refuse(changes, message):
    good = {
        "across": (0.0, 0.1, 0.2, 0.3),
        "thickness": (0.0, 1e-5, 1e-5, 0.0),
        "distance": 0.25,
        "speed": 0.3,
    }
    with pytest.raises(InputError, match=message):
        Stroke(**{**good, **changes})


def test_fits_refuse():
    stroke = measured(ring(0.25).scaled(3e-5), 0.25, 0.0, 0.0)
    with pytest.raises(InputError, match="at least one"):
        fit_footprint([], **CONE)
    with pytest.raises(InputError, match="pieces"):
        fit_footprint([stroke], **CONE, pieces=2)
    with pytest.raises(InputError, match="symmetric"):
        section(fan_footprint(2.0), np.zeros(1), 0.25, 0.3)
