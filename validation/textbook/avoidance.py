"""How the point mass keeps away from circles: three kinds of constraint rows.

With p the place relative to a circle's centre, h the length of an interval and r the radius:

- `Samples` (the thesis): |p|² ≥ r² at every node. Nothing holds in between.
- `Chords`: |p|² ≥ (r + u_max h²/8)² + ℓ²/4 at both ends of every interval, ℓ its chord. A chord
  whose ends are at the distance D stays √(D² − ℓ²/4) away, and the motion stays within |u| h²/8 of
  its chord.
- `Bernstein`: |p(s)|² − r² along an interval is a polynomial of degree four in s = t/h, which is
  ≥ 0 on [0, 1] if its Bernstein coefficients are. They are, with p₁ = p₀ + h v₀/2,
      |p₀|² − r²,   p₀·p₁ − r²,   (2|p₁|² + p₀·p₂)/3 − r²,   p₁·p₂ − r²,   |p₂|² − r².
  The second and the fourth are |p|² ± (h/2) p·v − r² at the interval's two ends. Every node has
  one of each sign, which imply |p|² ≥ r² there; the first and the last are given, and at rest.

`Bernstein` gives nothing away where the mass hugs a circle at the speed that its force can hold,
where `Chords` gives away u_max h²/4; on a straight tangent it gives away about h²v²/24r, `Chords`
u_max h²/8.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Protocol

import numpy as np

from ...core.arrays import FloatArray, IntArray

Places = tuple[IntArray, IntArray]

STRIDE = 6
"""Variables of a node: x, y, their speeds and their forces; the time comes before all nodes."""


@dataclass(frozen=True, slots=True, eq=False)
class State:
    """A point mass's variables.

    Args:
        h: length of an interval.
        q, v: (N, 2) places and speeds.
        p: (K, N, 2) places relative to the circles' centres.
    """

    h: float
    q: FloatArray
    v: FloatArray
    p: FloatArray


class AvoidanceRows(Protocol):
    """Rows c ≥ r². Derivatives with respect to h stand in column 0, which is not yet that of T.

    Attributes:
        count: of rows.
        floor: (count,) what they must not fall below.
        jacobian_places: rows and columns (k,) of `jacobian`'s values.
        hessian_places: of `hessian`'s values; of each entry off the diagonal one of the two.
    """

    count: int
    floor: FloatArray
    jacobian_places: Places
    hessian_places: Places

    def values(self, state: State) -> FloatArray:
        """c (count,)."""
        ...

    def jacobian(self, state: State) -> FloatArray:
        """Entries (k,)."""
        ...

    def hessian(self, state: State, multipliers: FloatArray) -> FloatArray:
        """Entries (k,) of ∇²(multipliers·c)."""
        ...


def columns(nodes: IntArray, part: int) -> IntArray:
    """Columns (k, 2) of the nodes' places (part 0), speeds (1) or forces (2)."""
    return np.asarray(1 + STRIDE * nodes[:, None] + 2 * part + np.arange(2))


class Samples:
    """|p|² ≥ r² at every node between the first and the last; rows (K, N − 2)."""

    def __init__(self, nodes: int, radii: FloatArray) -> None:
        inner = np.arange(1, nodes - 1)
        circles = len(radii)
        self.count = circles * len(inner)
        self.floor = np.repeat(radii**2, len(inner))
        q = columns(inner, 0)
        self.jacobian_places = _rows_of_two(self.count), np.tile(q.ravel(), circles)
        self.hessian_places = q.ravel(), q.ravel()

    def values(self, state: State) -> FloatArray:
        return _square(state.p[:, 1:-1]).ravel()

    def jacobian(self, state: State) -> FloatArray:
        return 2.0 * state.p[:, 1:-1].ravel()

    def hessian(self, state: State, multipliers: FloatArray) -> FloatArray:
        total = multipliers.reshape(len(state.p), -1).sum(axis=0)
        return np.repeat(2.0 * total, 2)


class Chords:
    """The samples' distance raised by half a chord and the bulge; rows (2, K, N − 1)."""

    def __init__(self, nodes: int, radii: FloatArray, force: float) -> None:
        first = np.arange(nodes - 1)
        circles = len(radii)
        self._radii, self._bulge = radii[:, None], force / 8.0
        self.count = 2 * circles * len(first)
        self.floor = np.zeros(self.count)
        near, far = columns(first, 0).ravel(), columns(first + 1, 0).ravel()
        rows = _rows_of_two(self.count)
        self.jacobian_places = (
            np.concatenate([rows, rows, np.arange(self.count)]),
            np.concatenate(
                [
                    np.tile(near, 2 * circles),
                    np.tile(far, 2 * circles),
                    np.zeros(self.count, dtype=np.int64),
                ]
            ),
        )
        self.hessian_places = (
            np.concatenate([near, far, far, [0]]),
            np.concatenate([near, near, far, [0]]),
        )

    def values(self, state: State) -> FloatArray:
        square = _square(state.p)
        chord = _square(np.diff(state.q, axis=0)) / 4.0
        taken = chord + (self._radii + self._bulge * state.h**2) ** 2
        return np.concatenate([(square[:, :-1] - taken).ravel(), (square[:, 1:] - taken).ravel()])

    def jacobian(self, state: State) -> FloatArray:
        half = np.broadcast_to(np.diff(state.q, axis=0) / 2.0, state.p[:, 1:].shape)
        b, h = self._bulge, state.h
        slope = -4.0 * b * h * (self._radii + b * h * h)
        by_h = np.broadcast_to(slope, half.shape[:2])
        near = half + 2.0 * state.p[:, :-1], half
        far = -half, 2.0 * state.p[:, 1:] - half
        return np.concatenate([a.ravel() for a in (*near, *far, by_h, by_h)])

    def hessian(self, state: State, multipliers: FloatArray) -> FloatArray:
        split = multipliers.reshape(2, len(state.p), -1)
        near, far = split.sum(axis=1)
        both = 0.5 * (near + far)
        blocks = np.concatenate([2.0 * near - both, both, 2.0 * far - both])
        b, h = self._bulge, state.h
        weights = split.sum(axis=(0, 2))
        by_h = float(weights @ (-4.0 * b * (self._radii[:, 0] + 3.0 * b * h * h)))
        return np.append(np.repeat(blocks, 2), by_h)


