"""Tuned motions: known answers, ways that agree, limits that hold."""

from __future__ import annotations

import math
from dataclasses import replace
from itertools import pairwise

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.integrate import solve_ivp

from flyby.core.errors import InputError
from flyby.core.motion.model.consumption import Motors, SquaredTorque
from flyby.core.motion.timing.energy import by_load, loads_of
from flyby.core.motion.timing.stamping import StandingStillError
from flyby.problems.free_motion.velocity_tuning import (
    FixedPath,
    JointDrive,
    Rigid,
    TorqueCurve,
    TuningError,
    TuningObjective,
    TuningTask,
    Way,
    drives_of,
    tune,
    tune_by_cones,
    tune_by_sweeps,
    tune_in_sequence,
)

from .tuning_paths import graded, scene, slider

SIZES = st.floats(0.2, 5.0)


def limited(*torque: float) -> tuple[JointDrive, ...]:
    return tuple(JointDrive(TorqueCurve.constant(value)) for value in torque)


# ------------------------------------------------------------------ known answers


@given(SIZES, SIZES, SIZES)
@settings(max_examples=8, deadline=None)
def test_bang_bang(distance, inertia, torque):
    """2 √(d I / τ): all torque forth, all torque back."""
    task = TuningTask(slider(distance, 40, inertia), limited(torque))
    wanted = 2.0 * math.sqrt(distance * inertia / torque)
    assert tune(task).way is Way.SWEEPS
    for found in (tune_by_sweeps(task), tune_by_cones(task)):
        assert found.duration == pytest.approx(wanted, rel=2e-3)


@given(SIZES, SIZES, st.floats(0.2, 1.0))
@settings(max_examples=8, deadline=None)
def test_weight_helps_one_way(distance, torque, share):
    """With gravity torque c the arm has τ − c forth and τ + c back."""
    held = -share * 0.9 * torque
    up, down = torque - held, torque + held
    task = TuningTask(slider(distance, 40, held=held), limited(torque))
    top = math.sqrt(2.0 * distance / (1.0 / up + 1.0 / down))
    assert tune(task).duration == pytest.approx(top / up + top / down, rel=2e-2)


def test_cubic_takes_least_squared_torque():
    """Rest to rest within T the least ∫ q̈² dt is 12 d² / T³, by a cubic in time."""
    task = TuningTask(slider(2.0, 150, 3.0), objective=TuningObjective(0.0, duration=1.7))
    found = tune(task)
    assert found.way is Way.CONVEX
    assert found.duration == pytest.approx(1.7, rel=1e-5)
    assert found.energy == pytest.approx(12.0 * 3.0**2 * 2.0**2 / 1.7**3, rel=2e-3)


def test_jerk_alone():
    """Four quarters of full jerk: (32 d / J)^⅓."""
    found = tune(TuningTask(slider(2.0, 300), jerk=np.array([50.0])))
    assert found.way is Way.SEQUENTIAL
    assert found.duration == pytest.approx((32.0 * 2.0 / 50.0) ** (1 / 3), rel=5e-3)
    assert np.abs(found.jerk).max() <= 50.0 * (1 + 1e-6)


def test_viscous_friction():
    """v' = (τ − f v) / I forth, −(τ + f v) / I back, integrated beside."""
    distance, torque, friction = 2.0, 5.0, 2.5
    task = TuningTask(
        slider(distance, 300), (JointDrive(TorqueCurve.constant(torque), viscous=friction),)
    )
    found = tune(task)
    assert found.way is Way.SEQUENTIAL
    wanted = beside(lambda v: torque - friction * v, lambda v: torque + friction * v, distance)
    assert found.duration == pytest.approx(wanted, rel=3e-3)
    assert found.excess < 1e-6


