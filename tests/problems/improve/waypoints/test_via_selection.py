"""The number of via points: corners cut in two, and searches that leave all else alone."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import example, given, settings
from hypothesis import strategies as st
from scipy.spatial import KDTree

from flyby.core.arrays import FloatArray
from flyby.core.collision.proof.certificate import certify, scenes_of
from flyby.core.motion.emulator.controller import Controller
from flyby.core.motion.emulator.run import Run
from flyby.core.motion.path.path import Path
from flyby.core.program.move import Move, MoveJ, MoveL, Opaque
from flyby.core.program.program import Program
from flyby.core.program.speed import Speed
from flyby.core.program.target import JointTarget, PoseTarget, Target
from flyby.core.program.tool import WORLD
from flyby.core.program.zone import FINE, Radius
from flyby.core.robot.kinematics.chain_kernels import poses
from flyby.core.robot.work_chain import work_chain
from flyby.core.spatial.pose import Pose
from flyby.core.spatial.rotation import quaternion_from_matrix
from flyby.problems.improve.progress import Progress
from flyby.problems.improve.solve_round_verify import ProgramFeasibility, solve_round_verify
from flyby.problems.improve.waypoints import (
    Effort,
    Fixed,
    PointBox,
    ViaCount,
    WaypointTask,
    optimize_waypoints,
)
from flyby.problems.improve.waypoints import optimize as optimizing
from flyby.problems.improve.waypoints.changeable import Selection, select
from flyby.problems.improve.waypoints.doubling import doubled
from flyby.problems.improve.waypoints.via_selection import (
    Counted,
    Rough,
    Searches,
    change_count,
    idle_points,
)
from flyby.validation.scenes.scene import PARABOLAS, joint_target, with_zone
from flyby.validation.scenes.two_joints import two_joints

SCENE = two_joints()
THREE = with_zone(SCENE.programs[0], Radius(0.1))
TWO = replace(THREE, statements=tuple(THREE.statements[k] for k in (0, 2, 3)))
ARM = 6
BETWEEN = 50
"""Places looked at between two samples of a path."""
NO_ROOM = 0.005
"""m; zones smaller than this have no room for two."""
QUICK = Effort(starts=1, generations=0, iterations=4, workers=1)


def controller() -> Controller:
    return SCENE.controller(PARABOLAS)


def tool_centres(path: Path) -> FloatArray:
    """(T, 3), all along a path: where joints drive straight on, samples are up to 73 mm apart."""
    samples = np.arange(len(path.q))
    between = np.linspace(0.0, samples[-1], 1 + BETWEEN * samples[-1])
    q = np.stack([np.interp(between, samples, joint) for joint in path.q.T], axis=1)
    return poses(work_chain(SCENE.cell.robot, SCENE.tool, WORLD), q)[1]


def farthest(one: FloatArray, other: FloatArray) -> float:
    """The largest way (m) from a place on one curve to the other, and the other way round."""
    there, back = (KDTree(b).query(a)[0].max() for a, b in ((one, other), (other, one)))
    return float(max(there, back))


def bent(program: Program) -> Program:
    """With a wrist that is nowhere singular."""

    def turned(target: Target | None) -> JointTarget:
        assert isinstance(target, JointTarget)
        return replace(target, joints=(*target.joints[:4], 0.5, target.joints[5]))

    moves = tuple(replace(move, target=turned(move.target)) for move in program.moves)
    return replace(program.with_moves(moves), start=turned(program.start))


def by_lines(program: Program) -> Program:
    """The same corners, driven to by the TCP on lines."""
    chain = work_chain(SCENE.cell.robot, SCENE.tool, WORLD)
    moves: list[Move] = []
    for move in program.moves:
        assert isinstance(move.target, JointTarget)
        R, p = poses(chain, np.array([move.target.joints]))
        x, y, z = map(float, p[0])
        w, i, j, k = map(float, quaternion_from_matrix(R[0]))
        target = PoseTarget(Pose((x, y, z), (w, i, j, k)))
        moves.append(MoveL(target, Speed(tcp=1.0), move.zone, SCENE.tool))
    return program.with_moves(tuple(moves))


@pytest.mark.parametrize("make", [lambda p: p, by_lines], ids=["joints", "lines"])
@given(index=st.integers(0, 2), radius=st.floats(0.001, 0.12))
@example(index=0, radius=0.021484375)
@example(index=1, radius=0.012)
@example(index=2, radius=0.08)
@example(index=1, radius=0.002)
@settings(max_examples=15)
def test_a_corner_cut_in_two_is_hardly_another_path(
    make: Callable[[Program], Program], index: int, radius: float
) -> None:
    program = make(bent(with_zone(THREE, Radius(radius))))
    before = controller().plan(program)
    found = doubled(program, before, index, ARM)
    if found is None:
        assert radius < NO_ROOM
        return
    assert len(found.moves) == len(program.moves) + 1
    after = controller().plan(found)
    assert after.q[[0, -1]] == pytest.approx(before.q[[0, -1]])
    assert all(isinstance(move, type(program.moves[0])) for move in found.moves)
    assert farthest(tool_centres(after), tool_centres(before)) < 0.15 * radius
    known = {note.message for note in before.notes}
    assert not [note.message for note in after.notes if note.message not in known]


def test_a_corner_between_kinds_keeps_its_point() -> None:
    """The move to it cannot end on the next one's leg."""
    joints = bent(THREE)
    mixed = joints.with_moves((*joints.moves[:2], *by_lines(joints).moves[2:]))
    found = doubled(mixed, controller().plan(mixed), 1, ARM)
    assert found is not None
    assert [type(move) for move in found.moves] == [MoveJ, MoveJ, MoveJ, MoveL, MoveL]
    assert found.moves[2].target == mixed.moves[1].target


