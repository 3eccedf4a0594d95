"""The base from which a robot drives a program fastest, proven to keep its clearance there.

Targets stay where they are in the world; the base moves. Bases all over the range are looked at by
inverse kinematics in closed form, which says what is out of reach and how far the joints have to
go; the best of them are emulated, and searched around in ever smaller steps; the fastest that is
proven is the answer.
"""

from __future__ import annotations

import math
from collections import Counter
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property
from itertools import product

import numpy as np

from ...core.arrays import FloatArray
from ...core.cell.cell import Cell
from ...core.collision.handled_scenes import scenes_along
from ...core.collision.proof.certificate import SceneOf, certify, scenes_of
from ...core.collision.proof.verdict import Certificate
from ...core.errors import InputError, MotionError
from ...core.handling.arrangement import Arrangement
from ...core.handling.handling import Handling, handling_of
from ...core.motion.emulator.controller import Controller
from ...core.motion.emulator.run import Run
from ...core.program.program import Program
from ...core.program.target import JointTarget
from ...core.program.tool import Tool
from ...core.robot.model import Robot
from ...core.spatial.pose import Pose
from ..improve.solution import squared_torque
from .reach import Stops

Shift = tuple[float, float, float, float]
"""m along x, y, z of the world, and rad about z, by which a base is elsewhere than it was."""
BesideOthers = Callable[[Controller, Run], Certificate | None]
"""Why a program as driven by a robot that stands somewhere does not hold beside other robots; None
if it does."""
_EMULATED = 16
"""Bases of the grid that are emulated."""
_TURNS = 2
"""Of them at one place, turned about the vertical."""
_FOLLOWED = 3
"""Of them searched around."""
_HALVINGS = 3
_PROVEN = 24
"""Bases that are tried to be proven, the fastest first."""
_SAME = 1e-4
"""m, and of quaternions, within which a part is held, or lies, as it did."""
_CLEARLY = 1e-4
"""s by which a base must be faster to be another one."""


@dataclass(frozen=True)
class PlacementTask:
    """Where a base may be.

    Args:
        room: m each way along x, y and z of the world, and rad each way about z, from where the
            base is now.
        steps: of the grid each way, along x, y, z and about z.
        clearance: m to keep.
        start: where the robot stands; None for the program's own start.
        resolution: m to which the clearance that there is is proven.

    Raises:
        InputError: a range is negative.
    """

    room: Shift
    steps: tuple[int, int, int, int] = (4, 4, 1, 4)
    clearance: float = 0.0
    start: JointTarget | None = None
    resolution: float = 1e-4

    def __post_init__(self) -> None:
        if not all(0.0 <= each < math.inf for each in self.room):
            raise InputError(f"ranges of a base are zero or more, not {self.room}")

    @property
    def grid(self) -> list[Shift]:
        """All bases that are looked at first."""
        sides = [
            np.linspace(-room, room, 2 * count + 1) if room > 0.0 else np.zeros(1)
            for room, count in zip(self.room, self.steps, strict=True)
        ]
        return [(float(x), float(y), float(z), float(t)) for x, y, z, t in product(*sides)]


@dataclass(frozen=True)
class PlacedBase:
    """A base with the program as driven from there.

    Args:
        shift: from the base as it is.
        base: in the world.
        run: the program as driven.
        certificate: of its clearance; None if it was not asked for.
        energy: ∫ τ² dt of all joints, N² m² s; None where it was not asked for, or the robot's
            inertias are not known.
    """

    shift: Shift
    base: Pose
    run: Run
    certificate: Certificate | None = None
    energy: float | None = None


@dataclass(frozen=True)
class Placement:
    """What a search for a base found.

    Args:
        before: the base as it is; None where the program cannot be driven from there.
        best: the fastest that is proven; None if none is.
        looked: bases looked at by inverse kinematics.
        reached: of them those from which all targets are in reach.
        emulated: bases from which the program was driven.
        refused: why the fastest that were not proven are not: a base, and its certificate.
    """

    before: PlacedBase | None
    best: PlacedBase | None
    looked: int
    reached: int
    emulated: int
    refused: tuple[PlacedBase, ...]


