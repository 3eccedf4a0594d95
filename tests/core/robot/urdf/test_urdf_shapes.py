"""Shapes of links from a URDF's geometry enclose what they stand for."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
import trimesh
from hypothesis import given, settings
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays

from flyby.core.robot.mesh_shapes import enclosing
from flyby.core.robot.shape import Box, Cylinder, Sphere
from flyby.core.robot.urdf.arm import load_urdf
from flyby.core.spatial.pose import Pose

POINTS = arrays(float, st.tuples(st.integers(1, 30), st.just(3)), elements=st.floats(-1, 1))


def holds(shape: object, placement: Pose, points: np.ndarray) -> bool:
    """Whether a body holds all points, to a hundredth of a millimetre."""
    matrix = placement.matrix()
    local = (points - matrix[:3, 3]) @ matrix[:3, :3]
    if isinstance(shape, Box):
        return bool((np.abs(local) <= 0.5 * np.array(shape.size) + 1e-5).all())
    if isinstance(shape, Sphere):
        return bool((np.linalg.norm(local, axis=1) <= shape.radius + 1e-5).all())
    assert isinstance(shape, Cylinder)
    inside = np.linalg.norm(local[:, :2], axis=1) <= shape.radius + 1e-5
    return bool((inside & (np.abs(local[:, 2]) <= 0.5 * shape.length + 1e-5)).all())


@settings(deadline=None)
@given(POINTS)
def test_bodies_enclose_their_points(points: np.ndarray) -> None:
    assert holds(*enclosing(points), points)


@pytest.mark.parametrize(
    ("mesh", "kind"),
    [
        (trimesh.creation.box((0.1, 0.2, 0.5)), Box),
        (trimesh.creation.cylinder(0.1, 0.5), Cylinder),
        (trimesh.creation.icosphere(3, 0.2), Sphere),
    ],
)
def test_the_closest_kind_of_body_is_taken(mesh: trimesh.Trimesh, kind: type) -> None:
    turned = mesh.copy().apply_transform(
        trimesh.transformations.rotation_matrix(0.7, [1.0, 2.0, 3.0])
    )
    shape, placement = enclosing(np.asarray(turned.vertices))
    assert isinstance(shape, kind)
    assert holds(shape, placement, np.asarray(turned.vertices))


ARM = """<robot name="arm">
<link name="base_link"><collision><origin xyz="0 0 0.1"/>
  <geometry><cylinder radius="0.1" length="0.2"/></geometry></collision></link>
<link name="base"/>
<joint name="b" type="fixed"><parent link="base_link"/><child link="base"/>
  <origin xyz="0 0 -0.5" rpy="0 0 3.141592653589793"/></joint>
<link name="l1"><collision><origin xyz="0 0 0.2" rpy="0 1.5707963 0"/>
  <geometry>{geometry}</geometry></collision></link>
<joint name="j1" type="revolute"><parent link="base_link"/><child link="l1"/><origin xyz="0 0 0.2"/>
  <axis xyz="0 0 1"/><limit lower="-3" upper="3" velocity="2" effort="0"/></joint>
<link name="l2"><visual><geometry><box size="0.1 0.1 0.4"/></geometry></visual></link>
<joint name="j2" type="revolute"><parent link="l1"/><child link="l2"/><origin xyz="0 0 0.4"/>
  <axis xyz="0 1 0"/><limit lower="-2" upper="2" velocity="2" effort="0"/></joint>
<link name="plate"><collision><geometry><sphere radius="0.05"/></geometry></collision></link>
<joint name="p" type="fixed"><parent link="l2"/><child link="plate"/><origin xyz="0 0 0.3"/></joint>
<link name="tool0"/>
<joint name="t" type="fixed"><parent link="plate"/><child link="tool0"/>
  <origin xyz="0 0 0.1"/></joint>
</robot>
"""


@pytest.fixture
def arm(tmp_path: Path) -> Callable[[str], Path]:
    def write(geometry: str) -> Path:
        folder = tmp_path / "my_robot" / "urdf"
        folder.mkdir(parents=True, exist_ok=True)
        path = folder / "arm.urdf"
        path.write_text(ARM.format(geometry=geometry), "utf-8")
        return path

    return write


def test_shapes_stand_where_the_file_puts_them(arm: Callable[[str], Path]) -> None:
    robot = load_urdf(arm('<box size="0.2 0.1 0.3"/>'))
    found = {(shape.link, type(shape.shape).__name__): shape for shape in robot.shapes}
    assert found.keys() == {(0, "Cylinder"), (1, "Box"), (2, "Box"), (2, "Sphere")}
    # The controller's frame is half a metre below the root's.
    np.testing.assert_allclose(found[0, "Cylinder"].placement.position, (0, 0, 0.6), atol=1e-12)
    np.testing.assert_allclose(found[1, "Box"].placement.position, (0, 0, 0.2), atol=1e-12)
    np.testing.assert_allclose(found[2, "Sphere"].placement.position, (0, 0, 0.3), atol=1e-12)
    assert robot.origins["shape"].startswith("computed: bodies that enclose")


def mesh_at(path: Path) -> trimesh.Trimesh:
    mesh = trimesh.creation.cone(100.0, 400.0)
    path.parent.mkdir(parents=True, exist_ok=True)
    mesh.export(path)
    return mesh


@pytest.mark.parametrize(
    ("name", "place"),
    [
        ("package://my_robot/meshes/l1.stl", "my_robot/meshes/l1.stl"),
        ("package://elsewhere/meshes/l1.stl", "my_robot/meshes/l1.stl"),
        ("l1.stl", "my_robot/urdf/l1.stl"),
        ("../meshes/l1.stl", "my_robot/meshes/l1.stl"),
    ],
)
def test_meshes_are_found_and_scaled(
    arm: Callable[[str], Path], tmp_path: Path, name: str, place: str
) -> None:
    mesh = mesh_at(tmp_path / place)
    robot = load_urdf(arm(f'<mesh filename="{name}" scale="0.001 0.001 0.001"/>'))
    (shape,) = (shape for shape in robot.shapes if shape.link == 1)
    corners = 1e-3 * np.asarray(mesh.vertices)
    turned = corners @ np.array([[0, 0, -1], [0, 1, 0], [1, 0, 0]]) + (0, 0, 0.2)
    assert holds(shape.shape, shape.placement, turned)
    volume = np.prod(shape.shape.size)
    assert volume < 3 * np.prod(np.ptp(corners, axis=0))


def test_without_a_mesh_there_are_no_shapes_and_the_robot_says_so(
    arm: Callable[[str], Path],
) -> None:
    robot = load_urdf(arm('<mesh filename="package://my_robot/meshes/none.stl"/>'))
    assert robot.shapes == ()
    assert "none.stl is not beside it" in robot.doubts[0]
    assert robot.origins["shape"].startswith("unknown: ")


@pytest.mark.parametrize("data", [b"", b"solid\n", b"\x00" * 84, b"garbage" * 100])
def test_broken_meshes_are_named(arm: Callable[[str], Path], tmp_path: Path, data: bytes) -> None:
    path = tmp_path / "my_robot" / "urdf" / "l1.stl"
    path.parent.mkdir(parents=True)
    path.write_bytes(data)
    robot = load_urdf(arm('<mesh filename="l1.stl"/>'))
    assert robot.shapes == ()
    assert "l1.stl" in robot.doubts[0]
