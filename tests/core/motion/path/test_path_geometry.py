"""q(σ): smooth across boundaries, its own derivatives, on the programmed path outside zones."""

from __future__ import annotations

from dataclasses import replace
from itertools import pairwise

import numpy as np
import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st

from flyby.core.motion.emulator.controller import Controller
from flyby.core.motion.geometry.corners import POSITION, STOP, TURNING
from flyby.core.motion.model.blend import TANGENT_ARC, Blend
from flyby.core.motion.model.motion_model import MotionModel
from flyby.core.motion.model.rules import OrientationZone, Overlap
from flyby.core.program.arc_orientation import ArcOrientation
from flyby.core.program.move import MoveC, MoveJ, MoveL
from flyby.core.program.program import Program
from flyby.core.program.speed import Speed
from flyby.core.program.tool import Tool
from flyby.core.program.zone import FINE, ContourFraction, Radius
from flyby.core.spatial.pose import Pose
from flyby.core.spatial.rotation import rotation_vector

SPEED = Speed(tcp=0.2, reorientation=3.0)
QUINTIC = Blend(alpha=(0, 0, 0, 10, -15, 6))
MODELS = {
    "parabola": MotionModel(),
    "beta": MotionModel(tcp=Blend(beta=(0.5,)), joint=Blend(beta=(-0.5, 0.3))),
    "quintic": MotionModel(tcp=QUINTIC, joint=QUINTIC, orientation=QUINTIC),
    "arc": MotionModel(tcp=TANGENT_ARC),
    "own zone": MotionModel(orientation_zone=OrientationZone.OWN),
    "shrink": MotionModel(overlap=Overlap.SHRINK),
}
OTHER = Tool("other", Pose((0.02, 0.01, 0.03)))


def zone(arm, share) -> Radius:
    radius = share * arm.leg
    return Radius(radius, 1.5 * radius, 1.5 * radius, 0.3 * share)


def mixed_program(arm, shares) -> Program:
    """Every kind of corner: L-L, L-C, C-C, C-J, J-J, J-L, and a change of tool."""
    z = [zone(arm, share) for share in shares]
    t = arm.target
    moves = (
        MoveL(t((1, 0, 0)), SPEED, z[0]),
        MoveL(t((1, 1, 0), (0, 0.2, 0.1)), SPEED, z[1]),
        MoveC(t((0, 1, 0.4), (0.2, 0.1, 0)), SPEED, z[2], via=t((0.6, 1.4, 0.1))),
        MoveC(t((0, 0, 0), (0, 0, 0)), SPEED, z[3], via=t((-0.3, 0.5, 0.4))),
        MoveJ(arm.joints([0.2, 0.1, -0.1, 0.2, 0.1, 0.3]), SPEED, z[4]),
        MoveJ(t((0, 0.5, 0.5)), SPEED, z[5]),
        MoveL(t((0, 0, 0.8), (0.2, 0, 0)), SPEED, z[0]),
        MoveL(t((0.5, 0, 0.4), (0.2, 0, 0)), SPEED, z[1], OTHER),
        MoveL(t((0.5, 0.5, 0.4)), SPEED, FINE, OTHER),
    )
    return Program(moves, start=arm.start)


def jumps(path):
    """Left and right states at the boundaries between pieces that are no stops."""
    first = path.pieces.first_sample
    inner = np.flatnonzero(~path.pieces.stop[1:-1]) + 1
    return first[inner] - 1, first[inner]


SHARES = st.lists(st.floats(0.05, 0.3), min_size=6, max_size=6)


@pytest.mark.parametrize("name", sorted(MODELS))
@settings(max_examples=4, deadline=None)
@given(shares=SHARES)
def test_the_tangent_is_continuous_wherever_the_robot_does_not_stop(arm, name, shares) -> None:
    path = arm.controller(MODELS[name]).plan(mixed_program(arm, shares))
    assert (path.corners.kind != STOP).all()
    left, right = jumps(path)
    np.testing.assert_allclose(path.states.q[left], path.states.q[right], atol=1e-9)
    scale = np.abs(path.states.dq).max()
    np.testing.assert_allclose(
        path.states.dq[left] / scale, path.states.dq[right] / scale, atol=1e-8
    )