def place(
    controller_at: Callable[[Robot], Controller],
    program: Program,
    cell: Cell,
    task: PlacementTask,
    tell: Callable[[str], None] = lambda _: None,
    beside: BesideOthers | None = None,
) -> Placement:
    """Find the base from which a program is driven fastest, and prove its clearance.

    Args:
        controller_at: drives a robot that stands somewhere.
        program: its targets are in the world; its moves carry the parts that are held.
        cell: what stands around; its robot stands where the base is now.
        task: where the base may be.
        tell: called with what is being done.
        beside: what other robots say of the program as driven from a base.

    Raises:
        InputError: the robot has external axes, or no target stays where it is.
    """
    if cell.robot.external_axes:
        raise InputError(
            f"{cell.robot.name} stands on or beside external axes: a base is found for arms that "
            "stand by themselves"
        )
    return _Search(controller_at, program, cell, task, tell, beside).run()


@dataclass
class _Search:
    controller_at: Callable[[Robot], Controller]
    program: Program
    cell: Cell
    task: PlacementTask
    tell: Callable[[str], None]
    beside: BesideOthers | None = None
    known: dict[Shift, PlacedBase | None] = field(default_factory=dict)

    def run(self) -> Placement:
        """Coarse to fine, then proven."""
        stops = Stops.of(self.cell.robot, self.program, self.task.start)
        if stops.anywhere:
            raise InputError(
                "every target is given by joint values and moves with the base: any base will do"
            )
        grid = self.task.grid
        self.tell(f"looking at {len(grid)} bases")
        routes = {shift: stops.route(self._robot(shift)) for shift in grid}
        reached = [shift for shift, (seconds, _) in routes.items() if math.isfinite(seconds)]
        before = self._driven((0.0, 0.0, 0.0, 0.0))
        places: Counter[Shift] = Counter()
        for shift in sorted(reached, key=lambda shift: routes[shift][0]):
            # Turned about the vertical a base is often much the same.
            place = (*shift[:3], 0.0)
            if places[place] < _TURNS and self._clear(shift, stops.tools, routes[shift][1]):
                self.tell(f"driving from {len(self.known)} bases")
                places[place] += self._driven(shift) is not None
            if sum(places.values()) >= _EMULATED:
                break
        for placed in self._fastest()[:_FOLLOWED]:
            self._around(placed)
        best, refused = self._proven()
        if before is not None:
            before = best if best is not None and best.shift == before.shift else self._with(before)
        return Placement(before, best, len(grid), len(reached), len(self.known), tuple(refused))

    def _clear(self, shift: Shift, tools: Sequence[Tool], q: FloatArray) -> bool:
        """Whether nothing collides at the targets (M, N)."""
        # Where parts are handled they touch: that is looked at when a base is proven.
        scenes = scenes_of(replace(self.cell, robot=self._robot(shift), parts=()))
        return not any(
            scenes(tool).collides(q[[k for k, other in enumerate(tools) if other == tool]]).any()
            for tool in dict.fromkeys(tools)
        )

    def _around(self, placed: PlacedBase) -> None:
        """Better neighbours, in ever smaller steps."""
        steps = list(self._steps)
        for _ in range(_HALVINGS):
            steps = [0.5 * step for step in steps]
            while True:
                self.tell(f"driving from {len(self.known)} bases")
                near = [self._driven(shift) for shift in self._neighbours(placed.shift, steps)]
                faster = min(
                    (one for one in near if one is not None),
                    key=lambda one: one.run.duration,
                    default=placed,
                )
                if faster.run.duration >= placed.run.duration - _CLEARLY:
                    break
                placed = faster

    def _neighbours(self, shift: Shift, steps: list[float]) -> Iterator[Shift]:
        for axis, step in enumerate(steps):
            for sign in (-1.0, 1.0):
                moved = list(shift)
                moved[axis] += sign * step
                if step > 0.0 and abs(moved[axis]) <= self.task.room[axis] + 1e-12:
                    yield (moved[0], moved[1], moved[2], moved[3])

    def _robot(self, shift: Shift) -> Robot:
        x, y, z, turn = shift
        base = self.cell.robot.base
        a, b, c = base.position
        turned = Pose((0.0, 0.0, 0.0), (math.cos(0.5 * turn), 0.0, 0.0, math.sin(0.5 * turn)))
        upright = turned @ Pose((0.0, 0.0, 0.0), base.quaternion)
        return self.cell.robot.with_base(Pose((a + x, b + y, c + z), upright.quaternion))

    def _driven(self, shift: Shift) -> PlacedBase | None:
        """The program from a base; None if it cannot be driven there."""
        if shift not in self.known:
            robot = self._robot(shift)
            try:
                run = self.controller_at(robot).run(self.program, self.task.start)
            except MotionError:
                self.known[shift] = None
            else:
                placed = PlacedBase(shift, robot.base, run)
                self.known[shift] = placed if self._alike(robot) else None
        return self.known[shift]

    def _alike(self, robot: Robot) -> bool:
        """Whether the same parts are taken and released on the same moves and at the same places
        from where a robot stands: joint targets move with the base, and parts do not."""
        if not self.cell.parts:
            return True
        made = handling_of(self.program, replace(self.cell, robot=robot), self.task.start)
        given = self._given_handling
        return made.changes == given.changes and all(
            one.gone or _at_one_place(one.pose, other.pose)
            for mine, theirs in zip(_places(made), _places(given), strict=True)
            for one, other in zip(mine, theirs, strict=True)
        )

    @cached_property
    def _given_handling(self) -> Handling:
        return handling_of(self.program, self.cell, self.task.start)

    def _scenes(self, placed: PlacedBase) -> SceneOf:
        """The cell along each move, with the robot where it stands."""
        cell = replace(self.cell, robot=self._robot(placed.shift))
        handling = None
        if cell.parts:
            handling = handling_of(self.program, cell, self.task.start)
        wanted = self.task.clearance
        return scenes_along(cell, handling, self.program, lambda: placed.run.path, wanted)

    def _fastest(self) -> list[PlacedBase]:
        found = [placed for placed in self.known.values() if placed is not None]
        return sorted(found, key=lambda placed: placed.run.duration)

    def _proven(self) -> tuple[PlacedBase | None, list[PlacedBase]]:
        """The fastest that is proven, and those before it; none beside one that is not."""
        refused: list[PlacedBase] = []
        for placed in self._fastest():
            if any(self._beside(placed, other) for other in refused) or len(refused) == _PROVEN:
                continue
            certified = self._with(placed)
            if _is_proven(certified):
                return (self._nearer(certified) if refused else certified), refused
            refused.append(certified)
        return None, refused

    def _nearer(self, best: PlacedBase) -> PlacedBase:
        """A faster one beside one that is proven: the fastest of all were not."""
        steps = list(self._steps)
        for _ in range(_HALVINGS):
            steps = [0.5 * step for step in steps]
            near = [self._driven(shift) for shift in self._neighbours(best.shift, steps)]
            faster = sorted(
                (one for one in near if one and one.run.duration < best.run.duration - _CLEARLY),
                key=lambda one: one.run.duration,
            )
            best = next((made for one in faster if (made := self._certified(one))), best)
        return best

    def _certified(self, placed: PlacedBase) -> PlacedBase | None:
        """With its certificate, if it is proven."""
        made = self._with(placed)
        return made if _is_proven(made) else None

    def _beside(self, placed: PlacedBase, other: PlacedBase) -> bool:
        """Whether two bases are less than half a step of the grid apart."""
        pairs = [*zip(placed.shift, other.shift, self._steps, strict=True)][:3]
        return all(abs(a - b) < 0.5 * step or step == 0.0 for a, b, step in pairs)

    @property
    def _steps(self) -> Shift:
        """Of the grid."""
        room, count = self.task.room, self.task.steps
        x, y, z, turn = (r / n if n else 0.0 for r, n in zip(room, count, strict=True))
        return x, y, z, turn

    def _with(self, placed: PlacedBase) -> PlacedBase:
        """With its certificate and what it takes of energy."""
        self.tell(f"proving a base, {placed.run.duration:.3f} s")
        robot = self._robot(placed.shift)
        scenes = self._scenes(placed)
        controller = self.controller_at(robot)
        certificate = certify(
            controller,
            placed.run,
            scenes,
            self.task.clearance,
            resolution=self.task.resolution,
        )
        if self.beside is not None and certificate.proven:
            certificate = self.beside(controller, placed.run) or certificate
        energy = squared_torque(controller, placed.run)
        return replace(
            placed,
            certificate=certificate,
            energy=None if energy is None else float(energy.sum()),
        )


def _is_proven(placed: PlacedBase) -> bool:
    return placed.certificate is not None and placed.certificate.proven


def _places(handling: Handling) -> tuple[Arrangement, ...]:
    """Where parts are on each move, and behind the last."""
    return (*handling.arrangements, handling.last)


def _at_one_place(one: Pose, other: Pose) -> bool:
    """Whether two poses are one, but for rounding."""
    off = one.inverse() @ other
    return math.hypot(*off.position) < _SAME and abs(off.quaternion[0]) > 1.0 - _SAME**2
