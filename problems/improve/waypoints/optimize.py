"""Programs made faster, or less hungry, without a collision."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field, replace
from typing import TypeVar

from ....core.cell.cell import Cell
from ....core.collision.handled_scenes import scenes_along
from ....core.collision.proof.certificate import SceneOf, renumbered
from ....core.collision.proof.verdict import Certificate
from ....core.errors import FlybyError, MotionError, Note
from ....core.motion.emulator.controller import Controller
from ....core.motion.emulator.run import Run
from ....core.program.move import Move
from ....core.program.program import Program
from ....core.program.zone import Fine
from ...reading_back import ReadBack, read_as_written
from ...scene_notes import scene_notes
from ..approaches import approach_notes
from ..gains import seconds_gained
from ..process_paths import lines_moved
from ..progress import Progress, Report
from ..rounding import Rounding
from ..solution import Moved, Solution, measure, moved_points
from ..solve_round_verify import ProgramFeasibility, solve_round_verify
from .block_emulation import drivable
from .block_search import FEASIBLE, Answer, Shared
from .blocks import MoveBlock, cut
from .changeable import Selection, beside_parts, select, with_freed_stops
from .multistart import improve, searched
from .options import Effort, Freedom, ViaCount, WaypointTask
from .taken_back import without_idle_changes
from .variables import make_variables
from .via_selection import Counted, Rough, Searches, change_count, idle_points
from .zones_alone import with_zones_of, zones_alone

Found = TypeVar("Found")
_GAIN = 1e-6
"""Share of the objective below which nothing has been gained."""


def optimize_waypoints(
    controller: Controller,
    program: Program,
    cell: Cell,
    task: WaypointTask | None = None,
    effort: Effort | None = None,
    read_back: ReadBack = lambda program: program,
    report: Report | None = None,
) -> Solution:
    """The program with the via points and zones, or the zones alone, that make it fastest.

    What the process needs stays: stop points, and moves that it fixes.

    Args:
        controller: drives the program.
        program: that is to become faster; it keeps the clearance.
        cell: what stands around, and the clearance to keep.
        task: what is wanted, and what must stay.
        effort: how hard to search.
        read_back: makes of a program what a controller would read: written and read again. It is
            this program that is proven and returned.
        report: called with progress; True, or the keyboard's interrupt, ends the search with the
            best proven result so far.

    Returns:
        Never a slower program: the input comes back where nothing better was proven.

    Raises:
        InputError: the program has no move, or an option does not fit it.
        MotionError: the program collides, keeps less clearance than is asked for, or cannot be
            driven; the message names the move.
    """
    made = _Optimization(controller, cell, task or WaypointTask(), effort or Effort(), report)
    return made.solution(program, read_back)


@dataclass
class _Optimization:
    """One optimisation; arguments as above.

    Attributes:
        ended: whether the user has ended it.
        given: s, and energy where it counts, of the program as it was given.
        scenes: of the program as it was given.
    """

    controller: Controller
    cell: Cell
    task: WaypointTask
    effort: Effort
    report: Report | None
    ended: bool = field(default=False, init=False)
    given: tuple[float, float] = field(default=(1.0, 1.0), init=False)
    scenes: SceneOf = field(init=False)

    def solution(self, program: Program, read_back: ReadBack) -> Solution:
        """All of it."""
        self.scenes = scenes_along(
            self.cell,
            self.task.handling,
            program,
            lambda: self.controller.plan(program, self.task.start),
            self._clearance + self.task.residual,
        )
        given, proof = self._feasibility(self.task).given(program)
        self.given = self._costs(given)
        notes = list(scene_notes(self.scenes, program))
        if self.task.handling is not None:
            self.task = beside_parts(self.task, program, given.path, self.scenes)
        base = with_freed_stops(self.controller, program, self.task, notes)
        zones = self._zones_alone(program, base, read_back)
        found = self._improved(base, self.task, self.effort, notes)
        if zones is not None and (found is None or zones.cost < found.cost):
            found = self._beyond(zones, base) or found
        if found is not None and self.task.vias is ViaCount.CHANGE:
            found = self._counted(found)
        if found is not None:
            found = self._as_read(program, self._bare(given, found), read_back, notes)
        if zones is not None and zones.cost < (self._cost(given) if found is None else found.cost):
            # Once more, as what is read back last is what is written.
            found = self._as_read(program, self._bare(given, zones), read_back, notes)
        before = measure(self.controller, given, proof)
        if found is None or found.cost >= self._cost(given):
            notes.append(Note("nothing better was found: this is the program as it was given"))
            return Solution(program, program, before, before, proof, tuple(notes))
        if self.task.vias is ViaCount.KEEP:
            notes += self._idle(found)
        moved: tuple[Moved, ...] = ()
        gained: dict[int, float] = {}
        if found.task.as_many_moves:
            notes += approach_notes(given, found.run)
            moved = moved_points(self.controller.robot, given, found.run)
            notes += lines_moved(program, moved)
            gained = seconds_gained(given, found.run)
        after = measure(self.controller, found.run, found.certificate)
        return Solution(
            program,
            found.run.program,
            before,
            after,
            found.certificate,
            tuple(notes),
            moved,
            gained=gained,
        )

    def _zones_alone(self, program: Program, base: Program, read_back: ReadBack) -> Counted | None:
        """What the largest zones alone bring, with all points as they are."""
        task = self.task
        self._tell("making zones alone as large as they can be")
        made = zones_alone(self.controller, program, base, self.cell, task, read_back)
        if made is None or made.certificate is None:
            return None
        run = self.controller.run(made.program, task.start)
        return Counted(run, made.certificate, self._cost(run), task)

    def _beyond(self, zones: Counted, base: Program) -> Counted | None:
        """What a search from the largest zones finds, where one from the program as it is has
        found less than these; None if it is no better."""
        if self.ended or self.task.freedom is Freedom.ZONES:
            return None
        if len(zones.run.program.moves) != len(base.moves):
            return None
        begun = with_zones_of(base, zones.run.program)
        try:
            found = self._improved(begun, self.task, self.effort, [])
        except MotionError:
            return None
        return None if found is None or found.cost >= zones.cost else found

    def _tell(self, stage: str) -> None:
        if self.report is not None:
            self.report(Progress(stage, 0, 1))

    @property
    def _clearance(self) -> float:
        wanted = self.task.clearance
        return self.cell.clearance if wanted is None else wanted

    def _scenes(self, task: WaypointTask) -> SceneOf:
        """Of a task's program."""
        return self.scenes if task.given is None else renumbered(self.scenes, task.given)

    def _feasibility(self, task: WaypointTask) -> ProgramFeasibility:
        """What a task's whole program has to stand."""
        return ProgramFeasibility(
            self.controller,
            self._scenes(task),
            self._clearance,
            task.residual,
            task.start,
            beside=task.beside,
        )

    def _improved(
        self,
        program: Program,
        task: WaypointTask,
        effort: Effort,
        notes: list[Note],
    ) -> Counted | None:
        """The best proven program; None where the input is not bettered."""
        shared = self._shared(program, task, effort, notes)
        if not shared.blocks:
            return None
        best, ended = improve(shared, self.report)
        self.ended = self.ended or ended
        whole = _Whole(program, task.rounding, shared.blocks, _gains(best), notes)
        held = solve_round_verify(self._feasibility(task), whole)
        return None if held is None else self._judged(*held, task)

    def _roughly(self, program: Program, task: WaypointTask, effort: Effort) -> Rough | None:
        """What searches alone come to; None where nothing keeps the clearance.

        Raises:
            MotionError: the program cannot be driven, as it is or as it was found.
        """
        shared = self._shared(program, task, effort, [])
        best, ended = searched(shared, self.report)
        self.ended = self.ended or ended
        if any(a is None or a.violation > FEASIBLE for a in best):
            return None
        whole = _Whole(program, task.rounding, shared.blocks, _gains(best), [])
        found = whole.rounded() or program
        return Rough(found, self._cost(self.controller.run(found, task.start)))

    def _shared(
        self, program: Program, task: WaypointTask, effort: Effort, notes: list[Note]
    ) -> Shared:
        """What searches of a program share."""
        run = self.controller.run(program, task.start)
        robot = self.controller.robot
        selection = select(program, run.path, robot, task)
        variables = make_variables(program, robot, selection, task)
        notes += _stays(program, selection, task.freedom)
        cut_blocks = cut(program, run.path, variables, robot.arm_size)
        blocks = drivable(self.controller, run.path, cut_blocks, notes)
        alone = replace(task, beside=None)
        return Shared(self.controller, self._scenes(task), alone, effort, self._clearance, blocks)

    def _bare(self, given: Run, found: Counted) -> Counted:
        """Without the changes that bring nothing, as far as the user has not ended the work."""

        def judged(program: Program) -> Counted | None:
            if self.ended:
                return None
            try:
                return self._judged(*self._feasibility(found.task).verified(program), found.task)
            except KeyboardInterrupt:
                self.ended = True
            return None

        return without_idle_changes(given, found, judged)

    def _as_read(
        self,
        given: Program,
        found: Counted,
        read_back: ReadBack,
        notes: list[Note],
    ) -> Counted | None:
        """The program as it is read from its new text, proven again; None if it is not."""
        try:
            written = read_as_written(given, found.run.program, read_back)
        except FlybyError as error:
            notes.append(Note(f"given up, as the new program cannot be written: {error}"))
            return None
        notes += written.notes
        run, proof = self._feasibility(found.task).verified(written.program)
        kept = self._judged(run, proof, found.task)
        if kept is None:
            why = "it cannot be driven" if proof is None else proof.message
            notes.append(Note(f"given up, as the program read from the new text fails: {why}"))
        return kept

    def _judged(
        self, run: Run | None, proof: Certificate | None, task: WaypointTask
    ) -> Counted | None:
        """A program with its cost; None if it is not proven."""
        if run is None or proof is None or not proof.proven:
            return None
        return Counted(run, proof, self._cost(run), task)

    def _counted(self, found: Counted) -> Counted:
        """With via points left out that serve nothing, and new ones that save time."""

        def unless_ended(
            search: Callable[[Program, WaypointTask, Effort], Found | None],
        ) -> Callable[[Program, WaypointTask, Effort], Found | None]:
            def searched(program: Program, task: WaypointTask, effort: Effort) -> Found | None:
                if self.ended:
                    return None
                try:
                    return search(program, task, effort)
                except KeyboardInterrupt:
                    # Between searches, too: what is proven already stays.
                    self.ended = True
                except MotionError:
                    pass
                return None

            return searched

        def improved(program: Program, task: WaypointTask, effort: Effort) -> Counted | None:
            found = self._improved(program, task, effort, [])
            # Nothing is left to change, or to better.
            return found or self._judged(*self._feasibility(task).verified(program), task)

        def selected(counted: Counted) -> Selection:
            run, task = counted.run, counted.task
            return select(run.program, run.path, robot, task)

        robot = self.controller.robot
        searches = Searches(unless_ended(self._roughly), unless_ended(improved), selected)
        return change_count(found, searches, self.effort, robot.arm_size)

    def _idle(self, found: Counted) -> list[Note]:
        """An offer to leave out via points that serve nothing."""

        def judged(program: Program, task: WaypointTask) -> float | None:
            kept = self._judged(*self._feasibility(task).verified(program), task)
            return None if kept is None else kept.cost

        run, robot = found.run, self.controller.robot
        selection = select(run.program, run.path, robot, found.task)
        return [
            Note("serves nothing any more: without it the program is as fast and as safe", i)
            for i in idle_points(found, selection, judged)
        ]

    def _cost(self, run: Run) -> float:
        """The objective: of time and energy the shares of what the given program takes."""
        weight = self.task.time_weight
        time, energy = self._costs(run)
        return weight * time / self.given[0] + (1.0 - weight) * energy / self.given[1]

    def _costs(self, run: Run) -> tuple[float, float]:
        """Time, and energy where it counts."""
        if self.task.time_weight == 1.0:
            return run.duration, 1.0
        return run.duration, self.controller.energy(run.program, run.timing).value


