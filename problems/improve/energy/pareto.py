"""The energy of a program, and the front between its time and its energy.

A controller drives a program as fast as its numbers let it. So these numbers are what is sought: an
outer problem over speeds, accelerations, zones and via points, with the emulator and its exact
derivatives inside, whose result is plain robot code. This is the future work of D. Gleeson et al.,
"Towards Energy Optimization using Trajectory Smoothing and Automatic Code Generation for Robotic
Assembly" (Procedia CIRP 44, 2016).
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from contextlib import suppress
from dataclasses import dataclass, replace

from ....core.cell.cell import Cell
from ....core.collision.handled_scenes import scenes_along
from ....core.collision.proof.certificate import SceneOf
from ....core.dialect import Dialect
from ....core.display import counted
from ....core.errors import InputError, Note
from ....core.motion.emulator.controller import Controller
from ....core.motion.emulator.run import Run
from ....core.program.program import Program
from ...reading_back import ReadBack
from ..progress import Progress, Report
from ..solve_round_verify import ProgramFeasibility
from ..waypoints import Effort, optimize_waypoints
from ..waypoints.changeable import beside_parts, select, with_freed_stops
from ..waypoints.options import Freedom
from ..waypoints.options import WaypointTask as Wishes
from ..waypoints.variables import ProgramVariables, make_variables
from ..waypoints.zones_alone import with_zones_of, zones_alone
from .front import Front, FrontPoint, without_dominated
from .options import EnergyScope, EnergyTask, Goal
from .paced_problem import EvaluatedProgram, Watch
from .paced_search import LATE, PacedSearch
from .pacing import make_pacing

_FASTEST = 1e-3
"""Share of the shortest time that the fastest program may take longer, to be frugal in it."""
_WORTH = 5e-4
"""Share of the energy that a slower program must save to count."""
_CROWDED = 2.0
"""Power of the spacing of durations: energy falls steepest at the fast end."""
_KEPT = 1e-5
"""Of constraints, by which a program may be off and still counts as found."""
_Served = tuple[Goal, EvaluatedProgram]
"""A goal, and what serves it best."""


def pareto(
    controller: Controller,
    program: Program,
    cell: Cell | None = None,
    task: EnergyTask | None = None,
    count: int = 8,
    effort: Effort | None = None,
    dialect: Dialect | None = None,
    read_back: ReadBack = lambda program: program,
    report: Report | None = None,
) -> Front:
    """The front between time and energy of a program, as programs.

    Args:
        controller: drives the program.
        program: that is given; in a cell it keeps the clearance.
        cell: what stands around, and the clearance to keep; None where that does not count, and
            then only speeds and accelerations change.
        task: what is wanted, and what must stay.
        count: of durations between the shortest and that of the least energy, both included.
        effort: how hard to search.
        dialect: what the program's language has words for; None for everything.
        read_back: makes of a program what a controller would read. It is this program whose
            figures are reported and which is proven.
        report: called with progress; True, or the keyboard's interrupt, ends the search with the
            points found so far.

    Raises:
        InputError: fewer than two points, inertias that are not known, or nothing that may change.
        MotionError: the program collides, keeps less clearance than is asked for, or cannot be
            driven; the message names the move.
    """
    if count < 2:
        raise InputError(f"a front has two points at least, not {count}")
    made = _Work(
        controller, cell, task or EnergyTask(), effort or Effort(), dialect, read_back, report
    )
    return made.front(program, count)


def optimize_energy(
    controller: Controller,
    program: Program,
    goal: Goal,
    cell: Cell | None = None,
    task: EnergyTask | None = None,
    effort: Effort | None = None,
    dialect: Dialect | None = None,
    read_back: ReadBack = lambda program: program,
) -> Front:
    """One program that serves a goal best: a front of one point.

    Never one that serves it worse than the program that is given, unless that ends too late.
    Arguments and errors are those of `pareto`.
    """
    made = _Work(
        controller, cell, task or EnergyTask(), effort or Effort(), dialect, read_back, None
    )
    return made.single(program, goal)


@dataclass(frozen=True)
class _Work:
    """One request; arguments as above."""

    controller: Controller
    cell: Cell | None
    task: EnergyTask
    effort: Effort
    dialect: Dialect | None
    read_back: ReadBack
    report: Report | None

    def single(self, program: Program, goal: Goal) -> Front:
        """The program that serves a goal best."""
        notes: list[Note] = []
        search, given = self._prepared(program, notes)
        found = search.search(goal, search.start)
        point = search.finish(goal, found.x) or given
        if _rank(goal, given) <= _rank(goal, point):
            notes.append(Note("nothing better was found: this is the program as it was given"))
            point = given
        if goal.latest is not None and point.duration > goal.latest * (1.0 + LATE):
            notes.append(
                Note(
                    f"it takes {point.duration:.4g} s: no program that takes {goal.latest:.4g} s "
                    "was found and proven"
                )
            )
        return Front(given, (point,), self.task.consumption.unit, tuple(notes))

    def front(self, program: Program, count: int) -> Front:
        """All of it."""
        notes: list[Note] = []
        candidates: list[_Served] = []
        seen = _Seen(self.report, 2 * count)
        search, given = self._prepared(program, notes, seen.look)
        with suppress(KeyboardInterrupt, _Ended):
            self._search(search, count, candidates, seen)
        points: list[FrontPoint] = []
        with suppress(KeyboardInterrupt):
            self._tell("proving the largest zones", 0, 1)
            points += self._zones_alone(program, search)
            for k, (goal, candidate) in enumerate(candidates):
                finished = search.finish(goal, candidate.x)
                if finished is None:
                    notes.append(
                        Note(f"no program of {goal.latest or candidate.duration:.4g} s was proven")
                    )
                else:
                    points.append(finished)
                if self._tell(_proven(points, given), k + 1, len(candidates)):
                    break
        return Front(
            given,
            # How late programs may end is how well their times are known.
            without_dominated([*points, *([given] if given.proven else [])], _WORTH, LATE),
            self.task.consumption.unit,
            tuple(notes),
        )

    def _zones_alone(self, program: Program, search: PacedSearch) -> list[FrontPoint]:
        """The program with zones as large as they can be, which `zones` finds; or none."""
        if not self._shapes or self.cell is None:
            return []
        wishes = search.task.wishes
        program = replace(program, start=wishes.start or program.start)
        base = with_freed_stops(self.controller, program, wishes, [])
        made = zones_alone(self.controller, program, base, self.cell, wishes, self.read_back)
        if made is None or len(made.program.moves) != len(program.moves):
            return []  # written anew it may begin with a move of its own
        # Once more, with the texts that it is known by.
        read = self.read_back(with_zones_of(program, made.program))
        run, proof = search.feasibility.verified(read)
        if run is None or proof is None or not proof.proven:
            return []
        return [FrontPoint.of(self.controller, run, self.task.consumption, proof)]

    # -------------------------------------------------------------------------- searching

    def _search(self, search: PacedSearch, count: int, found: list[_Served], seen: _Seen) -> None:
        """Candidates from the fastest to the most frugal, added to ``found``.

        Where only speeds change, the program as it is is the fastest.
        """
        first = search.measured(Goal(), search.start)
        if first.energy == 0.0:
            raise InputError("this program takes no energy: there is nothing to save")
        seen.given = abs(first.energy)
        by_energy = 1.0 / abs(first.energy)
        fastest = first
        if search.variables is not None:
            fastest = search.search(Goal(1.0 / first.duration), search.start)
        seen.ask(1)
        latest = fastest.duration * (1.0 + _FASTEST)
        goal = Goal(0.0, by_energy, latest)
        quick = search.search(goal, fastest.x)
        found.append((goal, quick))
        seen.ask(2)
        frugal = search.search(Goal(0.0, by_energy), quick.x)
        for k in range(1, count - 1):
            share = (k / (count - 1)) ** _CROWDED
            latest = quick.duration + share * max(frugal.duration - quick.duration, 0.0)
            goal = Goal(0.0, by_energy, latest)
            found.append((goal, search.search_near(goal, found[-1][1].x)))
            seen.ask(2 + k)
        found.append((Goal(0.0, by_energy, max(frugal.duration, quick.duration)), frugal))
        self._back(search, found, count, seen)

    def _back(self, search: PacedSearch, found: list[_Served], count: int, seen: _Seen) -> None:
        """Each once more, from the slower one's values: where time is short routes differ."""
        for k in range(len(found) - 2, 0, -1):
            goal, known = found[k]
            other = search.search_near(goal, found[k + 1][1].x)
            found[k] = goal, min(known, other, key=lambda candidate: candidate.rank)
            seen.ask(2 * count - k)

    def _tell(self, stage: str, done: int, total: int) -> bool:
        return self.report is not None and bool(self.report(Progress(stage, done, total)))

    # -------------------------------------------------------------------------- preparing

    def _prepared(
        self, program: Program, notes: list[Note], watch: Watch | None = None
    ) -> tuple[PacedSearch, FrontPoint]:
        """Where to search, and the figures of the program that was given."""
        wishes = self._wishes
        program = replace(program, start=wishes.start or program.start)
        scenes = self._scenes(program)
        feasibility = ProgramFeasibility(self.controller, scenes, self._clearance, wishes.residual)
        run, proof = feasibility.given(program)
        given = FrontPoint.of(self.controller, run, self.task.consumption, proof)
        if scenes is not None and wishes.handling is not None:
            wishes = beside_parts(wishes, program, run.path, scenes)
        task = replace(self.task, wishes=wishes)
        base, wishes = self._routed(program, wishes, notes)
        driven = self.controller.run(base)
        robot, slowest = self.controller.robot, self.task.slowest
        pacing = make_pacing(base, driven.timing, robot, self.dialect, wishes, slowest)
        search = PacedSearch(
            self.controller,
            base,
            pacing,
            self._variables(base, driven, wishes, notes),
            scenes,
            self._clearance,
            task,
            self.effort,
            self.read_back,
            watch,
        )
        if not len(search.start):
            raise InputError(
                "nothing of this program may change: the process fixes all its speeds, or they "
                "have no words in its language"
            )
        return search, given

    def _scenes(self, program: Program) -> SceneOf | None:
        """The cell along each move of the program; None without one."""
        if self.cell is None:
            return None
        return scenes_along(
            self.cell,
            self.task.wishes.handling,
            program,
            lambda: self.controller.plan(program),
            self._clearance + self.task.wishes.residual,
        )

    @property
    def _clearance(self) -> float:
        wanted = self._wishes.clearance
        if wanted is None:
            return 0.0 if self.cell is None else self.cell.clearance
        return wanted

    @property
    def _wishes(self) -> Wishes:
        """What stays, points too where only zones may change."""
        points = self.task.scope is EnergyScope.WAYPOINTS
        freedom = Freedom.WAYPOINTS_AND_ZONES if points else Freedom.ZONES
        return replace(self.task.wishes, freedom=freedom)

    @property
    def _shapes(self) -> bool:
        """Whether points or zones may change: only where it is known what stands around."""
        return self.cell is not None and self.task.scope is not EnergyScope.SPEEDS

    def _routed(
        self, program: Program, wishes: Wishes, notes: list[Note]
    ) -> tuple[Program, Wishes]:
        """The program to begin with, the fastest one that a search from many starts finds, and
        what may still change in it."""
        if not self._shapes:
            return program, wishes
        if self.cell is not None and self.effort.starts > 1:
            fastest = replace(wishes, time_weight=1.0)
            found = optimize_waypoints(self.controller, program, self.cell, fastest, self.effort)
            if found.changed:
                return replace(found.program, start=program.start), wishes.spent()
        return with_freed_stops(self.controller, program, wishes, notes), wishes

    def _variables(
        self, program: Program, driven: Run, wishes: Wishes, notes: list[Note]
    ) -> ProgramVariables | None:
        """Points and zones that may change; None where all stay."""
        if not self._shapes:
            return None
        wishes = replace(wishes, freed=())
        robot = self.controller.robot
        selection = select(program, driven.path, robot, wishes)
        notes += [Note(said, i) for i, said in selection.stays.items()]
        made = make_variables(program, robot, selection, wishes)
        return made if made.size else None


