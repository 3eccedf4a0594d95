"""URDF files, against Pinocchio's own URDF reader and by their errors."""

from __future__ import annotations

import math

import numpy as np
import pinocchio as pin
import pytest

from flyby.core.errors import InputError, UnknownNameError
from flyby.core.robot.urdf.arm import load_urdf

LIMIT = '<limit lower="-2" upper="1.5" velocity="3" effort="40"/>'
INERTIAL = """
<inertial><origin xyz="0.1 0.02 -0.03" rpy="0.2 0.3 0.4"/><mass value="{mass}"/>
<inertia ixx="0.3" iyy="0.4" izz="0.5" ixy="0.01" ixz="0.02" iyz="0.03"/></inertial>
"""


def joint(name, parent, child, kind="revolute", limit=LIMIT, more=""):
    return (
        f'<joint name="{name}" type="{kind}"><parent link="{parent}"/><child link="{child}"/>'
        f'<origin xyz="0.1 0.2 0.3" rpy="0.4 -0.5 0.6"/><axis xyz="0 0.6 0.8"/>'
        f"{limit}{more}</joint>"
    )


def robot(*joints, links="base a b tool plate", masses=True):
    bodies = "".join(
        f'<link name="{link}">{INERTIAL.format(mass=k + 1) if masses else ""}</link>'
        for k, link in enumerate(links.split())
    )
    return f'<robot name="arm">{bodies}{"".join(joints)}</robot>'


ARM = (
    joint("fixed0", "base", "plate", "fixed", ""),
    joint("j1", "plate", "a"),
    joint("j2", "a", "b", "prismatic"),
    joint("flange", "b", "tool", "fixed", ""),
)


@pytest.fixture
def load(tmp_path):
    def read(text, **options):
        file = tmp_path / "arm.urdf"
        file.write_text(text, "utf-8")
        return load_urdf(file, **options)

    return read


def test_kinematics_and_dynamics_agree_with_pinocchios_reader(load) -> None:
    text = robot(*ARM)
    found = load(text)
    model = pin.buildModelFromXML(text)
    model.gravity.linear = np.array(found.gravity)
    data = model.createData()
    q, dq, ddq = np.random.default_rng(0).normal(size=(3, 2))
    pin.framesForwardKinematics(model, data, q)
    tool = data.oMf[model.getFrameId("tool")]
    R, p = found.forward(q)
    np.testing.assert_allclose(R, tool.rotation, atol=1e-12)
    np.testing.assert_allclose(p, tool.translation, atol=1e-12)
    torques = found.inverse_dynamics(q, dq, ddq)
    np.testing.assert_allclose(torques, pin.rnea(model, data, q, dq, ddq), atol=1e-9)


def test_limits_are_read_and_accelerations_assumed_aloud(load) -> None:
    limits = load(robot(*ARM)).limits
    np.testing.assert_allclose(limits.lower, -2)
    np.testing.assert_allclose(limits.upper, 1.5)
    np.testing.assert_allclose(limits.velocity, 3)
    np.testing.assert_allclose(limits.effort, 40)
    np.testing.assert_allclose(limits.acceleration, 3 / 0.65)
    found = load(robot(*ARM))
    assert found.origins["acceleration"].startswith("assumed: maximum speed in 0.65 s of the first")
    assert found.spread == {"acceleration": 2.6}


def test_a_continuous_joint_without_limits_is_assumed_aloud(load) -> None:
    found = load(robot(joint("j1", "base", "a", "continuous", ""), links="base a"))
    (only,) = found.joints
    assert (only.lower, only.upper, only.effort) == (-2 * math.pi, 2 * math.pi, None)
    assert only.velocity == pytest.approx(math.pi)
    assert "assumed" in found.origins["range"] and "j1" in found.origins["velocity"]
    assert found.spread["velocity"] > 1.0
    none = LIMIT.replace('velocity="3"', 'velocity="0"')  # as exporters write what they do not know
    (only,) = load(robot(joint("j1", "base", "a", limit=none), links="base a")).joints
    assert only.velocity == pytest.approx(math.pi)


