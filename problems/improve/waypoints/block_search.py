"""What one search does: from a start at few places, refined at many, and proven between them."""

from __future__ import annotations

from copy import copy
from dataclasses import dataclass, field, replace
from enum import Enum, auto
from functools import cached_property

import numpy as np

from ....core.arrays import FloatArray
from ....core.collision.proof.certificate import SceneOf, renumbered
from ....core.collision.proof.verdict import Certificate
from ....core.errors import MotionError
from ....core.motion.emulator.controller import Controller
from ....core.motion.emulator.run import Run
from ....core.program.program import Program
from ..nonsmooth_sqp import Memory, SearchEffort, search, violation
from ..solve_round_verify import ProgramFeasibility, solve_round_verify
from .aim import FINE, Aim, driven_moves, with_room
from .block_problem import BlockCost, BlockProblem
from .blocks import MoveBlock
from .options import Effort, WaypointTask

FINE_BOX = 0.2
"""First trust box of a refinement."""
FINE_ITERATIONS = 40
"""Of a refinement, at most: one that has not come to its end and may win goes on."""
_AGAIN_ITERATIONS, _AGAIN_BOX = 10, 0.05
"""Of a refinement with a wider margin, which begins near its end."""
FEASIBLE = 1e-4
"""m of violation that a refinement mends."""


@dataclass(frozen=True)
class Shared:
    """What all searches share.

    Args:
        controller, task, effort: see `optimize`.
        scenes: of the whole program's moves.
        clearance: m to keep.
        blocks: of it.

    Attributes:
        problems: that have been set up, by whether they are fine, block and aim: searches of one
            block go on from each other.
    """

    controller: Controller
    scenes: SceneOf
    task: WaypointTask
    effort: Effort
    clearance: float
    blocks: tuple[MoveBlock, ...]
    problems: dict[tuple[bool, int, float, int], BlockProblem] = field(
        default_factory=dict, init=False, repr=False, compare=False
    )

    @cached_property
    def searching(self) -> Controller:
        """The controller with the sampling of searches."""
        other = copy(self.controller)
        other.sampling = self.effort.sampling
        return other

    def problem(self, fine: bool, block: int, aim: Aim) -> BlockProblem:
        """A block as a problem, with the controller's own sampling or that of searches.

        Raises:
            MotionError: it cannot be driven as it was given.
        """
        key = fine, block, aim.margin, aim.density
        if aim.more is None and key in self.problems:
            return self.problems[key]
        made = BlockProblem(
            self.controller if fine else self.searching,
            self.blocks[block],
            self.scenes_of(block),
            self.task,
            self.clearance + aim.margin,
            self.clearance,
            aim.density,
            aim.more,
        )
        if aim.more is None:
            self.problems[key] = made
        return made

    def scenes_of(self, block: int) -> SceneOf:
        """The scenes of one block's moves."""
        chosen = self.blocks[block]
        return renumbered(self.scenes, range(chosen.first, chosen.last + 1))

    def feasibility(self, block: int) -> ProgramFeasibility:
        """What a block alone has to stand."""
        return ProgramFeasibility(
            self.controller,
            self.scenes_of(block),
            self.clearance,
            self.task.residual,
            resolution=None,
        )


class JobStage(Enum):
    """What is to be done."""

    SEARCH = auto()
    REFINE = auto()
    PROVE = auto()


@dataclass(frozen=True)
class Job:
    """One search.

    Args:
        block: index of the block.
        memory: where to begin, and with what.
        iterations: of a search or a refinement, at most.
        stage: what is to be done.
        refined: what is to be proven.
    """

    block: int
    memory: Memory
    iterations: int = FINE_ITERATIONS
    stage: JobStage = JobStage.SEARCH
    refined: Answer | None = None


@dataclass(frozen=True, eq=False)
class Answer:
    """What came of a search.

    Args:
        block: index of the block.
        x: the best values.
        objective: there, in shares of the input's.
        violation: largest one there.
        finished: whether the search came to its end.
        memory: to go on with.
        fell: how far the objective has fallen; unknown, and infinite, from where the clearance was
            not kept.
        certificate: of the driven block, if it was to be proven.
    """

    block: int
    x: FloatArray
    objective: float
    violation: float
    finished: bool
    memory: Memory
    fell: float = np.inf
    certificate: Certificate | None = None

    @property
    def proven(self) -> bool:
        """Whether the values keep the clearance."""
        return self.certificate is not None and self.certificate.proven

    def rank(self) -> tuple[float, float]:
        """Smaller is better: feasible ones first."""
        return (0.0 if self.violation < FEASIBLE else self.violation), self.objective


