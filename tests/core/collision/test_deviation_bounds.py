"""Bounds of how far links are off a path, against motions driven at many speeds."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import Phase, assume, given, settings
from hypothesis import strategies as st

from flyby.core.collision.deviation import bounds as bounds_module
from flyby.core.collision.deviation.bounds import (
    Deviation,
    DeviationBounds,
    by_interval,
    deviation_bounds,
    parts_of,
)
from flyby.core.errors import MotionError
from flyby.core.motion.emulator.controller import Controller
from flyby.core.motion.emulator.run import Run
from flyby.core.motion.model.elasticity import Carried, Coupled, Elasticity
from flyby.core.motion.model.motion_model import MotionModel
from flyby.core.motion.model.servo import Servo
from flyby.core.motion.model.torque import Borne, Torque
from flyby.core.motion.timing.rests import InPosition
from flyby.core.motion.timing.timing import Settling, Timing
from flyby.core.program.move import MoveJ, MoveL
from flyby.core.program.program import Program
from flyby.core.program.speed import Speed
from flyby.core.program.target import JointTarget, PoseTarget
from flyby.core.program.zone import FINE, Radius
from flyby.core.registry import find_robot, find_vendor
from flyby.core.spatial.pose import Pose

ROBOT = find_robot("abb/irb6640-180-255")
ABB = find_vendor("abb")
HOME = np.array([0.1, 0.2, 0.3, 0.2, 0.9, 0.1])
GEARS = Elasticity(
    (0.0, 1e-4, 5e-5),
    (Carried(3, (3e-5, 7e-5)), Carried(5, (1e-4, 5e-5, -2e-5))),
    slack=(9e-5, 1e-5),
)
LOADED = replace(
    GEARS,
    coupled=(Coupled(3, 1, 0.3), Coupled(1, 2, -0.2), Coupled(5, 1, -1.0)),
    slack=(1.5e-4, 2e-4, 1e-4),
    weight=(0.0, 2.0, 1.0),
    spring=(0.0, 3e-3),
)
LATE = Elasticity(lag=(1e-3, 0.0, -2e-3))
DRAGGED = Servo((1e-4, -1e-4), drag=(-3e-3, 2e-3, 0.0, 1e-3), drag_speed=0.2, drag_delay=0.1)
RUBBING = Servo((-2e-3, 3e-3, 0.0, 0.0, 1e-3))
WEAK = Torque((0.03, 0.05, 0.09), (Borne(5, (0.03, 0.03)),), fade=(0.2, 0.1))
SPEED = Speed(tcp=2.0, reorientation=6.0)
DIRECTIONS = np.concatenate([np.eye(6), np.random.default_rng(3).normal(size=(20, 6))])
DIRECTIONS = np.concatenate([DIRECTIONS, -DIRECTIONS])
PLACES = 3_000

MODELS = {
    "one average": MotionModel(smoothing=(0.06,)),
    "cascade": MotionModel(smoothing=(0.04, 0.04, 0.03)),
    "short settling": MotionModel(smoothing=(0.05, 0.05), settling=0.02),
    "short settling, in position": MotionModel(
        smoothing=(0.05, 0.05), settling=0.08, in_position=0.05, in_position_time=0.12
    ),
    "ramp": MotionModel(smoothing=(0.04, 0.04), ramp=0.04),
    "in position, elastic": MotionModel(
        smoothing=(0.05, 0.05), ramp=0.02, settling=0.1, in_position=6e-3, elasticity=LOADED
    ),
    "ramp, short settling": MotionModel(smoothing=(0.05, 0.04), ramp=0.05, settling=0.03),
    "elastic": MotionModel(smoothing=(0.04, 0.03), elasticity=GEARS),
    "elastic, loaded": MotionModel(smoothing=(0.04, 0.03), elasticity=LOADED),
    "elastic, weak": MotionModel(smoothing=(0.03, 0.03), elasticity=GEARS, torque=WEAK),
    "elastic, slow start": MotionModel(smoothing=(0.04,), elasticity=GEARS, start_ramp=0.1),
    "lag": MotionModel(smoothing=(0.03,), elasticity=LATE),
    "lag, ramp": MotionModel(smoothing=(0.04, 0.03), ramp=0.03, elasticity=LATE),
    "lag, slow start": MotionModel(smoothing=(0.04,), elasticity=LATE, start_ramp=0.1),
    "lag, unsmoothed": MotionModel(elasticity=LATE),
    "friction": MotionModel(servo=RUBBING),
    "friction, lag": MotionModel(
        smoothing=(0.05, 0.05), settling=0.05, elasticity=LATE, servo=RUBBING
    ),
    "drag": MotionModel(smoothing=(0.04, 0.03), servo=DRAGGED),
    "drag, ramp, lag": MotionModel(smoothing=(0.04,), ramp=0.03, elasticity=LATE, servo=DRAGGED),
    "drag, unsmoothed": MotionModel(servo=DRAGGED),
    "fitted": ABB.motion_of(ROBOT),
}


@st.composite
def programs(draw, most: float = 0.35) -> Program:
    """Joint moves and lines round small and wide corners, with and without stops."""
    tcp = ROBOT.flange_pose(HOME)
    changes, zones = st.floats(-most, most), st.sampled_from([FINE, Radius(0.01), Radius(0.08)])
    moves: list[MoveJ | MoveL] = []
    for _ in range(draw(st.integers(2, 3))):
        if draw(st.booleans()):
            q = HOME + [draw(changes) for _ in range(6)]
            moves.append(MoveJ(JointTarget(tuple(map(float, q))), SPEED, zone=draw(zones)))
        else:
            place = np.array(tcp.position) + [draw(changes) for _ in range(3)]
            target = PoseTarget(Pose(tuple(map(float, place)), tcp.quaternion))
            moves.append(MoveL(target, SPEED, zone=draw(zones)))
    moves[-1] = replace(moves[-1], zone=FINE)
    return Program(tuple(moves), start=JointTarget(tuple(map(float, HOME))))


def at_speed(program: Program, share: float) -> Program:
    speed = Speed(tcp=2.0 * share, reorientation=6.0 * share, joint_fraction=share)
    return program.with_moves(tuple(replace(move, speed=speed) for move in program.moves))


def in_slow_time(controller: Controller, run: Run, rate: float) -> Run:
    """A run as it is where time runs at a rate, but that of what is waited for at stops."""
    of, model, window = run.timing, controller.model, controller.smoothing(run.program, run.path)
    late = window.window + of.ramp
    named = model.in_position_time
    waited = InPosition(model.in_position, late if named is None else named)
    stop = late if model.settling is None else min(model.settling, late)
    settling = Settling(stop, late, of.ramp, of.start, waited if model.in_position else None)
    slowed = replace(of.stamp, x=rate**2 * of.stamp.x, t=of.stamp.t / rate)
    timing = Timing.of(of.path, of.limits, of.along, of.path_limits, slowed, settling)
    return replace(run, timing=timing, trajectory=controller.sample(run.program, timing, 0.03))


def places(run: Run) -> tuple[np.ndarray, np.ndarray]:
    """Configurations and σ all along a path; stops count once."""
    t = np.linspace(0.0, run.timing.end[-1], PLACES)
    q, sigma = run.timing.states_at(t)[0], run.timing.place_at(run.timing.start.driven(t))
    moving = np.concatenate([[True], np.diff(sigma) > 0.0])
    return q[moving], sigma[moving]


def excess(deviations: DeviationBounds, path_q: np.ndarray, sigma: np.ndarray, run: Run) -> float:
    """By how much (rad) links are beyond the bounds at the best place on the path.

    In every direction n, n · (links − path) is at most what the ways and the rest allow.
    """
    step = np.abs(np.diff(path_q, axis=0, append=path_q[-1:]) @ DIRECTIONS.T)
    row = by_interval(deviations, sigma, sigma).own
    along = np.einsum("cwn,dn->cdw", deviations.ways[row], DIRECTIONS)
    bound = np.maximum(along * deviations.share[row][:, None, :, 1], 0.0)
    bound = np.maximum(bound, along * deviations.share[row][:, None, :, 0]).sum(axis=2)
    bound += deviations.rest[row] @ np.abs(DIRECTIONS).T + step
    made = run.trajectory
    worst = -np.inf
    for q, middle in zip(made.q, made.sigma, strict=True):
        near = slice(*np.searchsorted(sigma, [middle - 0.15, middle + 0.15]))
        signed = (q - path_q[near]) @ DIRECTIONS.T - bound[near]
        assert signed.size
        worst = max(worst, float(signed.max(axis=1).min()))
    return worst


@pytest.mark.parametrize("name", sorted(MODELS))
@settings(max_examples=1, deadline=None, phases=[Phase.reuse, Phase.generate])
@given(data=st.data())
def test_no_motion_at_any_speed_deviates_further_than_is_reckoned(name, data) -> None:
    program = data.draw(programs())
    controller = Controller(ABB, ROBOT, MODELS[name])
    share = data.draw(st.floats(0.1, 0.9))
    try:
        run = controller.run(at_speed(program, 1.0), period=0.03)
        slower = controller.run(at_speed(program, share), period=0.03)
    except MotionError:
        assume(False)
    path_q, sigma = places(run)
    bands = deviation_bounds(controller, run)
    for driven in (run, slower):
        assert min(excess(deviations, path_q, sigma, driven) for deviations in bands) < 2e-6


def test_what_gears_give_way_by_costs_nothing() -> None:
    """Motors are ahead by as much; the links are where smoothing leaves them."""
    model = MODELS["in position, elastic"]
    moves = (
        MoveJ(JointTarget(tuple(map(float, HOME + change))), SPEED, zone)
        for change, zone in ((0.3, Radius(0.05)), (np.array([0.3, 0.0, 0.2, 0.0, -0.4, 0.1]), FINE))
    )
    program = Program(tuple(moves), start=JointTarget(tuple(map(float, HOME))))
    found = []
    for one in (model, replace(model, elasticity=Elasticity())):
        controller = Controller(ABB, ROBOT, one)
        found.append(deviation_bounds(controller, controller.run(program, period=0.03)))
    for soft, stiff in zip(*found, strict=True):
        np.testing.assert_array_equal(soft.most, stiff.most)


@pytest.mark.parametrize("name", ["fitted", "lag, ramp", "short settling", "cascade"])
def test_parts_of_a_path_are_left_as_far_as_when_all_of_it_is_looked_at(name, monkeypatch) -> None:
    tcp = ROBOT.flange_pose(HOME)
    steps = np.array([[0, -0.3, 0], [0.2, 0, 0], [0, 0.3, 0.1], [-0.2, 0, 0], [0, 0, 0.1]])
    places = np.array(tcp.position) + np.cumsum(np.concatenate([steps, -steps]), axis=0)
    zones = [Radius(0.02), Radius(0.08), FINE, Radius(0.01), FINE] * 2
    moves = [
        MoveL(PoseTarget(Pose(tuple(map(float, at)), tcp.quaternion)), SPEED, zone=zone)
        for at, zone in zip(places, zones, strict=True)
    ]
    program = Program(tuple(moves), start=JointTarget(tuple(map(float, HOME))))
    controller = Controller(ABB, ROBOT, MODELS[name])
    run = controller.run(program, period=0.03)
    whole = deviation_bounds(controller, run)
    monkeypatch.setattr(bounds_module, "_TOGETHER", 40)
    parts, first_interval = list(parts_of(run.path)), run.path.pieces.first_interval
    assert len(parts) > 5 and parts[-1][1] == len(first_interval) - 1
    deviation_of_run = Deviation.of(controller, run)
    for first, last in parts:
        inside = np.linspace(*run.path.pieces.edge[[first, last]], 60)[1:-1]
        made = deviation_of_run.over(int(first_interval[first]), int(first_interval[last]))
        for one, all_of_it in zip(made, whole, strict=True):
            found, wanted = (by_interval(s, inside, inside).most for s in (one, all_of_it))
            np.testing.assert_allclose(found, wanted, rtol=1e-6, atol=1e-9)


WAITING = {
    "fitted": replace(ABB.motion_of(ROBOT), settling=0.1, in_position=6e-3),
    "loaded": MODELS["in position, elastic"],
    "long window": MotionModel(smoothing=(0.05, 0.03), in_position=0.03, elasticity=GEARS),
    "lag": MotionModel(smoothing=(0.06, 0.05), in_position=0.01, elasticity=LATE),
}


@pytest.mark.parametrize("name", sorted(WAITING))
@settings(max_examples=1, deadline=None, phases=[Phase.reuse, Phase.generate])
@given(data=st.data())
def test_no_motion_deviates_further_however_little_it_rests(name, data) -> None:
    """Crawling moves, an override of time, and both; each within one and the same bounds."""
    program = data.draw(programs(0.04))
    controller = Controller(ABB, ROBOT, WAITING[name])
    shares = [data.draw(st.floats(*ends)) for ends in ((0.01, 0.05), (0.05, 0.15), (0.1, 1.0))]
    rates = [data.draw(st.floats(*ends)) for ends in ((0.1, 0.7), (0.7, 1.0))]
    try:
        run = controller.run(at_speed(program, 1.0), period=0.01)
        slower = [controller.run(at_speed(program, share), period=0.03) for share in shares]
    except MotionError:
        assume(False)
    slower += [in_slow_time(controller, made, rate) for made in (run, slower[-1]) for rate in rates]
    path_q, sigma = places(run)
    bands = deviation_bounds(controller, run)
    assert len(bands) in (1, 3)
    for driven in (run, *slower):
        assert min(excess(deviations, path_q, sigma, driven) for deviations in bands) < 2e-6