def test_stops_have_no_corner_to_cut() -> None:
    sharp = with_zone(THREE, Radius(0.0))
    assert doubled(sharp, controller().plan(sharp), 1, ARM) is None


def test_one_more_pays_and_the_user_may_end_it() -> None:
    """It is proven with the 17th report; the user ends the searches after it."""
    seen: list[Progress] = []

    def report(state: Progress) -> bool:
        seen.append(state)
        return len(seen) > 17

    plane = WaypointTask(axes=SCENE.free, tilt=math.pi)
    kept = optimize_waypoints(controller(), TWO, SCENE.cell, plane, QUICK)
    task = replace(plane, vias=ViaCount.CHANGE)
    more = optimize_waypoints(controller(), TWO, SCENE.cell, task, QUICK, report=report)
    assert more.proven and len(more.program.moves) > len(kept.program.moves)
    assert more.after.time < 0.998 * kept.after.time
    assert len(seen) < 22


def never(changed: Program, own: WaypointTask, effort: Effort) -> None:
    """What nobody asks for where short searches come to nothing."""
    raise AssertionError


def test_what_short_searches_find_too_dear_is_not_optimised() -> None:
    """Only the two best of those that may save enough are searched longer."""
    run = controller().run(THREE)
    proof = certify(controller(), run, scenes_of(SCENE.cell), 0.005)
    best = Counted(run, proof, 1.0, WaypointTask(axes=SCENE.free, tilt=math.pi))
    asked: list[Program] = []

    def selected(counted: Counted) -> Selection:
        chosen = counted.run
        return select(chosen.program, chosen.path, SCENE.cell.robot, counted.task)

    def roughly(changed: Program, own: WaypointTask, effort: Effort) -> Rough:
        return Rough(changed, 1.1 if len(changed.moves) < 4 else 1.0 - 0.01 * len(asked))

    def improved(changed: Program, own: WaypointTask, effort: Effort) -> None:
        asked.append(changed)

    assert change_count(best, Searches(roughly, improved, selected), QUICK, ARM) is best
    assert [len(changed.moves) for changed in asked] == [5, 5]


