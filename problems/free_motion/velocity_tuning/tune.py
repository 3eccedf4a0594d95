"""How fast a fixed path is best passed.

- Where time alone counts and limits are on x and u (joints, TCP, constant torques): two sweeps.
- Where energy counts, or a duration is bounded: one second-order cone program.
- Where jerk, viscous friction or falling torque curves make that one non-convex: a sequence of
  them, each inside the true limits, from a slowed-down motion on. Every motion of the sequence is
  admissible and none is worse than the one before.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import numpy as np

from ....core.arrays import FloatArray
from ....core.errors import InputError
from ....core.motion.timing.stamping import stamp
from ...checks import of_kind
from .cones import ConeProgram, CostShares, TuningError
from .result import Tuned, Way
from .rows import FLOOR
from .task import FASTEST, TuningTask
from .usage import excess

_ROUNDS = 40
_TOLERANCE = 1e-5
"""Share of the objective by which a round must better it for another to follow."""
_WITHIN = 1e-6
"""Excess over a limit that counts as rounding."""
_HALVINGS = 12
_SLOWER, _SLOWEST = 0.7, 1e-12
"""Factor on x while a first motion is sought, and where that is given up."""

Report = Callable[[Tuned], object]
"""Called with every motion of a sequence; a true answer ends it with the best so far."""


def tune(task: TuningTask, report: Report | None = None) -> Tuned:
    """The best motion along a fixed path, by the simplest way that finds it.

    Args:
        task: the path, the limits and the objective.
        report: of a sequence's motions.

    Raises:
        InputError: torques are wanted and not known.
        StandingStillError: a torque limit forbids standing still; raised by `TuningTask` already.
        StampingError: the path cannot be passed within its limits.
        TuningError: no motion is short enough, or the solver failed.
    """
    of_kind("task", task, TuningTask)
    if not task.convex:
        return tune_in_sequence(task, report)
    return tune_by_sweeps(task) if _timely(task) else tune_by_cones(task)


def tune_by_sweeps(task: TuningTask) -> Tuned:
    """The fastest motion, by two sweeps.

    Raises:
        InputError: something but time counts, or a limit is not on x and u alone.
    """
    if not task.convex or task.objective.time_weight < 1.0:
        raise InputError("the sweeps know neither energy, jerk, viscous friction nor torque curves")
    found = Tuned(task, stamp(task.rows()).x, Way.SWEEPS)
    _check_duration(task, found.duration)
    return found


def tune_by_cones(task: TuningTask) -> Tuned:
    """The best motion, by one cone program (two where both time and energy count).

    Raises:
        InputError: the task is not convex.
        TuningError: no motion is short enough, or the solver failed.
    """
    if not task.convex:
        raise InputError("jerk, viscous friction and torque curves need a sequence of programs")
    unit = _unit(task)
    fastest = tune_by_sweeps(_hurried(task))
    _check_duration(task, fastest.duration)
    if _is_tight(task, fastest.duration):
        return Tuned(task, fastest.x, Way.SWEEPS)
    shares = CostShares(1.0) if _timely(task) else _shares(task, fastest)
    return Tuned(task, ConeProgram(task, unit).solve(shares, unit), Way.CONVEX, 1)


def tune_in_sequence(task: TuningTask, report: Report | None = None) -> Tuned:
    """The best motion found by a sequence of cone programs.

    Raises:
        TuningError: no motion is short enough, or the solver failed.
    """
    unit = _unit(task)
    if _timely(task) and task.objective.duration is None:
        shares = CostShares(1.0)
        best = Tuned(task, _start(task, unit), Way.SEQUENTIAL)
    else:
        fastest = tune(_hurried(task), report)
        best = Tuned(task, fastest.x, Way.SEQUENTIAL, fastest.iterations)
        _check_duration(task, fastest.duration)
        if _is_tight(task, fastest.duration):
            return best
        shares = CostShares(1.0) if _timely(task) else _shares(task, fastest)
    program = ConeProgram(task, unit)
    for round_ in range(1, _ROUNDS + 1):
        try:
            x = program.solve(shares, np.maximum(best.x, FLOOR * unit))
        except TuningError:
            if round_ == 1:
                raise
            return best
        better = _between(task, shares, best, x, round_)
        if better is None:
            return replace(best, iterations=round_)
        gain = _cost(shares, best) - _cost(shares, better)
        settled = gain < _TOLERANCE * abs(_cost(shares, better))
        best = better
        if settled or (report is not None and report(best)):
            break
    return best


def _between(
    task: TuningTask, shares: CostShares, best: Tuned, x: FloatArray, round_: int
) -> Tuned | None:
    """The best of motions on the way to one from a solver; None where none is better.

    The rows that both keep are convex, so that all between them keep them too.
    """
    duration = task.objective.duration
    latest = np.inf if duration is None else max(duration, best.duration) * (1.0 + _WITHIN)
    share = 1.0
    for _ in range(_HALVINGS):
        trial = replace(best, x=best.x + share * (x - best.x), iterations=round_)
        if _cost(shares, trial) < _cost(shares, best) and trial.duration <= latest:
            return trial
        share *= 0.5
    return None


def _cost(shares: CostShares, motion: Tuned) -> float:
    cost = shares.time * motion.duration
    return cost + shares.energy * motion.energy if shares.energy > 0.0 else cost


def _timely(task: TuningTask) -> bool:
    return task.objective.time_weight == 1.0


def _hurried(task: TuningTask) -> TuningTask:
    """The same with time alone as its objective."""
    consumption = task.objective.consumption
    return replace(task, objective=replace(FASTEST, consumption=consumption))


def _shares(task: TuningTask, fastest: Tuned) -> CostShares:
    """Time and energy in shares of those of the fastest motion."""
    most = fastest.flow
    if most == 0.0:
        raise InputError("the fastest motion takes no energy: there is nothing to compare with")
    weight = task.objective.time_weight
    return CostShares(weight / fastest.duration, (1.0 - weight) / most)


def _unit(task: TuningTask) -> FloatArray:
    """(K + 1,), x of the fastest motion within what the sweeps know; above zero off stops."""
    x = stamp(task.rows()).x.copy()
    moving = ~task.path.stops
    x[moving] = np.maximum(x[moving], 1e-12 * x.max())
    return x


def _start(task: TuningTask, unit: FloatArray) -> FloatArray:
    """A motion within all limits, by slowing the fastest one down throughout."""
    factor = 1.0
    while excess(task, factor * unit) > 0.0:
        factor *= _SLOWER
        if factor < _SLOWEST:
            raise TuningError(
                "no motion along this path is within all limits, however slow: friction may use up "
                "what a drive has"
            )
    return np.asarray(factor * unit)


def _is_tight(task: TuningTask, least: float) -> bool:
    """Whether no motion but the fastest is short enough, by what a solver can tell apart."""
    duration = task.objective.duration
    return duration is not None and least > duration * (1.0 - _WITHIN)


def _check_duration(task: TuningTask, least: float) -> None:
    """Refuse a bound on the duration that the fastest motion exceeds."""
    duration = task.objective.duration
    if duration is not None and least > duration * (1.0 + _WITHIN):
        raise TuningError(
            f"the path takes {least:.4g} s at least; the {duration:.4g} s that it may take are less"
        )
