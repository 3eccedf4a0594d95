"""Programs of KUKA controllers that somebody keeps without the folders of an archive."""

from __future__ import annotations

import pytest

import flyby
from flyby.core.source.execution.answers import Answers
from flyby.vendors.kuka.backup.opener import OPENER

from .archives import CONFIG, archive, programs, written
from .test_kuka_archives import opened, read, said

BESIDE = "KRC/R1/cell.src", "KRC/R1/System/$config.dat"


@pytest.mark.parametrize(
    ("names", "folder"),
    [
        (["README.md", "a.src", "$config.dat", "plc/x.st"], ""),
        (["cell/Line/a.src", "cell/$CONFIG.DAT", "old/b.src"], "cell"),
        (["x/$config.dat", "y/Line/a.src", "y/b.SRC", "y/b.dat"], "y"),
        (["a.src"], ""),
        (["$config.dat", "sps.sub"], None),
        (["PROGMOD/Main.mod"], None),
    ],
)
def test_where_programs_alone_begin(names: list[str], folder: str | None) -> None:
    assert OPENER.root_in(names) is None
    assert OPENER.programs_in(names) == folder


def test_programs_beside_the_controllers_list(tmp_path) -> None:
    """Somebody's repository: the list that says tools and the robot, and programs in folders."""
    files = {name.partition("R1/")[2]: text for name, text in programs().items()}
    del files["System/sps.sub"]
    folder = written(tmp_path, {**files, "$config.dat": CONFIG, "README.md": "Palletiser\n"})
    backup = flyby.open_backup(folder)
    whole = opened(tmp_path / "whole", archive())
    assert backup.root == folder
    assert (backup.tools, backup.frames, backup.homes) == (whole.tools, whole.frames, whole.homes)
    assert [one.name for one in backup.tasks[0].entries] == [
        one.name for one in whole.tasks[0].entries
    ]
    known = backup.robots[0]
    assert known.robot is not None and known.robot.name == "kuka/kr16-2"
    assert "no $machine.dat can be read" in known.lacks[0]
    alone = {name: text for name, text in files.items() if "lib" in name or name == "Program/x.dat"}
    bare = flyby.open_backup(written(tmp_path / "alone", alone))
    assert bare.tasks[0].name == "R1" and bare.robots[0].robot is None
    assert "tools, bases and homes are not known" in said(bare)


def test_parts_of_r1_that_stand_beside_it(tmp_path) -> None:
    whole = opened(tmp_path / "whole", archive())
    files = archive()
    loose = {
        name.replace("KRC/R1/", "KRC/", 1) if name in BESIDE else name: text
        for name, text in files.items()
    }
    backup = opened(tmp_path / "loose", loose)
    assert "of KRC/R1, beside which they stand: KRC/System/$config.dat, KRC/cell" in said(backup)
    assert (backup.tools, backup.homes) == (whole.tools, whole.homes)
    assert backup.tasks[0].main == "KRC/cell.src"
    assert [one.name for one in backup.tasks[0].entries] == [
        one.name for one in whole.tasks[0].entries
    ]
    both = opened(
        tmp_path / "both", {**files, "KRC/System/$config.dat": "DEFDAT $CONFIG\nENDDAT\n"}
    )
    assert both.tools == whole.tools and "KRC/System" not in said(both)


def test_a_cell_in_a_file_of_another_name(tmp_path) -> None:
    files = archive()
    files["KRC/R1/main.src"] = files.pop("KRC/R1/cell.src")
    backup = opened(tmp_path, files)
    task = backup.tasks[0]
    assert (task.main, task.entry) == ("KRC/R1/main.src", "CELL")
    assert len(read(backup, "CELL", Answers({"pgno": 1.0})).moves) > 0
