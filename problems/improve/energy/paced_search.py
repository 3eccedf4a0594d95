"""Where a program's numbers are sought for one goal, written, read back and proven."""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from ....core.arrays import FloatArray
from ....core.collision.proof.certificate import SceneOf
from ....core.collision.proof.verdict import Certificate
from ....core.errors import MotionError
from ....core.motion.emulator.controller import Controller
from ....core.motion.emulator.run import Run
from ....core.program.program import Program
from ...reading_back import ReadBack
from ..nonsmooth_sqp import Memory, SearchEffort, search
from ..solve_round_verify import ProgramFeasibility, solve_round_verify
from ..waypoints import Effort
from ..waypoints.aim import FINE, Aim, driven_moves, with_room
from ..waypoints.block_problem import BlockProblem
from ..waypoints.blocks import MoveBlock
from ..waypoints.variables import ProgramVariables
from .front import FrontPoint
from .options import EnergyTask, Goal
from .paced_problem import EvaluatedProgram, FixedShape, PacedProblem, Watch
from .pacing import Pacing

_NEAR, _NEAR_BOX = 45, 0.3
"""Iterations at most and first trust box of a search that begins at a neighbour's values."""
_REFINING, _SETTLING = SearchEffort(20, 0.2), SearchEffort(10, 0.1)
"""Of a refinement, and of one with accelerations rounded."""
_EARLY = 2e-5
"""Share of the latest end by which a search aims to be earlier, so that rounding leaves room."""
LATE = 1e-4
"""Share by which a program may end later than asked for."""
_APART = 1e-7
_HOPELESS = 0.02
"""Share by which a program ends too late where aiming earlier is no use."""


