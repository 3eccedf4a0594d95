"""The benchmark's problems as casadi expressions, on which IPOPT runs at its best.

Variables and rows are in the order of their numpy twins, which `checked` makes sure of.
"""

from __future__ import annotations

from typing import Any

import casadi as ca
import numpy as np
from banded import BLOCK, EFFORT, RIPPLE, STATES, WAVES, Banded

from flyby.core.arrays import FloatArray
from flyby.core.sqp import NLP
from flyby.validation.textbook import Avoidance, DoubleIntegrator, PointMass, Scheme
from flyby.validation.trajectories.separable import Separable, Terms

Expressions = dict[str, Any]
ca.GlobalOptions.setNumpyMode(-1)  # numpy's functions of symbols give symbols


def cubic() -> Expressions:
    """The cubic problem."""
    w = ca.SX.sym("w", 2)
    a, b = w[0], w[1]
    f = a**2 + a * b + b**2 - 3 * a - 3 * b
    return {"x": w, "f": f, "g": ca.vertcat((a / 2 - 2) ** 3 - b + 4, a**3 + b - 4)}


def double_integrator(problem: DoubleIntegrator) -> Expressions:
    """The double integrator, either scheme."""
    w = ca.SX.sym("w", problem.n)
    nodes = ca.reshape(w[1:], 3, problem.nodes)
    h = w[0] / (problem.nodes - 1)
    x1, x2, u = (nodes[row, :].T for row in range(3))
    force = (u[:-1] + u[1:]) / 2 if problem.scheme is Scheme.TRAPEZOIDAL else u[:-1]
    moved = x1[1:] - x1[:-1] - h * (x2[:-1] + x2[1:]) / 2
    sped = x2[1:] - x2[:-1] - h * force
    return {"x": w, "f": w[0], "g": ca.vertcat(moved, sped)}


def point_mass(problem: PointMass) -> Expressions:
    """The point mass, with any kind of avoidance."""
    w = ca.SX.sym("w", problem.n)
    nodes = ca.reshape(w[1:], 6, problem.nodes)
    h = w[0] / (problem.nodes - 1)
    q, v, u = nodes[0:2, :], nodes[2:4, :], nodes[4:6, :-1]
    moved = q[:, 1:] - q[:, :-1] - h * (v[:, :-1] + v[:, 1:]) / 2
    sped = v[:, 1:] - v[:, :-1] - h * u
    rows = _avoidance(problem, h, q, v)
    g = ca.vertcat(ca.vec(moved), ca.vec(sped), ca.sum1(u**2).T, rows)
    return {"x": w, "f": w[0], "g": g}


def _avoidance(problem: PointMass, h: Any, q: Any, v: Any) -> Any:
    groups: list[list[Any]] = [[], [], []]
    inner_v, v0 = v[:, 1:-1], v[:, :-1]
    for x, y, radius in problem.scene.circles:
        p = q - ca.DM([x, y])
        inner, p0, p2 = p[:, 1:-1], p[:, :-1], p[:, 1:]
        if problem.avoidance is Avoidance.SAMPLES:
            groups[0].append(ca.sum1(inner**2).T)
        elif problem.avoidance is Avoidance.CHORDS:
            taken = ca.sum1((p2 - p0) ** 2) / 4 + (radius + problem.force / 8 * h**2) ** 2
            groups[0].append((ca.sum1(p0**2) - taken).T)
            groups[1].append((ca.sum1(p2**2) - taken).T)
        else:
            swing = h / 2 * ca.sum1(inner * inner_v)
            p1 = p0 + h / 2 * v0
            groups[0].append((ca.sum1(inner**2) + swing).T)
            groups[1].append((ca.sum1(inner**2) - swing).T)
            groups[2].append(((2 * ca.sum1(p1**2) + ca.sum1(p0 * p2)) / 3).T)
    return ca.vertcat(*(row for group in groups for row in group))


def banded(problem: Banded) -> Expressions:
    """The random chain."""
    w = ca.SX.sym("w", problem.n)
    blocks = ca.reshape(w, BLOCK, problem.nodes)
    x, u = blocks[:STATES, :], blocks[STATES:, :]
    tracking = ca.sumsqr(x - problem.reference.T) / 2
    f = tracking + RIPPLE * ca.sum(ca.vec(ca.cos(3 * x))) + EFFORT / 2 * ca.sumsqr(u)
    driven = ca.DM(problem.A) @ x[:, :-1] + ca.DM(problem.B) @ u[:, :-1]
    driven += WAVES * ca.sin(x[:, :-1])
    return {"x": w, "f": f, "g": ca.vertcat(ca.vec(x[:, 1:] - driven), ca.sum1(x**2).T / 2)}


def separable(problem: Separable) -> Expressions:
    """A problem of formulas at places."""
    w = ca.SX.sym("w", problem.n)

    def at_places(terms: Terms) -> list[Any]:
        places = np.atleast_2d(terms.places)
        found = terms.formula(*(w[column.tolist()] for column in places.T))
        rows = found if isinstance(found, list) else [found]
        return [ca.SX(row) * ca.SX.ones(len(places), 1) for row in rows]

    f = sum(ca.sum1(row) for terms in problem.objective_terms for row in at_places(terms))
    rows = [row for terms in problem.row_terms for row in at_places(terms)]
    return {"x": w, "f": f, "g": ca.vertcat(*rows)}


def checked(expressions: Expressions, nlp: NLP, x: FloatArray) -> Expressions:
    """The expressions, if they agree with the callables at a point near x."""
    w = x + np.random.default_rng(1).normal(scale=0.1, size=len(x))
    both = ca.Function("both", [expressions["x"]], [expressions["f"], expressions["g"]])
    f, g = both(w)
    assert nlp.objective is not None and nlp.constraints is not None
    np.testing.assert_allclose(float(f), nlp.objective(w), rtol=1e-10)
    np.testing.assert_allclose(np.array(g).ravel(), nlp.constraints(w), rtol=1e-9, atol=1e-10)
    return expressions
