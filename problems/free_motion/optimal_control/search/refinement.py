"""Grids made finer, and limits made narrower, where a motion exceeds them between nodes."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from .....core.arrays import FloatArray, IntArray
from ..motion.audit import Audit
from ..motion.first_guess import Guess, breaks_of
from ..motion.layout import VariableLayout
from ..motion.motion import Motion
from ..task.task import MotionTask
from ..transcription.transcription import Margins

SPLIT = 5e-3
"""Share of a limit beyond which an interval is cut in two instead of given a margin."""
_AIM = 0.3
"""Share of the tolerance that margins aim at."""


@dataclass(frozen=True)
class PieceMargins:
    """What is left of limits on each interval.

    Args:
        torque: (K, R) shares.
        tcp_speed: (K,) shares.
        position: (K, n) rad or m.
    """

    torque: FloatArray
    tcp_speed: FloatArray
    position: FloatArray

    @classmethod
    def none(cls, audit: Audit) -> PieceMargins:
        """No margins, of the shapes of an audit."""
        return cls(0 * audit.torque, 0 * audit.tcp_speed, 0 * audit.beyond)

    def raised(self, audit: Audit, tolerance: float) -> PieceMargins:
        """More where limits are exceeded."""

        def more(own: FloatArray, excess: FloatArray) -> FloatArray:
            return np.where(excess > tolerance, own + excess - _AIM * tolerance, own)

        return PieceMargins(
            more(self.torque, audit.torque - 1.0),
            more(self.tcp_speed, audit.tcp_speed - 1.0),
            np.where(audit.beyond > 1e-6, self.position + audit.beyond, self.position),
        )

    def split(self, parts: IntArray) -> PieceMargins:
        """For intervals cut into parts (K,)."""
        fields = (self.torque, self.tcp_speed, self.position)
        return PieceMargins(*(np.repeat(field, parts, axis=0) for field in fields))

    def at_samples(self, layout: VariableLayout) -> Margins:
        """The larger of both neighbours'."""
        interval, sample, _ = layout.quadrature
        torque = np.zeros((len(layout.samples), self.torque.shape[1]))
        speed = np.zeros(len(layout.samples))
        np.maximum.at(torque, sample, self.torque[interval])
        np.maximum.at(speed, sample, self.tcp_speed[interval])
        position = np.zeros((layout.points, layout.joints))
        for step in range(layout.scheme.steps + 1):
            np.maximum.at(position, layout.first + step, self.position)
        return Margins(torque, speed, position)


def too_coarse(audit: Audit) -> NDArray[np.bool_]:
    """(K,), intervals to be cut in two."""
    torque = audit.torque.max(axis=1, initial=0.0)
    return np.asarray((torque > 1.0 + SPLIT) | (audit.tcp_speed > 1.0 + SPLIT))


def refined(task: MotionTask, guess: Guess, parts: IntArray) -> Guess:
    """The same motion on a grid whose intervals are cut into ``parts`` (K,)."""
    layout = guess.layout
    x = guess.x
    stretch = x[1 + np.arange(layout.stretches)] if layout.stretches else np.ones(1)
    grid = layout.grid.stretched(stretch).split(parts)
    finer = replace(layout, grid=grid, breaks=breaks_of(task, grid.leg))
    return represented(guess.motion, finer, guess.scale, float(x[0]), parts)


def represented(
    motion: Motion, layout: VariableLayout, scale: float, S: float, parts: IntArray
) -> Guess:
    """A motion of the layout's scheme on intervals that its pieces are cut into."""
    x = np.zeros(layout.size)
    x[0] = S
    x[1 : 1 + layout.stretches] = 1.0
    piece = np.repeat(np.arange(len(motion)), parts)
    inside = np.arange(len(piece)) - np.repeat(np.cumsum(parts) - parts, parts)
    time = scale * np.sqrt(S)
    scheme = layout.scheme

    def put(places: IntArray, share: float, order: int) -> None:
        u = (inside + share) / parts[piece]
        coefficients = motion.differentiated(order)[piece]
        powers = u[:, None] ** np.arange(coefficients.shape[1])
        x[places] = np.einsum("kc,kcn->kn", powers, coefficients) * time**order

    for step in range(scheme.steps + 1):
        put(layout.q[layout.first + step], step / scheme.steps, 0)
        put(layout.d[layout.first + step], step / scheme.steps, 1)
    for i, share in enumerate(scheme.shares):
        put(layout.e[layout.rise[:, i]], float(share), 2)
    return Guess(layout, scale, x)