class Bernstein:
    """Bernstein coefficients; rows (K, N − 2) leaving nodes, as many reaching them, and (K, N − 1)
    of the middle coefficient."""

    def __init__(self, nodes: int, radii: FloatArray) -> None:
        inner, first = np.arange(1, nodes - 1), np.arange(nodes - 1)
        k = len(radii)
        self._at_nodes, self._middle = k * len(inner), k * len(first)
        self.count = 2 * self._at_nodes + self._middle
        self.floor = np.concatenate(
            [np.tile(np.repeat(radii**2, len(inner)), 2), np.repeat(radii**2, len(first))]
        )
        q, v = columns(inner, 0).ravel(), columns(inner, 1).ravel()
        q0, v0 = columns(first, 0).ravel(), columns(first, 1).ravel()
        q2 = columns(first + 1, 0).ravel()
        node, middle = np.arange(2 * self._at_nodes), np.arange(2 * self._at_nodes, self.count)
        self.jacobian_places = (
            np.concatenate([*2 * [np.repeat(node, 2)], node, *3 * [np.repeat(middle, 2)], middle]),
            np.concatenate(
                [
                    np.tile(q, 2 * k),
                    np.tile(v, 2 * k),
                    np.zeros(len(node), dtype=np.int64),
                    np.tile(q0, k),
                    np.tile(v0, k),
                    np.tile(q2, k),
                    np.zeros(len(middle), dtype=np.int64),
                ]
            ),
        )
        time, time_first = np.zeros_like(q), np.zeros_like(q0)
        self.hessian_places = (
            np.concatenate([q, v, q, v, q0, v0, q2, v0, q0, v0, [0]]),
            np.concatenate([q, q, time, time, q0, q0, q0, v0, time_first, time_first, [0]]),
        )

    def values(self, state: State) -> FloatArray:
        h, p, v = state.h, state.p, state.v
        square = _square(p[:, 1:-1])
        swing = 0.5 * h * np.einsum("knd,nd->kn", p[:, 1:-1], v[1:-1])
        p0, p1, p2 = p[:, :-1], p[:, :-1] + 0.5 * h * v[:-1], p[:, 1:]
        middle = (2.0 * _square(p1) + np.einsum("knd,knd->kn", p0, p2)) / 3.0
        return np.concatenate([a.ravel() for a in (square + swing, square - swing, middle)])

    def jacobian(self, state: State) -> FloatArray:
        h, p, v = state.h, state.p[:, 1:-1], state.v[1:-1]
        turn = np.broadcast_to(0.5 * h * v, p.shape)
        swing = 0.5 * np.einsum("knd,nd->kn", p, v)
        p0, p2, v0 = state.p[:, :-1], state.p[:, 1:], state.v[:-1]
        p1 = p0 + 0.5 * h * v0
        parts = (
            2.0 * p + turn,
            2.0 * p - turn,
            0.5 * h * p,
            -0.5 * h * p,
            swing,
            -swing,
            (4.0 * p1 + p2) / 3.0,
            (2.0 * h / 3.0) * p1,
            p0 / 3.0,
            (2.0 / 3.0) * np.einsum("knd,nd->kn", p1, v0),
        )
        return np.concatenate([a.ravel() for a in parts])

    def hessian(self, state: State, multipliers: FloatArray) -> FloatArray:
        h, k = state.h, len(state.p)
        at_nodes, middle = np.split(multipliers, [2 * self._at_nodes])
        leaving, reaching = at_nodes.reshape(2, k, -1)
        middle = middle.reshape(k, -1)
        both, apart = (leaving + reaching).sum(axis=0), (leaving - reaching).sum(axis=0)
        pull = np.einsum("kn,knd->nd", leaving - reaching, state.p[:, 1:-1])
        v, v0 = state.v[1:-1], state.v[:-1]
        total = middle.sum(axis=0)
        pull0 = np.einsum("kn,knd->nd", middle, state.p[:, :-1])
        parts = (
            np.repeat(2.0 * both, 2),
            np.repeat(0.5 * h * apart, 2),
            0.5 * apart[:, None] * v,
            0.5 * pull,
            np.repeat(4.0 / 3.0 * total, 2),
            np.repeat(2.0 * h / 3.0 * total, 2),
            np.repeat(total / 3.0, 2),
            np.repeat(h * h / 3.0 * total, 2),
            2.0 / 3.0 * total[:, None] * v0,
            2.0 / 3.0 * (pull0 + h * total[:, None] * v0),
            np.array([total @ _square(v0) / 3.0]),
        )
        return np.concatenate([a.ravel() for a in parts])


def _square(p: FloatArray) -> FloatArray:
    """|p|² along the last axis."""
    return np.asarray(np.einsum("...d,...d->...", p, p))


def _rows_of_two(count: int) -> IntArray:
    return np.repeat(np.arange(count), 2)
