"""Programs are read of backups and written back into copies of them."""

from __future__ import annotations

import math
import shutil
import zipfile
from pathlib import Path

import pytest

import flyby
from flyby.core.collision.proof.certificate import scenes_of
from flyby.core.errors import FlybyError, InputError, OptionError, SourceError
from flyby.core.program.program import Program
from flyby.tasks.files.places import FilePlaces

from ...vendors.abb.backup.station import Station, multimove, one_robot
from ...vendors.ur.conftest import HOME, UR5E, Build


@pytest.fixture
def station(tmp_path: Path) -> Path:
    """A backup with a README beside its folder."""
    folder = tmp_path / "station"
    Station(moc=one_robot("-base_frame_pos_z 0.5")).write(folder / "Backup_1")
    (folder / "README.md").write_bytes(b"our cell\r\n")
    return folder


def packed(folder: Path) -> Path:
    """The same as an archive."""
    return Path(shutil.make_archive(str(folder), "zip", folder))


def contents(folder: Path) -> dict[str, bytes]:
    """Files below a folder, or of an archive."""
    if folder.is_dir():
        files = [path for path in folder.rglob("*") if path.is_file()]
        return {path.relative_to(folder).as_posix(): path.read_bytes() for path in files}
    with zipfile.ZipFile(folder) as archive:
        infos = [info for info in archive.infolist() if not info.is_dir()]
        return {info.filename: archive.read(info) for info in infos}


@pytest.mark.parametrize("archive", [False, True])
def test_robot_and_main_routine_come_from_the_backup(station: Path, archive: bool) -> None:
    program = flyby.read(packed(station) if archive else station)
    setup = program.setup
    assert setup.robot.name == "abb/irb4600-40-255"
    assert setup.robot.base.position == (0.0, 0.0, 0.5)
    assert setup.vendor.motion_of(setup.robot).period == pytest.approx(0.004032)
    run = flyby.emulate(program)
    assert run.faults == ()
    assert len(run.program.moves) == 3


def test_any_entry_with_arguments_or_of_another_module(station: Path) -> None:
    assert len(flyby.read(station, entry="pick").moves) == 2
    assert len(flyby.read(station, entry="Service").moves) == 2
    assert len(flyby.read(station, entry="At(p10)").moves) == 1
    named = {entry.name for entry in flyby.read(station, entry="all").entries}
    assert named == {"Main", "Pick", "At", "Service"}
    with pytest.raises(SourceError, match="Nowhere"):
        flyby.read(station, entry="Nowhere")


def test_what_the_user_names_takes_precedence(station: Path) -> None:
    program = flyby.read(station, robot="abb/irb4600-20-250")
    assert program.setup.robot.name == "abb/irb4600-20-250"


def test_of_several_tasks_one_has_to_be_named(tmp_path: Path) -> None:
    folder = multimove().write(tmp_path)
    with pytest.raises(OptionError, match=r"which task.*T_ROB1, T_ROB2; choose with task"):
        flyby.read(folder)
    assert flyby.read(folder, task="t_rob2").setup.robot.name == "abb/irb120-3-058"
    with pytest.raises(InputError, match=r"unknown task of .*'T_ROB3'"):
        flyby.read(folder, task="T_ROB3")
    with pytest.raises(InputError, match="nothing in T_WATCH can be run"):
        flyby.read(folder, task="T_WATCH")


def test_a_task_is_of_backups_alone(tmp_path: Path) -> None:
    path = tmp_path / "a.mod"
    path.write_text("MODULE a\nENDMODULE\n", "ascii")
    with pytest.raises(OptionError, match=r"task T_ROB1: .* is no backup with tasks"):
        flyby.read(path, robot="abb/irb120", task="T_ROB1")


def changed(source: Path, out: Path) -> list[Path]:
    """What is written where the zones of a program's moves have become stops."""
    program = flyby.read(source)
    return list(flyby.patch(flyby.zones(program, no_floor=True), out=out))


def test_a_copy_differs_in_the_changed_file_alone(station: Path, tmp_path: Path) -> None:
    out = tmp_path / "copy"
    (written,) = changed(station, out)
    before, after = contents(station), contents(out)
    assert before.keys() == after.keys()
    module = "Backup_1/RAPID/TASK1/PROGMOD/MainModule.mod"
    assert written == out / module
    assert {name for name in before if before[name] != after[name]} == {module}
    again = flyby.read(out)
    assert again.moves[1].zone != flyby.read(station).moves[1].zone


def test_a_copy_of_an_archive_is_a_folder_or_an_archive(station: Path, tmp_path: Path) -> None:
    archive = packed(station)
    (as_folder,) = changed(archive, tmp_path / "folder")
    (as_archive,) = changed(archive, tmp_path / "copy.zip")
    assert as_archive == tmp_path / "copy.zip"
    assert as_folder.name == "MainModule.mod"
    assert contents(tmp_path / "folder") == contents(tmp_path / "copy.zip")
    assert contents(archive).keys() == contents(as_archive).keys()
    assert flyby.read(as_archive).moves == flyby.read(tmp_path / "folder").moves


