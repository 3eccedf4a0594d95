"""Shapes and limits that a cell file has of its own arm."""

from __future__ import annotations

import math
from pathlib import Path

import numpy as np
import pytest
import trimesh

from flyby.core.cell.cell import Cell
from flyby.core.cell.file import load_cell
from flyby.core.collision.scene.scene import CollisionScene
from flyby.core.convex import split
from flyby.core.convex.decomposition import NotSplitError
from flyby.core.errors import InputError
from flyby.core.registry import find_robot, installed
from flyby.core.robot.shape import Capsule
from flyby.core.spatial.pose import Pose

UR = 'robot = "ur/ur10e"\n'
ABB = 'robot = "abb/irb6640-180-255"\n'
REACH = """
[[robot_shape]]
link = "{link}"
kind = "capsule"
radius_mm = 50
from_mm = [{x}, 0, {z}]
to_mm = [{x}, 0, {top}]
"""


def loaded(folder: Path, text: str) -> Cell:
    path = folder / "cell.toml"
    path.write_text(text, "utf-8")
    return load_cell(path, installed())


@pytest.mark.parametrize("name", ["abb/irb6640-180-255", "ur/ur10e"])
def test_shapes_stand_where_they_are_with_all_joints_at_zero(tmp_path: Path, name: str) -> None:
    robot = find_robot(name)
    for k, joint in enumerate(robot.joints):
        text = f'robot = "{name}"\n' + REACH.format(link=joint.name, x=3000, z=500, top=900)
        ball = '[[obstacle]]\nname = "ball"\nsphere_mm = [20]\n'
        ball += "pose = { xyz_mm = [3000, 0, 1000] }\n"
        cell = loaded(tmp_path, text + ball)
        own = [shape for shape in cell.robot.shapes if shape.link == k + 1]
        assert [shape.shape for shape in own] == [Capsule(0.05, 0.4)]
        others = [shape for shape in robot.shapes if shape.link != k + 1]
        assert list(cell.robot.shapes[: len(others)]) == others
        scene = CollisionScene(cell)
        q = np.zeros((1, robot.size))
        names = [{scene.body_names[a], scene.body_names[b]} for a, b in scene.pairs]
        index = names.index({robot.joints[k].name, "ball"})
        distance = scene.distances(q).distance[0, index]
        assert distance == pytest.approx(0.1 - 0.05 - 0.02, abs=1e-9)


def test_the_base_has_shapes_too(tmp_path: Path) -> None:
    cell = loaded(tmp_path, ABB + REACH.format(link="base", x=0, z=0, top=300))
    (own,) = (shape for shape in cell.robot.shapes if shape.link == 0)
    assert own.placement.position == pytest.approx((0.0, 0.0, 0.15))


