"""What is fitted where nobody says what: the type's figures or one robot's servos, as logs say."""

from __future__ import annotations

from dataclasses import replace

import pytest

from flyby.core.motion.model.blend import Blend
from flyby.core.motion.model.motion_model import MotionModel
from flyby.core.motion.model.servo import Servo
from flyby.identification.fit import ParameterSet, PreparedRun, fit_usual, servo_parameters
from flyby.identification.fit.layers import REST, SERVO_LISTS

from .known_truth import ROBOT, TRUTH, logged, ready

KINDS = ((0.03, 0.5), (0.08, 0.2), (0.05, 0.8))
RUBBING = replace(
    TRUTH,
    servo=Servo(friction=(0.0, 2e-4, -1.5e-4), drag=(0.0, 1e-3, -8e-4)),
    elasticity=replace(TRUTH.elasticity, lag=(0.0, -4e-4, 0.0, 5e-4, 0.0, 0.0)),
)
BULGING = replace(TRUTH, tcp=Blend(beta=(-0.9,)), settling=None)


def runs_of(truth: MotionModel, before: MotionModel, real: bool | None) -> list[PreparedRun]:
    made = [logged(*one, k, model=truth) for k, one in enumerate(KINDS)]
    return [ready(replace(run, real=real), before) for run in made]


def fitted(truth: MotionModel, real: bool | None):
    before = replace(TRUTH, settling=truth.settling)
    held = fit_usual(before, ROBOT, runs_of(truth, before, real))
    return held, {one.name for one in held.fit.parameters.parameters}


def is_servo(name: str) -> bool:
    return name.partition("[")[0] in (*SERVO_LISTS, REST)


def test_servos_that_differ_are_found() -> None:
    held, names = fitted(RUBBING, None)
    assert any(map(is_servo, names)) and not any("blend" in name for name in names)
    assert held.judgement is not None and held.judgement.better
    assert held.fit.after < 0.3 * held.fit.before
    servo = held.fit.model.servo
    assert servo.friction[1] == pytest.approx(2e-4, abs=8e-5)
    assert servo.drag[1] == pytest.approx(1e-3, abs=4e-4)


def test_a_type_that_differs_is_found() -> None:
    held, names = fitted(BULGING, None)
    assert "blend.tcp.beta[0]" in names and not any(map(is_servo, names))
    assert held.judgement is not None and held.judgement.better
    assert held.fit.model.tcp.beta[0] == pytest.approx(-0.9, abs=0.1)


def test_virtual_controllers_have_no_servos() -> None:
    _, names = fitted(RUBBING, False)
    assert names and not any(map(is_servo, names))


def test_every_joint_has_what_a_servo_has() -> None:
    texts = servo_parameters(TRUTH, ROBOT)
    found = ParameterSet.named(TRUTH, texts)
    assert found.size == 3 * ROBOT.arm_size + 1 and not found.before.any()
    assert ParameterSet.named(RUBBING, servo_parameters(RUBBING, ROBOT)).before[1] == 2e-4
