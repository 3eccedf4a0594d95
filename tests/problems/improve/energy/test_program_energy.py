"""Programs between fast and frugal: laws of the front, code that reads back, proofs."""

from __future__ import annotations

import math
from dataclasses import replace
from functools import cache
from itertools import pairwise

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from flyby.core.collision.proof.certificate import certify, scenes_of
from flyby.core.errors import InputError, MotionError
from flyby.core.motion.emulator.controller import Controller
from flyby.core.motion.model.consumption import Motors, SquaredTorque
from flyby.core.program.move import MoveJ, MoveL
from flyby.core.program.program import Program
from flyby.core.program.speed import Speed
from flyby.core.program.zone import Radius
from flyby.core.registry import find_vendor
from flyby.core.source.patch.edits import alike
from flyby.problems.improve.energy import (
    EnergyScope,
    EnergyTask,
    Front,
    Goal,
    optimize_energy,
    pareto,
)
from flyby.problems.improve.energy.front import FrontPoint, without_dominated
from flyby.problems.improve.energy.paced_problem import FixedShape, PacedProblem
from flyby.problems.improve.energy.paced_search import LATE
from flyby.problems.improve.energy.pacing import make_pacing
from flyby.problems.improve.waypoints import Effort
from flyby.problems.improve.waypoints import WaypointTask as Wishes
from flyby.validation.scenes.scene import PARABOLAS, with_zone
from flyby.validation.scenes.two_joints import two_joints

SCENE = two_joints()
QUICK = Effort(starts=1, generations=0, iterations=8, proofs=3, workers=1)
ABB = find_vendor("abb")


@cache
def controller() -> Controller:
    return SCENE.controller(PARABOLAS)


def zoned() -> Program:
    return with_zone(SCENE.programs[0], Radius(0.1))


def written(program: Program) -> Program:
    """The program as RAPID says it."""
    text = next(iter(ABB.write(program, SCENE.cell.robot).values()))
    return ABB.read(text, "point.mod", robot=SCENE.cell.robot)


@cache
def speeds_front() -> Front:
    task = EnergyTask(EnergyScope.SPEEDS)
    return pareto(controller(), zoned(), None, task, 3, QUICK, ABB.speaks, written)


@cache
def full_front() -> Front:
    task = EnergyTask(wishes=Wishes(axes=SCENE.free, tilt=math.pi))
    return pareto(controller(), zoned(), SCENE.cell, task, 3, QUICK, ABB.speaks, written)


# ------------------------------------------------------------------ the front


@pytest.mark.parametrize("front", [speeds_front, full_front])
def test_more_time_never_costs_more(front):
    points = front().points
    assert len(points) >= 2
    for fast, slow in pairwise(points):
        assert fast.duration < slow.duration
        assert fast.energy > slow.energy


@pytest.mark.parametrize("front", [speeds_front, full_front])
def test_figures_are_those_of_the_code(front):
    """Read again from its text each program drives as it says."""
    for point in front().points:
        again = written(point.program)
        run = controller().run(again, SCENE.programs[0].start)
        energy = controller().energy(again, run.timing).value
        assert run.timing.duration == pytest.approx(point.duration, rel=1e-6)
        assert energy == pytest.approx(point.energy, rel=1e-6)
        assert point.by_joint.sum() == pytest.approx(point.energy)


@pytest.mark.parametrize("front", [speeds_front, full_front])
def test_limits_hold(front):
    limits = SCENE.cell.robot.limits
    for point in front().points:
        run = controller().run(point.program, SCENE.programs[0].start)
        assert (np.abs(run.trajectory.dq) <= limits.velocity * 1.02).all()
        assert (np.abs(run.trajectory.ddq) <= limits.acceleration * 1.02).all()
        assert (run.path.q >= limits.lower - 1e-6).all()
        assert (run.path.q <= limits.upper + 1e-6).all()


