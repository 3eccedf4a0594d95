"""Links that may touch by an SRDF, read beside a URDF and kept in catalogue files."""

from __future__ import annotations

from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

from flyby.core.cell.cell import Cell
from flyby.core.cell.file import load_cell
from flyby.core.collision.scene.scene import CollisionScene
from flyby.core.errors import FlybyError, InputError
from flyby.core.registry import Registry, find_vendor
from flyby.core.robot.catalogue import load_robot
from flyby.core.robot.catalogue_text import robot_text
from flyby.core.robot.shape import TouchingLinks
from flyby.core.robot.urdf.arm import load_urdf
from flyby.core.robot.urdf.srdf import read_srdf

LINK = """<link name="{name}"><collision><origin xyz="0 0 0.2"/>
  <geometry><box size="0.1 0.1 0.3"/></geometry></collision></link>"""
JOINT = """<joint name="j{k}" type="revolute"><parent link="{a}"/><child link="{b}"/>
  <origin xyz="0 0 0.4"/><axis xyz="0 1 0"/>
  <limit lower="-3" upper="3" velocity="2" effort="0"/></joint>"""
LINKS = ("base_link", "l1", "l2", "l3", "l4")
URDF = "\n".join(
    [
        '<robot name="crane">',
        *(LINK.format(name=name) for name in LINKS),
        *(JOINT.format(k=k + 1, a=LINKS[k], b=LINKS[k + 1]) for k in range(4)),
        LINK.format(name="cover"),
        '<joint name="c" type="fixed"><parent link="l4"/><child link="cover"/></joint>',
        '<link name="flange"/>',
        '<joint name="f" type="fixed"><parent link="l4"/><child link="flange"/></joint>',
        "</robot>",
    ]
)
HEAD = '<?xml version="1.0"?>\n<robot name="crane">\n'


def pair(first: str, second: str, reason: str = "Never") -> str:
    return f'<disable_collisions link1="{first}" link2="{second}" reason="{reason}"/>\n'


def written(folder: Path, *entries: str, name: str = "arm.srdf") -> Path:
    urdf = folder / "urdf" / "arm.urdf"
    urdf.parent.mkdir(exist_ok=True)
    urdf.write_text(URDF, "utf-8")
    srdf = urdf.parent / name
    srdf.parent.mkdir(exist_ok=True)
    srdf.write_text(HEAD + "".join(entries) + "</robot>", "utf-8")
    return urdf


@pytest.mark.parametrize(
    "name",
    ["arm.srdf", "crane.srdf", "../srdf/arm.srdf", "../srdf/crane.srdf", "../config/crane.srdf"],
)
def test_an_srdf_beside_the_urdf_is_read(tmp_path: Path, name: str) -> None:
    robot = load_urdf(written(tmp_path, pair("l3", "l1", "User"), name=name))
    assert robot.may_touch == (TouchingLinks(1, 3, Path(name).name, "User"),)
    assert robot.doubts == ()


def test_without_one_nothing_more_may_touch(tmp_path: Path) -> None:
    assert load_urdf(written(tmp_path, name="other.srdf")).may_touch == ()


def test_one_that_is_named_comes_before_the_one_beside(tmp_path: Path) -> None:
    urdf = written(tmp_path, pair("l1", "l3"))
    other = tmp_path / "mine.srdf"
    other.write_text(HEAD + pair("base_link", "l2") + "</robot>", "utf-8")
    assert [(p.first, p.second) for p in load_urdf(urdf, srdf=other).may_touch] == [(0, 2)]


def test_bodies_fixed_together_may_touch_only_where_all_of_them_may(tmp_path: Path) -> None:
    one = load_urdf(written(tmp_path, pair("l2", "cover")))
    assert one.may_touch == ()
    both = load_urdf(written(tmp_path, pair("l2", "cover"), pair("l4", "l2", "Default")))
    (found,) = both.may_touch
    assert (found.first, found.second) == (2, 4)
    assert set(found.reason.split(", ")) == {"Never", "Default"}


def test_defaults_and_what_takes_them_back(tmp_path: Path) -> None:
    urdf = written(
        tmp_path,
        '<disable_default_collisions link="l1"/>\n',
        '<enable_collisions link1="l3" link2="l1"/>\n',
    )
    found = {(p.first, p.second): p.reason for p in load_urdf(urdf).may_touch}
    assert found == dict.fromkeys([(0, 1), (1, 2), (1, 4)], "Default")


