"""Certificates against densely sampled motions, and what samples do not see."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st

from flyby.core.cell.cell import Cell, Obstacle
from flyby.core.cell.geometry import Geometry
from flyby.core.collision.deviation import bounds as deviations
from flyby.core.collision.proof.certificate import TOLERANCE, certify, certify_stretch, scenes_of
from flyby.core.collision.proof.verdict import Certificate, Verdict
from flyby.core.errors import InputError, MotionError
from flyby.core.motion.emulator.controller import Controller
from flyby.core.motion.emulator.run import Run
from flyby.core.motion.geometry.pieces import Sampling
from flyby.core.motion.model.elasticity import Elasticity
from flyby.core.motion.model.motion_model import MotionModel
from flyby.core.program.move import MoveC, MoveJ, MoveL
from flyby.core.program.program import Program
from flyby.core.program.speed import Speed
from flyby.core.program.target import JointTarget, PoseTarget
from flyby.core.program.tool import FLANGE, Tool
from flyby.core.program.zone import FINE, Radius
from flyby.core.registry import find_robot, find_vendor
from flyby.core.robot.joint import ExternalAxis, ExternalRole, Joint
from flyby.core.robot.shape import Box, Capsule, Cylinder, Sphere
from flyby.core.spatial.pose import Pose
from flyby.core.spatial.rotation import matrix_from_rotation_vector

ARM = "abb/irb6640-180-255"
HOME = np.array([0.1, 0.2, 0.3, 0.2, 0.9, 0.1])
ROD = Tool("rod", Pose((0.0, 0.0, 0.3)))
ROD_SHAPE = Geometry(Capsule(0.05, 0.3), Pose((0.0, 0.0, 0.15)))
SPEED = Speed(tcp=1.0)
FEW = settings(max_examples=15)
DENSE = Sampling(step=0.002, turn=0.01, joint=0.003, halvings=1, most=5000)


def cell_with(*obstacles: Obstacle, robot=None, **parts) -> Cell:
    return Cell(
        robot or find_robot(ARM),
        "abb",
        tools={"rod": ROD},
        tool_geometries={"rod": ROD_SHAPE},
        obstacles=obstacles,
        allowed=(("J4", "rod"), ("J5", "rod"), ("J4", "J6")),
        **parts,
    )


def controller_of(cell: Cell, model: MotionModel | None = None, sampling=None) -> Controller:
    return Controller(find_vendor(cell.vendor), cell.robot, model or MotionModel(), sampling)


def turned(joint: int, angle: float) -> np.ndarray:
    """Home with one joint (from 1) turned by an angle in rad."""
    q = HOME.copy()
    q[joint - 1] += angle
    return q


def joints(q) -> JointTarget:
    return JointTarget(tuple(map(float, q)))


def swing(*changes, zone=FINE, speed: Speed = SPEED) -> Program:
    """Joint moves from home by these changes in turn (rad)."""
    targets = [HOME + np.array(change) for change in changes]
    moves = [MoveJ(joints(q), speed, zone, ROD) for q in targets]
    return Program((*moves[:-1], replace(moves[-1], zone=FINE)), start=joints(HOME))


def tip(robot, q) -> np.ndarray:
    return np.array((robot.flange_pose(np.asarray(q)) @ ROD.tcp).position)


def ball(at, radius: float = 0.02, name: str = "ball") -> Obstacle:
    return Obstacle(name, Geometry(Sphere(radius), Pose(tuple(map(float, at)))))


def check(cell: Cell, program: Program, clearance: float, **options) -> tuple[Run, Certificate]:
    controller = controller_of(cell)
    run = controller.run(program)
    return run, certify(controller, run, scenes_of(cell), clearance, **options)


def dense_least(cell: Cell, program: Program, within: float = 0.5) -> float:
    path = controller_of(cell, sampling=DENSE).plan(program)
    return float(scenes_of(cell)(ROD).clearance(path.q, within).min())


# What samples do not see


def sampled(cell: Cell, run: Run, count: int) -> float:
    """The least distance at evenly spaced configurations of a program of one joint move."""
    q = np.linspace(run.path.q[0], run.path.q[-1], count)
    return float(scenes_of(cell)(ROD).clearance(q).min())


def trap() -> tuple[Cell, Program]:
    """A move that is 5.00 mm clear of a ball at 45 samples and 4.80 mm in truth.

    The ball stands beside the way of the rod's tip, half way between two samples.
    """
    robot, count = find_robot(ARM), 45

    def made(turn: float, gap: float) -> tuple[Cell, Program]:
        place = tip(robot, turned(1, 0.5 * turn + 0.5 * turn / (count - 1)))
        side = place * [1.0, 1.0, 0.0] / np.linalg.norm(place[:2])
        cell = cell_with(ball(place + (0.05 + 0.02 + gap) * side))
        return cell, swing(turned(1, turn) - HOME)

    def least(turn: float, gap: float, samples: int) -> float:
        cell, program = made(turn, gap)
        return sampled(cell, controller_of(cell).run(program), samples)

    turn, gap = 0.3, 0.0048
    for _ in range(40):
        gap += 0.0048 - least(turn, gap, 44 * 40 + 1)
        wrong = least(turn, gap, count) - 0.005
        if abs(wrong) < 1e-8:
            break
        turn *= np.sqrt(0.0002 / (0.0002 + wrong))
    return made(turn, gap)


def test_the_sampling_trap_is_not_walked_into() -> None:
    cell, program = trap()
    controller = controller_of(cell)
    run = controller.run(program)
    assert sampled(cell, run, 45) == pytest.approx(0.005, abs=1e-6)
    assert sampled(cell, run, 300) == pytest.approx(0.0048, abs=5e-6)
    found = certify(controller, run, scenes_of(cell), 0.005)
    assert found.verdict is Verdict.VIOLATED
    assert set(found.pair) == {"rod", "ball"}
    assert found.distance < 0.005 - TOLERANCE
    again = scenes_of(cell)(ROD).clearance(np.array([found.configuration]))
    assert again[0] == pytest.approx(found.distance, abs=1e-9)
    assert found.sigma[0] <= found.sigma[1] and found.move == 0
    kept = certify(controller, run, scenes_of(cell), 0.0048, resolution=1e-5)
    assert kept.proven and 0.00479 - 1e-7 <= kept.clearance <= 0.0048 + 1e-7
    assert kept.distance == pytest.approx(0.0048, abs=1e-5)


@settings(max_examples=10)
@given(st.floats(0.1, 0.9), st.floats(1e-4, 1e-3))
def test_a_thin_wall_between_samples_is_found(share, thickness) -> None:
    program = swing(turned(1, 0.8) - HOME)
    place = tip(find_robot(ARM), turned(1, 0.8 * share))
    out = place * [1.0, 1.0, 0.0] / np.linalg.norm(place[:2])
    matrix = np.eye(4)
    matrix[:3, :3] = np.column_stack([out, np.cross([0.0, 0.0, 1.0], out), [0.0, 0.0, 1.0]])
    matrix[:3, 3] = place + 0.08 * out
    wall = Obstacle("wall", Geometry(Box((0.2, thickness, 0.4)), Pose.from_matrix(matrix)))
    cell = cell_with(wall)
    # Steps of the tip far wider than wall and rod.
    q = np.linspace(program.moves[0].target.joints, HOME, 4)
    scene = scenes_of(cell)(ROD)
    assume(not scene.collides(q).any())
    _, found = check(cell, program, 0.0)
    assert found.verdict is Verdict.VIOLATED and "wall" in found.pair
    assert found.distance <= 1e-5


# Random programs among random things

STEP = st.floats(-0.25, 0.25)
STEPS = st.tuples(STEP, STEP, STEP).map(np.array)
TURNS = st.tuples(*[st.floats(-0.4, 0.4)] * 3).map(np.array)
CHANGES = st.tuples(*[st.floats(-0.4, 0.4)] * 6).map(np.array)
SHAPES = st.one_of(
    st.builds(Sphere, st.floats(0.02, 0.2)),
    st.builds(Capsule, st.floats(0.02, 0.1), st.floats(0.05, 0.5)),
    st.builds(Cylinder, st.floats(0.02, 0.2), st.floats(0.05, 0.5)),
    st.builds(Box, st.tuples(*[st.floats(0.03, 0.6)] * 3)),
)


@st.composite
def random_obstacles(draw, robot, count: int = 3) -> tuple[Obstacle, ...]:
    """Things round the tool at home."""
    found = []
    for k in range(draw(st.integers(1, count))):
        place = Pose(tuple(tip(robot, HOME) + 2.5 * draw(STEPS)))
        turned = moved(place, np.zeros(3), 4 * draw(TURNS))
        found.append(Obstacle(f"thing {k}", Geometry(draw(SHAPES), turned)))
    return tuple(found)


def moved(pose: Pose, step, turn) -> Pose:
    matrix = pose.matrix()
    matrix[:3, :3] = matrix_from_rotation_vector(np.asarray(turn)) @ matrix[:3, :3]
    matrix[:3, 3] += step
    return Pose.from_matrix(matrix)


@st.composite
def random_moves(draw, robot, most: int = 3) -> Program:
    """Joint moves, lines and arcs near home, all with zones."""
    tcp = robot.flange_pose(HOME) @ ROD.tcp
    made = []
    for _ in range(draw(st.integers(1, most))):
        kind = draw(st.sampled_from((MoveJ, MoveL, MoveC)))
        zone = Radius(draw(st.floats(0.01, 0.1)))
        end = moved(tcp, draw(STEPS), draw(TURNS))
        if kind is MoveC:
            via = PoseTarget(moved(tcp, draw(STEPS), np.zeros(3)))
            made.append(MoveC(PoseTarget(end), SPEED, zone, ROD, via=via))
        elif kind is MoveL:
            made.append(MoveL(PoseTarget(end), SPEED, zone, ROD))
        else:
            made.append(MoveJ(joints(HOME + draw(CHANGES)), SPEED, zone, ROD))
    return Program(tuple(made), start=joints(HOME))


def planned(cell: Cell, program: Program, model: MotionModel | None = None) -> Run:
    try:
        return controller_of(cell, model).run(program)
    except MotionError:
        assume(False)
        raise


@FEW
@given(st.data(), st.sampled_from([0.0, 0.003]))
def test_the_proven_clearance_is_the_least_there_is(data, residual) -> None:
    robot = find_robot(ARM)
    cell = cell_with(*data.draw(random_obstacles(robot)))
    program = data.draw(random_moves(robot))
    run = planned(cell, program)
    scene = scenes_of(cell)(ROD)
    path = controller_of(cell, sampling=DENSE).plan(program)
    found = scene.distances(path.q, 0.4).distance
    least = float(found.min())
    assume(0.001 < least < 0.39)
    resolution = 5e-5
    certificate = certify(
        controller_of(cell), run, scenes_of(cell), 0.0, residual, resolution=resolution
    )
    if least < residual - 1e-4:
        assert certificate.verdict is Verdict.UNPROVEN
        return
    assume(least > 2 * residual + 1e-3)
    assert certificate.proven, certificate.message
    # Two links of the robot may both be elsewhere, an obstacle may not.
    assert certificate.clearance <= least - residual + 1e-7
    assert certificate.clearance >= least - 2 * residual - resolution - 5e-4


@FEW
@given(st.data())
def test_what_is_nearer_than_asked_for_is_found(data) -> None:
    robot = find_robot(ARM)
    cell = cell_with(*data.draw(random_obstacles(robot)))
    program = data.draw(random_moves(robot))
    run = planned(cell, program)
    least = dense_least(cell, program)
    assume(-0.01 < least < 0.3)
    clearance = least + data.draw(st.floats(5e-5, 0.05))
    assume(clearance > 0.001)
    found = certify(controller_of(cell), run, scenes_of(cell), clearance)
    assert found.verdict is Verdict.VIOLATED, found.message
    q = np.array([found.configuration])
    scene = scenes_of(cell)(ROD)
    pairs = [scene.pair_names(k) for k in range(len(scene.pairs))]
    between = scene.distances(q).distance[0, pairs.index(found.pair)]
    assert between == pytest.approx(found.distance, abs=1e-6)
    assert between < clearance
    # The configuration is on the path, in the stretch that is named.
    path = controller_of(cell, sampling=DENSE).plan(program)
    inside = np.abs(path.q - q).max(axis=1).min()
    assert inside < 0.02
    # Nothing before the stretch is too near.
    before = path.sigma < found.sigma[0]
    if before.any():
        assert scene.clearance(path.q[before], 0.5).min() >= clearance - TOLERANCE - 1e-6


@settings(max_examples=8)
@given(st.data(), st.floats(0.01, 0.04))
def test_smoothed_motions_keep_what_is_proven_at_every_override(data, window) -> None:
    robot = find_robot(ARM)
    cell = cell_with(*data.draw(random_obstacles(robot)))
    program = data.draw(random_moves(robot))
    model = MotionModel(smoothing=(window,))
    run = planned(cell, program, model)
    assume(dense_least(cell, program) > 0.03)
    controller = controller_of(cell, model)
    found = certify(controller, run, scenes_of(cell), 0.0, resolution=1e-4)
    assert found.proven, found.message
    scene = scenes_of(cell)(ROD)
    for share in (1.0, 0.5, 0.1):
        moves = tuple(
            replace(m, speed=Speed(tcp=share * 1.0, joint_fraction=share)) for m in program.moves
        )
        slower = controller.run(program.with_moves(moves), period=0.004 / share)
        assert scene.clearance(slower.trajectory.q, 0.5).min() >= found.clearance - 1e-6


@settings(max_examples=8)
@given(st.data(), STEPS, st.floats(-3.0, 3.0))
def test_moving_the_whole_cell_changes_nothing(data, step, angle) -> None:
    robot = find_robot(ARM)
    things = data.draw(random_obstacles(robot))
    program = data.draw(random_moves(robot))
    clearance = data.draw(st.floats(0.001, 0.1))
    place = moved(Pose(), 4 * step, [0.0, 0.0, angle])

    def carried(target):
        return PoseTarget(place @ target.pose) if isinstance(target, PoseTarget) else target

    elsewhere = []
    for move in program.moves:
        move = replace(move, target=carried(move.target))
        if isinstance(move, MoveC):
            move = replace(move, via=carried(move.via))
        elsewhere.append(move)
    there = cell_with(
        *(
            replace(t, geometry=replace(t.geometry, placement=place @ t.geometry.placement))
            for t in things
        ),
        robot=robot.with_base(place @ robot.base),
    )
    here = cell_with(*things)
    planned(here, program)
    first = check(here, program, clearance, resolution=1e-4)[1]
    second = check(there, program.with_moves(tuple(elsewhere)), clearance, resolution=1e-4)[1]
    assert first.verdict is second.verdict
    assert first.clearance == pytest.approx(second.clearance, abs=2e-4)
    if not first.proven:
        assert first.move == second.move and set(first.pair) == set(second.pair)
        assert first.sigma == pytest.approx(second.sigma, abs=1e-6)


def test_the_same_is_found_again() -> None:
    cell = cell_with(ball(tip(find_robot(ARM), HOME) + np.array([0.0, 0.3, 0.1])))
    program = swing(
        [0.4, 0.1, 0.0, 0.3, 0.0, 0.0], [0.1, -0.3, 0.2, 0.0, 0.2, 0.0], zone=Radius(0.1)
    )
    assert check(cell, program, 0.005)[1] == check(cell, program, 0.005)[1]


def test_a_stretch_knows_only_of_itself() -> None:
    cell, program = trap()
    away = swing(turned(1, -0.4) - HOME)
    program = Program(
        (*away.moves, MoveJ(joints(HOME), SPEED, FINE, ROD), *program.moves), start=away.start
    )
    controller = controller_of(cell)
    run = controller.run(program)
    scenes = scenes_of(cell)
    whole = certify(controller, run, scenes, 0.005)
    assert whole.verdict is Verdict.VIOLATED and whole.move == 2
    last = float(run.path.sigma[-1])
    clear = certify_stretch(controller, run, scenes, 0.005, [(0.0, whole.sigma[0] - 0.01)])
    assert clear.proven
    beside = [(0.0, 0.1), (whole.sigma[1] - 0.05, whole.sigma[1] + 0.05)]
    found = certify_stretch(controller, run, scenes, 0.005, beside)
    assert found.verdict is Verdict.VIOLATED and found.move == 2
    after = certify_stretch(controller, run, scenes, 0.005, [(whole.sigma[1] + 0.1, last)])
    assert after.proven


# Tools, tables, starts


def test_each_move_is_checked_with_its_own_tool() -> None:
    long = Tool("long", Pose((0.0, 0.0, 0.8)))
    place = tip(find_robot(ARM), turned(1, 0.4))
    axis = find_robot(ARM).flange_pose(turned(1, 0.4)).matrix()[:3, 2]
    cell = cell_with(ball(place + 0.3 * axis))
    cell = replace(
        cell,
        tools={"rod": ROD, "long": long},
        tool_geometries={"rod": ROD_SHAPE, "long": Geometry(Capsule(0.03, 0.8), Pose((0, 0, 0.4)))},
    )
    there = MoveJ(joints(turned(1, 0.4)), SPEED, FINE, ROD)
    back = replace(there, target=joints(HOME))
    assert check(cell, Program((there, back), start=joints(HOME)), 0.005)[1].proven
    _, found = check(cell, Program((there, replace(back, tool=long)), start=joints(HOME)), 0.005)
    assert found.verdict is Verdict.VIOLATED
    assert found.move == 1 and set(found.pair) == {"long", "ball"}
    assert found.message.startswith("move 2, at ")


def test_a_part_on_a_turning_table_is_seen_where_it_turns_to() -> None:
    table = Joint("T", Pose((1.6, 0.0, 0.2)), (0.0, 0.0, 1.0), -6, 6, 2, 4)
    robot = find_robot(ARM).with_external_axes([ExternalAxis(table, ExternalRole.TABLE)])
    post = Obstacle("post", Geometry(Cylinder(0.05, 1.6), Pose((0.9, 0.0, 0.8))), carried_by="T")
    cell = cell_with(post, robot=robot)
    start = JointTarget(tuple(HOME), (0.0,))
    scene = scenes_of(cell)(ROD)
    turns = np.linspace(0.0, 2 * np.pi, 400)
    q = np.column_stack([np.tile(HOME, (400, 1)), turns])
    least = scene.clearance(q)
    hit = turns[np.argmin(least)]
    assert least.min() < 0 < least[0]
    first = turns[np.argmax(least < 0.005)]
    for reach, clear in ((0.5 * first, True), (hit, False)):
        program = Program(
            (MoveJ(JointTarget(tuple(HOME), (reach,)), SPEED, FINE, ROD),), start=start
        )
        _, found = check(cell, program, 0.005)
        assert found.proven is clear
        if not clear:
            assert "post" in found.pair and found.configuration[6] == pytest.approx(first, abs=0.03)


def test_a_start_that_overlaps_is_said_with_its_depth() -> None:
    cell = cell_with(ball(tip(find_robot(ARM), HOME) + np.array([0.0, 0.0, -0.03])))
    run, found = check(cell, swing(turned(1, 0.3) - HOME), 0.005)
    assert found.verdict is Verdict.VIOLATED
    assert found.sigma[0] == 0.0 and found.move == 0
    depth = -scenes_of(cell)(ROD).clearance(run.path.q[:1])[0]
    assert found.distance == pytest.approx(-depth, abs=2e-3)
    assert "overlap by" in found.message and "rod" in found.message and "ball" in found.message


# What cannot be proven, and what cannot be asked


def test_a_budget_that_does_not_reach_says_so() -> None:
    cell, program = trap()
    _, found = check(cell, program, 0.0048, budget=5)
    assert found.verdict is Verdict.UNPROVEN and "budget" in found.message
    assert found.move == 0 and found.pair is None


def test_smoothing_does_not_leave_a_straight_move() -> None:
    cell, program = trap()
    controller = controller_of(cell, MotionModel(smoothing=(0.05,)))
    found = certify(controller, controller.run(program), scenes_of(cell), 0.0048)
    assert found.proven and found.clearance > 0.00479


def test_smoothing_that_takes_the_clearance_leaves_it_unproven() -> None:
    """A ball inside a corner, which the average over time cuts."""
    corner = turned(1, 0.4)
    end = corner.copy()
    end[2] += 0.4
    program = swing(corner - HOME, end - HOME, zone=Radius(0.02), speed=Speed(tcp=50.0))
    robot = find_robot(ARM)
    inside = 0.5 * (tip(robot, HOME) + tip(robot, end)) - tip(robot, corner)
    inside /= np.linalg.norm(inside)
    cell = cell_with(ball(tip(robot, corner) + 0.12 * inside))
    kept = dense_least(cell, program) - 1e-4
    assert check(cell, program, kept)[1].proven
    controller = controller_of(cell, MotionModel(smoothing=(0.1, 0.1)))
    found = certify(controller, controller.run(program), scenes_of(cell), kept)
    assert found.verdict is Verdict.UNPROVEN
    assert "smoothing in time" in found.message and set(found.pair) == {"rod", "ball"}


@pytest.mark.parametrize("resolution", [None, 1e-4])
def test_proofs_part_by_part_are_the_same(monkeypatch, resolution) -> None:
    cell = cell_with(ball((0.6, 0.9, 0.6), 0.1))
    changes = [turned(1, 0.1 * k) + turned(3, 0.05 * (k % 2)) - 2 * HOME for k in range(1, 9)]
    program = swing(*changes, zone=Radius(0.02))
    controller = controller_of(cell, MotionModel(smoothing=(0.04, 0.03)))
    run = controller.run(program)
    least = scenes_of(cell)(ROD).clearance(run.path.q, 0.5).min()
    for clearance in (least - 0.01, least + 0.01):
        monkeypatch.undo()
        whole = certify(controller, run, scenes_of(cell), clearance, resolution=resolution)
        monkeypatch.setattr(deviations, "_TOGETHER", 30)
        assert len(list(deviations.parts_of(run.path))) > 3
        made = certify(controller, run, scenes_of(cell), clearance, resolution=resolution)
        assert (made.verdict, made.pair, made.move) == (whole.verdict, whole.pair, whole.move)
        assert made.clearance == pytest.approx(whole.clearance, abs=1e-4)
        assert made.proven == (clearance < least)


@pytest.mark.parametrize("resolution", [None, 1e-4])
def test_deviations_that_no_bound_is_known_of_are_not_taken_for_none(resolution) -> None:
    """A ramp before servos that lag, not averaged; said at once, not halved for ever."""
    cell = cell_with(ball((3.0, 0.0, 0.0)))
    corner, end = turned(1, 0.4) - HOME, turned(1, 0.4) + turned(2, 0.4) - 2 * HOME
    program = swing(corner, end, zone=Radius(0.05))
    model = MotionModel(ramp=0.04, elasticity=Elasticity(lag=(1e-3,)))
    controller = controller_of(cell, model)
    run = controller.run(program)
    found = certify(controller, run, scenes_of(cell), 0.0, resolution=resolution)
    assert found.verdict is Verdict.UNPROVEN and found.measured < 1000


@pytest.mark.parametrize(("clearance", "words"), [(0.0, "nothing touches"), (0.0048, "at least")])
def test_a_proof_says_what_it_is_worth(clearance, words) -> None:
    cell, program = trap()
    _, found = check(cell, program, clearance)
    assert found.proven
    if clearance or found.clearance < 1e-5:
        assert words in found.message


def test_nothing_near_is_proven_without_a_figure() -> None:
    cell = cell_with()
    scene = scenes_of(cell)(ROD)
    _, found = check(cell, swing(turned(1, 0.3) - HOME), 0.005, resolution=1e-4)
    assert found.proven
    if len(scene.pairs):
        assert found.clearance == pytest.approx(found.distance, abs=1.1e-4)


@pytest.mark.parametrize(
    ("clearance", "options"),
    [
        (-0.001, {}),
        (float("nan"), {}),
        (float("inf"), {}),
        (0.005, {"residual": -1e-3}),
        (0.005, {"resolution": 1e-7}),
    ],
)
def test_senseless_numbers_are_refused(clearance, options) -> None:
    cell = cell_with()
    controller = controller_of(cell)
    run = controller.run(swing(turned(1, 0.1) - HOME))
    with pytest.raises(InputError, match=r"metres|are found to"):
        certify(controller, run, scenes_of(cell), clearance, **options)


def test_the_flange_alone_is_a_tool_too() -> None:
    cell = cell_with(ball([0.0, 0.0, 3.5]))
    move = MoveJ(joints(HOME + 0.2), SPEED, FINE, FLANGE)
    assert check(cell, Program((move,), start=joints(HOME)), 0.005)[1].proven
