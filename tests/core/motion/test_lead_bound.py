"""The bound of leads against leads of motions driven at many speeds."""

from __future__ import annotations

import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as st

from flyby.core.motion.allowed import Allowed
from flyby.core.motion.elasticity import LEAD_STEP, Carried, Elasticity
from flyby.core.motion.lead_bound import most_lead
from flyby.core.motion.model import MotionModel
from flyby.core.motion.ramped import stamped_motion
from flyby.core.motion.smoothing import Smoothing
from flyby.core.motion.start_ramp import SUDDEN
from flyby.core.motion.torque import Borne, Torque
from flyby.core.motion.trajectory import sample_times
from flyby.core.program.move import MoveJ, MoveL
from flyby.core.program.program import Program
from flyby.core.program.speed import Speed
from flyby.core.program.zone import FINE, Radius

GEARS = Elasticity(
    (0.0, 2e-4, 1e-4, 1e-5),
    (Carried(3, (1.5e-4, 1e-4)), Carried(5, (1e-4, -1e-4, 5e-5))),
    slack=(1e-4, 1e-5),
    lag=(0.0, 1e-3, -1e-3),
)
WEAK = Torque((0.03, 0.06, 0.1), (Borne(5, (0.03, 0.03)),), fade=(0.2, 0.1))


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


def led(arm, timing, smoothing: Smoothing) -> np.ndarray:
    motion = stamped_motion(timing)
    even = sample_times(0.0, float(motion.t[-1]), LEAD_STEP)
    return np.abs(GEARS.leads(arm.robot, *smoothing.command(motion, even))).max(axis=0)


@settings(max_examples=5, deadline=None)
@given(
    turn=st.floats(-0.5, 0.5),
    share=st.floats(0.1, 1.0),
    width=st.floats(0.01, 0.05),
    length=st.sampled_from([0.0, 0.1]),
    torque=st.sampled_from([Torque(), WEAK]),
)
def test_no_lead_at_any_speed_passes_the_bound(arm, turn, share, width, length, torque) -> None:
    model = MotionModel(start_ramp=length, torque=torque)
    smoothing = Smoothing((width, 0.5 * width))
    timing = timing_of(arm, turn, 1.0, model)
    most = most_lead(GEARS, arm.robot, Allowed.of(timing), smoothing, timing.start)
    for speed in (1.0, share):
        lead = led(arm, timing_of(arm, turn, speed, model), smoothing)
        assert (lead <= most * 1.001 + 1e-9).all()


def test_the_bound_of_unsmoothed_leads_is_near_what_is_reached(arm) -> None:
    timing = timing_of(arm, 0.3, 1.0, MotionModel())
    smoothing = Smoothing((0.01,))
    most = most_lead(GEARS, arm.robot, Allowed.of(timing), smoothing, SUDDEN)
    reached = led(arm, timing, smoothing)
    assert (most[:3] <= 5.0 * reached[:3]).all()


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