@dataclass(frozen=True)
class _Whole:
    """The blocks put together; one that does not hold in the whole is left as it was.

    Args:
        program: the whole, as it was.
        rounding: of new numbers.
        blocks: of it.
        chosen: what was found for each; None where it stays.
        notes: of what is left as it was.
    """

    program: Program
    rounding: Rounding
    blocks: Sequence[MoveBlock]
    chosen: list[Answer | None]
    notes: list[Note]

    def rounded(self) -> Program | None:
        """The whole with what has changed in every block; moves keep their places in the source."""
        if not any(answer is not None for answer in self.chosen):
            return None
        moves: list[Move] = list(self.program.moves)
        for block, answer in zip(self.blocks, self.chosen, strict=True):
            if answer is None:
                continue
            changed = block.variables.written(answer.x, self.rounding).moves
            for k, move in enumerate(changed):
                old = moves[block.first + k]
                moves[block.first + k] = replace(old, target=move.target, zone=move.zone)
        return self.program.with_moves(tuple(moves))

    def undrivable(self, error: MotionError) -> None:
        """The last change is given up."""
        self._give_up(None, "it cannot be driven")

    def accepted(self, run: Run, certificate: Certificate | None) -> bool:
        """Whether it is proven; if not, the change where it is not is given up."""
        assert certificate is not None
        if not certificate.proven:
            self._give_up(certificate.move, certificate.message)
        return certificate.proven

    def _give_up(self, move: int | None, why: str) -> None:
        live = [k for k, answer in enumerate(self.chosen) if answer is not None]
        there = [
            k
            for k in live
            if move is not None and self.blocks[k].first <= move <= self.blocks[k].last
        ]
        culprit = (there or live[-1:])[0]
        self.notes.append(
            Note(
                f"what was found from here on was given up, as the whole is not proven: {why}",
                self.blocks[culprit].first,
            )
        )
        self.chosen[culprit] = None


def _gains(best: Sequence[Answer | None]) -> list[Answer | None]:
    """Those by which something is gained."""
    return [a if a is not None and a.objective < 1.0 - _GAIN else None for a in best]


def _stays(program: Program, selection: Selection, freedom: Freedom) -> list[Note]:
    """What does not change, and why."""
    if not selection.passed:
        all_stop = all(isinstance(move.zone, Fine) for move in program.moves)
        stops = "stops at every point" if all_stop else "has no zone that counts"
        return [
            Note(
                f"the program {stops}: there is no via point and no zone to change; free the "
                "stops that the robot may pass"
            )
        ]
    notes = [
        Note(said, move, program.moves[move].statement) for move, said in selection.stays.items()
    ]
    if freedom is Freedom.WAYPOINTS_AND_ZONES and not selection.points:
        notes.append(Note("no via point may move: only zones are optimised"))
    return notes
