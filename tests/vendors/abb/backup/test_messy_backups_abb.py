"""Backups with parts missing, damaged, renamed, and with other things beside them."""

from __future__ import annotations

import shutil
from pathlib import Path

import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from flyby.core.backup.backup import Backup
from flyby.core.errors import FlybyError, InputError
from flyby.core.registry import find_robot, find_vendor
from flyby.vendors.abb.backup.opener import OPENER

from .station import MAIN, USER, Station, arm_records, multimove, on_track, one_robot, robot_record

TASK = "RAPID/TASK1"


def opened(root: Path) -> Backup:
    return OPENER.open(root, root, find_robot)


def texts(backup: Backup) -> list[str]:
    return [str(note) for note in backup.notes]


def names_of(root: Path) -> list[str]:
    return [path.relative_to(root).as_posix() for path in root.rglob("*") if path.is_file()]


# where it begins


@pytest.mark.parametrize(
    ("names", "root"),
    [
        (["BACKINFO/backinfo.txt", "RAPID/TASK1/PROGMOD/m.mod"], ""),
        (["a/b/Backinfo/BACKINFO.TXT", "README.md", "a/old.zip"], "a/b"),
        (["x/BACKINFO/backinfo.txt", "x/HOME/old/BACKINFO/backinfo.txt"], "x"),
        (["HOME/old/BACKINFO/backinfo.txt", "BACKINFO/backinfo.txt"], ""),
        (["b/BACKINFO/backinfo.txt", "a/BACKINFO/backinfo.txt"], "a"),
        (["cell/Rapid/Task1/Progmod/m.mod", "cell/Syspar/Moc.cfg"], "cell"),
        (["cell/syspar/MOC.cfg"], "cell"),
        (["SYSPAR/EIO.cfg", "SYSPAR/SYS.cfg"], ""),
        (["params/MOC.CFG", "params/sys.cfg"], "params"),
        (["MOC.cfg"], ""),
        (["EIO.cfg", "main.mod"], None),
        (["main.mod", "user.sys"], None),
        (["KRC/R1/Program/a.src", "am.ini"], None),
        ([], None),
    ],
)
def test_roots(names: list[str], root: str | None) -> None:
    assert OPENER.root_in(names) == root


@given(st.lists(st.text(max_size=40), max_size=20))
def test_roots_are_among_the_folders(names: list[str]) -> None:
    root = OPENER.root_in(names)
    assert root is None or not root or any(name.startswith(f"{root}/") for name in names)


def test_a_folder_without_a_backup_is_refused(tmp_path: Path) -> None:
    (tmp_path / "main.txt").write_text(MAIN)
    with pytest.raises(InputError, match="no backup of an ABB controller"):
        opened(tmp_path)
    (tmp_path / "go.mod").write_text("module example.com/cell\n\ngo 1.21\n")
    with pytest.raises(InputError, match=r"nothing of this backup can be read: go\.mod"):
        opened(tmp_path)


def test_older_backups_inside_are_said(tmp_path: Path) -> None:
    root = Station().write(tmp_path / "new")
    assert not any("further backups" in one for one in texts(opened(root)))
    old = Station(products=("IRB 120-3/0.6",), moc=one_robot(kind="120_0.58_3"))
    shutil.copytree(old.write(tmp_path / "old"), root / "HOME" / "BACKUP_1")
    backup = opened(root)
    assert backup.robots[0].robot == opened(tmp_path / "new").robots[0].robot
    assert "left out, to be named by themselves: HOME/BACKUP_1" in " ".join(texts(backup))
    assert opened(root / "HOME" / "BACKUP_1").robots[0].written == "ROB1_120_0.58_3"


def test_a_backup_of_which_nothing_can_be_read_is_refused(tmp_path: Path) -> None:
    (tmp_path / "SYSPAR").mkdir()
    (tmp_path / "SYSPAR" / "MOC.cfg").write_bytes(bytes(range(256)))
    with pytest.raises(InputError, match=r"nothing of this backup.*MOC\.cfg is passed over"):
        opened(tmp_path)


