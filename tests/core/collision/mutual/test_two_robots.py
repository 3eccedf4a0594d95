"""Proofs between two robots, beside what dense sampling finds."""

from __future__ import annotations

import math
from dataclasses import replace
from functools import lru_cache

import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from flyby.core.cell.floor import bare_cell
from flyby.core.collision.mutual import pair_proof
from flyby.core.collision.mutual.meetings import Meetings
from flyby.core.collision.mutual.pair_proof import PairProver
from flyby.core.collision.mutual.robot_motion import RobotMotion
from flyby.core.motion.emulator.controller import Controller
from flyby.core.motion.emulator.run import Run
from flyby.core.program.move import MoveJ, MoveL
from flyby.core.program.program import Program
from flyby.core.program.speed import Speed
from flyby.core.program.target import JointTarget, PoseTarget
from flyby.core.program.zone import FINE, Radius
from flyby.core.registry import find_robot, find_vendor
from flyby.core.spatial.pose import Pose

CLEARANCE = 0.02
HOME = np.array([0.0, -1.2, 1.6, -1.9, -1.57, 0.0])
REACH = np.array([1.0, 0.5, 0.6, 0.5, 0.5, 0.5])
RATE = 0.004
"""s between samples, a tenth of what a joint needs for 2°."""


def motion(
    name: str, base: Pose, seed: int, count: int = 4, any_speed: bool = False
) -> RobotMotion:
    """A UR5e at a place that drives some joint moves and a line among them."""
    rng = np.random.default_rng(seed)
    robot = find_robot("ur/ur5e").with_base(base)
    turns = [HOME + REACH * rng.uniform(-1.0, 1.0, 6) for _ in range(count)]
    moves = [
        MoveJ(JointTarget(tuple(q)), Speed(joint=0.6), Radius(0.03, 0.03, 0.03)) for q in turns[:-1]
    ]
    controller = Controller(find_vendor("ur"), robot)
    lifted = robot.flange_pose(turns[-2]) @ Pose((0.0, 0.0, -0.03))
    moves.append(MoveL(PoseTarget(lifted), Speed(tcp=0.3)))
    program = Program(tuple(moves), start=JointTarget(tuple(HOME)))
    run = controller.run(program, None, None)
    return RobotMotion(name, controller, run, bare_cell(robot, "ur", floor=False))


@lru_cache(maxsize=8)
def two(seed: int, gap: float) -> PairProver:
    facing = Pose((0.0, 0.0, 0.0), (0.0, 0.0, 0.0, 1.0))
    return PairProver(
        motion("a", facing, 2 * seed), motion("b", Pose((gap, 0.0, 0.0)), 2 * seed + 1)
    )


def at(run: Run, t: np.ndarray) -> np.ndarray:
    trajectory = run.trajectory
    return np.stack([np.interp(t, trajectory.t, q) for q in trajectory.q.T], -1)


def sampled(prover: PairProver, shift: float = 0.0) -> float:
    """The least distance of both robots, the second so many seconds later."""
    last = max(prover.one.run.duration, prover.other.run.duration + shift)
    t = np.arange(0.0, last, RATE)
    return prover.nearest(at(prover.one.run, t), at(prover.other.run, t - shift))[0]


def in_time(apart: float) -> Meetings:
    return Meetings((lambda own: own, lambda own: own), apart, every=False)


@settings(max_examples=25, deadline=None, suppress_health_check=list(HealthCheck))
@given(st.integers(0, 10_000), st.floats(0.9, 1.7))
def test_in_time_is_what_sampling_finds(seed: int, gap: float) -> None:
    prover = two(seed, gap)
    least = sampled(prover)
    verdict = prover.prove(CLEARANCE, in_time(0.0))
    if verdict.proven:
        assert least >= CLEARANCE - 1e-4
    else:
        assert least <= 2.0 * CLEARANCE, verdict


@settings(max_examples=12, deadline=None, suppress_health_check=list(HealthCheck))
@given(st.integers(0, 10_000), st.floats(1.1, 1.7), st.floats(-0.1, 0.1))
def test_what_is_proven_holds_at_every_jitter(seed: int, gap: float, shift: float) -> None:
    prover = two(seed, gap)
    if prover.prove(CLEARANCE, in_time(0.1)).proven:
        assert sampled(prover, shift) >= CLEARANCE - 1e-4


@settings(max_examples=12, deadline=None, suppress_health_check=list(HealthCheck))
@given(st.integers(0, 10_000), st.floats(1.0, 1.7))
def test_at_any_time_names_every_pair_of_moves_that_meets(seed: int, gap: float) -> None:
    prover = two(seed, gap)
    verdict = prover.prove(CLEARANCE, Meetings.at_any_time())
    one, other = (m.run.trajectory for m in (prover.one, prover.other))
    for a in np.unique(one.move):
        for b in np.unique(other.move):
            first, second = (run.q[run.move == move][::12] for run, move in ((one, a), (other, b)))
            i, j = (k.ravel() for k in np.indices((len(first), len(second))))
            least = prover.nearest(first[i], second[j])[0]
            # Zones belong to the one move or to the other.
            near = any((a + x, b + y) in verdict.conflicts for x in (-1, 0, 1) for y in (-1, 0, 1))
            assert near or least >= CLEARANCE - 1e-4


