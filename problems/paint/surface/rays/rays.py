"""Rays against a part's triangles: what they meet first, what lies between, what is nearest."""

from __future__ import annotations

import math
from abc import ABC, abstractmethod
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from .....core.arrays import FloatArray, IntArray
from .....core.errors import InputError


class Hits(NamedTuple):
    """What rays meet first.

    Args:
        face: (N,) index of the triangle; -1 where there is none.
        distance: (N,) m along the ray, negative behind its origin; inf where there is none.
        point: (N, 3) m, NaN where there is none.
    """

    face: IntArray
    distance: FloatArray
    point: FloatArray

    @property
    def found(self) -> NDArray[np.bool_]:
        """(N,) whether there is any."""
        return self.face >= 0


class NearestPoints(NamedTuple):
    """The mesh's points nearest to given ones.

    Args:
        face: (N,) index of the triangle.
        distance: (N,) m.
        point: (N, 3) m.
    """

    face: IntArray
    distance: FloatArray
    point: FloatArray


class Rays(ABC):
    """Queries on one mesh.

    Args:
        vertices: (V, 3) m.
        faces: (F, 3).

    Raises:
        InputError: there is no triangle.
    """

    def __init__(self, vertices: FloatArray, faces: IntArray) -> None:
        self.vertices = np.ascontiguousarray(vertices, dtype=float)
        self.faces = np.ascontiguousarray(faces, dtype=np.int64)
        if len(self.faces) == 0:
            raise InputError("rays need a surface: the mesh has no triangles")

    def first(self, origins: FloatArray, directions: FloatArray, far: float = math.inf) -> Hits:
        """What rays from origins (N, 3) along unit directions (N, 3) meet first, within far m."""
        origins, directions = _rays(origins, directions)
        face, distance = self._first(origins, directions, far)
        return _hits(origins, directions, face, distance)

    def blocked(
        self, origins: FloatArray, targets: FloatArray, gap: float = 1e-6
    ) -> NDArray[np.bool_]:
        """Whether anything lies between origins and targets (N, 3).

        Args:
            origins, targets: (N, 3) m.
            gap: m next to the target where nothing counts, as the target lies on the mesh itself.
        """
        origins, targets = np.broadcast_arrays(np.atleast_2d(origins), np.atleast_2d(targets))
        ways = targets - origins
        length = np.linalg.norm(ways, axis=1)
        # Ways that end at 1: the targets are then at the same parameter on all of them.
        short = length - gap
        scaled = ways * np.where(short > 0.0, short / np.maximum(length, 1e-300), 0.0)[:, None]
        seen = short > 0.0
        result = np.zeros(len(origins), dtype=np.bool_)
        result[seen] = self._any(
            np.ascontiguousarray(origins[seen], dtype=float),
            np.ascontiguousarray(scaled[seen]),
        )
        return result

    def nearest(self, points: FloatArray) -> NearestPoints:
        """The mesh's points nearest to points (N, 3) m."""
        points = np.ascontiguousarray(np.atleast_2d(points), dtype=float)
        face, nearest = self._nearest(points)
        return NearestPoints(face, np.linalg.norm(points - nearest, axis=1), nearest)

    @abstractmethod
    def _first(
        self, origins: FloatArray, directions: FloatArray, far: float
    ) -> tuple[IntArray, FloatArray]:
        """Triangle (-1: none) and distance (inf: none) of what is met first in [0, far) m."""

    @abstractmethod
    def _any(self, origins: FloatArray, ways: FloatArray) -> NDArray[np.bool_]:
        """Whether anything is met between origins and origins + ways."""

    @abstractmethod
    def _nearest(self, points: FloatArray) -> tuple[IntArray, FloatArray]:
        """Triangle and point of the mesh nearest to each point."""


def _rays(origins: FloatArray, directions: FloatArray) -> tuple[FloatArray, FloatArray]:
    origins, directions = np.broadcast_arrays(np.atleast_2d(origins), np.atleast_2d(directions))
    return (
        np.ascontiguousarray(origins, dtype=float),
        np.ascontiguousarray(directions, dtype=float),
    )


def _hits(
    origins: FloatArray, directions: FloatArray, face: IntArray, distance: FloatArray
) -> Hits:
    found = face >= 0
    reach = np.where(found, distance, np.nan)
    return Hits(face, np.where(found, distance, np.inf), origins + reach[:, None] * directions)
