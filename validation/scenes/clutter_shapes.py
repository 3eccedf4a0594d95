"""The things of the cluttered scene: pipes, gears, castings and clamps, each of its own seed."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from ...core.arrays import FloatArray
from ...core.cell.geometry import Mesh
from .solids import tube

RINGS, AROUND = 100, 50
"""Points along and around: 10 000 triangles."""


def pipe(name: str, rng: np.random.Generator) -> Mesh:
    """A bent pipe: a Bézier curve of four points, 25 to 40 mm thick, 0.2 to 0.35 m long."""
    length, radius = rng.uniform(0.2, 0.35), rng.uniform(0.0125, 0.02)
    control = np.zeros((4, 3))
    control[:, 2] = np.linspace(-0.5, 0.5, 4) * length
    control[:, :2] = rng.uniform(-0.3, 0.3, (4, 2)) * length
    s = np.linspace(0.0, 1.0, RINGS)[:, None]
    weights = [(1 - s) ** 3, 3 * s * (1 - s) ** 2, 3 * s**2 * (1 - s), s**3]
    curve = sum((w * c for w, c in zip(weights, control, strict=True)), np.zeros((RINGS, 3)))
    return tube(name, swept(curve, circle(radius)))


def gear(name: str, rng: np.random.Generator) -> Mesh:
    """A gear with a hub: 12 to 24 teeth, 0.1 to 0.16 m across, its axis along z."""
    radius, teeth = rng.uniform(0.05, 0.08), int(rng.integers(12, 25))
    # The rim's ring density is the teeth's: points sit at their flanks.
    angle = np.linspace(0.0, 2 * np.pi, AROUND * 2, endpoint=False)
    tooth = 1.0 + 0.06 * np.tanh(4.0 * np.sin(teeth * angle))
    heights = np.concatenate([np.full(5, -0.02), np.linspace(-0.02, 0.02, 25), np.full(20, 0.02)])
    inward = np.concatenate([np.linspace(0.3, 0.9, 5), np.ones(25), np.linspace(0.98, 0.35, 20)])
    heights[40:] += np.linspace(0.0, 0.04, 10)
    rings = np.zeros((len(heights), len(angle), 3))
    toothed = (inward == 1.0)[:, None]
    across = radius * inward[:, None] * np.where(toothed, tooth, 1.0)
    rings[..., 0], rings[..., 1] = across * np.cos(angle), across * np.sin(angle)
    rings[..., 2] = heights[:, None]
    return tube(name, rings)


def casting(name: str, rng: np.random.Generator) -> Mesh:
    """A lumpy ball, 0.09 to 0.2 m across."""
    radius = rng.uniform(0.045, 0.08)
    polar = np.linspace(0.0, np.pi, RINGS + 2)[1:-1, None]
    angle = np.linspace(0.0, 2 * np.pi, AROUND, endpoint=False)
    lumps = np.zeros((RINGS, AROUND))
    for waves in range(1, 6):
        phase = rng.uniform(0.0, 2 * np.pi, 2)
        share = rng.uniform(0.02, 0.12) / waves**0.5
        lumps += share * np.sin(waves * angle + phase[0]) * np.sin(polar) ** waves
        lumps += 0.5 * share * np.cos((waves + 1) * polar + phase[1])
    across = radius * (1.0 + lumps)
    direction = np.stack(
        [
            np.sin(polar) * np.cos(angle),
            np.sin(polar) * np.sin(angle),
            np.broadcast_to(np.cos(polar), (RINGS, AROUND)),
        ],
        axis=-1,
    )
    return tube(name, across[..., None] * direction)


def clamp(name: str, rng: np.random.Generator) -> Mesh:
    """A C-shaped clamp of square bar, 0.13 to 0.22 m high, its mouth along x."""
    radius, bar = rng.uniform(0.045, 0.07), rng.uniform(0.01, 0.02)
    turn = np.linspace(0.25 * np.pi, 1.75 * np.pi, RINGS)
    curve = np.stack(
        [radius * np.cos(turn), np.zeros(RINGS), 1.25 * radius * np.sin(turn)], axis=-1
    )
    return tube(name, swept(curve, rounded_square(bar)))


KINDS: tuple[Callable[[str, np.random.Generator], Mesh], ...] = (pipe, gear, casting, clamp)


def circle(radius: float) -> FloatArray:
    """Points (AROUND, 2) of a circle."""
    angle = np.linspace(0.0, 2 * np.pi, AROUND, endpoint=False)
    return radius * np.stack([np.cos(angle), np.sin(angle)], axis=-1)


def rounded_square(half: float) -> FloatArray:
    """Points (AROUND, 2) of a square with rounded corners (a superellipse of degree 6)."""
    unit = circle(1.0)
    return np.asarray(half * unit / (np.abs(unit) ** 6).sum(axis=1, keepdims=True) ** (1 / 6))


def swept(curve: FloatArray, section: FloatArray) -> FloatArray:
    """Rings (A, B, 3) of a section (B, 2) carried along a curve (A, 3) without twisting."""
    tangent = np.gradient(curve, axis=0)
    tangent /= np.linalg.norm(tangent, axis=1, keepdims=True)
    side = np.cross(tangent[0], np.eye(3)[np.argmin(np.abs(tangent[0]))])
    rings = np.empty((len(curve), len(section), 3))
    for k, (point, ahead) in enumerate(zip(curve, tangent, strict=True)):
        side = side - (side @ ahead) * ahead
        side /= np.linalg.norm(side)
        rings[k] = point + section @ np.stack([side, np.cross(ahead, side)])
    return rings
