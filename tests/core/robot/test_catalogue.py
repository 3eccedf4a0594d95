"""Catalogue files: what they mean, and the errors that name file and key."""

from __future__ import annotations

import math

import numpy as np
import pytest

from flyby.core.errors import InputError
from flyby.core.robot.catalogue import load_robot
from flyby.core.robot.joint import JointKind
from flyby.core.robot.shape import Box, Capsule, Sphere
from flyby.core.spatial.rotation import quaternion_from_matrix

ORIGIN = """
[origin]
geometry = "assumed: a test"
range = "assumed: a test"
velocity = "assumed: a test"
acceleration = "assumed: maximum speed in 0.25 s"
"""
JOINT = """
[[joint]]
name = "A1"
axis = [0, 0, 1]
lower_deg = -90
upper_deg = 180
velocity_deg_s = 90
"""
SMALL = 'name = "test/arm"\n' + ORIGIN + JOINT + "[assumed]\nacceleration_time_s = 0.25\n"


@pytest.fixture
def load(tmp_path):
    def read(text):
        file = tmp_path / "arm.toml"
        file.write_text(text, "utf-8")
        return load_robot(file)

    return read


# Forward kinematics of github.com/hehonglu123/Motion-Primitive-Planning
# config/abb_6640_180_255_*.yml and rpiRobotics/ARM-21-02-F-19-Robot-Motion-Program,
# base to flange without a tool: q deg, position mm, quaternion w, x, y, z.
IRB6640 = [
    ([0, 0, 0, 0, 0, 0], [1662.5, 0, 2055], [0.7071068, 0, 0.7071068, 0]),
    ([0, 0, 0, 0, 30, 0], [1635.7051, 0, 1955], [0.5, 0, 0.8660254, 0]),
    (
        [30, -20, 15, 40, -35, 60],
        [1100.8655, 550.4402, 2190.8053],
        [0.4812856, 0.3888906, 0.3069376, 0.7231304],
    ),
    (
        [-75, 40, -30, -120, 80, -200],
        [410.3789, -2190.6012, 1693.0202],
        [0.5761896, 0.5129449, -0.0974823, -0.6288006],
    ),
    (
        [120, 60, -100, 170, -95, 45],
        [-1025.2353, 1844.9546, 2043.5821],
        [0.2864886, -0.7740594, -0.551916, -0.1189332],
    ),
]


@pytest.mark.parametrize(("degrees", "position_mm", "quaternion"), IRB6640)
def test_irb6640_stands_where_the_published_model_does(
    robot_file, degrees, position_mm, quaternion
) -> None:
    robot = load_robot(robot_file("abb", "irb6640-180-255"))
    R, p = robot.forward(np.radians(degrees))
    np.testing.assert_allclose(1000 * p, position_mm, atol=1e-4)
    np.testing.assert_allclose(quaternion_from_matrix(R), quaternion, atol=1e-7)


def test_irb6640_has_limits_in_si_and_says_where_they_are_from(robot_file) -> None:
    robot = load_robot(robot_file("abb", "irb6640-180-255"))
    assert robot.name == "abb/irb6640-180-255" and robot.payload == 180
    np.testing.assert_allclose(np.degrees(robot.limits.lower), [-170, -65, -180, -300, -120, -360])
    np.testing.assert_allclose(np.degrees(robot.limits.velocity), [100, 90, 90, 190, 140, 190])
    assert robot.origins["velocity"].startswith("published: ")
    assert {shape.link for shape in robot.shapes} == set(range(7))


def test_accelerations_may_follow_from_an_assumed_time(load) -> None:
    (joint,) = load(SMALL).joints
    assert joint.acceleration == pytest.approx(math.radians(90) / 0.25)
    assert (joint.lower, joint.upper) == pytest.approx((-math.pi / 2, math.pi))


def test_linear_joints_are_in_millimetres(load) -> None:
    text = SMALL.replace("axis", 'kind = "prismatic"\naxis')
    text = text.replace("_deg_s", "_mm_s").replace("_deg", "_mm")
    (joint,) = load(text).joints
    assert joint.kind is JointKind.PRISMATIC
    assert (joint.lower, joint.velocity) == pytest.approx((-0.09, 0.09))


def test_forms_of_orientation_mean_the_same(load) -> None:
    forms = ["rpy_deg = [30, 20, 10]", "abc_deg = [10, 20, 30]"]
    flanges = [load(f"{SMALL}[flange]\n{form}\n").flange.matrix() for form in forms]
    np.testing.assert_allclose(flanges[0], flanges[1], atol=1e-15)
    # R = Rz(10°) Ry(20°) Rx(30°)
    assert flanges[0][2, 0] == pytest.approx(-math.sin(math.radians(20)))
    assert flanges[0][2, 1] == pytest.approx(math.cos(math.radians(20)) * 0.5)
    quarter = load(f"{SMALL}[flange]\nquat_wxyz = [0.7071068, 0, 0, 0.7071068]\n").flange.matrix()
    np.testing.assert_allclose(quarter[:3, 0], [0, 1, 0], atol=1e-15)


