"""What is fitted where nobody says what: the figures of a robot's type, or those of its servos.

What was fitted before for a type (blends, limits, elasticity) is its controller's and its arm's,
and robots of the type share it. One real robot differs from it by its servos: lags of the joints,
friction where they turn back, drag where they run fast, and how long it takes to come to rest. A
few runs show these few, all linear but the last, far better than two dozen figures that hold them
already. So both are fitted, each as runs held back ask for, and those runs choose. A virtual
controller has no servos.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence

from ...core.errors import FlybyError
from ...core.motion.model.motion_model import MotionModel
from ...core.robot.model import Robot
from .holding import HeldFit, fit_held
from .judgement import FEWEST
from .keys import value_of
from .minimum import Watch
from .parameters import ParameterSet, usual_parameters
from .runs import PreparedRun

SERVO_LISTS = ("servo.friction_rad", "servo.drag_s", "elasticity.lag_s")
"""Figures that each joint's servo has; zero where a model states none."""
REST = "servo.rest_s"


def servo_parameters(model: MotionModel, robot: Robot) -> list[str]:
    """What is fitted of one robot's servos, of all its joints alike."""
    keys = [f"{name}[{joint}]" for name in SERVO_LISTS for joint in range(robot.arm_size)]
    texts = [f"{key} = 0" if value_of(model, key) is None else key for key in keys]
    return [*texts, REST]


def fit_usual(
    model: MotionModel,
    robot: Robot,
    runs: Sequence[PreparedRun],
    workers: int = 1,
    watch: Watch | None = None,
    tell: Callable[[str], None] | None = None,
) -> HeldFit:
    """Fit what is usually fitted, and take what predicts runs held back best.

    Args:
        model: before the fit.
        robot: that drove.
        runs: of it.
        workers: processes.
        watch: called after each iteration; True ends the fit.
        tell: called with how far the work is.

    Raises:
        InputError: as `fit` does.
    """
    usual = ParameterSet.named(model, usual_parameters(model, robot))
    found = fit_held(usual, runs, workers, watch, tell)
    if len(runs) < FEWEST or all(run.run.real is False for run in runs):
        return found
    servo = ParameterSet.named(model, servo_parameters(model, robot))
    try:
        other = fit_held(servo, runs, workers, watch, tell)
    except FlybyError:  # the figures of the type do without them
        return found
    return max((found, other), key=_worth)


def _worth(held: HeldFit) -> tuple[bool, float]:
    """What runs held back say of a fit: whether it may be handed out, and what they gain."""
    judgement = held.judgement
    if judgement is None:
        return False, 0.0
    return judgement.better, float(judgement.gains.mean())