# modules


def test_what_stands_beside_is_left_alone(tmp_path: Path) -> None:
    twin = MAIN.replace("MainModule", "Old").encode()
    station = Station(
        unlisted={
            f"{TASK}/PROGMOD/Old.mod": twin,
            f"{TASK}/TASK1/PROGMOD/MainModule.mod": MAIN.encode(),
            f"{TASK}/PROGMOD/prog.pgf": b"<Program><Module>MainModule.mod</Module></Program>",
            "HOME/MainModule.mod": MAIN.encode(),
            "README.md": b"# Cell 7",
            "backup.zip": b"PK\x03\x04",
            ".git/HEAD": b"ref: refs/heads/main",
        }
    )
    backup = opened(station.write(tmp_path))
    (note,) = texts(backup)
    assert note.startswith("not in the list of loaded modules, and so not read, are ")
    assert "PROGMOD/Old.mod" in note and "TASK1/TASK1/PROGMOD/MainModule.mod" in note
    assert len(backup.tasks[0].files) == 2


def test_missing_encoded_and_damaged_modules(tmp_path: Path) -> None:
    root = Station(
        tasks={
            "TASK1": (
                "T_ROB1",
                {
                    "PROGMOD/MainModule.mod": MAIN,
                    "SYSMOD/secret.sys": "",
                    "SYSMOD/gone.sys": "",
                    "SYSMOD/cut.sys": "",
                    "SYSMOD/user.sys": USER,
                },
            )
        }
    ).write(tmp_path)
    (root / TASK / "SYSMOD/secret.sys").write_bytes(b"\xfe\x01\x02 not for you")
    (root / TASK / "SYSMOD/gone.sys").unlink()
    (root / TASK / "SYSMOD/cut.sys").write_text("MODULE cut\n  PROC a()\n    MoveJ p1, v10")
    backup = opened(root)
    cut, gone, secret = texts(backup)
    assert cut.startswith(f"{TASK}/SYSMOD/cut.sys:3:1: the module is left out: ")
    assert "1 of 5 listed modules is not in the backup: gone.sys" in gone
    assert "only the controller can read encoded modules" in secret and "secret.sys" in secret
    assert backup.tasks[0].files == (f"{TASK}/PROGMOD/MainModule.mod", f"{TASK}/SYSMOD/user.sys")
    assert backup.tasks[0].entry == "Main"


def test_hidden_modules_and_names_of_other_spelling(tmp_path: Path) -> None:
    root = Station().write(tmp_path)
    info = root / "BACKINFO" / "backinfo.txt"
    text = info.read_text().replace("SYSMOD/user.sys @ user", "SYSMOD\\USER.SYS @ HIDDEN user")
    info.write_text(text.replace(">>TASK1: (T_ROB1,prog,)", ">>TASK1:\n(T_ROB1,prog,)"))
    shutil.move(root / "RAPID", root / "rapid")
    shutil.move(root / "SYSPAR", root / "Syspar")
    shutil.move(root / "Syspar/MOC.cfg", root / "Syspar/moc.CFG")
    backup = opened(root)
    assert not texts(backup)
    assert backup.tasks[0].files[1] == "rapid/TASK1/SYSMOD/user.sys"
    robot = backup.robots[0].robot
    assert robot is not None and robot.origins["range"].startswith("published: ARM")


def test_without_the_list_all_modules_are_loaded(tmp_path: Path) -> None:
    root = Station().write(tmp_path)
    shutil.rmtree(root / "BACKINFO")
    backup = opened(root)
    (note,) = texts(backup)
    assert "all modules of each task's folder are taken as loaded" in note
    (task,) = backup.tasks
    assert (task.name, task.robot, task.entry, len(task.files)) == ("T_ROB1", 0, "Main", 2)


