"""What one search does: from a start at few places, refined at many, and proven between them."""

from __future__ import annotations

from copy import copy
from dataclasses import dataclass, replace
from enum import Enum, auto
from functools import cached_property

import numpy as np

from ....core.arrays import FloatArray
from ....core.collision.proof.certificate import SceneOf, certify
from ....core.collision.proof.verdict import Certificate, Verdict
from ....core.errors import MotionError
from ....core.motion.emulator.controller import Controller
from ....core.motion.emulator.run import Run
from ....core.motion.gradients.sensitivity import PathPlaces
from ....core.program.program import Program
from ..nonsmooth_sqp import Memory, Settings, search, violation
from ..rounding import STEP
from .block_emulation import crowd, rooms_of
from .block_problem import BlockProblem
from .blocks import Block
from .options import Effort, Task

FINE_BOX = 0.2
"""First trust box of a refinement."""
_FINE_ITERATIONS = 25
_AGAIN_ITERATIONS, _AGAIN_BOX = 10, 0.05
"""Of a refinement with a wider margin, which begins near its end."""
_COARSE, _FINE = 2, 4
"""Density of places of a search and of a refinement."""
_WIDER, _AMPLE = 1.3, 1.15
_STEPS = STEP * 2.0 ** np.arange(8)
"""m by which zones are made smaller in turn that rounding has left without room."""
_TIGHT = 1e-9
FEASIBLE = 1e-4
"""m of violation that a refinement mends."""


@dataclass(frozen=True)
class Workshop:
    """What all searches share.

    Args:
        controller, scenes, task, effort: see `optimize`.
        clearance: m to keep.
        blocks: the problems.
    """

    controller: Controller
    scenes: SceneOf
    task: Task
    effort: Effort
    clearance: float
    blocks: tuple[Block, ...]

    @cached_property
    def searching(self) -> Controller:
        """The controller with the sampling of searches."""
        other = copy(self.controller)
        other.sampling = self.effort.sampling
        return other


class Stage(Enum):
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
        iterations: of a search, at most.
        stage: what is to be done.
    """

    block: int
    memory: Memory
    iterations: int = _FINE_ITERATIONS
    stage: Stage = Stage.SEARCH


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
        certificate: of the driven block, if it was to be proven.
    """

    block: int
    x: FloatArray
    objective: float
    violation: float
    finished: bool
    memory: Memory
    certificate: Certificate | None = None

    @property
    def proven(self) -> bool:
        """Whether the values keep the clearance."""
        return self.certificate is not None and self.certificate.proven

    def rank(self) -> tuple[float, float]:
        """Smaller is better: feasible ones first."""
        return (0.0 if self.violation < FEASIBLE else self.violation), self.objective


def work(shop: Workshop, job: Job) -> Answer:
    """Do a job."""
    if job.stage is Stage.SEARCH:
        return _searched(shop, job, _Manner(shop.searching, Settings(job.iterations), _COARSE))
    if job.stage is Stage.REFINE:
        settings = Settings(_FINE_ITERATIONS, FINE_BOX)
        return _searched(shop, job, _Manner(shop.controller, settings, _FINE))
    return _proven(shop, job)


@dataclass(frozen=True)
class _Manner:
    """How to search.

    Args:
        controller: that drives.
        settings: how long.
        density: of places.
        margin: m that comes to that of the effort.
        more: places.
    """

    controller: Controller
    settings: Settings
    density: int
    margin: float = 0.0
    more: PathPlaces | None = None


def _searched(shop: Workshop, job: Job, manner: _Manner) -> Answer:
    """The best values near a start."""
    memory = job.memory
    try:
        problem = BlockProblem(
            manner.controller,
            shop.blocks[job.block],
            shop.scenes,
            shop.task,
            shop.clearance + shop.effort.margin + manner.margin,
            shop.clearance,
            manner.density,
            manner.more,
        )
        start = problem.point(memory.x)
    except MotionError:
        # As it is it can be driven, but not with these zones, or this sampling.
        start = None
    if start is None:
        return Answer(job.block, memory.x, np.inf, np.inf, True, memory)
    try:
        found = search(problem, start, manner.settings, memory)
    except MotionError:
        # A pose target is singular where the search stands: no derivatives, no way on.
        return Answer(job.block, start.x, start.objective, violation(start), True, memory)
    point = found.point
    return Answer(
        job.block, point.x, point.objective, found.violation, found.finished, found.memory
    )


