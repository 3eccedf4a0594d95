"""Modules that somebody keeps without the folders of a backup."""

from __future__ import annotations

import shutil
from collections.abc import Mapping
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

import flyby
from flyby.core.backup.backup import Backup
from flyby.core.errors import OptionError
from flyby.core.registry import find_robot
from flyby.vendors.abb.backup.opener import OPENER

from .station import MAIN, USER, Station

ARM = "abb/irb4600-40-255"
TOOLS = """MODULE Tools
  PERS tooldata tSpare:=[TRUE,[[0,0,90],[1,0,0,0]],[1,[0,0,40],[1,0,0,0],0,0,0]];
  PROC Park()
    MoveAbsJ [[0,0,0,0,30,0],[9E9,9E9,9E9,9E9,9E9,9E9]], v500, fine, tSpare;
  ENDPROC
ENDMODULE
"""
SECOND = """MODULE Second
  PROC main()
    Park;
  ENDPROC
ENDMODULE
"""


def written(folder: Path, files: Mapping[str, str]) -> Path:
    for name, text in files.items():
        (folder / name).parent.mkdir(parents=True, exist_ok=True)
        (folder / name).write_text(text, "utf-8")
    return folder


def opened(folder: Path, files: Mapping[str, str]) -> Backup:
    return flyby.open_backup(written(folder, files))


def tasks(backup: Backup) -> dict[str, tuple[str, ...]]:
    return {task.name: task.files for task in backup.tasks}


def listing(*names: str) -> str:
    return f"<Program>{''.join(f'<Module>{name}</Module>' for name in names)}</Program>"


@pytest.mark.parametrize(
    ("names", "folder"),
    [
        (["main.mod", "README.md"], ""),
        (["src/robot/main.MOD", "src/robot/lib/a.sys", "docs/a.txt"], "src/robot"),
        (["left/main.modx", "right/main.modx"], ""),
        (["a.prg"], ""),
        (["main.mod", "old/PROGMOD/a.mod"], "old"),
        (["SYSMOD", "main.src", "EIO.cfg"], None),
    ],
)
def test_where_modules_alone_begin(names: list[str], folder: str | None) -> None:
    assert OPENER.root_in(names) is None
    assert OPENER.programs_in(names) == folder


@pytest.mark.parametrize("suffixes", [("mod", "sys"), ("modx", "sysx"), ("PRG", "SYS")])
def test_a_folder_of_modules_is_one_task(tmp_path: Path, suffixes: tuple[str, str]) -> None:
    module, system = suffixes
    files = {f"cell/Main.{module}": MAIN, f"cell/lib/user.{system}": USER, "README.md": "Cell 7"}
    backup = opened(tmp_path, files)
    assert tasks(backup) == {"cell": (f"Main.{module}", f"lib/user.{system}")}
    (task,), (known,) = backup.tasks, backup.robots
    assert (task.entry, task.robot, known.robot) == ("Main", 0, None)
    assert "name one" in known.lacks[0]
    assert set(backup.tools) == {"tGripper"} and set(backup.frames) == {"wTable"}
    assert len(flyby.read(tmp_path, robot=ARM).moves) == 3
    assert len(flyby.read(tmp_path, robot=ARM, entry="Service").moves) == 2


def test_the_folder_of_programs_itself(tmp_path: Path) -> None:
    folder = Station().write(tmp_path) / "RAPID" / "TASK1" / "PROGMOD"
    lone = shutil.copytree(folder, tmp_path / "copied")
    assert tasks(flyby.open_backup(lone)) == {"copied": ("MainModule.mod",)}


def test_each_program_is_a_task(tmp_path: Path) -> None:
    """Two mains in one folder are two programs, which share what is neither's."""
    files = {"Main.mod": MAIN, "Second.mod": SECOND, "Tools.mod": TOOLS}
    backup = opened(tmp_path, files)
    assert tasks(backup) == {
        "Main": ("Main.mod", "Tools.mod"),
        "Second": ("Second.mod", "Tools.mod"),
    }
    assert len(flyby.read(tmp_path, robot=ARM, task="Second").moves) == 1
    with pytest.raises(OptionError, match="Several move a robot: Main, Second"):
        flyby.read(tmp_path)


def test_programs_in_folders_of_their_own_share_nothing_but_what_is_no_program_s(
    tmp_path: Path,
) -> None:
    files = {
        "T_ROB1/Main.mod": MAIN,
        "T_ROB2/Main.mod": SECOND,
        "T_ROB2/parts/Own.mod": TOOLS.replace("MODULE Tools", "MODULE Own"),
        "common/user.sys": USER.replace("Pick;", 'TPWrite "x";'),
    }
    assert tasks(opened(tmp_path, files)) == {
        "T_ROB1": ("T_ROB1/Main.mod", "common/user.sys"),
        "T_ROB2": ("T_ROB2/Main.mod", "T_ROB2/parts/Own.mod", "common/user.sys"),
    }


def test_a_list_of_modules_is_a_program(tmp_path: Path) -> None:
    files = {
        "Main.mod": MAIN,
        "Old.mod": MAIN.replace("MainModule", "Old"),
        "Tools.mod": TOOLS,
        "user.sys": USER,
        "cell.pgf": listing("main.mod", "Absent.mod"),
    }
    backup = opened(tmp_path, files)
    assert tasks(backup)["cell"] == ("Main.mod", "user.sys")
    assert tasks(backup)["Old"] == ("Old.mod", "Tools.mod", "user.sys")
    said = " ".join(map(str, backup.notes))
    assert "cell: 1 of 3 listed modules is not in the backup: Absent.mod" in said


def test_without_a_main_all_modules_are_one_task(tmp_path: Path) -> None:
    (task,) = opened(tmp_path, {"Tools.mod": TOOLS, "go.mod": "module example.com/x\n"}).tasks
    assert (task.files, task.entry, [one.name for one in task.entries]) == (
        ("Tools.mod",),
        None,
        ["Park"],
    )


def test_system_parameters_beside_modules_name_arm_and_task(tmp_path: Path) -> None:
    """Parameters and modules exported by themselves; what lies in HOME is loaded by nobody."""
    whole = Station().write(tmp_path / "whole")
    folder = written(tmp_path / "kept", {"code/Main.mod": MAIN, "HOME/Old.mod": SECOND})
    for file in (whole / "SYSPAR").iterdir():
        shutil.copy(file, folder)
    backup = flyby.open_backup(folder)
    assert tasks(backup) == {"T_ROB1": ("code/Main.mod",)}
    assert backup.robots == flyby.open_backup(whole).robots
    assert [one.name for one in backup.signals] == [
        one.name for one in flyby.open_backup(whole).signals
    ]


@given(st.lists(st.sampled_from(["a", "b", "c", "d"]), min_size=1, max_size=4).map("/".join))
def test_depth_does_not_matter(tmp_path_factory: pytest.TempPathFactory, inside: str) -> None:
    folder = written(tmp_path_factory.mktemp("deep"), {f"{inside}/Main.mod": MAIN})
    root = OPENER.programs_in([f"{inside}/Main.mod"])
    assert root == inside
    (task,) = OPENER.open(folder, folder / root, find_robot).tasks
    assert task.files == ("Main.mod",)