def test_without_inertials_only_kinematics_is_left(load) -> None:
    found = load(robot(*ARM, masses=False))
    found.forward(np.zeros(2))
    with pytest.raises(InputError, match=r"need the inertias .*links without <inertial> \(a, b\)"):
        found.inverse_dynamics(np.zeros(2), np.zeros(2), np.zeros(2))


ROS = robot(
    *(joint("base_link-base", "base_link", "base", "fixed", ""),),
    *(joint("j1", "base_link", "a"), joint("j2", "a", "b")),
    *(joint("b-flange", "b", "flange", "fixed", ""), joint("t", "flange", "tool0", "fixed", "")),
    *(joint("camera", "b", "camera", "fixed", ""), joint("dress", "a", "dress", "fixed", "")),
    links="base_link base a b flange tool0 camera dress",
)


def test_base_and_flange_are_the_controllers_own_where_the_file_has_them(load) -> None:
    found = load(ROS)
    model = pin.buildModelFromXML(ROS)
    data = model.createData()
    q = np.array([0.3, -0.7])
    pin.framesForwardKinematics(model, data, q)
    base, tool = (data.oMf[model.getFrameId(name)] for name in ("base", "tool0"))
    R, p = found.forward(q)
    np.testing.assert_allclose(p, (base.inverse() * tool).translation, atol=1e-12)
    np.testing.assert_allclose(R, (base.inverse() * tool).rotation, atol=1e-12)
    assert load(ROS, base="base_link").joints[0].placement != found.joints[0].placement


def test_base_and_tip_cut_the_arm(load) -> None:
    links = "base a b tool plate finger"
    branching = robot(*ARM, joint("left", "tool", "finger", "fixed", ""), links=links)
    assert load(branching, tip="tool").flange != load(branching, tip="b").flange
    assert len(load(branching, base="a", tip="finger").joints) == 1
    with pytest.raises(UnknownNameError, match="'tol': did you mean 'tool'"):
        load(branching, tip="tol")
    with pytest.raises(InputError, match="'plate' does not hang on 'tool'"):
        load(branching, base="tool", tip="plate")


@pytest.mark.parametrize(
    ("extra", "links", "message"),
    [
        (joint("k", "a", "c"), "base a b tool plate c", "ends in several links"),
        (joint("k", "x", "y"), "base a b tool plate x y", "2 root links"),
        (joint("k", "tool", "c", "floating", ""), "base a b tool plate c", "'k' is floating"),
        (joint("k", "tool", "c", limit=""), "base a b tool plate c", "'k' needs <limit"),
        (
            joint("k", "tool", "c", more='<mimic joint="j1"/>'),
            "base a b tool plate c",
            "'k' mimics 'j1'",
        ),
    ],
)
def test_what_is_no_serial_arm_is_refused(load, extra, links, message) -> None:
    with pytest.raises(InputError, match=rf"arm\.urdf: .*{message}"):
        load(robot(*ARM, extra, links=links))


def test_a_moving_branch_is_named_even_if_the_tip_is_chosen(load) -> None:
    text = robot(*ARM, joint("k", "a", "c"), links="base a b tool plate c")
    with pytest.raises(InputError, match="branches at link 'a': joint 'k' moves too"):
        load(text, tip="tool")


def test_what_is_no_urdf_is_refused(load, tmp_path) -> None:
    with pytest.raises(InputError, match=r"arm\.urdf: is not a URDF"):
        load("<robot")
    with pytest.raises(InputError, match="cannot be read: No such file"):
        load_urdf(tmp_path / "missing.urdf")


CHAIN = [f"l{k}" for k in range(8)]


