"""The time stamp against linear programs, and the symmetries that any fastest motion has."""

import dataclasses

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.optimize import linprog

from flyby.core.errors import InputError
from flyby.core.motion.timing.stamping import (
    Stamp,
    StampingError,
    StampLimits,
    StandingStillError,
    joint_limits,
    stamp,
)
from flyby.core.motion.timing.stamping_kernels import CEILING, SLOWDOWN

RATES = ("a", "b", "lower", "upper")


def random_limits(
    seed: int, count: int, rows: int, *, curvature: float = 1.0, unbounded: float = 0.2
) -> StampLimits:
    """Rows of any direction; a share ``unbounded`` of the bounds is infinite."""
    rng = np.random.default_rng(seed)
    shape = (count, 2, rows)
    lower, upper = -rng.uniform(0.1, 2.0, shape), rng.uniform(0.1, 2.0, shape)
    lower[rng.random(shape) < unbounded] = -np.inf
    upper[rng.random(shape) < unbounded] = np.inf
    return StampLimits(
        spacing=rng.uniform(0.05, 1.0, count),
        a=rng.normal(size=shape),
        b=curvature * rng.normal(size=shape),
        lower=lower,
        upper=upper,
        ceiling=rng.uniform(0.1, 4.0, count + 1),
    )


def half_planes(limits: StampLimits, first: int) -> tuple[np.ndarray, np.ndarray]:
    """(A, h) with A x[first:] ≤ h: all finite rows of the intervals from ``first`` on."""
    count = len(limits.spacing)
    normals, bounds = [], []
    for k, end, row in np.ndindex(limits.a.shape):
        if k < first:
            continue
        normal = np.zeros(count + 1)
        c = limits.a[k, end, row] / (2.0 * limits.spacing[k])
        normal[k] -= c
        normal[k + 1] += c
        normal[k + end] += limits.b[k, end, row]
        for sign, bound in ((1.0, limits.upper), (-1.0, -limits.lower)):
            if np.isfinite(bound[k, end, row]):
                normals.append(sign * normal[first:])
                bounds.append(bound[k, end, row])
    return np.array(normals).reshape(len(bounds), count + 1 - first), np.array(bounds)


def maximum(
    weights: np.ndarray,
    limits: StampLimits,
    first: int,
    boxes: np.ndarray,
    extra: np.ndarray | float = 0.0,
) -> np.ndarray:
    """The x[first:] that maximises ``weights`` · x within rows, boxes and ``extra`` · x ≤ 0."""
    normals, bounds = half_planes(limits, first)
    normals = np.vstack([normals, np.broadcast_to(extra, (2, len(weights)))])
    bounds = np.append(bounds, [0.0, 0.0])
    exact = {"primal_feasibility_tolerance": 1e-10, "dual_feasibility_tolerance": 1e-10}
    result = linprog(-weights, A_ub=normals, b_ub=bounds, bounds=boxes, options=exact)
    assert result.status == 0, result.message
    return result.x


def row_values(limits: StampLimits, result: Stamp) -> tuple[np.ndarray, np.ndarray]:
    """Value of each row, and the size of its terms."""
    x = np.stack([result.x[:-1], result.x[1:]], axis=1)[..., None]
    u = result.u[:, None, None]
    scale = np.abs(limits.a * x.max(axis=1, keepdims=True)) / limits.spacing[:, None, None]
    return limits.a * u + limits.b * x, scale + np.abs(limits.b * x)


def assert_within_limits(limits: StampLimits, result: Stamp) -> None:
    values, size = row_values(limits, result)
    assert np.all(values <= limits.upper + 1e-12 * size)
    assert np.all(values >= limits.lower - 1e-12 * size)
    assert np.all((result.x >= 0.0) & (result.x <= limits.ceiling))


def joint_path(seed: int, count: int = 60, joints: int = 3) -> StampLimits:
    """A smooth joint path, finely sampled."""
    rng = np.random.default_rng(seed)
    sigma = np.linspace(0.0, 1.0, count + 1)[:, None]
    amplitude, phase = rng.uniform(0.2, 1.0, joints), rng.uniform(0.0, 6.0, joints)
    frequency = rng.uniform(1.0, 5.0, joints)
    rate = amplitude * frequency * np.cos(frequency * sigma + phase)
    bend = -amplitude * frequency**2 * np.sin(frequency * sigma + phase)
    return joint_limits(
        np.diff(sigma[:, 0]),
        np.stack([rate[:-1], rate[1:]], axis=1),
        np.stack([bend[:-1], bend[1:]], axis=1),
        velocity=rng.uniform(0.5, 2.0, joints),
        acceleration_lower=-rng.uniform(1.0, 5.0, joints),
        acceleration_upper=rng.uniform(1.0, 5.0, joints),
    )


