"""What limits allow, against motions driven at many speeds."""

from __future__ import annotations

import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as st

from flyby.core.motion.allowed import Allowed
from flyby.core.motion.model import MotionModel
from flyby.core.program.move import MoveJ, MoveL
from flyby.core.program.program import Program
from flyby.core.program.speed import Speed
from flyby.core.program.zone import FINE, Radius


def driven(arm, turn: float, share: float) -> Program:
    speed = Speed(tcp=2.0 * share, reorientation=10.0 * share, joint_fraction=share)
    moves = (
        MoveL(arm.target((1, 0, 0)), speed, Radius(0.2 * arm.leg)),
        MoveL(arm.target((1, 1, 0)), speed, Radius(0.1 * arm.leg)),
        MoveJ(arm.target((0, 1, turn)), speed, FINE),
    )
    return Program(moves, start=arm.start)


def timing_of(arm, turn: float, share: float, model: MotionModel):
    controller = arm.controller(model)
    program = driven(arm, turn, share)
    return controller.stamp(program, controller.plan(program))


@settings(max_examples=5, deadline=None)
@given(share=st.floats(0.1, 1.0))
def test_no_rate_at_any_speed_passes_what_is_allowed(arm, share) -> None:
    allowed = Allowed.of(timing_of(arm, 0.3, 1.0, MotionModel()))
    slower = timing_of(arm, 0.3, share, MotionModel())
    _, dq, ddq, _ = slower.states_at(np.linspace(0.0, slower.duration, 3000))
    most = allowed.greatest(allowed.accelerations, np.abs).max(axis=0)
    assert (np.abs(ddq).max(axis=0) <= most * (1 + 1e-6) + 1e-6).all()
    assert (np.abs(dq).max(axis=0) <= allowed.velocities.max(axis=0) * (1 + 1e-6)).all()
    assert np.isfinite(most).all()