def test_falling_torque():
    """v' = T(v) forth and −T(v) back, integrated beside."""
    curve = TorqueCurve((0.0, 0.5, 1.0, 2.0), (4.0, 4.0, 2.0, 1.0))
    found = tune(TuningTask(slider(2.0, 300), (JointDrive(curve),)))

    def most(v):
        return float(curve.at(np.array(v)))

    assert found.duration == pytest.approx(beside(most, most, 2.0), rel=3e-3)
    assert found.excess < 1e-6


def beside(forth, back, distance) -> float:
    """Time of full torque forth and back, by integration over the speed: dt = dv / a."""

    def along(rise, top):
        sol = solve_ivp(
            lambda v, y: [1.0 / rise(v), v / rise(v)], (0.0, top), [0.0, 0.0], rtol=1e-9
        )
        return sol.y[:, -1]

    def to(top):
        return along(forth, top) + along(back, top)

    low, high = 0.0, 100.0
    while forth(high) <= 0.0 or to(high)[1] > distance:
        high *= 0.9
    high /= 0.9
    for _ in range(60):
        middle = 0.5 * (low + high)
        within = forth(middle) > 1e-9 and to(middle)[1] <= distance
        low, high = (middle, high) if within else (low, middle)
    return float(to(low)[0])


# ------------------------------------------------------------------ ways that agree


@given(st.floats(1.02, 3.0))
@settings(max_examples=4, deadline=None)
def test_sweeps_and_cones_agree_on_an_arm(room):
    path = scene()[3]
    drives = limited(*(room * np.abs(path.rigid.c).max(axis=(0, 1)) + 1.0))
    task = TuningTask(path, drives)
    swept, solved = tune_by_sweeps(task), tune_by_cones(task)
    assert swept.duration == pytest.approx(solved.duration, rel=1e-3)
    assert max(swept.excess, solved.excess) < 1e-6


def test_a_sequence_ends_where_one_program_does():
    """With hardly any friction, or a jerk far off, the sequence is the convex program."""
    path = scene()[3]
    most = 1.3 * np.abs(path.rigid.c).max(axis=(0, 1)) + 10.0
    plain = tune(TuningTask(path, limited(*most)))
    rubbed = tune(
        TuningTask(path, tuple(JointDrive(TorqueCurve.constant(v), viscous=1e-7) for v in most))
    )
    jerked = tune(TuningTask(path, limited(*most), jerk=np.full(6, 1e7)))
    for found in (rubbed, jerked):
        assert found.way is Way.SEQUENTIAL
        assert found.duration == pytest.approx(plain.duration, rel=1e-3)
    wanted = TuningObjective(0.4)
    convex = tune(TuningTask(path, limited(*most), objective=wanted))
    sequence = tune_in_sequence(
        TuningTask(
            path,
            tuple(JointDrive(TorqueCurve.constant(v), viscous=1e-7) for v in most),
            objective=wanted,
        )
    )
    assert sequence.energy == pytest.approx(convex.energy, rel=5e-3)
    assert sequence.duration == pytest.approx(convex.duration, rel=5e-3)


def test_all_ways_agree_where_all_apply():
    """Time alone by all three; energy on a DC link by the two that know it."""
    path = scene()[3]
    most = 1.3 * np.abs(path.rigid.c).max(axis=(0, 1)) + 10.0
    plain = TuningTask(path, limited(*most))
    times = [way(plain).duration for way in (tune_by_sweeps, tune_by_cones, tune_in_sequence)]
    assert times == pytest.approx([times[0]] * 3, rel=1e-3)
    for share in (0.0, 0.6, 1.0):
        motors = TuningObjective(0.5, Motors((1e-5,) * 6, share))
        task = TuningTask(path, limited(*most), objective=motors)
        one, many = tune_by_cones(task), tune_in_sequence(task)
        assert (one.way, many.way) == (Way.CONVEX, Way.SEQUENTIAL)
        assert many.duration == pytest.approx(one.duration, rel=5e-3)
        assert many.energy == pytest.approx(one.energy, rel=5e-3)


