"""What `flyby.station` returns."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np

from ...core.collision.mutual.conflict import Conflict, ConflictCause, PairVerdict
from ...core.display import counted, in_line
from ...core.errors import Note, Span
from ...core.notebook import page, table
from ...core.station.actions import Action
from ...core.station.clearances import PairClearance
from ...core.station.clock import Schedule, Spell, StationRun
from ...core.station.conflict_words import conflict_said
from ...core.station.deadlock import Deadlock
from ...core.station.interlocks import Saving
from ...core.station.orders import Orders
from ...core.station.station import RobotStation

ROBOTS = (
    ("robot", "left"),
    ("moves", "right"),
    ("begins", "right"),
    ("ends", "right"),
    ("drives", "right"),
    ("waits", "right"),
    ("slack", "right"),
)
WAITS = (
    ("robot", "left"),
    ("from", "right"),
    ("for", "right"),
    ("statement", "left"),
    ("line", "left"),
)
PAIRS = (
    ("robots", "left"),
    ("least met", "right"),
    ("in time", "left"),
    ("at any time", "left"),
    ("under interlocks", "left"),
)
SAVINGS = (
    ("robot", "left"),
    ("statement", "left"),
    ("line", "left"),
    ("proven", "left"),
    ("station quicker", "right"),
)
_SHORTEST = 1e-3
"""s of a wait that is shown."""
_ONE_TIME = 0.1
"""s between two times that count as one: what is known of when robots move."""


@dataclass(frozen=True, repr=False)
class DrivenStation:
    """A station on one clock.

    Args:
        station: what ran.
        actions: of each robot.
        run: who was where when.
        deadlock: why it does not end; None if it does.
        orders: what the signals allow; None where that is too much to look at.
        clearances: between each two robots; empty where no proof was asked for.
        jitter: s by which each robot may be early or late in what is proven in time.
        savings: changes of interlocks that are proven and make the station quicker.
        notes: what a user should know.
    """

    station: RobotStation
    actions: Mapping[str, tuple[Action, ...]]
    run: StationRun
    deadlock: Deadlock | None
    orders: Orders | None
    clearances: tuple[PairClearance, ...]
    jitter: float
    savings: tuple[Saving, ...]
    notes: tuple[Note, ...]

    def __repr__(self) -> str:
        told = f"{self.duration:.3f} s" if np.isfinite(self.duration) else "never ends"
        return in_line(f"Station of {counted(self.station.members, 'robot')}: {told}")

    @property
    def duration(self) -> float:
        """s, until the last robot has ended; infinite in a deadlock."""
        return self.run.duration

    @property
    def bottleneck(self) -> str:
        """The robot that ends last."""
        return max(self.run.schedules.values(), key=lambda schedule: schedule.end).name

    def driven(self, robot: str) -> float:
        """s that a robot drives in all, slower than by itself where moves are made together."""
        return self.run.schedules[robot].pace.at(self.station.members[robot].run.duration)

    @property
    def clear(self) -> bool:
        """Whether all robots are proven to keep clear of each other: in time, or in every order
        that the signals allow, which no robot that is early or late can leave."""
        return all(map(self.keeps, self.clearances))

    def keeps(self, pair: PairClearance) -> bool:
        """The same of two robots."""
        return pair.in_time.proven or (pair.safe and pair.least >= self.station.clearance)

    @property
    def may_lock(self) -> bool:
        """Whether some order that the signals allow ends in a deadlock."""
        return self.orders is not None and bool(self.orders.stuck)

    def waits(self) -> list[tuple[str, Spell]]:
        """Who waits for what, in order of time."""
        found = [
            (name, spell)
            for name, schedule in self.run.schedules.items()
            for spell in schedule.waits
            if spell.end - spell.begin > _SHORTEST
        ]
        return sorted(found, key=lambda one: one[1].begin)

    def robot_rows(self) -> list[tuple[str, ...]]:
        """A line a robot."""
        return [
            (
                name,
                str(len(self.station.members[name].program.moves)),
                f"{schedule.begin:.3f} s",
                _seconds(schedule.end),
                _seconds(self.driven(name)),
                _seconds(_waited(schedule)),
                _seconds(self.duration - schedule.end) if np.isfinite(self.duration) else "",
            )
            for name, schedule in self.run.schedules.items()
        ]

    def wait_rows(self) -> list[tuple[str, ...]]:
        """A line a wait."""
        return [
            (
                name,
                f"{spell.begin:.3f} s",
                _seconds(spell.end - spell.begin),
                spell.action.text + (" (gave up)" if spell.given_up else ""),
                _place(spell.action.span),
            )
            for name, spell in self.waits()
        ]

    def pair_rows(self) -> list[tuple[str, ...]]:
        """A line a pair of robots."""
        return [
            (
                " and ".join(pair.robots),
                f"{1e3 * pair.least:.1f} mm at {pair.least_at:.2f} s",
                self._in_time_said(pair),
                _verdict(pair.any_time, "needs interlocks for {}"),
                "" if pair.interlocked is None else _verdict(pair.interlocked, "open for {}"),
            )
            for pair in self.clearances
        ]

    def _in_time_said(self, pair: PairClearance) -> str:
        said = _verdict(pair.in_time, least=pair.least)
        return f"{said}, ± {1e3 * self.jitter:g} ms" if pair.in_time.proven else said

    def conflict_said(self, pair: PairClearance, conflict: Conflict) -> str:
        """A conflict in a sentence, with both program lines, and when: at one time of the station,
        unless it takes that one of them is late."""
        schedules = [self.run.schedules[name] for name in pair.robots]
        # A robot that waits is there for long; beyond the schedule the middles alone are near.
        timed = conflict in pair.in_time.conflicts.values()
        spans = [
            schedule.clocked(np.array([own if timed else (conflict.time(side),) * 2]))[0]
            for side, (schedule, own) in enumerate(zip(schedules, conflict.times, strict=True))
        ]
        begin, end = max(span[0] for span in spans), min(span[1] for span in spans)
        when = f"at {max(begin, 0.0):.2f} s"
        if begin > end + _ONE_TIME:
            both = zip(pair.robots, spans, strict=True)
            when = ", ".join(f"{name} at {span[0]:.3f} s" for name, span in both)
        said = conflict_said(self.station, pair.robots, conflict)
        return f"{said} ({when} of the station)"

    def saving_rows(self) -> list[tuple[str, ...]]:
        """A line a change of an interlock."""
        return [
            (
                saving.robot,
                saving.action.text,
                _place(saving.action.span),
                "can go"
                if saving.earlier is None
                else f"{saving.earlier:.3f} s or {1e3 * saving.place:.0f} mm of path earlier",
                f"{saving.seconds:.3f} s",
            )
            for saving in self.savings
        ]

    def findings(self) -> list[str]:
        """What is wrong, in sentences."""
        found = [] if self.deadlock is None else [str(self.deadlock)]
        for pair in self.clearances:
            if self.keeps(pair):
                continue
            found += [self.conflict_said(pair, c) for c in pair.in_time.conflicts.values()]
            if not pair.in_time.proven and pair.least < 0.0:
                both = " and ".join(pair.robots)
                found.append(
                    f"{both} overlap by {-1e3 * pair.least:.1f} mm at {pair.least_at:.3f} s"
                )
        for pair in self.clearances:
            if pair.in_time.proven and pair.interlocked is not None:
                worst = sorted(pair.interlocked.conflicts.values(), key=_nearness)[:1]
                found += [
                    "the interlocks alone do not keep it so, if a robot is late: "
                    + self.conflict_said(pair, conflict)
                    for conflict in worst
                ]
        if self.may_lock and self.deadlock is None:
            found.append(self._lock_said())
        return found

    def _lock_said(self) -> str:
        assert self.orders is not None
        at = self.orders.stuck[0]
        told = []
        for (name, actions), k in zip(self.orders.actions.items(), at, strict=True):
            if k < len(actions):
                told.append(f"{name} at {actions[k].text} ({_place(actions[k].span)})")
            else:
                told.append(f"{name} at its end")
        return "the signals allow a deadlock, though it does not come in this run: " + ", ".join(
            told
        )

    def as_json(self) -> dict[str, Any]:
        """All figures; times in s, lengths in mm."""
        return {
            "station_time_s": self.duration if np.isfinite(self.duration) else None,
            "bottleneck": self.bottleneck,
            "robots": [
                {
                    "name": name,
                    "moves": len(self.station.members[name].program.moves),
                    "begins_s": schedule.begin,
                    "ends_s": schedule.end if np.isfinite(schedule.end) else None,
                    "drives_s": self.driven(name),
                    "waits_s": _waited(schedule) if np.isfinite(_waited(schedule)) else None,
                }
                for name, schedule in self.run.schedules.items()
            ],
            "waits": [
                {
                    "robot": name,
                    "from_s": spell.begin,
                    "to_s": spell.end if np.isfinite(spell.end) else None,
                    "statement": spell.action.text,
                    "place": _place(spell.action.span),
                }
                for name, spell in self.waits()
            ],
            "clearance_mm": 1e3 * self.station.clearance,
            "jitter_ms": 1e3 * self.jitter,
            "pairs": [self._pair_json(pair) for pair in self.clearances],
            "deadlock": None if self.deadlock is None else str(self.deadlock),
            "may_lock": self.may_lock if self.orders is not None else None,
            "interlocks": [
                {
                    "robot": saving.robot,
                    "statement": saving.action.text,
                    "place": _place(saving.action.span),
                    "can_go": saving.earlier is None,
                    "earlier_s": saving.earlier,
                    "earlier_mm": None if saving.earlier is None else 1e3 * saving.place,
                    "saved_s": saving.seconds,
                }
                for saving in self.savings
            ],
            "findings": self.findings(),
            "notes": [str(note) for note in self.notes],
        }

    def _pair_json(self, pair: PairClearance) -> dict[str, Any]:
        inter = pair.interlocked
        return {
            "robots": list(pair.robots),
            "least_met_mm": 1e3 * pair.least,
            "least_met_at_s": pair.least_at,
            "proven_in_time": pair.in_time.proven,
            "proven_at_any_time": pair.any_time.proven,
            "moves_that_need_an_interlock": [[a + 1, b + 1] for a, b in pair.any_time.conflicts],
            "proven_under_interlocks": None if inter is None else inter.proven,
        }

    def picture(self, kind: str = "svg") -> bytes:
        """Moves, waits and signals over time (Gantt chart), as a file.

        Args:
            kind: ``png``, ``pdf`` or ``svg``.
        """
        from ...drawing.station import draw_station

        return draw_station(self.station, self.run, self.actions, kind)

    def _repr_html_(self) -> str:
        parts = [table(ROBOTS, self.robot_rows()), table(WAITS, self.wait_rows())]
        if self.clearances:
            parts.append(table(PAIRS, self.pair_rows()))
        return page(repr(self)[1:-1], *parts, notes=[*self.findings(), *self.notes])


def _nearness(conflict: Conflict) -> float:
    return np.inf if conflict.distance is None else conflict.distance


def _waited(schedule: Schedule) -> float:
    return float(sum(spell.end - spell.begin for spell in schedule.waits))


def _seconds(value: float) -> str:
    return f"{value:.3f} s" if np.isfinite(value) else "for ever"


def _place(span: Span | None) -> str:
    return "" if span is None else f"{span.file}:{span.line}"


def _verdict(verdict: PairVerdict, what: str = "", least: float = np.inf) -> str:
    """A verdict in a few words.

    Args:
        verdict: what was found.
        what: how many pairs of moves, said with this.
        least: m that was met.
    """
    if verdict.proven:
        return f"{1e3 * verdict.clearance:g} mm proven"
    if what:
        return what.format(counted(verdict.conflicts, "pair of moves", "pairs of moves"))
    causes = {conflict.cause for conflict in verdict.conflicts.values()}
    near = ConflictCause.NEAR in causes or least < verdict.clearance
    return "not kept" if near else "not proven"
