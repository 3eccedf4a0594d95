"""Which parts of a motion model earn their parameters: cross-validation over groups of runs.

Runs are left out in groups that share a condition (a zone, a speed, kinds of moves, a posture);
each candidate model is fitted to the rest and judged by the robust loss of the runs left out, whose
offsets in time alone are fitted to them. A part earns its parameters if runs that had no say in
them are predicted better with it.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace

import numpy as np

from ...core.arrays import FloatArray
from ...core.errors import FlybyError, InputError
from ...core.motion.model.motion_model import MotionModel
from ...core.program.zone import Radius
from .emulation import Nuisance, Rows
from .keys import figure_of
from .loss import loss
from .minimum import Minimum, minimise
from .parameters import ParameterSet
from .run_pool import RunPool
from .runs import PreparedRun

POSTURE = 0.5
"""rad within which starts count as one posture."""


@dataclass(frozen=True)
class CandidateModel:
    """A model to be compared.

    Args:
        name: for the table.
        parameters: that it fits.
    """

    name: str
    parameters: ParameterSet


def candidates(parameters: ParameterSet) -> list[CandidateModel]:
    """All parameters, and all but those of one figure of the motion file, for each figure; a
    figure that is not fitted stays where the base of the parameters has it."""
    figures: dict[str, list[str]] = {}
    for one in parameters.parameters:
        figure = figure_of(one.keys[0]).key
        figures.setdefault(figure, []).append(one.name)
    found = [CandidateModel("all", parameters)]
    if len(figures) > 1:
        found += [CandidateModel(f"all but {k}", parameters.without(v)) for k, v in figures.items()]
    return found


@dataclass(frozen=True)
class Score:
    """How a candidate predicts runs that it was not fitted to.

    Args:
        name: of the candidate.
        count: of its parameters.
        loss: mean robust loss per residual of each run, left out.
        fitted: the same of the runs when they take part, as the mean over the folds.
        gain: by how much its loss is below the first candidate's: mean over the runs.
        error: standard error of the gain.
    """

    name: str
    count: int
    loss: tuple[float, ...]
    fitted: float
    gain: float
    error: float

    @property
    def mean(self) -> float:
        """Of the runs left out."""
        return float(np.mean(self.loss))


def grouped(runs: Sequence[PreparedRun], trait: str) -> list[tuple[int, ...]]:
    """Indices of runs that share a trait: ``zone``, ``speed``, ``moves``, ``posture`` or ``run``.

    Raises:
        InputError: there is no such trait, or all runs share it.
    """
    if trait not in TRAITS:
        raise InputError(f"runs are grouped by {', '.join(TRAITS)}, not by {trait!r}")
    found: dict[object, list[int]] = {}
    for k, run in enumerate(runs):
        found.setdefault(TRAITS[trait](run), []).append(k)
    if len(found) < 2:
        raise InputError(f"all runs have the same {trait}: none can be left out")
    return [tuple(group) for group in found.values()]


@dataclass(frozen=True, eq=False)
class LeftOut:
    """Runs predicted by a fit in which they had no part.

    Args:
        indices: of the runs.
        nuisances: of them; offsets are fitted to them, clocks are those of the fit.
        model: that was fitted to the others.
        loss: mean robust loss per residual of each.
        path: the same over what shows the TCP's path.
        fitted: the same over the others.
    """

    indices: tuple[int, ...]
    nuisances: tuple[Nuisance, ...]
    model: MotionModel
    loss: tuple[float, ...]
    path: tuple[float, ...]
    fitted: float

    @classmethod
    def of(
        cls,
        runs: Sequence[PreparedRun],
        indices: tuple[int, ...],
        nuisances: Sequence[Nuisance],
        parameters: ParameterSet,
        end: Minimum,
    ) -> LeftOut:
        """What a fit to others makes of runs.

        Args:
            runs: that had no part in the fit.
            indices: of them.
            nuisances: of them, where the search for their own begins.
            parameters: that were fitted.
            end: of the fit.

        Raises:
            InputError: a program cannot be driven by the fitted model.
        """
        model = parameters.model(end.values)
        fitted = list(zip(end.variables.runs, end.nuisances, strict=True))
        clocks = {run.clock: own.clock for run, own in fitted if run.clock is not None}
        overrides = {run.override: own.override for run, own in fitted if run.override is not None}
        start = [
            replace(
                one,
                clock=clocks.get(run.clock or "", one.clock),
                override=overrides.get(run.override or "", one.override),
            )
            for run, one in zip(runs, nuisances, strict=True)
        ]
        # Clock and override are known, unless they are its own alone: the run may shift its offset,
        # and the sizes of zones nobody recorded.
        still = [
            replace(
                run,
                run=replace(run.run, real=None),
                own_clock=None if run.own_clock in clocks else run.own_clock,
                override=None if run.override in overrides else run.override,
            )
            for run in runs
        ]
        with RunPool(still, 1) as pool:
            alone = minimise(pool, ParameterSet(model, ()), start)
            found = pool.residuals(model, alone.nuisances)
        return cls(indices, alone.nuisances, model, *losses_of(runs, found), end.rest)


def losses_of(
    runs: Sequence[PreparedRun], found: Sequence[FloatArray | FlybyError]
) -> tuple[tuple[float, ...], tuple[float, ...]]:
    """Mean robust losses of runs from their weighted residuals, and of the TCP's path alone.

    Raises:
        InputError: a program cannot be driven.
    """
    whole, path = [], []
    for run, one in zip(runs, found, strict=True):
        if isinstance(one, FlybyError):
            raise InputError(f"{run.name}: {one}") from one
        each = loss(one)
        whole.append(float(each.mean()))
        path.append(float(each[:, run.q.shape[1] :].mean()))
    return tuple(whole), tuple(path)


def leave_out(
    runs: Sequence[PreparedRun],
    nuisances: Sequence[Nuisance],
    parameters: ParameterSet,
    groups: Sequence[tuple[int, ...]],
    workers: int = 1,
    tell: Callable[[str], None] | None = None,
    known: Sequence[Rows] = (),
) -> list[LeftOut]:
    """Fit to all runs but a group, and predict the group; each group in its turn.

    A fit that went as far as it could does not tell where it began: begin near, to save time.

    Args:
        runs: all of one robot.
        nuisances: of each run, where fits begin: those of a fit to all, or `first_nuisances`.
        parameters: to be fitted, likewise.
        groups: indices of runs to leave out together.
        workers: processes.
        tell: called with how far the work is.
        known: residuals and derivatives of each run where fits begin, if they are known.

    Raises:
        InputError: a group holds all runs, or a program cannot be driven.
    """
    found = []
    for number, group in enumerate(groups):
        if tell is not None:
            tell(f"leaving out group {number + 1} of {len(groups)}")
        rest = [k for k in range(len(runs)) if k not in group]
        if not rest:
            raise InputError("no run would be left to fit to")
        with RunPool([runs[k] for k in rest], workers) as pool:
            rows = [known[k] for k in rest] if known else None
            end = minimise(pool, parameters, [nuisances[k] for k in rest], known=rows)
        begin = [nuisances[k] for k in group]
        found.append(LeftOut.of([runs[k] for k in group], group, begin, parameters, end))
    return found


def compare_models(
    runs: Sequence[PreparedRun],
    nuisances: Sequence[Nuisance],
    candidates: Sequence[CandidateModel],
    groups: Sequence[tuple[int, ...]],
    workers: int = 1,
    tell: Callable[[str], None] | None = None,
) -> list[Score]:
    """Score candidates by the runs that they were not fitted to; see `leave_out`.

    Raises:
        InputError: as `leave_out` does.
    """
    scores: list[Score] = []
    for candidate in candidates:
        say = _named(tell, candidate.name)
        made = leave_out(runs, nuisances, candidate.parameters, groups, workers, say)
        each = np.empty(len(runs))
        for left in made:
            each[list(left.indices)] = left.loss
        against = np.array(scores[0].loss) if scores else each
        gain = against - each
        scores.append(
            Score(
                candidate.name,
                candidate.parameters.size,
                tuple(map(float, each)),
                float(np.mean([left.fitted for left in made])),
                float(gain.mean()),
                float(gain.std(ddof=1) / np.sqrt(len(gain))) if len(gain) > 1 else 0.0,
            )
        )
    return scores


def _named(tell: Callable[[str], None] | None, name: str) -> Callable[[str], None] | None:
    return None if tell is None else lambda text: tell(f"{name}: {text}")


def _zone(run: PreparedRun) -> float:
    zones = [m.zone.tcp for m in run.run.program.moves if isinstance(m.zone, Radius)]
    return round(max(zones, default=0.0), 4)


def _speed(run: PreparedRun) -> float:
    return max((m.speed.tcp or 0.0 for m in run.run.program.moves), default=0.0)


def _moves(run: PreparedRun) -> tuple[str, ...]:
    return tuple(sorted({type(move).__name__ for move in run.run.program.moves}))


def _posture(run: PreparedRun) -> tuple[int, ...]:
    return tuple(int(v) for v in np.round(np.median(run.q, axis=0) / POSTURE))


TRAITS: dict[str, Callable[[PreparedRun], object]] = {
    "zone": _zone,
    "speed": _speed,
    "moves": _moves,
    "posture": _posture,
    "run": lambda run: run.name,
}
"""By which runs are left out together."""
