"""Runs about open questions: what they are for is what they show."""

from __future__ import annotations

import math
import re
from dataclasses import replace
from functools import cache
from itertools import pairwise

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from flyby.core.cell.cell import Cell
from flyby.core.dialect import MoveWords
from flyby.core.errors import OptionError
from flyby.core.motion.emulator.controller import Controller
from flyby.core.program.move import MoveC, MoveJ, MoveL
from flyby.core.program.target import JointTarget
from flyby.core.program.tool import FLANGE
from flyby.core.program.zone import ContourFraction, Radius
from flyby.core.registry import find_robot, find_vendor
from flyby.identification.experiment.design import design
from flyby.identification.experiment.information import nats
from flyby.identification.experiment.kinds import Kind, Topic
from flyby.identification.experiment.page import grouped, page
from flyby.identification.experiment.plan import CandidateRun, Experiment, Plan, Study
from flyby.identification.experiment.purpose import fit_text
from flyby.identification.experiment.selection import Option, RunChoice
from flyby.identification.experiment.topics import _chain
from flyby.identification.fit.parameters import ParameterSet
from flyby.identification.tcp_path import tcp_positions

ROBOTS = ("abb/irb1200-5-090", "kuka/kr30-3", "ur/ur10e")
SMALL = Plan(
    about=tuple(Topic),
    postures=1,
    turns=(math.radians(40), math.radians(120)),
    radii=(0.004,),
    speeds=(0.4,),
    minutes=None,
)
each_robot = pytest.mark.parametrize("name", ROBOTS)


@cache
def designed(name: str, plan: Plan = SMALL) -> Experiment:
    vendor = find_vendor(name.partition("/")[0])
    return design(vendor, Cell(find_robot(name), vendor.name), plan, bare=True)


def runs_of(made: Experiment, kind: Kind):
    found = [run for run in made.runs if run.candidate.kind is kind]
    assert found, made.skipped
    return found


def spells(moving):
    """Where each stretch of samples begins, and how many they are."""
    edges = np.flatnonzero(np.diff(np.concatenate([[False], moving, [False]]).astype(int)))
    return edges[::2], np.diff(edges)[::2]


@each_robot
def test_every_topic_has_runs_that_keep_limits_and_say_what_they_are_for(name: str) -> None:
    made = designed(name)
    limits = made.robot.limits
    assert {run.topic for run in made.runs} == set(Topic), made.skipped
    for run in made.runs:
        driven = run.run.trajectory
        room = np.minimum(driven.q - limits.lower, limits.upper - driven.q)
        assert room.min() > made.plan.margin - 2e-5
        assert run.certificate.proven
        assert run.purpose.question.endswith("?") and run.figures
        texts = [text for key in run.figures if (text := fit_text(made.model, key))]
        assert ParameterSet.named(made.model, texts).size == len(texts) > 0
    for topic in Topic:
        shown = [run.purpose.alternatives for run in made.runs if run.topic is topic]
        told = page(made, None)
        assert f"<h3>{topic}</h3>" in told and "flyby identify FOLDER" in told
        if topic not in (Topic.SHORT_LEGS, Topic.POSTURES):  # where the joints or speeds decide
            assert any(shown)


@each_robot
def test_what_may_be_so_instead_is_what_another_model_drives(name: str) -> None:
    made = designed(name)
    vendor = find_vendor(name.partition("/")[0])
    run = runs_of(made, Kind.POINT_TURNS)[0]
    half = next(one for one in run.purpose.alternatives if "wrist" in one.what)
    scales = tuple(
        made.model.acceleration_scale(k) * (0.5 if k >= 3 else 1.0) for k in range(made.robot.size)
    )
    model = replace(made.model, joint_acceleration_scale=scales)
    start = JointTarget(tuple(run.candidate.start))
    durations = [
        Controller(vendor, made.robot, one).run(run.program, start).timing.duration
        for one in (made.model, model)
    ]
    assert half.longer == pytest.approx(durations[1] - durations[0], abs=5e-3) and half.longer > 0


