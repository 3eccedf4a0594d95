"""Robots of files: loaded, driven, kept among the user's own."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

import flyby
from flyby.core import own_robots
from flyby.core.errors import InputError, OptionError
from flyby.core.own_robots import keep_robot, with_own_robots
from flyby.core.registry import Registry, find_robot, find_vendor, installed
from flyby.core.robot.catalogue_text import robot_text
from flyby.core.robot.joint import ExternalAxis, ExternalRole
from flyby.core.robot.model import Robot
from flyby.core.robot_files import load_robot_file, names_file
from flyby.core.spatial.pose import Pose

KR30 = find_robot("kuka/kr30-3")
PROGRAM = """DEF job()
BAS(#INITMOV,0)
PTP {A1 0,A2 -90,A3 90,A4 0,A5 10,A6 0}
PTP {A1 10,A2 -80,A3 80,A4 0,A5 30,A6 0}
END
"""


def saved(folder: Path, robot: Robot, name: str = "arm.toml") -> Path:
    path = folder / name
    path.write_text(robot_text(robot), "utf-8")
    return path


def origin(pose: Pose) -> str:
    """A frame as URDF has it: rotations about fixed x, y, z."""
    m = pose.matrix()[:3, :3]
    pitch = float(np.arcsin(np.clip(-m[2, 0], -1, 1)))
    if abs(abs(m[2, 0]) - 1) < 1e-9:
        roll, yaw = float(np.arctan2(-m[1, 2], m[1, 1])), 0.0
    else:
        roll, yaw = (float(np.arctan2(*pair)) for pair in ((m[2, 1], m[2, 2]), (m[1, 0], m[0, 0])))
    xyz = " ".join(map(repr, map(float, pose.position)))
    return f'<origin xyz="{xyz}" rpy="{roll!r} {pitch!r} {yaw!r}"/>'


def urdf(folder: Path, robot: Robot) -> Path:
    """The arm as a URDF."""
    lines = ['<robot name="My Arm 5"><link name="link_0"/>']
    for k, joint in enumerate(robot.joints):
        lines.append(
            f'<link name="link_{k + 1}"/><joint name="joint_{k + 1}" type="revolute">'
            f'<parent link="link_{k}"/><child link="link_{k + 1}"/>{origin(joint.placement)}'
            f'<axis xyz="{" ".join(map(str, joint.axis))}"/><limit lower="{joint.lower}" '
            f'upper="{joint.upper}" velocity="{joint.velocity}" effort="0"/></joint>'
        )
    lines.append(
        f'<link name="tool0"/><joint name="end" type="fixed"><parent link="link_6"/>'
        f'<child link="tool0"/>{origin(robot.flange)}</joint></robot>'
    )
    path = folder / "arm.urdf"
    path.write_text("\n".join(lines), "utf-8")
    return path


def test_a_urdf_is_driven_by_the_vendor_that_is_named(tmp_path: Path) -> None:
    path = urdf(tmp_path, KR30)
    robot = flyby.robot(str(path), vendor="kuka")
    assert robot.name == "kuka/my-arm-5"
    q = np.random.default_rng(1).uniform(KR30.limits.lower, KR30.limits.upper, (20, 6))
    for one, other in zip(robot.forward(q), KR30.forward(q), strict=True):
        np.testing.assert_allclose(one, other, atol=1e-9)
    assert robot.recognised is not None
    program = flyby.read(PROGRAM, robot=str(path), vendor="kuka")
    run = flyby.emulate(program)
    low, high = run.report.time_range
    assert low < run.duration < high


def test_whose_controller_drives_a_urdf_has_to_be_said(tmp_path: Path) -> None:
    path = str(urdf(tmp_path, KR30))
    with pytest.raises(InputError, match=r"arm\.urdf: a URDF does not say whose .* vendor"):
        flyby.robot(path)
    with pytest.raises(InputError, match="unknown vendor 'fanuk'"):
        flyby.robot(path, vendor="fanuk")


def test_a_catalogue_file_says_its_vendor_itself(tmp_path: Path) -> None:
    slow = replace(KR30, name="kuka/slow-30")
    path = saved(tmp_path, slow)
    assert flyby.read(PROGRAM, robot=str(path)).setup.robot.name == "kuka/slow-30"
    with pytest.raises(InputError, match="is a robot of kuka, not of abb"):
        flyby.robot(str(path), vendor="abb")
    nobody = saved(tmp_path, replace(KR30, name="mine"), "nobody.toml")
    with pytest.raises(InputError, match="'mine' says no vendor: vendor/model is expected"):
        flyby.robot(str(nobody))


def test_a_robot_of_the_catalogue_is_driven_by_its_own_vendor() -> None:
    with pytest.raises(InputError, match="kuka/kr30-3 is driven by kuka"):
        flyby.read(PROGRAM, robot="kuka/kr30-3", vendor="abb")


def test_cells_name_files_of_robots(tmp_path: Path) -> None:
    saved(tmp_path, replace(KR30, name="kuka/mine"))
    cell = tmp_path / "cell.toml"
    cell.write_text('robot = "arm.toml"\n[base]\nxyz_mm = [0, 0, 500]\n', "utf-8")
    program = flyby.read(PROGRAM, cell=str(cell))
    assert program.setup.robot.base.position == (0.0, 0.0, 0.5)
    flyby.emulate(program)
    cell.write_text('robot = "missing.toml"\n', "utf-8")
    with pytest.raises(InputError, match=r"cell\.toml.*missing\.toml"):
        flyby.read(PROGRAM, cell=str(cell))


@pytest.mark.parametrize("name", ["a.dat", "a.xml"])
def test_files_that_no_vendor_reads_are_refused(tmp_path: Path, name: str) -> None:
    path = tmp_path / name
    path.write_text("x", "utf-8")
    with pytest.raises(InputError, match=rf"{name}: "):
        flyby.robot(str(path), vendor="abb")


def test_names_of_robots_are_no_files() -> None:
    assert not any(names_file(name) for name in installed().robot_names)
    assert not names_file("IRB 120-3/0.58")


@pytest.fixture
def own(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """The folder of the user's own robots."""
    folder = tmp_path / "own" / "robots"
    monkeypatch.setattr(own_robots, "own_folder", lambda: folder)
    return folder


def test_kept_robots_are_found_by_their_name(own: Path) -> None:
    mine = replace(KR30, name="kuka/mine")
    path = keep_robot(mine, find_vendor("kuka"))
    assert path == own / "kuka" / "mine.toml"
    vendors = with_own_robots(installed().vendors)
    found = Registry(vendors).find_robot("kuka/mine")
    np.testing.assert_allclose(found.forward([0.1] * 6)[1], KR30.forward([0.1] * 6)[1])
    with pytest.raises(InputError, match="is kept already"):
        keep_robot(mine, vendors["kuka"])
    keep_robot(replace(mine, payload=1.0), vendors["kuka"], replace_existing=True)
    track = ExternalAxis(replace(mine.joints[0], name="rail"), ExternalRole.TRACK)
    stated = {**mine.origins, "external axes": "published"}
    railed = replace(mine, name="kuka/railed", external_axes=(track,), origins=stated)
    kept = load_robot_file(keep_robot(railed, find_vendor("kuka")), installed())
    assert kept.doubts[-1].startswith("its external axes (rail) are not kept")
    assert "external axes" not in kept.origins
    assert load_robot_file(path, installed()).payload == 1.0


@pytest.mark.parametrize(
    ("name", "message"),
    [("kuka/kr30-3", "is in the catalogue already"), ("kuka/Mine!", "lower-case letters")],
)
def test_names_that_cannot_be_kept_are_refused(own: Path, name: str, message: str) -> None:
    with pytest.raises(InputError, match=message):
        keep_robot(replace(KR30, name=name), find_vendor("kuka"))
    assert not own.exists()


def test_a_broken_file_among_the_own_hides_no_other(own: Path) -> None:
    (own / "kuka").mkdir(parents=True)
    (own / "kuka" / "broken.toml").write_text("x = [", "utf-8")
    (own / "kuka" / "Not a name.toml").write_text("", "utf-8")
    registry = Registry(with_own_robots(installed().vendors))
    assert registry.find_robot("kuka/kr30-3") == KR30
    with pytest.raises(InputError, match=r"broken\.toml: is not TOML"):
        registry.find_robot("kuka/broken")


def test_robots_add_wants_a_file() -> None:
    from flyby.cli.catalogue import robots

    with pytest.raises(OptionError, match="go together"):
        robots("add")
