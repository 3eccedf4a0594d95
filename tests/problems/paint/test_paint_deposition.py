"""The deposition: paint is conserved, the coat is linear where it claims to be, derivatives are
those of the values, and frames do not matter."""

from __future__ import annotations

from dataclasses import replace
from itertools import pairwise

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.integrate import quad

from flyby.core.errors import InputError
from flyby.core.spatial.pose import Pose
from flyby.problems.paint.coating.deposition import Deposition
from flyby.problems.paint.spray.footprint import ring
from flyby.problems.paint.spray.trajectory import PaintTrajectory
from flyby.problems.paint.surface.samples import SurfaceSamples

from .paint_cases import bumpy, fan_footprint, plate, sweeps, wandering

SEEDS = st.integers(0, 10_000)
FEW = settings(max_examples=15)


def depositions(seed: int) -> tuple[Deposition, PaintTrajectory]:
    """A symmetric one for even seeds, a fan for odd ones."""
    elliptic = bool(seed % 2)
    footprint = fan_footprint() if elliptic else ring(0.2).scaled(1e-4)
    return Deposition(bumpy(15, seed), footprint, 3), wandering(5, seed, elliptic)


# ------------------------------------------------------------------------------- conservation


def still(nozzle: np.ndarray, fan: np.ndarray | None) -> PaintTrajectory:
    """A gun that stands at (0, 0, 0.25) for a second."""
    both = None if fan is None else np.tile(fan, (2, 1))
    return PaintTrajectory(
        np.tile((0.0, 0.0, 0.25), (2, 1)), np.tile(nozzle, (2, 1)), np.ones(1), np.ones(1), both
    )


@pytest.mark.parametrize("aspect", [1.0, 2.5])
@pytest.mark.parametrize("tilt", [0.0, 20.0, 45.0])
def test_a_plane_that_meets_the_whole_cone_gets_all_the_paint(tilt, aspect):
    """∫ B over the plane by adaptive quadrature, in polar coordinates round the axis's foot: along
    a ray from there the rim is crossed once, where the integrand ends."""
    footprint = fan_footprint(aspect)
    angle = np.radians(tilt)
    nozzle = np.array((np.sin(angle), 0.0, -np.cos(angle)))
    gun = still(nozzle, np.array((0.3, 0.9, 0.1)) / np.linalg.norm((0.3, 0.9, 0.1)))
    source = gun.position[0] - footprint.source_distance * nozzle
    foot = source + nozzle * (-source[2] / nozzle[2])

    def coat(radii: np.ndarray, phi: float) -> np.ndarray:
        points = foot + radii[:, None] * np.array((np.cos(phi), np.sin(phi), 0.0))
        up = np.tile((0.0, 0.0, 1.0), (len(radii), 1))
        return Deposition(SurfaceSamples(points, up, np.ones(len(radii))), footprint, 1).thickness(
            gun
        )

    def knots_along(phi: float) -> np.ndarray:
        """Distances at which the ray crosses the footprint's knots, by bisection of the radius."""
        direction = np.array((np.cos(phi), np.sin(phi), 0.0))
        fan = gun.fan[0] - (gun.fan[0] @ nozzle) * nozzle
        fan /= np.linalg.norm(fan)

        def radius(t: float) -> float:
            v = foot + t * direction - source
            s = v @ nozzle
            if s <= 1e-6:
                return np.inf
            x = v @ fan / s
            y2 = max(0.0, v @ v / s**2 - 1 - x**2)
            return footprint.reach * np.sqrt(x**2 + aspect**2 * y2)

        found = []
        for knot in footprint.knots[1:]:
            low, high = 0.0, 50.0
            for _ in range(80):
                middle = 0.5 * (low + high)
                low, high = (middle, high) if radius(middle) < knot else (low, middle)
            found.append(low)
        return np.array([0.0, *found])

    nodes, weights = np.polynomial.legendre.leggauss(40)

    def along_ray(phi: float) -> float:
        ends = knots_along(phi)
        total = 0.0
        for a, b in pairwise(ends):
            t = 0.5 * (a + b) + 0.5 * (b - a) * nodes
            total += 0.5 * (b - a) * float(weights @ (t * coat(t, phi)))
        return total

    volume = quad(along_ray, 0.0, 2 * np.pi, epsrel=1e-9, epsabs=1e-16, limit=200)[0]
    assert volume == pytest.approx(footprint.rate, rel=1e-7)