@each_robot
def test_the_moves_are_what_the_topic_asks_for(name: str) -> None:
    made = designed(name)
    robot = made.robot

    def places(run) -> np.ndarray:
        ends = run.run.path.route.ends.q
        return tcp_positions(robot, FLANGE, np.concatenate([ends[:1, 0], ends[:, 1]]))

    for run in runs_of(made, Kind.SHORT_LEGS):
        lengths = np.linalg.norm(np.diff(places(run), axis=0), axis=1)
        levels = " ".join(run.candidate.study.levels)
        told = {float(length) for length in re.findall(r"legs of (\S+) mm", levels)}
        assert told and len(run.candidate.corners) >= 8
        passed = [
            length
            for length, move in zip(lengths, run.run.path.route.moves, strict=True)
            if getattr(run.program.moves[move].zone, "tcp", 0.0) > 0
        ]
        for length in passed:
            assert min(abs(1e3 * length - one) for one in told) < 0.03
    for run in runs_of(made, Kind.POINT_TURNS):
        # The path does; averages over the joints take some controllers' TCP off it.
        assert np.ptp(tcp_positions(robot, FLANGE, run.run.path.q), axis=0).max() < 2e-5
        assert np.ptp(run.run.trajectory.q[:, 3:], axis=0).max() > 0.2
    for run in runs_of(made, Kind.RESTS):
        at = places(run)
        legs = np.diff(at, axis=0)
        up = legs[np.linalg.norm(legs[:, :2], axis=1) < 1e-4]
        assert len(up) >= 4 and (up[:, 2] > 0).any() and (up[:, 2] < 0).any()
    for run in runs_of(made, Kind.REVERSALS):
        ends = run.run.path.route.ends.q
        moved = np.abs(ends[:, 1] - ends[:, 0]) > 1e-9
        assert moved.sum(axis=1).max() == 1
        assert set(np.flatnonzero(moved.any(axis=0))) == set(run.candidate.study.joints)
        assert np.abs(run.run.trajectory.dq).max() < 0.06
    cruises = runs_of(made, Kind.CRUISES)
    assert {joint for run in cruises for joint in run.candidate.study.joints} == {0, 1, 2}
    for run in cruises:
        t, dq = run.run.trajectory.t, run.run.trajectory.dq
        assert (np.abs(dq) > 1e-3).sum(axis=1).max() == 1
        for joint in run.candidate.study.joints:
            begins, _ = spells(np.abs(dq[:, joint]) > 1e-3)
            tops = np.maximum.reduceat(dq[:, joint], begins)
            for rate in (0.15, 0.4, 1.2):  # KRL says whole percents.
                assert np.abs(tops - rate).min() < 0.04 * rate
            assert np.minimum.reduceat(dq[:, joint], begins).min() == pytest.approx(-1.2, abs=0.01)
        # What shows 0.14 s late has time to go while the last joint turns.
        _, lengths = spells(np.abs(dq[:, -1]) > 1e-3)
        assert lengths.min() * (t[1] - t[0]) > 0.4
    kinds = {run.candidate.kind for run in made.runs if run.topic is Topic.BLENDS}
    assert (Kind.CONTOURS in kinds) == (name.startswith("kuka"))
    assert {Kind.LINES, Kind.JOINTS, Kind.JOINTS_AND_ARCS, Kind.UNEQUAL_JOINTS} <= kinds
    for run in runs_of(made, Kind.UNEQUAL_JOINTS):
        speeds = [move.speed for move in run.program.moves[1:]]
        assert all(a != b for a, b in pairwise(speeds))
    (mixed,) = runs_of(made, Kind.JOINTS_AND_ARCS)
    assert {type(move) for move in mixed.program.moves} == {MoveJ, MoveC}
    (lines,) = runs_of(made, Kind.UNEQUAL_LINES)
    assert {type(move) for move in lines.program.moves[1:]} == {MoveL}


def test_contours_are_blended_by_their_shares() -> None:
    made = designed("kuka/kr30-3")
    (run,) = runs_of(made, Kind.CONTOURS)
    shares = {m.zone.fraction for m in run.program.moves if isinstance(m.zone, ContourFraction)}
    assert shares == {0.25, 0.5, 1.0} == {corner.share for corner in run.candidate.corners}
    assert "25 % 50 % 100 %" in page(made, None)