@dataclass
class _Seen:
    """What a search has looked at, told as it goes on.

    Args:
        report: see `pareto`.
        total: searches.
        given: energy of the program as it is; 0 while it is not known.
        done: searches that are over.
        looked: programs that were driven.
        fastest, least: s and energy of those among them that keep what is to be kept.
    """

    report: Report | None
    total: int
    given: float = 0.0
    done: int = 0
    looked: int = 0
    fastest: float = math.inf
    least: float = math.inf

    def look(self, point: EvaluatedProgram) -> None:
        """Count a program that was driven; it may not end the search."""
        self.looked += 1
        if point.shape is None or point.shape.constraints.min(initial=0.0) > -_KEPT:
            self.fastest = min(self.fastest, point.duration)
            self.least = min(self.least, point.energy)
        if self.report is not None:
            self.report(self._progress())

    def ask(self, done: int) -> None:
        """Tell that so many searches are over.

        Raises:
            _Ended: the user has seen enough.
        """
        self.done = done
        if self.report is not None and self.report(self._progress()):
            raise _Ended

    def _progress(self) -> Progress:
        stage = f"searching, {counted(self.looked, 'program')} driven"
        if self.given and math.isfinite(self.fastest):
            least = 100.0 * self.least / self.given
            stage += f", so far from {self.fastest:.3f} s down to {least:.0f} % of the energy"
        return Progress(stage, self.done, self.total)


class _Ended(Exception):
    """The user has seen enough."""


def _proven(points: Sequence[FrontPoint], given: FrontPoint) -> str:
    """What is done while programs are written, and what there is already."""
    if not points:
        return "writing and proving"
    fastest = min(point.duration for point in points)
    least = 100.0 * min(point.energy for point in points) / abs(given.energy)
    return f"writing and proving, so far from {fastest:.3f} s down to {least:.0f} % of the energy"


def _rank(goal: Goal, point: FrontPoint) -> tuple[float, float]:
    """Smaller is better: programs in time first."""
    late = 0.0 if goal.latest is None else point.duration / goal.latest - 1.0
    cost = goal.time * point.duration + goal.energy * point.energy
    return (late if late > LATE else 0.0), cost