@pytest.mark.parametrize(
    ("copied", "name", "main"),
    [
        ("RAPID", "TASK1", "TASK1/PROGMOD/MainModule.mod"),
        ("RAPID/TASK1", "TASK1", "PROGMOD/MainModule.mod"),
    ],
)
def test_a_folder_copied_out_of_a_backup(tmp_path: Path, copied: str, name: str, main: str) -> None:
    root = Station().write(tmp_path) / copied
    assert OPENER.root_in(names_of(root)) is None
    assert OPENER.programs_in(names_of(root)) == ""
    assert OPENER.programs_in([f"a/b/{one}" for one in names_of(root)]) == "a/b"
    (task,) = opened(root).tasks
    assert (task.name, task.robot, task.main, task.entry) == (name, 0, main, "Main")
    assert len(task.files) == 2


def test_names_that_are_declared_twice(tmp_path: Path) -> None:
    other = MAIN.replace("MainModule", "Other")
    station = Station(
        tasks={"TASK1": ("T_ROB1", {"PROGMOD/MainModule.mod": MAIN, "PROGMOD/Other.mod": other})}
    )
    backup = opened(station.write(tmp_path))
    (note,) = texts(backup)
    assert note == (
        f"{TASK}/PROGMOD/Other.mod is left out: it declares Main anew, which "
        f"{TASK}/PROGMOD/MainModule.mod has"
    )


def test_an_entry_that_is_nowhere(tmp_path: Path) -> None:
    station = Station(cab_tasks=('-Name "T_ROB1" -Entry "Production" -MotionTask',))
    backup = opened(station.write(tmp_path))
    (note,) = texts(backup)
    assert "its entry, PROC Production, is in none of the modules at hand" in note
    (task,) = backup.tasks
    assert (task.entry, task.main) == (None, f"{TASK}/PROGMOD/MainModule.mod")
    assert [entry.name for entry in task.entries] == ["Main", "Pick", "At", "Service"]


def test_programs_that_are_absent(tmp_path: Path) -> None:
    root = Station().write(tmp_path)
    shutil.rmtree(root / "RAPID")
    backup = opened(root)
    missing, empty = texts(backup)
    assert "2 of 2 listed modules are not in the backup: MainModule.mod, user.sys" in missing
    assert empty == "task T_ROB1 has no module that can be read"
    assert backup.tasks[0].main is None
    assert backup.robots[0].robot is not None and len(backup.signals) == 3


def test_routines_called_by_name_count(tmp_path: Path) -> None:
    text = (
        'MODULE M\n  PROC main()\n    %"part"+ValToStr(1)%;\n    CallByVar "job",2;\n  ENDPROC\n'
        "  PROC part1()\n    MoveL p, v10, fine, tool0;\n  ENDPROC\n"
        "  PROC job2()\n    part1;\n  ENDPROC\n  PROC idle()\n    WaitTime 1;\n  ENDPROC\n"
        "  FUNC num f()\n    part1;\n    RETURN 1;\n  ENDFUNC\n"
        "  PROC by_function()\n    VAR num n;\n    n:=f();\n  ENDPROC\nENDMODULE\n"
    )
    station = Station(tasks={"TASK1": ("T_ROB1", {"PROGMOD/M.mod": text})})
    backup = opened(station.write(tmp_path))
    entries = [entry.name for entry in backup.tasks[0].entries]
    assert entries == ["main", "part1", "job2", "by_function"]


# parameters


@pytest.mark.parametrize("topic", ["MOC", "SYS", "EIO"])
def test_parameters_that_are_absent(topic: str, tmp_path: Path) -> None:
    root = Station().write(tmp_path)
    (root / f"SYSPAR/{topic}.cfg").unlink()
    backup = opened(root)
    (task,) = backup.tasks
    assert (task.robot, task.entry) == (0, "Main")
    robot = backup.robots[0].robot
    assert robot is not None and robot.name == "abb/irb4600-40-255"
    if topic == "MOC":
        assert "MOC.cfg" in backup.robots[0].lacks[-1]
    said = texts(backup)
    assert len(said) == (topic == "SYS")
    assert all(note.startswith("SYS.cfg is not in the backup: ") for note in said)


