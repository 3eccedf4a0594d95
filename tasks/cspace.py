"""The configuration space of two joints with a program's path in it."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

from ..core.door import spelt
from ..core.errors import InputError, OptionError
from .changes import joint_indices
from .options.entries import COUNT, REQUIRED, Extent, number, switch, value
from .options.keywords import by_keywords
from .options.moves import moves_named
from .options.texts import configuration
from .setup import CellOptions, controller_of, start_of, with_setup

if TYPE_CHECKING:
    from ..core.arrays import FloatArray
    from ..core.program.program import Program
    from ..core.robot.model import Robot
    from .results.joint_planes import ProgramPlane

STEPS = Extent(11, 1001)
_PAD = 0.5
"""Share of the path's span that is shown beside it."""
_LEAST = 0.2
"""rad or m that are shown beside the path at least."""


@dataclass(frozen=True, kw_only=True)
class CspaceOptions(CellOptions):
    """Which plane of joints is drawn."""

    axes: str | Sequence[int] = value(REQUIRED, "The two joints, such as 2,3.")
    move: int | str | None = value(
        None,
        "The other joints are held where this move ends: its number, line:44 or the name of its "
        "target; at the program's start if unset.",
    )
    held: str | Sequence[float] | None = value(
        None, "The other joints are held at these axis values instead.", numbers="rad and m"
    )
    whole: bool = switch("Show the whole ranges of both joints, not just those of the path.")
    steps: int = number(161, "Values of each joint that are looked at.", COUNT, STEPS)


def cspace_with(program: Program, options: CspaceOptions) -> ProgramPlane:
    """Look where the arm is free while two joints vary and the others are held.

    Args:
        program: as `flyby.read` gives it.

    Returns:
        The plane with the program's path in it, and its picture.

    Raises:
        InputError: naming the option.
        MotionError: the program cannot be driven.
    """
    import numpy as np

    from ..core.collision.handled_scenes import scenes_along
    from ..core.collision.joint_plane import joint_plane
    from .results.cell_course import CellCourse
    from .results.joint_planes import ProgramPlane

    program, setup = with_setup(program, options)
    robot = setup.robot
    axes = joint_indices(options.axes, robot.size)
    if len(axes) != 2 or axes[0] == axes[1]:
        raise OptionError(f"{spelt('axes')} {options.axes}: two different joints, such as 2,3")
    if options.held is not None and options.move is not None:
        raise OptionError(f"{spelt('held')} and {spelt('move')} both say where joints are held")
    cell = setup.surroundings(program, no_floor=options.no_floor)
    options.say("driving the program")
    course = CellCourse.of(program, setup)
    run = controller_of(program, setup).run(course.program, start_of(program))
    ends, moves = run.path.route.ends.q, run.path.route.moves
    index = 0
    held = ends[0, 0]
    if options.move is not None:
        named = moves_named(program, options.move, "move")[0]
        if named not in moves:
            raise InputError(f"{spelt('move')} {options.move}: this move is not driven")
        index = moves.index(named)
        held = ends[index, 1]
    if options.held is not None:
        held = np.array(configuration(options.held, spelt("held"), robot))
    pair = axes[0], axes[1]
    window = _window(robot, run.path.q, pair, held, whole=options.whole)
    options.say(f"looking at {options.steps**2} postures")
    move = moves[index]
    scenes = scenes_along(cell, course.handling, program, lambda: run.path, cell.clearance)
    scene = scenes(program.moves[move].tool, move)
    plane = joint_plane(scene, held, pair, window, options.steps, cell.clearance)
    return ProgramPlane(plane, robot, run)


cspace = by_keywords(cspace_with, CspaceOptions)


def _window(
    robot: Robot, q: FloatArray, axes: tuple[int, int], held: FloatArray, *, whole: bool
) -> FloatArray:
    """Lower and upper end (2, 2) of both joints."""
    import numpy as np

    limits = np.stack([robot.limits.lower, robot.limits.upper], -1)[[*axes]]
    if whole:
        return np.clip(limits, -2 * np.pi, 2 * np.pi)
    shown = np.concatenate([q, held[None]])[:, axes]
    low, high = shown.min(axis=0), shown.max(axis=0)
    pad = np.maximum(_PAD * (high - low), _LEAST)
    return np.asarray(np.clip(np.stack([low - pad, high + pad], -1), limits[:, :1], limits[:, 1:]))