def work(shared: Shared, job: Job) -> Answer:
    """Do a job."""
    margin = shared.effort.margin
    if job.stage is JobStage.SEARCH:
        return _searched(shared, job, SearchEffort(job.iterations), Aim(margin), fine=False)
    if job.stage is JobStage.REFINE:
        settings = SearchEffort(job.iterations, FINE_BOX)
        return _searched(shared, job, settings, Aim(margin, FINE))
    if shared.task.rounding.predefined:
        shared, job = _with_chosen_zones(shared, job)
    at_end = job.refined is not None and job.refined.memory.box <= _AGAIN_BOX
    refined = _Refined(
        shared,
        job,
        Aim(margin, FINE),
        shared.effort.proofs + 1,
        job.refined if at_end else None,
    )
    solve_round_verify(shared.feasibility(job.block), refined)
    assert refined.answer is not None, "there is one attempt at least"
    return refined.answer


def _searched(
    shared: Shared, job: Job, settings: SearchEffort, aim: Aim, fine: bool = True
) -> Answer:
    """The best values near a start."""
    memory = job.memory
    stand = None
    try:
        problem = shared.problem(fine, job.block, aim)
        stand = problem.stands.pop(memory.x.tobytes(), None)
        start = problem.point(memory.x) if stand is None else stand.point
    except MotionError:
        # As it is it can be driven, but not with these zones, or this sampling.
        start = None
    if start is None:
        return Answer(job.block, memory.x, np.inf, np.inf, True, memory)
    try:
        known = None if stand is None else stand.gradient
        found = search(problem, start, settings, memory, known)
    except MotionError:
        # A pose target is singular where the search stands: no derivatives, no way on.
        return Answer(job.block, start.x, start.objective, violation(start), True, memory)
    if not found.finished:
        problem.remember(found.stand)
    point = found.point
    fell = start.objective - point.objective if violation(start) <= FEASIBLE else np.inf
    return Answer(
        job.block, point.x, point.objective, found.violation, found.finished, found.memory, fell
    )


@dataclass
class _Refined:
    """Refined values on their way to a proof.

    Where it fails, the search looks there more closely, and aims wider.

    Args:
        shared, job: see `work`.
        aim: of the next search.
        left: searches.
        refined: values whose search came to its end: they are tried as they are at first.
        answer: of the last search.
    """

    shared: Shared
    job: Job
    aim: Aim
    left: int
    refined: Answer | None = None
    answer: Answer | None = None

    def rounded(self) -> Program | None:
        """The block with the values found next, so rounded that zones have room."""
        if not self.left:
            return None
        self.left -= 1
        shared, settings = self.shared, SearchEffort(_AGAIN_ITERATIONS, _AGAIN_BOX)
        job = replace(self.job, memory=Memory(self.job.memory.x, _AGAIN_BOX))
        answer, self.refined = self.refined, None
        if answer is None:
            answer = _searched(shared, job, settings, self.aim)
        if not shared.task.rounding.predefined:
            # Predefined: the next smaller zone would be far smaller; to be cut by a hair does no
            # harm.
            variables, plan = shared.blocks[job.block].variables, shared.controller.plan
            moves = driven_moves(plan, variables, answer.x)
            room = with_room(answer.x, variables, lambda x: plan(self._written(x)), moves)
            answer = replace(answer, x=room)
        self.job, self.answer = replace(job, memory=answer.memory), answer
        return self._written(answer.x) if np.isfinite(answer.objective) else None

    def undrivable(self, error: MotionError) -> None:
        """There is no other way to round it."""
        self.left = 0

    def accepted(self, run: Run, certificate: Certificate | None) -> bool:
        """Whether it is proven. Its objective is then that of the rounded program."""
        assert self.answer is not None
        assert certificate is not None
        objective = self._cost.of(run.program, run.timing)
        self.answer = replace(self.answer, certificate=certificate, objective=objective)
        if not certificate.proven:
            self.aim = self.aim.after(run, certificate, self.shared.clearance)
        return certificate.proven

    @cached_property
    def _cost(self) -> BlockCost:
        """The objective."""
        shared = self.shared
        variables = shared.blocks[self.job.block].variables
        given = variables.applied(variables.start)
        timing = shared.controller.stamp(given, shared.controller.plan(given))
        return BlockCost.beside(shared.controller, shared.task.time_weight, given, timing)

    def _written(self, x: FloatArray) -> Program:
        shared = self.shared
        return shared.blocks[self.job.block].variables.written(x, shared.task.rounding)


def _with_chosen_zones(shared: Shared, job: Job) -> tuple[Shared, Job]:
    """The job with predefined zones, for which its points are refined once more."""
    block = shared.blocks[job.block]
    chosen = block.variables.with_chosen_zones(job.memory.x, shared.task.rounding)
    blocks = list(shared.blocks)
    blocks[job.block] = replace(block, variables=chosen)
    shared = replace(shared, blocks=tuple(blocks))
    x = np.clip(job.memory.x, chosen.lower, chosen.upper)
    refined = work(shared, replace(job, memory=Memory(x, FINE_BOX), stage=JobStage.REFINE))
    return shared, replace(job, memory=refined.memory, refined=refined)