def test_toppra_agrees():
    """Another implementation of the same problem, on the same samples."""
    constraint = pytest.importorskip("toppra.constraint")
    algorithm = pytest.importorskip("toppra.algorithm")
    toppra = pytest.importorskip("toppra")
    points = np.array([[0.0, 0.0], [0.8, -0.4], [0.3, 0.9], [1.2, 1.1]])
    spline = toppra.SplineInterpolator(np.linspace(0, 1, 4), points)
    knots = np.linspace(0.0, 1.0, 401)
    velocity, acceleration = np.array([1.5, 2.0]), np.array([4.0, 6.0])
    peer = algorithm.TOPPRA(
        [
            constraint.JointVelocityConstraint(velocity),
            constraint.JointAccelerationConstraint(
                acceleration, discretization_scheme=constraint.DiscretizationType.Interpolation
            ),
        ],
        spline,
        gridpoints=knots,
    )
    rate = peer.compute_parameterization(0.0, 0.0)[1]
    theirs = float(np.sum(2.0 * np.diff(knots) / (rate[1:] + rate[:-1])))
    ends = np.stack([knots[:-1], knots[1:]], -1)
    dq, ddq = spline(ends.ravel(), 1), spline(ends.ravel(), 2)
    dq, ddq = (part.reshape(400, 2, 2) for part in (dq, ddq))
    from flyby.core.motion.timing.stamping import joint_limits

    path = FixedPath(
        joint_limits(np.diff(knots), dq, ddq, velocity, -acceleration, acceleration), dq, ddq
    )
    assert tune_by_cones(TuningTask(path)).duration == pytest.approx(theirs, rel=1e-3)


# ------------------------------------------------------------------ laws


@given(st.floats(1.3, 4.0), st.floats(0.0, 1.0))
@settings(max_examples=4, deadline=None)
def test_torque_and_time_scale(factor, weight):
    """All torques times s², time divided by s: the same motion."""
    objective = TuningObjective(weight, duration=4.0)
    one = tune(TuningTask(slider(1.0, 60), limited(2.0), objective=objective))
    other = tune(
        TuningTask(
            slider(1.0, 60),
            limited(2.0 * factor**2),
            objective=replace(objective, duration=4.0 / factor),
        )
    )
    assert other.duration == pytest.approx(one.duration / factor, rel=2e-3)
    assert other.energy == pytest.approx(one.energy * factor**3, rel=1e-2)


def test_more_time_never_costs_more():
    path = scene()[3]
    fastest = tune(TuningTask(path))
    energies = [
        tune(
            TuningTask(path, objective=TuningObjective(0.0, duration=share * fastest.duration))
        ).energy
        for share in (1.0001, 1.02, 1.1, 1.3, 2.0, 4.0)
    ]
    assert all(b <= a * (1 + 1e-6) for a, b in pairwise(energies))
    assert energies[0] <= fastest.energy * (1 + 1e-6)
    assert energies[-1] == pytest.approx(energies[-2], rel=1e-4)


def test_no_time_to_lose():
    """Where only the fastest motion is short enough, it is the answer."""
    path = scene()[3]
    fastest = tune(TuningTask(path))
    found = tune(TuningTask(path, objective=TuningObjective(0.0, duration=fastest.duration)))
    assert found.x == pytest.approx(fastest.x)


def test_weights_order_the_motions():
    path = scene()[3]
    found = [tune(TuningTask(path, objective=TuningObjective(w))) for w in (1.0, 0.5, 0.0)]
    assert found[0].duration < found[1].duration < found[2].duration
    assert found[0].energy > found[1].energy > found[2].energy
    assert all(motion.excess < 1e-6 for motion in found)
    assert sum(found[1].energy_by_joint) == pytest.approx(found[1].energy)