@settings(max_examples=4, deadline=None)
@given(shares=SHARES)
def test_a_second_order_blend_is_continuous_to_second_order_on_joint_lines(arm, shares) -> None:
    moves = tuple(
        MoveJ(arm.joints(change), SPEED, zone(arm, share))
        for change, share in zip(
            ([0.3, 0.1, 0, 0, 0, 0], [0.3, 0.3, 0.1, 0.2, 0, 0], [0, 0.2, 0.2, 0.2, 0.3, 0]),
            shares,
            strict=False,
        )
    )
    path = arm.controller(MODELS["quintic"]).plan(Program(moves, start=arm.start))
    left, right = jumps(path)
    # Geometric: the curvature vector square to the tangent, per length of arc.
    bend = []
    for k in (left, right):
        dq, ddq = path.states.dq[k], path.states.ddq[k]
        unit = dq / np.linalg.norm(dq, axis=1, keepdims=True)
        across = ddq - unit * np.sum(unit * ddq, axis=1, keepdims=True)
        bend.append(across / np.sum(dq * dq, axis=1, keepdims=True))
    np.testing.assert_allclose(bend[0], bend[1], atol=1e-7)


@pytest.mark.parametrize("name", ["parabola", "quintic", "arc", "own zone"])
def test_derivatives_are_those_of_q(arm, name) -> None:
    """Trapezoidal rules between samples of a denser sampling of the same path, spaced anyhow."""
    controller = arm.controller(MODELS[name])
    program = mixed_program(arm, [0.25] * 6)
    controller.sampling = replace(controller.sampling, least=300, blend=300, most=1000, halvings=0)
    path = controller.plan(program)
    first, s = path.pieces.first_sample, path.states
    for begin, end in pairwise(first):
        q, dq, ddq = (array[begin:end] for array in (s.q, s.dq, s.ddq))
        h = np.diff(path.sigma[begin:end])[:, None]
        step = h / 2 * (dq[1:] + dq[:-1]) - h**2 / 12 * np.diff(ddq, axis=0)
        scale = np.abs(dq).max()
        np.testing.assert_allclose(np.diff(q, axis=0) / h / scale, step / h / scale, atol=1e-6)
        turn = np.diff(dq, axis=0) / h
        scale = max(1.0, np.abs(ddq).max())
        mean = 0.5 * (ddq[1:] + ddq[:-1])
        np.testing.assert_allclose(turn / scale, mean / scale, atol=5e-3)


def tcp(arm, q) -> np.ndarray:
    return arm.robot.forward(q)[1]


def distance_to_chain(points, corners) -> np.ndarray:
    """Distances (P,) to a chain of lines."""
    best = np.full(len(points), np.inf)
    for a, b in pairwise(corners):
        share = np.clip((points - a) @ (b - a) / np.sum((b - a) ** 2), 0, 1)
        best = np.minimum(best, np.linalg.norm(points - a - share[:, None] * (b - a), axis=1))
    return best


@pytest.mark.parametrize("name", sorted(MODELS))
@settings(max_examples=5, deadline=None)
@given(shares=st.lists(st.floats(0.02, 0.75), min_size=3, max_size=3))
def test_the_tcp_leaves_the_lines_inside_the_effective_spheres_only(arm, name, shares) -> None:
    offsets = [(0, 0, 0), (1, 0, 0), (1, 1, 0), (0.3, 1, 0.5), (0.3, 0.2, 0.5)]
    moves = tuple(
        MoveL(arm.target(offset), SPEED, zone(arm, share))
        for offset, share in zip(offsets[1:], [*shares, 0.1], strict=True)
    )
    path = arm.controller(MODELS[name]).plan(Program(moves, start=arm.start))
    corners = np.array([arm.pose(offset).position for offset in offsets])
    points = tcp(arm, path.q)
    away = distance_to_chain(points, corners) > 1e-8
    lengths = np.linalg.norm(np.diff(corners, axis=0), axis=1)
    inside = np.zeros(len(points), dtype=bool)
    for i, reach in enumerate(path.corners.reach[:, POSITION]):
        effective = reach * lengths[i : i + 2]
        assert effective[0] == pytest.approx(effective[1])
        assert effective[0] <= shares[i] * arm.leg * (1 + 1e-9)
        inside |= np.linalg.norm(points - corners[i + 1], axis=1) < effective[0] * (1 + 1e-7)
    assert away.any()
    assert inside[away].all()


def test_the_tool_leaves_its_programmed_turn_inside_its_own_zone_only(abb) -> None:
    radius = 0.1 * abb.leg
    middle = (0.0, 0.4, 0.2)
    moves = (
        MoveL(abb.target((1, 0, 0), middle), SPEED, Radius(radius, 3 * radius, 3 * radius, 0.2)),
        MoveL(abb.target((1, 1, 0)), SPEED, FINE),
    )
    path = abb.controller(MODELS["own zone"]).plan(Program(moves, start=abb.start))
    R, p = abb.robot.forward(path.q)
    wp = abb.pose((1, 0, 0), middle).matrix()
    from_corner = np.linalg.norm(p - wp[:3, 3], axis=1)
    start = abb.pose().matrix()[:3, :3]
    full = np.linalg.norm(rotation_vector(start.T @ wp[:3, :3]))
    turned = np.linalg.norm(rotation_vector(wp[:3, :3].T @ R), axis=1)
    programmed = full * from_corner / abb.leg
    outside = from_corner > 3 * radius * (1 + 1e-9)
    np.testing.assert_allclose(turned[outside], programmed[outside], atol=1e-7)
    between = (from_corner > 1.1 * radius) & (from_corner < 2.8 * radius)
    assert np.abs(turned - programmed)[between].min() > 1e-4
    assert path.corners.reach[0, TURNING] == pytest.approx([0.3, 0.3])


