"""Archives of KUKA controllers, opened: whole ones, parts of them, copies, contradictions."""

from __future__ import annotations

import math
from pathlib import Path

import numpy as np
import pytest

import flyby
from flyby.core.backup.backup import Backup, SignalKind
from flyby.core.errors import InputError
from flyby.core.motion.emulator.controller import Controller
from flyby.core.program.program import Program
from flyby.core.registry import find_robot, find_vendor
from flyby.core.robot.joint import ExternalRole
from flyby.core.source.execution.answers import Answers, key
from flyby.vendors.kuka.backup.marks import layout_of
from flyby.vendors.kuka.backup.opener import OPENER

from ..machine_data.data_lists import external_axis, machine_data, robcor
from .archives import CONFIG, KR16, NAME, archive, kr_c2, programs, written


def opened(folder: Path, files) -> Backup:
    written(folder, files)
    names = [p.relative_to(folder).as_posix() for p in folder.rglob("*") if p.is_file()]
    root = OPENER.root_in(names)
    assert root is not None
    return OPENER.open(folder, folder / root, find_robot)


def said(backup: Backup) -> str:
    return "\n".join(map(str, backup.notes))


def read(backup: Backup, entry: str, answers: Answers | None = None) -> Program:
    """An entry's program, as the commands read it."""
    main = backup.tasks[0]
    (chosen,) = [one for one in main.entries if one.name == entry]
    beside = [backup.root / name for name in main.files if name != chosen.file]
    return find_vendor("kuka").read_file(
        backup.root / chosen.file, chosen.name, backup.robots[0].robot, answers, beside=beside
    )


def test_a_whole_one(tmp_path) -> None:
    backup = opened(tmp_path, archive("V8.6.10"))
    assert (backup.vendor, backup.version) == ("kuka", "V8.6.10")
    assert backup.controller == "CELL_7, serial number 0658424"
    (robot,) = backup.robots
    assert (robot.unit, robot.written, robot.lacks) == ("CELL_7", "KR16-2 C4 FLR", ())
    assert robot.robot is not None and robot.robot.name == "kuka/kr16-2"
    assert robot.robot.payload == 16.0
    q = np.radians([10, -80, 70, 20, 30, 40])
    np.testing.assert_allclose(
        robot.robot.flange_pose(q).position, KR16.flange_pose(q).position, atol=1e-6
    )
    assert not backup.notes
    # Filters of 144 and 96 ms.
    value, origin = backup.motion["time.joint_smoothing_s"]
    assert value == pytest.approx([0.072] * 2) and "$DEF_FLT_PTP, 144 ms" in origin
    value, origin = backup.motion["time.smoothing_s"]
    assert value == pytest.approx([0.048] * 2) and "$DEF_FLT_CP, 96 ms" in origin
    value, origin = backup.motion["limit.reorientation_acceleration"]
    assert value == pytest.approx(math.radians(120.0)) and "DEF_ACC_ORI1" in origin


def test_tools_bases_homes_and_signals(tmp_path) -> None:
    backup = opened(tmp_path, archive())
    gripper = backup.tools["TOOL_DATA[1]"]
    assert gripper.name == "TOOL_DATA[1]" and gripper.robot_held
    assert backup.comments == {"TOOL_DATA[1]": "Greifer groß", "BASE_DATA[1]": "Tisch"}
    assert gripper.tcp.position == pytest.approx((0.0, 0.0, 0.15))
    assert gripper.load is not None
    assert (gripper.load.mass, gripper.load.inertia) == (6.5, (0.1, 0.2, 0.3))
    assert gripper.load.centre == pytest.approx((0.01, 0.0, 0.08))
    assert list(backup.tools) == ["TOOL_DATA[1]", "BASE_DATA[2]"]
    assert not backup.tools["BASE_DATA[2]"].robot_held  # BASE_TYPE #TCP
    assert list(backup.frames) == ["TOOL_DATA[2]", "BASE_DATA[1]"]
    assert backup.frames["TOOL_DATA[2]"].robot_held
    table = backup.frames["BASE_DATA[1]"].pose
    assert table.position == pytest.approx((0.9, -0.2, 0.4))
    assert np.degrees(backup.homes["XHOME"].joints) == pytest.approx([0, -90, 90, 0, 10, 0])
    assert list(backup.homes) == ["XHOME", "XHOME1"] and backup.homes["XHOME1"].external == ()
    assert [(one.name, one.kind, one.address) for one in backup.signals] == [
        ("GRIPPER", SignalKind.DIGITAL_OUTPUT, "$OUT[12]"),
        ("PART_NO", SignalKind.GROUP_INPUT, "$IN[1] to $IN[8]"),
        ("GLUE", SignalKind.ANALOG_OUTPUT, "$ANOUT[1]"),
    ]


