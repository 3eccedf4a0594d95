"""Speeds and accelerations in another language's terms.

A line or arc keeps its programmed numbers. A joint move keeps its time and its share of the joints'
acceleration where the two languages pace joint moves differently: the number that paces it is
sought with which the new robot's emulated move takes as long as the old one's.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence, Set
from dataclasses import fields, replace
from typing import Any

import numpy as np

from ..arrays import FloatArray
from ..dialect import Dialect, MoveWords
from ..motion.path.path import Path
from ..program.move import Move, MoveJ
from ..program.program import Program
from ..program.speed import Speed
from .emulation import EmulatedProgram, Party
from .kept_times import KeptTimes
from .losses import LossesOfPart
from .overrides import OVERRIDE, SHARE, accelerates_by
from .time_search import TimeSearch, leading_axis, rounded, rounded_down

_STILL = 1e-6
"""m of TCP path below which a move merely turns the tool."""
_BINDS = 0.99
"""Share of a programmed limit from which on it counts as having held the move."""
_SHOWN = {
    "tcp_acceleration": ("acceleration", "m/s²", 1.0),
    "joint_acceleration": ("joints' acceleration", "rad/s²", 1.0),
    "reorientation": ("speed of reorientation", "°/s", 180.0 / math.pi),
    "reorientation_acceleration": ("acceleration of reorientation", "°/s²", 180.0 / math.pi),
}
"""What bounded numbers are called, their unit, and how many of it an SI unit is."""
_NUMBERS = tuple(part.name for part in fields(Speed) if part.name != "name")
_SLOWEST = 1e-4
"""m/s, rad/s or share; no move is made slower."""


class Pacer:
    """States the speeds of a program for another language."""

    def __init__(
        self,
        old: EmulatedProgram,
        target: Party,
        dialect: Dialect,
        losses: LossesOfPart,
        tied: Sequence[Sequence[int]] = (),
    ) -> None:
        self._old = old
        self._target = target
        self._dialect = dialect
        self._losses = losses
        spoken = old.party.vendor.speaks
        self._same_pace = spoken is not None and spoken.pace == dialect.pace
        self._own = spoken is not None and spoken is dialect
        self._tied = {i: tuple(moves) for moves in tied for i in moves}
        self._sought: dict[int, str] = {}
        self._search = TimeSearch(old, target, dialect, self._sought, self._tied)
        self._held: dict[int, str] = {}

    def pace(self, program: Program, path: Path) -> Program:
        """The program with its speeds in the language's terms.

        Args:
            program: on the new robot, with the old speeds.
        """
        change = path.route.ends.q[:, 1] - path.route.ends.q[:, 0]
        segment = {move: k for k, move in enumerate(path.route.moves)}
        moves = list(program.moves)
        for i, move in enumerate(moves):
            turned = change[segment[i]] if i in segment else np.zeros(self._target.robot.size)
            if isinstance(move, MoveJ):
                stated = self._joint(i, turned)
            else:
                stated = self._line(i, self._path_acceleration(path, segment.get(i)))
            moves[i] = replace(move, speed=stated)
        self._tie(moves)
        return self._search.in_time(program.with_moves(tuple(moves)), path, segment)

    def _tie(self, moves: list[Move]) -> None:
        """Give moves that are one the least of their numbers."""
        for tied in dict.fromkeys(self._tied.values()):
            speeds = [moves[i].speed for i in tied]
            sought = {self._sought[i] for i in tied if i in self._sought}
            known = [{n for n in _NUMBERS if getattr(s, n) is not None} for s in speeds]
            if len(sought) > 1 or any(names != known[0] for names in known):
                for i in tied:  # they cannot be one: each has its own
                    del self._tied[i]
                continue
            least = {name: min(getattr(s, name) for s in speeds) for name in known[0]}
            for i in tied:
                moves[i] = replace(moves[i], speed=replace(moves[i].speed, **least))

    def again(self, program: Program, path: Path) -> Program:
        """A program that was paced, on a path that has changed since."""
        segment = {move: k for k, move in enumerate(path.route.moves)}
        return self._search.in_time(program, path, segment)

    # ------------------------------------------------------------------- lines and arcs

    def _line(self, i: int, most: float) -> Speed:
        """The speed of a line or arc that may be accelerated by ``most`` m/s²."""
        speed, words, peaks = self._old.moves[i].speed, self._words(i), self._old.peaks
        k = self._old.segment.get(i)
        stated = _said(speed, words)
        tcp = speed.tcp
        if tcp is None and "tcp" in words.needs:
            tcp = self._dialect.fastest if k is None else rounded(float(peaks.tcp[k]))
        if tcp is not None:
            stated["tcp"] = min(max(tcp, _SLOWEST), self._dialect.fastest)
        acceleration = self._line_acceleration(i)
        if acceleration is not None:
            stated["tcp_acceleration"] = acceleration
        self._bound(i, stated, {**self._dialect.most, "tcp_acceleration": most})
        if k is not None:
            self._keep_time(i, k, speed, words, stated)
            self._keep_share(i, speed, words, stated)
            self._tell_line(i, k, speed, words.speeds - {OVERRIDE} | stated.keys())
        return Speed(**self._alone(i, k, stated, words))

    def _alone(
        self, i: int, k: int | None, stated: dict[str, Any], words: MoveWords
    ) -> dict[str, Any]:
        """One of the numbers of which a language says one alone: that which the time needs."""
        known = [name for name in stated if name in words.exclusive]
        if len(known) < 2:
            return stated
        turning = k is not None and self._old.length[k] < _STILL
        wanted = ("duration", *(("reorientation", "tcp") if turning else ("tcp", "reorientation")))
        kept = next(name for name in wanted if name in known)
        if kept == "reorientation":
            self._sought[i] = kept
        return {n: v for n, v in stated.items() if n == kept or n not in known}

    def _bound(self, i: int, stated: dict[str, Any], most: Mapping[str, float]) -> None:
        """Numbers no greater than the maker takes; a program of the same language has its own."""
        if self._own:
            return
        k = self._old.segment.get(i)
        for name in sorted(most.keys() & stated.keys()):
            wanted, taken = stated[name], most[name]
            if wanted <= taken:
                continue
            stated[name] = taken
            idle = k is None or (name == "reorientation" and self._old.peaks.turn[k] <= taken)
            if not idle:
                what, unit, per = _SHOWN[name]
                self._held[i] = (
                    f"; its {what} is {per * taken:.4g} {unit} instead of {per * wanted:.4g}: its "
                    "maker allows, or drives it with, no more"
                )

    def _path_acceleration(self, path: Path, k: int | None) -> float:
        """m/s² along segment k of the new path that the maker takes, or that joints have by it."""
        most = self._dialect.most
        if "tcp_acceleration" in most:
            return most["tcp_acceleration"]
        usual = self._dialect.path_acceleration
        if k is None or "joint_acceleration" not in most:
            return usual if k is None and "joint_acceleration" in most else math.inf
        first, last = path.layout.waypoint[k : k + 2]
        inside = (path.sigma >= first) & (path.sigma <= last)
        arm = self._target.robot.arm_size
        ways = np.abs(path.states.dq[inside][:, :arm]).max(axis=1)
        lengths = np.linalg.norm(path.states.v[inside][:, :3], axis=1)
        moved = lengths > _STILL * ways
        if not moved.any():
            return usual
        reached = float((most["joint_acceleration"] * lengths[moved] / ways[moved]).min())
        return usual if reached <= usual else rounded_down(reached)

    def _words(self, i: int) -> MoveWords:
        return self._dialect.words(self._old.moves[i])

    def _line_acceleration(self, i: int) -> float | None:
        """m/s² along the path: as programmed, the model's, or what the old robot reached."""
        speed, words = self._old.moves[i].speed, self._words(i)
        if "tcp_acceleration" not in words.speeds or speed.tcp_acceleration is not None:
            return speed.tcp_acceleration if "tcp_acceleration" in words.speeds else None
        reduced = speed.joint_acceleration_fraction < 1.0
        lost = reduced and "joint_acceleration_fraction" not in words.speeds
        if not lost and "tcp_acceleration" not in words.needs:
            return None
        if self._old.party.model.tcp_acceleration is not None and not lost:
            return self._old.party.model.tcp_acceleration
        return self._reached_acceleration(speed.joint_acceleration_fraction)

    def _reached_acceleration(self, share: float) -> float:
        """m/s², the greatest that the old robot reaches on its lines and arcs with a share."""
        alike = [
            float(self._old.peaks.tcp_acceleration[k])
            for i, k in self._old.segment.items()
            if not isinstance(self._old.moves[i], MoveJ)
            and self._old.moves[i].speed.joint_acceleration_fraction == share
        ]
        reached = max(alike, default=0.0)
        return rounded(reached) if reached > _SLOWEST else self._dialect.path_acceleration

    def _keep_time(
        self, i: int, k: int, speed: Speed, words: MoveWords, stated: dict[str, Any]
    ) -> None:
        """For what has a duration, or is a pure turn that the language has no speed for."""
        if speed.duration is not None and "duration" not in words.speeds:
            self._sought[i] = "tcp"
        turning = self._old.length[k] < _STILL and "reorientation" not in words.speeds
        if turning and "duration" in words.speeds:
            stated["duration"] = rounded(float(self._old.peaks.duration[k]))

    def _keep_share(self, i: int, speed: Speed, words: MoveWords, stated: dict[str, Any]) -> None:
        """For a share of the joints' acceleration, or an acceleration of the TCP, that is said as a
        share of all accelerations: those that the other controller may not have held are reduced
        with it."""
        share, own = speed.joint_acceleration_fraction, self._target.model.tcp_acceleration
        along = speed.tcp_acceleration
        if (share == 1.0 and along is None) or "tcp_acceleration" in stated:
            return
        if accelerates_by(words) != OVERRIDE:
            return
        share = min(share, along / own) if along is not None and own is not None else share
        share *= speed.acceleration_override
        stated[OVERRIDE] = max(self._dialect.least_acceleration_share, self._search.stepped(share))
        self._sought.setdefault(i, OVERRIDE)

    def _tell_line(self, i: int, k: int, speed: Speed, said: Set[str]) -> None:
        limit = speed.reorientation
        reached = float(self._old.peaks.turn[k])
        held = limit is not None and reached > _BINDS * limit and self._old.length[k] >= _STILL
        if held and "reorientation" not in said:
            self._losses.at(
                i,
                f"the speed of reorientation ({np.degrees(limit or 0):.4g}°/s), which holds this "
                "move, has no words: the tool may turn faster",
            )
        if speed.tcp_acceleration is not None and said.isdisjoint({"tcp_acceleration", OVERRIDE}):
            self._losses.at(
                i, f"the acceleration of the TCP ({speed.tcp_acceleration:.4g} m/s²) has no words"
            )
        self._tell_jerk(i, speed, said)

    def _tell_jerk(self, i: int, speed: Speed, said: Set[str]) -> None:
        if speed.jerk_fraction < 1.0 and "jerk_fraction" not in said:
            self._losses.at(i, f"a reduced jerk ({speed.jerk_fraction:.0%}) has no words")

    # ---------------------------------------------------------------------- joint moves

    def _joint(self, i: int, turned: FloatArray) -> Speed:
        """The speed of a joint move by which the new robot turns its axes by ``turned`` (N,)."""
        speed, words, k = self._old.moves[i].speed, self._dialect.joint, self._old.segment.get(i)
        stated = _said(speed, words)
        self._tell_jerk(i, speed, words.speeds)
        robot = self._target.robot
        leading = leading_axis(robot, turned)
        share = _acceleration_share(self._old, speed, k)
        by = accelerates_by(words)
        if by == SHARE or (by == OVERRIDE and share < 1.0):
            # Where the speed is sought, that is what meets the time: no share may be in its way.
            kept = self._same_pace and getattr(speed, self._dialect.pace) is not None
            share *= speed.acceleration_override if by == OVERRIDE else 1.0
            least = self._dialect.least_acceleration_share
            stated[by] = share = max(least, self._search.stepped(share, up=not kept))
        if "joint_acceleration" in words.needs and not self._keeps(speed, "joint_acceleration"):
            limit = float(robot.limits.acceleration[leading])
            stated["joint_acceleration"] = rounded(share * limit)
        self._bound(i, stated, self._dialect.most)
        pace = self._dialect.pace
        if "duration" in stated and {"duration", pace} <= words.exclusive:
            others = words.exclusive - {"duration"}
            return Speed(**{n: v for n, v in stated.items() if n not in others})
        if self._same_pace and getattr(speed, pace) is not None:
            return Speed(**stated)
        stated[pace] = self._first_pace(k, leading)
        if k is not None and "duration" not in stated:
            self._sought[i] = pace
            if pace == "tcp" and float(self._old.peaks.tcp[k]) < _STILL:
                stated["tcp"] = self._dialect.fastest
                stated["reorientation"] = max(_SLOWEST, rounded(float(self._old.peaks.turn[k])))
                self._sought[i] = "reorientation"
        return Speed(**stated)

    def _keeps(self, speed: Speed, name: str) -> bool:
        return self._same_pace and getattr(speed, name) is not None

    def _first_pace(self, k: int | None, leading: int) -> float:
        """Where the search for the number that paces a joint move begins."""
        limits = self._target.robot.limits
        greatest = {
            "tcp": self._dialect.fastest,
            "joint_fraction": 1.0,
            "joint": rounded_down(float(limits.velocity[leading])),
        }[self._dialect.pace]
        if k is None:
            return greatest
        if self._dialect.pace == "tcp":
            return min(greatest, max(_SLOWEST, float(self._old.peaks.tcp[k])))
        old = self._old.party.robot.limits.velocity
        share = float((self._old.peaks.joint[k] / old).max())
        return greatest * min(1.0, max(0.01, share))

    def tell_times(self, program: Program, path: Path) -> None:
        """Losses of moves that do not take as long as before; the path is the program's."""
        told = KeptTimes(self._old, self._target, self._dialect, self._losses, self._held)
        told.tell(program, path, self._sought, self._tied)


def _said(speed: Speed, words: MoveWords) -> dict[str, Any]:
    """The numbers of a speed that there are words for."""
    values = {name: getattr(speed, name) for name in sorted(words.speeds)}
    return {name: value for name, value in values.items() if value is not None}


def _acceleration_share(old: EmulatedProgram, speed: Speed, k: int | None) -> float:
    """The share of the joints' acceleration that a joint move is programmed with."""
    share = speed.joint_acceleration_fraction
    if speed.joint_acceleration is None or k is None:
        return share
    robot = old.party.robot
    limit = float(robot.limits.acceleration[leading_axis(robot, old.change[k])])
    return min(share, speed.joint_acceleration / limit)