def test_speeds_alone_leave_the_path():
    given_, front = zoned(), speeds_front()
    for point in front.points:
        moves = list(point.program.moves)
        if len(moves) > len(given_.moves):  # written programs begin by driving to their start
            start = moves.pop(0).target
            assert start.joints == pytest.approx(given_.start.joints, abs=1e-6)
        for old, new in zip(given_.moves, moves, strict=True):
            assert new.target.joints == pytest.approx(old.target.joints, abs=1e-6)
            assert alike(getattr(new.zone, "tcp", 0.0), getattr(old.zone, "tcp", 0.0))
        assert point.certificate is None
    # Its own program is the fastest: nothing is driven faster than it is programmed.
    assert front.points[0].duration >= front.given.duration * (1 - 1e-6)
    assert front.points[-1].energy < front.given.energy * 0.99


def test_every_point_is_proven():
    front = full_front()
    assert front.proven
    scenes = scenes_of(SCENE.cell)
    for point in front.points:
        run = controller().run(point.program, SCENE.programs[0].start)
        assert certify(controller(), run, scenes, SCENE.cell.clearance).proven
    assert front.points[0].duration < front.given.duration


def test_speeds_alone_are_proven_in_a_cell():
    goal = Goal(0.0, 1e-7)
    task, cell = EnergyTask(EnergyScope.SPEEDS), SCENE.cell
    found = optimize_energy(controller(), zoned(), goal, cell, task, QUICK, ABB.speaks, written)
    assert found.proven and found.points[0].certificate is not None
    assert found.points[0].energy < found.given.energy


def test_the_same_again():
    task = EnergyTask(EnergyScope.SPEEDS)
    again = pareto(controller(), zoned(), None, task, 3, QUICK, ABB.speaks, written)
    for one, other in zip(speeds_front().points, again.points, strict=True):
        assert one.program.moves == other.program.moves
        assert one.energy == other.energy


@given(st.floats(0.01, 100.0))
@settings(max_examples=2, deadline=None)
def test_units_do_not_matter(factor):
    """Weights of all torques in common scale the energies, and change nothing else."""

    def found(weight):
        task = EnergyTask(EnergyScope.SPEEDS, SquaredTorque((weight,) * 6))
        goal = Goal(0.0, 1e-7 / weight)
        return optimize_energy(controller(), zoned(), goal, None, task, QUICK).points[0]

    one, other = found(1.0), found(factor)
    assert other.duration == pytest.approx(one.duration, rel=1e-2)
    assert other.energy == pytest.approx(factor * one.energy, rel=1e-3)


def test_motors_with_recuperation_take_less():
    copper = (1e-5,) * 6

    def least(recuperation):
        task = EnergyTask(EnergyScope.SPEEDS, Motors(copper, recuperation))
        goal = Goal(0.0, 1e-3)
        return optimize_energy(controller(), zoned(), goal, None, task, QUICK).points[0]

    assert least(0.9).energy < least(0.0).energy


# ------------------------------------------------------------------ single goals


@given(st.floats(1.05, 1.6))
@settings(max_examples=2, deadline=None)
def test_a_bound_is_kept(share):
    given_ = speeds_front().given
    goal = Goal(0.0, 1.0 / given_.energy, share * given_.duration)
    task = EnergyTask(EnergyScope.SPEEDS)
    found = optimize_energy(controller(), zoned(), goal, None, task, QUICK, ABB.speaks, written)
    (point,) = found.points
    assert point.duration <= goal.latest * (1 + 1e-4)
    assert point.energy <= given_.energy


def test_a_bound_that_cannot_be_kept_is_told():
    given_ = speeds_front().given
    goal = Goal(0.0, 1.0 / given_.energy, 0.5 * given_.duration)
    task = EnergyTask(EnergyScope.SPEEDS)
    effort = replace(QUICK, iterations=4, proofs=1)
    found = optimize_energy(controller(), zoned(), goal, None, task, effort, ABB.speaks, written)
    assert any("no program that takes" in note.message for note in found.notes)


def test_weights_order_programs():
    given_ = speeds_front().given
    task = EnergyTask(EnergyScope.SPEEDS)
    found = [
        optimize_energy(
            controller(),
            zoned(),
            Goal.weighted(w, given_.duration, given_.energy),
            None,
            task,
            QUICK,
            ABB.speaks,
        ).points[0]
        for w in (1.0, 0.5, 0.0)
    ]
    assert found[0].duration <= found[1].duration <= found[2].duration
    assert found[0].energy >= found[1].energy >= found[2].energy


