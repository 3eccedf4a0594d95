"""Motions are the same whether they are sampled in one go or stretch by stretch."""

from __future__ import annotations

import tracemalloc
from dataclasses import replace

import numpy as np
import pytest

from flyby.core.motion.command import commanded_motion as driven
from flyby.core.motion.model.elasticity import Carried, Elasticity
from flyby.core.motion.model.motion_model import MotionModel
from flyby.core.motion.model.servo import Servo
from flyby.core.program.move import MoveJ, MoveL, Wait
from flyby.core.program.program import Program
from flyby.core.program.speed import Speed
from flyby.core.program.zone import FINE, Radius

GEARS = Elasticity((0.0, 1e-4), (Carried(3, (1e-4, 1e-4)),), slack=(1e-4,))
MODELS = {
    "stamped": MotionModel(),
    "averaged": MotionModel(smoothing=(0.04, 0.03)),
    "ramp": MotionModel(smoothing=(0.04, 0.04), ramp=0.05),
    "ramp alone": MotionModel(ramp=0.05),
    "elastic": MotionModel(smoothing=(0.04, 0.03, 0.02), ramp=0.03, elasticity=GEARS),
    "slack averaged": MotionModel(
        smoothing=(0.04, 0.05, 0.02),
        ramp=0.03,
        elasticity=replace(GEARS, slack=(1e-3, 3e-4), slack_averaged=True),
    ),
    "slow start": MotionModel(smoothing=(0.05,), start_ramp=0.2),
    "lag": MotionModel(smoothing=(0.05, 0.03), elasticity=Elasticity(lag=(1e-3, 0.0, -2e-3))),
    "friction": MotionModel(servo=Servo((-1e-3, 1e-3, 2e-3))),
    "drag": MotionModel(servo=Servo((1e-3,), drag=(-1e-3, 1e-3, 2e-3))),
    "drag, friction, elastic": MotionModel(
        smoothing=(0.04, 0.03),
        ramp=0.03,
        elasticity=GEARS,
        servo=Servo((-1e-3, 1e-3), drag=(2e-3, 0.0, -1e-3), drag_delay=0.4),
    ),
    "friction, elastic": MotionModel(
        smoothing=(0.04, 0.03), ramp=0.03, elasticity=GEARS, servo=Servo((-1e-3, 1e-3))
    ),
}


def program(arm) -> Program:
    speed = Speed(tcp=0.4, reorientation=5.0)
    moves = (
        MoveL(arm.target((1, 0, 0)), speed, Radius(0.2 * arm.leg)),
        MoveL(arm.target((1, 1, 0)), speed, FINE),
        MoveJ(arm.target((0, 1, 0.4)), speed, FINE),
    )
    return Program(moves, start=arm.start)


@pytest.mark.parametrize("name", MODELS)
def test_stretches_join(abb, monkeypatch, name: str) -> None:
    controller = abb.controller(MODELS[name])
    whole = controller.run(program(abb), period=0.003).trajectory
    monkeypatch.setattr(driven, "_STRETCH", 0.111)
    made = controller.run(program(abb), period=0.003).trajectory
    assert len(list(driven.stretches(made.t))) > 5
    np.testing.assert_array_equal(made.t, whole.t)
    np.testing.assert_array_equal(made.move, whole.move)
    np.testing.assert_allclose(made.sigma, whole.sigma, rtol=0, atol=1e-12)
    for name, size in (("q", 2e-7), ("dq", 2e-5), ("q_motor", 2e-7), ("position", 2e-7)):
        off = np.abs(getattr(made, name) - getattr(whole, name))
        assert off.max() < size, name
    for name in ("ddq", "ddq_motor"):
        off = np.abs(getattr(made, name) - getattr(whole, name))
        assert off.max() < 2e-3 * np.abs(whole.ddq).max(), name


def test_memory_does_not_grow_with_what_is_between_samples(abb) -> None:
    """Of a motion that takes long, at few samples."""
    model = MODELS["elastic"]
    controller = abb.controller(model)
    first, *rest = program(abb).moves
    peaks = []
    for wait in (40.0, 160.0):
        driven_one = Program((first, *rest[:-1], Wait(wait), rest[-1]), start=abb.start)
        timing = controller.stamp(driven_one, controller.plan(driven_one))
        tracemalloc.start()
        made = controller.sample(driven_one, timing, 0.5)
        peaks.append(tracemalloc.get_traced_memory()[1])
        tracemalloc.stop()
        assert made.duration > wait
    assert peaks[1] < 1.2 * peaks[0]
