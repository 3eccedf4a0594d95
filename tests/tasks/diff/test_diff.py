"""Two states of a station, driven and laid side by side."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

import flyby
from flyby.core.difference.differences import Differing
from flyby.core.errors import InputError

from ...vendors.abb.backup.station import MAIN, USER, Station, multimove, one_robot
from ...vendors.ur.conftest import Build

ROBOT = "abb/irb6640-180-255"


@pytest.fixture
def build() -> Build:
    return Build()


def station(folder: Path, main: str = MAIN, **more: object) -> Path:
    tasks = {"TASK1": ("T_ROB1", {"PROGMOD/MainModule.mod": main, "SYSMOD/user.sys": USER})}
    Station(tasks=tasks, **more).write(folder)
    return folder


def test_a_state_does_not_differ_from_itself(tmp_path: Path) -> None:
    one, other = station(tmp_path / "a"), station(tmp_path / "b")
    found = flyby.diff(one, other)
    assert not found.differs
    assert found.differences == () and found.files == ()
    assert {routine.name for routine in found.routines} == {"Main", "Pick", "Service"}


def test_what_changed_in_the_text_and_what_it_does(tmp_path: Path) -> None:
    new = MAIN.replace("[[100,0,300]", "[[104,0,303]").replace("v500, fine", "v200, fine")
    new = new.replace("[12.5,0,180]", "[12.5,0,190]").replace(", z10, ", ", z50, ")
    found = flyby.diff(station(tmp_path / "a"), station(tmp_path / "b", new))
    shown = {(d.subject, d.name): d for d in found.differences}
    assert shown[Differing.POINT, "p10"].distance == pytest.approx(0.005)
    assert shown[Differing.TOOL, "tGripper"].distance == pytest.approx(0.010)
    # The second move's target is reckoned from the first one's.
    assert {subject for subject, _ in shown} == {
        *(Differing.POINT, Differing.TOOL, Differing.SPEED, Differing.ZONE, Differing.TARGET)
    }
    pick = next(routine for routine in found.routines if routine.name == "Pick")
    assert pick.times[1] > pick.times[0] + 0.1
    assert 0.003 < pick.distance < 0.03
    (file,) = found.files
    assert file.kind == "changed"


def test_a_fault_that_appeared_is_named_and_one_that_is_mended(tmp_path: Path) -> None:
    far = MAIN.replace("[[100,0,300]", "[[9100,0,300]")
    found = flyby.diff(station(tmp_path / "a"), station(tmp_path / "b", far))
    pick = next(routine for routine in found.routines if routine.name == "Pick")
    assert any("cannot be reached" in fault for fault in pick.faults)
    assert pick.mended == () and pick.times[1] is None and pick.distance is None
    back = flyby.diff(tmp_path / "b", tmp_path / "a")
    pick = next(routine for routine in back.routines if routine.name == "Pick")
    assert any("cannot be reached" in fault for fault in pick.mended)


def test_stations_differ_in_ranges_bases_and_signals(tmp_path: Path) -> None:
    one = station(tmp_path / "a")
    other = station(tmp_path / "b", moc=one_robot("-base_frame_pos_z 0.2"))
    found = flyby.diff(one, other)
    assert [d.subject for d in found.differences] == [Differing.BASE]
    apart = [routine.distance for routine in found.routines if routine.distance is not None]
    assert max(apart) == pytest.approx(0.2, abs=1e-3)


def test_of_several_tasks_routines_are_called_with_them(tmp_path: Path) -> None:
    found = flyby.diff(multimove().write(tmp_path / "a"), station(tmp_path / "b"))
    assert "T_ROB2/Pick" in {routine.name for routine in found.routines}
    assert Differing.ROBOT in {d.subject for d in found.differences}


def test_programs_of_a_named_robot(tmp_path: Path) -> None:
    old, new = tmp_path / "old.mod", tmp_path / "new.mod"
    old.write_text(MAIN, "ascii")
    new.write_text(MAIN.replace("MoveL Offs(p10,0,200,0)", "MoveJ Offs(p10,0,200,0)"), "ascii")
    found = flyby.diff(old, new, robot=ROBOT)
    moves = {(d.kind, d.before[:5], d.after[:5]) for d in found.differences}
    assert moves == {("removed", "MoveL", ""), ("added", "", "MoveJ")}


def test_folders_of_program_trees_are_driven_and_compared(build: Build, tmp_path: Path) -> None:
    for name, radius in (("a", "0.01"), ("b", "0.03")):
        steps = [
            build.fixed("A", (0.1, -1.4, 1.6, -1.8, -1.5, 0.2)),
            build.fixed("B", (0.3, -1.2, 1.5, -1.9, -1.6, 0.1), f'blendRadius="{radius}"'),
            build.fixed("C", (0.5, -1.3, 1.6, -1.9, -1.5, 0.4)),
        ]
        build.packed(tmp_path / name / "default.installation", build.installation())
        text = build.program(build.move(*steps, kind="MoveL", speed=0.3))
        build.packed(tmp_path / name / "job.urp", text)
    found = flyby.diff(tmp_path / "a", tmp_path / "b")
    (routine,) = found.routines
    assert routine.times[0] > routine.times[1] > 0.5 and routine.distance > 1e-3
    assert [d.subject for d in found.differences] == [Differing.ZONE]
    assert [(file.name, file.added) for file in found.files] == [("job.urp", 1)]


def test_a_tool_with_two_names_is_said_once(build: Build, tmp_path: Path) -> None:
    """Its program calls it tcp, the installation gripper."""
    steps = build.fixed("A", (0.1, -1.4, 1.6, -1.8, -1.5, 0.2))
    longer = re.sub(r'offset="[^"]*"', 'offset="0, 0, 0.5, 0, 0, 0"', build.installation())
    for name, installation in (("a", build.installation()), ("b", longer)):
        build.packed(tmp_path / name / "default.installation", installation)
        build.packed(tmp_path / name / "job.urp", build.program(build.move(steps)))
    tools = [d for d in flyby.diff(tmp_path / "a", tmp_path / "b").differences if d.distance]
    assert [one.name for one in tools if one.subject is Differing.TOOL] == ["tcp, gripper"]


def test_what_stands_beside_a_program_counts_in_folders_that_are_named(tmp_path: Path) -> None:
    for name, x in (("a", 900), ("b", 905)):
        (tmp_path / name).mkdir()
        (tmp_path / name / "Main.mod").write_text(MAIN, "ascii")
        data = f"MODULE Data\nCONST num nX:={x};\nENDMODULE\n"
        (tmp_path / name / "Data.mod").write_text(data, "ascii")
    found = flyby.diff(tmp_path / "a", tmp_path / "b", robot=ROBOT)
    assert [(file.name, file.added, file.removed) for file in found.files] == [("Data.mod", 1, 1)]
    assert not flyby.diff(tmp_path / "a/Main.mod", tmp_path / "b/Main.mod", robot=ROBOT).differs


def test_what_cannot_be_read_is_refused(tmp_path: Path) -> None:
    with pytest.raises(InputError, match="there is no such file"):
        flyby.diff(tmp_path / "a.mod", tmp_path / "b.mod", robot=ROBOT)
