"""Random cells in which parts are taken and put down, and what dense samples find there."""

from __future__ import annotations

from collections.abc import Iterator, Sequence, Set
from dataclasses import dataclass, replace
from typing import NamedTuple

import numpy as np

from ...core.arrays import FloatArray
from ...core.cell.cell import Cell, Obstacle
from ...core.cell.geometry import Geometry
from ...core.cell.workpiece import Workpiece
from ...core.collision.distance.solid import TriangleMesh
from ...core.collision.scene.bodies import Body, BodyKind
from ...core.collision.scene.scene import CollisionScene
from ...core.handling.handling import Handling
from ...core.motion.path.path import Path
from ...core.program.move import Move, MoveC, MoveJ, MoveL, Opaque
from ...core.program.program import Program
from ...core.program.speed import Speed
from ...core.program.target import PoseTarget
from ...core.program.tool import Tool
from ...core.program.zone import FINE, Radius, Zone
from ...core.registry import find_robot
from ...core.robot.joint import ExternalAxis, ExternalRole, Joint
from ...core.robot.model import Robot
from ...core.robot.shape import Box, Cylinder, Sphere
from ...core.spatial.pose import Pose
from .solids import plate

ARM = "ur/ur10e"
TABLE = Joint("table", Pose((0.7, 0.0, -0.02)), (0.0, 0.0, 1.0), -3.0, 3.0, 1.0, 2.0)
TOP = 0.0
"""m, height of what parts stand on."""
ROOM = 0.3
"""m above it at which parts are carried."""
RESTING = 2e-3
"""m that parts may be in what they rest on, and tools deeper in parts than where they take them."""
BESIDE = 0.01
"""m within which a part may be beside what it does not touch where it is taken or released."""
APART = 0.018
"""m beyond the clearance, from where pairs surely count as apart."""
JUST_APART = 1.2e-3
"""m beyond the clearance, from where a pair is not let go on the next move."""
AGAIN = 5e-4
"""m more by which a pair surely goes into each other again; how far it was out sampling says."""
OFF = 1e-4
"""m by which a part is farther from what it rests on at the end of a move that lifts it."""
GRIP, OPEN = Opaque("grip on", True), Opaque("grip off", True)


@dataclass(frozen=True)
class HandlingScene:
    """A cell with parts, and a program that takes some and puts them down.

    Args:
        cell, program: see there.
    """

    cell: Cell
    program: Program