def test_links_that_there_are_not_are_doubted(tmp_path: Path) -> None:
    urdf = written(tmp_path, pair("l1", "l3"), pair("l1", "gripper"))
    robot = load_urdf(urdf)
    assert len(robot.may_touch) == 1
    assert robot.doubts == (
        f"{urdf.with_suffix('.srdf')}: names links that the URDF does not have: 'gripper' (line 4)",
    )


def test_an_srdf_of_another_robot_is_doubted(tmp_path: Path) -> None:
    urdf = written(tmp_path)
    urdf.with_suffix(".srdf").write_text('<robot name="x"/>', "utf-8")
    assert "is of a robot 'x', the URDF of 'crane'" in load_urdf(urdf).doubts[0]


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("", "is not an SRDF file"),
        (HEAD + "<disable_collisions", r"arm\.srdf:3: is not an SRDF file"),
        (HEAD + '<disable_collisions link1="l1"/></robot>', r"arm\.srdf:3: .* needs link2="),
        (HEAD + pair("l1", "l1") + "</robot>", r"arm\.srdf:3: pairs 'l1' with itself"),
        ("<!DOCTYPE x><robot/>", "declares a document type"),
        ("<svg/>", r"arm\.srdf:1: .* begins with <svg>"),
    ],
)
def test_damaged_ones_are_refused_with_file_and_line(
    tmp_path: Path, text: str, message: str
) -> None:
    urdf = written(tmp_path)
    urdf.with_suffix(".srdf").write_text(text, "utf-8")
    with pytest.raises(InputError, match=message) as caught:
        load_urdf(urdf)
    assert str(caught.value).count("arm.srdf") == 1


@given(st.binary(max_size=200) | st.text(max_size=80).map(lambda t: (HEAD + t).encode()))
def test_garbage_is_refused_or_read(tmp_path_factory: pytest.TempPathFactory, data: bytes) -> None:
    path = tmp_path_factory.getbasetemp() / "garbage.srdf"
    path.write_bytes(data)
    try:
        read_srdf(path, "crane", LINKS)
    except FlybyError as error:
        assert "garbage.srdf" in str(error)


def test_pairs_are_kept_in_catalogue_files(tmp_path: Path) -> None:
    robot = load_urdf(
        written(tmp_path, pair("l1", "l3"), pair("base_link", "l2", "a &quot;b&quot;"))
    )
    kept = tmp_path / "kept.toml"
    kept.write_text(robot_text(robot), "utf-8")
    assert load_robot(kept).may_touch == robot.may_touch
    kept.write_text(robot_text(robot).replace("[1, 3]", "[3, 1]"), "utf-8")
    with pytest.raises(InputError, match=r"kept\.toml.*links.*the lower first"):
        load_robot(kept)


def test_scenes_leave_them_out_and_say_so(tmp_path: Path) -> None:
    scenes = [
        CollisionScene(Cell(load_urdf(written(tmp_path, *entries)), "ur"))
        for entries in ((), (pair("l1", "l3"), pair("l2", "l3", "Adjacent")))
    ]
    names = [{scene.pair_names(k) for k in range(len(scene.pairs))} for scene in scenes]
    assert names[0] - names[1] == {("j1", "j3")}
    told = "pairs allowed to touch by arm.srdf: j1 and j3 (Never), j2 and j3 (Adjacent)"
    assert [note.message for note in scenes[1].notes] == [told]
    reasons = {(e.first, e.second): e.reason for e in scenes[1].exclusions}
    assert reasons["j1", "j3"] == "allowed by arm.srdf (Never)"


def test_a_cell_names_its_urdf_and_srdf(tmp_path: Path) -> None:
    written(tmp_path, pair("l1", "l3"))
    (tmp_path / "mine.srdf").write_text(HEAD + pair("base_link", "l2") + "</robot>", "utf-8")
    cell = tmp_path / "cell.toml"
    cell.write_text('robot = "urdf/arm.urdf"\nvendor = "ur"\nsrdf = "mine.srdf"\n', "utf-8")
    registry = Registry({"ur": find_vendor("ur")})
    assert [(p.first, p.second) for p in load_cell(cell, registry).robot.may_touch] == [(0, 2)]
    cell.write_text('robot = "ur/ur10e"\nsrdf = "mine.srdf"\n', "utf-8")
    with pytest.raises(InputError, match="srdf"):
        load_cell(cell, registry)
