"""Limits of torque: what they take, their derivatives, and what they leave."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from flyby.core.collision.deviation.speed_bounds import greatest
from flyby.core.errors import InputError, MotionError
from flyby.core.motion.emulator.binding_limits import interval_limits
from flyby.core.motion.model.motion_file import load_motion_model
from flyby.core.motion.model.motion_model import MotionModel
from flyby.core.motion.model.torque import Borne, Torque
from flyby.core.motion.timing.torque import pull_torque_shares, torque_shares
from flyby.core.motion.timing.torque_rows import Shares
from flyby.core.program.move import MoveJ, MoveL
from flyby.core.program.program import Program
from flyby.core.program.speed import Speed
from flyby.core.program.zone import FINE, Radius
from flyby.core.registry import find_robot

MASSES = (Borne(3, (0.045, 0.0)), Borne(4, (0.02, 0.04, 0.02)), Borne(5, (0.02, 0.03, 0.01)))
MOTORS = Torque((0.05, 0.05, 0.08), MASSES, (0.0, 0.1, 1.0), (0.25, 0.1, 0.05))
ROBOT = find_robot("abb/irb6640-180-255")


def states(seed: int, count: int = 4) -> tuple[np.ndarray, ...]:
    rng = np.random.default_rng(seed)
    return rng.uniform(-1.2, 1.2, (count, 6)), *rng.normal(size=(2, count, 6))


def wrist(q: np.ndarray) -> np.ndarray:
    """The origin of joint 5: on the flange's axis, 0.2 m behind it."""
    rotation, position = ROBOT.forward(q)
    return position + rotation @ np.array([0.0, 0.0, -0.2])


@settings(max_examples=20, deadline=None)
@given(seed=st.integers(0, 1000))
def test_a_mass_takes_its_inertial_torque_and_its_weight(seed) -> None:
    """Jᵀ (p̈ - g), with J and p̈ from difference quotients of where the wrist is."""
    q, dq, ddq = states(seed)
    ones = (1.0, 1.0, 1.0)
    made = torque_shares(Torque((1e-9,) * 3, (Borne(5, ones),), (1.0, 0.5, 0.0)), ROBOT, q, dq, ddq)
    h = 1e-4
    J = np.stack([(wrist(q + h * e) - wrist(q - h * e)) / (2 * h) for e in np.eye(6)[:3]], -1)

    def at(t):
        return wrist(q + t * dq + 0.5 * t**2 * ddq)

    v, pull = (at(h) - at(-h)) / (2 * h), (at(h) - 2 * at(0.0) + at(-h)) / h**2
    close = {"rtol": 1e-5, "atol": 2e-5}
    np.testing.assert_allclose(made.a, np.einsum("tij,ti->tj", J, v), **close)
    np.testing.assert_allclose(made.b, np.einsum("tij,ti->tj", J, pull), **close)
    weight = 9.80665 * J[:, 2] * [1.0, 0.5, 0.0]
    np.testing.assert_allclose(made.h, weight, **close)


@settings(max_examples=20, deadline=None)
@given(seed=st.integers(0, 1000))
def test_the_reverse_is_that_of_difference_quotients(seed) -> None:
    path = states(seed)
    rng = np.random.default_rng(seed + 1)
    bar = Shares(*rng.normal(size=(4, 4, 3)))
    out = tuple(np.zeros((4, 6)) for _ in range(3))
    pull_torque_shares(MOTORS, ROBOT, path, bar, out)

    def value(part: int, change: np.ndarray) -> float:
        moved = [array + (change if k == part else 0.0) for k, array in enumerate(path)]
        made = torque_shares(MOTORS, ROBOT, *moved)
        return float(sum(np.sum(x * y) for x, y in zip(made, bar, strict=True)))

    for part in range(3):
        way = rng.normal(size=(4, 6))
        h = 1e-6
        slope = (value(part, h * way) - value(part, -h * way)) / (2 * h)
        assert slope == pytest.approx(float(np.sum(out[part] * way)), rel=1e-6, abs=1e-7)


def program(arm, **numbers: float) -> Program:
    speed = Speed(tcp=3.0, reorientation=20.0, **numbers)
    moves = (
        MoveL(arm.target((1, 0, 0)), speed, Radius(0.2 * arm.leg)),
        MoveL(arm.target((1, 1, 0)), speed, FINE),
        MoveJ(arm.joints([0.4, 0.2, -0.3, 0.3, 0.2, 0.5]), speed, FINE),
    )
    return Program(moves, start=arm.start)