def test_parameters_alone(tmp_path: Path) -> None:
    root = Station().write(tmp_path / "whole")
    for name in ("SYS.cfg", "MOC.cfg"):
        shutil.copy(root / "SYSPAR" / name, tmp_path / name)
    shutil.rmtree(root)
    backup = opened(tmp_path)
    assert not backup.tasks and not texts(backup)
    assert backup.robots[0].robot is not None


def test_arms_that_are_not_known(tmp_path: Path) -> None:
    station = Station(moc=one_robot(kind="6700_LeanID_2.65_220"), products=())
    backup = opened(station.write(tmp_path / "a"))
    (robot,) = backup.robots
    assert robot.robot is None
    (lack,) = robot.lacks
    assert "no arm ROB1_6700_LeanID_2.65_220 is known; near it are" in lack
    assert "abb/irb6700-235-265 (235 kg, 2.65 m)" in lack and "robot=NAME" in lack
    assert backup.tasks[0].robot == 0
    oblique = opened(Station(moc=one_robot(kind="580_16")).write(tmp_path / "b")).robots[0]
    assert oblique.robot is not None and oblique.robot.name == "abb/irb580-16"
    # The controller's product is of another model: it is not this arm.
    other = opened(Station(moc=one_robot(kind="9990_16")).write(tmp_path / "d")).robots[0]
    assert other.robot is None and "no arm ROB1_9990_16 is known" in other.lacks[0]
    none = Station(moc={"ARM": arm_records()["ARM"]}, products=())
    lacks = opened(none.write(tmp_path / "c")).robots[0].lacks
    assert lacks[0] == "the backup does not say which arm it is: name one, robot=NAME"


def test_ranges_that_make_no_sense(tmp_path: Path) -> None:
    moc = one_robot()
    moc["ARM"] = ['-name "rob1_1" -upper_joint_bound -1 -lower_joint_bound 1', *moc["ARM"][1:]]
    moc["ARM"][1] = '-name "rob1_2" -upper_joint_bound high'
    backup = opened(Station(moc=moc).write(tmp_path))
    first, second = texts(backup)
    assert "the range of rob1_1 makes no sense, so that of its type is taken" in first
    assert "upper_joint_bound of rob1_2 is no number" in second
    robot, own = backup.robots[0].robot, find_robot("abb/irb4600-40-255")
    assert robot is not None
    assert robot.joints[:2] == own.joints[:2]
    assert "states the ranges of 4 of 6 joints" in backup.robots[0].lacks[-1]


def test_units_that_no_arm_moves(tmp_path: Path) -> None:
    station = multimove()
    groups = ('-Name "rob1" -Robot "ROB_1"', '-Name "second" -Robot "ROB_2"', '-Name "stn"')
    station.sys = {"MECHANICAL_UNIT_GROUP": groups}
    station.cab_tasks = (
        *station.cab_tasks[:2],
        '-Name "T_WATCH" -UseMechanicalUnitGroup "stn" -MotionTask',
    )
    station.moc = {
        **station.moc,
        "ROBOT": [
            *station.moc["ROBOT"],
            '-name "ORB" -use_robot_type "IRBP_A250"',
        ],
        "SINGLE": [*station.moc["SINGLE"], '-name "CNV1" -use_single_type "CNV1"'],
    }
    said = texts(opened(station.write(tmp_path)))
    assert any("unit ORB (IRBP_A250) is no arm but a positioner" in note for note in said)
    assert "conveyors are not driven: CNV1; what lies on one is taken to stand still" in said
    assert "no arm moves the units STN1: they are taken to stand" in said
    assert "motion task T_WATCH moves no arm that is known: it is not driven" in said


