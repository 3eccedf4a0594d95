"""All runs of a robot as one robust least-squares problem."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from ...core.arrays import FloatArray, IntArray
from ...core.errors import FlybyError, InputError
from ...core.sqp import NLP
from .emulation import Nuisance, Rows
from .loss import square_root
from .parameters import ParameterSet
from .run_pool import RunPool
from .runs import PreparedRun
from .secants import RunDerivatives, carried

OFFSET_SCALE, CLOCK_SCALE, SIZE_SCALE, OVERRIDE_SCALE = 0.01, 0.01, 0.5, 0.01
"""s, 1, 1 and 1: the units of nuisances in the problem's variables."""
MOST_OFFSET, MOST_CLOCK = 0.5, 0.05
"""s and 1, by which they may leave their starts."""
SMALLEST, LARGEST = 0.02, 50.0
"""Factors on zones that were not recorded."""
SLOWEST = 0.02
"""Least speed override."""


@dataclass(frozen=True)
class Variables:
    """What the problem's variables stand for: parameters, then offsets, clocks, overrides, sizes.

    Args:
        parameters: of the motion model.
        runs: whose nuisances are variables.
        clocks, overrides: names of the clocks and overrides that runs share.
        start: nuisances of each run at the start.
    """

    parameters: ParameterSet
    runs: tuple[PreparedRun, ...]
    clocks: tuple[str, ...]
    overrides: tuple[str, ...]
    start: tuple[Nuisance, ...]

    @classmethod
    def of(
        cls,
        parameters: ParameterSet,
        runs: Sequence[PreparedRun],
        nuisances: Sequence[Nuisance] | None = None,
    ) -> Variables:
        """The variables for runs.

        Args:
            parameters: of the motion model.
            runs: all of one robot.
            nuisances: where the runs' own begin; None for what their alignment says.
        """
        clocks = tuple(sorted({run.clock for run in runs if run.clock is not None}))
        overrides = tuple(sorted({run.override for run in runs if run.override is not None}))
        start = first_nuisances(runs) if nuisances is None else tuple(nuisances)
        return cls(parameters, tuple(runs), clocks, overrides, start)

    @property
    def size(self) -> int:
        """How many variables there are."""
        shared = self.parameters.size + len(self.clocks) + len(self.overrides)
        return shared + len(self.timed) + len(self.sized)

    @property
    def timed(self) -> tuple[int, ...]:
        """Indices of the runs with an offset."""
        return tuple(k for k, run in enumerate(self.runs) if not run.by_place)

    @property
    def sized(self) -> tuple[int, ...]:
        """Indices of the runs whose zones are to be found."""
        return tuple(k for k, run in enumerate(self.runs) if not run.run.zones_known)

    def values(self, x: FloatArray) -> FloatArray:
        """(P,), the parameters at variables x."""
        p = self.parameters
        lower, upper = p.bounds
        return np.clip(p.start + p.scale * x[: p.size], lower, upper)

    def nuisances(self, x: FloatArray) -> tuple[Nuisance, ...]:
        """The runs' own at variables x."""
        offset = self.parameters.size + np.arange(len(self.timed))
        offsets = dict(zip(self.timed, OFFSET_SCALE * x[offset], strict=True))
        clocks = dict(zip(self.clocks, CLOCK_SCALE * x[self._clock()], strict=True))
        overrides = dict(zip(self.overrides, OVERRIDE_SCALE * x[self._override()], strict=True))
        sizes = dict(zip(self.sized, SIZE_SCALE * x[self._size()], strict=True))
        made = []
        for k, (run, start) in enumerate(zip(self.runs, self.start, strict=True)):
            made.append(
                Nuisance(
                    start.offset + offsets.get(k, 0.0),
                    start.clock + (0.0 if run.clock is None else clocks[run.clock]),
                    start.size * float(np.exp(sizes.get(k, 0.0))),
                    start.override + (0.0 if run.override is None else overrides[run.override]),
                )
            )
        return tuple(made)

    def bounds(self) -> tuple[FloatArray, FloatArray]:
        """(n,) each, of the variables."""
        p = self.parameters
        lower, upper = p.bounds
        low, high = [(lower - p.start) / p.scale], [(upper - p.start) / p.scale]
        for count, most in (
            (len(self.timed), MOST_OFFSET / OFFSET_SCALE),
            (len(self.clocks), MOST_CLOCK / CLOCK_SCALE),
        ):
            low.append(np.full(count, -most))
            high.append(np.full(count, most))
        overrides = np.array([self._first_override(name) for name in self.overrides])
        low.append((SLOWEST - overrides) / OVERRIDE_SCALE)
        high.append((1.0 - overrides) / OVERRIDE_SCALE)
        sizes = np.array([self.start[k].size for k in self.sized])
        low.append(np.log(SMALLEST / sizes) / SIZE_SCALE)
        high.append(np.log(LARGEST / sizes) / SIZE_SCALE)
        return np.concatenate(low), np.concatenate(high)

    def jacobian(self, k: int, rows: Rows, nuisance: Nuisance) -> FloatArray:
        """(K, M, n), derivatives of a run's residuals with respect to all variables."""
        p = self.parameters
        out = np.zeros((*rows.values.shape, self.size))
        out[..., : p.size] = rows.by_parameter * p.scale
        run = self.runs[k]
        if k in self.timed:
            out[..., p.size + self.timed.index(k)] = OFFSET_SCALE * rows.by_offset
        if run.clock is not None:
            place = self._clock()[self.clocks.index(run.clock)]
            out[..., place] = CLOCK_SCALE * rows.by_clock
        if run.override is not None:
            place = self._override()[self.overrides.index(run.override)]
            out[..., place] = OVERRIDE_SCALE * rows.by_override
        if k in self.sized:
            place = self._size()[self.sized.index(k)]
            out[..., place] = SIZE_SCALE * nuisance.size * rows.by_size
        return out

    def _clock(self) -> IntArray:
        return self.parameters.size + len(self.timed) + np.arange(len(self.clocks))

    def _override(self) -> IntArray:
        behind = self.parameters.size + len(self.timed) + len(self.clocks)
        return behind + np.arange(len(self.overrides))

    def _first_override(self, name: str) -> float:
        runs = zip(self.runs, self.start, strict=True)
        return next(own.override for run, own in runs if run.override == name)

    def _size(self) -> IntArray:
        return self.size - len(self.sized) + np.arange(len(self.sized))