def test_programs_by_number_and_submits(tmp_path) -> None:
    main, submit = opened(tmp_path, archive()).tasks
    assert (main.name, main.robot, main.main, main.entry) == ("R1", 0, "KRC/R1/cell.src", "CELL")
    assert [(one.name, one.comment, one.parameters, one.moves) for one in main.entries] == [
        ("CELL", "chooses by program number", (), 6),
        ("PICK", "program number 1", (), 4),
        ("PLACE", "program number 2,3", (), 2),
        ("APPROACH", "", ("UP",), 1),
    ]
    assert "KRC/R1/System/$config.dat" in main.files
    assert not [name for name in main.files if "Mada" in name or name.startswith("C/")]
    assert (submit.name, submit.robot, submit.main) == ("sps", None, "KRC/R1/System/sps.sub")
    assert submit.entry == "SPS" and not submit.entries


def test_a_cell_that_calls_nothing_is_the_operators_choice(tmp_path) -> None:
    files = archive()
    cell = files["KRC/R1/cell.src"]
    assert isinstance(cell, str)
    files["KRC/R1/cell.src"] = cell.replace("PICK (", ";PICK (").replace("PLACE (", ";PLACE (")
    main = opened(tmp_path, files).tasks[0]
    assert main.main is None and main.entry is None
    assert [one.name for one in main.entries] == ["PICK", "PLACE", "APPROACH"]


def cell_of(folder: Path, old: str, new: str) -> list[tuple[str, str]]:
    files = archive()
    cell = files["KRC/R1/cell.src"]
    assert isinstance(cell, str) and old in cell
    files["KRC/R1/cell.src"] = cell.replace(old, new)
    return [(one.name, one.comment) for one in opened(folder, files).tasks[0].entries]


def test_an_integrator_asks_for_another_number(tmp_path) -> None:
    assert cell_of(tmp_path, "SWITCH  PGNO", "SWITCH(JOB_OF_PLC)") == [
        ("CELL", "chooses by program number"),
        ("PICK", "program number 1"),
        ("PLACE", "program number 2,3"),
        ("APPROACH", ""),
    ]


def test_where_the_program_number_is_asked_for_no_other_counts(tmp_path) -> None:
    shift = "SWITCH SHIFT\n    CASE 9\n      PICK ( )\n    ENDSWITCH\n    SWITCH  PGNO"
    assert ("PICK", "program number 1") in cell_of(tmp_path, "SWITCH  PGNO", shift)


@pytest.mark.parametrize(
    ("old", "new"),
    [
        ("    SWITCH  PGNO ; Select with Programnumber\n    CASE 1\n", "    IF PGNO==1 THEN\n"),
        ("CASE 1\n", "CASE #MORNING\n"),
    ],
)
def test_a_cell_may_choose_otherwise(tmp_path, old: str, new: str) -> None:
    names = dict(cell_of(tmp_path, old, new))
    assert names["PICK"] == ""
    assert "PLACE" in names