@settings(
    max_examples=25, deadline=None, suppress_health_check=[HealthCheck.function_scoped_fixture]
)
@given(data=st.data())
def test_damage_never_fails_otherwise_than_by_messages(data: st.DataObject, tmp_path: Path) -> None:
    root = tmp_path / "station"
    shutil.rmtree(root, ignore_errors=True)
    station = data.draw(st.sampled_from([Station(), Station(moc=on_track()), multimove()]))
    station.write(root)
    for name in data.draw(st.lists(st.sampled_from(names_of(root)), max_size=4, unique=True)):
        path = root / name
        whole = path.read_bytes()
        kind = data.draw(st.sampled_from(["gone", "random", "cut", "hit", "folder"]))
        if kind in ("gone", "folder"):
            path.unlink()
            if kind == "folder":
                path.mkdir()
        elif kind == "random":
            path.write_bytes(data.draw(st.binary(max_size=200)))
        else:
            at = data.draw(st.integers(0, len(whole)))
            some = data.draw(st.binary(max_size=6)) if kind == "hit" else b""
            rest = whole[at + len(some) :] if kind == "hit" else b""
            path.write_bytes(whole[:at] + some + rest)
    try:
        backup = opened(root)
    except FlybyError:
        return
    for task in backup.tasks:
        assert task.robot is None or task.robot < len(backup.robots)
        assert all((root / file).is_file() for file in task.files)
        assert task.main is None or task.main in task.files
        if task.main is not None:
            try:
                find_vendor("abb").read_file(
                    root / task.main, others=[root / file for file in task.files]
                )
            except FlybyError:
                continue


def test_texts_with_robots_that_no_controller_has(tmp_path: Path) -> None:
    moc = one_robot()
    moc["ROBOT"] = [robot_record(1, more="-base_frame_orient_u0 3 -base_frame_pos_x nan")]
    backup = opened(Station(moc=moc).write(tmp_path))
    (note,) = texts(backup)
    assert "the base frame of ROB_1 is not taken" in note and "is no number" in note


@pytest.mark.parametrize(
    ("inside", "name"),
    [
        ("PROC a()\nENDPROC\nPROC a()\nENDPROC", "a"),
        ("LOCAL PROC b()\nENDPROC\nLOCAL PROC B()\nENDPROC", "B"),
        ("PERS num c:=1;\nPERS num c:=2;", "c"),
        ("RECORD r\nnum x;\nENDRECORD\nRECORD r\nnum y;\nENDRECORD", "r"),
        ("RECORD r\nnum x;\nnum x;\nENDRECORD", "r.x"),
    ],
)
def test_modules_that_contradict_themselves(inside: str, name: str, tmp_path: Path) -> None:
    twice = f"MODULE twice\n{inside}\nENDMODULE\n"
    modules = {"PROGMOD/MainModule.mod": MAIN, "PROGMOD/twice.mod": twice}
    backup = opened(Station(tasks={"TASK1": ("T_ROB1", modules)}).write(tmp_path))
    assert texts(backup) == [f"{TASK}/PROGMOD/twice.mod is left out: it declares {name} twice"]
    assert backup.tasks[0].entry == "Main"


@pytest.mark.parametrize("size", [30, 3000])
def test_moves_are_counted_through_calls(size: int, tmp_path: Path) -> None:
    move = "    MoveL p, v10, fine, tool0;\n"
    procs = [f"  PROC r{k}()\n{move}    r{k + 1};\n    r{k + 1};\n  ENDPROC\n" for k in range(size)]
    text = f"MODULE M\n{''.join(procs)}  PROC r{size}()\n    r0;\n  ENDPROC\nENDMODULE\n"
    modules = {
        "PROGMOD/M.mod": text.replace("PROC r0()", "PROC main()\n    r1;\n  ENDPROC\n  PROC r0()")
    }
    entries = opened(Station(tasks={"TASK1": ("T_ROB1", modules)}).write(tmp_path)).tasks[0].entries
    assert len(entries) == size + 2 and entries[0].name == "main"
    moves = {entry.name: entry.moves for entry in entries}["main"]
    assert moves == size if size < 1000 else moves >= 1  # too many calls to be followed
