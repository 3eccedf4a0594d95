"""What every optimisation of a program hands back: the new program, what it gained and cost."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import TYPE_CHECKING

import numpy as np

from ...core.arrays import FloatArray
from ...core.display import in_line
from ...core.errors import InputError, Note
from ...core.motion.emulator.controller import Controller
from ...core.motion.emulator.run import Run
from ...core.motion.timing.timing import Timing
from ...core.notebook import PictureCurve, page, picture, table
from ...core.program.program import Program
from ...core.robot.model import Robot
from ...core.spatial.rotation import rotation_vector

if TYPE_CHECKING:
    from ...core.collision.proof.verdict import Certificate
    from ...core.source.reading import Files


_DECIMALS = {"m/s²": 2, "mm": 2, "% of before": 1}
"""Of figures in tables, by their unit."""
_STILL = 1e-9
"""m and rad below which a point has not been moved."""


@dataclass(frozen=True)
class Measures:
    """Figures of one driven program.

    Args:
        time: cycle time, s.
        path_length: of the TCP, m.
        peak_acceleration: largest acceleration of the TCP, m/s², before any smoothing in time.
        lowest: height of the TCP at its lowest, m in the world; None where a tool stands still.
        energy: (N,) ∫ τⱼ² dt of each joint in N² m² s, before any smoothing in time; None where
            the robot's inertias are not known.
        clearance: proven to be kept, m; None where nothing is proven.
    """

    time: float
    path_length: float
    peak_acceleration: float
    lowest: float | None = None
    energy: FloatArray | None = None
    clearance: float | None = None


@dataclass(frozen=True, slots=True)
class FigureRow:
    """A line of the before/after table.

    Args:
        what: the figure.
        unit: of both values.
        before, after: None where not known.
    """

    what: str
    unit: str
    before: float | None
    after: float | None

    @property
    def change(self) -> float | None:
        """In percent of the value before; None where there is none to compare with."""
        if self.before is None or self.after is None or self.before == 0.0:
            return None
        return 100.0 * (self.after - self.before) / self.before

    @property
    def shown(self) -> tuple[str, str]:
        """Both values as tables show them; empty where they are not known."""
        decimals = _DECIMALS.get(self.unit, 4)
        told = [None if v is None else f"{v:.{decimals}f}" for v in (self.before, self.after)]
        return told[0] or "", told[1] or ""


@dataclass(frozen=True, slots=True)
class Moved:
    """How far a via point was moved: the tool's TCP there, or what the robot carries to a tool that
    stands still.

    Args:
        move: index of the move to it.
        distance: m.
        rise: m, upward in the world.
        turn: rad.
    """

    move: int
    distance: float
    rise: float
    turn: float


@dataclass(frozen=True, repr=False)
class Solution:
    """What an optimisation made of a program.

    Args:
        original: the program that was given.
        program: the new one; the same object where nothing better was found.
        before, after: their figures.
        certificate: of the new program; None where no proof was asked for.
        notes: what was found on the way.
        moved: the via points that are elsewhere than before, or turned; empty where the number of
            moves has changed.
        texts: the source files that were changed, or written anew, and read back as the program.
        gained: s at each waypoint, by the index of the move that ends there; see `seconds_gained`.
    """

    original: Program
    program: Program
    before: Measures
    after: Measures
    certificate: Certificate | None = None
    notes: tuple[Note, ...] = ()
    moved: tuple[Moved, ...] = ()
    texts: Files = field(default_factory=dict, repr=False)
    gained: Mapping[int, float] = field(default_factory=dict, repr=False)

    def __repr__(self) -> str:
        said = "proven" if self.proven else "not proven"
        made = (
            f"{self.before.time:.3f} s → {self.after.time:.3f} s" if self.changed else "unchanged"
        )
        return in_line(f"Solution for {self.program.name}: {made}, {said}")

    def _repr_html_(self) -> str:
        rows = [
            (
                row.what,
                row.unit,
                *row.shown,
            )
            for row in self.table()
        ]
        columns = (("", "left"), ("unit", "left"), ("before", "right"), ("after", "right"))
        return page(repr(self)[1:-1], table(columns, rows), self._drawn(), notes=self.notes)

    def _drawn(self) -> str:
        """The waypoints before and after; nothing where they are not all known."""
        curves = []
        for name, program in (("before", self.original), ("after", self.program)):
            points = program.waypoints()
            if points is None:
                return ""
            curves.append(PictureCurve(name, points, points))
        return picture(curves)

    @property
    def files(self) -> dict[str, bytes]:
        """The new program for a folder: changed files with all that they run with.

        Raises:
            InputError: the program was not read from source files.
        """
        from ...core.source.patch.runnable import runnable_files

        return runnable_files(self.original, self.texts)

    @property
    def changed(self) -> bool:
        """Whether the new program is another one than was given."""
        return self.program is not self.original

    @property
    def timed(self) -> str:
        """What the times are of."""
        cycle = self.original.cycle
        passes = 1 if cycle is None else cycle.passes
        return "cycle time" if passes == 1 else f"time of {passes} passes"

    @property
    def proven(self) -> bool:
        """Whether the new program is proven to keep its clearance."""
        return self.certificate is not None and self.certificate.proven

    def table(self, joints: Sequence[str] = ()) -> tuple[FigureRow, ...]:
        """Figures before and after.

        Args:
            joints: names of the axes, for the lines of energy; their numbers if left out.
        """
        before, after = self.before, self.after
        rows = [
            FigureRow(self.timed, "s", before.time, after.time),
            FigureRow("TCP path length", "m", before.path_length, after.path_length),
            FigureRow(
                "peak TCP acceleration", "m/s²", before.peak_acceleration, after.peak_acceleration
            ),
        ]
        lowest = [None if m.lowest is None else 1e3 * m.lowest for m in (before, after)]
        if lowest[0] is not None:
            rows.append(FigureRow("lowest point of the TCP", "mm", *lowest))
        rows += _energy_rows(before.energy, after.energy, joints)
        clearances = [None if m.clearance is None else 1e3 * m.clearance for m in (before, after)]
        rows.append(FigureRow("proven clearance", "mm", *clearances))
        return tuple(rows)


_COUNTS = 5e-4
"""Share of a program's energy from which on a joint has a line."""


