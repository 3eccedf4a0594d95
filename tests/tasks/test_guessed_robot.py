"""Programs that are driven though nobody says for which robot they are."""

from __future__ import annotations

from pathlib import Path

import pytest

import flyby
from flyby.core.errors import FlybyError, InputError, OptionError
from flyby.core.registry import all_listed, find_vendor
from flyby.tasks.options.guessed_robot import read_or_guess, with_robot
from flyby.tasks.read import SourceOptions, read_with

from ..vendors.abb.backup.station import Station, one_robot

UNUSED = "[9E9,9E9,9E9,9E9,9E9,9E9]"


def rapid(folder: Path, *moves: str, head: str = "") -> Path:
    file = folder / "a.mod"
    body = "\n".join(moves)
    file.write_text(f"MODULE M\n{head}\nPROC main()\n{body}\nENDPROC\nENDMODULE\n", "utf-8")
    return file


def at(x: float, y: float, z: float, tool: str = "tool0") -> str:
    return f"MoveJ [[{x},{y},{z}],[0,0,1,0],[0,0,0,0],{UNUSED}],v100,fine,{tool};"


def taken(file: Path) -> tuple[str | None, str]:
    options, notes = with_robot(file, SourceOptions())
    name = options.robot if isinstance(options.robot, str) else getattr(options.robot, "name", None)
    return name, " ".join(note.message for note in notes)


def test_an_arm_that_drives_the_program_is_taken_and_said(tmp_path: Path) -> None:
    file = rapid(tmp_path, at(1700, 100, 900), at(1700, 200, 900))
    robot, said = taken(file)
    program = read_or_guess(file, SourceOptions())
    assert robot is not None and program.setup.robot.name == robot
    assert f"nobody says which robot it is: {robot} is taken: " in said
    assert "can take the 2 places that the program says; robot says another" in said
    assert said in program.notes[0].message


@pytest.mark.parametrize(
    ("head", "robot"),
    [("! Cell 3: IRB 1600-6/1.45, pick", "abb/irb1600-6-145"), ("! (IRB1600_6_145)", None)],
)
def test_the_arm_that_the_text_names_goes_first(
    tmp_path: Path, head: str, robot: str | None
) -> None:
    found, said = taken(rapid(tmp_path, at(600, 0, 600), at(600, 50, 600), head=head))
    assert found == (robot or "abb/irb1600-6-145")
    assert "stands in its text or folder" in said


def test_a_folder_names_the_arm_too(tmp_path: Path) -> None:
    folder = tmp_path / "cell_irb4600-60-205"
    folder.mkdir()
    found, said = taken(rapid(folder, at(1200, 0, 900), at(1200, 50, 900)))
    assert found == "abb/irb4600-60-205" and "'irb4600-60-205' stands in" in said


def test_a_backup_that_says_nothing_of_its_robot_is_driven_by_one(tmp_path: Path) -> None:
    folder = tmp_path / "PROGMOD"
    folder.mkdir()
    rapid(folder, at(1200, 0, 900), at(1200, 50, 900), head="! by the IRB 4600-60/2.05")
    robot, said = taken(tmp_path)
    assert robot == "abb/irb4600-60-205" and "stands in its text or folder" in said
    program = read_or_guess(tmp_path, SourceOptions())
    assert len(program.moves) == 2 and program.setup.robot.name == robot
    with pytest.raises(OptionError, match=r"which robot is .* for.*abb/irb4600-60-205"):
        with_robot(tmp_path, SourceOptions(), writes=True)
    syspar = tmp_path / "SYSPAR"
    syspar.mkdir()
    text = 'MOC:CFG_1.0:6:0::\n#\nROBOT:\n\n      -name "ROB_1" -use_robot_type "ROB1_777_9.9_1"\n'
    (syspar / "MOC.cfg").write_text(text)
    assert taken(tmp_path) == (None, "")


def test_what_hangs_on_an_unknown_tool_counts_where_nothing_else_does(tmp_path: Path) -> None:
    robot, said = taken(rapid(tmp_path, at(1700, 0, 900, "tGun"), at(1700, 90, 900, "tGun")))
    assert robot is not None
    assert "with its unknown tools and frames as they are assumed" in said


@pytest.mark.parametrize(
    "body", ["MoveJ pNowhere,v100,fine,tool0;", "MoveJ ) p;", 'TPWrite "hello";']
)
def test_a_program_that_says_no_place_is_read_for_some_arm(tmp_path: Path, body: str) -> None:
    robot, said = taken(rapid(tmp_path, body))
    assert robot is not None and "one of middle reach, as the program says no place" in said


