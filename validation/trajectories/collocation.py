"""Optimal control problems made finite: trapezoidal or Hermite–Simpson collocation.

Variables are w = [parameters, x[0], u[0], x[1], u[1], …] at nodes of equal distance.
Hermite–Simpson is the compressed form of Betts, "Practical methods for optimal control" (2010),
section 4.5: the state in the middle follows from the nodes', the control there is their mean.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from enum import StrEnum
from typing import Any

import numpy as np

from ...core.arrays import FloatArray
from .separable import Separable, Terms

Values = Sequence[Any]


class Collocation(StrEnum):
    """How the motion between two nodes follows from theirs."""

    TRAPEZOIDAL = "trapezoidal"
    HERMITE_SIMPSON = "hermite_simpson"


@dataclass(frozen=True)
class Control:
    """A problem in continuous time. All functions take states, controls and parameters.

    Args:
        states, controls, parameters: numbers of them.
        dynamics: gives ẋ.
        duration: of the parameters.
        running: cost that is integrated; None for none.
        final: cost of the last node; None for none.
        path: rows at each node, with limits; None for none.
        path_lower, path_upper: of each of them.
        lower, upper: limits of a node's states and controls.
        parameter_lower, parameter_upper: likewise.
        first, last: values of the states at the ends, NaN where free.
    """

    states: int
    controls: int
    dynamics: Callable[[Values, Values, Values], list[Any]]
    duration: Callable[[Values], Any]
    first: Sequence[float]
    last: Sequence[float]
    lower: Sequence[float]
    upper: Sequence[float]
    parameters: int = 0
    parameter_lower: Sequence[float] = ()
    parameter_upper: Sequence[float] = ()
    running: Callable[[Values, Values, Values], Any] | None = None
    final: Callable[[Values, Values, Values], Any] | None = None
    path: Callable[[Values, Values, Values], list[Any]] | None = None
    path_lower: Sequence[float] = field(default=())
    path_upper: Sequence[float] = field(default=())


def collocated(problem: Control, nodes: int, scheme: Collocation) -> Separable:
    """The finite problem."""
    P, width = problem.parameters, problem.states + problem.controls
    n = P + nodes * width
    node = P + np.arange(nodes)[:, None] * width + np.arange(width)
    globals_ = np.tile(np.arange(P), (nodes, 1))
    pairs = np.hstack([globals_[1:], node[:-1], node[1:]])
    zeros = [0.0] * problem.states
    rows = [Terms(_defects(problem, nodes, scheme), pairs, zeros, zeros)]
    single = np.hstack([globals_, node])
    if problem.path is not None:
        rows.append(
            Terms(_at_node(problem, problem.path), single, problem.path_lower, problem.path_upper)
        )
    costs = []
    if problem.running is not None:
        costs.append(Terms(_integral(problem, nodes, scheme), pairs))
    if problem.final is not None:
        costs.append(Terms(_at_node(problem, problem.final), single[-1:]))
    lower = np.concatenate([problem.parameter_lower, np.tile(problem.lower, nodes)])
    upper = np.concatenate([problem.parameter_upper, np.tile(problem.upper, nodes)])
    for place, values in ((node[0], problem.first), (node[-1], problem.last)):
        fixed = np.isfinite(values)
        held = place[: problem.states][fixed]
        lower[held] = upper[held] = np.asarray(values, float)[fixed]
    return Separable(n, costs, rows, lower, upper)


def guess(parameters: Sequence[float], nodes: FloatArray) -> FloatArray:
    """w of parameters and nodes (N, states + controls)."""
    return np.concatenate([np.asarray(parameters, float), np.asarray(nodes, float).ravel()])


def nodes_of(problem: Control, w: FloatArray) -> FloatArray:
    """(N, states + controls)."""
    return w[problem.parameters :].reshape(-1, problem.states + problem.controls)


def _split(problem: Control, given: Values) -> tuple[Values, list[tuple[Values, Values]]]:
    P, S = problem.parameters, problem.states
    width = S + problem.controls
    nodes = [given[k : k + width] for k in range(P, len(given), width)]
    return given[:P], [(node[:S], node[S:]) for node in nodes]


def _at_node(problem: Control, function: Callable[..., Any]) -> Callable[..., Any]:
    def formula(*given: Any) -> Any:
        p, ((x, u),) = _split(problem, given)
        return function(x, u, p)

    return formula


def _middle(problem: Control, h: Any, a: Any, b: Any, fa: Values, fb: Values) -> tuple[Any, Any]:
    x = [
        (x0 + x1) / 2 + h / 8 * (f0 - f1) for x0, x1, f0, f1 in zip(a[0], b[0], fa, fb, strict=True)
    ]
    return x, [(u0 + u1) / 2 for u0, u1 in zip(a[1], b[1], strict=True)]


def _defects(problem: Control, nodes: int, scheme: Collocation) -> Callable[..., list[Any]]:
    def formula(*given: Any) -> list[Any]:
        p, (a, b) = _split(problem, given)
        h = problem.duration(p) / (nodes - 1)
        fa, fb = problem.dynamics(*a, p), problem.dynamics(*b, p)
        if scheme is Collocation.TRAPEZOIDAL:
            moved = [h / 2 * (f0 + f1) for f0, f1 in zip(fa, fb, strict=True)]
        else:
            fm = problem.dynamics(*_middle(problem, h, a, b, fa, fb), p)
            moved = [h / 6 * (f0 + 4 * f + f1) for f0, f, f1 in zip(fa, fm, fb, strict=True)]
        return [x1 - x0 - d for x0, x1, d in zip(a[0], b[0], moved, strict=True)]

    return formula


def _integral(problem: Control, nodes: int, scheme: Collocation) -> Callable[..., Any]:
    running = problem.running
    assert running is not None

    def formula(*given: Any) -> Any:
        p, (a, b) = _split(problem, given)
        h = problem.duration(p) / (nodes - 1)
        ends = running(*a, p) + running(*b, p)
        if scheme is Collocation.TRAPEZOIDAL:
            return h / 2 * ends
        fa, fb = problem.dynamics(*a, p), problem.dynamics(*b, p)
        return h / 6 * (ends + 4 * running(*_middle(problem, h, a, b, fa, fb), p))

    return formula


def straight(first: Sequence[float], last: Sequence[float], nodes: int) -> FloatArray:
    """Nodes (N, …) in a straight line between two."""
    share = np.linspace(0.0, 1.0, nodes)[:, None]
    return np.asarray(first, float) * (1 - share) + np.asarray(last, float) * share
