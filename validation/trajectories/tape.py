"""Expressions worked out at many places at once, by one compiled loop for all formulas."""

from __future__ import annotations

from collections.abc import Sequence
from math import erf
from typing import NamedTuple

import numpy as np
from numba import njit

from ...core.arrays import FloatArray, IntArray
from .expressions import Expression, Graph, Operation

_TOGETHER = 32
"""Places that are worked out together: their values stay in the cache."""
_CONSTANT, _VARIABLE = int(Operation.CONSTANT), int(Operation.VARIABLE)
_ADD, _SUBTRACT, _MULTIPLY = map(int, (Operation.ADD, Operation.SUBTRACT, Operation.MULTIPLY))
_DIVIDE, _NEGATE, _POWER = map(int, (Operation.DIVIDE, Operation.NEGATE, Operation.POWER))
_EXP, _LOG, _SQRT = map(int, (Operation.EXP, Operation.LOG, Operation.SQRT))
_SIN, _COS, _TAN = map(int, (Operation.SIN, Operation.COS, Operation.TAN))
_TANH, _ARCTAN = int(Operation.TANH), int(Operation.ARCTAN)


class _Steps(NamedTuple):
    """What is to be done, in order: (t,) each.

    Args:
        kinds: operations.
        first, second: steps or variables that they take.
        constants: numbers that they take.
    """

    kinds: IntArray
    first: IntArray
    second: IntArray
    constants: FloatArray


class Tape:
    """Some expressions of a graph, and no more of it than they take.

    Args:
        graph: the graph.
        outputs: the expressions (o,).
    """

    def __init__(self, graph: Graph, outputs: Sequence[Expression]) -> None:
        needed = {expression.node for expression in outputs}
        for node in range(len(graph.nodes) - 1, -1, -1):
            kind, a, b, _ = graph.nodes[node]
            if node in needed and kind not in (Operation.CONSTANT, Operation.VARIABLE):
                needed |= {a, b}
        order = sorted(needed)
        number = {node: step for step, node in enumerate(order)}
        leaf = Operation.CONSTANT, Operation.VARIABLE
        steps = [
            (kind, a, b, value) if kind in leaf else (kind, number[a], number[b], value)
            for kind, a, b, value in (graph.nodes[node] for node in order)
        ]
        kinds, first, second, constants = zip(*steps, strict=True) if steps else ((),) * 4
        self._steps = _Steps(
            np.array(kinds, dtype=np.int64),
            np.array(first, dtype=np.int64),
            np.array(second, dtype=np.int64),
            np.array(constants, dtype=np.float64),
        )
        self._outputs = np.array([number[e.node] for e in outputs], dtype=np.int64)

    def values(self, given: FloatArray) -> FloatArray:
        """The expressions' values.

        Args:
            given: (variables, k) at k places.

        Returns:
            (o, k).
        """
        found = np.empty((len(self._outputs), given.shape[1]))
        _work_out(self._steps, self._outputs, given, found)
        return found


@njit(cache=True, error_model="numpy")
def _work_out(steps: _Steps, outputs: IntArray, given: FloatArray, found: FloatArray) -> None:
    work = np.empty((len(steps.kinds), _TOGETHER))
    for begin in range(0, given.shape[1], _TOGETHER):
        count = min(_TOGETHER, given.shape[1] - begin)
        for step in range(len(steps.kinds)):
            kind, first, second = steps.kinds[step], steps.first[step], steps.second[step]
            to = work[step, :count]
            if kind == _CONSTANT:
                to[:] = steps.constants[step]
            elif kind == _VARIABLE:
                to[:] = given[first, begin : begin + count]
            elif kind <= _DIVIDE:
                _arithmetic(kind, to, work[first, :count], work[second, :count])
            else:
                _function(kind, to, work[first, :count], steps.constants[step])
        for k in range(len(outputs)):
            found[k, begin : begin + count] = work[outputs[k], :count]


@njit(cache=True, error_model="numpy")
def _arithmetic(kind: int, to: FloatArray, u: FloatArray, v: FloatArray) -> None:
    if kind == _ADD:
        for k in range(len(to)):
            to[k] = u[k] + v[k]
    elif kind == _SUBTRACT:
        for k in range(len(to)):
            to[k] = u[k] - v[k]
    elif kind == _MULTIPLY:
        for k in range(len(to)):
            to[k] = u[k] * v[k]
    else:
        for k in range(len(to)):
            to[k] = u[k] / v[k]


@njit(cache=True, error_model="numpy")
def _function(kind: int, to: FloatArray, u: FloatArray, constant: float) -> None:
    for k in range(len(to)):
        x = u[k]
        if kind == _NEGATE:
            to[k] = -x
        elif kind == _POWER:
            to[k] = x**constant
        elif kind == _EXP:
            to[k] = np.exp(x)
        elif kind == _LOG:
            to[k] = np.log(x)
        elif kind == _SQRT:
            to[k] = np.sqrt(x)
        elif kind == _SIN:
            to[k] = np.sin(x)
        elif kind == _COS:
            to[k] = np.cos(x)
        elif kind == _TAN:
            to[k] = np.tan(x)
        elif kind == _TANH:
            to[k] = np.tanh(x)
        elif kind == _ARCTAN:
            to[k] = np.arctan(x)
        else:
            to[k] = erf(x)
