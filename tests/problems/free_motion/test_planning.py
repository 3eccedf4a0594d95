"""First paths: free, repeatable, and refused in plain words where there is none."""

from __future__ import annotations

import sys
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from flyby.core.cell.cell import Obstacle
from flyby.core.cell.geometry import Geometry
from flyby.core.collision.proof.certificate import scenes_of
from flyby.core.errors import InputError, MotionError
from flyby.core.program.target import JointTarget, PoseTarget
from flyby.core.program.zone import Radius
from flyby.core.robot.inverse.solution import UnreachableError
from flyby.core.robot.shape import Box
from flyby.core.spatial.pose import Pose
from flyby.problems.free_motion.planning.free_space import FreeSpace
from flyby.problems.free_motion.planning.plan import PlannedPath, PlanningOptions, plan_path
from flyby.validation.scenes.scene import Scene, joint_target
from flyby.validation.scenes.stud_welding import stud_welding
from flyby.validation.scenes.two_joints import two_joints

pytest.importorskip("ompl")

QUICK = PlanningOptions(tries=1)


def planned(scene: Scene, start=None, goal=None, options: PlanningOptions = QUICK) -> PlannedPath:
    program = scene.programs[0]
    return plan_path(
        scene.cell,
        program.start if start is None else start,
        program.moves[-1].target if goal is None else goal,
        scene.tool,
        options=options,
        controller=scene.controller(),
    )


@pytest.fixture(scope="module")
def scene() -> Scene:
    return two_joints()


@pytest.fixture(scope="module")
def space(scene: Scene) -> FreeSpace:
    return FreeSpace(scenes_of(scene.cell)(scene.tool), scene.cell.clearance, ())


def test_a_path_leads_from_start_to_goal_and_is_proven(scene: Scene) -> None:
    found = planned(scene)
    program = scene.programs[0]
    assert found.program.start.joints == pytest.approx(program.start.joints)
    assert found.program.moves[-1].target.joints == pytest.approx(program.moves[-1].target.joints)
    assert found.certificate.proven
    assert found.certificate.clearance >= scene.cell.clearance - 1.1e-5
    assert len(found.program.moves) > 1  # the box is in the straight way
    assert found.run.duration < scene.controller().run(program).duration


def test_the_same_seed_gives_the_same_path(scene: Scene) -> None:
    first, again = planned(scene), planned(scene)
    assert first.program == again.program
    other = planned(scene, options=replace(QUICK, seed=3))
    assert other.program != first.program


def test_more_tries_give_no_slower_path(scene: Scene) -> None:
    one = planned(scene)
    three = planned(scene, options=replace(QUICK, tries=3))
    assert three.run.duration <= one.run.duration + 5e-3


def test_a_pose_may_be_met_by_any_branch(scene: Scene) -> None:
    joints = scene.programs[0].moves[-1].target.joints
    pose = scene.cell.robot.flange_pose(joints) @ scene.tool.tcp
    found = planned(scene, goal=PoseTarget(pose))
    reached = found.program.moves[-1].target.joints
    tip = scene.cell.robot.flange_pose(reached) @ scene.tool.tcp
    np.testing.assert_allclose(tip.position, pose.position, atol=1e-9)


def test_zones_go_round_the_points_passed(scene: Scene) -> None:
    found = planned(scene, options=replace(QUICK, zone=Radius(0.01), margin=0.004))
    assert found.certificate.proven
    assert [move.zone for move in found.program.moves[:-1]] == [Radius(0.01)] * (
        len(found.program.moves) - 1
    )


def test_a_free_straight_way_is_one_move() -> None:
    station = stud_welding()
    found = planned(station)  # from home to the first stud
    assert len(found.program.moves) == 1


def test_a_start_that_collides_is_named_with_what_it_hits(scene: Scene) -> None:
    inside = joint_target((0.0, 20.0, 40.0, 0.0, 0.0, 0.0))
    with pytest.raises(MotionError, match=r"the start is not free: .*box overlap by .* mm"):
        planned(scene, start=inside)