def test_a_strangers_vendor_is_served() -> None:
    """One whose controller drives otherwise, and whose language has no shares of contours."""
    kuka, other = find_vendor("kuka"), find_vendor("ur").motion()
    joint = MoveWords((Radius,), kuka.speaks.joint.speeds, kuka.speaks.joint.needs)
    stranger = replace(
        kuka, motion=lambda: other, robot_motion={}, speaks=replace(kuka.speaks, joint=joint)
    )
    plan = replace(SMALL, about=(Topic.REVERSALS, Topic.TURNS, Topic.BLENDS), turns=(1.0,))
    made = design(stranger, Cell(find_robot("kuka/kr30-3"), "kuka"), plan, bare=True)
    assert {run.topic for run in made.runs} == set(plan.about)
    assert Kind.CONTOURS not in {run.candidate.kind for run in made.runs}
    assert "limit.blend_acceleration" in runs_of(made, Kind.JOINTS)[0].figures


@given(
    length=st.floats(0.005, 0.3), turn=st.floats(math.radians(3), 1.2), room=st.floats(0.05, 0.5)
)
def test_short_legs_are_of_one_length_and_turn_and_stay_near(length, turn, room) -> None:
    points = _chain(length, turn, room)
    legs = np.diff(points, axis=0)
    assert np.linalg.norm(legs, axis=1) == pytest.approx(length, rel=1e-9)
    headings = np.arctan2(legs[:, 1], legs[:, 0])
    turns = [abs(math.remainder(b - a, 2 * math.pi)) for a, b in pairwise(headings)]
    assert turns == pytest.approx([turn] * len(turns), rel=1e-6)
    assert len(legs) >= 2
    assert np.linalg.norm(points, axis=1).max() <= max(room, length) * (1 + 1e-9)


@given(st.randoms(use_true_random=False), st.integers(2, 5))
def test_topics_take_turns_until_all_pairs_are_covered(random, count) -> None:
    topics = list(Topic)[:count]
    options = []
    for topic in topics:
        for k in range(random.randint(1, 4)):
            levels = frozenset(f"{topic}: {random.randint(0, 5)}" for _ in range(3))
            study = Study(topic, levels)
            name = f"{topic}{k}"
            told = CandidateRun(name, Kind.RESTS, 0, None, (), None, np.zeros(6), study)
            F = np.diag([random.uniform(0.1, 2.0) for _ in range(3)])
            options.append(Option(told, F, random.uniform(2, 20)))
    choice = RunChoice(options, Plan(about=tuple(topics), minutes=None))
    first = []
    while (taken := choice.best()) is not None:
        before = nats(choice.information)
        assert choice.take(taken) == pytest.approx(nats(choice.information) - before)
        first.append(taken.candidate.study.topic)
    assert set(first[:count]) == set(topics)  # none waits until another is through
    assert len(first) == len(options) and not choice.missing()


def test_short_legs_show_the_least_time_of_zones() -> None:
    plan = replace(SMALL, about=(Topic.SHORT_LEGS,), radii=(0.001,), speeds=(7.0,))
    made = designed("abb/irb6640-180-255", plan)
    (run,) = runs_of(made, Kind.SHORT_LEGS)
    assert {one.what for one in run.purpose.alternatives} >= {"zones take no least time"}
    (known,) = (one for one in made.precision if one.key == "zone.least_time_s")
    assert known.after < 0.2 * known.before


def test_keys_of_one_list_are_told_together() -> None:
    keys = ("servo.friction_rad[0]", "servo.friction_rad[2]", "zone.pace")
    assert grouped(keys) == "servo.friction_rad[0, 2], zone.pace"


def test_postures_are_more_where_they_are_the_question() -> None:
    plan = Plan(about=(Topic.POSTURES, Topic.TURNS))
    assert plan.posture_count == 8 and Plan().posture_count == 3
    assert plan.topics_at(0) == plan.about and plan.topics_at(7) == (Topic.POSTURES,)
    assert replace(plan, postures=5).topics_at(4) == plan.about
    with pytest.raises(OptionError, match="1 to 99"):
        replace(plan, postures=0)
