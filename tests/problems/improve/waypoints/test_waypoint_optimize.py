"""Whole optimisations: never slower, never nearer, tasks where they were."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from flyby.core.arrays import FloatArray
from flyby.core.cell.cell import Cell, Obstacle
from flyby.core.collision.proof.certificate import scenes_of
from flyby.core.errors import InputError, MotionError, Note
from flyby.core.motion.emulator.controller import Controller
from flyby.core.motion.emulator.run import Run
from flyby.core.program.program import Program
from flyby.core.program.target import JointTarget
from flyby.core.program.zone import FINE, Radius
from flyby.core.registry import find_vendor
from flyby.core.robot.kinematics.chain_kernels import poses
from flyby.core.robot.shape import Box as BoxShape
from flyby.core.robot.work_chain import work_chain
from flyby.core.spatial.pose import Pose
from flyby.core.spatial.rotation import rotation_vector
from flyby.problems.improve.progress import Progress
from flyby.problems.improve.solution import Solution
from flyby.problems.improve.waypoints import (
    Effort,
    Fixed,
    Freedom,
    PointBox,
    PointCone,
    ViaCount,
    WaypointTask,
    optimize_waypoints,
)
from flyby.validation.scenes.scene import PARABOLAS, SECOND_ORDER_BLENDS, joint_target, with_zone
from flyby.validation.scenes.two_joints import two_joints

SCENE = two_joints()
PROGRAM = with_zone(SCENE.programs[0], Radius(0.1))
QUICK = Effort(starts=1, generations=0, iterations=25, workers=1)
PLANE = WaypointTask(axes=SCENE.free, tilt=math.pi)


def controller() -> Controller:
    return SCENE.controller(PARABOLAS)


def optimized(
    program: Program = PROGRAM,
    task: WaypointTask = PLANE,
    effort: Effort = QUICK,
    cell: Cell = SCENE.cell,
) -> Solution:
    return optimize_waypoints(controller(), program, cell, task, effort)


def sampled_clearance(run: Run, cell: Cell) -> float:
    """At many more places than any search looks at."""
    t = np.linspace(0.0, run.timing.duration, 4000)
    q = run.timing.states_at(t)[0]
    scene = scenes_of(cell)(SCENE.tool)
    return float(scene.clearance(q).min())


@pytest.fixture(scope="module")
def faster() -> Solution:
    return optimized()


def test_waypoints_and_zones_make_it_faster(faster: Solution) -> None:
    assert faster.changed and faster.proven
    assert faster.after.time < 1.2 < 1.5 < faster.before.time
    assert faster.after.clearance is not None
    assert faster.after.clearance >= SCENE.cell.clearance - 1e-5


def test_the_clearance_holds_between_samples(faster: Solution) -> None:
    run = controller().run(faster.program)
    assert sampled_clearance(run, SCENE.cell) >= SCENE.cell.clearance - 1e-5


def test_tasks_and_locked_joints_stay(faster: Solution) -> None:
    assert faster.program.start == PROGRAM.start
    assert faster.program.moves[-1] == PROGRAM.moves[-1]
    for old, new in zip(PROGRAM.moves, faster.program.moves, strict=True):
        assert isinstance(old.target, JointTarget) and isinstance(new.target, JointTarget)
        locked = [0, 3, 4, 5]
        assert [new.target.joints[j] for j in locked] == [old.target.joints[j] for j in locked]
        assert (old.speed, old.tool, old.work_object) == (new.speed, new.tool, new.work_object)


def test_limits_hold(faster: Solution) -> None:
    trajectory = controller().run(faster.program).trajectory
    limits = SCENE.cell.robot.limits
    assert (np.abs(trajectory.dq) <= 1.01 * limits.velocity).all()
    assert (np.abs(trajectory.ddq) <= 1.05 * limits.acceleration).all()
    assert (trajectory.q >= limits.lower - 1e-9).all()
    assert (trajectory.q <= limits.upper + 1e-9).all()


def test_no_zone_is_cut(faster: Solution) -> None:
    assert not [n for n in controller().run(faster.program).notes if "cut" in n.message]


def test_the_same_comes_out_again_whatever_the_number_of_workers(faster: Solution) -> None:
    again = optimized(effort=replace(QUICK, workers=2))
    assert again.program == faster.program


def test_the_table_tells_both_sides(faster: Solution) -> None:
    rows = {row.what: row for row in faster.table(SCENE.cell.robot.axis_names)}
    assert rows["cycle time"].change == pytest.approx(
        100 * (faster.after.time / faster.before.time - 1)
    )
    assert rows["energy, joint J2"].before is not None
    assert rows["proven clearance"].after == pytest.approx(5.0, abs=0.1)


def moved_cell(pose: Pose) -> Cell:
    """The same cell elsewhere in the world."""
    cell = SCENE.cell
    obstacles = tuple(
        Obstacle(o.name, replace(o.geometry, placement=pose @ o.geometry.placement))
        for o in cell.obstacles
    )
    return replace(cell, robot=cell.robot.with_base(pose), obstacles=obstacles)


def test_moving_the_whole_cell_changes_nothing(faster: Solution) -> None:
    half = math.sqrt(0.5)
    cell = moved_cell(Pose((3.0, -1.0, 0.5), (half, 0.0, 0.0, half)))
    driver = Controller(find_vendor(cell.vendor), cell.robot, PARABOLAS)
    found = optimize_waypoints(driver, PROGRAM, cell, PLANE, QUICK)
    # The same up to rounding, which decides between kinks now and then.
    assert found.after.time == pytest.approx(faster.after.time, rel=5e-3)


@given(
    shifts=st.lists(st.floats(-0.08, 0.08), min_size=6, max_size=6),
    radius=st.floats(0.02, 0.15),
    second_order=st.booleans(),
)
@settings(max_examples=4, deadline=None, suppress_health_check=[HealthCheck.filter_too_much])
def test_never_slower_never_nearer(shifts: list[float], radius: float, second_order: bool) -> None:
    moves = list(with_zone(SCENE.programs[0], Radius(radius)).moves)
    for k in range(3):
        target = moves[k].target
        assert isinstance(target, JointTarget)
        q = list(target.joints)
        q[1] -= abs(shifts[2 * k])
        q[2] += 0.3 * shifts[2 * k + 1]
        moves[k] = replace(moves[k], target=JointTarget((*q[:2], min(q[2], 1.2), *q[3:])))
    program = PROGRAM.with_moves(tuple(moves))
    driver = SCENE.controller(SECOND_ORDER_BLENDS if second_order else PARABOLAS)
    effort = replace(QUICK, iterations=10, proofs=2)
    found = optimize_waypoints(driver, program, SCENE.cell, PLANE, effort)
    run = driver.run(found.program)
    assert run.duration <= driver.run(program).duration
    assert found.proven
    assert sampled_clearance(run, SCENE.cell) >= SCENE.cell.clearance - 1e-5
    assert found.program.moves[-1] == program.moves[-1]


def test_zones_alone_leave_all_points() -> None:
    task = replace(PLANE, freedom=Freedom.ZONES)
    found = optimize_waypoints(controller(), PROGRAM, SCENE.cell, task, QUICK)
    assert found.changed and found.after.time < found.before.time
    assert [m.target for m in found.program.moves] == [m.target for m in PROGRAM.moves]


def test_energy_as_the_objective_saves_energy() -> None:
    found = optimized(task=replace(PLANE, time_weight=0.0))
    assert found.changed
    assert found.before.energy is not None and found.after.energy is not None
    assert found.after.energy.sum() < found.before.energy.sum()


# ------------------------------------------------------------------------ user limits


def test_fixed_points_stay_and_boxes_bound() -> None:
    task = replace(PLANE, limits={0: Fixed(), 1: PointBox(joints=(0.05,) * 6)})
    found = optimized(task=task)
    old, new = PROGRAM.moves, found.program.moves
    assert new[0].target == old[0].target
    assert isinstance(old[1].target, JointTarget) and isinstance(new[1].target, JointTarget)
    change = np.abs(np.subtract(new[1].target.joints, old[1].target.joints))
    assert change.max() <= 0.05 + 1e-6


def tcp(target: object) -> tuple[FloatArray, FloatArray]:
    assert isinstance(target, JointTarget)
    chain = work_chain(SCENE.cell.robot, SCENE.tool, PROGRAM.moves[0].work_object)
    R, p = poses(chain, np.array([target.joints]))
    return R[0], p[0]


def test_boxes_of_positions_and_cones_hold_for_joint_targets() -> None:
    half, angle = (0.04, 0.04, 0.04), math.radians(5.0)
    task = replace(PLANE, limits={1: PointBox(position=half), 2: PointCone(angle)})
    found = optimized(task=task)
    assert found.changed
    moved = np.abs(tcp(found.program.moves[1].target)[1] - tcp(PROGRAM.moves[1].target)[1])
    assert (moved <= np.array(half) + 1e-5).all()
    axes = [tcp(p.moves[2].target)[0][:, 2] for p in (PROGRAM, found.program)]
    assert math.acos(min(1.0, float(axes[0] @ axes[1]))) <= angle + 1e-4


def test_kept_moves_keep_path_and_zones() -> None:
    found = optimized(task=replace(PLANE, keep=[1]))
    for k in (0, 1):
        assert found.program.moves[k] == PROGRAM.moves[k]


def test_freed_stops_become_via_points() -> None:
    stopping = SCENE.programs[0]
    found = optimized(stopping, replace(PLANE, freed=[0, 1, 2]))
    assert found.after.time < 0.6 * found.before.time
    assert found.original is stopping


def test_points_that_serve_nothing_go() -> None:
    """A via point in the middle of a straight way, nothing near."""
    points = [joint_target((0.0, a, b, 0.0, 0.0, 0.0)) for a, b in ((0, 0), (10, -5), (20, -10))]
    program = replace(
        PROGRAM,
        statements=tuple(
            replace(PROGRAM.moves[0], target=point, zone=zone)
            for point, zone in zip(points[1:], (Radius(0.05), FINE), strict=True)
        ),
        start=points[0],
    )
    cell = replace(SCENE.cell, obstacles=())
    fewer = optimized(program, replace(PLANE, vias=ViaCount.CHANGE), cell=cell)
    assert len(fewer.program.moves) <= 2
    assert fewer.after.time <= fewer.before.time


# --------------------------------------------------------------------------- bad input


def test_a_start_that_collides_is_refused_with_its_move() -> None:
    wall = Obstacle("wall", replace(SCENE.cell.obstacles[0].geometry, shape=BoxShape((0.15, 1, 3))))
    cell = replace(SCENE.cell, obstacles=(wall,))
    with pytest.raises(MotionError, match=r"move \d.*wall.*overlap"):
        optimized(cell=cell)


def test_a_clearance_larger_than_the_start_has_is_refused_with_the_largest() -> None:
    with pytest.raises(MotionError, match="98"):
        optimized(task=replace(PLANE, clearance=0.12))


def test_a_program_without_via_points_comes_back() -> None:
    found = optimized(SCENE.programs[0])
    assert not found.changed and found.program is SCENE.programs[0]
    assert any("no via point" in note.message for note in found.notes)


@pytest.mark.parametrize(
    ("task", "word"),
    [(replace(PLANE, freed=[3]), "move 4"), (replace(PLANE, keep=[7]), "move 8")],
)
def test_moves_that_cannot_be_meant(task: WaypointTask, word: str) -> None:
    with pytest.raises(InputError, match=word):
        optimized(task=task)


def test_numbers_out_of_range() -> None:
    for make, word in (
        (lambda: WaypointTask(time_weight=1.5), "time_weight"),
        (lambda: WaypointTask(clearance=-1.0), "clearance"),
        (lambda: Effort(starts=0), "starts"),
        (lambda: Effort(spread=0.0), "spread"),
        (lambda: PointBox(turn=-1.0), "range of a PointBox"),
        (lambda: PointCone(4.0), "angle"),
    ):
        with pytest.raises(InputError, match=word):
            make()


# ------------------------------------------------------------------------- interruption


def test_an_interrupted_search_gives_what_can_be_proven_of_it() -> None:
    seen: list[Progress] = []

    def report(state: Progress) -> bool:
        seen.append(state)
        return True

    effort = replace(QUICK, starts=3)
    found = optimize_waypoints(controller(), PROGRAM, SCENE.cell, PLANE, effort, report=report)
    assert seen[1].done == 1 < seen[1].total
    assert {state.stage for state in seen[2:]} <= {"refining", "proving"}
    assert found.changed and found.proven and found.after.time < found.before.time


def test_progress_is_told_to_the_end_and_what_is_handed_out_was_read_back() -> None:
    seen: list[Progress] = []
    read: list[Program] = []

    def read_back(program: Program) -> Program:
        read.append(replace(program, notes=(Note("as read from its text"),)))
        return read[-1]

    found = optimize_waypoints(
        controller(), PROGRAM, SCENE.cell, PLANE, QUICK, read_back, lambda s: seen.append(s)
    )
    assert seen[-1].stage == "proving" and seen[-1].best < 1.0
    assert found.changed and found.proven
    assert found.program is read[-1]


def test_a_text_that_says_a_program_that_collides_is_given_up(faster: Solution) -> None:
    """What is proven is the program that was read, not the one that was found."""

    def read_back(program: Program) -> Program:
        """A text that has no place for via points: all moves lead straight to the end."""
        moves = [replace(move, target=PROGRAM.moves[-1].target) for move in program.moves]
        return program.with_moves(tuple(moves))

    assert faster.changed, "without the text's fault something better is found"
    found = optimize_waypoints(controller(), PROGRAM, SCENE.cell, PLANE, QUICK, read_back)
    assert not found.changed and found.program is PROGRAM
    assert any("the program read from the new text fails" in note.message for note in found.notes)


# ------------------------------------------------------------------------ what a tool holds


def most_turned(solution: Solution) -> float:
    """rad, the farthest that the tool is turned at a waypoint."""
    robot = SCENE.cell.robot
    pairs = zip(solution.original.moves, solution.program.moves, strict=True)
    turns = [0.0]
    for old, new in pairs:
        assert isinstance(old.target, JointTarget) and isinstance(new.target, JointTarget)
        R = robot.forward(np.array([old.target.joints, new.target.joints]))[0]
        turns.append(float(np.linalg.norm(rotation_vector(R[1] @ R[0].T))))
    return max(turns)


@pytest.mark.parametrize("degrees", [0.0, 8.0])
def test_tools_are_tilted_no_further_than_allowed(degrees: float) -> None:
    """The same program goes up to a quarter of a turn where that is allowed."""
    found = optimized(task=WaypointTask(tilt=math.radians(degrees)))
    assert found.changed and found.proven
    assert found.after.time < found.before.time
    assert most_turned(found) < math.radians(degrees + 1e-3)
    told = {point.move: point for point in found.moved}
    assert told and max(point.turn for point in told.values()) == pytest.approx(most_turned(found))
    if degrees:
        assert most_turned(found) > math.radians(1.0)


def test_what_was_moved_is_told(faster: Solution) -> None:
    """Heights and turns, from the waypoints as they are driven."""
    assert faster.moved and max(point.turn for point in faster.moved) > math.radians(1.0)
    robot, lift = SCENE.cell.robot, SCENE.tool.tcp
    for point in faster.moved:
        old, new = (p.moves[point.move].target for p in (faster.original, faster.program))
        assert isinstance(old, JointTarget) and isinstance(new, JointTarget)
        before, after = (robot.flange_pose(t.joints) @ lift for t in (old, new))
        assert point.rise == pytest.approx(after.position[2] - before.position[2])
        assert point.distance == pytest.approx(math.dist(after.position, before.position))
    what = {row.what: row for row in faster.table()}
    assert what["lowest point of the TCP"].before is not None
