"""What a reference scene is: a cell, programs in it, and the controllers that drive them."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from ...core.cell.cell import Cell
from ...core.motion.emulator.controller import Controller
from ...core.motion.geometry.pieces import Sampling
from ...core.motion.model.blend import PARABOLA, Blend
from ...core.motion.model.motion_model import MotionModel
from ...core.program.move import MoveJ
from ...core.program.program import Program
from ...core.program.speed import Speed
from ...core.program.target import JointTarget
from ...core.program.tool import Tool
from ...core.program.zone import FINE, Zone
from ...core.registry import installed

SECOND_ORDER = Blend(alpha=(0.0, 0.0, 0.0, 10.0, -15.0, 6.0))
"""α = 10s³ − 15s⁴ + 6s⁵: legs are left and met with continuous second derivatives."""
SECOND_ORDER_BLENDS = MotionModel(tcp=SECOND_ORDER, joint=SECOND_ORDER, orientation=SECOND_ORDER)
"""The reference model of the scenes; no zone reaches further than half way to a neighbour."""
PARABOLAS = MotionModel(tcp=PARABOLA, joint=PARABOLA, orientation=PARABOLA)
"""The same with parabolas."""
UNHURRIED = Speed(tcp=50.0)
"""More than any TCP here can do: the joints' own limits alone count."""


@dataclass(frozen=True)
class Scene:
    """A cell with programs.

    Args:
        name: of the scene.
        cell: robot, tool, obstacles and the clearance to keep.
        programs: each from rest to rest, with a stop at every via point.
        tool: the tool that all moves use.
        free: indices of the joints that an optimisation may move.
        process: indices of the moves, in each program, whose path and speed the process fixes.
    """

    name: str
    cell: Cell
    programs: tuple[Program, ...]
    tool: Tool
    free: tuple[int, ...]
    process: tuple[int, ...] = ()

    def controller(
        self, model: MotionModel = SECOND_ORDER_BLENDS, sampling: Sampling | None = None
    ) -> Controller:
        """An emulated controller of the cell's vendor that drives by ``model``."""
        return Controller(self.cell.find_vendor(installed()), self.cell.robot, model, sampling)


def joint_target(degrees: Sequence[float], name: str | None = None) -> JointTarget:
    """A target at joint values in degrees."""
    return JointTarget(tuple(float(value) for value in np.radians(degrees)), name=name)


def joint_program(name: str, points: Sequence[JointTarget], tool: Tool) -> Program:
    """Joint moves from the first point through all others, with a stop at each."""
    start, *targets = points
    moves = tuple(MoveJ(target=target, speed=UNHURRIED, tool=tool) for target in targets)
    return Program(moves, name=name, start=start)


def with_zone(program: Program, zone: Zone) -> Program:
    """The same program with one zone round all its waypoints but the last, which stays a stop."""
    moves = tuple(replace(move, zone=zone) for move in program.moves[:-1])
    return program.with_moves((*moves, replace(program.moves[-1], zone=FINE)))
