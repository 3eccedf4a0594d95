"""The page of several robots on one clock: who is where when, who waits for whom, how near."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from itertools import combinations
from pathlib import PurePath
from typing import NamedTuple

import numpy as np

from ...core.arrays import FloatArray
from ...core.display import counted
from ...core.driving.driven_program import DrivenProgram
from ...core.errors import Span
from ...core.program.move import Opaque, Statement, Wait
from ...core.program.signal import Meet
from ...core.station.clearances import StationProver
from ...core.station.clock import Schedule, Spell
from ...core.station.hand_over import follow_hand_overs
from ...core.station.station import HandOver
from ...core.station.turns import hand_over_times
from ...drawing.page.content import (
    Page,
    PageBar,
    PageBars,
    PageCell,
    PageColumn,
    PageRow,
    PageShare,
    PageTable,
)
from ...drawing.page.curves import BETWEEN, CHARTS
from ...drawing.page.packing import Quantised
from ...drawing.page.retiming import OtherClock, cut_off, on_clock
from ...drawing.page.track_content import PageChannel, PageChart, PageFlag, PageTrack
from ...drawing.signals import signals_on
from ..results.runs import Run
from ..results.stations import DrivenStation
from .program_tables import page_shares, time_tables
from .run_page import PageDraft, made_by

MOST_TIMES, EVERY = 300, 0.05
"""Times at which distances between robots are looked at, and s between them at least."""
_LEAST = 1e-3
"""s from which on a share of the time is shown."""
_ROBOTS = (
    PageColumn("robot"),
    PageColumn("moves"),
    PageColumn("begins", "s", 3),
    PageColumn("ends", "s", 3),
    PageColumn("drives", "s", 3, bar=True),
    PageColumn("waits", "s", 3, bar=True),
    PageColumn("slack", "s", 3),
)
_WAITS = (
    PageColumn("robot"),
    PageColumn("from", "s", 3),
    PageColumn("for", "s", 3, bar=True),
    PageColumn("statement"),
    PageColumn("line"),
)
_HAND_OVERS = (
    PageColumn("part"),
    PageColumn("from"),
    PageColumn("lets go", "s", 3),
    PageColumn("line"),
    PageColumn("to"),
    PageColumn("takes it", "s", 3),
    PageColumn("line"),
)
_SAVINGS = (
    PageColumn("station quicker", "s", 3, bar=True),
    PageColumn("robot"),
    PageColumn("statement"),
    PageColumn("line"),
    PageColumn("proven"),
)


def station_page(made: DrivenStation) -> Page:
    """The page of a station."""
    return StationPage(made).page()


class StationPage:
    """The page of a station, and what is behind it.

    Args:
        made: the station.
        distances: whether distances between robots are drawn although none are proven.

    Attributes:
        draft: robots and tracks, a track a robot.
        runs, clocks: of each robot.
    """

    def __init__(self, made: DrivenStation, distances: bool = False) -> None:
        self.made = made
        self.distances = distances or bool(made.clearances)
        self.draft = PageDraft()
        self.last = _until(made)
        self.clocks: list[OtherClock] = []
        self.runs: list[Run] = []
        self.handed: list[_Handed] = []

    def page(self) -> Page:
        made, draft = self.made, self.draft
        grid = np.linspace(0.0, self.last, int(np.clip(self.last / EVERY, 2, MOST_TIMES)))
        for name, member in made.station.members.items():
            robot = member.run.path.route.robot
            run = Run.of(DrivenProgram.faultless(member.run), robot)
            draft.drive([run], member.cell, [name], ghosts=0)
            schedule = made.run.schedules[name]
            clock = _clock(schedule, run.duration, self.last)
            index = len(draft.tracks) - 1
            spans = [spell.action.span for spell in schedule.waits]
            draft.sources.add(run.program, index, spans)
            track = on_clock(draft.tracks[-1], clock, grid)
            if not np.isfinite(schedule.end):
                track = cut_off(track, self.last)
            waits = [self._flag(index, spell) for spell in schedule.waits if self._seen(spell)]
            flags = sorted([*track.flags, *waits], key=lambda flag: flag.t)
            draft.tracks[-1] = replace(track, flags=flags)
            self.clocks.append(clock)
            self.runs.append(run)
        self._hand_over()
        if self.distances:
            self._distances(grid)
        charts = [PageChart(BETWEEN, "Distance between robots", "mm"), *CHARTS]
        return Page(
            "station" if made.station.file is None else made.station.file.parent.name,
            "station",
            self._facts(),
            list(self._shares()),
            draft.arms,
            draft.tracks,
            draft.files(),
            list(self._tables()),
            charts if self.distances else CHARTS,
            gantt=[*self._robots(), *self._signals()],
            notes=made.findings(),
            chosen=list(made.station.members).index(made.bottleneck),
            made_by=made_by(),
        )

    # Times

    def _seen(self, spell: Spell) -> bool:
        return min(spell.end, self.last) - spell.begin > _LEAST

    def _flag(self, track: int, spell: Spell) -> PageFlag:
        source, line = self.draft.sources.place(track, spell.action.span)
        end = min(spell.end, self.last)
        return PageFlag("wait", _waits_for(spell), spell.begin, end - spell.begin, source, line)

    def _hand_over(self) -> None:
        """Parts are drawn where their givers have them until their takers do."""
        schedules, members = self.made.run.schedules, self.made.station.members
        names = list(members)
        for found in follow_hand_overs(self.made.station).followed:
            told = found.declared
            both = told.giver, told.taker
            runs = members[told.giver].run, members[told.taker].run
            times = hand_over_times(found, runs, (schedules[both[0]], schedules[both[1]]))
            taken = min(times[1], self.last)
            giver, taker = names.index(told.giver), names.index(told.taker)
            self._own(giver, told.given, ends=taken)
            self._own(taker, told.taken, begins=taken)
            changes = zip(runs, (found.released, found.taken), strict=True)
            spans = [_span(run.program.statements[one.statement]) for run, one in changes]
            self.handed.append(_Handed(told, (giver, taker), times, (spans[0], spans[1])))

    def _own(
        self, track: int, name: str, begins: float | None = None, ends: float | None = None
    ) -> None:
        """Say from when, or until when, a part is a robot's."""
        own = self.draft.tracks[track]
        parts = [
            replace(one, begins=begins or one.begins, ends=ends or one.ends)
            if one.name == name
            else one
            for one in own.parts
        ]
        self.draft.tracks[track] = replace(own, parts=parts)

    def _distances(self, grid: FloatArray) -> None:
        """Curves of the distance of each two robots, on the tracks of both."""
        made, tracks = self.made, self.draft.tracks
        prover = StationProver(made.station, made.actions)
        names = list(made.station.members)
        rows = [prover.standing(made.run.schedules[name], grid) for name in names]
        for a, b in combinations(range(len(names)), 2):
            pair = prover.prover(names[a], names[b])
            least = np.array(
                [
                    pair.nearest(
                        rows[a][0][k : k + 1],
                        rows[b][0][k : k + 1],
                        (rows[a][1][k : k + 1], rows[b][1][k : k + 1]),
                        at_once=True,
                    )[0]
                    for k in range(len(grid))
                ]
            )
            for own, other in ((a, b), (b, a)):
                values = 1e3 * np.interp(tracks[own].motion.t.values, grid, least)
                curve = PageChannel(f"to {names[other]}", BETWEEN, Quantised(values, 0.1))
                tracks[own] = replace(tracks[own], channels=[*tracks[own].channels, curve])

    # Figures at the top

    def _driven(self, index: int, schedule: Schedule) -> float:
        """s of its own that a robot drives on the page."""
        if np.isfinite(schedule.end):
            return self.made.driven(schedule.name)
        return self.last - schedule.begin - self._waited(schedule)

    def _waited(self, schedule: Schedule) -> float:
        """s that a robot waits for others on the page."""
        return float(sum(min(s.end, self.last) - s.begin for s in schedule.waits))

    def _facts(self) -> dict[str, str]:
        made = self.made
        ends = np.isfinite(made.duration)
        facts = {"station time": f"{made.duration:.3f} s" if ends else "never ends"}
        if ends:
            facts["ends last"] = made.bottleneck
        if made.clearances:
            facts["least met"] = self._least()
            proven = [pair for pair in made.clearances if made.keeps(pair)]
            kept = f"{1e3 * made.station.clearance:g} mm"
            if len(proven) < len(made.clearances):
                kept += f" for {len(proven)} of {counted(made.clearances, 'pair')}"
            in_time = all(pair.in_time.proven for pair in proven)
            how = "proven in time" if in_time else "proven under interlocks"
            facts[how] = kept if proven else "nothing"
        return facts

    def _least(self) -> str:
        """The pair that comes nearest to each other, and how near."""
        pair = min(self.made.clearances, key=lambda one: one.least)
        near = f"{1e3 * pair.least:.1f} mm, " if pair.least > 0.0 else "touch: "
        return near + " – ".join(pair.robots)

    def _shares(self) -> Iterator[PageShare]:
        """What the time of each robot goes into."""
        for index, schedule in enumerate(self.made.run.schedules.values()):
            run = self.runs[index]
            waits = self._waited(schedule)
            if np.isfinite(schedule.end):
                yield from page_shares(run.program, run.report, index)
                slower = self.made.driven(schedule.name) - run.duration
                if slower > _LEAST:
                    yield PageShare("slower, together with others", slower, index)
            else:
                driven = self._driven(index, schedule)
                yield PageShare("motion, waits of its own", driven, index)
            if waits > 0.0:
                yield PageShare("waits for others", waits, index)

    # Rows over time

    def _robots(self) -> Iterator[PageBars]:
        for index, name in enumerate(self.made.station.members):
            track = self.draft.tracks[index]
            yield PageBars(name, list(self._bars(index, track)), index)

    def _bars(self, index: int, track: PageTrack) -> Iterator[PageBar]:
        schedule = list(self.made.run.schedules.values())[index]
        clock = self.clocks[index]
        for move, said in zip(self.runs[index].report.moves, track.moves, strict=True):
            if move.driven:
                ends = np.array([move.begin, move.begin + move.time + move.settling])
                begin, end = float(clock.begins(ends[:1])[0]), float(clock.first(ends[1:])[0])
                if begin < self.last:
                    text = f"move {said.number}: {said.label}"
                    yield PageBar("move", begin, end, text, said.source, said.line)
        for flag in track.flags:
            if flag.duration > 0.0 and flag.t < self.last:
                kind = "device" if flag.kind == "device" else "dwell"
                if any(abs(spell.begin - flag.t) < 1e-9 for spell in schedule.waits):
                    continue
                end = flag.t + flag.duration
                yield PageBar(kind, flag.t, end, flag.text, flag.source, flag.line)
        for spell in schedule.waits:
            if self._seen(spell):
                source, line = self.draft.sources.place(index, spell.action.span)
                kind = "meeting" if isinstance(spell.action.does, Meet) else "wait"
                end = min(spell.end, self.last)
                yield PageBar(kind, spell.begin, end, _waits_for(spell), source, line)

    def _signals(self) -> Iterator[PageBars]:
        made = self.made
        for name, spans in signals_on(made.station, made.run, made.actions, self.last).items():
            yield PageBars(name, [PageBar("on", begin, end, f"{name} on") for begin, end in spans])

    # Tables

    def _tables(self) -> Iterator[PageTable]:
        made = self.made
        names = list(made.station.members)
        yield PageTable("Robots", _ROBOTS, list(self._robot_rows()))
        rows = []
        for name, spell in made.waits():
            index = names.index(name)
            source, line = self.draft.sources.place(index, spell.action.span)
            length = spell.end - spell.begin if np.isfinite(spell.end) else None
            level = "error" if not np.isfinite(spell.end) else ""
            cells = (name, spell.begin, length, _waits_for(spell), _where(spell.action.span))
            rows.append(PageRow(cells, level, index, spell.begin, None, source, line))
        if rows:
            yield PageTable("Waits", _WAITS, rows)
        if self.handed:
            yield PageTable("Hand-overs", _HAND_OVERS, [self._handed_row(h) for h in self.handed])
        if made.clearances:
            yield self._pairs(names)
        if made.savings:
            saved = []
            for saving, told in zip(made.savings, made.saving_rows(), strict=True):
                index = names.index(saving.robot)
                source, line = self.draft.sources.place(index, saving.action.span)
                place = _where(saving.action.span)
                changed: list[PageCell] = [saving.seconds, *told[:2], place, told[3]]
                saved.append(PageRow(changed, "", index, None, None, source, line))
            note = "What could go or come earlier; the station is as much quicker."
            yield PageTable("Interlocks", _SAVINGS, saved, note)
        schedules = made.run.schedules.values()
        for index, (run, clock) in enumerate(zip(self.runs, self.clocks, strict=True)):
            if not np.isfinite(list(schedules)[index].end):
                continue  # Its lines and causes are of a program that is driven to its end.
            for table in time_tables(run, self.draft.sources, index):
                rows = [
                    row if row.t is None else replace(row, t=clock.last_at(row.t))
                    for row in table.rows
                ]
                yield replace(table, rows=rows)
        findings = [PageRow((text,), "error") for text in made.findings()]
        findings += [PageRow((str(note),), "warning") for note in made.notes]
        if findings:
            yield PageTable("Notes", [PageColumn("what")], findings)

    def _robot_rows(self) -> Iterator[PageRow]:
        made = self.made
        for index, (name, schedule) in enumerate(made.run.schedules.items()):
            waits = self._waited(schedule)
            ends = np.isfinite(schedule.end)
            slack = made.duration - schedule.end if np.isfinite(made.duration) else None
            cells = (
                name,
                float(len(made.station.members[name].program.moves)),
                schedule.begin,
                schedule.end if ends else None,
                self._driven(index, schedule),
                waits if waits > 0.0 and ends else None,
                slack,
            )
            yield PageRow(cells, "" if ends else "error", index, schedule.begin)

    def _handed_row(self, handed: _Handed) -> PageRow:
        cells: list[PageCell] = [handed.told.given]
        told = (handed.told.giver, handed.told.taker), handed.times, handed.spans
        for name, time, span in zip(*told, strict=True):
            cells += [name, time if np.isfinite(time) else "never", _where(span)]
        track = handed.tracks[1]
        source, line = self.draft.sources.place(track, handed.spans[1])
        happens = np.isfinite(handed.times).all()
        time = float(min(handed.times[1], self.last))
        return PageRow(cells, "" if happens else "error", track, time, None, source, line)

    def _pairs(self, names: list[str]) -> PageTable:
        columns = [
            PageColumn("robots"),
            PageColumn("least met", "mm", 1),
            *(PageColumn(one) for one in ("in time", "any time", "interlocked")),
        ]
        rows = []
        made = self.made
        for pair, told in zip(made.clearances, made.pair_rows(), strict=True):
            cells: list[PageCell] = [told[0], 1e3 * pair.least, *told[2:]]
            level = "error" if not made.keeps(pair) else "" if pair.safe else "warning"
            rows.append(PageRow(cells, level, names.index(pair.robots[0]), pair.least_at))
        return PageTable("Distances", columns, rows)


