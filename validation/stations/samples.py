"""What dense samples find of a station of two robots, beside what is proven of it.

The station is run as controllers may run it: programs begin early or late, some robots are slower,
links take any of their delays, and where a wait stands behind a zone the robot passes if what it
waits for is there in time. Then everything is measured, where it is near at ten times the
controllers' rate. Who has a part that is handed over the times of the statements say.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from itertools import product

import numpy as np

from ...core.arrays import FloatArray, IntArray
from ...core.collision.mutual.pair_proof import PairProver
from ...core.collision.mutual.robot_motion import RobotMotion
from ...core.handling.arrangement import PlacedPart
from ...core.handling.handling import Handling
from ...core.station.actions import Action, actions_of
from ...core.station.clock import Schedule, StationClock, StationRun
from ...core.station.station import ClockPace, RobotStation, StationRobot
from ...tasks.results.stations import DrivenStation
from ...tasks.setup import setup_of_program
from .files import MAKES
from .random_stations import RandomStation

FINER = 10
_STEPS = (16e-3, 4e-3)
"""s between samples; between these the least are looked for at `FINER` times the rate."""
_CLOSE = (0.15, 0.05)
"""m, below which that is done: between samples nothing comes nearer by as much."""
_STILL = 1e-6
"""rad or m by which axes move where robots stand."""
_TOGETHER = 16
"""Samples of which the least counts."""
_STANDS = 2e-3
"""rad by which a robot that stands may be off."""
_SOON = 5e-3
"""s by which a change of hands may be off."""


@dataclass(frozen=True)
class Trial:
    """A station as it may happen to run.

    Args:
        station, actions: as driven then.
        run: on one clock.
        shifts: s by which each robot is late all along.
    """

    station: RobotStation
    actions: Mapping[str, tuple[Action, ...]]
    run: StationRun
    shifts: tuple[float, float] = (0.0, 0.0)


def trials_in_time(
    made: DrivenStation, rng: np.random.Generator, jitter: float, count: int
) -> Iterator[Trial]:
    """Runs in which each robot is up to the jitter early or late."""
    for k in range(count):
        begins = jitter + rng.uniform(-jitter, jitter, 2) * (k > 0)
        yield from trials_begun(made, begins, (1.0, 1.0), 0.5)
    for late in (-jitter, jitter):
        if all(member.passing is None for member in made.station.members.values()):
            yield Trial(made.station, made.actions, made.run, (late, -late))


def trials_at_any_time(
    made: DrivenStation, rng: np.random.Generator, count: int
) -> Iterator[Trial]:
    """Runs in which nothing is known but what signals hold back."""
    for _ in range(count):
        slower = 1.0 + rng.uniform(0.0, 2.0, 2) * (rng.random(2) < 0.5)
        begins = rng.uniform(0.0, 8.0, 2) * (rng.random(2) < 0.7)
        yield from trials_begun(made, begins, tuple(slower.tolist()), float(rng.uniform()))


def trials_begun(
    made: DrivenStation,
    begins: Sequence[float] | FloatArray,
    slower: tuple[float, ...] = (1.0, 1.0),
    late: float = 0.5,
) -> Iterator[Trial]:
    """One run, or some where robots may pass through zones that waits stand behind.

    Args:
        made: the station.
        begins: s by which each robot begins later.
        slower: factors on the times that they take.
        late: share of the range of links' delays.
    """
    members = made.station.members
    choices = [
        list(product((False, True), repeat=0 if m.passing is None else len(m.passing.moves)))
        for m in members.values()
    ]
    for passes in product(*choices):
        driven, actions = {}, dict(made.actions)
        for (name, member), begin, factor, which in zip(
            members.items(), begins, slower, passes, strict=True
        ):
            way = member.run
            if member.passing is not None and any(which):
                moves = [m for m, w in zip(member.passing.moves, which, strict=True) if w]
                way, actions[name] = member.passing.drive(moves)
            own = np.array([0.0, way.duration])
            pace = ClockPace.slower([(own, factor * own)])
            driven[name] = replace(member, run=way, pace=pace, begins=member.begins + float(begin))
        station = replace(made.station, members=driven)
        run = StationClock(station, actions, late).run()
        if all(
            _may_be(run.schedules[name], member, which, actions[name])
            for (name, member), which in zip(members.items(), passes, strict=True)
        ):
            yield Trial(station, actions, run)


def _may_be(
    schedule: Schedule, member: StationRobot, which: tuple[bool, ...], actions: tuple[Action, ...]
) -> bool:
    """Whether a robot finds what it waits for in time where it passes."""
    if member.passing is None:
        return True
    passed = {m for m, w in zip(member.passing.moves, which, strict=True) if w}
    held = {s.action.move for s in schedule.waits if s.end > s.begin}
    late = {
        action.move
        for action, ready in schedule.ready
        if ready < schedule.pace.at(action.time) - schedule.pace.at(action.soonest)
    }
    return passed.isdisjoint(held | late)


class Samples:
    """Measures trials of one station.

    Args:
        scene: as written.
        made: as driven.
    """

    def __init__(self, scene: RandomStation, made: DrivenStation) -> None:
        self._scene, self._names = scene, tuple(made.station.members)
        members = list(made.station.members.values())
        bare = [_motion(member, None) for member in members]
        self._arms = PairProver(bare[0], bare[1])
        period = min(float(np.diff(member.run.trajectory.t[:2])[0]) for member in members)
        self._steps = (*_STEPS, period / FINER)
        self._part: dict[tuple[int, bool], PairProver] = {}
        if scene.hands is not None:
            held = [_motion(member, _held(member)) for member in members]
            tools = [MAKES[make].tool for make in scene.makes]
            for who, touching in product((0, 1), (False, True)):
                both = (held[0], bare[1]) if who == 0 else (bare[0], held[1])
                pair = ("bar", tools[1]) if who == 0 else (tools[0], "bar")
                prover = PairProver(both[0], both[1], [pair] if touching else [])
                names = [prover.names(row) for row in range(len(prover.pairs))]
                prover.pairs = prover.pairs[["bar" in names for names in names]]
                self._part[who, touching] = prover

    def least(self, trial: Trial) -> float:
        """m, the least distance of what may not touch; less than nothing where a part is torn, or
        falls."""
        members = [trial.station.members[name] for name in self._names]
        schedules = [trial.run.schedules[name] for name in self._names]
        ends = [s.end if np.isfinite(s.end) else s.waits[-1].begin for s in schedules]
        last = max(ends) + 0.2
        least = self._closest(self._arms, trial, np.arange(0.0, last, self._steps[0]))
        if self._scene.hands is None:
            return least
        t = np.arange(0.0, last, self._steps[1])
        return min(least, self._handed(trial, members, schedules, t))

    def _handed(
        self,
        trial: Trial,
        members: list[StationRobot],
        schedules: list[Schedule],
        t: FloatArray,
    ) -> float:
        assert self._scene.hands is not None
        grip, give, take = self._scene.hands
        (q, moves), (other, others) = self._rows(trial, t)
        cues = [
            _cue(member, schedule, move, MAKES[make].grip[opens]) + shift
            for member, schedule, make, move, opens, shift in (
                (members[0], schedules[0], self._scene.makes[0], grip, 0, trial.shifts[0]),
                (members[1], schedules[1], self._scene.makes[1], take, 0, trial.shifts[1]),
                (members[0], schedules[0], self._scene.makes[0], give, 1, trial.shifts[0]),
            )
        ]
        picked, took, gave = cues
        if took > gave + 1e-9:  # nobody holds it
            return -1.0
        stands = [
            np.abs(a - _stand(m, k)).max(axis=1) < _STANDS
            for m, a, k in ((members[0], q, give), (members[1], other, take))
        ]
        both = (t > took + _SOON) & (t < gave - _SOON)
        if not (stands[0][both].all() and stands[1][both].all()):
            return -1.0
        if np.isfinite(took) and not stands[0][np.argmin(np.abs(t - took))]:
            return -1.0
        least = np.inf
        for who, when, touching in (
            (0, (t >= picked) & (t <= took), (others >= take - 1) & (others <= take) & stands[0]),
            (1, t >= took, (moves >= give) & (moves <= give + 1) & stands[1]),
        ):
            # A tool touches what it comes to, takes, and draws back from.
            for tool, which in ((False, when & ~touching), (True, when & touching)):
                for spell in _spells(np.flatnonzero(which)):
                    found = self._closest(self._part[who, tool], trial, t[spell], 1)
                    least = min(least, found)
        return least

    def _closest(self, prover: PairProver, trial: Trial, t: FloatArray, level: int = 0) -> float:
        """The least distance at times (T,) s, and between them where it is small."""
        least = np.inf
        count = -(-len(t) // _TOGETHER) if level < len(_CLOSE) else 1
        for part in np.array_split(t, count):
            (q, moves), (other, others) = self._rows(trial, part)
            found = prover.nearest(q, other, (moves, others))[0]
            moved = max(float(np.ptp(at, axis=0).max()) for at in (q, other))
            if level < len(_CLOSE) and found < _CLOSE[level] and moved > _STILL:
                step = self._steps[level + 1]
                finer = np.arange(part[0], part[-1] + self._steps[level], step)
                found = min(found, self._closest(prover, trial, finer, level + 1))
            least = min(least, found)
        return float(least)

    def _rows(self, trial: Trial, t: FloatArray) -> tuple[tuple[FloatArray, IntArray], ...]:
        """Configurations and moves of both robots at times (T,) s."""
        found = []
        for name, shift in zip(self._names, trial.shifts, strict=True):
            trajectory = trial.station.members[name].run.trajectory
            own = trial.run.schedules[name].own(t - shift)
            row = np.clip(np.searchsorted(trajectory.t, own, "right") - 1, 0, None)
            q = np.stack([np.interp(own, trajectory.t, joint) for joint in trajectory.q.T], -1)
            found.append((q, trajectory.move[row]))
        return tuple(found)


def _spells(rows: IntArray) -> Iterator[IntArray]:
    """Rows that follow each other."""
    if len(rows):
        yield from np.split(rows, np.flatnonzero(np.diff(rows) > 1) + 1)


def _motion(member: StationRobot, handling: Handling | None) -> RobotMotion:
    cell = member.cell if handling is not None else replace(member.cell, parts=())
    return RobotMotion(member.name, member.controller, member.run, cell, (), handling)


def _held(member: StationRobot) -> Handling:
    """The part in the hand all along."""
    assert member.handling is not None
    held: list[PlacedPart] = [
        placed
        for arrangement in member.handling.arrangements
        for placed in arrangement
        if placed.held
    ]
    count = len(member.handling.arrangements)
    return replace(member.handling, arrangements=((held[0],),) * count)


def _stand(member: StationRobot, move: int) -> FloatArray:
    route = member.run.path.route
    return np.asarray(route.ends.q[list(route.moves).index(move), 1])


def _cue(member: StationRobot, schedule: Schedule, move: int, text: str) -> float:
    """s of the station at which the gripper does something behind a move."""
    vendor = setup_of_program(member.program).vendor
    words = None if vendor.speaks is None else vendor.speaks.signals
    (action,) = [
        action
        for action in actions_of(member.run, words)
        if action.move == move and "".join(action.text.split()) == "".join(text.split())
    ]
    waited = sum(
        spell.end - spell.begin
        for spell in schedule.waits
        if spell.action.statement < action.statement
    )
    return schedule.pace.at(action.time) + schedule.begin + waited
