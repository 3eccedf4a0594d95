"""How fast the path of a program is best passed, if every moment could have a speed of its own."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

from ...core.display import counted
from ...core.door import spelt
from ...core.errors import InputError, OptionError
from ..options import texts
from ..options.entries import POSITIVE, TIME, number, switch, value
from ..options.keywords import by_keywords
from ..setup import RobotOptions, controller_of, start_of, with_setup
from .objective import ObjectiveOptions

if TYPE_CHECKING:
    from ...core.arrays import FloatArray
    from ...core.program.program import Program
    from ...core.robot.model import Robot
    from ..results.motions import TunedMotion


@dataclass(frozen=True, kw_only=True)
class TuneOptions(ObjectiveOptions, RobotOptions):
    """What limits the motion along a path, and what counts."""

    torques: bool = switch("Hold the torque limits of the robot's description.")
    jerk: str | Sequence[float] | None = value(
        None,
        "Jerk that no joint exceeds, one number for all or one an axis, degrees/s³ (mm/s³).",
        numbers="rad/s³ (m/s³)",
    )
    period: float | None = number(
        None, "Seconds between samples; the controller's own if unset.", TIME, POSITIVE
    )


def tune_with(program: Program, options: TuneOptions) -> TunedMotion:
    """The best speeds along the path that a program drives, whatever its language can say.

    Args:
        program: as `flyby.read` gives it.

    Returns:
        The motion, without waits, and the emulated one beside it. No robot code: a program has one
        speed and one acceleration a move.

    Raises:
        InputError: naming the option, or torques are wanted and not known.
        MotionError: the program cannot be driven, or no motion within the limits is short enough.
    """
    from ...problems.free_motion.velocity_tuning import (
        FixedPath,
        TuningObjective,
        TuningTask,
        drives_of,
        tune,
    )
    from ..results.motions import TunedMotion

    program, setup = with_setup(program, options)
    controller = controller_of(program, setup)
    options.say(f"emulating {counted(program.moves, 'move')}")
    timing = controller.stamp(program, controller.plan(program, start_of(program)))
    options.say("finding the best speeds")
    objective = TuningObjective(
        options.weight,
        options.consumption(setup.robot),
        options.longest,
    )
    drives = drives_of(setup.robot) if options.torques else ()
    jerk = None if options.jerk is None else _jerk(options.jerk, setup.robot)
    found = tune(TuningTask(FixedPath.of(controller, program, timing), drives, jerk, objective))
    tuned = controller.sample(program, found.timing(timing), options.period)
    return TunedMotion(program, setup.robot, found, timing, tuned)


tune = by_keywords(tune_with, TuneOptions)


def _jerk(given: str | Sequence[float], robot: Robot) -> FloatArray:
    """(N,) rad/s³ or m/s³."""
    import numpy as np

    name = spelt("jerk")
    found = texts.several(given, name)
    if len(found) not in (1, robot.size) or min(found, default=0.0) <= 0.0:
        kind = OptionError if min(found, default=0.0) <= 0.0 else InputError
        raise kind(
            f"{name} {given}: one number above zero, or one an axis ({', '.join(robot.axis_names)})"
        )
    every = np.broadcast_to(np.array(found), robot.size)
    if isinstance(given, str):
        every = every * [scale for _, scale in texts.axis_units(robot)]
    return np.array(every)