def test_copies_do_not_go_where_they_must_not(station: Path, tmp_path: Path) -> None:
    program = flyby.read(station)
    made = flyby.zones(program, no_floor=True)
    with pytest.raises(InputError, match="lies in the backup"):
        flyby.patch(made, out=station / "inside")
    with pytest.raises(InputError, match="is no archive: name a folder"):
        flyby.patch(made, out=tmp_path / "copy.zip")
    assert not (tmp_path / "copy.zip").exists()
    (tmp_path / "full").mkdir()
    flyby.patch(made, out=tmp_path / "full")
    with pytest.raises(InputError, match="exists already"):
        flyby.patch(made, out=tmp_path / "full")


ALONE = """MODULE MainModule
  CONST robtarget p10:=[[1400,0,1100],[0,0,1,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]];
  PROC Main()
    MoveJ p10, v1000, fine, tool0;
    MoveL Offs(p10,0,200,0), v500, z1, tool0;
    MoveL Offs(p10,0,200,300), v500, fine, tool0;
  ENDPROC
ENDMODULE
"""


def test_in_place_changes_folders_and_no_archives(tmp_path: Path) -> None:
    tasks = {"TASK1": ("T_ROB1", {"PROGMOD/MainModule.mod": ALONE})}
    station = tmp_path / "station"
    Station(tasks=tasks).write(station / "Backup_1")
    archive = packed(station)
    before = contents(station)
    program = flyby.read(archive)
    with pytest.raises(InputError, match="is an archive, of which a copy alone is written"):
        flyby.patch(flyby.zones(program, no_floor=True), in_place=True)
    program = flyby.read(station)
    flyby.patch(flyby.zones(program, no_floor=True), in_place=True)
    after = contents(station)
    assert [name for name in before if before[name] != after[name]] == [
        "Backup_1/RAPID/TASK1/PROGMOD/MainModule.mod"
    ]


def test_places_ask_for_one_of_both() -> None:
    places = FilePlaces(Path("a.zip"), True, [], False)
    with pytest.raises(OptionError, match="one place or the other"):
        places.check()


def test_a_cell_leaves_how_the_archive_says_its_arm_is_driven() -> None:
    """A file of what stands around does not take the controller's filters away."""
    examples = Path(__file__).parents[3] / "examples"
    press = {"source": examples / "kuka_archive", "entry": "PRESS"}
    alone = flyby.emulate(flyby.read(**press)).duration
    for named in ({"cell": examples / "cell/press.toml"}, {"robot": "kuka/kr16-2"}):
        assert flyby.emulate(flyby.read(**press, **named)).duration == pytest.approx(alone)


NARROW = ((-150, 150), (-80, 140), (-170, 70), (-300, 300), (-110, 110), (-360, 360))


def narrow(folder: Path) -> Path:
    """A backup whose arm turns less far than its type does, and stands on a plinth."""
    return Station(moc=one_robot("-base_frame_pos_z 0.5", NARROW)).write(folder)


def cell_file(path: Path, *lines: str, robot: str = "abb/irb4600-40-255") -> Path:
    path.write_text("\n".join([f'robot = "{robot}"', "clearance_mm = 1", *lines]))
    return path


def upper(program: Program) -> list[float]:
    return [math.degrees(joint.upper) for joint in program.setup.robot.joints]


@pytest.mark.parametrize("archive", [False, True])
def test_beside_a_cell_the_arm_is_the_backups(tmp_path: Path, archive: bool) -> None:
    folder = narrow(tmp_path / "station")
    source = packed(folder) if archive else folder
    bare = cell_file(tmp_path / "bare.toml")
    program = flyby.read(source, cell=bare)
    assert upper(program) == pytest.approx([high for _, high in NARROW])
    assert program.setup.robot.base.position == (0.0, 0.0, 0.5)
    assert program.setup.cell.robot == program.setup.robot
    assert "the cell's is taken" not in str(program.notes)
    limit = "[joint_limit.J1]\nrange_deg = [-90, 90]"
    said = cell_file(tmp_path / "said.toml", "base = { xyz_mm = [0, 0, 300] }", limit)
    program = flyby.read(source, cell=said)
    assert upper(program) == pytest.approx([90, *(high for _, high in NARROW[1:])])
    assert program.setup.robot.base.position == (0.0, 0.0, 0.3)
    told = "base at 0.0, 0.0, 500.0 mm, the cell at 0.0, 0.0, 300.0"
    assert any(told in str(note) for note in program.notes)
    program = flyby.read(source, robot="IRB 4600-40/2.55")
    assert upper(program) == pytest.approx([high for _, high in NARROW])


