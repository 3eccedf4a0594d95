"""A point mass in the plane among circles, in minimum time (thesis, section 3.4).

    minimise T   subject to   q̈ = u,   |u| ≤ u_max,   q in a square,   |q − c_k| ≥ r_k,
                              q(0), q(T) given, q̇(0) = q̇(T) = 0

N nodes at equal times, h = T/(N − 1), in w = [T, x₀, y₀, ẋ₀, ẏ₀, u_x₀, u_y₀, x₁, …]. The force is
constant over an interval, so that the motion between nodes is known exactly:

    q[i+1] = q[i] + h (q̇[i] + q̇[i+1])/2        (the mean is the speed at the interval's midpoint)
    q̇[i+1] = q̇[i] + h u[i]
    |u[i]|² ≤ u_max²                              (u[N−1] acts no more, and is 0)

and rows that keep the mass away from the circles: see `avoidance`. The thesis asks for
|q − c|² ≥ r² at the nodes, and its optimiser then jumps: since T is free it takes a run-up and
passes a wall within one interval, however many there are.
"""

from __future__ import annotations

from collections.abc import Sequence
from enum import StrEnum

import numpy as np
from scipy import sparse

from ...core.arrays import FloatArray, IntArray
from ...core.errors import InputError
from ...core.sqp import NLP
from ...core.sqp.algebra.entries import MatrixEntries
from .arcs import Arcs
from .avoidance import STRIDE, AvoidanceRows, Bernstein, Chords, Samples, State, columns
from .ranges import check_force, check_nodes
from .scenes import Place, Scene


class Avoidance(StrEnum):
    """How circles are avoided."""

    SAMPLES = "samples"
    """At the nodes only, as in the thesis: the motion may jump between them."""
    CHORDS = "chords"
    """At the nodes, by a margin that covers the way between them."""
    BERNSTEIN = "bernstein"
    """All along each interval, by the Bernstein coefficients of the squared distance."""