def test_other_stretches_and_limited_points_are_left_alone() -> None:
    """There and back: the first way's second point is limited, and only the others are cut."""
    moves = list(THREE.moves)
    again = replace(moves[1], target=joint_target((0.0, -6.0, 44.0, 0.0, 0.0, 0.0)))
    home = replace(moves[1], target=THREE.start, zone=FINE)
    program = replace(THREE, statements=(*moves, again, home))
    run = controller().run(program)
    proof = certify(controller(), run, scenes_of(SCENE.cell), 0.005)
    task = WaypointTask(axes=SCENE.free, tilt=math.pi, limits={1: PointBox(joints=(0.1,) * ARM)})
    asked: list[tuple[Program, WaypointTask]] = []

    def roughly(changed: Program, own: WaypointTask, effort: Effort) -> None:
        asked.append((changed, own))

    def selected(counted: Counted) -> Selection:
        return select(program, run.path, SCENE.cell.robot, counted.task)

    best = Counted(run, proof, 1.0, task)
    searches = Searches(roughly, never, selected)
    assert change_count(best, searches, QUICK, ARM) is best
    fewer = [own for changed, own in asked if len(changed.moves) < len(program.moves)]
    more = [own for changed, own in asked if len(changed.moves) > len(program.moves)]
    assert len(fewer) == 4 and len(more) == 3
    # One more before the limited point, one after it, and one on the way back.
    assert [own.limits for own in more] == [{2: Fixed()}, {1: Fixed()}, {1: Fixed()}]
    assert [set(own.keep) for own in more] == [{5, 6}, {5, 6}, {0, 1, 2, 3}]


def test_a_point_where_something_is_switched_stays_one() -> None:
    """It is neither left out nor cut in two: the output would come elsewhere."""
    switch = Opaque("SetDO do1,1;")
    statements = (*THREE.statements[:2], switch, *THREE.statements[2:])
    program = replace(THREE, statements=statements)
    run = controller().run(program)
    proof = certify(controller(), run, scenes_of(SCENE.cell), 0.005)
    task = WaypointTask(axes=SCENE.free, tilt=math.pi)
    asked: list[Program] = []

    def roughly(changed: Program, own: WaypointTask, effort: Effort) -> None:
        asked.append(changed)

    def selected(counted: Counted) -> Selection:
        chosen = counted.run
        return select(chosen.program, chosen.path, SCENE.cell.robot, counted.task)

    best = Counted(run, proof, 1.0, task)
    assert list(selected(best).points) == [(0,), (1,), (2,)]
    change_count(best, Searches(roughly, never, selected), QUICK, ARM)
    assert [len(changed.moves) for changed in asked] == [3, 3, 5, 5]
    for changed in asked:
        place = changed.statements.index(switch)
        assert changed.statements[place - 1] == program.statements[1]
    assert list(idle_points(best, selected(best), lambda changed, task: 0.0)) == [0, 2]


def test_ctrl_c_between_two_searches_keeps_what_is_proven(monkeypatch: pytest.MonkeyPatch) -> None:
    """What the first search made is put together and proven; the second one is interrupted."""
    searches = 0

    def interrupted(*arguments: object) -> object:
        nonlocal searches
        searches += 1
        if searches == 2:
            raise KeyboardInterrupt
        return solve_round_verify(*arguments)  # type: ignore[arg-type]

    monkeypatch.setattr(optimizing, "solve_round_verify", interrupted)
    task = WaypointTask(axes=SCENE.free, tilt=math.pi, vias=ViaCount.CHANGE)
    found = optimize_waypoints(controller(), TWO, SCENE.cell, task, QUICK)
    assert searches == 2 and found.proven
    assert len(found.program.moves) == len(TWO.moves)
    assert found.after.time < found.before.time


def test_ctrl_c_while_changes_are_taken_back_keeps_what_is_proven(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    verified = ProgramFeasibility.verified
    asked = []

    def interrupted(*arguments: object) -> object:
        asked.append(arguments)
        raise KeyboardInterrupt

    def taking_back(given: Run, found: Counted, judged: Callable[[Program], object]) -> Counted:
        monkeypatch.setattr(ProgramFeasibility, "verified", interrupted)
        assert judged(given.program) is None and judged(given.program) is None
        monkeypatch.setattr(ProgramFeasibility, "verified", verified)
        return found

    monkeypatch.setattr(optimizing, "without_idle_changes", taking_back)
    task = WaypointTask(axes=SCENE.free, tilt=math.pi)
    found = optimize_waypoints(controller(), TWO, SCENE.cell, task, QUICK)
    assert len(asked) == 1 and found.proven
    assert found.after.time < found.before.time
