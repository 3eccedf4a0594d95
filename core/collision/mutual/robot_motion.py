"""The motion of one robot through its program, as other robots meet it."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ...arrays import FloatArray, IntArray
from ...cell.cell import Cell
from ...handling.handling import Handling
from ...motion.emulator.controller import Controller
from ...motion.emulator.run import Run
from ...robot.shape import Sphere
from ...spatial.pose import IDENTITY
from ..deviation.bounds import Deviation, DeviationBounds, by_interval, parts_of
from ..distance.closed_form import hulls_of
from ..proof.boxes import Boxes
from ..proof.enclosure import EnclosedIntervals, Enclosure
from ..scene.bodies import Body, BodyKind, bodies_of
from ..scene.frames import WORLD, frame_tree, place_bodies
from ..scene.outline import outlines_of
from ..scene.part_bodies import part_bodies, part_solids, refuse_parts
from .pair_bounds import Side
from .passing_times import PassingTimes
from .swept_intervals import SweptIntervals, sweep_intervals

_STRIDE = 0.1
"""m that a body moves at most on the intervals which everything begins with."""
_ANYWHERE = 1.0
"""m of deviation from the path from which on a body may be anywhere, and nothing is gained by
halves: bounds are that large where a motion turns back on itself within a zone."""
_NARROWEST = 1e-9
"""Share of a piece below which an interval is not halved any more."""


@dataclass(frozen=True, slots=True)
class OwnBody:
    """A body of one robot, or of its cell alone.

    Args:
        body: what and where it is.
        moves: whether anything moves it.
    """

    body: Body
    moves: bool


class RobotMotion:
    """One robot on its way, in intervals that are halved as proofs ask for it.

    Args:
        name: of the robot in its station.
        controller: that drove it.
        run: path and timing.
        cell: the cell it stands in; of its obstacles those count that external axes carry, or
            that are named.
        obstacles: names of obstacles that other robots have not in their own cells.
        handling: of the cell's parts: on each move they are carried, or lie where it says; None for
            a cell without.
        any_speed: whether bounds hold at every override in (0, 1]; else at the emulated speed.
        residual: m by which a moving body may be elsewhere than the emulated motion says.

    Attributes:
        bodies: the B bodies.
        piece, begin, end: of each interval, as `EnclosedIntervals` has them.
        moves: (L,), index of the move that each is of.
        own_time: (L, 2) s, when it is entered and left at the emulated timing; the robot has always
            stood where it begins, and stands for ever where it ends.

    Raises:
        InputError: the robot has no shapes, a tool is not in the cell, or the cell has parts and
            nobody says where they are.
    """

    def __init__(
        self,
        name: str,
        controller: Controller,
        run: Run,
        cell: Cell,
        obstacles: Sequence[str] = (),
        handling: Handling | None = None,
        *,
        any_speed: bool = False,
        residual: float = 0.0,
    ) -> None:
        if handling is None:
            refuse_parts(cell)
        self.name, self.run, self._residual = name, run, residual
        self._tree = frame_tree(cell.robot)
        self._enclosure = Enclosure.of(run.path)
        standing, there = _bodies(cell, run, obstacles)
        parts, carried = _parts(cell, run, handling)
        self.bodies = [*standing, *parts]
        self._there = np.concatenate([there, carried], axis=1)
        still = Body("", "", "", BodyKind.OBSTACLE, WORLD, Sphere(1.0), IDENTITY)
        outlines = outlines_of([*(own.body for own in self.bodies), still])
        places = np.array([own.body.placement.matrix() for own in self.bodies])
        deviation = Deviation.of(controller, run)
        self._times = PassingTimes(run.timing, deviation.smoothing)
        self._deviations = _deviations(deviation, run, any_speed)
        self._intervals = self._enclosure.over([(0.0, float(run.path.sigma[-1]))])
        self._side = Side(
            SweptIntervals.empty(0, len(self.bodies), len(self._tree.parent)),
            outlines,
            hulls_of([own.body.solid for own in self.bodies]),
            np.ascontiguousarray(places[:, :3, :3]),
            np.ascontiguousarray(places[:, :3, 3]),
        )
        self._widest_first()

    def _widest_first(self) -> None:
        """Halve until no interval is wide."""
        intervals = self._intervals
        done: list[tuple[EnclosedIntervals, SweptIntervals]] = []
        while len(intervals):
            swept = self._swept(intervals)
            wide = ~(swept.motion.max(axis=1) <= _STRIDE) & ~self._narrow(intervals)
            # Deviations do not shrink with the interval.
            wide &= ~((swept.motion - swept.off).max(axis=1) <= 0.5 * _STRIDE)
            wide &= swept.off.max(axis=1) < _ANYWHERE
            done.append((_chosen(intervals, ~wide), swept.chosen(~wide)))
            intervals = self._enclosure.halves(intervals, np.flatnonzero(wide))
        rows = _joined([part for part, _ in done])
        swept = done[0][1].joined(*(part for _, part in done[1:]))
        order = np.argsort(self._sigma(rows, rows.begin), kind="stable")
        self._intervals = _chosen(rows, order)
        self._side = self._side._replace(swept=swept.chosen(order))
        self.first = len(order)
        self._children = np.full(len(order), -1)
        self._describe()

    def _describe(self) -> None:
        """Moves and times of intervals that are new."""
        rows, path = self._intervals, self.run.path
        moves = np.array(path.route.moves)[path.pieces.segment[rows.piece]]
        begin, end = self._sigma(rows, rows.begin), self._sigma(rows, rows.end)
        self.moves: IntArray = moves
        self.own_time: FloatArray = np.stack(self._times.over(begin, end), -1)

    @property
    def side(self) -> Side:
        """All intervals, and the bodies, for the kernels."""
        return self._side

    @property
    def sigma(self) -> FloatArray:
        """(L, 2), σ of the intervals' ends."""
        rows = self._intervals
        return np.stack([self._sigma(rows, rows.begin), self._sigma(rows, rows.end)], -1)

    @property
    def middles(self) -> FloatArray:
        """(L, N), configurations at the middles of the intervals."""
        return self._intervals.boxes.q

    def placed(self, q: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Places of all bodies' solids at configurations (T, N): (T, B, 3, 3) and (T, B, 3) m."""
        frames = self._side.outlines.frame[:-1]
        at = self._side.rotation, self._side.translation
        R, p = place_bodies(self._tree, frames, *at, np.ascontiguousarray(q))
        return R, p

    def there(self, moves: IntArray) -> NDArray[np.bool_]:
        """Which bodies are there on moves (T,), (T, B): those of a tool only where it is driven,
        those of a part where it is carried, or lies, so."""
        return np.asarray(self._there[moves])

    def halved(self, which: IntArray) -> tuple[IntArray, NDArray[np.bool_]]:
        """The first of the two halves of intervals (K,); they are made when first asked for.

        Returns:
            rows, that of the second half one behind; and whether they can be halved at all.
        """
        chosen = np.unique(which)
        new = chosen[self._children[chosen] < 0]
        new = new[~self._narrow(_chosen(self._intervals, new))]
        if len(new):
            count = len(self._intervals)
            halves = self._enclosure.halves(self._intervals, new)
            self._children[new] = count + 2 * np.arange(len(new))
            self._children = np.concatenate([self._children, np.full(len(halves), -1)])
            self._intervals = _joined([self._intervals, halves])
            swept = self._side.swept.joined(self._swept(halves))
            self._side = self._side._replace(swept=swept)
            self._describe()
        found = self._children[which]
        return found, found >= 0

    def _narrow(self, intervals: EnclosedIntervals) -> NDArray[np.bool_]:
        width = intervals.end - intervals.begin
        return np.asarray(width < _NARROWEST * self._enclosure.whole(intervals.piece))

    def _sigma(self, intervals: EnclosedIntervals, parameter: FloatArray) -> FloatArray:
        return self._enclosure.sigma(intervals.piece, parameter)

    def _swept(self, intervals: EnclosedIntervals) -> SweptIntervals:
        count, path = len(intervals), self.run.path
        found = SweptIntervals.empty(count, len(self.bodies), len(self._tree.parent))
        moves = np.array(path.route.moves)[path.pieces.segment[intervals.piece]]
        edges = self._sigma(intervals, intervals.begin), self._sigma(intervals, intervals.end)
        most = np.zeros_like(intervals.boxes.q)
        for bounds in self._deviations:
            most = np.maximum(most, by_interval(bounds, *edges).most)
        sweep_intervals(
            self._tree,
            self._side.outlines,
            intervals.boxes,
            most,
            self._residual,
            self._there[moves],
            found,
        )
        return found


def _bodies(
    cell: Cell, run: Run, obstacles: Sequence[str]
) -> tuple[list[OwnBody], NDArray[np.bool_]]:
    """All bodies that the robot has with any tool, and which are there on which move (M, B)."""
    found: dict[str, OwnBody] = {}
    there: dict[str, set[str]] = {}
    for tool in dict.fromkeys(move.tool for move in run.program.moves):
        for body in bodies_of(cell, tool).bodies:
            moves = body.frame != WORLD
            if body.kind is BodyKind.OBSTACLE and not moves and body.thing not in obstacles:
                continue
            found.setdefault(body.name, OwnBody(body, moves))
            there.setdefault(body.name, set()).add(tool.name)
    present = np.array(
        [[move.tool.name in there[name] for name in found] for move in run.program.moves]
    )
    return list(found.values()), present.reshape(len(run.program.moves), len(found))


def _parts(
    cell: Cell, run: Run, handling: Handling | None
) -> tuple[list[OwnBody], NDArray[np.bool_]]:
    """The bodies of parts at each of their places, and which are there on which move (M, B)."""
    count = len(run.program.moves)
    if handling is None:
        return [], np.zeros((count, 0), dtype=np.bool_)
    solids, _ = part_solids(cell.parts)
    found: list[OwnBody] = []
    there: list[NDArray[np.bool_]] = []
    known: dict[tuple[object, ...], NDArray[np.bool_]] = {}
    for move, arrangement in enumerate(handling.arrangements):
        for placed in arrangement:
            if placed.gone:
                continue
            key = placed.name, placed.held, placed.carrier, placed.pose
            if key not in known:
                known[key] = np.zeros(count, dtype=np.bool_)
                bodies = part_bodies(cell.robot, (placed,), solids)
                found += [OwnBody(body, body.frame != WORLD) for body in bodies]
                there += [known[key]] * len(bodies)
            known[key][move] = True
    return found, np.stack(there, axis=1) if there else np.zeros((count, 0), dtype=np.bool_)


def _deviations(deviation: Deviation, run: Run, any_speed: bool) -> list[DeviationBounds]:
    pieces = run.path.pieces
    found = []
    for part in parts_of(run.path):
        first, last = (int(k) for k in pieces.first_interval[list(part)])
        bounds = deviation.over(first, last)
        found += list(bounds if any_speed else bounds[:1])
    return found


def _chosen(intervals: EnclosedIntervals, which: NDArray[np.bool_] | IntArray) -> EnclosedIntervals:
    piece, begin, end, ends, boxes = intervals
    picked = Boxes._make(a[which] for a in boxes)
    return EnclosedIntervals(piece[which], begin[which], end[which], ends[which], picked)


def _joined(parts: Sequence[EnclosedIntervals]) -> EnclosedIntervals:
    boxes = Boxes._make(map(np.concatenate, zip(*(part.boxes for part in parts), strict=True)))
    piece = np.concatenate([part.piece for part in parts])
    begin, end = (np.concatenate([part[k] for part in parts]) for k in (1, 2))
    return EnclosedIntervals(piece, begin, end, np.concatenate([p.ends for p in parts]), boxes)
