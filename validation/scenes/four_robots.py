"""Four robots in two facing pairs that weld on parts between them, and share the middle.

After figure 4.5 of the thesis from which the zones of `flyby.problems.improve.zones` come: four
robots in a cell, each with its own program. Layout and tasks are made up: bases 3.3 m apart and
1.5 m beside each other, as wide as robots of this size are set, and tasks on both sides of the
middle.
"""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np

from ...core.cell.cell import Cell
from ...core.cell.geometry import Geometry, Mesh
from ...core.motion.emulator.controller import Controller
from ...core.program.move import Move, MoveJ, MoveL, Opaque
from ...core.program.program import Program
from ...core.program.speed import Speed
from ...core.program.target import JointTarget, PoseTarget
from ...core.program.tool import Tool
from ...core.program.zone import FINE, Radius, Zone
from ...core.registry import find_robot, find_vendor
from ...core.robot.shape import Capsule
from ...core.spatial.pose import Pose
from ...core.station.actions import Action, actions_of
from ...core.station.station import RobotStation, StationRobot, Wire
from .clutter_shapes import circle, swept
from .solids import tube

ROBOT = "abb/irb6640-180-255"
CLEARANCE = 0.01
ACROSS, BESIDE = 3.3, 1.5
"""m between the bases of a facing pair, and of neighbours."""
TASKS = 33
_HOME = (0.0, -0.2, 0.2, 0.0, 1.2, 0.0)
DRAWN_BACK = (0.0, -0.7, 0.6, 0.0, 1.2, 0.0)
"""Where robots with guns stand clear of those that reach over the middle; with `_HOME` guns do not
(16 mm into a wrist, if a robot comes home late)."""
_DOWN = (0.0, 1.0, 0.0, 0.0)
_ABOVE = 0.15
ROD = Tool("rod", Pose((0.0, 0.0, 0.3)))
_SHAPE = Geometry(Capsule(0.05, 0.2), Pose((0.0, 0.0, 0.15)))
_OPENING, _BOW, _STEPS = 0.11, 1.5 * math.pi, 125
"""m, radius of a gun's bow; rad of it; rings of its mesh."""
BASES = {
    "a": Pose((0.0, 0.0, 0.0)),
    "b": Pose((ACROSS, 0.0, 0.0), (0.0, 0.0, 0.0, 1.0)),
    "c": Pose((0.0, BESIDE, 0.0)),
    "d": Pose((ACROSS, BESIDE, 0.0), (0.0, 0.0, 0.0, 1.0)),
}
FIRST = ("a", "d")
"""Robots that reach over the middle first; those facing them wait until they have left it."""


def gun() -> Mesh:
    """A closed C of 10 000 triangles, as welding guns are, with the TCP at its lower jaw."""
    along = np.linspace(0.0, _BOW, _STEPS)
    curve = np.stack([np.sin(along), np.zeros(_STEPS), 1.0 - np.cos(along)], axis=1)
    return tube("gun", swept(np.array([0.0, 0.0, 0.05]) + _OPENING * curve, circle(0.035)))


def four_robots(
    *,
    stops: bool = False,
    locked: bool = True,
    shape: Geometry = _SHAPE,
    home: tuple[float, ...] = _HOME,
) -> tuple[RobotStation, dict[str, tuple[Action, ...]]]:
    """The station, and what its programs do with signals.

    Args:
        stops: whether robots stop at every point, in place of zones of 50 mm.
        locked: whether the middle is held by signals; else programs only run.
        shape: of the tools.
        home: rad, where robots stand at both ends of their programs.
    """
    members, actions = {}, {}
    words = find_vendor("abb").speaks
    for name, base in BASES.items():
        robot = find_robot(ROBOT).with_base(base)
        program = _program(name, base, home, stops=stops, locked=locked)
        controller = Controller(find_vendor("abb"), robot)
        run = controller.run(program, None, None)
        cell = Cell(
            robot,
            "abb",
            CLEARANCE,
            tools={"rod": ROD},
            tool_geometries={"rod": shape},
            allowed=(("J2", "J4"), ("J4", "rod")),
        )
        members[name] = StationRobot(name, program, controller, cell, run)
        assert words is not None
        actions[name] = actions_of(run, words.signals)
    wires = []
    if locked:
        for one, other in (("a", "b"), ("d", "c")):
            wires.append(Wire(f"{one}.doOut", f"{other}.diFree", 0.01, 0.04))
    return RobotStation(members, tuple(wires), clearance=CLEARANCE), actions


def _program(
    name: str, base: Pose, home: tuple[float, ...], *, stops: bool, locked: bool
) -> Program:
    """33 tasks, each above, down and up again; a quarter of them over the middle."""
    rng = np.random.default_rng(sum(map(ord, name)))
    over = TASKS // 4
    near = [(rng.uniform(1.1, 1.25), rng.uniform(-0.4, 0.4)) for _ in range(TASKS - over)]
    far = [(rng.uniform(1.5, 1.7), rng.uniform(-0.25, 0.25)) for _ in range(over)]
    tasks = [*far, *near] if name in FIRST else [*near, *far]
    zone: Zone = FINE if stops else Radius(0.05, 0.075, 0.075)
    statements: list[Move | Opaque] = []
    for k, (x, y) in enumerate(tasks):
        if locked and name not in FIRST and k == TASKS - over:
            last = statements[-1]
            assert isinstance(last, MoveL)
            statements[-1] = replace(last, zone=FINE)
            statements.append(Opaque("WaitDI diFree, 1;", stops=True))
        z = rng.uniform(0.7, 1.0)
        at = base @ Pose((x, y, z), _DOWN)
        above = PoseTarget(at @ Pose((0.0, 0.0, -_ABOVE)))
        fast, slow = Speed(tcp=1.5), Speed(tcp=0.5)
        statements.append(MoveJ(above, fast, zone, ROD))
        statements.append(MoveL(PoseTarget(at), slow, FINE, ROD))
        if locked and name in FIRST and k == over:
            statements.append(Opaque("SetDO doOut, 1;"))  # it has left the middle
        statements.append(MoveL(above, slow, zone, ROD))
    statements.append(MoveJ(JointTarget(home), Speed(tcp=1.5), FINE, ROD))
    return Program(tuple(statements), name=name, start=JointTarget(home))
