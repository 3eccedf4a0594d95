"""Programs made faster, or less hungry, without a collision."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field, replace

from ....core.cell.cell import Cell
from ....core.collision.proof.certificate import SceneOf, certify, scenes_of
from ....core.collision.proof.verdict import Certificate
from ....core.errors import FlybyError, MotionError, Note
from ....core.motion.emulator.controller import Controller
from ....core.motion.emulator.run import Run
from ....core.program.move import Move
from ....core.program.program import Program
from ....core.program.zone import Fine
from ...reading_back import ReadBack, read_as_written
from ...scene_notes import scene_notes
from ..solution import RESOLUTION, Solution, measure, moved_points
from ..start_check import check_start
from .block_emulation import drivable
from .blocks import Block, cut
from .changeable import Selection, select
from .freed_stops import with_freed_stops
from .multistart import Report, improve
from .options import Effort, Freedom, Task, ViaCount
from .solve_round_verify import Answer, Workshop
from .variables import make_variables
from .via_selection import Counted, change_count, idle_points

_GAIN = 1e-6
"""Share of the objective below which nothing has been gained."""


def optimize_zones(
    controller: Controller,
    program: Program,
    cell: Cell,
    task: Task | None = None,
    effort: Effort | None = None,
    read_back: ReadBack = lambda program: program,
    report: Report | None = None,
) -> Solution:
    """The program with the zones that make it fastest; all points stay.

    Args:
        controller: drives the program.
        program: that is to become faster; it keeps the clearance.
        cell: what stands around, and the clearance to keep.
        task: what is wanted, and what must stay.
        effort: how hard to search.
        read_back: makes of a program what a controller would read: written and read again. It is
            this program that is proven and returned.
        report: is told of progress; True, or the keyboard's interrupt, ends the search with the
            best proven result so far.

    Returns:
        Never a slower program: the input comes back where nothing better was proven.

    Raises:
        InputError: the program has no move, or an option does not fit it.
        MotionError: the program collides, keeps less clearance than is asked for, or cannot be
            driven; the message names the move.
    """
    made = _Optimization(
        controller, cell, task or Task(), effort or Effort(), Freedom.ZONES, report
    )
    return made.solution(program, read_back)


def optimize_waypoints(
    controller: Controller,
    program: Program,
    cell: Cell,
    task: Task | None = None,
    effort: Effort | None = None,
    read_back: ReadBack = lambda program: program,
    report: Report | None = None,
) -> Solution:
    """The program with the via points and zones that make it fastest.

    Tasks stay: stop points, and moves that the process fixes. Arguments, result and errors are
    those of `optimize_zones`.
    """
    made = _Optimization(
        controller, cell, task or Task(), effort or Effort(), Freedom.WAYPOINTS_AND_ZONES, report
    )
    return made.solution(program, read_back)


@dataclass
class _Optimization:
    """One optimisation; arguments as above.

    Attributes:
        ended: whether the user has ended it.
        given: s, and energy where it counts, of the program as it was given.
    """

    controller: Controller
    cell: Cell
    task: Task
    effort: Effort
    freedom: Freedom
    report: Report | None
    ended: bool = field(default=False, init=False)
    given: tuple[float, float] = field(default=(1.0, 1.0), init=False)

    def solution(self, program: Program, read_back: ReadBack) -> Solution:
        """All of it."""
        scenes = scenes_of(self.cell)
        given = self.controller.run(program, self.task.start)
        proof = self._proof(given, scenes)
        check_start(self.controller, given, scenes, proof, self.task.residual)
        self.given = self._costs(given)
        notes = list(scene_notes(scenes, program))
        base = with_freed_stops(self.controller, program, self.task, notes)
        found = self._improved(base, self.task, self.effort, scenes, notes)
        if found is not None and self.task.vias is ViaCount.CHANGE:
            found = self._counted(found, scenes)
        if found is not None:
            found = self._as_read(program, found, scenes, read_back, notes)
        before = measure(self.controller, given, proof)
        if found is None or found.cost >= self._cost(given):
            notes.append(Note("nothing better was found: this is the program as it was given"))
            return Solution(program, program, before, before, proof, tuple(notes))
        if self.task.vias is ViaCount.KEEP:
            notes += self._idle(found, scenes)
        after = measure(self.controller, found.run, found.certificate)
        return Solution(
            program,
            found.run.program,
            before,
            after,
            found.certificate,
            tuple(notes),
            moved_points(self.controller.robot, given, found.run),
        )

    @property
    def _clearance(self) -> float:
        wanted = self.task.clearance
        return self.cell.clearance if wanted is None else wanted

    def _improved(
        self,
        program: Program,
        task: Task,
        effort: Effort,
        scenes: SceneOf,
        notes: list[Note],
    ) -> Counted | None:
        """The best proven program; None where the input is not bettered."""
        run = self.controller.run(program, task.start)
        robot = self.controller.robot
        selection = select(program, run.path, robot, task, self.freedom)
        variables = make_variables(program, robot, selection, task)
        notes += _stays(program, selection, self.freedom)
        cut_blocks = cut(program, run.path, variables, robot.arm_size)
        blocks = drivable(self.controller, run.path, cut_blocks, notes)
        if not blocks:
            return None
        shop = Workshop(self.controller, scenes, task, effort, self._clearance, blocks)
        made = improve(shop, self.report)
        self.ended = self.ended or made.ended
        chosen = [a if a is not None and a.objective < 1.0 - _GAIN else None for a in made.best]
        return self._together(program, task, blocks, chosen, scenes, notes)

    def _together(
        self,
        program: Program,
        task: Task,
        blocks: Sequence[Block],
        chosen: list[Answer | None],
        scenes: SceneOf,
        notes: list[Note],
    ) -> Counted | None:
        """The blocks put together; one that does not hold in the whole is left as it was."""
        while any(answer is not None for answer in chosen):
            run = self._driven(_assembled(program, blocks, chosen, task), task)
            proof = None if run is None else self._proof(run, scenes)
            if run is not None and proof is not None and proof.proven:
                return Counted(run, proof, self._cost(run), task)
            culprit = _culprit(blocks, chosen, proof)
            why = proof.message if proof is not None else "it cannot be driven"
            notes.append(
                Note(
                    f"what was found from here on was given up, as the whole is not proven: {why}",
                    blocks[culprit].first,
                )
            )
            chosen[culprit] = None
        return None

    def _as_read(
        self,
        given: Program,
        found: Counted,
        scenes: SceneOf,
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
        run = self._driven(written.program, found.task)
        proof = None if run is None else self._proof(run, scenes)
        if run is None or proof is None or not proof.proven:
            why = "it cannot be driven" if proof is None else proof.message
            notes.append(Note(f"given up, as the program read from the new text fails: {why}"))
            return None
        return replace(found, run=run, certificate=proof, cost=self._cost(run))

    def _counted(self, found: Counted, scenes: SceneOf) -> Counted:
        """With via points left out that serve nothing, and new ones that pay."""

        def improved(program: Program, task: Task, effort: Effort) -> Counted | None:
            if self.ended:
                return None
            try:
                found = self._improved(program, task, effort, scenes, [])
                return found or self._as_it_is(program, task, scenes)
            except KeyboardInterrupt:
                # Between searches, too: what is proven already stays.
                self.ended = True
            except MotionError:
                pass
            return None

        def selected(counted: Counted) -> Selection:
            run, task = counted.run, counted.task
            return select(run.program, run.path, robot, task, self.freedom)

        robot = self.controller.robot
        return change_count(found, improved, selected, self.effort, robot.arm_size)

    def _as_it_is(self, program: Program, task: Task, scenes: SceneOf) -> Counted | None:
        """A program in which nothing is left to change, or to better; None if it is not proven."""
        run = self._driven(program, task)
        proof = None if run is None else self._proof(run, scenes)
        if run is None or proof is None or not proof.proven:
            return None
        return Counted(run, proof, self._cost(run), task)

    def _idle(self, found: Counted, scenes: SceneOf) -> list[Note]:
        """An offer to leave out via points that serve nothing."""

        def judged(program: Program) -> float | None:
            run = self._driven(program, found.task)
            if run is None or not self._proof(run, scenes).proven:
                return None
            return self._cost(run)

        run, robot = found.run, self.controller.robot
        selection = select(run.program, run.path, robot, found.task, self.freedom)
        return [
            Note("serves nothing any more: without it the program is as fast and as safe", i)
            for i in idle_points(found, selection, judged)
        ]

    def _driven(self, program: Program, task: Task) -> Run | None:
        try:
            return self.controller.run(program, task.start)
        except MotionError:
            return None

    def _proof(self, run: Run, scenes: SceneOf) -> Certificate:
        return certify(
            self.controller,
            run,
            scenes,
            self._clearance,
            self.task.residual,
            resolution=RESOLUTION,
        )

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


def _assembled(
    program: Program, blocks: Sequence[Block], answers: Sequence[Answer | None], task: Task
) -> Program:
    """The program with what has changed in every block; moves keep their places in the source."""
    moves: list[Move] = list(program.moves)
    for block, answer in zip(blocks, answers, strict=True):
        if answer is None:
            continue
        changed = block.variables.written(answer.x, task.rounding).moves
        for k, move in enumerate(changed):
            old = moves[block.first + k]
            moves[block.first + k] = replace(old, target=move.target, zone=move.zone)
    return program.with_moves(tuple(moves))


def _culprit(
    blocks: Sequence[Block], answers: Sequence[Answer | None], proof: Certificate | None
) -> int:
    """The block whose change is to be given up."""
    live = [k for k, answer in enumerate(answers) if answer is not None]
    if proof is not None and proof.move is not None:
        for k in live:
            if blocks[k].first <= proof.move <= blocks[k].last:
                return k
    return live[-1]


def _stays(program: Program, selection: Selection, freedom: Freedom) -> list[Note]:
    """What does not change, and why."""
    if not selection.passed:
        stops = "stops at every point" if _all_stop(program) else "has no zone that counts"
        return [
            Note(
                f"the program {stops}: there is no via point and no zone to change; free the "
                "stops that the robot may pass"
            )
        ]
    notes = [Note(f"stays as it is: {why}", move) for move, why in selection.reasons.items()]
    if freedom is Freedom.WAYPOINTS_AND_ZONES and not selection.points:
        notes.append(Note("no via point may move: only zones are optimised"))
    return notes


def _all_stop(program: Program) -> bool:
    return all(isinstance(move.zone, Fine) for move in program.moves)