class _Drawn:
    """One scene, drawn bit by bit."""

    def __init__(self, seed: int) -> None:
        self._rng = rng = np.random.default_rng(seed)
        self._turns = bool(rng.random() < 0.4)
        robot = find_robot(ARM)
        if self._turns:
            robot = robot.with_external_axes((ExternalAxis(TABLE, ExternalRole.TABLE),))
        self._height, self._wide = rng.uniform(0.03, 0.12), rng.uniform(0.03, 0.09)
        self._count = int(rng.integers(1, 4))
        self._pitch = self._wide + rng.uniform(0.0, 0.06)
        self._reach = rng.uniform(0.08, 0.2)
        self.tool = Tool("grip", Pose((0.0, 0.0, self._reach)))
        self._external = 0.0
        self._parts = self._part()
        self.cell = self._cell(robot)

    def _part(self) -> Workpiece:
        rng, height, wide = self._rng, self._height, self._wide
        shape = (Box((wide, wide, height)), Cylinder(0.5 * wide, height), Sphere(0.5 * wide))[
            rng.integers(0, 3)
        ]
        half = 0.5 * (wide if isinstance(shape, Sphere) else height)
        self._tall = 2.0 * half
        kind = Workpiece(
            "part",
            Geometry(shape, Pose((0.6, 0.2, TOP + half))),
            ("grip on",),
            ("grip off",),
            count=(self._count, 1, 1),
            pitch=(self._pitch, 0.0, 0.0),
            leaves=bool(rng.random() < 0.15),
            near=0.03,
        )
        if self._turns:
            kind = replace(kind, released_on="table")
            if rng.random() < 0.5:
                lying = Pose((-0.1, 0.2, TOP + half + 0.02))
                kind = replace(kind, carried_by="table", geometry=Geometry(shape, lying))
        return kind

    def _cell(self, robot: Robot) -> Cell:
        rng = self._rng
        grip = self._reach + rng.uniform(-0.02, 0.0)
        shape: Cylinder | Box = Cylinder(rng.uniform(0.01, 0.03), grip)
        if rng.random() < 0.3:
            shape = Box((rng.uniform(0.02, 0.1), rng.uniform(0.02, 0.05), grip))
        return Cell(
            robot,
            "ur",
            tools={"grip": self.tool},
            tool_geometries={"grip": Geometry(shape, Pose((0.0, 0.0, 0.5 * grip)))},
            obstacles=tuple(self._around()),
            parts=(self._parts,),
        )

    def _around(self) -> Iterator[Obstacle]:
        rng = self._rng
        if rng.random() < 0.4:
            # A depth into meshes is not known.
            rim = plate(_rimmed, (0.4, -0.45), (1.1, 0.45), 0.05, 0.1)
            yield Obstacle("floor", Geometry(rim))
        elif self._turns:
            disc = Geometry(Cylinder(0.45, 0.1), Pose((0.0, 0.0, TOP + 0.02 - 0.05)))
            yield Obstacle("disc", disc, "table")
        else:
            board = Geometry(Box((0.7, 0.9, 0.1)), Pose((0.75, 0.0, TOP - 0.05)))
            yield Obstacle("floor", board)
        if rng.random() < 0.6:
            tall = rng.uniform(0.05, 0.3)
            x, y = rng.uniform(0.45, 0.75), rng.uniform(-0.12, 0.1)
            wall = Box((rng.uniform(0.05, 0.3), 0.02, tall))
            yield Obstacle("wall", Geometry(wall, Pose((x, y, TOP + 0.5 * tall))))
        if rng.random() < 0.4:
            # Beside where the first part lies, so near that it may be touched.
            gap = 0.5 * self._wide + rng.uniform(0.0, 0.02)
            side = Box((0.02, 0.1, rng.uniform(0.02, 0.1)))
            at = Pose((0.6 - gap - 0.01, 0.2, TOP + 0.5 * side.size[2]))
            yield Obstacle("rail", Geometry(side, at))

    def program(self) -> Program:
        """Parts of the tray in turn, each put down at a place of its own, more or less well."""
        rng = self._rng
        statements: list[Move | Opaque] = []
        for k in range(int(rng.integers(1, self._count + 1))):
            x, y = 0.6 + k * self._pitch, 0.2
            grip = TOP + self._tall + rng.uniform(-0.03, 0.004)
            put = rng.uniform(0.45, 0.75), rng.uniform(-0.35, -0.15)
            off = rng.choice(
                [0.0, rng.uniform(-0.0019, 0.006), rng.uniform(-0.03, 0.0)], p=[0.5, 0.4, 0.1]
            )
            room = TOP + self._tall + rng.uniform(0.1, ROOM)
            statements += self._there(x, y, room, grip)
            statements += [GRIP, *self._away(x, y, room, grip)]
            if self._turns and rng.random() < 0.7:
                self._external = rng.uniform(-1.0, 1.0)
            statements += self._there(*put, room, grip + off)
            statements += [OPEN, *self._away(*put, room, grip + off)]
        return Program(tuple(statements))

    def _there(self, x: float, y: float, room: float, z: float) -> Iterator[Move]:
        dx, dy = self._beside()
        joint = self._rng.random() < 0.3
        yield self._to(x + dx, y + dy, room, self._zone(), joint)
        yield self._to(x, y, z)

    def _away(self, x: float, y: float, room: float, z: float) -> Iterator[Move]:
        rng = self._rng
        dx, dy = self._beside()
        last = self._to(x + dx, y + dy, room, self._zone())
        if rng.random() < 0.1:
            via = self._to(x + rng.uniform(-0.02, 0.02), y, z + rng.uniform(0.005, 0.04))
            assert isinstance(via.target, PoseTarget)
            last = MoveC(last.target, last.speed, last.zone, tool=self.tool, via=via.target)
        elif rng.random() < 0.15:
            yield self._to(
                x, y, z + rng.uniform(0.0, 0.03), FINE if rng.random() < 0.5 else self._zone()
            )
        yield last

    def _beside(self) -> tuple[float, float]:
        """How far from straight above parts are come to and left."""
        rng = self._rng
        if rng.random() < 0.8:
            return 0.0, 0.0
        return rng.uniform(-0.04, 0.04), rng.uniform(-0.04, 0.04)

    def _zone(self) -> Zone:
        radius = self._rng.uniform(0.002, 0.05)
        return Radius(radius) if self._rng.random() < 0.6 else FINE

    def _to(self, x: float, y: float, z: float, zone: Zone = FINE, joint: bool = False) -> Move:
        external = (self._external,) if self._turns else ()
        target = PoseTarget(Pose((x, y, z), (0.0, 1.0, 0.0, 0.0)), external=external)
        kind = MoveJ if joint else MoveL
        return kind(target, Speed(tcp=0.5), zone, tool=self.tool)