# ------------------------------------------------------------------ the parts


@given(st.lists(st.floats(-1.0, -0.05), min_size=8, max_size=8), st.booleans())
@settings(max_examples=10, deadline=None)
def test_gradients_are_difference_quotients(shifts, hurry):
    program = zoned()
    timing = controller().stamp(program, controller().plan(program))
    robot = SCENE.cell.robot
    pacing = make_pacing(program, timing, robot, ABB.speaks, Wishes(), 0.02)
    assert pacing.size == 8
    x = np.clip(pacing.start + np.array(shifts) - 1e-3 * np.arange(8), pacing.lower, pacing.upper)
    base = pacing.applied(program, x)
    fixed = FixedShape(base, controller().plan(base))
    goal = Goal(1.0, 0.0) if hurry else Goal(0.0, 1e-6)
    problem = PacedProblem(controller(), fixed, pacing, goal, EnergyTask().consumption)
    point = problem.point(x)
    assert point is not None
    slope, step = problem.gradient(point), 1e-6
    for k in range(pacing.size):
        sides = []
        for sign in (1.0, -1.0):
            moved = x.copy()
            moved[k] += sign * step
            other = problem.point(moved)
            assert other is not None
            sides.append(other.objective)
        ahead = (sides[0] - point.objective) / step
        behind = (point.objective - sides[1]) / step
        # Where another limit takes over within the step, the slope is one of both sides'.
        low, high = sorted((ahead, behind))
        room = 2e-3 * (abs(low) + abs(high)) + 1e-3
        assert low - room <= slope[k] <= high + room


@given(st.lists(st.floats(0.2, 3.0), min_size=4, max_size=4))
@settings(max_examples=5, deadline=None)
def test_speeds_that_are_not_reached_may_go(factors):
    """The programmed speed in the place of one that is not reached changes nothing."""
    program = zoned()
    timing = controller().stamp(program, controller().plan(program))
    robot = SCENE.cell.robot
    pacing = make_pacing(program, timing, robot, ABB.speaks, Wishes(), 0.02)
    y = np.clip(pacing.start + np.repeat(np.log(factors), 2), pacing.lower, pacing.upper)
    # Neighbours with speeds of their own, so that both programs are sampled alike.
    y = np.maximum(y - 1e-6 * np.arange(8), pacing.lower)
    before = pacing.applied(program, y)
    path = controller().plan(before)
    stamped = controller().stamp(before, path)
    after = pacing.applied(program, pacing.released(y, stamped, robot))
    again = controller().stamp(after, path)
    assert again.duration == pytest.approx(stamped.duration, rel=1e-9)


def test_numbers_are_in_the_words_of_the_language():
    program = zoned()
    timing = controller().stamp(program, controller().plan(program))
    robot = SCENE.cell.robot

    def names(vendor):
        speaks = find_vendor(vendor).speaks
        return {n.name for n in make_pacing(program, timing, robot, speaks, Wishes(), 0.1).numbers}

    assert names("abb") == {"tcp", "joint_acceleration_fraction"}
    assert names("kuka") == {"joint_fraction", "joint_acceleration_fraction"}
    assert names("ur") == {"joint", "joint_acceleration"}


def test_lines_are_paced_too():
    program = zoned()
    line = [MoveL(m.target, replace(m.speed, tcp=1.0), m.zone, m.tool) for m in program.moves]
    ends = [replace(program.moves[0]), *line[1:2], *program.moves[2:]]
    made = program.with_moves(tuple(ends))
    poses = controller().plan(program)
    assert poses is not None
    timing = controller().stamp(program, poses)
    pacing = make_pacing(made, timing, SCENE.cell.robot, find_vendor("ur").speaks, Wishes(), 0.1)
    # A line whose acceleration is not stated has no number for it.
    assert [n.name for n in pacing.numbers if n.move == 1] == ["tcp"]