UR5E = """
dh = [
  { d_mm = 162.5, a_mm = 0, alpha_deg = 90 },
  { d_mm = 0, a_mm = -425, alpha_deg = 0 },
  { d_mm = 0, a_mm = -392.2, alpha_deg = 0 },
  { d_mm = 133.3, a_mm = 0, alpha_deg = 90 },
  { d_mm = 99.7, a_mm = 0, alpha_deg = -90 },
  { d_mm = 99.6, a_mm = 0, alpha_deg = 0 },
]
"""


def dh_file(links=""):
    joints = "".join(
        JOINT.replace("A1", f"J{k}").replace("axis = [0, 0, 1]\n", "") for k in range(6)
    )
    head = SMALL.replace(JOINT, "").replace(ORIGIN, UR5E + ORIGIN + 'inertia = "assumed: a test"\n')
    return head + joints + links


def test_denavit_hartenberg_rows_give_the_published_pose(load) -> None:
    """UR5e of github.com/UniversalRobots/Universal_Robots_ROS2_Description."""
    robot = load(dh_file())
    R, p = robot.forward(np.radians([10, -70, 100, -120, -80, 30]))
    np.testing.assert_allclose(1000 * p, [-549.6800, -249.8419, 267.6825], atol=1e-4)
    expected = [0.07899, 0.816035, 0.571394, -0.036834]
    np.testing.assert_allclose(quaternion_from_matrix(R), expected, atol=1e-6)


def test_bodies_of_dh_files_are_moved_to_their_joints(load) -> None:
    link = "[[link]]\nmass_kg = 2\ncentre_mm = [10, 20, 30]\ninertia_kgm2 = [1, 2, 3, 0, 0, 0]\n"
    robot = load(dh_file(6 * link))
    # Row 1: DH frame 1 stands 162.5 mm above joint 1, turned by 90° about x.
    np.testing.assert_allclose(robot.links[0].centre, [0.010, -0.030, 0.1825], atol=1e-12)
    np.testing.assert_allclose(np.diag(robot.links[0].tensor), [1, 3, 2], atol=1e-12)


def test_shapes_come_with_their_frames(load) -> None:
    text = 'name = "test/arm"\n' + ORIGIN + 'shape = "assumed: a test"\n' + JOINT
    text += "[assumed]\nacceleration_time_s = 0.25\n"
    text += """
[[shape]]
link = 1
kind = "capsule"
radius_mm = 50
from_mm = [100, 0, 0]
to_mm = [500, 0, 0]
[[shape]]
link = 0
kind = "sphere"
radius_mm = 70
centre_mm = [0, 0, 10]
[[shape]]
link = 0
kind = "box"
size_mm = [10, 20, 30]
xyz_mm = [0, 0, 15]
"""
    capsule, sphere, box = load(text).shapes
    assert capsule.link == 1 and capsule.shape == Capsule(0.05, 0.4)
    matrix = capsule.placement.matrix()
    np.testing.assert_allclose(matrix[:3, 2], [1, 0, 0], atol=1e-15)
    np.testing.assert_allclose(matrix[:3, 3], [0.3, 0, 0], atol=1e-15)
    assert sphere.shape == Sphere(0.07) and box.shape == Box((0.01, 0.02, 0.03))


@pytest.mark.parametrize(
    ("old", "new", "message"),
    [
        ("axis", "axes", r"joint\[1\]\.axis: is missing"),
        ("axis = [0, 0, 1]", "axis = [0, 0, 2]", "joint A1: axis .* must have length 1"),
        ("velocity_deg_s = 90", "velocity_deg = 90", r"velocity_deg_s: is missing"),
        (
            "velocity_deg_s = 90",
            "velocity_deg_s = 90\nspeed = 1",
            r"joint\[1\]\.speed: unknown key",
        ),
        ("acceleration_time_s = 0.25", "", r"acceleration_deg_s2: is missing"),
        (
            'range = "assumed',
            'range = "guessed',
            r"origin\.range: must start with one of published",
        ),
        ('velocity = "assumed: a test"\n', "", r"origin\.velocity: is missing"),
        ("upper_deg = 180", "upper_deg = -100", "lower limit .* must be below"),
        ("lower_deg", "lower_mm", r"lower_mm: needs one of the units lower_deg"),
        ('name = "test/arm"', "", "name: is missing"),
        ("[assumed]", "typo = 1\n[assumed]", r"joint\[1\]\.typo: unknown key"),
        (JOINT, "", "joint: is missing"),
    ],
)
def test_errors_name_file_and_key(load, old, new, message) -> None:
    assert old in SMALL
    with pytest.raises(InputError, match=rf"arm\.toml: .*{message}"):
        load(SMALL.replace(old, new))