def first_nuisances(runs: Sequence[PreparedRun]) -> tuple[Nuisance, ...]:
    """The runs' own as their alignment says: a clock is the median of its runs', an override that
    of those that show one."""
    clocks = {
        name: float(np.median([1 / (1 + run.drift) for run in runs if run.clock == name]))
        for name in {run.clock for run in runs if run.clock is not None}
    }
    overrides = {}
    for name in {run.override for run in runs if run.override is not None}:
        shown = [r.scale.ratio for r in runs if r.override == name and r.scale is not None]
        overrides[name] = min(float(np.median(shown)), 1.0) if shown else 1.0
    return tuple(
        Nuisance(
            run.offset,
            1.0 if run.clock is None else clocks[run.clock],
            run.size,
            1.0 if run.override is None else overrides[run.override],
        )
        for run in runs
    )


class Problem:
    """The least-squares problem for `flyby.core.sqp`.

    Its Jacobian is carried on from where it was evaluated as long as that holds (`secants`).

    Args:
        pool: emulates the runs.
        variables: of the same runs.
        known: residuals and derivatives of each run at the start, if they are known.
    """

    def __init__(
        self, pool: RunPool, variables: Variables, known: Sequence[Rows] | None = None
    ) -> None:
        self.pool = pool
        self.variables = variables
        self.exact = True
        """Whether the Jacobian asked for last was evaluated where it was asked for."""
        self.carries = True
        """Whether Jacobians may be carried on."""
        self._residuals: tuple[FloatArray, list[FloatArray]] | None = None
        self._known: tuple[FloatArray, list[RunDerivatives]] | None = None
        if known is not None:
            start = np.zeros(variables.size)
            own = variables.nuisances(start)
            made = [(rows, variables.jacobian(k, rows, own[k])) for k, rows in enumerate(known)]
            self._known = start, _flat(made)
        self._scale = 1.0 / np.sqrt(
            sum(run.weight.shape[0] * run.weight.shape[1] for run in pool.runs)
        )

    def nlp(self) -> NLP:
        """To minimise."""
        lower, upper = self.variables.bounds()
        return NLP(
            self.variables.size,
            residuals=self.residuals,
            residual_jacobian=self.jacobian,
            x_lower=lower,
            x_upper=upper,
        )

    def residuals(self, x: FloatArray) -> FloatArray:
        """All of them, robust and scaled to one; NaN where a program cannot be driven."""
        v = self.variables
        found = self.pool.residuals(v.parameters.model(v.values(x)), v.nuisances(x))
        values = [
            np.full(_rows(run), np.nan) if isinstance(one, FlybyError) else one.ravel()
            for run, one in zip(self.pool.runs, found, strict=True)
        ]
        self._residuals = x.copy(), values
        parts = [square_root(one)[0] for one in values]
        return np.concatenate([self._scale * np.concatenate(parts), self._held(x)[0]])

    def jacobian(self, x: FloatArray) -> FloatArray:
        """(R, n)."""
        made = self._carried(x)
        self.exact = made is None
        if made is None:
            made = _flat(self.linearised(x))
        self._known = x.copy(), made
        parts = [square_root(one.values)[1][:, None] * one.jacobian for one in made]
        return np.concatenate([self._scale * np.concatenate(parts), self._held(x)[1]])

    def _carried(self, x: FloatArray) -> list[RunDerivatives] | None:
        """Residuals and derivatives of each run at x, without any evaluation; None where that does
        not do."""
        if self._known is None or not self.carries:
            return None
        start, known = self._known
        if np.array_equal(start, x):
            return known
        if self._residuals is None or not np.array_equal(self._residuals[0], x):
            return None
        return carried(known, x - start, self._residuals[1])

    def _held(self, x: FloatArray) -> tuple[FloatArray, FloatArray]:
        """(P,) and (P, n), what it costs to leave what was before; nothing where runs alone
        count."""
        v = self.variables
        p = v.parameters
        if p.hold == 0.0:
            return np.zeros(0), np.zeros((0, v.size))
        away, slope = p.departures(v.values(x))
        held, by_away = square_root(away)
        jacobian = np.zeros((p.size, v.size))
        jacobian[:, : p.size] = np.diag(by_away * slope * p.scale)
        return np.sqrt(p.hold) * held, np.sqrt(p.hold) * jacobian

    def linearised(self, x: FloatArray) -> list[tuple[Rows, FloatArray]]:
        """Weighted residuals of each run, and their derivatives (K, M, n) by the variables.

        Raises:
            InputError: a program cannot be driven.
        """
        v = self.variables
        nuisances = v.nuisances(x)
        out = []
        for k, rows in enumerate(self.pool.rows(v.parameters, v.values(x), nuisances)):
            if isinstance(rows, FlybyError):
                raise InputError(f"{self.pool.runs[k].name}: {rows}") from rows
            out.append((rows, v.jacobian(k, rows, nuisances[k])))
        return out


def _flat(linearised: Sequence[tuple[Rows, FloatArray]]) -> list[RunDerivatives]:
    return [
        RunDerivatives(rows.values.ravel(), J.reshape(-1, J.shape[-1])) for rows, J in linearised
    ]


def _rows(run: PreparedRun) -> int:
    """How many weighted residuals a run has."""
    return int(run.weight.shape[0] * run.weight.shape[1])