class PointMass:
    """The discretised problem; see the module.

    Args:
        scene: circles, start and goal.
        nodes: N, at least 3.
        avoidance: how the circles are avoided.
        force: u_max, above zero.

    Raises:
        InputError: an argument is out of its range.
    """

    def __init__(
        self,
        scene: Scene,
        nodes: int,
        avoidance: Avoidance = Avoidance.SAMPLES,
        force: float = 1.0,
    ) -> None:
        check_nodes(nodes, 3)
        check_force(force)
        self.scene = scene
        self.nodes = nodes
        self.avoidance = Avoidance(avoidance)
        self.force = force
        self.n = 1 + STRIDE * nodes
        self._rows = self._avoidance_rows()
        self._intervals = nodes - 1
        self._driven = 5 * self._intervals
        self.m = self._driven + self._rows.count
        self._gradient = np.zeros(self.n)
        self._gradient[0] = 1.0
        self._jacobian = self._jacobian_entries()
        self._hessian = self._hessian_entries()
        self._time_shares = self._shares_of_time()

    def _avoidance_rows(self) -> AvoidanceRows:
        radii = self.scene.radii
        if self.avoidance is Avoidance.CHORDS:
            return Chords(self.nodes, radii, self.force)
        kind = Samples if self.avoidance is Avoidance.SAMPLES else Bernstein
        return kind(self.nodes, radii)

    def nlp(self) -> NLP:
        """The problem for the solver."""
        scene, driven = self.scene, 4 * self._intervals
        lower, upper = np.full(self.n, -np.inf), np.full(self.n, np.inf)
        lower[0] = 1e-3
        for axis in range(2):
            lower[1 + axis :: STRIDE], upper[1 + axis :: STRIDE] = (
                scene.lower[axis],
                scene.upper[axis],
            )
        for part in (lower, upper):
            part[1:5] = (*scene.start, 0.0, 0.0)
            part[-STRIDE:] = (*scene.goal, 0.0, 0.0, 0.0, 0.0)
        c_lower, c_upper = np.zeros(self.m), np.full(self.m, np.inf)
        c_upper[:driven] = 0.0
        c_lower[driven : self._driven] = -np.inf
        c_upper[driven : self._driven] = self.force**2
        c_lower[self._driven :] = self._rows.floor
        return NLP(
            n=self.n,
            m=self.m,
            objective=self.objective,
            gradient=self.gradient,
            constraints=self.constraints,
            jacobian=self.jacobian,
            hessian=self.hessian,
            x_lower=lower,
            x_upper=upper,
            c_lower=c_lower,
            c_upper=c_upper,
        )

    # ------------------------------------------------------------------- guesses, results

    def straight_line(self) -> FloatArray:
        """The thesis's guess: places along the line from the start to the goal."""
        return self.through((self.scene.start, self.scene.goal))

    def through(self, corners: Sequence[Place]) -> FloatArray:
        """A guess (n,) along a polyline, in the time that stops at every corner would need.

        Places are evenly spaced and have the speeds that go with them; no forces.

        Raises:
            InputError: there are no two corners.
        """
        points = np.array(corners, dtype=np.float64)
        if points.ndim != 2 or len(points) < 2 or points.shape[1] != 2:
            raise InputError(f"corners are two places in the plane or more, not {corners!r}")
        lengths = np.linalg.norm(np.diff(points, axis=0), axis=1)
        along = np.concatenate([[0.0], np.cumsum(lengths)])
        at = np.linspace(0.0, along[-1], self.nodes)
        time = 2.0 * np.sqrt(lengths / self.force).sum()
        nodes = np.zeros((self.nodes, STRIDE))
        for axis in range(2):
            nodes[:, axis] = np.interp(at, along, points[:, axis])
        nodes[1:-1, 2:4] = (nodes[2:, :2] - nodes[:-2, :2]) * self._intervals / (2.0 * time)
        return np.concatenate([[time], nodes.ravel()])

    def arcs(self, w: FloatArray) -> Arcs:
        """The motion between the nodes."""
        state = self._state(w)
        handles = state.q[:-1] + 0.5 * state.h * state.v[:-1]
        return Arcs(np.stack([state.q[:-1], handles, state.q[1:]], axis=1), float(w[0]))

    def places(self, w: FloatArray) -> FloatArray:
        """(N, 2)."""
        return self._state(w).q

    # -------------------------------------------------------------------------- callables

    def objective(self, w: FloatArray) -> float:
        """T."""
        return float(w[0])

    def gradient(self, w: FloatArray) -> FloatArray:
        """∇T (n,)."""
        return self._gradient

    def constraints(self, w: FloatArray) -> FloatArray:
        """Defects of places and speeds, squared forces, avoidance (m,)."""
        state, u = self._state(w), self._forces(w)
        moved = np.diff(state.q, axis=0) - state.h * _means(state.v)
        sped = np.diff(state.v, axis=0) - state.h * u
        squares = np.einsum("nd,nd->n", u, u)
        parts = moved.ravel(), sped.ravel(), squares, self._rows.values(state)
        return np.concatenate(parts)

    def jacobian(self, w: FloatArray) -> sparse.csc_array:
        """∂c/∂w (m, n)."""
        state, u = self._state(w), self._forces(w)
        each = 2 * self._intervals
        ones, h = np.ones(2 * each), state.h
        values = (
            -ones,
            ones,
            np.full(2 * each, -0.5 * h),
            np.full(each, -h),
            -_means(state.v).ravel() / self._intervals,
            -u.ravel() / self._intervals,
            2.0 * u.ravel(),
            self._rows.jacobian(state) * self._time_shares[0],
        )
        return self._jacobian.matrix(np.concatenate(values))

    def hessian(self, w: FloatArray, factor: float, multipliers: FloatArray) -> sparse.csc_array:
        """∇²(factor T + multipliers·c) (n, n)."""
        intervals = self._intervals
        moved, sped, bound, avoid = np.split(
            multipliers, [2 * intervals, 4 * intervals, self._driven]
        )
        pull = -0.5 * moved / intervals
        own = self._rows.hessian(self._state(w), avoid) * self._time_shares[1]
        lower = np.concatenate([pull, pull, -sped / intervals, np.repeat(2.0 * bound, 2), own])
        return self._hessian.matrix(np.concatenate([lower, lower[self._mirrored]]))

    def _state(self, w: FloatArray) -> State:
        nodes = w[1:].reshape(self.nodes, STRIDE)
        q, v = nodes[:, :2], nodes[:, 2:4]
        return State(float(w[0]) / self._intervals, q, v, q - self.scene.centres[:, None])

    def _forces(self, w: FloatArray) -> FloatArray:
        return w[1:].reshape(self.nodes, STRIDE)[:-1, 4:]

    # --------------------------------------------------------------------------- patterns

    def _jacobian_entries(self) -> MatrixEntries:
        first = np.arange(self._intervals)
        each = 2 * self._intervals
        moved, sped = np.arange(each), each + np.arange(each)
        bounded = 2 * each + np.repeat(first, 2)
        here = [columns(first, part).ravel() for part in range(3)]
        after = [columns(first + 1, part).ravel() for part in range(3)]
        rows, places = self._rows.jacobian_places
        parts = (
            (moved, here[0]),
            (sped, here[1]),
            (moved, after[0]),
            (sped, after[1]),
            (moved, here[1]),
            (moved, after[1]),
            (sped, here[2]),
            (moved, 0 * moved),
            (sped, 0 * sped),
            (bounded, here[2]),
            (self._driven + rows, places),
        )
        return _entries(parts, (self.m, self.n))

    def _hessian_entries(self) -> MatrixEntries:
        first = np.arange(self._intervals)
        speeds, forces = columns(first, 1).ravel(), columns(first, 2).ravel()
        after = columns(first + 1, 1).ravel()
        parts = (
            (speeds, 0 * speeds),
            (after, 0 * after),
            (forces, 0 * forces),
            (forces, forces),
            self._rows.hessian_places,
        )
        rows, places = (np.concatenate(side) for side in zip(*parts, strict=True))
        self._mirrored = np.flatnonzero(rows != places)
        both = (rows, places), (places[self._mirrored], rows[self._mirrored])
        return _entries(both, (self.n, self.n))

    def _shares_of_time(self) -> tuple[FloatArray, FloatArray]:
        """What makes the avoidance rows' derivatives by h derivatives by T: ∂h/∂T = 1/(N − 1)."""
        (_, by), (first, second) = self._rows.jacobian_places, self._rows.hessian_places
        share = 1.0 / self._intervals
        times = (first == 0).astype(int) + (second == 0)
        return np.where(by == 0, share, 1.0), share**times


def _means(v: FloatArray) -> FloatArray:
    """Mean speed of each interval (N − 1, 2)."""
    return 0.5 * (v[:-1] + v[1:])


def _entries(parts: Sequence[tuple[IntArray, IntArray]], shape: tuple[int, int]) -> MatrixEntries:
    rows, places = (np.concatenate(side) for side in zip(*parts, strict=True))
    return MatrixEntries(rows, places, shape)
