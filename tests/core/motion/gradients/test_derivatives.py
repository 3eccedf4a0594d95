"""Derivatives of whole programs equal difference quotients of the emulator itself."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from functools import cache

import numpy as np
import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st

from flyby.core.errors import InputError
from flyby.core.motion.emulator.controller import Controller
from flyby.core.motion.gradients.derivatives import Derivatives, ProgramGradient
from flyby.core.motion.model.blend import Blend
from flyby.core.motion.model.motion_model import MotionModel
from flyby.core.motion.model.rules import LineTurn, Pace
from flyby.core.motion.model.torque import Borne, Torque
from flyby.core.program.arc_orientation import ArcOrientation
from flyby.core.program.move import Move, MoveC, MoveJ, MoveL
from flyby.core.program.program import Program
from flyby.core.program.speed import Speed
from flyby.core.program.target import JointTarget, PoseTarget
from flyby.core.program.tool import Load, Tool, WorkObject
from flyby.core.program.zone import FINE, ContourFraction, Radius
from flyby.core.registry import find_robot, find_vendor
from flyby.core.robot.joint import ExternalAxis, ExternalRole, Joint, JointKind
from flyby.core.robot.model import Robot
from flyby.core.spatial.pose import Pose
from flyby.core.spatial.rotation import (
    matrix_from_rotation_vector,
    quaternion_from_matrix,
    rotation_vector,
)

ROBOT = find_robot("abb/irb6640-180-255")
VENDOR = find_vendor("abb")
START = JointTarget((0.1, 0.2, 0.1, 0.2, 0.5, 0.1))
STEP = 2e-6
WEIGHTS = np.array([1.0, 0.5, -0.3, 0.2, 0.7, -0.4])
SMOOTHSTEP = Blend(alpha=(0.0, 0.0, 3.0, -2.0), beta=(0.3,))


def pose(position: np.ndarray, turn: np.ndarray) -> Pose:
    w, x, y, z = map(float, quaternion_from_matrix(matrix_from_rotation_vector(turn)))
    a, b, c = map(float, position)
    return Pose((a, b, c), (w, x, y, z))


TOOL = Tool("gun", pose(np.array([0.1, 0, 0.3]), np.array([0, 0.3, 0])), Load(5.0, (0, 0, 0.1)))
OTHER = Tool("probe", pose(np.array([0.05, 0, 0.2]), np.zeros(3)), Load(2.0, (0, 0, 0.1)))


def shifted(dx: float, dy: float, dz: float, *turn: float) -> PoseTarget:
    """A target near where the tool stands at the start."""
    rotation, position = ROBOT.forward(np.array(START.joints))
    at = TOOL.tcp.matrix()
    here = position + rotation @ at[:3, 3] + np.array([dx, dy, dz])
    return PoseTarget(pose(here, rotation_vector(rotation @ at[:3, :3]) + np.array(turn)))


def speed(tcp: float, **more: float) -> Speed:
    return Speed(tcp=tcp, reorientation=2.0, **more)


@cache
def program() -> Program:
    """Lines, both kinds of arcs, joint moves to both kinds of targets, and all corners between.

    No two neighbours share a speed: that would be a tie between their limits.
    """
    moves: tuple[Move, ...] = (
        MoveL(
            shifted(0.05, 0.3, 0.02, 0.1, 0.05, 0.2),
            speed(0.5, tcp_acceleration=3.0),
            Radius(0.04, 0.06, 0.06, 0.1),
            TOOL,
        ),
        MoveL(
            shifted(-0.1, 0.35, 0.3, -0.1, 0.15, 0.1), speed(0.7), Radius(0.03, 0.07, 0.05), TOOL
        ),
        MoveC(
            shifted(-0.1, 0.05, 0.32, 0.1, 0.1, 0.0),
            speed(0.6),
            Radius(0.03, 0.035),
            TOOL,
            via=shifted(-0.15, 0.2, 0.4, 0, 0, 0),
        ),
        MoveC(
            shifted(-0.05, -0.2, 0.3, 0.1, 0.0, 0.1),
            speed(0.6),
            Radius(0.03),
            TOOL,
            via=shifted(-0.12, -0.1, 0.25, 0, 0, 0),
            orientation=ArcOrientation.FIXED_FRAME,
        ),
        MoveJ(JointTarget((0.3, 0.3, 0.2, 0.3, 0.6, 0.2)), speed(0.8), Radius(0.05), TOOL),
        MoveJ(shifted(0.02, -0.3, 0.1, 0.1, -0.1, 0.1), speed(1.2), Radius(0.04), TOOL),
        MoveJ(
            JointTarget((-0.1, 0.4, 0.0, 0.1, 0.5, 0.2)),
            speed(0.8, joint_fraction=0.3),
            ContourFraction(0.4),
            TOOL,
        ),
        MoveL(shifted(0.1, 0.1, -0.3, 0, 0.05, 0.2), speed(0.9), Radius(0.02), OTHER),
        MoveL(shifted(0.15, 0.3, -0.2, 0, 0.05, 0.1), speed(0.95), FINE, TOOL),
    )
    return Program(moves, start=START)


MODELS = {
    "parabola": replace(VENDOR.motion(), tcp=Blend(beta=(0.1,)), joint=Blend(beta=(0.2,))),
    "smoothstep": replace(
        VENDOR.motion(), tcp=SMOOTHSTEP, joint=SMOOTHSTEP, orientation=SMOOTHSTEP
    ),
    "arc": replace(VENDOR.motion(), tcp=Blend(kind="arc")),
    "quintic": replace(VENDOR.motion(), joint=Blend(kind="quintic")),
    "superposed": replace(
        VENDOR.motion(),
        pace=Pace.SUPERPOSED,
        line_turn=LineTurn.SWIVEL,
        tcp_acceleration=2.0,
        reorientation_acceleration=0.9,
    ),
    "superposed arcs": replace(
        VENDOR.motion(),
        tcp=Blend(kind="arc"),
        pace=Pace.SUPERPOSED,
        centripetal=1.2,
        tcp_acceleration=2.0,
        reorientation_acceleration=3.0,
    ),
    "zone times": replace(VENDOR.motion(), zone_time=0.08),
    "torque": replace(
        VENDOR.motion(),
        torque=Torque(
            (0.2, 0.15, 0.3, 0.1),
            (Borne(3, (0.13, 0.01)), Borne(5, (0.06, 0.09, 0.03, 0.0))),
            (0.0, 0.1, 0.6),
            (0.3, 0.2, 0.1),
        ),
    ),
}


class Quantities:
    """Duration, energy, and a configuration at a sample and at a time, with derivatives."""

    def __init__(self, robot: Robot, model: MotionModel, program: Program) -> None:
        self.robot = robot
        controller = Controller(VENDOR, robot, model)
        path = controller.plan(program)
        timing = controller.stamp(program, path)
        self.sample = 2 * len(path.sigma) // 3
        self.time = 0.37 * timing.duration
        self.weights = np.resize(WEIGHTS, robot.size)
        derivatives = Derivatives(program, timing)
        self.gradients = [
            derivatives.duration(),
            derivatives.configuration(self.sample, self.weights),
            derivatives.configuration_at(self.time, self.weights),
        ]
        self.has_energy = not robot.external_axes
        if self.has_energy:
            self.gradients.append(derivatives.energy())
        self.scale = np.abs(self.values(model, program)) + 1.0

    def values(self, model: MotionModel, program: Program) -> np.ndarray:
        controller = Controller(VENDOR, self.robot, model)
        path = controller.plan(program)
        timing = controller.stamp(program, path)
        q = timing.states_at(np.array([self.time]))[0][0]
        values = [timing.duration, path.q[self.sample] @ self.weights, q @ self.weights]
        if self.has_energy:
            values.append(controller.energy(program, timing).value)
        return np.array(values)

    def check(
        self,
        vary: Callable[[float], tuple[MotionModel, Program]],
        of: Callable[[ProgramGradient], float],
    ) -> None:
        """Hold the derivative ``of`` against the quotient of ``vary``."""
        quotient = (self.values(*vary(STEP)) - self.values(*vary(-STEP))) / (2 * STEP)
        exact = np.array([of(gradient) for gradient in self.gradients])
        tolerance = 1e-5 * np.abs(exact) + 1e-6 * self.scale
        assert (np.abs(exact - quotient) <= tolerance).all(), (exact, quotient)


@cache
def quantities(name: str) -> Quantities:
    return Quantities(ROBOT, MODELS[name], program())


def changed(index: int, change: Callable[[Move, float], Move], h: float) -> Program:
    moves = list(program().moves)
    moves[index] = change(moves[index], h)
    return program().with_moves(tuple(moves))


def displaced(move: Move, step: np.ndarray) -> Move:
    target = move.target
    assert isinstance(target, PoseTarget)
    at = tuple(np.array(target.pose.position) + step)
    return replace(move, target=replace(target, pose=Pose(at, target.pose.quaternion)))


def move_position(move: Move, axis: int, h: float) -> Move:
    return displaced(move, h * np.eye(3)[axis])


def turn_target(move: Move, axis: int, h: float) -> Move:
    target = move.target
    assert isinstance(target, PoseTarget)
    turned = matrix_from_rotation_vector(h * np.eye(3)[axis]) @ target.pose.matrix()[:3, :3]
    quaternion = tuple(map(float, quaternion_from_matrix(turned)))
    return replace(move, target=replace(target, pose=Pose(target.pose.position, quaternion)))


@pytest.mark.parametrize("name", MODELS)
@pytest.mark.parametrize("index", [0, 1, 2, 3, 5, 7, 8])
def test_pose_targets(name: str, index: int) -> None:
    found = quantities(name)
    for axis in (0, 1, 2):
        found.check(
            lambda h, a=axis: (
                MODELS[name],
                changed(index, lambda move, h: move_position(move, a, h), h),
            ),
            lambda gradient, a=axis: gradient.position[index, a],
        )
    found.check(
        lambda h: (MODELS[name], changed(index, lambda move, h: turn_target(move, 1, h), h)),
        lambda gradient: gradient.turn[index, 1],
    )


@pytest.mark.parametrize("name", MODELS)
@pytest.mark.parametrize("index", [4, 6])
def test_joint_targets_and_start(name: str, index: int) -> None:
    for axis in (1, 4):
        step = np.eye(6)[axis]

        def move_joints(move: Move, h: float, step: np.ndarray = step) -> Move:
            assert isinstance(move.target, JointTarget)
            return replace(move, target=JointTarget(tuple(move.target.joints + h * step)))

        def move_start(h: float, step: np.ndarray = step) -> Program:
            return replace(program(), start=JointTarget(tuple(np.array(START.joints) + h * step)))

        quantities(name).check(
            lambda h, f=move_joints: (MODELS[name], changed(index, f, h)),
            lambda gradient, a=axis: gradient.joints[index, a],
        )
        quantities(name).check(
            lambda h, f=move_start: (MODELS[name], f(h)),
            lambda gradient, a=axis: gradient.start[a],
        )


@pytest.mark.parametrize("name", MODELS)
@pytest.mark.parametrize("index", [2, 3])
def test_auxiliary_points_of_arcs(name: str, index: int) -> None:
    def move_via(move: Move, h: float) -> Move:
        assert isinstance(move, MoveC)
        x, y, z = move.via.pose.position
        moved = Pose((x + 0.6 * h, y, z + 0.8 * h), move.via.pose.quaternion)
        return replace(move, via=replace(move.via, pose=moved))

    quantities(name).check(
        lambda h: (MODELS[name], changed(index, move_via, h)),
        lambda gradient: 0.6 * gradient.via[index, 0] + 0.8 * gradient.via[index, 2],
    )


@pytest.mark.parametrize("name", MODELS)
@pytest.mark.parametrize("index", range(8))
def test_zones(name: str, index: int) -> None:
    def widen(field: str) -> Callable[[Move, float], Move]:
        return lambda move, h: replace(
            move, zone=replace(move.zone, **{field: getattr(move.zone, field) + h})
        )

    share = isinstance(program().moves[index].zone, ContourFraction)
    quantities(name).check(
        lambda h: (MODELS[name], changed(index, widen("fraction" if share else "tcp"), h)),
        lambda gradient: gradient.zone[index],
    )
    if index in (0, 1):
        quantities(name).check(
            lambda h: (MODELS[name], changed(index, widen("reorientation"), h)),
            lambda gradient: gradient.zone_reorientation[index],
        )


@pytest.mark.parametrize("name", MODELS)
@pytest.mark.parametrize(
    ("index", "field"),
    [
        (0, "tcp"),
        (1, "tcp"),
        (4, "tcp"),
        (8, "tcp"),
        (0, "tcp_acceleration"),
        (6, "joint_fraction"),
    ],
)
def test_speeds(name: str, index: int, field: str) -> None:
    def faster(move: Move, h: float) -> Move:
        value = getattr(move.speed, field) + h
        return replace(move, speed=replace(move.speed, **{field: value}))

    quantities(name).check(
        lambda h: (MODELS[name], changed(index, faster, h)),
        lambda gradient: getattr(gradient.speed, field)[index],
    )


@pytest.mark.parametrize("name", ["parabola", "smoothstep"])
@pytest.mark.parametrize("law", ["tcp", "joint"])
def test_blend_laws(name: str, law: str) -> None:
    model = MODELS[name]
    blend: Blend = getattr(model, law)

    def bend(h: float) -> tuple[MotionModel, Program]:
        beta = (blend.beta[0] + h, *blend.beta[1:])
        return replace(model, **{law: replace(blend, beta=beta)}), program()

    def lean(h: float) -> tuple[MotionModel, Program]:
        # α keeps its end at 1: s gains what s² loses.
        alpha = (0.0, 1.0 + h, -h)
        return replace(model, **{law: replace(blend, alpha=alpha)}), program()

    found = quantities(name)
    found.check(bend, lambda g: getattr(g, f"{law}_blend").beta[0])
    if name == "parabola":
        found = Quantities(ROBOT, lean(0.0)[0], program())
        found.check(
            lean,
            lambda g: getattr(g, f"{law}_blend").alpha[1] - getattr(g, f"{law}_blend").alpha[2],
        )


@cache
def moved() -> tuple[Robot, Program]:
    """A robot on a track working on a turntable; the two never tie for the slower axis."""
    track = Joint("E1", Pose((0, 0, 0)), (0, 1, 0), -3, 3, 1.0, 2.0, None, kind=JointKind.PRISMATIC)
    table = Joint("E2", Pose((1.6, 0, 0.3)), (0, 0, 1), -3, 3, 1.0, 2.0, None)
    robot = ROBOT.with_external_axes(
        [ExternalAxis(track, ExternalRole.TRACK), ExternalAxis(table, ExternalRole.TABLE)]
    )
    part = WorkObject("part", moved_by="E2")

    def target(base: PoseTarget, e1: float, e2: float) -> PoseTarget:
        x, y, z = base.pose.position
        at = Pose((x - 1.6, y, z - 0.3), base.pose.quaternion)
        return PoseTarget(at, external=(e1, e2))

    zone = Radius(0.04, 0.05, 0.06)
    moves = (
        MoveL(target(shifted(0.05, 0.25, 0, 0, 0, 0.1), 0.13, 0.08), speed(0.5), zone, TOOL, part),
        MoveL(target(shifted(0.0, 0.3, 0.2, 0.1, 0, 0), 0.35, -0.13), speed(0.5), zone, TOOL, part),
        MoveJ(JointTarget((0.2, 0.1, 0.2, 0.2, 0.6, 0.1), (0.2,)), speed(0.8), zone, TOOL, part),
        MoveL(target(shifted(0.0, 0.1, 0.1, 0, 0, 0), 0.05, 0.11), speed(0.5), FINE, TOOL, part),
    )
    return robot, Program(moves, start=replace(START, external=(0.0, 0.0)))


@pytest.mark.parametrize(("index", "axis"), [(0, 0), (0, 1), (1, 0), (1, 1), (3, 1)])
def test_external_axes(index: int, axis: int) -> None:
    robot, base = moved()
    model = MODELS["parabola"]

    def slide(h: float) -> tuple[MotionModel, Program]:
        moves = list(base.moves)
        values = np.array(moves[index].target.external) + h * np.eye(2)[axis]
        moves[index] = replace(
            moves[index], target=replace(moves[index].target, external=tuple(values))
        )
        return model, base.with_moves(tuple(moves))

    Quantities(robot, model, base).check(slide, lambda g: g.joints[index, 6 + axis])


@settings(max_examples=12, deadline=None)
@given(seed=st.integers(0, 10_000))
def test_any_direction(seed: int) -> None:
    """Along a random direction in all positions and radii of a random chain of lines and joints."""
    rng = np.random.default_rng(seed)
    moves: list[Move] = []
    for _ in range(4):
        target = shifted(*rng.uniform(-0.3, 0.3, 3), *rng.uniform(-0.2, 0.2, 3))
        kind = MoveL if rng.random() < 0.6 else MoveJ
        moves.append(kind(target, speed(rng.uniform(0.2, 1.0)), Radius(0.02, 0.03), TOOL))
    base = Program(tuple(moves), start=START)
    direction = rng.normal(size=(4, 3))

    def along(h: float) -> Program:
        return base.with_moves(
            tuple(
                replace(displaced(m, h * d), zone=Radius(0.02 + 0.1 * h * d[0], 0.03))
                for m, d in zip(base.moves, direction, strict=True)
            )
        )

    controller = Controller(VENDOR, ROBOT)

    def duration(h: float) -> float:
        moved = along(h)
        return controller.stamp(moved, controller.plan(moved)).duration

    near = (duration(STEP) - duration(-STEP)) / (2 * STEP)
    far = (duration(3 * STEP) - duration(-3 * STEP)) / (6 * STEP)
    assume(abs(near - far) < 1e-5 * (1 + abs(near)))
    timing = controller.stamp(base, controller.plan(base))
    gradient = Derivatives(base, timing).duration()
    exact = np.sum(gradient.position * direction) + 0.1 * np.sum(gradient.zone * direction[:, 0])
    assert exact == pytest.approx(near, rel=1e-5, abs=1e-5)


def test_a_fixed_duration_is_refused() -> None:
    timed = changed(0, lambda move, h: replace(move, speed=Speed(duration=3.0)), 0.0)
    controller = Controller(VENDOR, ROBOT)
    timing = controller.stamp(timed, controller.plan(timed))
    with pytest.raises(InputError, match="move 1 has a fixed duration"):
        Derivatives(timed, timing)
