"""Proof that two robots keep a clearance: in time, at any time, or in what an interlock lets be.

What may come near is found by trees of boxes (`interval_tree`), and each pair of bodies on a pair
of intervals then halved, the one that moves more, until it is proven or found too near.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence

import numpy as np
from numpy.typing import NDArray

from ...arrays import FloatArray, IntArray
from ..distance.answers import Distances
from ..distance.closed_form import Hulls, measure
from ..distance.coal_engine import CoalEngine
from ..distance.containment import Nesting
from ..distance.engine import BodyPoses
from .carried_work import CarriedPairs, CarriedWork
from .conflict import Conflict, ConflictCause, PairVerdict
from .handed_part import AwaitedPairs, AwaitedPart, HandedPairs, HandedPart
from .interval_tree import interval_tree, near_pairs
from .meetings import InTurn, Meetings
from .pair_bounds import PairBounds, bound_measured, bound_pairs, place_solids
from .robot_motion import RobotMotion

ROUNDING = 1e-6
"""m by which measured distances may be off."""
TOLERANCE = 1e-5
"""m by which what is proven may stay below the clearance asked for."""
_WIDE = 0.25
"""m of motion above which bodies are not measured by an engine."""
_LOCATED = 2e-3
"""m of motion below which a place that is too near counts as found."""
_STALLED = 1e-4
"""m of motion below which nothing is halved any more."""
_FOLLOWED = 64
"""Pairs of intervals that are near at their middles, of each pair of moves, which are halved first:
one of them that is found is enough."""
_CHUNK = 512
_MOST_NEAR = 8_000_000
"""Pairs of intervals and bodies that are looked at first, at most."""
BUDGET = 20_000_000


class PairProver:
    """Two robots.

    Args:
        one, other: their motions.
        allowed: pairs of names of things that may touch, of the one and of the other.
        handed: parts that one of them hands to the other.
        awaited: parts that one of them gets of a third robot.
        carried: moves that one of them makes on what the other one turns.
    """

    def __init__(
        self,
        one: RobotMotion,
        other: RobotMotion,
        allowed: Sequence[tuple[str, str]] = (),
        handed: Sequence[HandedPart] = (),
        awaited: Sequence[AwaitedPart] = (),
        carried: Sequence[CarriedWork] = (),
    ) -> None:
        self.one, self.other = one, other
        self.pairs: IntArray = np.array(
            [
                (a, b)
                for a, first in enumerate(one.bodies)
                for b, second in enumerate(other.bodies)
                if (first.moves or second.moves)
                and (first.body.part, second.body.part) not in allowed
            ],
            dtype=np.int64,
        ).reshape(-1, 2)
        solids = [own.body.solid for own in (*one.bodies, *other.bodies)]
        self._engine = CoalEngine(solids, Nesting(solids))
        self._count = len(solids)
        self.handed, self.carried = tuple(handed), tuple(carried)
        self._without: list[HandedPairs | AwaitedPairs | CarriedPairs] = [
            *(HandedPairs(part, (one, other), self.pairs) for part in handed),
            *(AwaitedPairs(part, (one, other), self.pairs) for part in awaited),
            *(CarriedPairs(work, (one, other), self.pairs) for work in carried),
        ]

    def prove(self, clearance: float, meetings: Meetings, budget: int = BUDGET) -> PairVerdict:
        """Whether the two keep a clearance of each other.

        Args:
            clearance: m.
            meetings: when they may be where at once.
            budget: how many bounds may be made.
        """
        verdict = _Search(self, clearance, meetings, budget).run()
        for part in self.handed:
            for conflict in self._out_of_turn(part, meetings.in_turn(part)):
                verdict.conflicts.setdefault(conflict.moves, conflict)
        for work in self.carried:
            for conflict in work.conflicts():
                verdict.conflicts.setdefault(conflict.moves, conflict)
        return verdict

    def _out_of_turn(self, part: HandedPart, turn: InTurn) -> Iterator[Conflict]:
        """What is wrong with how a part changes hands."""
        motions = (self.one, self.other)
        taker = motions[1 - part.giver]
        off = [move for move in taker.run.path.route.moves if move > part.moves[1]]
        found = [] if turn.brought else [(ConflictCause.EARLY, part.moves, "")]
        if turn.brought and not (turn.held or part.rests):
            found.append((ConflictCause.DROPPED, part.moves, ""))
        if not turn.let_go and off:
            found.append((ConflictCause.TORN, (part.moves[0], off[0]), ""))
        found += [(ConflictCause.OWN_CELL, part.moves, why) for why in part.unproven]
        for cause, own, why in found:
            moves = own if part.giver == 0 else own[::-1]
            names = part.names if part.giver == 0 else part.names[::-1]
            rows = [
                int(np.flatnonzero(motion.moves == move)[-1])
                for motion, move in zip(motions, moves, strict=True)
            ]
            times = [_span(motion.own_time[row]) for motion, row in zip(motions, rows, strict=True)]
            yield Conflict(cause, moves, names, None, (times[0], times[1]), (rows[0], rows[1]), why)

    def skipped(self, items: IntArray) -> NDArray[np.bool_]:
        """Which items (K, 3) are none, as a part changes hands there."""
        out = np.zeros(len(items), dtype=np.bool_)
        for pairs in self._without:
            out |= pairs.skipped(*items.T)
        return out

    def measure(self, items: IntArray, wanted: float, found: PairBounds) -> None:
        """Distances and normals of items at the middles, by the engine.

        What is so far apart that the two keep ``wanted`` m all along is not measured any further.
        """
        sides, shift = (self.one.side, self.other.side), len(self.one.bodies)
        placed, motion = [], np.zeros(len(items))
        for column, side in enumerate(sides):
            rows, bodies = (
                np.ascontiguousarray(x) for x in (items[:, column], self.pairs[items[:, 2], column])
            )
            turned, at = np.empty((len(items), 3, 3)), np.empty((len(items), 3))
            place_solids(side, rows, bodies, turned, at)
            placed.append((bodies + column * shift, turned, at))
            motion += side.swept.motion[rows, bodies]
        within = motion + wanted + ROUNDING
        (first, Ra, pa), (second, Rb, pb) = placed
        R, p = np.empty((self._count, 3, 3)), np.empty((self._count, 3))
        asked = zip(first.tolist(), second.tolist(), within.tolist(), strict=True)
        for k, (a, b, most) in enumerate(asked):
            R[a], R[b], p[a], p[b] = Ra[k], Rb[k], pa[k], pb[k]
            # Other places every time: the engine keeps what it makes of them.
            witness = self._engine.distance(a, b, BodyPoses(R, p), most)
            if witness is None:
                found.distance[k] = most
            else:
                found.distance[k], found.normal[k] = witness.distance, witness.normal

    def nearest(
        self,
        q: FloatArray,
        other: FloatArray,
        moves: tuple[IntArray, IntArray] | None = None,
        *,
        at_once: bool = False,
    ) -> tuple[float, int, int]:
        """The least distance at instants at which both stand somewhere.

        Args:
            q, other: (T, N), (T, M), configurations of the one and of the other.
            moves: (T,) each, the moves that they are on, where bodies are only there on some.
            at_once: whether both are there by one clock, so that what the one turns is where the
                other works on it; else it is left out.

        Returns:
            m, the instant and the row of `pairs`.
        """
        sides = self.one.side, self.other.side
        shift = np.array([0, len(self.one.bodies)])
        least = math.inf, 0, 0
        for start in range(0, len(q), _CHUNK):
            part = slice(start, start + _CHUNK)
            placed = [
                motion.placed(rows[part]) for motion, rows in ((self.one, q), (self.other, other))
            ]
            R, p = (np.concatenate(both, axis=1) for both in zip(*placed, strict=True))
            hulls = Hulls(*map(np.concatenate, zip(*(s.hulls for s in sides), strict=True)))
            found = Distances.farther(len(R), len(self.pairs), least[0])
            bound = measure(hulls, self.pairs + shift, R, p, least[0], found.numbers)
            if moves is not None:
                gone = ~self._there(moves[0][part], moves[1][part])
                for without in self._without:
                    if at_once and isinstance(without, CarriedPairs):
                        continue
                    at, own = (q[part], other[part]), (moves[0][part], moves[1][part])
                    gone |= without.skipped_at(at, own, len(self.pairs))
                found.distance[gone] = bound[gone] = np.inf
            k, row = np.unravel_index(int(found.distance.argmin()), found.distance.shape)
            if found.distance[k, row] < least[0]:
                least = float(found.distance[k, row]), start + int(k), int(row)
            left = np.argwhere(bound < least[0])
            for k, row in left[np.argsort(bound[tuple(left.T)])].tolist():
                if bound[k, row] >= least[0]:
                    break
                a, b = self.pairs[row] + shift
                at = BodyPoses(R[k], p[k])
                witness = self._engine.distance(int(a), int(b), at, least[0])
                if witness is not None:
                    least = float(witness.distance), start + k, row
        return least

    def _there(self, moves: IntArray, other: IntArray) -> NDArray[np.bool_]:
        """(T, P), whether both bodies of a pair are there on moves (T,)."""
        first, second = self.pairs.T
        return np.asarray(self.one.there(moves)[:, first] & self.other.there(other)[:, second])

    def names(self, row: int) -> tuple[str, str]:
        """Names of the bodies of a pair."""
        a, b = self.pairs[row]
        return self.one.bodies[a].body.name, self.other.bodies[b].body.name


class _Search:
    def __init__(
        self, prover: PairProver, clearance: float, meetings: Meetings, budget: int
    ) -> None:
        self._prover, self._meetings, self._left = prover, meetings, budget
        self._wanted = max(clearance - TOLERANCE, 1e-9)
        self._verdict = PairVerdict(clearance)
        self._first = meetings.until
        self._later: list[IntArray] = []

    def run(self) -> PairVerdict:
        """Look at everything that may come near."""
        items = self._begun()
        while len(items) or self._later:
            if not len(items):
                items = self._meeting(self._later.pop())
                continue
            self._verdict.looks += len(items)
            self._left -= len(items)
            found = self._bounds(items)
            open_ones = ~(found.lower >= self._wanted)
            items, found = items[open_ones], found.chosen(open_ones)
            if self._left < 0:
                items = np.concatenate([items, *self._later])
                unknown, every = PairBounds.unknown(len(items)), np.ones(len(items), dtype=bool)
                self._note(items, unknown, every, ConflictCause.EXHAUSTED)
                break
            items = self._judged(items, found)
            items = self._halved(items)
        return self._verdict

    def _begun(self) -> IntArray:
        prover, meetings = self._prover, self._meetings
        trees = [
            interval_tree(m.side.swept, m.first, clock(m.own_time[: m.first]))
            for m, clock in zip((prover.one, prover.other), meetings.clocks, strict=True)
        ]
        most = min(self._left, _MOST_NEAR)
        items = near_pairs(*trees, prover.pairs, self._wanted, meetings.apart, most)
        if len(items) == most:
            # What comes behind these is not known.
            unknown, every = PairBounds.unknown(1), np.ones(1, dtype=bool)
            self._note(items[-1:], unknown, every, ConflictCause.EXHAUSTED)
            return np.empty((0, 3), dtype=np.int64)
        return self._meeting(items)

    def _meeting(self, items: IntArray) -> IntArray:
        """Those whose intervals can be passed at once, and are not decided yet."""
        prover, meetings = self._prover, self._meetings
        i, j = items[:, 0], items[:, 1]
        kept = ~prover.skipped(items)
        if meetings.apart < math.inf:
            first, second = self._clocked(i, j)
            kept &= first[:, 0] <= second[:, 1] + meetings.apart
            kept &= second[:, 0] <= first[:, 1] + meetings.apart
            # What comes behind a wait without end is never passed.
            kept &= (first[:, 0] < math.inf) & (second[:, 0] < math.inf)
            if not meetings.every:
                kept &= np.maximum(first[:, 0], second[:, 0]) - meetings.apart <= self._first
        if meetings.together is not None:
            kept &= meetings.together(i, j)[0]
        if meetings.every and self._verdict.conflicts:
            groups = prover.one.moves[i], prover.other.moves[j]
            decided = np.zeros((groups[0].max(initial=0) + 1, groups[1].max(initial=0) + 1), bool)
            for a, b in self._verdict.conflicts:
                if a < decided.shape[0] and b < decided.shape[1]:
                    decided[a, b] = True
            kept &= ~decided[groups]
        return items[kept]

    def _clocked(self, i: IntArray, j: IntArray) -> tuple[FloatArray, FloatArray]:
        prover, (one, other) = self._prover, self._meetings.clocks
        return one(prover.one.own_time[i]), other(prover.other.own_time[j])

    def _bounds(self, items: IntArray) -> PairBounds:
        prover = self._prover
        sides = prover.one.side, prover.other.side
        found = PairBounds.unknown(len(items))
        bound_pairs(*sides, items, prover.pairs, self._wanted, found)
        motion = self._travel(items)
        asked = found.engine & ~(found.lower >= self._wanted) & (motion.sum(axis=1) < _WIDE)
        if asked.any():
            chosen = found.chosen(asked)
            prover.measure(items[asked], self._wanted, chosen)
            bound_measured(*sides, items[asked], prover.pairs, chosen)
            for whole, part in zip(found, chosen, strict=True):
                whole[asked] = part
        return found

    def _travel(self, items: IntArray) -> FloatArray:
        """(K, 2) m, how far the paths move both bodies at most; infinite where not known."""
        prover = self._prover
        of = []
        for side, motion in ((0, prover.one), (1, prover.other)):
            swept, row = motion.side.swept, items[:, side]
            body = prover.pairs[items[:, 2], side]
            of.append(swept.motion[row, body] - np.nan_to_num(swept.off[row, body]))
        return np.stack(of, -1)

    def _judged(self, items: IntArray, found: PairBounds) -> IntArray:
        """Note what is too near, or as good as too near; what is to be halved."""
        travel, known = self._travel(items).sum(axis=1), np.isfinite(found.distance)
        distance = np.where(known, found.distance, np.inf) + ROUNDING
        # Where they may be at once all along, halves tell no more than the whole.
        located = (travel < _LOCATED) | self._always_at_once(items)
        near = located & (distance < self._wanted)
        # However short an interval is, deviations from the path stay what they are.
        off = located & ~near & (distance + travel - self._off(items) < self._wanted)
        stalled = (travel < _STALLED) & ~near & ~off
        for chosen, cause in (
            (near, ConflictCause.NEAR),
            (off, ConflictCause.DEVIATION),
            (stalled, ConflictCause.STALLED),
        ):
            self._note(items, found, chosen, cause)
        left = ~(near | off | stalled)
        put_off = self._many(items, np.where(left & (distance < self._wanted), distance, np.inf))
        if put_off.any():
            self._later.append(items[put_off])
        return self._meeting(items[left & ~put_off])

    def _many(self, items: IntArray, distance: FloatArray) -> NDArray[np.bool_]:
        """Which items (K,) at finite distances are not among the nearest of their pair of moves."""
        prover, order = self._prover, np.argsort(distance, kind="stable")
        moves = prover.one.moves[items[order, 0]], prover.other.moves[items[order, 1]]
        group = np.unique(np.stack(moves, -1), axis=0, return_inverse=True)[1].ravel()
        again = np.argsort(group, kind="stable")
        begins = np.searchsorted(group[again], group)
        rank = np.empty(len(items), dtype=np.int64)
        rank[again] = np.arange(len(items))
        many = np.zeros(len(items), dtype=np.bool_)
        many[order] = (rank - begins >= _FOLLOWED) & np.isfinite(distance[order])
        return many

    def _always_at_once(self, items: IntArray) -> NDArray[np.bool_]:
        """Whether both may be anywhere on their intervals at one time, (K,)."""
        if self._meetings.together is not None:
            return self._meetings.together(items[:, 0], items[:, 1])[1]
        if self._meetings.apart == math.inf:
            return np.ones(len(items), dtype=bool)
        first, second = self._clocked(items[:, 0], items[:, 1])
        apart = np.maximum(first[:, 1] - second[:, 0], second[:, 1] - first[:, 0])
        return np.asarray(apart <= self._meetings.apart)

    def _off(self, items: IntArray) -> FloatArray:
        """(K,) m, what deviations from both paths may take at the most."""
        prover, off = self._prover, np.zeros(len(items))
        for side, motion in ((0, prover.one), (1, prover.other)):
            body = prover.pairs[items[:, 2], side]
            off += np.nan_to_num(motion.side.swept.off[items[:, side], body], posinf=1e9)
        return off

    def _halved(self, items: IntArray) -> IntArray:
        """The same items with one interval of each halved."""
        travel = self._travel(items)
        second = travel[:, 1] > travel[:, 0]
        made = []
        for side, motion in ((0, self._prover.one), (1, self._prover.other)):
            rows = items[second == bool(side)]
            if not len(rows):
                continue
            child, known = motion.halved(rows[:, side])
            if not known.all():
                stuck = rows[~known]
                unknown = PairBounds.unknown(len(stuck))
                every = np.ones(len(stuck), dtype=bool)
                self._note(stuck, unknown, every, ConflictCause.UNVERIFIED)
            for half in (0, 1):
                part = rows[known].copy()
                part[:, side] = child[known] + half
                made.append(part)
        if not made:
            return np.empty((0, 3), dtype=np.int64)
        return self._meeting(np.concatenate(made))

    def _note(
        self, items: IntArray, found: PairBounds, chosen: NDArray[np.bool_], cause: ConflictCause
    ) -> None:
        """Keep the nearest of chosen items of each pair of moves, or the first in time."""
        if not chosen.any():
            return
        prover = self._prover
        rows, distance = items[chosen], found.distance[chosen]
        if not self._meetings.every:
            first, second = self._clocked(rows[:, 0], rows[:, 1])
            when = np.maximum(first[:, 0], second[:, 0])
            k = int(np.argmin(when))
            if when[k] < self._first or not self._verdict.conflicts:
                self._first = float(when[k])
                self._verdict.conflicts = {}
                self._keep(rows[k], float(distance[k]), cause)
            return
        groups = np.stack([prover.one.moves[rows[:, 0]], prover.other.moves[rows[:, 1]]], -1)
        order = np.argsort(distance, kind="stable")
        _, index = np.unique(groups[order], axis=0, return_index=True)
        for k in order[index]:
            self._keep(rows[k], float(distance[k]), cause)

    def _keep(self, item: IntArray, distance: float, cause: ConflictCause) -> None:
        one, other = self._prover.one, self._prover.other
        i, j, row = (int(k) for k in item)
        moves = int(one.moves[i]), int(other.moves[j])
        times = _span(one.own_time[i]), _span(other.own_time[j])
        known = distance if math.isfinite(distance) else None
        conflict = Conflict(cause, moves, self._prover.names(row), known, times, (i, j))
        self._verdict.conflicts.setdefault(moves, conflict)


def _span(times: FloatArray) -> tuple[float, float]:
    return float(times[0]), float(times[1])
