"""Who traces the rays: Intel's Embree where the package ``embreex`` is installed, else the tree.

Both answer alike up to rounding: Embree finds the triangle in single precision, and the point on
it is worked out again in double.
"""

from __future__ import annotations

import importlib.util
from enum import StrEnum

from .....core.arrays import FloatArray, IntArray
from .....core.errors import InputError
from .bvh import BvhRays
from .rays import Rays


class RayEngine(StrEnum):
    """Who traces the rays."""

    AUTO = "auto"
    """Embree where it is installed, else the tree."""
    EMBREE = "embree"
    TREE = "tree"


def make_rays(vertices: FloatArray, faces: IntArray, engine: RayEngine = RayEngine.AUTO) -> Rays:
    """Queries on a mesh.

    Args:
        vertices: (V, 3) m.
        faces: (F, 3).
        engine: see `RayEngine`.

    Raises:
        InputError: there is no triangle, or Embree is asked for and not installed.
    """
    installed = importlib.util.find_spec("embreex") is not None
    if engine is RayEngine.EMBREE and not installed:
        raise InputError("the ray engine 'embree' needs the package embreex: pip install embreex")
    if engine is RayEngine.TREE or not installed:
        return BvhRays(vertices, faces)
    from .embree import EmbreeRays

    return EmbreeRays(vertices, faces)