def monotone(limits: StampLimits) -> StampLimits:
    """The limits with |b| ≤ |a| / (2Δ): then one x is the greatest at all knots at once."""
    largest = np.abs(limits.a) / (2.0 * limits.spacing[:, None, None])
    return dataclasses.replace(limits, b=np.clip(limits.b, -largest, largest))


@pytest.fixture(scope="module", autouse=True)
def compiled() -> None:
    """The first call compiles, which no single test should be timed for."""
    stamp(joint_path(0))


seeds = st.integers(0, 2**32 - 1)
counts = st.integers(1, 6)
widths = st.integers(1, 5)


counts = st.integers(2, 6)


def interval(limits: StampLimits, k: int) -> StampLimits:
    """The limits of interval k alone."""
    return StampLimits(
        limits.spacing[k : k + 1],
        *(getattr(limits, name)[k : k + 1] for name in RATES),
        limits.ceiling[k : k + 2],
    )


@given(seeds, counts, widths, st.floats(0.0, 3.0))
def test_backward_sweep_finds_the_greatest_sum_of_neighbours(seed, count, rows, curvature):
    limits = random_limits(seed, count, rows, curvature=curvature)
    result = stamp(limits)
    assert result.top[-1] == 0.0
    for k in range(count):
        boxes = np.array([[0.0, limits.ceiling[k]], [0.0, result.top[k + 1]]])
        last = float(k == count - 1)
        change = np.array([[1.0 - last, -1.0 / SLOWDOWN], [-1.0 / SLOWDOWN, 1.0]])
        greatest = maximum(np.ones(2), interval(limits, k), 0, boxes, change)
        assert result.top[k] + result.partner[k] == pytest.approx(sum(greatest), rel=1e-6, abs=1e-6)


@given(seeds, counts, widths)
def test_backward_sweep_finds_the_greatest_controllable_speed(seed, count, rows):
    limits = monotone(random_limits(seed, count, rows))
    result = stamp(limits)
    for k in range(count):
        boxes = np.stack([np.zeros(count + 1 - k), limits.ceiling[k:]], axis=1)
        boxes[-1, 1] = 0.0
        greatest = maximum(np.eye(count + 1 - k)[0], limits, k, boxes)[0]
        assert result.top[k] == pytest.approx(greatest, rel=1e-6, abs=1e-6)


@given(seeds, counts, widths, st.floats(0.0, 3.0))
def test_forward_sweep_takes_the_greatest_next_speed(seed, count, rows, curvature):
    limits = random_limits(seed, count, rows, curvature=curvature)
    result = stamp(limits)
    for k in range(count):
        # HiGHS keeps rows to 1e-7 only; half a step of that back, the set is never empty.
        boxes = np.array([[result.x[k] * (1.0 - 1e-7), result.x[k]], [0.0, result.top[k + 1]]])
        following = maximum(np.array([0.0, 1.0]), interval(limits, k), 0, boxes)[1]
        assert result.x[k + 1] == pytest.approx(following, rel=1e-4, abs=1e-5)


@given(seeds, counts, widths)
def test_greatest_sum_of_squared_speeds_is_the_stamp(seed, count, rows):
    limits = monotone(random_limits(seed, count, rows))
    boxes = np.stack([np.zeros(count + 1), limits.ceiling], axis=1)
    boxes[[0, -1], 1] = 0.0
    greatest = maximum(np.ones(count + 1), limits, 0, boxes)
    np.testing.assert_allclose(stamp(limits).x, greatest, rtol=1e-6, atol=1e-6)


@given(seeds, st.integers(2, 40), st.integers(1, 12), st.floats(0.0, 30.0))
def test_limits_hold_at_both_ends_of_each_interval(seed, count, rows, curvature):
    limits = random_limits(seed, count, rows, curvature=curvature)
    assert_within_limits(limits, stamp(limits))