@settings(max_examples=10, deadline=None)
@given(deflection=st.floats(0.1, 2.9), share=st.floats(0.05, 0.45))
def test_the_tangent_arc_touches_both_legs_at_the_radius(ur, deflection, share) -> None:
    r = share * ur.leg
    end = (1 + np.cos(deflection), np.sin(deflection), 0)
    moves = (
        MoveL(ur.target((1, 0, 0)), SPEED, Radius(r)),
        MoveL(ur.target(end), SPEED, FINE),
    )
    path = ur.controller(MODELS["arc"]).plan(Program(moves, start=ur.start))
    position = path.tcp.curves.position
    centre, out, along = position.control[2, :3]
    assert position.angle[2] == pytest.approx(deflection)
    assert np.linalg.norm(out) == pytest.approx(r / np.tan(deflection / 2))
    assert np.linalg.norm(along) == pytest.approx(np.linalg.norm(out))
    wp = np.array(ur.pose((1, 0, 0)).position)
    assert np.linalg.norm(centre + out - wp) == pytest.approx(r)
    points = tcp(ur, path.q)
    near = np.linalg.norm(points - wp, axis=1) < r * (1 - 1e-9)
    np.testing.assert_allclose(
        np.linalg.norm(points[near] - centre, axis=1), np.linalg.norm(out), atol=1e-8
    )


@settings(max_examples=10, deadline=None)
@given(deflection=st.floats(0.1, 2.9), beta=st.floats(-1.0, 1.0))
def test_the_apex_of_a_corner(ur, deflection, beta) -> None:
    r = 0.3 * ur.leg
    end = (1 + np.cos(deflection), np.sin(deflection), 0)
    moves = (
        MoveL(ur.target((1, 0, 0)), SPEED, Radius(r)),
        MoveL(ur.target(end), SPEED, FINE),
    )
    model = MotionModel(tcp=Blend(beta=(beta,)))
    path = ur.controller(model).plan(Program(moves, start=ur.start))
    middle = np.flatnonzero(np.isclose(path.sigma, path.layout.waypoint[1], atol=1e-12))
    apex = tcp(ur, path.q[middle]) - ur.pose((1, 0, 0)).position
    expected = 0.5 * r * np.sin(deflection / 2) * (1 + beta / 4)
    np.testing.assert_allclose(np.linalg.norm(apex, axis=1), expected, rtol=1e-6)


@settings(max_examples=8, deadline=None)
@given(
    share=st.floats(0.02, 0.3),
    change=st.lists(st.floats(-0.3, 0.3), min_size=6, max_size=6),
)
def test_zones_of_joint_moves_end_on_the_sphere(arm, share, change) -> None:
    assume(np.linalg.norm(change) > 1e-2)
    first = np.array([0.3, 0.2, -0.2, 0.1, 0.2, 0.1])
    moves = (
        MoveJ(arm.joints(first), SPEED, zone(arm, share)),
        MoveJ(arm.joints(first + change), SPEED, FINE),
    )
    path = arm.controller().plan(Program(moves, start=arm.start))
    assert path.corners.kind[0] != STOP
    wp = arm.home + first
    centre = tcp(arm, wp[None])[0]
    halves = [tcp(arm, (wp + 0.5 * np.array(far))[None])[0] for far in (-first, change)]
    radius = min(share * arm.leg, *(np.linalg.norm(half - centre) for half in halves))
    # The sixth joint alone turns the tool about itself: no sphere is left then.
    assume(radius > 1e-6)
    for reach, far in zip(path.corners.reach[0, POSITION], (-first, change), strict=True):
        inside = tcp(arm, wp + np.linspace(0, reach, 50)[:, None] * np.array(far))
        distance = np.linalg.norm(inside - centre, axis=1)
        if reach < 0.5:
            assert distance[-1] == pytest.approx(radius, abs=1e-9)
        assert (distance[:-1] < radius + 1e-9).all()