def chain(*kinds: str, mimic: bool = False) -> str:
    """An arm of joints of these kinds, with two fingers if one of them mimics the other."""
    arm = [joint(f"j{k}", f"l{k - 1}", f"l{k}", kind) for k, kind in enumerate(kinds, 1)]
    links = CHAIN[: len(kinds) + 1]
    if mimic:
        hand = links[-1]
        arm += [
            joint("left", hand, "f1", "prismatic"),
            joint("right", hand, "f2", "prismatic", more='<mimic joint="left"/>'),
        ]
        links = [*links, "f1", "f2"]
    return robot(*arm, links=" ".join(links))


def test_a_rail_is_an_external_axis(load) -> None:
    """As the controller of an arm of six axes drives it; the flange is where the file has it."""
    text = chain("prismatic", *6 * ("revolute",))
    found = load(text)
    (track,) = found.external_axes
    assert (track.name, track.role.value, len(found.joints)) == ("j1", "track", 6)
    model = pin.buildModelFromXML(text)
    data = model.createData()
    q = np.random.default_rng(3).normal(size=7)
    pin.framesForwardKinematics(model, data, q)
    there = data.oMf[model.getFrameId("l7")]
    R, p = found.forward([*q[1:], q[0]])
    np.testing.assert_allclose(R, there.rotation, atol=1e-12)
    np.testing.assert_allclose(p, there.translation, atol=1e-12)
    seven = load(chain(*7 * ("revolute",)))
    assert len(seven.joints) == 7 and not seven.external_axes


def test_fingers_are_no_part_of_the_arm(load) -> None:
    bare, held = load(chain(*6 * ("revolute",))), load(chain(*6 * ("revolute",), mimic=True))
    assert held.joints == bare.joints and held.flange == bare.flange
    assert any("left out: left, right; the flange is link l6" in doubt for doubt in held.doubts)
    with pytest.raises(InputError, match="branches at link 'l6': joint 'left' moves"):
        load(chain(*6 * ("revolute",), mimic=True), tip="f2")


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ('<sdf version="1.6"><model/></sdf>', "it begins with <sdf>, not <robot>"),
        ('<robot name="a"><group name="arm"/></robot>', "an SRDF, which belongs to a URDF"),
        ('<robot name="a"><link name="l"/><joint name="${p}j"/></robot>', "a template of xacro"),
        ('<robot name="a"><xacro:include filename="b"/></robot>', "a template of xacro"),
    ],
)
def test_what_it_is_instead_is_said(load, text, message) -> None:
    with pytest.raises(InputError, match=message):
        load(text)


SHORT = (
    '<robot name="r"><link name="a"/><link name="b"/><joint name="j" type="revolute">'
    '<parent link="a"/><child link="b"/><axis xyz="0 0 1"/>'
    '<limit lower="-1" upper="1" velocity="1" effort="1"/></joint></robot>'
)


@pytest.mark.parametrize(
    ("old", "new", "message"),
    [
        ('<link name="b"/>', "", "names 'b', which is no link"),
        ('<link name="b"/>', '<link name="b"/><link name="b"/>', "two links have one name"),
        ("0 0 1", "1e300 1e300 0", "has no axis"),
        ("0 0 1", "nan 0 0", "has no axis"),
        ("0 0 1", "0 1", "has no axis"),
        ('upper="1"', 'upper="1e308"', "at most 10000 either way"),
        ('upper="1"', 'upper="inf"', "at most 10000 either way"),
        ('velocity="1"', 'velocity="nan"', "velocity nan"),
        ("<robot", '<!DOCTYPE r [<!ENTITY a SYSTEM "file:///etc/passwd">]><robot', "document type"),
        ("</robot>", "", "is not a URDF file"),
        ('<parent link="a"/>', "", "is not a URDF file"),
        ('<link name="a"/>', '<link name="a">' + "<x>" * 10_000, "is not a URDF file"),
    ],
)
def test_hostile_files_are_refused_by_name(tmp_path, old, new, message) -> None:
    path = tmp_path / "arm.urdf"
    path.write_text(SHORT, "utf-8")
    assert load_urdf(path).size == 1
    path.write_text(SHORT.replace(old, new, 1), "utf-8")
    with pytest.raises(InputError, match=rf"arm\.urdf: .*{message}"):
        load_urdf(path)
