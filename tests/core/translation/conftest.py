"""Two robots and programs in the space that both reach."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
import pytest
from hypothesis import strategies as st

from flyby.core.motion.emulator.controller import Controller
from flyby.core.motion.emulator.run import Run
from flyby.core.program.move import Move, MoveC, MoveJ, MoveL
from flyby.core.program.program import Program
from flyby.core.program.speed import Speed
from flyby.core.program.target import JointTarget, PoseTarget
from flyby.core.program.zone import FINE, Radius
from flyby.core.registry import find_robot, find_vendor
from flyby.core.robot.model import Robot
from flyby.core.spatial.pose import IDENTITY, Pose
from flyby.core.spatial.rotation import matrix_from_rotation_vector
from flyby.core.translation.corners import EmulatedCorner, corners_of
from flyby.core.translation.translate import Translation, translate
from flyby.core.vendor import Vendor

ABB, KUKA, UR = "abb/irb1600-6-145", "kuka/kr30-3", "ur/ur10e"
SPEEDS = {
    ABB: Speed(tcp=0.3, reorientation=2.0),
    KUKA: Speed(tcp=0.3, joint_fraction=0.3, tcp_acceleration=2.0),
    UR: Speed(tcp=0.3, tcp_acceleration=1.2, joint=0.8, joint_acceleration=1.4),
}
JOINT_FIELDS = {
    ABB: ("tcp", "reorientation"),
    KUKA: ("joint_fraction",),
    UR: ("joint", "joint_acceleration"),
}
LINE_FIELDS = {
    ABB: ("tcp", "reorientation"),
    KUKA: ("tcp", "tcp_acceleration"),
    UR: ("tcp", "tcp_acceleration"),
}
CENTRES = {
    frozenset({ABB, KUKA}): (1.05, 0.0, 0.75),
    frozenset({ABB, UR}): (0.7, 0.0, 0.4),
    frozenset({KUKA, UR}): (0.9, -0.05, 0.3),
}
"""m, the middle of what both robots reach with the flange down."""


@dataclass(frozen=True)
class Pair:
    """Two robots."""

    old: str
    new: str

    def _repr_pretty_(self, printer, cycle) -> None:
        printer.text(f"{self.old} -> {self.new}")

    @property
    def back(self) -> Pair:
        return Pair(self.new, self.old)

    def run_old(self, program: Program, start: JointTarget | None = None) -> Run:
        return Controller(*side(self.old)).run(program, start)

    def run_new(self, made: Translation) -> Run:
        return Controller(*side(self.new)).run(made.program, made.start)

    def robot(self, name: str) -> Robot:
        return side(name)[1]

    def programs(self, *kinds: type) -> st.SearchStrategy[Program]:
        return programs(self, kinds or (MoveJ, MoveL, MoveC))

    @staticmethod
    def corners(made: Run) -> dict[int, EmulatedCorner]:
        """The corner at the end of each move that is driven."""
        return dict(zip(made.path.route.moves, corners_of(made.path), strict=False))

    def translate(self, program: Program, base: Pose | None = None) -> Translation:
        return translate(program, side(self.old), side(self.new), base or IDENTITY)

    def down(self, offset: Sequence[float] = (0.0, 0.0, 0.0), turn=(0.0, 0.0, 0.0)) -> Pose:
        """The flange down, moved by ``offset`` m and turned by ``turn`` rad."""
        matrix = np.eye(4)
        turned = matrix_from_rotation_vector(np.array(turn, dtype=float))
        matrix[:3, :3] = np.diag([-1.0, 1.0, -1.0]) @ turned
        matrix[:3, 3] = np.add(
            CENTRES.get(frozenset({self.old, self.new}), (0.9, -0.05, 0.3)), offset
        )
        return Pose.from_matrix(matrix)

    def target(self, offset=(0.0, 0.0, 0.0), turn=(0.0, 0.0, 0.0), name=None) -> PoseTarget:
        return PoseTarget(self.down(offset, turn), name=name)

    def joint(self, offset=(0.0, 0.0, 0.0), zone=FINE, turn=(0.0, 0.0, 0.0), **speed) -> MoveJ:
        return MoveJ(self.target(offset, turn), self.speed(MoveJ, **speed), zone)

    def line(self, offset=(0.0, 0.0, 0.0), zone=FINE, turn=(0.0, 0.0, 0.0), **speed) -> MoveL:
        return MoveL(self.target(offset, turn), self.speed(MoveL, **speed), zone)

    def speed(self, kind: type, **more: float) -> Speed:
        fields = (JOINT_FIELDS if kind is MoveJ else LINE_FIELDS)[self.old]
        known = {name: getattr(SPEEDS[self.old], name) for name in fields}
        return Speed(**{**known, **more})


def side(name: str) -> tuple[Vendor, Robot]:
    return find_vendor(name.split("/")[0]), find_robot(name)


PAIRS = [Pair(a, b) for a in (ABB, KUKA, UR) for b in (ABB, KUKA, UR) if a != b]


@pytest.fixture(params=PAIRS, ids=lambda pair: f"{pair.old[:4]}-{pair.new[:4]}")
def pair(request) -> Pair:
    return request.param


@pytest.fixture
def between():
    """Makes a pair of two of ``abb``, ``kuka`` and ``ur``."""
    names = {name.split("/")[0]: name for name in (ABB, KUKA, UR)}
    return lambda old, new: Pair(names[old], names[new])


@st.composite
def programs(draw: st.DrawFn, pair: Pair, kinds: Sequence[type] = (MoveJ, MoveL, MoveC)) -> Program:
    """Fly-by programs in the middle of what both robots reach."""
    axis = st.integers(-12, 12).map(lambda cm: cm / 100)
    turn = st.integers(-20, 20).map(lambda hundredth: hundredth / 100)
    points: list[np.ndarray] = [np.zeros(3)]
    moves: list[Move] = [pair.joint()]
    for _ in range(draw(st.integers(2, 6))):
        far = st.tuples(axis, axis, axis).map(np.array)
        point = draw(far.filter(lambda p, q=points[-1]: np.linalg.norm(p - q) > 0.08))
        kind = draw(st.sampled_from(list(kinds)))
        zone = Radius(draw(st.integers(2, 30)) / 1000)
        target = pair.target(point, draw(st.tuples(turn, turn, turn)))
        move = kind(target, pair.speed(kind), zone, **_via(kind, pair, points[-1], point))
        moves.append(move)
        points.append(point)
    return Program((*moves[:-1], replace(moves[-1], zone=FINE)))


def _via(kind: type, pair: Pair, begin: np.ndarray, end: np.ndarray) -> dict[str, PoseTarget]:
    """An auxiliary point beside the middle of the chord."""
    if kind is not MoveC:
        return {}
    along = (end - begin) / np.linalg.norm(end - begin)
    aside = np.cross(along, np.eye(3)[int(np.argmin(np.abs(along)))])
    return {"via": pair.target(0.5 * (begin + end) + 0.03 * aside / np.linalg.norm(aside))}