def random_handling(seed: int) -> HandlingScene:
    """A UR10e, often beside a table that turns, that takes one to three parts and puts them down.

    Grips, walls, trays of meshes, ways there and away and how deep parts are put are drawn, so that
    about a half of the programs collide somewhere.
    """
    drawn = _Drawn(seed)
    return HandlingScene(drawn.cell, drawn.program())


def _rimmed(x: FloatArray, y: FloatArray) -> FloatArray:
    """A board with a rim along one side, m: no convex shape."""
    return np.where(y > 0.4, TOP + 0.02, TOP + 0.0 * x)


class Fault(NamedTuple):
    """A sample at which the rules of parts are broken, or are least kept.

    Args:
        by: m; negative is what is left.
        move: index in the program.
        pair: names of the bodies.
    """

    by: float
    move: int
    pair: tuple[str, str]


class _MoveSamples(NamedTuple):
    """Samples of one move.

    Args:
        move: its index.
        q: (M, N).
        scene, smaller: with the parts where they are, and smaller ones.
        distance: (M, P) m.
        least: (M, P) m, what pairs have to keep; written.
    """

    move: int
    q: FloatArray
    scene: CollisionScene
    smaller: CollisionScene
    distance: FloatArray
    least: FloatArray

    def row(self, pair: tuple[Body, Body]) -> int | None:
        """The row of a pair of bodies that are at the same places here; None for none."""
        for row, (a, b) in enumerate(self.scene.pairs):
            bodies = self.scene.bodies[a], self.scene.bodies[b]
            if all(
                (x.name, x.frame, x.placement) == (y.name, y.frame, y.placement)
                for x, y in zip(bodies, pair, strict=True)
            ):
                return row
        return None


def worst_fault(cell: Cell, handling: Handling, path: Path, clearance: float = 0.0) -> Fault:
    """Where a densely sampled path breaks the rules of parts most.

    Made apart from the proofs: the rules once more, pair by pair and sample by sample. A pair that
    touches where a part is taken or released keeps the clearance once it has surely been apart,
    and is no deeper before than where it was taken or released, nor goes into each other again;
    others always keep it. It may take
    several moves until it is apart, if it goes on coming apart on each behind the first.

    Args:
        cell: with its parts, and one tool.
        handling: of the program.
        path: with as many samples as wanted.
        clearance: m.
    """
    moves = path.sample_moves()
    (tool,) = (tool for name, tool in cell.tools.items() if name in cell.tool_geometries)
    whole, small = (
        CollisionScene(cell, tool, handling.arrangements[0], by) for by in (0.0, RESTING)
    )
    driven: list[_MoveSamples] = []
    for move in dict.fromkeys(moves.tolist()):
        q, parts = path.q[moves == move], handling.arrangements[move]
        scene, smaller = whole.rearranged(parts), small.rearranged(parts)
        distance = scene.distances(q, clearance + APART + 1e-3).distance.copy()
        least = np.full(distance.shape, float(clearance))
        driven.append(_MoveSamples(move, q, scene, smaller, distance, least))
    for k, samples in enumerate(driven):
        _let_go(driven[k:], handling.before[samples.move], 1, clearance)
        _let_go(driven[k::-1], handling.behind[samples.move], -1, clearance)
    found: list[Fault] = []
    for samples in driven:
        for row in range(len(samples.scene.pairs)):
            short = samples.least[:, row] - _judged(samples, row)
            names = samples.scene.pair_names(row)
            found.append(Fault(float(short.max()), samples.move, names))
    return max(found)