def test_the_footprint_arrives_as_it_is():
    footprint = ring(0.25)
    r = np.linspace(0.0, 0.3, 61)
    points = np.column_stack((r, np.zeros((61, 2))))
    samples = SurfaceSamples(points, np.tile((0.0, 0.0, 1.0), (61, 1)), np.ones(61))
    found = Deposition(samples, footprint, 2).thickness(still(np.array((0.0, 0.0, -1.0)), None))
    assert np.allclose(found, footprint(r), atol=1e-12)


def test_a_fan_is_long_along_its_axis():
    footprint = fan_footprint(2.0)
    r = np.linspace(0.0, 0.25, 51)
    zero = np.zeros(51)
    up = np.tile((0.0, 0.0, 1.0), (51, 1))
    gun = still(np.array((0.0, 0.0, -1.0)), np.array((0.0, 1.0, 0.0)))
    for points, scale in (((zero, r, zero), 1.0), ((r, zero, zero), 2.0)):
        samples = SurfaceSamples(np.column_stack(points), up, np.ones(51))
        found = Deposition(samples, footprint, 1).thickness(gun)
        assert np.allclose(found, footprint(scale * r), atol=1e-16)


def test_nothing_arrives_behind_the_gun_or_on_the_back():
    points = np.array([[0.0, 0.0, 0.0], [0.0, 0.0, 0.6], [0.0, 0.0, 0.0]])
    normals = np.array([[0.0, 0.0, 1.0], [0.0, 0.0, -1.0], [0.0, 0.0, -1.0]])
    found = Deposition(SurfaceSamples(points, normals, np.ones(3)), ring(0.25)).thickness(
        still(np.array((0.0, 0.0, -1.0)), None)
    )
    assert found[0] > 0.0
    assert not found[1:].any()


# ---------------------------------------------------------------------------------- linearity


@FEW
@given(SEEDS)
def test_the_matrix_times_durations_is_the_coat(seed):
    deposition, trajectory = depositions(seed)
    coat = deposition.thickness(trajectory)
    assert np.allclose(deposition.rates(trajectory) @ trajectory.duration, coat, rtol=1e-12)
    rng = np.random.default_rng(seed)
    other = rng.uniform(0.1, 2.0, trajectory.segments)
    both = deposition.thickness(trajectory.with_durations(trajectory.duration + 3.0 * other))
    second = deposition.thickness(trajectory.with_durations(other))
    assert np.allclose(both, coat + 3.0 * second, rtol=1e-12)


@FEW
@given(SEEDS, st.floats(0.2, 5.0))
def test_flow_and_duration_count_alike(seed, factor):
    deposition, trajectory = depositions(seed)
    more = trajectory.with_flow(trajectory.flow * factor)
    longer = trajectory.with_durations(trajectory.duration * factor)
    assert np.allclose(deposition.thickness(more), deposition.thickness(longer), rtol=1e-12)


def test_segments_without_flow_lay_nothing():
    deposition, trajectory = depositions(4)
    flow = trajectory.flow.copy()
    flow[1] = 0.0
    without = deposition.thickness(trajectory.with_flow(flow))
    rates = deposition.rates(trajectory)
    kept = trajectory.duration.copy()
    kept[1] = 0.0
    assert np.allclose(without, rates @ kept, rtol=1e-12)
    assert deposition.rates(trajectory.with_flow(flow))[:, [1]].nnz == 0