def test_recuperation_pays():
    """The more is given back, the less is taken, and the faster the best motion is."""
    path, copper = scene()[3], (1e-5,) * 6
    found = [
        tune(TuningTask(path, objective=TuningObjective(0.0, Motors(copper, share))))
        for share in (0.0, 0.3, 0.7, 1.0)
    ]
    for less, more in pairwise(found):
        assert more.energy < less.energy
        assert more.duration < less.duration


def test_an_energy_that_nearly_cancels_weighs_no_more_than_others():
    """What the fastest motion takes passes zero at η = 0.674; its share of the price does not."""
    path = scene()[3]
    found = [
        tune(TuningTask(path, objective=TuningObjective(0.5, Motors((), share))))
        for share in (0.5, 0.674, 1.0)
    ]
    fastest = tune(TuningTask(path, objective=TuningObjective(1.0, Motors((), 0.674))))
    assert abs(fastest.energy) < 1e-2 * fastest.flow
    assert found[0].duration > found[1].duration > found[2].duration


@given(st.sampled_from([0.0, 0.4, 1.0]), st.floats(1.05, 2.0))
@settings(max_examples=4, deadline=None)
def test_no_other_motion_takes_less(share, slower):
    """Neither the fastest motion slowed down nor a mean of it and the best one is better."""
    path, motors = scene()[3], Motors((1e-5,) * 6, share)
    fastest = tune(TuningTask(path, objective=TuningObjective(1.0, motors)))
    bound = slower * fastest.duration
    best = tune(TuningTask(path, objective=TuningObjective(0.0, motors, bound)))
    room = 5e-3 * abs(fastest.energy)
    for other in (fastest.x / slower**2, 0.5 * (fastest.x + best.x)):
        assert best.energy <= replace(best, x=other).energy + room


def _torque_between(found, controller, program, timing) -> np.ndarray:
    """(T, N) N m of the motors every ms, between knots too."""
    own = found.timing(timing)
    t = np.arange(5e-4, own.duration, 1e-3)
    q, dq, ddq = own.states_at(t)
    interval = np.clip(np.searchsorted(own.begin, t, "right") - 1, 0, None)
    torque = np.empty_like(q)
    for load, rows in by_load(loads_of(program, timing.path), own.interval_segments[interval]):
        torque[rows] = controller.robot.inverse_dynamics(q[rows], dq[rows], ddq[rows], load)
    for j, drive in enumerate(found.task.drives):
        torque[:, j] += drive.inertia * ddq[:, j] + drive.viscous * dq[:, j]
        torque[:, j] += drive.coulomb * np.sign(dq[:, j])
    return torque


def test_torque_limits_hold_between_knots():
    controller, program, timing, path = scene()
    most = 1.2 * np.abs(path.rigid.c).max(axis=(0, 1)) + 50.0
    found = tune(TuningTask(path, limited(*most)))
    between = np.abs(_torque_between(found, controller, program, timing)) / most
    assert between.max() < 1.001


def test_tuned_timing_is_a_timing():
    """A tuned motion put in the place of the stamp has its duration and its energy."""
    controller, program, timing, path = scene()
    found = tune(TuningTask(path, objective=TuningObjective(0.3)))
    own = found.timing(timing)
    assert own.duration == pytest.approx(found.duration)
    assert controller.energy(program, own).value == pytest.approx(found.energy, rel=1e-9)


def test_kinematic_optimum_is_the_emulators():
    """What the emulator drives is what velocity tuning calls the fastest."""
    _, _, timing, path = scene()
    assert tune(TuningTask(path)).duration == pytest.approx(timing.stamp.duration, rel=1e-12)


def test_weighted_torques():
    path = scene()[3]
    only_second = SquaredTorque((0.0, 1.0, 0.0, 0.0, 0.0, 0.0))
    found = tune(TuningTask(path, objective=TuningObjective(0.0, only_second)))
    plain = tune(TuningTask(path, objective=TuningObjective(0.0)))
    by_second = plain.energy_by_joint[1]
    assert found.energy <= by_second * (1 + 1e-6)


