"""Parts made round a mesh enclose its surface, whatever parts were given."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
import trimesh
from hypothesis import assume, given, settings
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays
from scipy.spatial import ConvexHull

from flyby.core.convex import decomposition
from flyby.core.convex import split as splitting
from flyby.core.convex.cover import cover
from flyby.core.convex.decomposition import NotSplitError, approximate_parts
from flyby.core.convex.split import HOLLOW, hull_volume, split

OUTLINE = np.array([(0, 0), (3, 0), (3, 3), (2, 3), (2, 1), (1, 1), (1, 3), (0, 3)], float)
CAPS = [(0, 1, 4), (0, 4, 5), (1, 2, 3), (1, 3, 4), (0, 5, 6), (0, 6, 7)]


def u_shape() -> tuple[np.ndarray, np.ndarray]:
    """A U of 0.3 x 0.3 x 0.1 m, two legs of 0.1 m beside a gap of 0.1 m."""
    n = len(OUTLINE)
    vertices = 0.1 * np.vstack([np.c_[OUTLINE, np.zeros(n)], np.c_[OUTLINE, np.ones(n)]])
    faces = [(a, c, b) for a, b, c in CAPS] + [(a + n, b + n, c + n) for a, b, c in CAPS]
    for i in range(n):
        j = (i + 1) % n
        faces += [(i, j, j + n), (i, j + n, i + n)]
    return vertices, np.array(faces)


def boxes(*spans: tuple[tuple[float, float], ...]) -> list[np.ndarray]:
    return [np.array(np.meshgrid(*span)).reshape(3, 8).T for span in spans]


IN_U = boxes(
    ((0.0, 0.3), (0.0, 0.1), (0.0, 0.1)),
    ((0.0, 0.1), (0.1, 0.3), (0.0, 0.1)),
    ((0.2, 0.3), (0.1, 0.3), (0.0, 0.1)),
)
"""Three boxes of which the U is made."""


def beyond(points: np.ndarray, parts: list[np.ndarray]) -> float:
    """How far the worst of points (K, 3) is out of the union of the hulls of parts."""
    planes = [ConvexHull(part).equations for part in parts]
    out = [(points @ one[:, :3].T + one[:, 3]).max(axis=1) for one in planes]
    return float(np.min(out, axis=0).max())


def sampled(vertices: np.ndarray, faces: np.ndarray, seed: int) -> np.ndarray:
    """Points on a surface, corners among them."""
    weights = np.random.default_rng(seed).dirichlet(np.ones(3), (len(faces), 20))
    inside = np.einsum("fkc,fcx->fkx", weights, vertices[faces]).reshape(-1, 3)
    return np.concatenate([vertices[np.unique(faces)], inside])


CORNERS = arrays(float, st.tuples(st.integers(4, 12), st.just(3)), elements=st.floats(-1, 1))


@settings(deadline=None, max_examples=60)
@given(st.data(), CORNERS, st.lists(CORNERS, min_size=1, max_size=4), st.integers(0, 99))
def test_each_point_of_the_surface_is_in_a_part(
    data: st.DataObject, vertices: np.ndarray, parts: list[np.ndarray], seed: int
) -> None:
    assume(np.ptp(vertices, axis=0).max() > 0.1)
    count = data.draw(st.integers(1, 8))
    index = st.integers(0, len(vertices) - 1)
    faces = data.draw(arrays(np.int64, (count, 3), elements=index))
    made = cover(vertices, faces, parts)
    if all(hull_volume(part) == 0.0 for part in parts):
        assert made == []
    if made:
        assert beyond(sampled(vertices, faces, seed), made) < 1e-9


@settings(deadline=None, max_examples=25)
@given(st.floats(0.0, 0.03), st.integers(0, 99))
def test_parts_that_are_too_small_grow_little(shrunk: float, seed: int) -> None:
    vertices, faces = u_shape()
    parts = [part + (part.mean(axis=0) - part) * shrunk for part in IN_U]
    made = cover(vertices, faces, parts)
    assert beyond(sampled(vertices, faces, seed), made) < 1e-12
    assert sum(map(hull_volume, made)) < 0.0079
    # The gap between the legs stays free.
    gap = np.array([[0.15, y, 0.05] for y in np.linspace(0.12, 0.3, 10)])
    planes = [ConvexHull(part).equations for part in made]
    out = np.min([(gap @ p[:, :3].T + p[:, 3]).max(axis=1) for p in planes], axis=0)
    assert out.min() > 0.01


@pytest.fixture
def given_parts(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(splitting, "approximate_parts", lambda vertices, faces: IN_U)


@pytest.mark.usefixtures("given_parts")
def test_only_what_is_far_from_convex_is_split() -> None:
    assert len(split(*u_shape()).parts) == 3
    box: Any = trimesh.creation.box((0.3, 0.2, 0.1))
    whole = split(np.asarray(box.vertices), np.asarray(box.faces))
    assert len(whole.parts) == 1
    assert whole.lacks is None
    sheet = split(np.eye(3), np.array([[0, 1, 2]]))
    assert len(sheet.parts) == 1


def test_parts_that_save_nothing_are_not_taken(monkeypatch: pytest.MonkeyPatch) -> None:
    whole = boxes(((0.0, 0.3), (0.0, 0.3), (0.0, 0.1)))
    monkeypatch.setattr(splitting, "approximate_parts", lambda vertices, faces: whole)
    made = split(*u_shape())
    assert len(made.parts) == 1
    assert made.lacks is None
    assert hull_volume(whole[0]) > (1 - HOLLOW) * 0.009


def test_without_the_library_the_hull_stays_and_the_remedy_is_told(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    def missing(name: str) -> str:
        raise decomposition.PackageNotFoundError(name)

    monkeypatch.setattr(decomposition, "version", missing)
    made = split(*u_shape())
    assert len(made.parts) == 1
    assert made.lacks == (
        "its convex hull has 1.29 times its volume; pip install 'flyby[shapes]' adds what splits "
        "it into convex parts"
    )


def test_parts_are_kept_and_damaged_ones_are_made_anew(
    monkeypatch: pytest.MonkeyPatch, tmp_path: Any
) -> None:
    asked = []

    def ask(vertices: np.ndarray, faces: np.ndarray) -> bytes:
        import io

        asked.append(len(faces))
        buffer = io.BytesIO()
        np.savez(buffer, points=np.concatenate(IN_U), counts=np.array([8, 8, 8]))
        return buffer.getvalue()

    monkeypatch.setattr(decomposition, "version", lambda name: "1")
    monkeypatch.setattr(decomposition, "cache_folder", lambda: tmp_path / "kept")
    monkeypatch.setattr(decomposition, "_asked", ask)
    for _ in range(2):
        np.testing.assert_array_equal(approximate_parts(*u_shape()), IN_U)
    assert len(asked) == 1
    (file,) = (tmp_path / "kept").glob("*.npz")
    file.write_bytes(file.read_bytes()[:-30])
    np.testing.assert_array_equal(approximate_parts(*u_shape()), IN_U)
    assert len(asked) == 2
    # Where nothing can be kept it works all the same.
    (tmp_path / "file").write_text("")
    monkeypatch.setattr(decomposition, "cache_folder", lambda: tmp_path / "file")
    np.testing.assert_array_equal(approximate_parts(*u_shape()), IN_U)


def test_a_library_that_fails_is_told(monkeypatch: pytest.MonkeyPatch, tmp_path: Any) -> None:
    monkeypatch.setattr(decomposition, "version", lambda name: "1")
    monkeypatch.setattr(decomposition, "cache_folder", lambda: tmp_path)
    monkeypatch.setattr(decomposition, "_asked", lambda vertices, faces: b"nonsense")
    with pytest.raises(NotSplitError, match="CoACD cannot split it"):
        approximate_parts(*u_shape())
    monkeypatch.setattr(decomposition, "MOST_TRIANGLES", 3)
    with pytest.raises(NotSplitError, match="make it coarser"):
        approximate_parts(*u_shape())


def test_coacd_splits_a_u(monkeypatch: pytest.MonkeyPatch, tmp_path: Any) -> None:
    pytest.importorskip("coacd")
    monkeypatch.setattr(decomposition, "cache_folder", lambda: tmp_path)
    vertices, faces = u_shape()
    made = split(vertices, faces)
    assert made.lacks is None
    assert 3 <= len(made.parts) <= decomposition.MOST_PARTS
    assert sum(map(hull_volume, made.parts)) < 0.0072
    assert beyond(sampled(vertices, faces, 1), list(made.parts)) < 1e-12