@FEW
@given(SEEDS)
def test_a_mask_hides_points_from_segments(seed):
    deposition, trajectory = depositions(seed)
    rng = np.random.default_rng(seed)
    seen = rng.random((deposition.samples.size, trajectory.segments)) < 0.7
    hidden = deposition.with_visible(seen)
    expected = deposition.rates(trajectory).multiply(seen) @ trajectory.duration
    assert np.allclose(hidden.thickness(trajectory), expected, rtol=1e-12)
    assert np.allclose(hidden.rates(trajectory) @ trajectory.duration, expected, rtol=1e-12)


# --------------------------------------------------------------------------------- invariance


@FEW
@given(SEEDS)
def test_frames_do_not_matter(seed):
    deposition, trajectory = depositions(seed)
    rng = np.random.default_rng(seed + 1)
    turn = rng.normal(size=4)
    pose = Pose(tuple(rng.normal(size=3)), tuple(turn / np.linalg.norm(turn)))
    matrix = pose.matrix()
    samples = deposition.samples
    normals = samples.normals @ matrix[:3, :3].T
    moved = SurfaceSamples(
        samples.points @ matrix[:3, :3].T + matrix[:3, 3],
        normals / np.linalg.norm(normals, axis=1, keepdims=True),
        samples.areas,
    )
    found = Deposition(moved, deposition.footprint, 3).thickness(trajectory.moved(pose))
    before = deposition.thickness(trajectory)
    assert np.allclose(found, before, rtol=1e-7, atol=1e-9 * before.max())


@FEW
@given(SEEDS, st.floats(0.1, 4.0))
def test_sizes_scale(seed, factor):
    """All lengths of the scene and of the footprint times a factor: the same growth everywhere."""
    deposition, trajectory = depositions(seed)
    samples, footprint = deposition.samples, deposition.footprint
    larger = replace(
        footprint,
        knots=footprint.knots * factor,
        slopes=footprint.slopes / factor,
        reference_distance=footprint.reference_distance * factor,
        source_distance=footprint.source_distance * factor,
    )
    scene = SurfaceSamples(samples.points * factor, samples.normals, samples.areas * factor**2)
    motion = replace(trajectory, position=trajectory.position * factor)
    found = Deposition(scene, larger, 3).thickness(motion)
    before = deposition.thickness(trajectory)
    assert np.allclose(found, before, rtol=1e-9, atol=1e-12 * before.max())


@FEW
@given(SEEDS)
def test_direction_of_travel_does_not_matter(seed):
    deposition, trajectory = depositions(seed)
    back = replace(
        trajectory,
        position=trajectory.position[::-1],
        nozzle=trajectory.nozzle[::-1],
        duration=trajectory.duration[::-1],
        flow=trajectory.flow[::-1],
        fan=None if trajectory.fan is None else trajectory.fan[::-1],
    )
    found = deposition.thickness(back)
    assert np.allclose(found, deposition.thickness(trajectory), rtol=1e-11)


@FEW
@given(SEEDS)
def test_points_do_not_know_each_other(seed):
    """The groups that pass over what no cone reaches pass over nothing else."""
    deposition, trajectory = depositions(seed)
    samples = deposition.samples
    whole = deposition.thickness(trajectory)
    some = np.random.default_rng(seed).permutation(samples.size)[:40]
    part = SurfaceSamples(samples.points[some], samples.normals[some], samples.areas[some])
    found = Deposition(part, deposition.footprint, 3).thickness(trajectory)
    assert np.allclose(found, whole[some], rtol=1e-13)


def test_subpoints_converge():
    trajectory, samples = sweeps(), plate(21)
    exact = Deposition(samples, ring(0.25), 64).thickness(trajectory)
    errors = [
        np.abs(Deposition(samples, ring(0.25), k).thickness(trajectory) - exact).max()
        / exact.mean()
        for k in (2, 4, 8)
    ]
    assert errors[0] > errors[1] > errors[2]
    assert errors[1] < 2.5e-3


# -------------------------------------------------------------------------------- derivatives


