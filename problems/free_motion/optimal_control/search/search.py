"""The outer iteration: linearise, solve, prove, accept; then limits between nodes.

Distances to the surroundings are linearised about a motion that is proven free, the nonlinear
program is solved within a box about it, and what comes of it is taken only if it is proven free
itself, between its nodes too. Where it is not, the pair is looked at there as well and has to keep
more; if that does not help, the box shrinks. So every motion that is kept is free if the first one
is, and no node can jump to the other side of a wall.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import numpy as np

from .....core.arrays import FloatArray
from .....core.sqp import BackendKind, Result, SolverMethod, Status, solve
from ..motion.audit import Audit, audit
from ..motion.first_guess import Guess
from ..motion.layout import VariableLayout
from ..motion.motion import Motion
from ..motion.proof import Proof, prove
from ..motion.result import SearchStep
from ..task.limits import MotionLimits
from ..task.sampled import Plant, TorqueField
from ..task.task import MotionTask
from ..transcription.rows import MotionRows
from ..transcription.sample_rows import EnergyTerm
from ..transcription.transcription import Bounds, Transcription
from .aiming import TangentChoice
from .effort import MotionEffort
from .patience import Patience
from .refinement import PieceMargins, refined, too_coarse
from .surroundings import Breach, Instants, Linearised, Surroundings, breaches, linearised, sags

Report = Callable[[SearchStep], bool | None]

_CORRECTIONS = 4
_GROW, _SHRINK = 2.0, 4.0
_SMALLEST, _LARGEST = 1e-3, 1.0
"""rad or m, of the box."""
_PLACES, _SLOTS = 2, 3
"""Places on each interval at which distances are linearised, and pairs of bodies at each, at
most."""
_LOOKED = 8
"""Places on each interval where a motion is looked at before it is proven."""
_SOLVER_TOLERANCE = 1e-5
"""Of the KKT conditions and of constraints."""
_INFEASIBLE = 1e-4
_IDLE = 1e-7
_SOLVER_ITERATIONS, _OUTER_ITERATIONS = 60, 12
"""At most; the second where there is a motion already that is to be made better."""
_INTERIOR_ITERATIONS = 300
_ROUNDS = 8


class Interrupted(Exception):
    """The user has had enough."""


class MotionSearch:
    """One search; it changes as it goes.

    Args:
        task, limits, plant, around, effort: what is asked.
        guess: a motion whose time and energy are the units of the objective.
        report: called after every outer iteration; True ends the search.
        begin: a free motion to begin with; None for the guess.

    Attributes:
        base: the motion so far.
        best: the best motion so far that keeps all limits and is proven, with its audit and
            proof; None if there was none yet.
        steps: of the search.
        converged, interrupted: whether it has ended by itself, or by the user.
    """

    def __init__(
        self,
        task: MotionTask,
        limits: MotionLimits,
        plant: Plant | None,
        around: Surroundings | None,
        effort: MotionEffort,
        guess: Guess,
        report: Report | None = None,
        begin: Guess | None = None,
    ) -> None:
        self.task, self.limits, self.plant = task, limits, plant
        self.around, self.effort, self.report = around, effort, report
        self.base = begin or guess
        self.steps: list[SearchStep] = []
        self.converged, self.interrupted = False, False
        self.best: tuple[float, Motion, Audit, Proof | None] | None = None
        longest = task.objective.longest
        self._longest = np.inf if longest is None else longest * (1.0 + effort.tolerance)
        self._box = effort.box
        self._clean = False
        self._energy_unit = self._first_energy(guess)
        self._margins = PieceMargins.none(self._audited(self.base.motion))
        self._rounds = 0
        self._most_intervals = 4 * len(guess.layout.grid)
        self._warm: Result | None = None
        self.aim = TangentChoice(effort.trials)

    def _first_energy(self, guess: Guess) -> float | None:
        if self.task.objective.time_weight == 1.0:
            return None
        assert self.plant is not None
        field = TorqueField(self.plant, guess.scale)
        consumption = self.task.objective.consumption
        return EnergyTerm(guess.layout, field, consumption, guess.scale, 0.0).size(guess.x)

    # The outer iteration

    def run(self) -> None:
        """MotionSearch."""
        given = (self.task.start_velocity, self.task.end_velocity)
        if not any(np.asarray(velocity, dtype=float).any() for velocity in given):
            # The first guess is at rest at both ends.
            first = self._transcription(self.base.layout).objective(self.base.x)
            self._note_best(self.base.motion, None, first)
        try:
            for _ in range(self.effort.outer):
                if self._iterate():
                    self.converged = True
                    return
        except (Interrupted, KeyboardInterrupt):
            self.interrupted = True

    def _iterate(self) -> bool:
        """One outer iteration; whether nothing is left to do."""
        transcription = self._transcription(self.base.layout)
        before = transcription.objective(self.base.x)
        found, step = self._candidate(transcription, before)
        if found is None:
            self._tell(step)
            return self._failed(step) and self._settled()
        guess, proof = found
        after = transcription.objective(guess.x)
        gain = (before - after) / abs(before)
        previous, was_clean = self.base, self._clean
        self.base, self._clean = guess, True
        self._note_best(guess.motion, proof, after)
        self._tell(
            replace(
                step,
                time=guess.motion.duration,
                objective=after,
                accepted=True,
                what="a better motion",
            )
        )
        if self.around is None:
            return was_clean and gain < self.effort.gain and self._settled()
        self._box = min(_GROW * self._box, _LARGEST)
        little = was_clean and gain < self.effort.gain
        return self.aim.gained(previous.x, little) and self._settled()

    def _failed(self, step: SearchStep) -> bool:
        """Try something else; whether nothing is left to try."""
        if self.around is None:
            return True
        if not self.aim.at_base or self.aim.exhausted:
            return self.aim.missed()
        self._box /= _SHRINK
        return self._box < _SMALLEST

    def _settled(self) -> bool:
        """Whether limits hold between nodes too; else margins are raised or the grid refined."""
        seen = self._audited(self.base.motion)
        if seen.holds(self.effort.tolerance) or self._rounds >= _ROUNDS:
            return True
        self._rounds += 1
        self._margins = self._margins.raised(seen, self.effort.tolerance)
        cut = too_coarse(seen)
        if cut.any() and len(cut) + cut.sum() <= self._most_intervals:
            parts = np.where(cut, 2, 1)
            self.base = refined(self.task, self.base, parts)
            self._warm = None
            self._margins = self._margins.split(parts)
        self._clean = False
        self.aim.settle()
        self._box = max(self._box, 0.1 * self.effort.box)
        return False

    def _candidate(
        self, transcription: Transcription, before: float
    ) -> tuple[tuple[Guess, Proof | None] | None, SearchStep]:
        """A better motion that is proven free, or None."""
        cuts, bounds = self._surroundings_of(transcription.layout)
        keep, sag = self._kept(cuts)
        extra = np.zeros(keep.shape)
        x, iterations = self.base.x, 0
        count = 0 if cuts is None else cuts.count
        step = SearchStep(self.base.motion.duration, before, np.nan, False, 0, count, self._box, "")
        for attempt in range(1 if cuts is None else _CORRECTIONS):
            rows = None
            if cuts is not None and self.around is not None:
                rows = cuts.rows(transcription.layout, self.around.wanted, keep, sag, extra)
            result = self._solved(transcription, bounds, rows, x)
            iterations += result.iterations
            guess = Guess(transcription.layout, self.base.scale, result.x)
            step = replace(step, candidate=guess.motion.duration, iterations=iterations)
            if result.constraint_violation > _INFEASIBLE:
                return None, replace(step, what="this attempt broke off before all limits held")
            if self._clean and result.objective >= before - 1e-9 * abs(before):
                if attempt == 0 and self.aim.at_base:
                    self.aim.exhaust(_touching(result, rows))
                return None, replace(step, what="nothing better that keeps clear")
            if self.around is None or cuts is None:
                return (guess, None), step
            proof = self._proof(guess.motion)
            if isinstance(proof, Proof):
                if proof.certificate.proven:
                    return (guess, proof), step
                return None, replace(step, what=str(proof.certificate))
            (cuts, extra), x = proof.blamed(cuts, extra, self.around.wanted), result.x
            keep, sag = self._kept(cuts)
        return None, replace(step, what="too near to something on the way")

    def _kept(self, cuts: Linearised | None) -> tuple[FloatArray, FloatArray]:
        """Linear distances of the base at the places of cuts, and how much nearer it comes between
        them."""
        if cuts is None or self.around is None:
            return np.zeros(0), np.zeros(0)
        motion = self.base.motion
        q = cuts.places.of(self.task, motion)[:, self.task.moving]
        return cuts.at(q), sags(self.task, self.around, motion, cuts, _LOOKED)

    def _solved(
        self,
        transcription: Transcription,
        bounds: Bounds,
        rows: MotionRows | None,
        x: FloatArray,
    ) -> Result:
        patience = None
        if not self._smooth and (rows is not None or transcription.layout.stretches):
            beat = transcription.objective(self.base.x) if self._clean else None
            most = _SOLVER_ITERATIONS if beat is None else _OUTER_ITERATIONS
            patience = Patience(_SOLVER_TOLERANCE, most, self.effort.gain, beat)
        result = solve(
            transcription.nlp(bounds, rows),
            x,
            method=SolverMethod.INTERIOR_POINT if self._smooth else SolverMethod.SQP,
            tolerance=_SOLVER_TOLERANCE,
            max_iterations=_INTERIOR_ITERATIONS if self._smooth else _SOLVER_ITERATIONS,
            callback=patience,
            qp=BackendKind.INTERIOR_POINT,
            warm_start=None if self._smooth else self._warm,
            structure_of=self._warm,
        )
        ended = patience is not None and patience.ended
        if result.status is Status.INTERRUPTED and not ended:
            raise Interrupted
        self._warm = result
        return result if patience is None else patience.outcome(result)

    @property
    def _smooth(self) -> bool:
        """Whether the interior point is used, with an exact Hessian.

        Energy leaves many variables free of limits: what a convex Hessian leaves out costs SQP
        hundreds of iterations there. Where time alone counts, nearly as many limits are active as
        there are variables, and SQP takes a tenth of the interior point's iterations; among
        obstacles programs follow each other, each to be solved from the one before. A grid that
        stretches takes hundreds of iterations of either, and patience.
        """
        fixed = not self.base.layout.stretches
        return fixed and self.around is None and self._energy_unit is not None

    def _transcription(self, layout: VariableLayout) -> Transcription:
        return Transcription(
            self.task,
            self.limits,
            layout,
            self.base.scale,
            self._energy_unit,
            self.plant,
            self._margins.at_samples(layout),
            indefinite=self._smooth,
        )

    # Surroundings

    def _surroundings_of(self, layout: VariableLayout) -> tuple[Linearised | None, Bounds]:
        """Linearised distances about the base, and how far each node may move."""
        position = self._margins.at_samples(layout).position
        lower, upper = self.limits.lower + position, self.limits.upper - position
        if self.around is None:
            return None, Bounds(lower, upper)
        places = Instants.even(len(layout.grid), _PLACES)
        q = self.aim.configurations(self.task, self.base, places)
        cuts = linearised(self.task, self.around, q, places, self._box, _SLOTS)
        q = self.base.x[layout.q]
        return cuts, Bounds(np.maximum(lower, q - self._box), np.minimum(upper, q + self._box))

    def _proof(self, motion: Motion) -> Proof | Breach:
        """A proof that a motion is free; else where it is not."""
        assert self.around is not None
        clearance = self.around.clearance
        places = Instants.even(len(motion), _LOOKED)
        near = breaches(self.task, self.around, motion, places, clearance)
        if near is not None:
            return near
        proof = prove(self.task, motion, self.around.scene, clearance)
        time = proof.certificate.time
        if proof.certificate.proven or proof.pair is None or time is None:
            return proof
        piece = motion.pieces(np.array([time]))
        share = (time - motion.knots[piece]) / motion.durations[piece]
        within = max(self.around.wanted, (proof.certificate.distance or 0.0) + 1e-5)
        near = breaches(self.task, self.around, motion, Instants(piece, share), within)
        return proof if near is None else near

    # What is kept

    def _audited(self, motion: Motion) -> Audit:
        return audit(self.task, self.limits, self.plant, motion, self.effort.tolerance)

    def _note_best(self, motion: Motion, proof: Proof | None, objective: float) -> None:
        """Keep a motion that holds all limits, is proven where it has to be, and is better."""
        if self.best is not None and objective >= self.best[0]:
            return
        seen = self._audited(motion)
        if not seen.holds(self.effort.tolerance) or motion.duration > self._longest:
            return
        if self.around is not None and proof is None:
            proof = prove(self.task, motion, self.around.scene, self.around.clearance)
        if proof is None or proof.certificate.proven:
            self.best = (objective, motion, seen, proof)

    def _tell(self, step: SearchStep) -> None:
        self.steps.append(step)
        if self.report is not None and self.report(step):
            raise Interrupted


def _touching(result: Result, rows: MotionRows | None) -> bool:
    """Whether any linearised distance holds a motion back."""
    if rows is None:
        return False
    return bool(np.abs(result.multipliers[-len(rows.lower) :]).max(initial=0.0) > _IDLE)