def test_a_goal_too_near_says_how_near(scene: Scene) -> None:
    with pytest.raises(MotionError, match=r"the start is not free: .* apart, less than .* 500 mm"):
        planned(scene, options=replace(QUICK, clearance=0.499))


def test_a_pose_all_of_whose_branches_collide_lists_why(scene: Scene) -> None:
    inside = PoseTarget(Pose((1.575, 0.0, 0.4), (0.0, 1.0, 0.0, 0.0)))
    with pytest.raises(MotionError, match=r"configurations of the goal is free: .*box"):
        planned(scene, goal=inside)


def test_a_goal_out_of_reach_is_named(scene: Scene) -> None:
    with pytest.raises(UnreachableError, match=r"^the goal: "):
        planned(scene, goal=PoseTarget(Pose((9.0, 0.0, 1.0))))


def test_joint_values_must_fit_the_robot(scene: Scene) -> None:
    with pytest.raises(InputError, match="the goal: joint J3 at 100° is outside"):
        planned(scene, goal=joint_target((0.0, 0.0, 100.0, 0.0, 0.0, 0.0)))
    with pytest.raises(InputError, match="the goal has 2 joint values"):
        planned(scene, goal=JointTarget((0.0, 0.0)))
    with pytest.raises(InputError, match="0 external axes"):
        planned(scene, goal=replace(scene.programs[0].start, external=(0.1,)))


def test_a_goal_behind_walls_is_given_up_in_time(scene: Scene) -> None:
    """A narrow corridor with a low ceiling: the arm cannot turn round in it."""
    plates = [((6.0, 0.05, 4.0), (0.0, y, 1.0)) for y in (-0.5, 0.5)]
    plates.append(((6.0, 1.0, 0.05), (0.0, 0.0, 2.3)))
    walls = tuple(
        Obstacle(f"wall{k}", Geometry(Box(size), Pose(place)))
        for k, (size, place) in enumerate(plates)
    )
    corridor = replace(scene, cell=replace(scene.cell, obstacles=walls))
    behind = joint_target((168.0, 0.0, 20.0, 0.0, 0.0, 0.0))
    with pytest.raises(MotionError, match=r"no path .* was found in 1 s; allow more time"):
        planned(corridor, goal=behind, options=replace(QUICK, time_limit=1.0))


def test_without_ompl_the_extra_is_named(scene: Scene, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, "ompl.base", None)
    with pytest.raises(InputError, match=r"pip install 'flyby\[planning\]'"):
        planned(scene)


@pytest.mark.parametrize(
    "wrong", [{"clearance": -1e-3}, {"margin": float("nan")}, {"tries": 0}, {"time_limit": 0.0}]
)
def test_options_check_themselves(wrong: dict[str, float]) -> None:
    with pytest.raises(InputError, match="PlanningOptions"):
        PlanningOptions(**wrong)


angles = st.tuples(st.floats(-0.6, 1.2), st.floats(-0.6, 1.2))


@given(first=angles, last=angles)
@settings(max_examples=60, deadline=None)
def test_a_motion_said_to_be_free_keeps_the_clearance_all_along(
    first: tuple[float, float], last: tuple[float, float], space: FreeSpace
) -> None:
    a, b = (np.array([0.0, *pair, 0.0, 0.0, 0.0]) for pair in (first, last))
    share = np.linspace(0.0, 1.0, 301)[:, None]
    least = space.scene.clearance((1 - share) * a + share * b, 0.2).min()
    if space.joins(a, b):
        assert least >= space.clearance - 1e-9
    else:
        assert least < space.clearance + 2e-3


@given(first=angles, last=angles)
@settings(max_examples=20, deadline=None)
def test_a_motion_is_as_free_forth_as_back(
    first: tuple[float, float], last: tuple[float, float], space: FreeSpace
) -> None:
    a, b = (np.array([0.0, *pair, 0.0, 0.0, 0.0]) for pair in (first, last))
    assert space.joins(a, b) == space.joins(b, a)