@dataclass(frozen=True)
class PacedSearch:
    """What all searches of a program share.

    Args:
        controller: that drives it.
        program: from its start, freed stops passed.
        pacing: its speeds.
        variables: its points and zones; None where they stay.
        scenes: the cell with each tool; None without a cell.
        clearance: m to keep.
        task, effort: see `pareto`.
        read_back: see `pareto`.
        watch: called with every point that can be driven.
    """

    controller: Controller
    program: Program
    pacing: Pacing
    variables: ProgramVariables | None
    scenes: SceneOf | None
    clearance: float
    task: EnergyTask
    effort: Effort
    read_back: ReadBack
    watch: Watch | None = None

    @property
    def start(self) -> FloatArray:
        """(n,), the program as it is."""
        own = np.zeros(0) if self.variables is None else self.variables.start
        return np.concatenate([own, self.pacing.start])

    # -------------------------------------------------------------------------- searching

    def measured(self, goal: Goal, x: FloatArray) -> EvaluatedProgram:
        """Values judged by a goal.

        Raises:
            MotionError: they cannot be driven.
        """
        point = self._problem(goal, self.pacing).point(x)
        if point is None:
            raise MotionError("the program cannot be driven as it is", 0)
        return point

    def search(self, goal: Goal, x: FloatArray) -> EvaluatedProgram:
        """The best values found from a start.

        Raises:
            MotionError: it cannot be driven.
        """
        return self._found(goal, x, SearchEffort(self.effort.iterations))

    def search_near(self, goal: Goal, x: FloatArray) -> EvaluatedProgram:
        """The same from values that serve a goal much like this one."""
        return self._found(goal, x, SearchEffort(min(_NEAR, self.effort.iterations), _NEAR_BOX))

    def _found(self, goal: Goal, x: FloatArray, settings: SearchEffort) -> EvaluatedProgram:
        found = self._searched(goal, self.pacing, x, settings)
        if found is None:
            raise MotionError("the program cannot be driven as it is", 0)
        return found

    def _searched(
        self,
        goal: Goal,
        pacing: Pacing,
        x: FloatArray,
        settings: SearchEffort,
        aim: Aim | None = None,
    ) -> EvaluatedProgram | None:
        """From one start; None where it cannot be driven."""
        if goal.latest is not None:
            goal = replace(goal, latest=goal.latest * (1.0 - _EARLY))
        problem = self._problem(goal, pacing, aim)
        start = problem.point(x)
        if start is None:
            return None
        try:
            memory = Memory(start.x, settings.box)
            return search(problem, start, settings, memory).point
        except MotionError:
            # A pose target is singular where the search stands: no way on.
            return start

    def _problem(self, goal: Goal, pacing: Pacing, aim: Aim | None = None) -> PacedProblem:
        geometry = self._geometry(aim or Aim(self.effort.margin))
        consumption = self.task.consumption
        return PacedProblem(self.controller, geometry, pacing, goal, consumption, self.watch)

    def _geometry(self, aim: Aim) -> BlockProblem | FixedShape:
        if self.variables is None or self.scenes is None:
            return self._fixed
        apart = self._apart
        return BlockProblem(
            self.controller,
            MoveBlock(
                0, len(apart.moves) - 1, apart, ProgramVariables(apart, self.variables.parts)
            ),
            self.scenes,
            replace(self.task.wishes, time_weight=1.0),
            self.clearance + aim.margin,
            self.clearance,
            aim.density,
            aim.more,
        )

    @cached_property
    def _fixed(self) -> FixedShape:
        return FixedShape(self._apart, self.controller.plan(self._apart))

    @cached_property
    def _apart(self) -> Program:
        """The program with speeds that differ by next to nothing from move to move: its path is
        sampled as one on which they do."""
        return self.pacing.applied(
            self.program, self.pacing.start - _APART * np.arange(self.pacing.size)
        )

    # -------------------------------------------------------------------------- finishing

    def finish(self, goal: Goal, x: FloatArray) -> FrontPoint | None:
        """The program near x as its language says it; None where it cannot be proven.

        Where it ends too late, as rounded, an earlier end is aimed at; if that does not help, it
        is what it is.
        Accelerations are rounded first, as their steps are large, and all else is sought again.
        """
        aim = Aim(self.effort.margin, FINE)
        refined = _Refined(self, goal, x, aim, goal, self.effort.proofs + 1)
        solve_round_verify(self.feasibility, refined)
        return refined.best

    @property
    def feasibility(self) -> ProgramFeasibility:
        """What the program has to stand."""
        residual = self.task.wishes.residual
        return ProgramFeasibility(
            self.controller, self.scenes, self.clearance, residual, self.program.start, None
        )

    def rounded(self, goal: Goal, x: FloatArray, aim: Aim) -> tuple[FloatArray, Program | None]:
        """Values near x that can be written, and their program as it is read."""
        if self.variables is not None:
            found = self._searched(goal, self.pacing, x, _REFINING, aim)
            if found is None:
                return x, None
            x = found.x
        x = self._with_rounded_accelerations(x)
        found = self._searched(goal, self._paces_alone(x), x, _SETTLING, aim)
        if found is None:
            return x, None
        x = self._released(goal, self._with_room(found.x))
        return x, self.read_back(self._written(x))

    def _released(self, goal: Goal, x: FloatArray) -> FloatArray:
        """Values with the programmed speed wherever a lower one is not reached either."""
        point = self._problem(goal, self.pacing).point(x)
        if point is None:
            return x
        y = self.pacing.released(x[self._split :], point.timing, self.controller.robot)
        return np.concatenate([x[: self._split], y])

    @property
    def _split(self) -> int:
        return 0 if self.variables is None else self.variables.size

    def _with_rounded_accelerations(self, x: FloatArray) -> FloatArray:
        y = x[self._split :]
        rounded = np.where(self.pacing.coarse(), self.pacing.rounded(y), y)
        return np.concatenate([x[: self._split], rounded])

    def _paces_alone(self, x: FloatArray) -> Pacing:
        """The pacing with accelerations held at what they are."""
        held, y = self.pacing.coarse(), np.exp(x[self._split :])
        return Pacing(
            [
                replace(n, begin=v, least=v, most=v) if hold else n
                for n, v, hold in zip(self.pacing.numbers, y.tolist(), held, strict=True)
            ]
        )

    def _written(self, x: FloatArray) -> Program:
        program = self.program
        if self.variables is not None:
            program = self.variables.written(x[: self._split], self.task.wishes.rounding)
        return self.pacing.written(program, x[self._split :])

    def _with_room(self, x: FloatArray) -> FloatArray:
        """Values with zones small enough for their neighbours when all is rounded."""
        if self.variables is None:
            return x
        shape, y = x[: self._split], x[self._split :]
        room = with_room(
            shape,
            self.variables,
            lambda own: self.controller.plan(self._written(np.concatenate([own, y]))),
            driven_moves(self.controller.plan, self.variables, shape),
        )
        return np.concatenate([room, y])


@dataclass
class _Refined:
    """Values on their way to a program that is proven, and not late.

    Args:
        search: whose they are.
        goal: what is wanted.
        x: (n,), the values.
        aim: how closely to look at distances.
        nearer: what is aimed at: the goal, or an earlier end.
        left: attempts.
        best: the soonest one that is proven.
    """

    search: PacedSearch
    goal: Goal
    x: FloatArray
    aim: Aim
    nearer: Goal
    left: int
    best: FrontPoint | None = None

    def rounded(self) -> Program | None:
        """The program as it is read, with the values found next."""
        if not self.left:
            return None
        self.left -= 1
        self.x, program = self.search.rounded(self.nearer, self.x, self.aim)
        return program

    def undrivable(self, error: MotionError) -> None:
        """There is no other way to round it."""
        self.left = 0

    def accepted(self, run: Run, certificate: Certificate | None) -> bool:
        """Whether it is proven, and no earlier end is worth aiming at."""
        if certificate is not None and not certificate.proven:
            self.aim = self.aim.after(run, certificate, self.search.clearance)
            return self.search.variables is None
        if self.best is not None and run.timing.duration >= self.best.duration:
            return True
        search = self.search
        self.best = FrontPoint.of(search.controller, run, search.task.consumption, certificate)
        late = 0.0 if self.goal.latest is None else run.timing.duration / self.goal.latest - 1.0
        if self.nearer.latest is None or not LATE < late < _HOPELESS:
            return True
        self.nearer = replace(self.nearer, latest=self.nearer.latest * (1.0 - 1.5 * late))
        return False
