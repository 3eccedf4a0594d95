"""Formulas as graphs: what a formula does with its variables, recorded once, and differentiated.

A formula is called with `Expression`s in the place of numbers; each operation adds a node to their
`Graph`. Derivatives are nodes of the same graph: the chain rule, backwards from a node (reverse
mode), writes them down. What is worked out twice is one node, and what is zero is none.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from enum import IntEnum
from math import pi
from math import sqrt as root
from typing import Any

import numpy as np
from scipy import special


class Operation(IntEnum):
    """What a node does with the nodes that it is made of."""

    CONSTANT = 0
    VARIABLE = 1
    ADD = 2
    SUBTRACT = 3
    MULTIPLY = 4
    DIVIDE = 5
    NEGATE = 6
    POWER = 7
    """Of a node to a constant."""
    EXP = 8
    LOG = 9
    SQRT = 10
    SIN = 11
    COS = 12
    TAN = 13
    TANH = 14
    ARCTAN = 15
    ERF = 16


class Graph:
    """The nodes of formulas in the same variables, each after those that it is made of.

    Args:
        variables: number of them.

    Attributes:
        nodes: operation, two nodes or places, a constant.
    """

    def __init__(self, variables: int) -> None:
        self.nodes: list[tuple[Operation, int, int, float]] = []
        self._known: dict[tuple[Operation, int, int, float], int] = {}
        self.variables = [self._node(Operation.VARIABLE, k) for k in range(variables)]

    def constant(self, value: float) -> Expression:
        """A number."""
        return self._node(Operation.CONSTANT, value=float(value))

    def operation(
        self, kind: Operation, a: Expression, b: Expression | None = None, value: float = 0.0
    ) -> Expression:
        """A node made of others."""
        return self._node(kind, a.node, a.node if b is None else b.node, value)

    def _node(self, kind: Operation, a: int = 0, b: int = 0, value: float = 0.0) -> Expression:
        entry = kind, a, b, value
        found = self._known.get(entry)
        if found is None:
            found = self._known[entry] = len(self.nodes)
            self.nodes.append(entry)
        return Expression(self, found)


class Expression:
    """A node of a graph, which numbers and other nodes go together with."""

    __slots__ = ("graph", "node")
    __array_ufunc__ = None  # numpy's numbers leave the arithmetic to this class

    def __init__(self, graph: Graph, node: int) -> None:
        self.graph = graph
        self.node = node

    @property
    def number(self) -> float | None:
        """Its value, if it is a constant."""
        kind, _, _, value = self.graph.nodes[self.node]
        return value if kind is Operation.CONSTANT else None

    def _lift(self, other: Expression | float) -> Expression:
        return other if isinstance(other, Expression) else self.graph.constant(other)

    def __add__(self, other: Expression | float) -> Expression:
        other = self._lift(other)
        a, b = self.number, other.number
        if a is not None and b is not None:
            return self.graph.constant(a + b)
        if a == 0.0:
            return other
        if b == 0.0:
            return self
        first, second = sorted((self, other), key=lambda e: e.node)
        return self.graph.operation(Operation.ADD, first, second)

    def __sub__(self, other: Expression | float) -> Expression:
        other = self._lift(other)
        a, b = self.number, other.number
        if a is not None and b is not None:
            return self.graph.constant(a - b)
        if a == 0.0:
            return -other
        return self if b == 0.0 else self.graph.operation(Operation.SUBTRACT, self, other)

    def __mul__(self, other: Expression | float) -> Expression:
        other = self._lift(other)
        a, b = self.number, other.number
        if a is not None and b is not None:
            return self.graph.constant(a * b)
        if a == 0.0 or b == 0.0:
            return self.graph.constant(0.0)
        if a == 1.0:
            return other
        if b == 1.0:
            return self
        first, second = sorted((self, other), key=lambda e: e.node)
        return self.graph.operation(Operation.MULTIPLY, first, second)

    def __truediv__(self, other: Expression | float) -> Expression:
        other = self._lift(other)
        a, b = self.number, other.number
        if b is not None:
            return self * (1.0 / b)
        return self if a == 0.0 else self.graph.operation(Operation.DIVIDE, self, other)

    def __neg__(self) -> Expression:
        value = self.number
        return self.graph.operation(Operation.NEGATE, self) if value is None else self._lift(-value)

    def __pos__(self) -> Expression:
        return self

    def __pow__(self, power: Expression | float) -> Expression:
        exponent = power.number if isinstance(power, Expression) else float(power)
        if exponent is None:
            return _expression(exp(power * log(self)))
        if exponent in (0.0, 1.0):
            return self if exponent else self._lift(1.0)
        if self.number is not None:
            return self._lift(self.number**exponent)
        if exponent == 2.0:
            return self * self
        return self.graph.operation(Operation.POWER, self, value=exponent)

    __radd__ = __add__
    __rmul__ = __mul__

    def __rsub__(self, other: float) -> Expression:
        return self._lift(other) - self

    def __rtruediv__(self, other: float) -> Expression:
        return self._lift(other) / self

    def __rpow__(self, base: float) -> Expression:
        return _expression(exp(self * np.log(base)))


def _expression(value: Any) -> Expression:
    assert isinstance(value, Expression)
    return value


def _lifted(kind: Operation, function: Callable[[Any], Any]) -> Callable[[Any], Any]:
    """A function of expressions and of numbers."""

    def lifted(x: Any) -> Any:
        if not isinstance(x, Expression):
            return function(x)
        value = x.number
        return x.graph.operation(kind, x) if value is None else x.graph.constant(function(value))

    lifted.__name__ = kind.name.lower()
    return lifted


exp = _lifted(Operation.EXP, np.exp)
log = _lifted(Operation.LOG, np.log)
sqrt = _lifted(Operation.SQRT, np.sqrt)
sin = _lifted(Operation.SIN, np.sin)
cos = _lifted(Operation.COS, np.cos)
tan = _lifted(Operation.TAN, np.tan)
tanh = _lifted(Operation.TANH, np.tanh)
arctan = _lifted(Operation.ARCTAN, np.arctan)
erf = _lifted(Operation.ERF, special.erf)

_SLOPES: dict[Operation, Callable[[Expression, Expression], Any]] = {
    Operation.EXP: lambda u, value: value,
    Operation.LOG: lambda u, value: 1.0 / u,
    Operation.SQRT: lambda u, value: 0.5 / value,
    Operation.SIN: lambda u, value: cos(u),
    Operation.COS: lambda u, value: -sin(u),
    Operation.TAN: lambda u, value: 1.0 + value * value,
    Operation.TANH: lambda u, value: 1.0 - value * value,
    Operation.ARCTAN: lambda u, value: 1.0 / (1.0 + u * u),
    Operation.ERF: lambda u, value: 2.0 / root(pi) * exp(-(u * u)),
}
"""Argument, value → derivative."""


def slopes(of: Expression, by: Sequence[Expression]) -> list[Expression]:
    """Derivatives of an expression by variables; constants of zero where it does not depend on
    one."""
    graph = of.graph
    zero = graph.constant(0.0)
    found = {of.node: graph.constant(1.0)}
    for node in range(of.node, -1, -1):
        behind = found.get(node)
        if behind is None:
            continue
        for part, share in _shares(graph, node, behind):
            before = found.get(part)
            found[part] = share if before is None else before + share
    return [found.get(variable.node, zero) for variable in by]


def _shares(graph: Graph, node: int, behind: Expression) -> Iterable[tuple[int, Expression]]:
    """What a node passes on to those that it is made of.

    Args:
        behind: derivative by the node.
    """
    kind, a, b, value = graph.nodes[node]
    u, v = Expression(graph, a), Expression(graph, b)
    match kind:
        case Operation.CONSTANT | Operation.VARIABLE:
            return []
        case Operation.ADD:
            return [(a, behind), (b, behind)]
        case Operation.SUBTRACT:
            return [(a, behind), (b, -behind)]
        case Operation.MULTIPLY:
            return [(a, behind * v), (b, behind * u)]
        case Operation.DIVIDE:
            share = behind / v
            return [(a, share), (b, -(share * Expression(graph, node)))]
        case Operation.NEGATE:
            return [(a, -behind)]
        case Operation.POWER:
            return [(a, behind * (value * u ** (value - 1.0)))]
    return [(a, behind * _SLOPES[kind](u, Expression(graph, node)))]
