"""First curves: their shape on surfaces of known form, and what they must keep everywhere."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from flyby.core.errors import InputError
from flyby.core.spatial.pose import Pose
from flyby.core.spatial.rotation import matrix_from_rotation_vector
from flyby.problems.paint.coating.deposition import Deposition
from flyby.problems.paint.initial.curve import InitialCurve, initial_curve
from flyby.problems.paint.initial.plan import Coats, Gun, Method, SweepPlan
from flyby.problems.paint.initial.spacing import predicted_ripple, spacings
from flyby.problems.paint.spray.footprint import ring
from flyby.problems.paint.spray.trajectory import PaintTrajectory
from flyby.problems.paint.surface.part import Part
from flyby.validation.surfaces.fender import ARCH_RADIUS, fender
from flyby.validation.surfaces.sheets import grid_faces, plate, saddle, sloped, wavy

X = (1.0, 0.0, 0.0)
DOWN = (0.0, 0.0, -1.0)


def cylinder(radius: float, angle: float, across: int = 41) -> Part:
    """A metre of a cylinder along x that bends down by ± angle (rad)."""
    u, v = np.meshgrid(np.linspace(-0.5, 0.5, across), np.linspace(-angle, angle, across))
    points = np.stack([u, radius * np.sin(v), radius * (np.cos(v) - 1.0)], axis=-1)
    return Part.of_triangles(points.reshape(-1, 3), grid_faces(across, across)[:, ::-1])


def keeps_its_promises(curve: InitialCurve, plan: SweepPlan) -> None:
    """What holds for every first curve."""
    made = curve.trajectory
    away = made.position - curve.base
    assert np.linalg.norm(away, axis=1) == pytest.approx(
        np.full(len(away), plan.distance), abs=1e-9
    )
    assert away == pytest.approx(-plan.distance * made.nozzle, abs=1e-9)
    assert np.linalg.norm(made.nozzle, axis=1) == pytest.approx(np.ones(len(away)), abs=1e-9)
    for sweep in curve.sweeps:
        assert sweep.lengths.max() <= plan.longest_segment * (1 + 1e-5)
        assert np.einsum("ij,ij->i", *sweep.frames[1:]) == pytest.approx(
            np.zeros(len(sweep.feasible)), abs=1e-9
        )
    steps = np.linalg.norm(np.diff(curve.base, axis=0), axis=1)
    assert steps.max() <= plan.longest_segment * (1 + 1e-5)
    assert made.speeds[made.duration > 1.001e-3] == pytest.approx(plan.speed)


@pytest.mark.parametrize("method", list(Method))
def test_the_plate_gets_the_sweeps_of_the_paper(method: Method) -> None:
    """Six sweeps at 180 mm, 100 mm over the edges: 82 segments of 100 and 90 mm."""
    plan = SweepPlan(0.18, method=method)
    curve = initial_curve(plate(21), plan)
    keeps_its_promises(curve, plan)
    assert curve.trajectory.segments == 82
    lines = [np.linspace(-0.6, 0.6, 13)[:: 1 if k % 2 == 0 else -1] for k in range(6)]
    heights = 0.18 * (np.arange(6) - 2.5)
    if curve.base[0, 1] > 0.0:
        heights = -heights
    if curve.base[0, 0] > 0.0:
        lines = [-line for line in lines]
    for k, (line, y) in enumerate(zip(lines, heights, strict=True)):
        at = curve.base[curve.sweep == k]
        expected = np.stack([line, np.full(13, y), np.zeros(13)], axis=1)
        assert at == pytest.approx(expected, abs=1e-4)
    assert curve.trajectory.nozzle == pytest.approx(np.tile(DOWN, (83, 1)), abs=1e-12)
    assert curve.trajectory.painting.all()
    assert not curve.notes


SURFACES = {
    "saddle": lambda: saddle(0.5, 31),
    "wavy": lambda: wavy(0.03, across=31),
    "sloped": lambda: sloped(31),
    "fender": lambda: fender(0.015),
}


@pytest.mark.parametrize("method", list(Method))
@pytest.mark.parametrize("name", SURFACES)
def test_curves_keep_their_promises_on_every_surface(name: str, method: Method) -> None:
    plan = SweepPlan(0.18, method=method)
    keeps_its_promises(initial_curve(SURFACES[name](), plan), plan)


@given(radius=st.floats(0.35, 2.0), width=st.floats(0.08, 0.25), seed=st.integers(0, 99))
@settings(max_examples=6)
def test_sideways_sweeps_are_a_sweep_width_apart_on_the_surface(
    radius: float, width: float, seed: int
) -> None:
    """On a cylinder, along its axis: there the distance on the surface is known."""
    angle = min(0.5 / radius, 1.1)
    plan = SweepPlan(width, heading=X, view=DOWN, longest_segment=0.15)
    curve = initial_curve(cylinder(radius, angle), plan)
    turn = [
        np.arctan2(sweep.frames.point[:, 1], sweep.frames.point[:, 2] + radius)
        for sweep in curve.sweeps
    ]
    places = np.array([radius * np.median(each) for each in turn])
    gaps = np.abs(np.diff(places))
    assert gaps == pytest.approx(np.full(len(gaps), width), rel=0.01)
    left, right = places.min() + radius * angle, radius * angle - places.max()
    assert max(left, right) <= 0.5 * width + 0.02 * width
    assert left == pytest.approx(right, abs=0.02 * width)
    assert spacings([s if k % 2 == 0 else s.reversed() for k, s in enumerate(curve.sweeps)]) == (
        pytest.approx(width, rel=0.03)
    )


@given(seed=st.integers(0, 999), method=st.sampled_from(Method))
@settings(max_examples=6)
def test_a_moved_part_gets_the_moved_curve(seed: int, method: Method) -> None:
    rng = np.random.default_rng(seed)
    matrix = np.eye(4)
    matrix[:3, :3] = matrix_from_rotation_vector(rng.uniform(-2.0, 2.0, 3))
    matrix[:3, 3] = rng.uniform(-3.0, 3.0, 3)
    pose = Pose.from_matrix(matrix)
    part = saddle(0.9, 21)
    plan = SweepPlan(0.2, heading=(1.0, 0.2, 0.0), view=(0.1, 0.0, -1.0), method=method)
    here = initial_curve(part, plan).trajectory.moved(pose)
    turn = pose.matrix()[:3, :3]
    view, heading = (
        (float(a), float(b), float(c))
        for a, b, c in (turn @ np.array(plan.view), turn @ np.array(plan.heading))
    )
    there = initial_curve(
        part.moved(pose), SweepPlan(0.2, heading=heading, view=view, method=method)
    ).trajectory
    assert there.position == pytest.approx(here.position, abs=2e-4)
    assert there.nozzle == pytest.approx(here.nozzle, abs=2e-3)


def test_on_the_slope_the_sideways_method_halves_the_unevenness() -> None:
    part, footprint = sloped(41), ring(0.25)
    deviation = {}
    for method in Method:
        plan = SweepPlan(0.18, heading=X, view=DOWN, method=method)
        curve = initial_curve(part, plan, footprint)
        samples = part.samples
        coat = Deposition(samples, footprint).thickness(curve.trajectory)
        coat /= samples.areas @ coat / samples.area
        deviation[method] = math.sqrt(samples.areas @ (coat - 1.0) ** 2 / samples.area)
        drifted = [note for note in curve.notes if "apart on the surface" in note.message]
        assert bool(drifted) == (method is Method.RASTER)
    assert deviation[Method.SIDEWAYS] <= 0.5 * deviation[Method.RASTER]


def test_on_the_fender_sweeps_follow_the_arch_down_to_the_flanges() -> None:
    curve = initial_curve(fender(0.012), SweepPlan(0.18))
    assert len(curve.sweeps) == 4
    for sweep in curve.sweeps:
        inner = sweep.frames.spray[3:-3]
        point = sweep.frames.point[3:-3]
        toward = -(point + np.array([0.0, 0.0, ARCH_RADIUS])) * [1.0, 0.0, 1.0]
        toward /= np.linalg.norm(toward, axis=1, keepdims=True)
        aside = np.degrees(np.arctan2(np.abs(inner[:, 1]), np.einsum("ij,ij->i", inner, toward)))
        assert aside == pytest.approx(np.full(len(aside), aside.mean()), abs=3.0)
        assert min(abs(aside.mean() - tilt) for tilt in (4.3, 80.0)) < 6.0
        assert sweep.feasible.all()
    assert not any("farther than a sweep width" in note.message for note in curve.notes)


def test_the_gun_is_off_in_turns_and_over_gaps_on_request() -> None:
    curve = initial_curve(plate(11), SweepPlan(0.18, turns=Gun.OFF))
    painting = curve.trajectory.painting
    inner = (curve.sweep[1:] >= 0) & (curve.sweep[1:] == curve.sweep[:-1])
    assert (painting == inner).all()
    sheet = plate(41)
    gap = np.abs(sheet.vertices[sheet.faces].mean(axis=1)[:, 0]) < 0.3
    used, index = np.unique(sheet.faces[~gap], return_inverse=True)
    split = Part.of_triangles(sheet.vertices[used], index.reshape(-1, 3))
    plan = SweepPlan(0.18, heading=X, view=DOWN, gaps=Gun.OFF, method=Method.RASTER)
    crossing = initial_curve(split, plan)
    off = ~crossing.trajectory.painting
    middle = 0.5 * (crossing.base[1:] + crossing.base[:-1])[:, 0]
    assert off.any()
    assert (np.abs(middle[off]) < 0.3).all()
    assert crossing.trajectory.painting[np.abs(middle) > 0.25].all()


def test_crossed_coats_are_two_at_right_angles() -> None:
    """And the gun is off on the way from one to the other, which is short."""
    plan = SweepPlan(0.2, heading=X, coats=Coats.CROSSED)
    one = initial_curve(plate(11), replace(plan, coats=Coats.ONE))
    both = initial_curve(plate(11), plan)
    keeps_its_promises(both, plan)
    assert len(both.sweeps) == 2 * len(one.sweeps) == both.sweep.max() + 1
    ways = [
        np.diff(both.base[both.sweep == k], axis=0).sum(axis=0) for k in range(both.sweep.max() + 1)
    ]
    first, second = ways[: len(one.sweeps)], ways[len(one.sweeps) :]
    assert np.abs(np.array(first) @ np.transpose(second)).max() < 1e-6
    way = ~both.trajectory.painting
    assert way.any() and (np.diff(np.flatnonzero(way)) == 1).all()
    assert both.trajectory.lengths[way].sum() < 0.3
    assert len(way) == 2 * one.trajectory.segments + way.sum()


def test_a_fan_is_held_across_the_sweeps() -> None:
    """On every sweep to the same side: the gun is not turned round."""
    footprint = replace(ring(0.25), aspect=2.0)
    plan = SweepPlan(0.2, heading=X)
    assert initial_curve(plate(11), plan, ring(0.25)).trajectory.fan is None
    for part in (plate(11), saddle(1.0, 11)):
        curve = initial_curve(part, plan, footprint)
        fan = curve.trajectory.fan
        assert fan is not None
        assert np.abs(np.einsum("ij,ij->i", fan, curve.trajectory.nozzle)).max() < 1e-9
        assert (np.einsum("ij,ij->i", fan[1:], fan[:-1]) > 0.9).all()
        assert np.abs(fan[:, 1]).min() > 0.8


def test_wide_sweeps_are_warned_of_with_their_ripple() -> None:
    footprint = ring(0.25)
    plain = initial_curve(plate(11), SweepPlan(0.18), footprint)
    assert plain.ripple is not None
    assert plain.ripple.half_range < 0.06
    assert not plain.notes
    wide = initial_curve(plate(11), SweepPlan(0.25), footprint)
    assert wide.ripple is not None
    assert any("between 61 and 141 %" in note.message for note in wide.notes)
    bare = initial_curve(plate(11), SweepPlan(0.55), footprint)
    assert any("bare strips" in note.message for note in bare.notes)
    fan = initial_curve(plate(11), SweepPlan(0.25), replace(footprint, aspect=2.0))
    assert fan.ripple == wide.ripple


@given(st.floats(0.1, 0.3), st.floats(0.2, 0.3), st.sampled_from((1.0, 2.0)))
@settings(max_examples=6)
def test_the_predicted_ripple_is_that_of_long_strokes(
    width: float, distance: float, aspect: float
) -> None:
    """Against the deposition of nine strokes far beyond a small patch in the middle."""
    footprint = replace(ring(0.2), aspect=aspect)
    lines = []
    for k in range(-4, 5):
        x = np.linspace(-0.6, 0.6, 61)[:: 1 if k % 2 else -1]
        lines.append(np.stack([x, np.full(61, k * width), np.full(61, distance)], axis=1))
    position = np.concatenate(lines)
    nozzle = np.tile(DOWN, (len(position), 1))
    flow = np.ones(len(position) - 1)
    flow[60::61] = 0.0
    trajectory = PaintTrajectory.at_speed(position, nozzle, 0.25, flow)
    trajectory = replace(trajectory, fan=np.tile((0.0, 1.0, 0.0), (len(position), 1)))
    patch = plate(31, width)
    coat = Deposition(patch.samples, footprint).thickness(trajectory)
    mean = patch.samples.areas @ coat / patch.samples.area
    ripple = predicted_ripple(footprint, distance, width)
    assert coat.min() / mean == pytest.approx(ripple.least, abs=0.01)
    assert coat.max() / mean == pytest.approx(ripple.most, abs=0.01)


def test_what_lies_round_a_corner_is_told() -> None:
    import trimesh

    from flyby.problems.paint.surface.loading import make_part

    box = trimesh.creation.box((0.8, 0.6, 0.5))
    part = make_part(np.array(box.vertices), np.array(box.faces), view=DOWN)
    curve = initial_curve(part, SweepPlan(0.18, view=DOWN))
    assert any("round a corner" in note.message for note in curve.notes)
    assert curve.trajectory.nozzle == pytest.approx(np.tile(DOWN, (len(curve.base), 1)), abs=1e-9)


def test_a_closed_ball_is_not_run_round_for_ever() -> None:
    import trimesh

    ball = trimesh.creation.icosphere(subdivisions=3, radius=0.3)
    part = Part.of_triangles(np.array(ball.vertices), np.array(ball.faces))
    with pytest.raises(InputError, match="faces all ways"):
        initial_curve(part, SweepPlan(0.1))
    plan = SweepPlan(0.1, view=DOWN)
    curve = initial_curve(part, plan)
    keeps_its_promises(curve, plan)
    assert (curve.trajectory.nozzle @ np.array(DOWN) > math.cos(math.radians(115.0))).all()
    assert len(curve.sweeps) <= 24


def test_millimetres_taken_for_metres_are_refused_before_they_take_for_ever() -> None:
    flat = plate(11)
    with pytest.raises(InputError, match="check the part's units"):
        initial_curve(Part.of_triangles(1000.0 * flat.vertices, flat.faces), SweepPlan(0.18))


@pytest.mark.parametrize(
    ("wrong", "said"),
    [
        ({"sweep_width": 0.0}, "sweep_width is a finite number above zero"),
        ({"sweep_width": 0.1, "overhang": -1.0}, "overhang is a finite number, zero or more"),
        ({"sweep_width": 0.1, "view": (0.0, 0.0, 0.0)}, "view must be a direction"),
    ],
)
def test_plans_check_their_numbers(wrong: dict[str, object], said: str) -> None:
    with pytest.raises(InputError, match=said):
        SweepPlan(**wrong)  # type: ignore[arg-type]


def test_views_and_headings_that_do_not_fit_are_refused() -> None:
    with pytest.raises(InputError, match="along the view"):
        initial_curve(plate(5), SweepPlan(0.18, view=DOWN, heading=(0.0, 0.0, 1.0)))
    with pytest.raises(InputError, match="no extent"):
        initial_curve(plate(5), SweepPlan(0.18, view=X))
    with pytest.raises(InputError, match="no sweep meets"):
        initial_curve(plate(5), SweepPlan(0.18, view=(0.0, 0.0, 1.0)))