@pytest.mark.parametrize("entry", ["PICK", "PLACE", "CELL"])
@pytest.mark.parametrize("made", [archive, kr_c2])
def test_entries_are_read_across_folders_and_driven(tmp_path, entry: str, made) -> None:
    backup = opened(tmp_path, made())
    (known,) = backup.robots
    assert known.robot is not None
    kuka = find_vendor("kuka").with_stated(known.robot, backup.motion)
    program = read(backup, entry)
    assert len(program.moves) == (2 if entry == "PLACE" else 4)
    if entry == "PICK":
        assert [move.tool.name for move in program.moves[1:]] == ["TOOL_DATA[1]"] * 3
        assert program.moves[2].work_object.name == "BASE_DATA[1]"
        load = program.moves[2].tool.load
        assert load is not None and load.mass == 6.5
    assert not [note for note in program.notes if "unknown routine" in str(note)]
    assert 0.3 < Controller(kuka, known.robot).run(program).duration < 20.0


@pytest.mark.parametrize(("number", "moves"), [(1, 4), (2, 2), (3, 2)])
def test_a_program_number_is_an_answer(tmp_path, number: int, moves: int) -> None:
    backup = opened(tmp_path, archive())
    asked = read(backup, "CELL")
    assert any("PGNO" in str(question) for question in asked.questions)
    program = read(backup, "CELL", Answers(values={key("PGNO"): number}))
    assert len(program.moves) == moves


def test_kr_c2(tmp_path) -> None:
    backup = opened(tmp_path, kr_c2())
    (known,) = backup.robots
    assert backup.version == "V4.1.7" and known.written == "KR16 FLR"
    assert known.robot is not None and known.robot.name == "kuka/kr16-2"
    assert "$RAISE_TIME" in known.robot.origins["acceleration"]
    assert backup.tasks[0].main == "KRC/R1/CELL.SRC"
    assert list(backup.homes) == ["XHOME", "XHOME1"]


def test_only_programs(tmp_path) -> None:
    backup = opened(tmp_path, programs("R1"))
    (known,) = backup.robots
    assert known.robot is None and "nothing says which robot it is" in known.lacks[0]
    assert len(backup.tasks[0].files) == 7
    assert said(backup) == ("no $config.dat is in it: tools, bases and homes are not known")


def test_only_the_robots_half(tmp_path) -> None:
    files = {name: text for name, text in archive().items() if "/R1/Mada/" in name}
    backup = opened(tmp_path, files)
    assert backup.robots[0].robot is not None and not backup.tasks
    assert "no programs are in it: no .src below R1" in said(backup)


def test_without_machine_data_the_name_says_the_robot(tmp_path) -> None:
    files = {name: text for name, text in archive().items() if "machine.dat" not in name}
    (known,) = opened(tmp_path / "a", files).robots
    assert known.robot is not None and known.robot.name == "kuka/kr16-2"
    assert "lengths, limits and place are those of its type" in known.lacks[0]
    files["KRC/R1/Mada/$robcor.dat"] = robcor("#KR16", 16.0)
    files["KRC/R1/System/$config.dat"] = CONFIG.replace("KR16-2", "Robot")
    (known,) = opened(tmp_path / "b", files).robots
    assert known.robot is None and "or several are" in known.lacks[0]


def test_damaged_machine_data(tmp_path) -> None:
    text = machine_data(KR16, NAME).replace("$LENGTH_B=", ";")
    rest = {"KRC/STEU/Mada/$machine.dat": "DEFDAT $MACHINE\nENDDAT\n"}
    (known,) = opened(tmp_path, {**archive(machine=text), **rest}).robots
    assert known.robot is not None and known.robot.name == "kuka/kr16-2"
    assert known.lacks[0].startswith("KRC/R1/Mada/$machine.dat: $LENGTH_B is missing: lengths")


def test_an_arm_that_is_not_modelled(tmp_path) -> None:
    text = machine_data(KR16, "#KR470 PA C4").replace("$DEF_A4FIX=FALSE", "$DEF_A4FIX=TRUE")
    (known,) = opened(tmp_path, archive(machine=text)).robots
    assert known.robot is None
    assert "KR470 PA C4 cannot be driven: its controller holds A4 at 0" in known.lacks[0]