def _energy_rows(
    before: FloatArray | None, after: FloatArray | None, joints: Sequence[str]
) -> list[FigureRow]:
    """The energy of all joints and of those that count, in percent of all of it before."""
    if before is None or after is None or not before.sum() > 0.0:
        return []
    names = joints or [str(j + 1) for j in range(len(before))]
    whole = float(before.sum())
    one, other = 100.0 * before / whole, 100.0 * after / whole
    rows = [FigureRow("energy (torque²)", "% of before", 100.0, float(other.sum()))]
    return rows + [
        FigureRow(f"energy, joint {names[j]}", "% of before", float(one[j]), float(other[j]))
        for j in range(len(before))
        if max(one[j], other[j]) >= 100.0 * _COUNTS
    ]


def measure(controller: Controller, run: Run, certificate: Certificate | None = None) -> Measures:
    """The figures of a driven program.

    Args:
        controller: that drove it.
        run: what came of it.
        certificate: of the run, if there is one.
    """
    steps = np.diff(run.trajectory.position, axis=0)
    held = all(move.tool.robot_held for move in run.program.moves)
    return Measures(
        run.duration,
        float(np.linalg.norm(steps, axis=1).sum()),
        _peak_acceleration(run.timing),
        float(run.trajectory.position[:, 2].min()) if held else None,
        squared_torque(controller, run),
        certificate.clearance if certificate is not None and certificate.proven else None,
    )


def moved_points(robot: Robot, before: Run, after: Run) -> tuple[Moved, ...]:
    """The waypoints of a program that are elsewhere than in another, or turned.

    Args:
        robot: that drives both.
        before, after: the programs, driven; with other numbers of moves nothing is reported.
    """
    if len(before.program.moves) != len(after.program.moves):
        return ()
    old, new = _waypoints(robot, before), _waypoints(robot, after)
    return tuple(
        moved
        for index in sorted(old.keys() & new.keys())
        if (moved := _between(index, old[index], new[index])) is not None
    )


def _waypoints(robot: Robot, run: Run) -> dict[int, FloatArray]:
    """Poses (4, 4) in the world of what each move brings to its waypoint."""
    found = {}
    for k, index in enumerate(run.path.route.moves):
        flange = robot.flange_pose(run.path.segments.ends.q[k, 1]).matrix()
        tool = run.program.moves[index].tool
        found[index] = flange @ tool.tcp.matrix() if tool.robot_held else flange
    return found


def _between(index: int, before: FloatArray, after: FloatArray) -> Moved | None:
    shift = after[:3, 3] - before[:3, 3]
    turn = float(np.linalg.norm(rotation_vector(after[:3, :3] @ before[:3, :3].T)))
    distance = float(np.linalg.norm(shift))
    if distance < _STILL and turn < _STILL:
        return None
    return Moved(index, distance, float(shift[2]), turn)


def _peak_acceleration(timing: Timing) -> float:
    """p' σ̈ + p'' σ̇² at both ends of every interval."""
    states, stamp = timing.along.states, timing.stamp
    left = timing.path.pieces.interval_samples
    ends = np.stack([left, left + 1], -1)
    x = np.stack([stamp.x[:-1], stamp.x[1:]], -1)[..., None]
    rate, bend = states.v[ends, :3], states.a[ends, :3]
    return float(np.linalg.norm(rate * stamp.u[:, None, None] + bend * x, axis=-1).max())


def squared_torque(controller: Controller, run: Run) -> FloatArray | None:
    """(N,) ∫ τⱼ² dt of each joint, N² m² s; None where the robot's inertias are not known."""
    try:
        made = controller.energy(run.program, run.timing)
    except InputError:
        return None
    steps = run.timing.end - run.timing.begin
    return np.asarray(0.5 * np.einsum("k,kej->j", steps, made.torque**2))