def _judged(samples: _MoveSamples, row: int) -> FloatArray:
    """(M,) m of a pair; a depth into meshes is not known, but whether a smaller part touches."""
    distance, deep = samples.distance[:, row].copy(), samples.least[:, row] < 0.0
    bodies = [samples.scene.bodies[k].solid for k in samples.scene.pairs[row]]
    if deep.any() and any(isinstance(solid, TriangleMesh) for solid in bodies):
        smaller = samples.smaller.of_pairs(samples.scene.pairs[row : row + 1])
        distance[deep] = np.where(smaller.collides(samples.q[deep]), -2.0 * RESTING, 0.0)
    return distance


def _let_go(ways: Sequence[_MoveSamples], names: Set[str], way: int, clearance: float) -> None:
    """Lower what pairs have to keep that touch at one end of a move, until they are apart.

    Args:
        ways: the move, and those behind it, or before it.
        names: of the parts that are handled at that end.
        way: 1 for its beginning, -1 for its end.
        clearance: m.
    """
    scene = ways[0].scene
    for first in range(len(scene.pairs)):
        bodies = scene.bodies[scene.pairs[first][0]], scene.bodies[scene.pairs[first][1]]
        at_end = float(ways[0].distance[::way][0, first])
        floor = _floor(*bodies, names, at_end, clearance)
        if floor is None:
            continue
        drawn = BodyKind.HELD not in {body.kind for body in bodies}
        meshed = any(isinstance(body.solid, TriangleMesh) for body in bodies)
        best, back = -np.inf, RESTING + AGAIN + max(at_end, 0.0)
        row: int | None = first
        for k, samples in enumerate(ways):
            row = first if k == 0 else samples.row(bodies)
            if row is None:
                break
            d, least = samples.distance[::way, row], samples.least[::way, row]
            if k and not _lifted(d, clearance):
                break
            apart = np.logical_or.accumulate(d >= clearance + APART)
            come = np.maximum.accumulate(np.append(best, d))[1:]
            best = float(come[-1])
            kept = np.full(len(d), floor) if meshed or floor >= 0.0 else come - back
            least[~apart] = np.minimum(least, np.maximum(kept, floor))[~apart]
            if d.max() >= clearance + JUST_APART or not (drawn or d[-1] > d[0] + OFF):
                break


def _lifted(distance: FloatArray, clearance: float) -> bool:
    """Whether a pair only gets farther from each other until it is apart."""
    before = ~np.logical_or.accumulate(distance >= clearance + JUST_APART)
    falls = bool(((distance < np.maximum.accumulate(distance) - OFF) & before).any())
    return bool(distance[-1] > distance[0] + OFF) and not falls


def _floor(
    first: Body, second: Body, names: Set[str], at_end: float, clearance: float
) -> float | None:
    """How deep a pair may be, as negative m; None where it may not touch."""
    handled = [body for body in (first, second) if body.thing in names]
    if first.kind is BodyKind.TOOL and second.kind is BodyKind.PART and handled:
        return min(at_end, 0.0) - RESTING
    held = any(body.kind is BodyKind.HELD for body in handled)
    still = {first.kind, second.kind} & {BodyKind.OBSTACLE, BodyKind.PART}
    if not held or not still or at_end >= max(min(clearance, BESIDE), RESTING):
        return None
    return -RESTING if at_end < RESTING else 0.0