# ------------------------------------------------------------------ refusals


def test_standing_still_is_refused_by_name():
    path = scene()[3]
    most = np.full(6, 1e5)
    most[2] = 0.5 * np.abs(path.rigid.c[..., 2]).max()
    with pytest.raises(StandingStillError, match=r"joint J3 needs .* N m to hold the arm still"):
        TuningTask(path, limited(*most))


def test_too_short_a_time_is_refused():
    path = slider(1.0, 40, velocity=1.0)
    for weight in (1.0, 0.0):
        with pytest.raises(TuningError, match=r"s at least|within all limits"):
            tune(TuningTask(path, objective=TuningObjective(weight, duration=0.5)))


def test_ways_refuse_what_they_do_not_know():
    path = slider(1.0, 20)
    with pytest.raises(InputError, match="sweeps know neither"):
        tune_by_sweeps(TuningTask(path, objective=TuningObjective(0.5)))
    with pytest.raises(InputError, match="sequence"):
        tune_by_cones(TuningTask(path, jerk=np.ones(1)))


def test_unknown_inertias_are_refused():
    path = slider(1.0, 20)
    bare = FixedPath(path.limits, path.dq, path.ddq)
    assert tune(TuningTask(bare)).duration > 0.0
    with pytest.raises(InputError, match="inertias"):
        tune(TuningTask(bare, objective=TuningObjective(0.5)))
    hollow = path.rigid._replace(c=np.full_like(path.rigid.c, np.nan))
    with pytest.raises(InputError, match="inertia of axis J1"):
        tune(TuningTask(FixedPath(path.limits, path.dq, path.ddq, hollow), limited(1.0)))


@pytest.mark.parametrize(
    ("speed", "torque"),
    [
        ((), ()),
        ((0.0, 1.0), (1.0,)),
        ((0.1, 1.0), (2.0, 1.0)),
        ((0.0, 1.0), (1.0, 2.0)),
        ((0.0, 1.0), (1.0, 0.0)),
        ((0.0, 1.0, 0.5), (3.0, 2.0, 1.0)),
        ((0.0, math.nan), (3.0, 2.0)),
        ((0.0, 0.1, 1.0, 3.0), (10.0, 5.0, 4.9, 1.0)),
    ],
)
def test_curves_that_are_none(speed, torque):
    with pytest.raises(InputError, match="TorqueCurve"):
        TorqueCurve(speed, torque)


@given(st.lists(st.tuples(st.floats(0.05, 1.0), st.floats(0.0, 0.9)), min_size=1, max_size=6))
def test_runs_are_the_curve(steps):
    """A curve that is accepted is the least of its runs, everywhere."""
    speed = np.concatenate([[0.0], np.cumsum([step for step, _ in steps])])
    torque = 10.0 * np.cumprod([1.0, *(1.0 - fall for _, fall in steps)])
    try:
        curve = TorqueCurve(tuple(speed), tuple(torque))
    except InputError:
        return
    at = np.linspace(0.0, 1.5 * speed[-1], 200)
    least = np.min([run.at(at) for run in curve.runs], axis=0)
    # Between points a run may come from further off and lie below: never above.
    assert (least <= curve.at(at) + 1e-9).all()
    assert least[0] == pytest.approx(10.0)


def test_drives_of_a_robot_without_torques_limit_nothing():
    robot = scene()[0].robot
    drives = drives_of(robot)
    assert len(drives) == robot.size
    path = scene()[3]
    assert tune(TuningTask(path, drives)).duration == pytest.approx(tune(TuningTask(path)).duration)


def test_graded_knots_end_where_they_should():
    knots = graded(2.0, 10)
    assert knots[0] == 0.0 and knots[-1] == pytest.approx(2.0) and (np.diff(knots) > 0).all()