@FEW
@given(SEEDS)
def test_gradient_against_differences(seed):
    deposition, trajectory = depositions(seed)
    rng = np.random.default_rng(seed)
    adjoint = rng.normal(size=deposition.samples.size)
    found = deposition.gradient(trajectory, adjoint)
    step = 1e-6
    shift, turn = rng.normal(size=(2, *trajectory.position.shape))
    turn -= np.einsum("ij,ij->i", turn, trajectory.nozzle)[:, None] * trajectory.nozzle
    longer, more = rng.normal(size=(2, trajectory.segments))

    def value(h: float) -> float:
        nozzle = trajectory.nozzle + h * turn
        nozzle /= np.linalg.norm(nozzle, axis=1, keepdims=True)
        moved = replace(
            trajectory,
            position=trajectory.position + h * shift,
            nozzle=nozzle,
            duration=trajectory.duration + h * longer,
            flow=trajectory.flow + h * more,
        )
        return float(adjoint @ deposition.thickness(moved))

    expected = (value(step) - value(-step)) / (2 * step)
    slope = (
        (found.position * shift).sum()
        + (found.nozzle * turn).sum()
        + found.duration @ longer
        + found.flow @ more
    )
    size = np.abs(found.position).sum() + np.abs(found.nozzle).sum()
    assert slope == pytest.approx(expected, rel=1e-5, abs=1e-6 * size)


@FEW
@given(SEEDS)
def test_the_normal_matrix_is_of_the_gradients(seed):
    deposition, trajectory = depositions(seed)
    rng = np.random.default_rng(seed)
    size = deposition.samples.size
    turns = rng.normal(size=(len(trajectory.position), 2, 3))
    weights = np.where(rng.random(size) < 0.1, rng.random(size), 0.0)
    rows = []
    for k in np.flatnonzero(weights):
        found = deposition.gradient(trajectory, np.eye(size)[k])
        angles = np.einsum("ijk,ik->ij", turns, found.nozzle)
        waypoints = np.concatenate((found.position, angles), axis=1)
        rows.append(np.sqrt(weights[k]) * np.append(waypoints, found.duration))
    expected = np.transpose(rows) @ np.array(rows)
    total = deposition.normal_matrix(trajectory, turns, weights)
    assert np.allclose(total, expected, rtol=1e-9, atol=1e-12 * np.abs(expected).max())


def test_gradient_at_the_centre_of_the_footprint():
    """Straight under the gun r = 0: f′(r)/r has to have its limit there."""
    samples = SurfaceSamples(np.zeros((1, 3)), np.array([[0.0, 0.0, 1.0]]), np.ones(1))
    gun = still(np.array((0.0, 0.0, -1.0)), None)
    found = Deposition(samples, ring(0.25), 1).gradient(gun, np.ones(1))
    assert np.isfinite(found.position).all()
    assert np.allclose(found.position[:, :2], 0.0)
    assert np.allclose(found.position[:, 2].sum(), -2 * 0.1 / ring(0.25).reach)


# ----------------------------------------------------------------------------------- refusals


def test_refusals():
    samples = plate(3)
    with pytest.raises(InputError, match="subpoints"):
        Deposition(samples, ring(0.25), 0)
    with pytest.raises(InputError, match="visible"):
        Deposition(samples, ring(0.25), visible=np.ones((2, 2), dtype=bool))
    with pytest.raises(InputError, match="segments"):
        Deposition(samples, ring(0.25), visible=np.ones((9, 2), dtype=bool)).thickness(
            wandering(5, 0)
        )
    with pytest.raises(InputError, match="fan"):
        Deposition(samples, fan_footprint()).thickness(wandering(5, 0))
    with pytest.raises(InputError, match="millimetres"):
        SurfaceSamples(samples.points * 1000.0, samples.normals, samples.areas)
    with pytest.raises(InputError, match="unit length"):
        SurfaceSamples(samples.points, samples.normals * 2.0, samples.areas)
    with pytest.raises(InputError, match="areas"):
        SurfaceSamples(samples.points, samples.normals, -samples.areas)
    with pytest.raises(InputError, match="normals"):
        SurfaceSamples(samples.points, samples.normals[:4], samples.areas)