@settings(max_examples=8, deadline=None, suppress_health_check=list(HealthCheck))
@given(st.integers(0, 10_000), st.floats(0.9, 1.3), st.floats(0.2, 0.8))
def test_what_is_followed_first_changes_no_verdict(seed: int, gap: float, share: float) -> None:
    """Where the two may be at once on parts of moves alone, many pairs of intervals that are near
    are not a conflict, and all have to be looked at."""
    prover = two(seed, gap)
    limits = [share * motion.run.duration for motion in (prover.one, prover.other)]

    def together(i: np.ndarray, j: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        spans = prover.one.own_time[i], prover.other.own_time[j]
        over = [span[:, 0] <= limit for span, limit in zip(spans, limits, strict=True)]
        whole = [span[:, 1] <= limit for span, limit in zip(spans, limits, strict=True)]
        return over[0] & over[1], whole[0] & whole[1]

    meetings = Meetings.at_any_time()
    meetings = replace(meetings, together=together)
    found = []
    for followed in (1, 10**9):
        with pytest.MonkeyPatch.context() as patch:
            patch.setattr(pair_proof, "_FOLLOWED", followed)
            found.append(prover.prove(CLEARANCE, meetings))
    assert set(found[0].conflicts) == set(found[1].conflicts)


def test_a_budget_that_ends_early_leaves_nothing_out() -> None:
    facing = Pose((0.0, 0.0, 0.0), (0.0, 0.0, 0.0, 1.0))
    prover = PairProver(motion("a", facing, 3), motion("b", Pose((0.9, 0.0, 0.0)), 4))
    for budget in (10, 100, 1000, 10_000):
        assert not prover.prove(CLEARANCE, Meetings.at_any_time(), budget).proven


def test_conflicts_say_where_and_when() -> None:
    facing = Pose((0.0, 0.0, 0.0), (0.0, 0.0, 0.0, 1.0))
    prover = PairProver(motion("a", facing, 3), motion("b", Pose((0.9, 0.0, 0.0)), 4))
    verdict = prover.prove(CLEARANCE, in_time(0.0))
    (conflict,) = verdict.conflicts.values()
    assert conflict.cause.name == "NEAR" and conflict.distance is not None
    assert conflict.distance < CLEARANCE
    assert abs(conflict.time(0) - conflict.time(1)) < 0.05
    q = [
        at(m.run, np.array([conflict.time(side)]))
        for side, m in enumerate((prover.one, prover.other))
    ]
    assert prover.nearest(q[0], q[1])[0] < CLEARANCE + 5e-3


def test_a_budget_that_is_used_up_is_no_proof() -> None:
    facing = Pose((0.0, 0.0, 0.0), (0.0, 0.0, 0.0, 1.0))
    prover = PairProver(motion("a", facing, 3), motion("b", Pose((1.2, 0.0, 0.0)), 4))
    verdict = prover.prove(CLEARANCE, Meetings.at_any_time(), budget=1)
    assert not verdict.proven
    assert {conflict.cause.name for conflict in verdict.conflicts.values()} == {"EXHAUSTED"}


def test_far_apart_needs_no_look() -> None:
    prover = PairProver(
        motion("a", Pose((0.0, 0.0, 0.0)), 3), motion("b", Pose((9.0, 0.0, 0.0)), 4)
    )
    verdict = prover.prove(CLEARANCE, Meetings.at_any_time())
    assert verdict.proven and verdict.looks == 0


@pytest.mark.parametrize("rows", [1, 7])
def test_halves_cover_the_whole(rows: int) -> None:
    moving = motion("a", Pose((0.0, 0.0, 0.0)), 5)
    chosen = np.arange(rows)
    child, known = moving.halved(chosen)
    assert known.all()
    for k, half in zip(chosen, child, strict=True):
        whole, first, second = moving.sigma[[k, half, half + 1]]
        assert (first[0], second[1]) == pytest.approx(tuple(whole))
        assert first[1] == pytest.approx(second[0])
        own = moving.own_time[[k, half, half + 1]]
        assert own[1, 0] <= own[0, 0] + 1e-9 or math.isinf(own[0, 0])
        assert (moving.side.swept.motion[half] <= moving.side.swept.motion[k] + 1e-6).all()


def test_a_motion_that_turns_back_within_a_zone_is_not_cut_to_pieces() -> None:
    """Its deviation has no useful bound: halves of it tell no more than the whole."""
    robot = find_robot("abb/irb120-3-058")
    there, back = JointTarget((0.3, 0.2, 0.0, 0.0, 0.5, 0.0)), JointTarget((0.0,) * 4 + (0.5, 0.0))
    speed, zone = Speed(tcp=0.5), Radius(0.001, 0.001, 0.001)
    moves = (MoveJ(there, speed, zone), MoveJ(back, speed, FINE))
    controller = Controller(find_vendor("abb"), robot)
    run = controller.run(Program(moves, start=back), None, None)
    made = RobotMotion("a", controller, run, bare_cell(robot, "abb", floor=False), any_speed=True)
    assert made.first < 2000


def test_more_near_pairs_than_are_looked_at_are_no_proof(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("flyby.core.collision.mutual.pair_proof._MOST_NEAR", 5)
    prover = PairProver(
        motion("a", Pose((0.0, 0.0, 0.0)), 3), motion("b", Pose((0.5, 0.0, 0.0)), 4)
    )
    assert not prover.prove(CLEARANCE, Meetings.at_any_time()).proven
