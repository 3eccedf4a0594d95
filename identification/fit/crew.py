"""Emulates many runs at once, in as many processes as there are workers."""

from __future__ import annotations

import multiprocessing
from collections.abc import Callable, Sequence
from concurrent.futures import ProcessPoolExecutor
from dataclasses import replace
from types import TracebackType
from typing import Any, TypeVar

from ...core.arrays import FloatArray
from ...core.errors import FlybyError
from ...core.motion.model.motion_model import MotionModel
from .emulation import Nuisance, Rows, RunEmulator
from .parameters import ParameterSet
from .runs import PreparedRun

Answer = TypeVar("Answer")

_emulators: list[RunEmulator] = []
"""Of a worker process, by inheritance."""


class Crew:
    """Workers who know some runs. To be used in a ``with`` statement.

    Args:
        runs: to be emulated.
        workers: processes; more than one needs a system that can fork, else the work is done here.
    """

    def __init__(self, runs: Sequence[PreparedRun], workers: int = 1) -> None:
        self.runs = tuple(runs)
        self._emulators = [RunEmulator(run) for run in self.runs]
        self._workers = min(workers, len(self.runs)) if _can_fork() else 1
        self._pool: ProcessPoolExecutor | None = None

    def __enter__(self) -> Crew:
        if self._workers > 1:
            context = multiprocessing.get_context("fork")
            _emulators[:] = self._emulators
            self._pool = ProcessPoolExecutor(self._workers, mp_context=context)
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        value: BaseException | None,
        trace: TracebackType | None,
    ) -> None:
        if self._pool is not None:
            self._pool.shutdown(cancel_futures=True)
            self._pool = None
        _emulators.clear()

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
        return self._each(_rows, [(bare, values, one) for one in nuisances])

    def _each(
        self, work: Callable[..., Answer], arguments: Sequence[tuple[Any, ...]]
    ) -> list[Answer | FlybyError]:
        if self._pool is None:
            pairs = zip(self._emulators, arguments, strict=True)
            return [_tried(work, emulator, given) for emulator, given in pairs]
        # Long runs first, so that no worker is left with one at the end.
        order = sorted(range(len(self.runs)), key=lambda k: -len(self.runs[k].log.t))
        futures = {k: self._pool.submit(_inherited, work, k, arguments[k]) for k in order}
        return [futures[k].result() for k in range(len(self.runs))]


def _can_fork() -> bool:
    return "fork" in multiprocessing.get_all_start_methods()


def _inherited(
    work: Callable[..., Answer], index: int, given: tuple[Any, ...]
) -> Answer | FlybyError:
    return _tried(work, _emulators[index], given)


def _tried(
    work: Callable[..., Answer], emulator: RunEmulator, given: tuple[Any, ...]
) -> Answer | FlybyError:
    try:
        return work(emulator, *given)
    except FlybyError as error:
        return error


def _residuals(emulator: RunEmulator, model: MotionModel, nuisance: Nuisance) -> FloatArray:
    return emulator.residuals(model, nuisance)


def _rows(
    emulator: RunEmulator, parameters: ParameterSet, values: FloatArray, nuisance: Nuisance
) -> Rows:
    return emulator.rows(parameters, values, nuisance)