@given(seeds, st.integers(2, 40), st.integers(1, 6))
def test_limits_hold_with_rows_that_repeat_or_nearly_repeat(seed, count, rows):
    """Straight lines give the same row at both ends; short intervals nearly so."""
    limits = random_limits(seed, count, rows)
    rng = np.random.default_rng(seed)
    copies = {name: getattr(limits, name).copy() for name in RATES}
    for value in copies.values():
        value[:, 1] = value[:, 0]
    copies["b"] *= rng.choice([0.0, 1e-12, 1e-6, 1.0], size=copies["b"].shape)
    copies["a"] *= rng.choice([0.0, 1e-9, 1.0], size=copies["a"].shape)
    limits = dataclasses.replace(limits, **copies)
    assert_within_limits(limits, stamp(limits))


@given(seeds, st.integers(2, 12), widths)
def test_no_ceilings_but_at_the_ends(seed, count, rows):
    limits = random_limits(seed, count, rows, unbounded=0.0)
    limits = dataclasses.replace(limits, ceiling=np.full(count + 1, np.inf))
    result = stamp(limits)
    assert np.all(np.isfinite(result.x))
    assert_within_limits(limits, result)


@given(seeds, st.integers(2, 40), widths)
def test_more_limits_are_never_faster(seed, count, rows):
    limits = monotone(random_limits(seed, count, rows))
    extra = monotone(
        dataclasses.replace(random_limits(seed + 1, count, rows), spacing=limits.spacing)
    )
    both = StampLimits(
        limits.spacing,
        *(np.concatenate([getattr(limits, n), getattr(extra, n)], axis=2) for n in RATES),
        np.minimum(limits.ceiling, extra.ceiling),
    )
    assert np.all(stamp(both).x <= stamp(limits).x * (1.0 + 1e-9))


@given(seeds, st.integers(2, 40), widths)
def test_path_driven_backwards_takes_as_long(seed, count, rows):
    limits = monotone(random_limits(seed, count, rows))
    backwards = StampLimits(
        limits.spacing[::-1],
        -limits.a[::-1, ::-1],
        *(getattr(limits, name)[::-1, ::-1] for name in ("b", "lower", "upper")),
        limits.ceiling[::-1],
    )
    np.testing.assert_allclose(stamp(backwards).x[::-1], stamp(limits).x, rtol=1e-9, atol=1e-12)


@given(seeds)
def test_smooth_joint_path_takes_as_long_backwards(seed):
    limits = joint_path(seed, count=200)
    backwards = StampLimits(
        limits.spacing[::-1],
        -limits.a[::-1, ::-1],
        *(getattr(limits, name)[::-1, ::-1] for name in ("b", "lower", "upper")),
        limits.ceiling[::-1],
    )
    assert stamp(backwards).duration == pytest.approx(stamp(limits).duration, rel=1e-6)


@given(seeds, st.floats(0.1, 10.0))
def test_faster_joints_take_proportionally_less_time(seed, factor):
    limits = monotone(random_limits(seed, 20, 4))
    faster = dataclasses.replace(
        limits,
        lower=limits.lower * factor**2,
        upper=limits.upper * factor**2,
        ceiling=limits.ceiling * factor**2,
    )
    assert stamp(faster).duration * factor == pytest.approx(stamp(limits).duration, rel=1e-9)


@given(seeds, st.floats(-12.0, 12.0))
def test_unit_of_the_path_parameter_does_not_matter(seed, exponent):
    limits, factor = monotone(random_limits(seed, 20, 4)), 10.0**exponent
    rescaled = StampLimits(
        limits.spacing * factor,
        limits.a / factor,
        limits.b / factor**2,
        limits.lower,
        limits.upper,
        limits.ceiling * factor**2,
    )
    np.testing.assert_allclose(stamp(rescaled).t, stamp(limits).t, rtol=1e-9)


@given(seeds, st.floats(0.001, 0.005), st.floats(0.001, 0.005))
def test_boundary_speeds_are_kept(seed, x_start, x_end):
    limits = joint_path(seed)
    result = stamp(limits, x_start, x_end)
    assert result.x[0] == pytest.approx(x_start, rel=1e-9)
    assert result.x[-1] == pytest.approx(x_end, rel=1e-9)
    assert result.duration < stamp(limits).duration


@given(seeds, st.integers(2, 58))
def test_stop_inside_splits_the_path(seed, knot):
    limits = joint_path(seed)
    limits.ceiling[knot] = 0.0
    parts = [
        StampLimits(
            limits.spacing[part],
            *(getattr(limits, name)[part] for name in RATES),
            limits.ceiling[part.start : part.stop + 1],
        )
        for part in (slice(0, knot), slice(knot, 60))
    ]
    expected = sum(stamp(part).duration for part in parts)
    assert stamp(limits).duration == pytest.approx(expected, rel=1e-12)