def test_a_palletiser_of_the_catalogue_has_its_own_limits(tmp_path) -> None:
    text = machine_data(KR16, "#KR120R3200 PA C4").replace("$DEF_A4FIX=FALSE", "$DEF_A4FIX=TRUE")
    (known,) = opened(tmp_path, archive(machine=text)).robots
    assert known.robot is not None and known.robot.name == "kuka/kr120-r3200-pa"
    assert known.robot.joints[3].held
    assert known.robot.joints[0].upper == pytest.approx(KR16.joints[0].upper)
    assert any("lengths are those of its type" in doubt for doubt in known.robot.doubts)


def test_a_model_file_of_another_arm(tmp_path) -> None:
    files = archive()
    files["KRC/R1/Mada/$robcor.dat"] = robcor("#KR210R2700 EXTRA C4 FLR", 210.0)
    backup = opened(tmp_path, files)
    assert backup.robots[0].robot is not None and backup.robots[0].robot.payload == 16.0
    (note,) = [n for n in backup.notes if "$MODEL_NAME" in str(n)]
    assert "says KR210R2700 EXTRA C4 FLR" in str(note) and "rated load is left out" in str(note)


def test_copies_of_folders_are_said_once(tmp_path) -> None:
    files = archive()
    for name, text in programs().items():
        if "/Program/" in name:
            copy = str(text).replace("DECL E6AXIS XAPP", "DECL E6AXIS XOLD")
            files[name.replace("/Program/", "/Program/Copy of it/")] = copy
    backup = opened(tmp_path, files)
    (note,) = [n for n in backup.notes if "left out" in str(n)]
    assert str(note) == (
        "left out of KRC/R1/Program/Copy of it: HANDLING.src, PICK.dat, PICK.src, PLACE.dat, "
        "PLACE.src, which KRC/R1/Program has as well; names are global over an archive (other text "
        "in PICK.dat)"
    )
    assert not [name for name in backup.tasks[0].files if "Copy" in name]


def test_lines_that_make_no_sense_are_said(tmp_path) -> None:
    files = archive()
    config = CONFIG.replace("TOOL_DATA[1]={X 0.0", "TOOL_DATA[1]={X 0..0")
    files["KRC/R1/System/$config.dat"] = config
    backup = opened(tmp_path, files)
    assert "KRC/R1/System/$config.dat:5:1: TOOL_DATA[1] is left out" in said(backup)
    files["KRC/R1/Mada/$machine.dat"] = machine_data(KR16, NAME).replace(
        "$LENGTH_A=", "$LENGTH_A=?"
    )
    (known,) = opened(tmp_path, files).robots
    assert "$LENGTH_A has no value that is one" in known.lacks[0]


def test_a_copy_of_the_whole_archive_beside_it(tmp_path) -> None:
    files = archive() | {f"old/{name}": text for name, text in programs().items()}
    backup = opened(tmp_path, files)
    assert "old/KRC/R1 left out: KRC/R1 is read" in said(backup)
    assert not [name for name in backup.tasks[0].files if name.startswith("old")]


def test_a_file_that_is_no_text_is_left_out(tmp_path) -> None:
    files = archive()
    files["KRC/R1/Program/WIDE.src"] = "DEF WIDE()\nEND\n".encode("utf-16")[:-1]
    backup = opened(tmp_path, files)
    assert "left out: KRC/R1/Program/WIDE.src:1:1: the file begins as UTF-16" in said(backup)
    assert not [name for name in backup.tasks[0].files if "WIDE" in name]


def test_a_copy_of_workvisual(tmp_path) -> None:
    files = {name: text for name, text in archive().items() if name != "am.ini"}
    files["Connections.xml"] = (
        '<?xml version="1.0"?><Connections><Controller KssVersion="V8.3.27" Type="KR C4 compact"/>'
        "</Connections>"
    )
    backup = opened(tmp_path, files)
    assert (backup.controller, backup.version) == ("KR C4 compact", "8.3.27")


