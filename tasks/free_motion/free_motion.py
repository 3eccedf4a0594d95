"""How fast, and how cheaply, a robot could move if no program language stood in the way."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

from ...core.door import given, spelt
from ...core.errors import OptionError
from ..changes import joint_indices
from ..options.entries import COUNT, Extent, number, value
from ..options.keywords import by_keywords
from ..options.texts import configuration
from ..setup import CellOptions, Setup, setup_of
from .objective import ObjectiveOptions

if TYPE_CHECKING:
    from ...core.errors import Note
    from ...core.program.tool import Tool
    from ...problems.free_motion.optimal_control import SearchStep, Surroundings
    from ..results.motions import FreeMotion

MOST_TRIALS = 16


@dataclass(frozen=True, kw_only=True)
class FreeMotionOptions(ObjectiveOptions, CellOptions):
    """From where to where a robot moves, past what, and for what price."""

    vias: Sequence[str | Sequence[float]] = value(
        (),
        "A corner of a path that is free, axis values in degrees and mm, in order; may be given "
        "several times. Without any, straight joint lines, or planned ones where these are not "
        "free.",
        several=True,
        flag="--via",
        numbers="rad and m",
    )
    tool: str | None = value(None, "Tool of the cell that is mounted; the flange if unset.")
    axes: str | Sequence[int] | None = value(
        None, "Joints that may move, such as 2,3; all if unset."
    )
    intervals: int = number(
        60,
        "Pieces of time that the motion is first laid out in; more are finer, and take longer.",
        COUNT,
        Extent(1),
    )
    trials: int = number(
        MOST_TRIALS,
        "Ways in which a motion that is stuck near obstacles is led on; 0 is quickest.",
        COUNT,
        Extent(0, MOST_TRIALS),
    )


def free_motion_with(
    start: str | Sequence[float], goal: str | Sequence[float], options: FreeMotionOptions
) -> FreeMotion:
    """The best motion found between two configurations, from rest to rest: by optimal control.

    Args:
        start, goal: (N,) axis values in rad and m; as text in degrees and mm.

    Returns:
        A sampled motion, no robot code: a yardstick for programs along the same way. In a cell it
        is proven to keep the clearance.

    Raises:
        InputError: naming the option, or the joint that cannot do what is asked.
        MotionError: a configuration or the path to begin with collides, or no motion within the
            limits was found.
    """
    from ...core.robot.inertia import carried_inertia
    from ...problems.free_motion.optimal_control import (
        MotionEffort,
        MotionObjective,
        MotionTask,
        optimize,
    )
    from ..results.motions import FreeMotion

    setup = setup_of(options)
    robot = setup.robot
    ends = [configuration(q, spelt(name), robot) for q, name in ((start, "start"), (goal, "goal"))]
    vias = [configuration(q, spelt("vias", "--via"), robot) for q in options.vias]
    tool = _tool(setup, options.tool)
    consumption = options.consumption(robot)
    task = MotionTask(
        robot,
        start=ends[0],
        end=ends[1],
        joints=None if options.axes is None else joint_indices(options.axes, robot.size),
        tcp=tool.tcp,
        loads=(carried_inertia(tool) if robot.links else None,),
        objective=MotionObjective(options.weight, consumption, options.longest),
    )
    effort = MotionEffort(intervals=options.intervals, trials=options.trials)

    def report(step: SearchStep) -> None:
        options.say(f"{step.time:.4f} s: {step.what} (Ctrl-C ends with the best)")

    around, notes = _surroundings(setup, tool, no_floor=options.no_floor)
    found = optimize(task, around, effort, [vias] if vias else None, report)
    return FreeMotion(replace(found, notes=(*notes, *found.notes)), consumption)


free_motion = by_keywords(free_motion_with, FreeMotionOptions)


def _tool(setup: Setup, name: str | None) -> Tool:
    from ...core.program.tool import FLANGE

    if name is None:
        return FLANGE
    if setup.cell is None:
        raise OptionError(
            f"{given('tool', name)}: tools are declared in a cell file; give {spelt('cell')}"
        )
    return setup.cell.tool(name)


def _surroundings(
    setup: Setup, tool: Tool, *, no_floor: bool
) -> tuple[Surroundings | None, tuple[Note, ...]]:
    """What to keep clear of, nothing where not even the shape of the arm is known, and what there
    is to say of it."""
    from ...core.collision.scene.scene import CollisionScene
    from ...problems.free_motion.optimal_control import Surroundings

    cell, notes = setup.before_programs(no_floor=no_floor)
    if setup.cell is None and not setup.robot.shapes:
        return None, ()
    return Surroundings(CollisionScene(cell, tool), cell.clearance), notes
