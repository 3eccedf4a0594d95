"""A program file given alone names the backup that it lies in."""

from __future__ import annotations

import shutil
from pathlib import Path

import pytest

import flyby
from flyby.core.errors import InputError
from flyby.core.registry import installed
from flyby.tasks.backup.surrounding import backup_round

from ...vendors.abb.backup.station import Station
from ...vendors.kuka.backup.archives import archive, written

UR_INSTALLATION = b"<Installation/>"


@pytest.fixture
def abb(tmp_path: Path) -> Path:
    return Station().write(tmp_path / "station" / "Backup_1")


@pytest.fixture
def kuka(tmp_path: Path) -> Path:
    return written(tmp_path / "archive", archive())


def modules(folder: Path, suffix: str) -> list[Path]:
    return sorted(p for p in folder.rglob("*") if p.suffix.lower() == suffix)


def test_modules_of_an_abb_backup(abb: Path) -> None:
    shutil.copytree(abb, abb.parent / "Backup_0")
    home = abb / "HOME" / "old" / "mine.mod"
    home.parent.mkdir(parents=True)
    shutil.copy(modules(abb, ".mod")[0], home)
    for file in (*modules(abb / "RAPID", ".mod"), home):
        assert backup_round(file, installed()) == ("abb", abb)


def test_sources_of_a_kuka_archive(kuka: Path) -> None:
    for file in modules(kuka / "KRC", ".src"):
        assert backup_round(file, installed()) == ("kuka", kuka)
    # What belongs to the operating system is no program of the archive.
    for file in modules(kuka / "C", ".src"):
        assert backup_round(file, installed()) is None


def test_a_script_beside_an_installation_of_a_ur(tmp_path: Path) -> None:
    folder = tmp_path / "programs"
    folder.mkdir()
    script = folder / "pick.script"
    script.write_text("movej([0,0,0,0,0,0])\n", "utf-8")
    assert backup_round(script, installed()) is None
    (folder / "default.installation").write_bytes(UR_INSTALLATION)
    assert backup_round(script, installed()) == ("ur", folder)


def test_what_is_far_above_a_script_is_not_its_backup(tmp_path: Path) -> None:
    (tmp_path / "stray.installation").write_bytes(UR_INSTALLATION)
    for depth, found in ((1, True), (3, True), (4, False), (6, False)):
        script = tmp_path.joinpath(*"abcdef"[:depth], "pick.script")
        script.parent.mkdir(parents=True, exist_ok=True)
        script.write_text("movej([0,0,0,0,0,0])\n", "utf-8")
        assert (backup_round(script, installed()) is not None) == found


def test_files_elsewhere_lie_in_no_backup(abb: Path, tmp_path: Path) -> None:
    module = modules(abb, ".mod")[0]
    for place in (tmp_path / "alone.mod", abb.parent / "beside.mod"):
        shutil.copy(module, place)
        assert backup_round(place, installed()) is None
    stray = tmp_path / "x" / "RAPID" / "TASK1" / "main.mod"
    stray.parent.mkdir(parents=True)
    shutil.copy(module, stray)
    assert backup_round(stray, installed()) is None


def test_links_to_themselves_do_no_harm(abb: Path) -> None:
    (abb / "loop").symlink_to(abb)
    (abb / "RAPID" / "gone").symlink_to(abb / "nowhere")
    assert backup_round(modules(abb / "RAPID", ".mod")[0], installed()) is not None


def test_the_note_says_what_takes_robot_and_data(
    abb: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(abb.parent)
    main = next(f for f in modules(abb / "RAPID", ".mod") if "main" in f.name.lower())
    told = (
        f'{main} lies in a backup of abb, Backup_1: flyby.emulate("Backup_1") with '
        "entry=ROUTINE takes robot, tools and data from it too"
    )
    program = flyby.read(main, robot="abb/irb4600-40-255")
    assert program.notes[0].message == told
    with pytest.raises(InputError) as caught:
        flyby.read(main)
    assert str(caught.value).endswith(f"; {told}")
