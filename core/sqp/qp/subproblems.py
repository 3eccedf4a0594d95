"""Subproblems solved by a back end, made exact where its active set is right, and by another
one where it fails."""

from __future__ import annotations

import time
from dataclasses import replace

import numpy as np

from ..algebra.linear import Saddle
from . import active_set
from .equilibration import units_of
from .problem import Backend, QpSolution, QpStatus, QuadraticProgram

_POLISHING = 1
_EXACT = 1e-9
_LONGEST = 8
"""Subproblems in a row for which no guess is tried, at most: after each that led nowhere twice as
many as before, as the systems that it takes may cost more than the back end."""
_INEXACT = 1e-5
"""Error of a solution from a back end that gave up at which it is still taken."""


class Subproblems:
    """Solves the subproblems of one solution.

    Args:
        backends: the first one is asked first.

    Attributes:
        known: back ends by name that are set up.
        seconds: spent since `use` was called last.
        used: name of the back end that was asked last.
    """

    def __init__(self, backends: tuple[Backend, ...]) -> None:
        self.known: dict[str, Backend] = {}
        self._saddle = Saddle()
        self.use(backends)

    def use(self, backends: tuple[Backend, ...]) -> None:
        """Begin a solution with these back ends; those known already stay as they are set up."""
        for backend in backends:
            self.known.setdefault(backend.name, backend)
        self._backends = tuple(self.known[backend.name] for backend in backends)
        self.seconds = 0.0
        self._pause = self._left = 0
        self.used = self._backends[0].name

    def solve(self, qp: QuadraticProgram, warm: QpSolution | None = None) -> QpSolution:
        """The solution of ``qp``; what the last back end says if none solves it."""
        begin = time.perf_counter()
        units = units_of(qp)
        try:
            if units is None:
                return self._solve(qp, warm)
            return units.unscaled(self._solve(units.scaled(qp), units.scaled_guess(warm)))
        finally:
            self.seconds += time.perf_counter() - begin

    def _solve(self, qp: QuadraticProgram, warm: QpSolution | None) -> QpSolution:
        if not (np.isfinite(qp.d_lower).any() or np.isfinite(qp.d_upper).any() or len(qp.lower)):
            return self._unconstrained(qp)
        self._left -= 1
        if warm is not None and self._left < 0:
            found = self._from_guess(qp, warm)
            if found is not None:
                self._pause = 0
                return found
            self._pause = self._left = min(2 * self._pause + 1, _LONGEST)
        found = None
        for backend in self._backends:
            found = _doubted(qp, backend.solve(qp, warm))
            self.used = backend.name
            if found.status is QpStatus.SOLVED:
                return self._polished(qp, found)
            if found.status is QpStatus.INEXACT:
                found = self._polished(qp, found)
                size = max(1.0, float(np.abs(found.y).max(initial=0.0)))
                good = active_set.error(qp, found) <= _INEXACT * size
                found = replace(found, status=QpStatus.SOLVED if good else QpStatus.FAILED)
            if found.status is not QpStatus.FAILED:
                return found
        assert found is not None
        return found

    def _from_guess(self, qp: QuadraticProgram, warm: QpSolution) -> QpSolution | None:
        """The solution from the active set of another; None where that leads nowhere."""
        guess = active_set.pushed_by(qp, warm.y, warm.z)
        found = active_set.settled(qp, guess, self._saddle, self._backends[0].worth)
        if found is None:
            return None
        size = max(1.0, float(np.abs(qp.q).max()))
        return found if active_set.error(qp, found) <= _EXACT * size else None

    def _unconstrained(self, qp: QuadraticProgram) -> QpSolution:
        n = len(qp.q)
        none, zero = np.zeros(n, dtype=np.bool_), np.zeros(n)
        empty = np.zeros(0)
        found = self._saddle.solve(qp.P, qp.q, qp.A, np.zeros(0, dtype=np.bool_), empty, none, zero)
        if found is None:
            return QpSolution(QpStatus.UNBOUNDED, zero, empty, zero)
        d = found[0]
        left = float(np.abs(qp.P @ d + qp.q).max())
        solved = left <= 1e-6 * max(1.0, float(np.abs(qp.q).max()))
        return QpSolution(
            QpStatus.SOLVED if solved else QpStatus.UNBOUNDED, d if solved else zero, empty, zero
        )

    def _polished(self, qp: QuadraticProgram, found: QpSolution) -> QpSolution:
        """The exact solution for the active set that a solution shows; the solution itself if that
        is no better.

        Interior points stop short of their bounds, and first-order methods anywhere near; with the
        active set known the rest is one linear system.
        """
        found = replace(found, d=np.clip(found.d, qp.d_lower, qp.d_upper))
        shown = active_set.shown_by(qp, found.d, found.y, found.z)
        better = active_set.settled(qp, shown, self._saddle, _POLISHING)
        if better is None:
            return found
        error = active_set.error(qp, better)
        if np.isnan(error) or error >= active_set.error(qp, found):
            return found
        return replace(better, status=found.status)


def _doubted(qp: QuadraticProgram, found: QpSolution) -> QpSolution:
    """A back end's answer; a failure where it claims what cannot be: unbounded steps within bounds,
    or that nothing is feasible where d = 0 is."""
    unbounded = found.status is QpStatus.UNBOUNDED
    if unbounded and np.isfinite(qp.d_lower).all() and np.isfinite(qp.d_upper).all():
        return replace(found, status=QpStatus.FAILED)
    if found.status is QpStatus.INFEASIBLE and _holds_at_zero(qp):
        return replace(found, status=QpStatus.FAILED)
    return found


def _holds_at_zero(qp: QuadraticProgram) -> bool:
    rows = (qp.lower <= 0.0).all() and (qp.upper >= 0.0).all()
    return bool(rows and (qp.d_lower <= 0.0).all() and (qp.d_upper >= 0.0).all())