def test_rigid_torques_are_the_arms():
    """τ = a u + b x + c is inverse dynamics, at any x and u."""
    controller, program, timing, path = scene()
    found = tune(TuningTask(path))
    torque = controller.energy(program, found.timing(timing)).torque
    assert found.torque == pytest.approx(torque, abs=1e-6 * np.abs(torque).max())
    assert isinstance(path.rigid, Rigid)


# ------------------------------------------------------------------ reports


def test_active_limits_are_named():
    """A cruise between two ramps, by the limit that each is driven at."""
    swift = tune(TuningTask(slider(4.0, 60, velocity=1.0, acceleration=2.0)))
    assert set(swift.active) == {"J1 acceleration", "speed"}
    assert swift.active[0] == swift.active[-1] == "J1 acceleration"
    assert swift.active[30] == "speed"
    pushed = tune(TuningTask(slider(4.0, 60, velocity=1.0), limited(2.0)))
    assert set(pushed.active) == {"J1 torque", "speed"}
    smooth = tune(TuningTask(slider(4.0, 60), jerk=np.array([5.0])))
    assert set(smooth.active) == {"J1 jerk"}


def test_every_limit_of_an_arm_is_reported():
    path = scene()[3]
    most = 1.2 * np.abs(path.rigid.c).max(axis=(0, 1)) + 50.0
    found = tune(TuningTask(path, limited(*most)))
    used = found.usage
    assert {"speed", "J2 torque", "J2 acceleration"} <= set(used)
    # Nothing limits it, so that there is nothing to report.
    assert "TCP acceleration" not in used
    assert max(shares.max() for shares in used.values()) == pytest.approx(1.0 + found.excess)
    assert used["J2 torque"] == pytest.approx(
        np.abs(found.torque[..., 1]).max(axis=1) / most[1], rel=1e-12
    )
    # In a fastest motion something is used up nearly everywhere.
    busiest = np.max(list(used.values()), axis=0)
    assert np.mean(busiest > 0.999) > 0.9


@pytest.mark.parametrize(
    ("make", "message"),
    [
        (lambda: TuningTask(None), "TuningTask.path is of type FixedPath, not None"),
        (
            lambda: TuningTask(slider(1.0, 9), JointDrive()),
            "TuningTask.drives is a tuple of JointDrive values",
        ),
        (
            lambda: TuningTask(slider(1.0, 9), (JointDrive(), JointDrive())),
            r"one an axis \(J1\), not 2",
        ),
        (
            lambda: TuningTask(slider(1.0, 9), jerk="x"),
            r"TuningTask.jerk: one number above zero an axis",
        ),
        (
            lambda: TuningTask(slider(1.0, 9), jerk=[math.nan]),
            r"TuningTask.jerk: one number above zero",
        ),
        (
            lambda: TuningTask(slider(1.0, 9), objective=0.5),
            "TuningTask.objective is of type TuningObjective",
        ),
        (
            lambda: TuningTask(slider(1.0, 9), objective=TuningObjective(0.5, Motors((1.0, 1.0)))),
            "Motors.copper has figures of 2 joints; there are 1",
        ),
        (
            lambda: TuningObjective("x"),
            "TuningObjective.time_weight is a number from 0 to 1, not 'x'",
        ),
        (lambda: TuningObjective(0.5, None), "TuningObjective.consumption is of type Consumption"),
        (
            lambda: TuningObjective(0.5, duration=math.nan),
            "TuningObjective.duration is a finite number",
        ),
        (lambda: JointDrive(5.0), "JointDrive.torque is of type TorqueCurve, not 5.0"),
        (lambda: JointDrive(coulomb=-1.0), "JointDrive.coulomb is a finite number, zero or more"),
        (lambda: TorqueCurve(0.0, 5.0), "TorqueCurve.speed is a tuple"),
    ],
)
def test_what_is_refused_by_name(make, message):
    with pytest.raises(InputError, match=message):
        make()
