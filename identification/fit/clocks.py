"""Which clocks and speed overrides of their own a fit gives to runs, before figures of the model.

A log that is some percent slower than its emulation, all over, may be explained by slower motions
too, with narrow intervals and wrong figures. So where a clock or an override explains most of the
times of logs (`time_scale`), or figures alone leave much unexplained, the runs are fitted with one
clock for all, with one override for all, with those of single runs, and with none; what needs less
is preferred.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from ...core.errors import InputError
from ..time_scale import LEAST, Cause, TimeScale, explained
from .emulation import Nuisance
from .minimum import Minimum, minimise
from .parameters import ParameterSet
from .problem import first_nuisances
from .run_pool import RunPool
from .runs import PreparedRun

LIKELIER = 2.0
"""How many times the loss must be without a clock or an override that does not explain logs alone;
likewise with one for all runs beside one for each."""
POOR = 0.1
"""Loss of a fit that leaves logs unexplained: whatever explains them is looked for."""
ALIKE = 0.01
"""By how much scales of runs may differ that are one."""
_ALL = "the logs"


def timed(
    parameters: ParameterSet, runs: Sequence[PreparedRun], plain: float, workers: int = 1
) -> list[PreparedRun] | None:
    """The runs, those with a clock or an override of their own that ask for one; None if none does.

    Args:
        parameters: that are to be fitted.
        runs: of one robot.
        plain: loss of the fit in which clocks are right and overrides 100 %.
        workers: processes.

    Raises:
        InputError: a program cannot be driven.
    """
    free = [run for run in runs if run.clock is None and not run.by_place]
    hints = [run.scale for run in free if run.scale is not None]
    alone = any(one.alone for one in hints)
    if not free or (not alone and plain < POOR):
        return None
    best, made = np.inf, None
    for worth, other in _candidates(runs, hints):
        try:
            end = _minimum(parameters, other, workers)
        except InputError:
            continue
        if end.last * worth < best and _differs(end):
            best, made = end.last * worth, other
    wanted = plain * LIKELIER if alone else plain / LIKELIER
    return made if best <= wanted else None


def _minimum(parameters: ParameterSet, runs: Sequence[PreparedRun], workers: int) -> Minimum:
    with RunPool(runs, workers) as pool:
        return minimise(pool, parameters, first_nuisances(runs))


def _candidates(
    runs: Sequence[PreparedRun], hints: Sequence[TimeScale]
) -> list[tuple[float, list[PreparedRun]]]:
    """Runs with clocks and overrides that may be, and how many times better each is to be."""
    shown = Counter(one.cause for one in hints)
    # Beside accelerations that are fitted too, an override is as good as a clock.
    worth = {
        cause: 1.0 if shown[cause] == max(shown.values(), default=0) else LIKELIER
        for cause in Cause
    }
    found = [(worth[cause], [_with(run, cause, _ALL) for run in runs]) for cause in Cause]
    values = [one.ratio for one in hints]
    own = [run.scale is not None and run.scale.alone for run in runs]
    if any(own) and (not all(own) or np.ptp(values) > ALIKE * np.median(values)):
        each = [
            _with(run, run.scale.cause, run.name)
            if run.scale is not None and run.scale.alone
            else run
            for run in runs
        ]
        found.append((LIKELIER, each))
    return found


def _with(run: PreparedRun, cause: Cause, name: str) -> PreparedRun:
    """A run with a clock or an override that has a name, if its own is not known otherwise."""
    if run.clock is not None or run.by_place:
        return run
    if cause is Cause.CLOCK:
        return replace(run, own_clock=name)
    return replace(run, override=name)


def _differs(end: Minimum) -> bool:
    """Whether a clock or an override is another than what programs and stamps say."""
    return any(
        (run.own_clock is not None and abs(own.clock - 1.0) >= LEAST)
        or (run.override is not None and abs(own.override - 1.0) >= LEAST)
        for run, own in zip(end.variables.runs, end.nuisances, strict=True)
    )


def told(runs: Sequence[PreparedRun], nuisances: Sequence[Nuisance]) -> list[tuple[str, str]]:
    """Names of runs that were fitted with a clock or an override of their own, and what it is."""
    found: dict[str, list[int]] = {}
    for k, run in enumerate(runs):
        name = run.own_clock or run.override
        if name is not None:
            found.setdefault(name, []).append(k)
    said = []
    for members in found.values():
        run, own = runs[members[0]], nuisances[members[0]]
        cause = Cause.CLOCK if run.own_clock is not None else Cause.OVERRIDE
        value = 1.0 / own.clock if cause is Cause.CLOCK else own.override
        alone = any((one := runs[k].scale) is not None and one.alone for k in members)
        what = "this log" if len(members) == 1 else "these logs"
        names = ", ".join(runs[k].name for k in members)
        said.append((names, explained(cause, value, what, alone)))
    return said