TRACK = """INT $EX_AX_NUM=2
$EX_KIN={ET1 #ERSYS,ET2 #EASYS,ET3 #NONE}
$ET1_AX={TR_A1 #E1,TR_A2 #NONE,TR_A3 #NONE}
$ET1_TA1KR={X 0.0,Y 0.0,Z 450.0,A 0.0,B 90.0,C 0.0}
$ET1_TFLA3={X 0.0,Y 0.0,Z 0.0,A 0.0,B -90.0,C 0.0}
$ET2_AX={TR_A1 #E2,TR_A2 #NONE,TR_A3 #NONE}
$ET2_TFLA3={X 0.0,Y 0.0,Z 300.0,A 0.0,B 0.0,C 0.0}
""" + "\n".join(
    [
        external_axis(7, linear=True, lower=-100, upper=5000, speed=1000.0),
        external_axis(8, linear=False, lower=-400, upper=400, speed=90.0),
    ]
)
MACHINES = """MACHINE_DEF[2]={NAME[] "TISCH",ROOT {X 1500.0,Y 200.0,Z 100.0},MECH_TYPE #EASYS}
MACHINE_FRAME_DAT[1]={MACH_DEF_INDEX 2,PARENT[] "TISCH",GEOMETRY[] " "}
ENDDAT
"""


def test_a_track_and_a_table(tmp_path) -> None:
    files = archive(machine=machine_data(KR16, NAME, extra=TRACK))
    files["KRC/R1/System/$config.dat"] = CONFIG.replace("ENDDAT\n", MACHINES)
    backup = opened(tmp_path, files)
    robot = backup.robots[0].robot
    assert robot is not None
    assert [(axis.name, axis.role) for axis in robot.external_axes] == [
        ("E1", ExternalRole.TRACK),
        ("E2", ExternalRole.TABLE),
    ]
    table = robot.external_axes[1].joint.placement
    assert table.position == pytest.approx((1.5, 0.2, 0.4))
    assert backup.frames["BASE_DATA[1]"].moved_by == "E2"
    assert backup.frames["BASE_DATA[1]"].user.position == pytest.approx((0.9, -0.2, 0.4))
    assert backup.homes["XHOME1"].external == pytest.approx((0.5, 0.0))
    assert not any("where the table" in lack for lack in backup.robots[0].lacks)
    program = read(backup, "PICK")
    assert program.moves[2].work_object.moved_by == "E2"
    assert program.moves[2].work_object.user.position == pytest.approx((0.9, -0.2, 0.4))


def test_a_base_on_a_table_that_is_not_there(tmp_path) -> None:
    files = archive()
    files["KRC/R1/System/$config.dat"] = CONFIG.replace("ENDDAT\n", MACHINES)
    backup = opened(tmp_path, files)
    assert "BASE_DATA[1] stands on TISCH, which is no table in $machine.dat" in said(backup)
    assert backup.frames["BASE_DATA[1]"].moved_by is None
    program = read(backup, "PICK")
    assert "MACHINE_FRAME_DAT[1] couples the base" in "".join(map(str, program.notes))
    at = program.moves[2].work_object.user.position
    assert at == pytest.approx((2.4, 0.0, 0.5))  # its root and the base on it


@pytest.mark.parametrize(
    ("names", "root"),
    [
        (["KRC/R1/Program/a.src"], ""),
        (["x/y/KRC/R1/Program/a.src", "x/README.md"], "x/y"),
        (["x/R1/System/$config.dat"], "x"),
        (["x/r1/MADA/$MACHINE.DAT"], "x"),
        (["krc/steu/mada/$machine.dat"], ""),
        (["Mada/$machine.dat", "Program/a.src"], ""),
        (["$machine.dat"], ""),
        (["x/System/$config.dat", "x/Program/a.src"], "x"),
        (["C/KRC/ROBOTER/KRC/R1/Mada/$machine.dat", "KRC/R1/cell.src"], ""),
        (["R1/readme.txt", "Program/a.src"], None),
        (["R1/a.src", "R2/a.src"], None),
        (["RAPID/TASK1/PROGMOD/Main.mod"], None),
        ([], None),
    ],
)
def test_where_it_begins(names: list[str], root: str | None) -> None:
    assert OPENER.root_in(names) == root


def test_where_its_parts_are() -> None:
    names = ["a/KRC/R1/Program/x.src", "a/KRC/STEU/Mada/$machine.dat", "b/R1/TP/y.src"]
    layout = layout_of(names)
    assert (layout.robot, layout.controller) == ("a/KRC/R1", "a/KRC/STEU")
    assert layout.copies == ("b/R1",)