def test_a_share_of_the_contour_begins_at_its_share_of_half_the_move(abb) -> None:
    moves = (
        MoveJ(abb.joints([0.3, 0, 0, 0, 0, 0]), SPEED, ContourFraction(0.4)),
        MoveJ(abb.joints([0.3, 0.3, 0, 0, 0, 0]), SPEED, FINE),
    )
    path = abb.controller().plan(Program(moves, start=abb.start))
    np.testing.assert_allclose(path.corners.reach[0], 0.2)


@given(fraction=st.floats(0.05, 1.0), first=st.floats(0.05, 0.4), second=st.floats(0.05, 0.4))
def test_a_share_of_the_contour_is_as_far_on_both_sides(abb, fraction, first, second) -> None:
    """Of the shorter of two joint moves; a line beside it is no measure of the other."""
    moves = (
        MoveJ(abb.joints([first, 0, 0, 0, 0, 0]), SPEED, ContourFraction(fraction)),
        MoveJ(abb.joints([first, second, 0, 0, 0, 0]), SPEED, FINE),
    )
    path = abb.controller().plan(Program(moves, start=abb.start))
    np.testing.assert_allclose(
        path.corners.reach[0] * [first, second], 0.5 * fraction * min(first, second)
    )


@pytest.mark.parametrize("orientation", list(ArcOrientation))
def test_arcs_end_at_their_target_through_the_auxiliary_point(arm, orientation) -> None:
    via, end = arm.target((0.5, 0.4, 0)), arm.target((1, 0, 0.1), (0.2, 0.3, -0.1))
    moves = (MoveC(end, SPEED, FINE, via=via, orientation=orientation),)
    path = arm.controller().plan(Program(moves, start=arm.start))
    R, p = arm.robot.forward(path.q)
    target = end.pose.matrix()
    np.testing.assert_allclose(p[-1], target[:3, 3], atol=1e-8)
    np.testing.assert_allclose(R[-1], target[:3, :3], atol=1e-8)
    closest = np.linalg.norm(p - np.array(via.pose.position), axis=1).min()
    assert closest < 0.05 * arm.leg
    step = rotation_vector(R[:-1].swapaxes(1, 2) @ R[1:])
    rate = np.linalg.norm(step, axis=1)[1:-1] / np.diff(path.sigma)[1:-1]
    if orientation is ArcOrientation.FIXED_FRAME:
        np.testing.assert_allclose(rate, rate[0], rtol=1e-4)


def test_two_lines_on_one_line_make_no_corner(arm) -> None:
    moves = (
        MoveL(arm.target((0.5, 0, 0)), SPEED, zone(arm, 0.1)),
        MoveL(arm.target((1, 0, 0)), SPEED, FINE),
    )
    for model in MODELS.values():
        path = arm.controller(model).plan(Program(moves, start=arm.start))
        points = tcp(arm, path.q)
        line = distance_to_chain(points, np.array([points[0], points[-1]]))
        assert line.max() < 1e-8


@pytest.mark.parametrize("name", ["parabola", "arc", "quintic"])
def test_a_reversal_turns_back_inside_its_zone(ur, name) -> None:
    moves = (
        MoveL(ur.target((1, 0, 0)), SPEED, zone(ur, 0.2)),
        MoveL(ur.target((0.2, 0, 0)), SPEED, FINE),
    )
    run = ur.controller(MODELS[name]).run(Program(moves, start=ur.start))
    points = run.trajectory.position
    line = np.array([ur.pose().position, ur.pose((1, 0, 0)).position])
    assert distance_to_chain(points, line).max() < 1e-7
    turned = np.linalg.norm(points - line[1], axis=1).min()
    assert 0.0 < turned < 0.2 * ur.leg


def test_moving_world_and_targets_together_changes_nothing(arm) -> None:
    program = mixed_program(arm, [0.2] * 6)
    shift = Pose((0.3, -0.2, 0.1), (0.8, 0.0, 0.0, 0.6))
    moved = []
    for move in program.moves:
        changes = {}
        if hasattr(move.target, "pose"):
            changes["target"] = replace(move.target, pose=shift @ move.target.pose)
        if isinstance(move, MoveC):
            changes["via"] = replace(move.via, pose=shift @ move.via.pose)
        moved.append(replace(move, **changes))
    robot = arm.robot.with_base(shift @ arm.robot.base)
    one = arm.controller().plan(program)
    other = arm.controller(robot=robot).plan(program.with_moves(tuple(moved)))
    np.testing.assert_allclose(one.q, other.q, atol=1e-8)


def test_a_controller_of_one_robot_keeps_its_programs_apart(abb) -> None:
    controller: Controller = abb.controller()
    program = mixed_program(abb, [0.2] * 6)
    one = controller.plan(program)
    controller.plan(mixed_program(abb, [0.1] * 6))
    np.testing.assert_array_equal(one.q, controller.plan(program).q)