@settings(max_examples=8, deadline=None)
@given(share=st.floats(0.2, 1.0))
def test_a_stamped_motion_takes_all_of_some_torque_and_no_more(abb, share) -> None:
    controller = abb.controller(MotionModel(torque=MOTORS))
    run = controller.run(program(abb, joint_acceleration_fraction=share), period=5e-4)
    q, dq, ddq = run.timing.states_at(run.trajectory.t)
    _, inertial, weight, fade = torque_shares(MOTORS, abb.robot, q, dq, ddq)
    upper = share * (1 - weight - fade)
    lower = -share * (1 + weight - fade)
    assert np.maximum(inertial - upper, lower - inertial).max() < 0.02 * share
    full = np.maximum(inertial / upper, inertial / lower).max()
    assert full == pytest.approx(1.0, abs=0.03)
    stated = "torque" if share == 1.0 else "programmed joint acceleration"
    assert any(name.endswith(stated) for name in interval_limits(run, abb.robot.axis_names))
    assert not [note for note in run.notes if "acceleration" in note.message]


def test_less_torque_takes_longer(abb) -> None:
    durations = [
        abb.controller(MotionModel(torque=MOTORS))
        .run(program(abb, joint_acceleration_fraction=share))
        .duration
        for share in (1.0, 0.5, 0.25)
    ]
    assert durations[0] < durations[1] < durations[2]


def test_torques_that_joints_do_not_have_leave_the_others_their_accelerations(abb) -> None:
    """A limit of torque on a joint that barely moves changes nothing for the rest."""
    free = Torque((1e-6, 1e-6, 1e-6))
    run = abb.controller(MotionModel(torque=free)).run(program(abb), period=5e-4)
    ddq = run.timing.states_at(run.trajectory.t)[2]
    share = np.abs(ddq / abb.robot.limits.acceleration).max(axis=0)
    assert share[3:].max() == pytest.approx(1.0, abs=0.03)
    assert share[:3].max() > 1.1


@settings(max_examples=6, deadline=None)
@given(share=st.floats(0.1, 1.0))
def test_no_motion_is_faster_than_allowed(abb, share) -> None:
    """Driven as stamped, or slower."""
    controller = abb.controller(MotionModel(torque=MOTORS))
    driven = program(abb)
    timing = controller.stamp(driven, controller.plan(driven))
    most = greatest(timing)
    slower = program(abb, joint_fraction=share)
    for made in (timing, controller.run(slower).timing):
        assert (made.stamp.x <= most * (1 + 1e-6) + 1e-12).all()


def test_an_arm_too_weak_for_its_weight_is_refused(abb) -> None:
    weak = replace(MOTORS, carried=(Borne(5, (0.0, 0.0, 0.5)),))
    with pytest.raises(MotionError, match="standing still"):
        abb.controller(MotionModel(torque=weak)).run(program(abb))


def test_more_joints_than_the_arm_has_are_refused() -> None:
    with pytest.raises(InputError, match="not 7"):
        torque_shares(Torque((0.1,) * 7), ROBOT, *np.zeros((3, 1, 6)))


def test_a_file_states_what_it_states(tmp_path) -> None:
    path = tmp_path / "motion.toml"
    path.write_text(
        "[torque]\nown_s2 = [0.05, 0.06]\nweight = [0, 0.1]\nfade_s2 = [0.2]\n"
        "carried = [{ joint = 3, share_s2_per_m2 = [0.04, 0.01] }]\n",
        "utf-8",
    )
    model = load_motion_model(path)
    assert model.torque == Torque(
        (0.05, 0.06), (Borne(3, (0.04, 0.01)),), weight=(0.0, 0.1), fade=(0.2,)
    )
    stated = {f"torque.{key}" for key in ("own_s2", "carried", "weight", "fade_s2")}
    assert stated <= model.figures
    path.write_text("[torque]\nfade_s2 = [0.3]\n", "utf-8")
    assert load_motion_model(path, model).torque == replace(model.torque, fade=(0.3,))


@pytest.mark.parametrize(
    ("text", "key"),
    [
        ("own = [1]", "torque.own"),
        ("own_s2 = 1", "torque.own_s2"),
        ("own_s2 = [0]", "torque.own_s2"),
        ("own_s2 = [nan]", "torque.own_s2"),
        ("own_s2 = [1]\nweight = [0, 1]", "torque.own_s2"),
        ("own_s2 = [1]\nfade_s2 = [-1]", "torque.fade_s2"),
        ("carried = 3", "torque.carried"),
        ("carried = [{ joint = 3 }]", "torque.carried"),
        ("carried = [{ joint = 3.5, share_s2_per_m2 = [] }]", "torque.carried"),
        ("own_s2 = [1, 1]\ncarried = [{ joint = 2, share_s2_per_m2 = [0, 1] }]", "torque.carried"),
    ],
)
def test_a_broken_table_is_named_with_the_key(text, key, tmp_path) -> None:
    path = tmp_path / "motion.toml"
    path.write_text(f"[torque]\n{text}\n", "utf-8")
    with pytest.raises(InputError, match=rf"motion\.toml: .*{key}"):
        load_motion_model(path)