class _Handed(NamedTuple):
    """A part that changes hands, on the station's clock.

    Args:
        told: whose part it is.
        tracks: of giver and taker.
        times: s, when the giver lets go of it and the taker takes it.
        spans: where these stand.
    """

    told: HandOver
    tracks: tuple[int, int]
    times: tuple[float, float]
    spans: tuple[Span | None, Span | None]


def _until(made: DrivenStation) -> float:
    """s, until when anything happens."""
    if np.isfinite(made.duration):
        return max(made.duration, 1e-3)
    times = [s.end for s in made.run.schedules.values() if np.isfinite(s.end)]
    times += [spell.begin for s in made.run.schedules.values() for spell in s.waits]
    # A little of what lasts for ever.
    return 1.05 * max([1.0, *times, *(change.time for change in made.run.changes)])


def _clock(schedule: Schedule, duration: float, last: float) -> OtherClock:
    """The station's clock; until its program begins a robot stands where it does."""
    at = [min(spell.action.time + schedule.lag, duration) for spell in schedule.waits]
    length = [min(spell.end, last) - spell.begin for spell in schedule.waits]
    rests = np.array([0.0, *at]), np.array([schedule.begin, *length])
    return OtherClock(0.0, *rests, schedule.lag, schedule.pace)


def _waits_for(spell: Spell) -> str:
    how = " (gave up)" if spell.given_up else "" if np.isfinite(spell.end) else " (for ever)"
    return spell.action.text + how


def _span(statement: Statement) -> Span | None:
    """Where a statement stands; what takes a part or lets go of it is no move."""
    return statement.span if isinstance(statement, Opaque | Wait) else None


def _where(span: Span | None) -> str:
    return "" if span is None else f"{PurePath(span.file).name}:{span.line}"