def _proven(shop: Workshop, job: Job) -> Answer:
    """Refined values with their certificate.

    Where the proof fails, the search is told to look there more closely, and aims wider.
    """
    if shop.task.rounding.predefined:
        shop, job = _with_chosen_zones(shop, job)
    manner = _Manner(shop.controller, Settings(_AGAIN_ITERATIONS, _AGAIN_BOX), _FINE)
    for _ in range(shop.effort.proofs + 1):
        job = replace(job, memory=Memory(job.memory.x, _AGAIN_BOX))
        answer = _searched(shop, job, manner)
        answer = replace(answer, x=_with_room(shop, answer))
        run = _driven(shop, answer)
        if run is None:
            return answer
        certificate = certify(shop.controller, run, shop.scenes, shop.clearance, shop.task.residual)
        answer = replace(answer, certificate=certificate)
        if answer.proven:
            return answer
        wider = wider_margin(shop.effort.margin + manner.margin, shop.clearance, certificate)
        manner = replace(
            manner, margin=wider - shop.effort.margin, more=_more(manner.more, run, certificate)
        )
        job = replace(job, memory=answer.memory)
    return answer


def _with_chosen_zones(shop: Workshop, job: Job) -> tuple[Workshop, Job]:
    """The job with predefined zones, for which its points are refined once more."""
    block = shop.blocks[job.block]
    chosen = block.variables.with_chosen_zones(job.memory.x, shop.task.rounding)
    blocks = list(shop.blocks)
    blocks[job.block] = replace(block, variables=chosen)
    shop = replace(shop, blocks=tuple(blocks))
    x = np.clip(job.memory.x, chosen.lower, chosen.upper)
    refined = work(shop, replace(job, memory=Memory(x, FINE_BOX), stage=Stage.REFINE))
    return shop, replace(job, memory=refined.memory)


def _driven(shop: Workshop, answer: Answer) -> Run | None:
    if not np.isfinite(answer.objective):
        return None
    try:
        return shop.controller.run(_written(shop, answer.block, answer.x))
    except MotionError:
        return None


def _written(shop: Workshop, block: int, x: FloatArray) -> Program:
    return shop.blocks[block].variables.written(x, shop.task.rounding)


def _with_room(shop: Workshop, answer: Answer) -> FloatArray:
    """Values with zones small enough for their neighbours when all is rounded.

    Rounded points are a little nearer to each other or further apart than those searched for.
    """
    x, variables = answer.x, shop.blocks[answer.block].variables
    if shop.task.rounding.predefined:
        # The next smaller one would be far smaller; zones that are cut by a hair do no harm.
        return x
    for step in _STEPS:
        try:
            path = shop.controller.plan(_written(shop, answer.block, x))
        except MotionError:
            return answer.x
        tight = {room.corner for room in rooms_of(path) if room.left.value < -_TIGHT}
        if not tight:
            return x
        for corner in tight:
            x = variables.with_smaller_zone(x, path.route.zone_moves[corner], step)
    return x


def _more(known: PathPlaces | None, run: Run, certificate: Certificate) -> PathPlaces | None:
    """Places where a proof has failed, beside those known."""
    if certificate.sigma is None or certificate.configuration is None:
        return known
    q = np.array(certificate.configuration)
    found = crowd(run.path, 0.5 * sum(certificate.sigma), q, _FINE)
    return found if known is None else known.with_more(found)


def wider_margin(margin: float, clearance: float, certificate: Certificate) -> float:
    """The margin to aim at after a proof has failed.

    Where the path keeps the clearance and the proof fails all the same, for what smoothing in time
    and the model's residual may do, that takes more than the path had to spare there.
    """
    distance = certificate.clearance if certificate.distance is None else certificate.distance
    short = clearance - distance
    if certificate.verdict is Verdict.UNPROVEN:
        return max(_WIDER * margin, -_AMPLE * short)
    return max(_WIDER * margin, margin + _WIDER * short)