def test_limits_are_narrowed_one_by_one(tmp_path: Path) -> None:
    text = (
        ABB
        + """
[joint_limit.J1]
range_deg = [-90, 60]
[joint_limit.J2]
speed_deg_s = 40
acceleration_rad_s2 = 30
"""
    )
    robot, given = loaded(tmp_path, text).robot, find_robot("abb/irb6640-180-255")
    limits, known = robot.limits, given.limits
    assert (limits.lower[0], limits.upper[0]) == pytest.approx(np.radians([-90, 60]))
    assert limits.velocity[1] == pytest.approx(math.radians(40))
    assert limits.acceleration[1] == 30.0
    assert limits.velocity[0] == known.velocity[0]
    assert np.array_equal(limits.lower[1:], known.lower[1:])
    assert np.array_equal(limits.acceleration[2:], known.acceleration[2:])


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ('[[obstacle]]\nname = "b"\nsphere_mm = 20', "sphere_mm: must be a list"),
        ("[joint_limit.J9]\nrange_deg = [0, 1]", r"joint_limit.J9.*no such joint"),
        ("[joint_limit.J1]\nrange_deg = [-300, 10]", r"J1.range.*narrower than"),
        ("[joint_limit.J1]\nrange_deg = [10, -10]", "must rise"),
        ("[joint_limit.J1]\nrange_mm = [10, 20]", "range_mm.*needs one of the units"),
        ("[joint_limit.J1]\nspeed_deg_s = 1000", "speed.*at most"),
        ("[joint_limit.J1]\nspeed_deg_s = 0", "speed.*above zero"),
        ("[joint_limit.J1]\nacceleration_deg_s2 = 0", "acceleration.*above zero"),
        ("[joint_limit.J1]\nspeed = 10", "needs one of the units"),
        ("[joint_limit.J1]\njerk_deg_s3 = 10", "jerk"),
        (REACH.format(link="J9", x=0, z=0, top=1), "link"),
        (REACH.format(link="J1", x=0, z=5, top=5), "positive lengths"),
        (REACH.format(link="J1", x=0, z=5, top=9).replace("capsule", "blob"), "kind"),
        (REACH.format(link="J1", x=0, z=5, top=9).replace("radius_mm", "radius"), "radius"),
    ],
)
def test_what_is_wrong_is_told_with_its_key(tmp_path: Path, text: str, message: str) -> None:
    with pytest.raises(InputError, match=message) as caught:
        loaded(tmp_path, ABB + text)
    assert str(caught.value).count("cell.toml") == 1


MESH = """
[[robot_shape]]
link = "J3"
kind = "mesh"
mesh = "{name}"
units = "mm"
xyz_mm = [500, 0, 1000]
"""


def test_a_link_has_the_bodies_that_enclose_its_mesh(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    def three(vertices, faces):
        spans = [((0, 3), (0, 1)), ((0, 1), (1, 3)), ((2, 3), (1, 3))]
        return [0.1 * np.array(np.meshgrid(*s, (0, 1))).reshape(3, 8).T for s in spans]

    profile = [(0, 0), (3, 0), (3, 3), (2, 3), (2, 1), (1, 1), (1, 3), (0, 3)]
    caps = [(0, 1, 4), (0, 4, 5), (1, 2, 3), (1, 3, 4), (0, 5, 6), (0, 6, 7)]
    corners = np.array([(*at, z) for z in (0, 1) for at in profile], float) * 100
    faces = [(a, c, b) for a, b, c in caps] + [(a + 8, b + 8, c + 8) for a, b, c in caps]
    for i in range(8):
        j = (i + 1) % 8
        faces += [(i, j, j + 8), (i, j + 8, i + 8)]
    trimesh.Trimesh(corners, faces, process=False).export(tmp_path / "u.stl")
    monkeypatch.setattr(split, "approximate_parts", three)
    cell = loaded(tmp_path, ABB + MESH.format(name="u.stl"))
    own = [shape for shape in cell.robot.shapes if shape.link == 3]
    assert len(own) == 3
    assert cell.robot.doubts == find_robot("abb/irb6640-180-255").doubts
    frame = Pose()
    for joint in cell.robot.joints[:3]:
        frame = frame @ joint.placement
    middles = [(frame @ shape.placement).position for shape in own]
    wanted = [(0.65, 0.05, 1.05), (0.55, 0.2, 1.05), (0.75, 0.2, 1.05)]
    np.testing.assert_allclose(middles, wanted, atol=1e-3)

    def not_there(vertices, faces):
        raise NotSplitError("install something")

    monkeypatch.setattr(split, "approximate_parts", not_there)
    cell = loaded(tmp_path, ABB + MESH.format(name="u.stl"))
    assert len([shape for shape in cell.robot.shapes if shape.link == 3]) == 1
    assert cell.robot.doubts[-1].endswith("install something")


def test_meshes_of_links_that_cannot_be_read_are_named(tmp_path: Path) -> None:
    (tmp_path / "bad.stl").write_bytes(b"nothing")
    for name in ("bad.stl", "none.stl"):
        with pytest.raises(InputError, match=rf"cell\.toml.*mesh.*{name}"):
            loaded(tmp_path, ABB + MESH.format(name=name))