def test_what_is_none(tmp_path) -> None:
    (tmp_path / "a.sub").write_text("DEF a()\nEND\n")
    with pytest.raises(InputError, match="no archive of a KUKA controller"):
        OPENER.open(tmp_path, tmp_path, find_robot)


@pytest.mark.parametrize("room", ["Folgen/Folge1.src", "UPs/UP99.src", "Makros/Makro0.src"])
def test_an_archive_of_a_vkrc_has_its_arm_and_tools(tmp_path, room: str) -> None:
    """Programs in Volkswagen's folders are not driven, whatever else is there."""
    own = {f"KRC/R1/{room}": "DEF FOLGE1( )\nPTP {A1 10}\nEND\n"}
    whole = opened(tmp_path / "whole", archive())
    made = opened(tmp_path / "vw", archive() | own)
    assert (made.robots, made.tools, made.frames) == (whole.robots, whole.tools, whole.frames)
    assert all(room not in file for task in made.tasks for file in task.files)
    assert "a VKRC (VW System Software)" in said(made) and "for a KSS controller" in said(made)
    with pytest.raises(InputError, match="a VKRC"):
        opened(tmp_path / "alone", own)


def test_a_project_of_workvisual_is_refused_by_its_cause(tmp_path) -> None:
    (tmp_path / "Cell.WVS").write_bytes(bytes(range(9)))
    for path in (tmp_path, tmp_path / "Cell.WVS"):
        with pytest.raises(InputError, match=r"Cell\.WVS is a project of WorkVisual.*archive"):
            flyby.open_backup(path)


@pytest.mark.parametrize("name", ["iiQKA_backup_2024/project.json", "export.zip/iiQWorks.meta"])
def test_what_iiqka_keeps_is_refused_by_its_name(tmp_path, name: str) -> None:
    file = tmp_path / "data" / name
    file.parent.mkdir(parents=True)
    file.write_text("{}")
    with pytest.raises(InputError, match=r"iiQ\S+ is of KUKA's iiQKA\.OS, .*not known here"):
        flyby.open_backup(tmp_path / "data")


def test_programs_that_are_called_so_are_read(tmp_path) -> None:
    """KRL of iiQKA.OS2 is KRL."""
    (tmp_path / "iiqka_demo.src").write_text("DEF iiqka_demo()\nPTP {A1 10}\nEND\n")
    assert len(flyby.read(tmp_path / "iiqka_demo.src", robot="kuka/kr16-2").moves) == 1


def test_two_archives_are_a_station(tmp_path: Path) -> None:
    """Called as their files; where the world of each controller is the station file says, and each
    drives there as it did at home."""
    folders = [written(tmp_path / name, archive()) for name in ("left", "right")]
    with pytest.raises(InputError, match=r"left and right stand at one place.*world = "):
        flyby.station(folders)
    text = "clearance_mm = 5\n"
    for k, folder in enumerate(folders):
        world = f"world = {{ xyz_mm = [{5000 * k}, 300, 0], abc_deg = [{150 * k}, 0, 0] }}"
        text += f'[robot.{folder.name}]\nprogram = "{folder.name}"\n{world}\n'
    file = tmp_path / "station.toml"
    file.write_text(text)
    made = flyby.station(file)
    (pair,) = made.clearances
    assert made.clear and pair.any_time.proven
    left, right = (member.run.trajectory for member in made.station.members.values())
    assert np.allclose(left.q, right.q, atol=1e-9)
    turned = math.radians(150.0)
    x, y, z = (left.position - np.array([0.0, 0.3, 0.0])).T
    there = np.stack(
        [
            5.0 + math.cos(turned) * x - math.sin(turned) * y,
            0.3 + math.sin(turned) * x + math.cos(turned) * y,
            z,
        ],
        -1,
    )
    assert np.allclose(right.position, there, atol=1e-9)
    with pytest.raises(InputError, match="world of its own"):
        flyby.station_zones(file)