def test_the_true_cause_is_said_where_no_robot_is_named(tmp_path: Path) -> None:
    program = read_or_guess(rapid(tmp_path, "MoveJ pNowhere,v100,fine,tool0;"), SourceOptions())
    with pytest.raises(FlybyError, match="pNowhere"):
        flyby.emulate(program)


def test_where_no_arm_takes_all_places_one_is_taken_that_drives_most(tmp_path: Path) -> None:
    file = rapid(tmp_path, at(700, 0, 600), at(700, 90, 600), at(9000, 0, 600), at(700, 0, 500))
    robot, said = taken(file)
    assert "none can take all its places" in said
    (fault,) = flyby.emulate(flyby.read(file, robot=robot)).faults
    assert fault.move == 2


def test_an_arm_is_taken_that_drives_the_known_places_with_an_unknown_frame_put_right(
    tmp_path: Path,
) -> None:
    point = "MoveL [[%d,215,300],[0,0.7071,0.7071,0],[0,0,0,0]," + UNUSED + "],v100,fine,tool0"
    work = [point % x + "\\WObj:=wPallet;" for x in (0, 60)]
    file = rapid(tmp_path, at(1100, 300, 1100), at(1150, 900, 900), *work)
    robot, _ = taken(file)
    run = flyby.emulate(flyby.read(file, robot=robot))
    assert not run.faults and run.report.unknown == ("wPallet",)


def test_an_arm_of_seven_axes_is_taken_where_targets_have_a_value_for_the_seventh(
    tmp_path: Path,
) -> None:
    target = "[[%d,240,230],[0,0,1,0],[0,0,0,4],[-140,9E9,9E9,9E9,9E9,9E9]]"
    moves = [f"MoveL {target % x},v100,fine,tool0;" for x in (380, 420)]
    moves.append("MoveL " + (target % 400).replace("-140", "-135") + ",v100,fine,tool0;")
    robot, said = taken(rapid(tmp_path, *moves))
    assert robot == "abb/irb14000-05-056-left" and "a seventh axis, which targets name" in said


def test_postures_alone_are_driven_by_an_arm_of_middle_reach(tmp_path: Path) -> None:
    move = "MoveAbsJ [[0,0,0,0,%d,0]," + UNUSED + "],v100,fine,tool0;"
    robot, said = taken(rapid(tmp_path, move % 30, move % 60))
    assert robot is not None and "can take the 2 places" in said
    (reach,) = (arm.reach for arm in all_listed(find_vendor("abb")) if arm.name == robot)
    assert reach is not None and 1.2 < reach < 3.0


def test_postures_of_six_joints_are_those_of_an_arm_with_six_axes(tmp_path: Path) -> None:
    move = "MoveAbsJ [[0,0,0,0,0,0]," + UNUSED + "],v100,fine,tool0;"
    robot, _ = taken(rapid(tmp_path, move))
    (axes,) = (arm.axes for arm in all_listed(find_vendor("abb")) if arm.name == robot)
    assert axes == 6


@pytest.mark.parametrize(
    ("configuration", "head", "faults"),
    [(None, "", 0), ("exact", "", 1), (None, "! IRB 1600-6/1.45", 1)],
)
def test_configurations_of_another_arm_give_way_where_the_arm_is_guessed(
    tmp_path: Path, configuration: str | None, head: str, faults: int
) -> None:
    odd = at(700, 200, 700).replace("[0,0,0,0]", "[1,2,1,5]")
    file = rapid(tmp_path, at(700, 0, 700), odd, at(700, 100, 700), head=head)
    options = SourceOptions(configuration=configuration)
    found, notes = with_robot(file, options, gives_way=True)
    assert len(flyby.emulate(read_with(file, found)).faults) == faults
    assert ("give way to the nearest" in notes[0].message) == (not faults)
    plain, _ = with_robot(file, options)
    assert plain.configuration == configuration


def test_who_names_a_robot_is_heard(tmp_path: Path) -> None:
    file = rapid(tmp_path, at(600, 0, 600))
    options = SourceOptions(robot="abb/irb120-3-058")
    assert with_robot(file, options) == (options, ())


