"""Convex solids made smaller all round."""

from __future__ import annotations

import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as st

from flyby.core.collision.distance.shrinking import shrink
from flyby.core.collision.scene.bodies import Body, BodyKind
from flyby.core.collision.scene.outline import outlines_of, support
from flyby.core.spatial.pose import IDENTITY

from .conftest import boxes, capsules, cylinders, polytopes, spheres

solids = st.one_of(spheres, capsules, cylinders, boxes, polytopes())


def supports(solid, ways: np.ndarray) -> np.ndarray:
    outlines = outlines_of([Body("", "", "", BodyKind.PART, 0, solid, IDENTITY)])
    R, p = np.eye(3), np.zeros(3)
    return np.array([support(outlines, 0, R, p, tuple(map(float, way))) for way in ways])


@settings(max_examples=60)
@given(solids, st.floats(1e-4, 0.03), st.integers(0, 10**6))
def test_what_is_left_lies_inside_and_no_deeper_than_said_where_it_is_thick(
    solid, by, seed
) -> None:
    ways = np.random.default_rng(seed).normal(size=(40, 3))
    ways /= np.linalg.norm(ways, axis=1, keepdims=True)
    taken = supports(solid, ways) - supports(shrink(solid, by), ways)
    assert (taken > 0.0).all()
    # Along some way it is no more than was asked for; at corners it is.
    axes = np.vstack([np.eye(3), -np.eye(3)])
    if not hasattr(solid, "vertices"):
        least = supports(solid, axes) - supports(shrink(solid, by), axes)
        assert least.min() <= by + 1e-12
    assert supports(shrink(solid, by), axes).max() > -1.0
