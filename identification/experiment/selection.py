"""Which runs tell most in the time there is.

First every level of every factor (posture, kind of moves, speed, zone) gets a run, since a fit is
judged by conditions that it has not seen: of the runs with the most new levels the one that tells
most a second. Runs about open questions cross their factors, and every pair of levels gets a run;
the question of which the least is covered comes next. Then, greedily, whatever tells most a second:
information of runs adds up, log det is submodular, and the greedy choice is the usual one for such
a budget.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass

import numpy as np

from ...core.arrays import FloatArray
from .information import nats
from .kinds import Topic
from .plan import CandidateRun, Plan, Skipped


@dataclass(frozen=True, eq=False)
class Option:
    """A run that may be chosen.

    Args:
        candidate: the run.
        information: (K, K), see `information`.
        duration: s.
    """

    candidate: CandidateRun
    information: FloatArray
    duration: float

    @property
    def levels(self) -> frozenset[str]:
        """The levels of factors that it has."""
        made = self.candidate
        if made.study is not None:
            return made.study.levels
        found = {f"posture {made.posture + 1}", f"the kind {made.kind}"}
        if made.speed is not None:
            found.add(f"a speed of {1e3 * made.speed:.5g} mm/s")
        return frozenset(
            found | {f"a zone of {1e3 * corner.radius:.5g} mm" for corner in made.corners}
        )


class RunChoice:
    """Chooses one run after the other.

    Args:
        options: to choose from.
        plan: says how much time there is.
    """

    def __init__(self, options: Iterable[Option], plan: Plan) -> None:
        self._open = list(options)
        self._plan = plan
        self._left = np.inf if plan.minutes is None else 60.0 * plan.minutes
        self._wanted = frozenset().union(*(option.levels for option in self._open))
        self._had: frozenset[str] = frozenset()
        size = len(self._open[0].information) if self._open else 0
        self.information: FloatArray = np.zeros((size, size))
        """(K, K), of all runs taken."""

    def best(self) -> Option | None:
        """The next run to take; None if none fits any more."""
        fit = [option for option in self._open if self._cost(option) <= self._left]
        if not fit:
            return None
        topics = {t for t in map(_topic, fit) if t is not None and self._share(t) < 1.0}
        if topics:
            behind = min(sorted(topics), key=self._share)
            fit = [option for option in fit if _topic(option) is behind]
        fresh = [len(option.levels - self._had) for option in fit]
        fit = [option for option, new in zip(fit, fresh, strict=True) if new == max(fresh)]
        return max(fit, key=lambda option: self._gain(option) / self._cost(option))

    def _share(self, topic: Topic) -> float:
        """How much is covered of what runs about a topic that still fit could cover."""
        wanted = {
            level
            for option in self._open
            if _topic(option) is topic and self._cost(option) <= self._left
            for level in option.levels
        }
        had = {level for level in self._had if level.startswith(f"{topic}: ")}
        return len(had) / len(wanted | had)

    def take(self, option: Option) -> float:
        """Take a run; returns what it tells beyond those before, in nats."""
        gain = self._gain(option)
        self._left -= self._cost(option)
        self._had |= option.levels
        self.information = self.information + option.information
        self._open.remove(option)
        return gain

    def refuse(self, option: Option) -> None:
        """Take a run from the list that is not possible after all."""
        self._open.remove(option)

    def missing(self) -> list[str]:
        """Levels that no run has for want of time."""
        still = frozenset().union(*(option.levels for option in self._open))
        return sorted((self._wanted & still) - self._had)

    def left_over(self) -> list[Skipped]:
        """The runs that there was no time for, the most informative first."""
        rest = sorted(self._open, key=lambda option: -self._gain(option) / self._cost(option))
        return [
            Skipped(
                option.candidate.name,
                f"{option.duration:.0f} s, would tell {self._gain(option):.2f} nats more",
            )
            for option in rest
        ]

    def _cost(self, option: Option) -> float:
        return seconds_of(option.duration, self._plan)

    def _gain(self, option: Option) -> float:
        return nats(self.information + option.information) - nats(self.information)


def _topic(option: Option) -> Topic | None:
    study = option.candidate.study
    return None if study is None else study.topic


def seconds_of(duration: float, plan: Plan) -> float:
    """s at the robot for a run of so many seconds of motion."""
    return duration + plan.overhead