def straight(count: int, length: float, velocity: float, acceleration: float) -> StampLimits:
    """A single joint that moves by ``length``."""
    return joint_limits(
        np.full(count, 1.0 / count),
        np.full((count, 2, 1), length),
        np.zeros((count, 2, 1)),
        velocity=np.array([velocity]),
        acceleration_lower=np.array([-acceleration]),
        acceleration_upper=np.array([acceleration]),
    )


@given(st.floats(0.1, 10.0), st.floats(0.1, 10.0), st.floats(0.1, 10.0), st.integers(1, 20))
def test_straight_line_is_the_trapezoid(length, velocity, acceleration, half):
    limits = straight(2 * half, length, velocity, acceleration)
    if velocity**2 < acceleration * length:
        # The sampled trapezoid switches at knots: only as fast as the true one, and close.
        exact = length / velocity + velocity / acceleration
        longest = exact + 2.0 * length / velocity / half
        assert exact * (1.0 - 1e-12) <= stamp(limits).duration <= longest
    else:
        exact = 2.0 * np.sqrt(length / acceleration)
        assert stamp(limits).duration == pytest.approx(exact, rel=1e-12)


def test_one_interval_with_boundary_speeds():
    result = stamp(straight(1, 2.0, 1.0, 10.0), x_start=0.25, x_end=0.25)
    assert result.duration == pytest.approx(2.0, rel=1e-12)
    np.testing.assert_array_equal(result.limit, [CEILING])


def test_limit_names_what_holds_the_speed_down():
    result = stamp(straight(10, 1.0, 0.5, 0.5))
    accelerating = result.half_plane(int(result.limit[0]))
    braking = result.half_plane(int(result.limit[-1]))
    assert (accelerating.row, accelerating.upper) == (0, True)
    assert (braking.row, braking.upper) == (0, False)
    assert CEILING in result.limit
    np.testing.assert_array_equal(result.at_ceiling, np.isclose(result.x, 0.25))


def test_standing_still_against_a_limit_is_named():
    limits = straight(4, 1.0, 1.0, 1.0)
    limits.lower[2, 1, 0] = 0.1
    with pytest.raises(StandingStillError, match="row 0 at the right end of interval 2") as caught:
        stamp(limits)
    assert (caught.value.knot, caught.value.row) == (3, 0)


def test_two_stops_without_a_way_between_are_named():
    limits = straight(5, 1.0, 1.0, 1.0)
    limits.ceiling[2:4] = 0.0
    with pytest.raises(StampingError, match="interval 2") as caught:
        stamp(limits)
    assert caught.value.knot == 2


def test_speed_that_nothing_bounds_is_named():
    limits = straight(5, 1.0, 1.0, 1.0)
    limits.ceiling[2] = np.inf
    limits.a[2] = 0.0
    with pytest.raises(StampingError, match="knot 2"):
        stamp(limits)


@pytest.mark.parametrize(("x_start", "x_end", "name"), [(1.0, 0.0, "start"), (0.0, 1.0, "end")])
def test_boundary_speed_out_of_reach_is_refused(x_start, x_end, name):
    limits = straight(5, 1.0, 10.0, 0.1)
    with pytest.raises(StampingError, match=f"at its {name}"):
        stamp(limits, x_start, x_end)


@pytest.mark.parametrize(
    ("name", "value", "message"),
    [
        ("spacing", 0.0, "interval 1 has length 0.0"),
        ("spacing", np.nan, "interval 1"),
        ("ceiling", -1.0, "knot 1"),
        ("ceiling", np.nan, "knot 1"),
        ("a", np.nan, "interval 1 is unusable"),
        ("b", np.inf, "interval 1 is unusable"),
        ("upper", np.nan, "interval 1 is unusable"),
        ("lower", 2.0, "interval 1 is unusable"),
    ],
)
def test_unusable_numbers_are_named(name, value, message):
    limits = straight(4, 1.0, 1.0, 1.0)
    getattr(limits, name)[1] = value
    with pytest.raises(InputError, match=message):
        stamp(limits)


def test_wrong_shapes_are_refused():
    with pytest.raises(InputError, match="spacing"):
        StampLimits(*(np.zeros(0),) * 6)
    sound = straight(4, 1.0, 1.0, 1.0)
    for name in ("a", "b", "lower", "upper", "ceiling"):
        with pytest.raises(InputError, match=f"^{name} has shape"):
            dataclasses.replace(sound, **{name: np.zeros((3, 2))})
