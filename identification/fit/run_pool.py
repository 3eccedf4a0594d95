"""Emulates many runs at once, in as many processes as there are workers."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from contextlib import ExitStack
from dataclasses import replace
from types import TracebackType
from typing import Any, TypeVar

from ...core.arrays import FloatArray
from ...core.errors import FlybyError
from ...core.motion.model.motion_model import MotionModel
from ...core.worker_pool import WorkerPool, worker_pool
from .emulation import STEP, Nuisance, Rows, RunEmulator
from .parameters import ParameterSet, SteppedModels
from .runs import PreparedRun

Answer = TypeVar("Answer")
_Job = tuple[int, Callable[..., Any], tuple[Any, ...]]
"""Index of the run, what is wanted of its emulator, and with what."""


class RunPool:
    """Workers that know some runs. To be used in a ``with`` statement.

    Args:
        runs: to be emulated.
        workers: processes; more than one needs a system that can fork, else the work is done here.
    """

    def __init__(self, runs: Sequence[PreparedRun], workers: int = 1) -> None:
        self.runs = tuple(runs)
        self._emulators = [RunEmulator(run) for run in self.runs]
        self._workers = workers
        self._open = ExitStack()
        self._pool: WorkerPool[_Job, Any] = WorkerPool(self._answer, None)

    def __enter__(self) -> RunPool:
        made = worker_pool(self._answer, self._workers, len(self.runs))
        self._pool = self._open.enter_context(made)
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        value: BaseException | None,
        trace: TracebackType | None,
    ) -> None:
        self._open.close()
        self._pool = WorkerPool(self._answer, None)

    def residuals(
        self, model: MotionModel, nuisances: Sequence[Nuisance]
    ) -> list[FloatArray | FlybyError]:
        """Weighted residuals (K, M) of each run; the error of one that cannot be driven so."""
        bare = replace(model, provenance={})
        return self._each(_residuals, [(bare, one) for one in nuisances])

    def rows(
        self, parameters: ParameterSet, values: FloatArray, nuisances: Sequence[Nuisance]
    ) -> list[Rows | FlybyError]:
        """Residuals and derivatives of each run; the error of one that cannot be driven so."""
        bare = ParameterSet(replace(parameters.base, provenance={}), parameters.parameters)
        try:
            models = bare.stepped(values, STEP)
        except FlybyError as error:
            return [error for _ in nuisances]
        return self._each(_rows, [(models, one) for one in nuisances])

    def _each(
        self, work: Callable[..., Answer], arguments: Sequence[tuple[Any, ...]]
    ) -> list[Answer | FlybyError]:
        # Long runs first, so that no worker is left with one at the end.
        order = sorted(range(len(self.runs)), key=lambda k: -len(self.runs[k].log.t))
        answers = self._pool.answers([(k, work, arguments[k]) for k in order])
        found = {k: answer for k, answer in zip(order, answers, strict=True) if answer is not None}
        return [found[k] for k in range(len(self.runs))]

    def _answer(self, job: _Job) -> Any:
        run, work, given = job
        try:
            return work(self._emulators[run], *given)
        except FlybyError as error:
            return error


def _residuals(emulator: RunEmulator, model: MotionModel, nuisance: Nuisance) -> FloatArray:
    return emulator.residuals(model, nuisance)


def _rows(emulator: RunEmulator, models: SteppedModels, nuisance: Nuisance) -> Rows:
    return emulator.rows(models, nuisance)