def test_moves_of_the_process_keep_their_speed():
    program = zoned()
    timing = controller().stamp(program, controller().plan(program))
    wishes = Wishes(keep=(1,))
    pacing = make_pacing(program, timing, SCENE.cell.robot, ABB.speaks, wishes, 0.1)
    assert {number.move for number in pacing.numbers} == {0, 2, 3}


@given(st.lists(st.tuples(st.floats(1.0, 9.0), st.floats(1.0, 9.0)), min_size=1, max_size=12))
def test_no_point_of_a_front_is_dominated(pairs):
    program = zoned()
    points = [FrontPoint(program, t, e, np.zeros(6)) for t, e in pairs]
    kept = without_dominated(points)
    for point in points:
        assert any(k.duration <= point.duration and k.energy <= point.energy for k in kept)
    for one, other in pairwise(kept):
        assert one.duration < other.duration and one.energy > other.energy


def test_programs_that_take_equally_long_are_one():
    """To the share by which programs may end late; a chain of them does not run away."""
    program = zoned()
    pairs = [(1.0, 5.0), (1.000024, 4.0), (1.00009, 3.5), (1.00012, 3.0), (1.2, 2.0)]
    points = [FrontPoint(program, t, e, np.zeros(6)) for t, e in pairs]
    kept = without_dominated(points, 5e-4, LATE)
    assert [(p.duration, p.energy) for p in kept] == [(1.00009, 3.5), (1.00012, 3.0), (1.2, 2.0)]
    assert len(without_dominated(points)) == 5


# ------------------------------------------------------------------ refusals and endings


def test_ended_early_there_is_still_a_front():
    seen = []

    def enough(state):
        seen.append(state)
        return state.stage.startswith("searching") and state.done == 3

    front = pareto(
        controller(),
        zoned(),
        None,
        EnergyTask(EnergyScope.SPEEDS),
        4,
        QUICK,
        ABB.speaks,
        written,
        enough,
    )
    assert 1 <= len(front.points) <= 4
    searched = [state for state in seen if state.stage.startswith("searching")]
    assert searched[-1].done == 3 < searched[-1].total
    # It tells what it has so far, while each search goes on as well.
    assert len(searched) > 10 and "% of the energy" in searched[-1].stage
    assert any("so far from" in state.stage for state in searched if state.done == 1)


def test_too_few_points_are_refused():
    with pytest.raises(InputError, match="two points"):
        pareto(controller(), zoned(), count=1)


def test_a_program_that_may_not_change_is_refused():
    program = zoned()
    moves = tuple(
        MoveJ(m.target, Speed(tcp=1.0, duration=2.0), m.zone, m.tool) for m in program.moves
    )
    with pytest.raises(InputError, match="nothing of this program may change"):
        pareto(
            controller(),
            program.with_moves(moves),
            task=EnergyTask(EnergyScope.SPEEDS),
            effort=QUICK,
        )


def test_unknown_inertias_are_refused():
    bare = replace(SCENE.cell.robot, links=())
    with pytest.raises(InputError, match="inertias"):
        pareto(Controller(ABB, bare), zoned(), effort=QUICK)


def test_a_collision_is_refused():
    straight = zoned()
    through = replace(straight, statements=straight.statements[-1:])
    with pytest.raises(MotionError, match="collides"):
        pareto(controller(), through, SCENE.cell, effort=QUICK)


@pytest.mark.parametrize(
    ("make", "word"),
    [
        (lambda: Goal(-1.0, 1.0), "weights"),
        (lambda: Goal(0.0, 0.0), "not both zero"),
        (lambda: Goal(1.0, 0.0, 0.0), "latest"),
        (lambda: Goal.weighted(1.5, 1.0, 1.0), "weight"),
        (lambda: Goal.weighted(0.5, 0.0, 1.0), "time"),
        (lambda: Goal.weighted(0.5, 1.0, -1.0), "energy"),
        (lambda: EnergyTask(slowest=0.0), "slowest"),
    ],
)
def test_what_cannot_be_wanted(make, word):
    with pytest.raises(InputError, match=word):
        make()
