"""A first program from start to goal: planned, shortened, and proven to keep the clearance."""

from __future__ import annotations

import math
from dataclasses import dataclass

from ....core.cell.cell import Cell
from ....core.collision.proof.certificate import SceneOf, certify, scenes_of
from ....core.collision.proof.verdict import Certificate
from ....core.errors import InputError, MotionError
from ....core.motion.emulator.controller import Controller
from ....core.motion.emulator.run import Run
from ....core.program.move import MoveJ
from ....core.program.program import Program
from ....core.program.speed import Speed
from ....core.program.target import JointTarget, Target
from ....core.program.tool import FLANGE, WORLD, Tool, WorkObject
from ....core.program.zone import FINE, Zone
from ....core.registry import installed
from .ends import check_coupled, external_values, free_end
from .free_space import FreeSpace
from .search import quickest_path

UNLIMITED = Speed()
"""The robot's own limits alone."""


@dataclass(frozen=True, slots=True)
class PlanningOptions:
    """How to plan.

    Args:
        clearance: m to keep; None for the cell's own.
        margin: m beyond the clearance that the planner keeps, so that zones and the proof have
            room.
        seed: the same seed gives the same path, if time does not run out.
        tries: paths planned, of which the quickest is taken.
        time_limit: s for all of them.
        zone: of the points passed on the way; the last one is a stop.

    Raises:
        InputError: a number out of its range.
    """

    clearance: float | None = None
    margin: float = 1e-3
    seed: int = 0
    tries: int = 3
    time_limit: float = 20.0
    zone: Zone = FINE

    def __post_init__(self) -> None:
        for name in ("clearance", "margin"):
            value = getattr(self, name)
            if value is not None and not 0.0 <= value < math.inf:
                raise InputError(f"PlanningOptions.{name} is zero or more metres, not {value}")
        if self.seed < 0 or self.tries < 1:
            raise InputError("PlanningOptions.seed is zero or more, tries one or more")
        if not 0.0 < self.time_limit < math.inf:
            raise InputError(f"PlanningOptions.time_limit is above zero, not {self.time_limit}")


@dataclass(frozen=True)
class PlannedPath:
    """A planned program.

    Args:
        program: joint moves from the start (`Program.start`) to the goal.
        run: how the controller drives it.
        certificate: the proof that it keeps the clearance.
    """

    program: Program
    run: Run
    certificate: Certificate


def plan_path(
    cell: Cell,
    start: Target,
    goal: Target,
    tool: Tool = FLANGE,
    work_object: WorkObject = WORLD,
    *,
    options: PlanningOptions | None = None,
    controller: Controller | None = None,
    scenes: SceneOf | None = None,
) -> PlannedPath:
    """Joint moves from start to goal that keep the clearance.

    Args:
        cell: robot and obstacles.
        start, goal: joint values, or poses; of a pose every branch of inverse kinematics is
            tried. External axes stand still.
        tool: that is mounted, with a shape if the cell has one for it.
        work_object: of poses.
        options: None for `PlanningOptions` as they are.
        controller: that will drive it; None for the vendor's own.
        scenes: of the cell, if they are at hand already: `scenes_of`.

    Raises:
        InputError: OMPL is not installed, start or goal do not fit the robot, or the arm has ranges
            of several joints together.
        MotionError: start or goal collide or cannot be reached, no path was found in time, or
            zones take it too near to something.
    """
    options = PlanningOptions() if options is None else options
    clearance = cell.clearance if options.clearance is None else options.clearance
    controller = controller or Controller(cell.find_vendor(installed()), cell.robot)
    scenes = scenes or scenes_of(cell)
    check_coupled(cell.robot)
    external = external_values(cell.robot, start, goal)
    space = FreeSpace(scenes(tool), clearance + options.margin, external)
    ends = [
        free_end(name, target, tool, work_object, space, external)
        for name, target in (("start", start), ("goal", goal))
    ]
    path = quickest_path(
        cell.robot.joints,
        space,
        ends[0].configurations,
        ends[1].configurations,
        options.seed,
        options.tries,
        options.time_limit,
    )
    if path is None:
        raise MotionError(
            f"no path from start to goal was found in {options.time_limit:g} s; allow more time, "
            f"or a clearance below {1e3 * clearance:g} mm"
        )
    targets = [JointTarget(tuple(map(float, q)), external) for q in path]
    program = _program(targets, tool, work_object, options)
    run = controller.run(program)
    certificate = certify(controller, run, scenes, clearance)
    if not certificate.proven:
        raise MotionError(
            f"the planned path is not proven: {certificate}; take smaller zones or a larger margin"
        )
    return PlannedPath(program, run, certificate)


def _program(
    targets: list[JointTarget], tool: Tool, work_object: WorkObject, options: PlanningOptions
) -> Program:
    zones = [*[options.zone] * (len(targets) - 2), FINE]
    moves = tuple(
        MoveJ(target=target, speed=UNLIMITED, zone=zone, tool=tool, work_object=work_object)
        for target, zone in zip(targets[1:], zones, strict=True)
    )
    return Program(moves, name="planned", start=targets[0])