def test_a_cell_need_not_say_the_backups_tools_again(tmp_path: Path) -> None:
    """Of a tool it may say the shape alone; what it does say of it counts."""
    folder = tmp_path / "station"
    Station(moc=one_robot()).write(folder)
    used = {move.tool for move in flyby.read(folder).moves if move.tool.name != "tool0"}
    tool = next(iter(used))
    for more in ("", f"[tool.{tool.name}]\ncylinder_mm = [20, 50]\n"):
        program = flyby.read(folder, cell=cell_file(tmp_path / "cell.toml", more))
        assert program.setup.cell.tools[tool.name] == tool
        scenes = scenes_of(program.setup.cell)
        assert not any("TCP" in note.message for note in scenes(tool).notes)
    said = f"[tool.{tool.name}]\ntcp = {{ xyz_mm = [0, 0, 77] }}\n"
    program = flyby.read(folder, cell=cell_file(tmp_path / "cell.toml", said))
    assert program.setup.cell.tools[tool.name].tcp.position == (0.0, 0.0, 0.077)


def test_another_arm_than_the_backups_is_told(tmp_path: Path) -> None:
    folder = narrow(tmp_path / "station")
    program = flyby.read(folder, robot="abb/irb6640-180-255")
    assert program.setup.robot.name == "abb/irb6640-180-255"
    told = "the backup is of abb/irb4600-40-255: abb/irb6640-180-255 is driven, as it was named"
    assert told in [note.message for note in program.notes]


def test_every_task_takes_the_arm_of_the_backup(tmp_path: Path) -> None:
    """A move to where the type gets and this arm does not is a fault, whatever is asked for."""
    folder = narrow(tmp_path / "station")
    module = folder / "RAPID/TASK1/PROGMOD/MainModule.mod"
    module.write_text(module.read_text().replace("[[0,-20,20,0,60,0]", "[[160,-20,20,0,60,0]"))
    cell = cell_file(tmp_path / "cell.toml")
    program = flyby.read(folder, cell=cell)
    assert len(flyby.emulate(program).faults) == 1
    assert any("range" in found.message for found in flyby.check(program).errors)
    with pytest.raises(FlybyError, match="beyond its limit of 150"):
        flyby.zones(program)
    found = flyby.diff(folder, folder, cell=cell)
    assert any("Main" in one.name and one.lasting for one in found.routines)
    alone = flyby.read(folder)
    assert len(flyby.emulate(alone, cell=cell).faults) == 1


def test_a_folder_that_is_a_backup_and_holds_a_program_stays_one(tmp_path: Path) -> None:
    """The root of a KUKA archive holds ``cell.src``: beside a cell it is no folder of programs."""
    examples = Path(__file__).parents[3] / "examples"
    root = next((examples / "kuka_archive").rglob("R1"))
    whole = flyby.read(examples / "kuka_archive", entry="PRESS")
    alone = flyby.read(root, entry="PRESS", cell=examples / "cell/press.toml")
    assert len(alone.moves) == len(whole.moves)


def test_a_program_tree_beside_a_cell_keeps_its_own_calibration(tmp_path: Path) -> None:
    build = Build()
    rows = ((0.001, *UR5E[0][1:]), *UR5E[1:])
    step = build.move(build.fixed("A", HOME, rows=rows))
    build.packed(tmp_path / "job.urp", build.program(step, rows=rows))
    cell = cell_file(tmp_path / "cell.toml", robot="ur/ur5e")
    alone = flyby.read(tmp_path / "job.urp").setup.robot
    beside = flyby.read(tmp_path / "job.urp", cell=cell).setup.robot
    assert beside.joints == alone.joints
    assert beside.joints != flyby.robot("ur/ur5e").joints


def test_a_routine_that_is_not_there_is_told_from_one_that_nobody_names() -> None:
    archive = Path(__file__).parents[3] / "examples/kuka_archive"
    with pytest.raises(InputError, match=r"has no routine NOWHERE that moves the robot.*PRESS"):
        flyby.read(archive, entry="NOWHERE")
    with pytest.raises(InputError, match=r"which routine\?.*PRESS"):
        flyby.read(archive)


def test_the_tasks_of_a_backup_are_a_station(tmp_path: Path) -> None:
    folder = multimove().write(tmp_path)
    second = folder / "RAPID/TASK2/PROGMOD/Second.mod"
    second.write_text(second.read_text().replace("    Pick;\n", "", 1))  # beyond the small arm
    made = flyby.station(folder)
    assert list(made.station.members) == ["T_ROB1", "T_ROB2"]
    places = [member.cell.robot.base.position[1] for member in made.station.members.values()]
    assert places == [1.2, -1.2]
    (pair,) = made.clearances
    assert pair.least < 3.0 and made.deadlock is None
    assert any("of backups nobody says what joins" in str(note) for note in made.notes)
    file = tmp_path / "station.toml"
    file.write_text(
        "clearance_mm = 10\n"
        + "".join(
            f'[robot.{name}]\nprogram = "{folder.as_posix()}"\ntask = "{task}"\n'
            for name, task in (("left", "T_ROB1"), ("right", "T_ROB2"))
        )
    )
    again = flyby.station(file)
    assert again.duration == pytest.approx(made.duration)


def test_one_robot_is_no_station(station: Path, tmp_path: Path) -> None:
    with pytest.raises(InputError, match="1 of its tasks moves a robot"):
        flyby.station(station)
    empty = tmp_path / "nothing"
    empty.mkdir()
    with pytest.raises(InputError, match="neither a station file"):
        flyby.station(empty)
