"""Rests at stops that end when the axes have been in position for a while; their derivatives."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st

from flyby.core.motion.emulator.controller import Controller
from flyby.core.motion.gradients.derivatives import Derivatives, ProgramGradient
from flyby.core.motion.model.motion_model import MotionModel
from flyby.core.motion.model.servo import Servo
from flyby.core.motion.timing.rests import InPosition, Rests
from flyby.core.motion.timing.timing import Timing
from flyby.core.program.move import Move, MoveC, MoveJ, MoveL, Wait
from flyby.core.program.program import Program
from flyby.core.program.speed import Speed
from flyby.core.program.target import JointTarget, PoseTarget
from flyby.core.program.zone import FINE, Fine, Radius, Zone
from flyby.core.registry import find_robot, find_vendor
from flyby.core.spatial.pose import Pose

ROBOT = find_robot("abb/irb6640-180-255")
ABB = find_vendor("abb")
HOME = np.array([0.1, 0.2, 0.1, 0.2, 0.5, 0.1])
START = JointTarget(tuple(HOME))
MOST = 0.1
WAITING = replace(ABB.motion(), smoothing=(0.05, 0.05, 0.05), settling=MOST)
MODEL = replace(WAITING, in_position=6e-3, in_position_time=0.15)
STEP = 2e-6


def there(*offset: float) -> PoseTarget:
    at = ROBOT.flange_pose(HOME)
    return PoseTarget(Pose(tuple(np.array(at.position) + offset), at.quaternion))


def speed(tcp: float) -> Speed:
    return Speed(tcp=tcp, reorientation=2.0)


def line(tcp: float, zone: Zone, *offset: float) -> MoveL:
    return MoveL(there(*offset), speed(tcp), zone)


def varied() -> Program:
    """Stops after fast and slow lines, an arc, joints, and after hardly moving at all."""
    moves: tuple[Move, ...] = (
        line(0.9, FINE, 0.0, 0.303, 0.0),
        line(0.06, Radius(0.02), 0.05, 0.35, 0.05),
        line(0.08, FINE, 0.15, 0.35, 0.1),
        MoveC(there(0.1, 0.1, 0.2), speed(0.1), FINE, via=there(0.2, 0.2, 0.2)),
        line(0.02, FINE, 0.1, 0.1, 0.199),
        line(0.005, FINE, 0.1, 0.1, 0.197),
        MoveJ(JointTarget((0.0, 0.3, 0.1, 0.1, 0.5, 0.2)), speed(0.07), FINE),
        line(0.5, FINE, 0.0, 0.0, 0.0),
    )
    return Program(moves, start=START)


def stamped(program: Program, model: MotionModel = MODEL) -> Timing:
    controller = Controller(ABB, ROBOT, model)
    return controller.stamp(program, controller.plan(program))


@st.composite
def programs(draw, most: float = 0.3) -> Program:
    """Lines and joint moves from crawling to fast, most of them to stops."""
    moves: list[Move] = []
    reach = st.floats(-most, most)
    for _ in range(draw(st.integers(2, 4))):
        told = speed(float(np.exp(draw(st.floats(np.log(0.01), np.log(1.0))))))
        zone = draw(st.sampled_from([FINE, FINE, Radius(0.02)]))
        if draw(st.booleans()):
            moves.append(MoveL(there(*(draw(reach) for _ in range(3))), told, zone))
        else:
            q = HOME + [draw(reach) for _ in range(6)]
            moves.append(MoveJ(JointTarget(tuple(map(float, q))), told, zone))
    return Program((*moves, line(0.4, FINE, 0.0, 0.1, 0.1)), start=START)


@st.composite
def models(draw) -> MotionModel:
    window = draw(st.floats(1e-4, 3e-2))
    return replace(MODEL, in_position=window, in_position_time=draw(st.floats(0.0, 0.4)))


def test_stops_of_all_kinds_are_met() -> None:
    """What the other tests are about: rests that are cut short, whole, none, and hardly a move."""
    timing = stamped(varied())
    length, entries = timing.rests.length, timing.rests.entries
    assert entries is not None
    assert length[0] == MOST and not timing.rests.counted[0]
    assert timing.rests.counted.sum() >= 3
    assert 0.0 in length
    assert len({k < 0 for k in entries.interval[timing.rests.counted]}) == 2


@settings(max_examples=25, deadline=None)
@given(program=programs(), model=models())
def test_rests_end_a_time_after_the_axes_came_into_the_window(program, model) -> None:
    timing = stamped(program, model)
    rests, stamp = timing.rests, timing.stamp
    assume(len(rests.knot) > 0)
    entries = rests.entries
    assert entries is not None
    assert ((rests.length >= 0.0) & (rests.length <= MOST)).all()
    left = model.in_position_time - (stamp.t[rests.knot] - entries.t)
    np.testing.assert_allclose(rests.length, np.clip(left, 0.0, MOST), atol=1e-12)
    ends = timing.path.pieces.interval_ends
    for i, stop in enumerate(rests.knot):
        place = timing.path.q[ends[stop - 1, 1]]
        late = timing.begin[stop - 1] - stamp.t[stop - 1]
        entered = float(entries.t[i])
        inside = np.linspace(entered, stamp.t[stop], 300)[:-1] + late
        away = np.abs(timing.states_at(inside)[0] - place).max(axis=1)
        if entries.interval[i] < 0:
            assert entered == stamp.t[entries.begin[i]]
            assert away[0] <= model.in_position + 1e-9
        else:
            assert away[0] == pytest.approx(model.in_position, abs=1e-9)
        # Between samples nothing is looked for.
        assert (away <= model.in_position * (1 + 1e-3) + 1e-9).all()


@settings(max_examples=25, deadline=None)
@given(program=programs(), model=models(), share=st.floats(0.05, 0.95))
def test_a_slower_approach_rests_no_longer(program, model, share) -> None:
    moves = tuple(
        replace(move, speed=replace(move.speed, tcp=share * move.speed.tcp))
        for move in program.moves
    )
    slower = stamped(program.with_moves(moves), model)
    faster = stamped(program, model)
    assert (slower.rests.length <= faster.rests.length + 1e-9).all()
    assert slower.duration >= faster.duration - 1e-9


@settings(max_examples=15, deadline=None)
@given(program=programs(), model=models(), share=st.floats(0.05, 1.0), rate=st.floats(0.1, 1.0))
def test_rests_of_slower_motions_are_foretold(program, model, share, rate) -> None:
    """A share of all speeds is driven like a program of those; where time runs, x is scaled."""
    at_once = stamped(program, model)
    controller = Controller(ABB, ROBOT, model)
    slower = controller.stamp_slower(program, at_once, share)
    moves = tuple(replace(move, speed=slowed(move.speed, share)) for move in program.moves)
    told = stamped(program.with_moves(moves), model)
    np.testing.assert_allclose(slower.begin, told.begin, rtol=1e-9, atol=1e-9)
    np.testing.assert_allclose(slower.rests.length, told.rests.length, atol=1e-9)
    of = slower.stamp
    stamp = replace(of, x=rate**2 * of.x, t=of.t / rate)
    waited = InPosition(model.in_position, model.in_position_time)
    late = Rests.of(slower.path.pieces, slower.along, stamp, slower.rests.most, waited)
    np.testing.assert_allclose(slower.rests.where_time_runs(rate), late.length, atol=1e-9)


def slowed(told: Speed, share: float) -> Speed:
    assert told.joint is None
    return replace(
        told,
        tcp=share * told.tcp,
        reorientation=share * told.reorientation,
        joint_fraction=share * told.joint_fraction,
    )


def test_without_a_window_all_rest_alike() -> None:
    base = Controller(ABB, ROBOT, WAITING).run(varied())
    assert (base.timing.rests.length == MOST).all()
    for change in (
        {"in_position_time": 0.15},
        {"in_position": 1e-9, "in_position_time": 1.0},
    ):
        same = Controller(ABB, ROBOT, replace(WAITING, **change)).run(varied())
        for mine, other in zip(
            (base.timing.begin, base.timing.end, base.trajectory.t, base.trajectory.q),
            (same.timing.begin, same.timing.end, same.trajectory.t, same.trajectory.q),
            strict=True,
        ):
            np.testing.assert_array_equal(mine, other)


def test_the_time_is_what_averages_reach_over_if_none_is_stated() -> None:
    smoothed = replace(MODEL, in_position_time=None, ramp=0.03)
    stated = replace(smoothed, in_position_time=sum(MODEL.smoothing) + 0.03)
    lengths = [stamped(varied(), model).rests.length for model in (smoothed, stated)]
    np.testing.assert_array_equal(*lengths)
    assert len(set(lengths[0])) == 3 and lengths[0].max() == MOST


def test_no_stop_has_no_rest_and_nothing_to_wait_for_none_either() -> None:
    through = Program((line(0.1, Radius(0.02), 0.0, 0.3, 0.0), line(0.1, FINE, 0.2, 0.3, 0.0)))
    assert len(stamped(through).rests.length) == 0
    at_once = replace(MODEL, in_position_time=0.0)
    assert (stamped(varied(), at_once).rests.length == 0.0).all()


@settings(max_examples=15, deadline=None)
@given(program=programs(), wait=st.floats(0.0, 0.3), seed=st.integers(0, 1000))
def test_only_programmed_stops_wait_for_servos(program, wait, seed) -> None:
    rng, stop = np.random.default_rng(seed), Fine(programmed=False)
    moves = tuple(
        replace(move, zone=stop) if move.zone == FINE and rng.random() < 0.5 else move
        for move in program.moves
    )
    waiting = replace(WAITING, servo=Servo(rest=wait))
    here, before = (stamped(program.with_moves(moves), model) for model in (waiting, WAITING))
    stops = [zone for zone in here.path.route.zones if isinstance(zone, Fine)]
    longer = here.rests.length - before.rests.length
    np.testing.assert_allclose(longer, [wait * zone.programmed for zone in stops], atol=1e-12)
    assert here.duration == pytest.approx(before.duration + longer.sum())


def test_a_programmed_wait_comes_on_top() -> None:
    plain = varied()
    waits = replace(plain, statements=(*plain.moves[:3], Wait(0.25), *plain.moves[3:]))
    first, second = stamped(plain), stamped(waits)
    np.testing.assert_array_equal(first.rests.length, second.rests.length)
    assert second.duration == pytest.approx(first.duration + 0.25)


@pytest.mark.parametrize("index", range(8))
def test_derivatives_hold_on_stops_of_all_kinds(index) -> None:
    """By every number of a move, one after the other, of the cycle time and of a configuration."""
    program = varied()
    moves = list(program.moves)
    checks = [(lambda h: replace(moves[index], speed=speed(moves[index].speed.tcp + h)), "speed")]
    target = moves[index].target
    for axis in range(3):
        if isinstance(target, PoseTarget):
            checks.append((_moved(moves[index], target, axis), axis))
        else:
            checks.append((_turned(moves[index], target, axis), axis))
    for make, what in checks:

        def along(h: float, make=make) -> Program:
            return program.with_moves((*moves[:index], make(h), *moves[index + 1 :]))

        def exact(gradient, what=what) -> float:
            if what == "speed":
                return float(gradient.speed.tcp[index])
            told = gradient.position if isinstance(target, PoseTarget) else gradient.joints
            return float(told[index, what])

        Quotients(along, MODEL, 0.6).check(exact)


def _moved(move: Move, target: PoseTarget, axis: int):
    def make(h: float) -> Move:
        at = tuple(np.array(target.pose.position) + h * np.eye(3)[axis])
        return replace(move, target=PoseTarget(Pose(at, target.pose.quaternion)))

    return make


def _turned(move: Move, target: JointTarget, axis: int):
    return lambda h: replace(
        move, target=JointTarget(tuple(np.array(target.joints) + h * np.eye(6)[axis]))
    )


class Quotients:
    """Difference quotients of the cycle time and of a configuration, and the derivatives."""

    weights = np.array([1.0, 0.5, -0.3, 0.2, 0.7, -0.4])

    def __init__(self, along: Callable[[float], Program], model: MotionModel, share: float) -> None:
        self.along, self.model = along, model
        self.timing = stamped(along(0.0), model)
        self.t = share * self.timing.duration

    def values(self, h: float) -> np.ndarray:
        made = stamped(self.along(h), self.model)
        return np.array([made.duration, made.states_at(np.array([self.t]))[0][0] @ self.weights])

    def at(self, step: float) -> np.ndarray:
        return (self.values(step) - self.values(-step)) / (2 * step)

    def check(self, exact: Callable[[ProgramGradient], float]) -> None:
        made = Derivatives(self.along(0.0), self.timing)
        told = [made.duration(), made.configuration_at(self.t, self.weights)]
        np.testing.assert_allclose([*map(exact, told)], self.at(STEP), rtol=2e-5, atol=2e-5)


@settings(max_examples=20, deadline=None)
@given(program=programs(), model=models(), seed=st.integers(0, 10_000), share=st.floats(0.2, 0.9))
def test_derivatives_hold_in_any_direction(program, model, seed, share) -> None:
    rng = np.random.default_rng(seed)
    turn, pace, wide = rng.normal(size=(len(program.moves), 6)), rng.normal(), rng.normal()

    def along(h: float) -> Program:
        made = []
        for move, d in zip(program.moves, turn, strict=True):
            target = move.target
            if isinstance(target, PoseTarget):
                at = tuple(np.array(target.pose.position) + h * d[:3])
                target = PoseTarget(Pose(at, target.pose.quaternion))
            else:
                target = JointTarget(tuple(np.array(target.joints) + h * d))
            zone = Radius(0.02 + 0.1 * h * wide) if isinstance(move.zone, Radius) else FINE
            told = speed(move.speed.tcp * (1 + h * pace))
            made.append(replace(move, target=target, zone=zone, speed=told))
        return program.with_moves(tuple(made))

    def exact(gradient) -> float:
        total = np.sum(gradient.position * turn[:, :3]) + np.sum(gradient.joints * turn)
        total += (
            0.1
            * wide
            * sum(
                part
                for part, move in zip(gradient.zone, program.moves, strict=True)
                if isinstance(move.zone, Radius)
            )
        )
        paces = np.array([move.speed.tcp for move in program.moves])
        return float(total + pace * np.sum(gradient.speed.tcp * paces))

    found = Quotients(along, model, share)
    # A move that goes nowhere would go somewhere.
    assume(len(found.timing.path.route.moves) == len(program.moves))
    near, far = found.at(STEP), found.at(3 * STEP)
    # Where they differ a limit, or an axis, takes the place of another one.
    assume((np.abs(near - far) < 1e-5 * (1 + np.abs(near))).all())
    found.check(exact)