def test_a_program_that_begins_nowhere_is_judged_by_the_routine_that_drives_most(
    tmp_path: Path,
) -> None:
    file = tmp_path / "a.mod"
    near, far = at(300, 0, 400), [at(1900, 50 * k, 900) for k in range(3)]
    routines = "".join(
        f"PROC {name}()\n{body}\nENDPROC\n"
        for name, body in (("main", ""), ("rNear", near), ("rFar", "\n".join(far)))
    )
    file.write_text(f"MODULE M\n{routines}ENDMODULE\n", "utf-8")
    robot, said = taken(file)
    assert robot is not None and "can take the 3 places" in said


@pytest.mark.parametrize("suffix", ["mod", "src", "script"])
@pytest.mark.parametrize(("data", "is_"), [(b"", "empty"), (b" \r\n\n", "empty"),
                                           (b"\x7fELF\0\1", "binary"),
                                           (bytes(range(1, 256)), "binary")])  # fmt: skip
def test_a_file_that_is_no_text_is_named_as_that(tmp_path: Path, suffix, data, is_) -> None:
    file = tmp_path / f"a.{suffix}"
    file.write_bytes(data)
    with pytest.raises(InputError, match=f"a.{suffix} is {is_}"):
        read_or_guess(file, SourceOptions())


def test_a_text_in_any_encoding_is_one(tmp_path: Path) -> None:
    text = rapid(tmp_path, at(600, 0, 600), at(600, 50, 600), head="! Gr\xf6\xdfe").read_text(
        "utf-8"
    )
    for codec in ("utf-8", "utf-8-sig", "cp1252", "utf-16"):
        (tmp_path / "a.mod").write_bytes(text.encode(codec))
        assert taken(tmp_path / "a.mod")[0] is not None


def test_what_is_written_is_for_the_robot_that_somebody_names(tmp_path: Path) -> None:
    file = rapid(tmp_path, at(1700, 100, 900), at(1700, 200, 900))
    robot, _ = taken(file)
    for option in ("robot", "--from"):
        with pytest.raises(InputError, match=rf"say it, {option}[= ]{robot} if it is this one"):
            with_robot(file, SourceOptions(), writes=True, option=option)
    named = SourceOptions(robot=robot)
    assert with_robot(file, named, writes=True) == (named, ())


def test_a_program_in_a_backup_is_for_the_robot_of_that(tmp_path: Path) -> None:
    backup = Station().write(tmp_path / "Backup_1")
    (main,) = backup.rglob("MainModule.mod")
    robot, said = taken(main)
    assert robot == "abb/irb4600-40-255" and "the robot of the backup around" in said
    for folder in (main.parent, main.parent.parent, backup / "RAPID"):
        options, (note,) = with_robot(folder, SourceOptions())
        assert options.robot == flyby.open_backup(backup).robots[0].robot
        assert f"the robot of the backup around {folder}" in note.message
    assert taken(backup) == (None, "")  # it says so itself
    strange = Station(products=("English", "IRB 9990-77/9.9"), moc=one_robot(kind="9990_9.9_77"))
    other = strange.write(tmp_path / "Backup_2")
    (main,) = other.rglob("MainModule.mod")
    with pytest.raises(InputError) as caught:  # there is one, and it is not known
        read_or_guess(main, SourceOptions())
    said = str(caught.value)
    assert f"{main} lies in a backup, whose robot is ROB1_9990_9.9_77: " in said
    assert said.endswith("name one that will do, robot=NAME")


def test_a_backup_that_names_no_arm_is_driven_by_one_that_can(tmp_path: Path) -> None:
    folder = tmp_path / "cell"
    point = "{X 900,Y %d,Z 800,A 0,B 180,C 0}"
    moves = "\n".join(f"PTP {point % (100 * k)}" for k in range(3))
    config = (
        "DEFDAT $CONFIG\nDECL FRAME TOOL_DATA[2]\nTOOL_DATA[1]={X 0,Y 0,Z 90,A 0,B 0,C 0}\nENDDAT\n"
    )
    main = folder / "Program" / "Sacks" / "main.src"
    main.parent.mkdir(parents=True)
    main.write_text(f"DEF main()\nBAS(#TOOL,1)\n{moves}\nEND\n", "utf-8")
    (folder / "System").mkdir()
    (folder / "System" / "$config.dat").write_text(config, "utf-8")
    for source, entry in ((main, None), (folder, "main"), (folder, None)):
        program = read_or_guess(source, SourceOptions(entry=entry))
        assert "can take the 3 places" in program.notes[0].message
        assert program.moves[0].tool.tcp.position == (0, 0, 0.09)
        assert not flyby.emulate(program).faults
