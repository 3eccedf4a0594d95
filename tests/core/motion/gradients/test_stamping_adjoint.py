"""The stamp's derivative against central differences, away from ties."""

import dataclasses

import numpy as np
import pytest
from hypothesis import assume, given
from hypothesis import strategies as st

from flyby.core.errors import InputError
from flyby.core.motion.gradients.stamping_adjoint import StampGradient, stamp_adjoint
from flyby.core.motion.timing.stamping import Stamp, StampingError, StampLimits, stamp

INPUTS = ("spacing", "a", "b", "lower", "upper", "ceiling")
STEP = 1e-5


def random_limits(seed: int, count: int, rows: int, curvature: float) -> StampLimits:
    """Rows of any direction, a part of the bounds infinite, sometimes a stop inside."""
    rng = np.random.default_rng(seed)
    shape = (count, 2, rows)
    lower, upper = -rng.uniform(0.1, 2.0, shape), rng.uniform(0.1, 2.0, shape)
    lower[rng.random(shape) < 0.2] = -np.inf
    upper[rng.random(shape) < 0.2] = np.inf
    ceiling = rng.uniform(0.1, 4.0, count + 1)
    if count > 3 and rng.random() < 0.3:
        ceiling[rng.integers(2, count - 1)] = 0.0
    return StampLimits(
        rng.uniform(0.05, 1.0, count),
        rng.normal(size=shape),
        curvature * rng.normal(size=shape),
        lower,
        upper,
        ceiling,
    )


@pytest.fixture(scope="module", autouse=True)
def compiled() -> None:
    """The first call compiles, which no single test should be timed for."""
    stamp_adjoint(stamp(random_limits(0, 4, 2, 0.5)))


def moved(limits: StampLimits, directions: dict[str, np.ndarray], step: float) -> StampLimits:
    """The limits one step along the directions; infinite bounds stay."""
    with np.errstate(invalid="ignore"):
        return dataclasses.replace(
            limits,
            **{name: getattr(limits, name) + step * d for name, d in directions.items()},
        )


def active(result: Stamp) -> tuple[bytes, ...]:
    """What the derivative holds fixed."""
    return np.sort(result.pair, axis=1).tobytes(), result.source.tobytes()


def difference(functions: list[float], step: float) -> float:
    """Derivative from values at -2, -1, 1, 2 steps, to fourth order."""
    far_left, left, right, far_right = functions
    return (8.0 * (right - left) - (far_right - far_left)) / (12.0 * step)


def stamps_around(
    limits: StampLimits, directions: dict[str, np.ndarray], x_start: float, x_end: float
) -> list[Stamp]:
    """Stamps at -2, -1, 1, 2 steps; rejects the example unless all have the same active set."""
    try:
        centre = stamp(limits, x_start, x_end)
        around = [
            stamp(moved(limits, directions, i * STEP), x_start, x_end) for i in (-2, -1, 1, 2)
        ]
    except StampingError:
        assume(False)
    assume(all(active(one) == active(centre) for one in around))
    # Close to a stop, time goes with the root of x: a step must be small against x.
    assume(np.min(centre.x[centre.x > 0.0]) > 1e-2)
    return [centre, *around]


def inner(gradient: StampGradient, directions: dict[str, np.ndarray]) -> tuple[float, float]:
    """Directional derivative, and the sum of the sizes of its terms."""
    terms = np.concatenate(
        [(getattr(gradient, name) * d).ravel() for name, d in directions.items()]
    )
    return float(terms.sum()), float(np.abs(terms).sum())


seeds = st.integers(0, 2**32 - 1)


@given(seeds, st.integers(2, 12), st.integers(1, 5), st.floats(0.0, 1.0), st.sampled_from(INPUTS))
def test_gradient_is_the_difference_quotient(seed, count, rows, curvature, name):
    rng = np.random.default_rng(seed)
    limits = random_limits(seed, count, rows, curvature)
    # Relative steps keep signs and stops.
    value = np.nan_to_num(getattr(limits, name), posinf=0.0, neginf=0.0)
    directions = {name: value * rng.uniform(-1.0, 1.0, value.shape)}
    centre, *around = stamps_around(limits, directions, 0.0, 0.0)
    x_bar, t_bar = rng.normal(size=(2, count + 1))
    got, size = inner(stamp_adjoint(centre, x_bar, t_bar), directions)
    expected = difference([x_bar @ one.x + t_bar @ one.t for one in around], STEP)
    assert got == pytest.approx(expected, rel=1e-6, abs=1e-6 * size + 1e-9)


@given(seeds, st.integers(1, 8), st.integers(1, 4), st.sampled_from(["x_start", "x_end"]))
def test_gradient_with_respect_to_boundary_speeds(seed, count, rows, name):
    limits = random_limits(seed, count, rows, 0.5)
    boundary = {"x_start": 0.05, "x_end": 0.05}

    def at(step: float) -> Stamp:
        return stamp(limits, **{**boundary, name: boundary[name] + step})

    try:
        centre, *around = (at(i * STEP * 0.05) for i in (0, -2, -1, 1, 2))
    except StampingError:
        assume(False)
    assume(all(active(one) == active(centre) for one in around))
    assume(np.min(centre.x[centre.x > 0.0]) > 1e-2)
    t_bar = np.zeros(count + 1)
    t_bar[-1] = 1.0
    got = getattr(stamp_adjoint(centre, t_bar=t_bar), name)
    expected = difference([one.duration for one in around], STEP * 0.05)
    assert got == pytest.approx(expected, rel=1e-6, abs=1e-7)


@given(seeds, st.integers(2, 30), st.integers(1, 5))
def test_duration_knows_its_own_scaling(seed, count, rows):
    """T(c² limits) = T / c and T(σ → c σ) = T, so both directional derivatives are known."""
    limits = random_limits(seed, count, rows, 0.5)
    result = stamp(limits)
    t_bar = np.zeros(count + 1)
    t_bar[-1] = 1.0
    gradient = stamp_adjoint(result, t_bar=t_bar)
    finite = {name: np.nan_to_num(getattr(limits, name), posinf=0.0, neginf=0.0) for name in INPUTS}
    faster = {name: 2.0 * finite[name] for name in ("lower", "upper", "ceiling")}
    got, size = inner(gradient, faster)
    assert got == pytest.approx(-result.duration, rel=1e-8, abs=1e-10 * size)
    powers = {"spacing": 1.0, "a": -1.0, "b": -2.0, "ceiling": 2.0}
    got, size = inner(gradient, {name: p * finite[name] for name, p in powers.items()})
    assert got == pytest.approx(0.0, abs=1e-10 * size)


def test_seeds_of_the_wrong_shape_are_refused():
    result = stamp(random_limits(0, 4, 2, 0.5))
    with pytest.raises(InputError, match="x_bar"):
        stamp_adjoint(result, x_bar=np.zeros(4))
    with pytest.raises(InputError, match="t_bar"):
        stamp_adjoint(result, t_bar=np.zeros(6))


def test_no_seed_gives_no_gradient():
    gradient = stamp_adjoint(stamp(random_limits(0, 4, 2, 0.5)))
    assert all(not np.any(getattr(gradient, name)) for name in INPUTS)
