"""Backups are found by what marks them, wherever they stand; opened by whoever wrote them."""

from __future__ import annotations

import shutil
import zipfile
from collections.abc import Callable, Sequence
from dataclasses import replace
from pathlib import Path, PurePosixPath

import pytest
from hypothesis import given
from hypothesis import strategies as st

from flyby.core.backup.backup import Backup
from flyby.core.errors import InputError
from flyby.core.registry import Registry, find_vendor
from flyby.core.robot.model import Robot
from flyby.tasks.backup.finding import find_backup, no_backup


class Marked:
    """Opens whatever holds a file of a name."""

    def __init__(self, vendor: str, mark: str) -> None:
        self.vendor = vendor
        self.mark = mark

    def root_in(self, names: Sequence[str]) -> str | None:
        roots = [PurePosixPath(n).parent for n in names if PurePosixPath(n).name == self.mark]
        best = min(roots, key=lambda root: len(root.parts), default=None)
        return None if best is None else "" if best == PurePosixPath() else best.as_posix()

    def programs_in(self, names: Sequence[str]) -> str | None:
        return None

    def unreadable_in(self, names: Sequence[str]) -> str | None:
        return None

    def open(self, source: Path, root: Path, find_robot: Callable[[str], Robot]) -> Backup:
        assert (root / self.mark).is_file()
        return Backup(source, root, self.vendor, "controller", "1", (), ())


def _registry(**marks: str) -> Registry:
    abb = find_vendor("abb")
    return Registry(
        {
            name: replace(abb, name=name, backups=lambda n=name, m=mark: Marked(n, m))
            for name, mark in marks.items()
        }
    )


ONE = _registry(one="mark.txt")
TWO = _registry(one="mark.txt", two="sign.txt")


def opened(path: Path, registry: Registry = ONE) -> Backup:
    """The backup, which has to be there."""
    found = find_backup(path, registry)
    assert found is not None
    return found


def _made(folder: Path, *names: str) -> Path:
    for name in names:
        (folder / name).parent.mkdir(parents=True, exist_ok=True)
        (folder / name).write_text("")
    return folder


@pytest.mark.parametrize("root", ["", "station/", "a/b/c/"])
def test_a_backup_is_found_where_it_stands(tmp_path: Path, root: str) -> None:
    folder = _made(tmp_path / "all", f"{root}mark.txt", "README.md", "pictures/cell.png")
    backup = opened(folder)
    assert backup.root == folder / root
    assert backup.source == folder


def test_an_archive_is_opened_as_a_folder(tmp_path: Path) -> None:
    path = tmp_path / "Station 12.zip"
    with zipfile.ZipFile(path, "w") as archive:
        archive.writestr("Backup_1/mark.txt", "")
    backup = opened(path)
    assert (backup.root / "mark.txt").is_file()
    assert backup.root.name == "Backup_1"
    assert backup.source == path


def test_a_file_of_its_own_is_a_backup_if_it_marks_one(tmp_path: Path) -> None:
    folder = _made(tmp_path, "mark.txt", "other.txt")
    assert opened(folder / "mark.txt").root == folder
    assert find_backup(folder / "other.txt", ONE) is None


def test_of_several_backups_one_has_to_be_named(tmp_path: Path) -> None:
    folder = _made(tmp_path / "x", "monday/mark.txt", "tuesday/mark.txt", "tuesday/old/mark.txt")
    with pytest.raises(InputError, match=r"several backups.*: monday \(one\), tuesday \(one\)"):
        find_backup(folder, ONE)
    assert opened(folder / "tuesday").root == folder / "tuesday"
    _made(tmp_path / "y", "mark.txt", "sign.txt")
    with pytest.raises(InputError, match=r"y \(one\), y \(two\)"):
        find_backup(tmp_path / "y", TWO)


def test_the_one_furthest_out_counts(tmp_path: Path) -> None:
    folder = _made(tmp_path, "mark.txt", "HOME/copies/old/sign.txt")
    assert opened(folder, TWO).vendor == "one"


def test_a_text_beside_programs_is_none_of_another_vendor(tmp_path: Path) -> None:
    class Loose(Marked):
        def programs_in(self, names: Sequence[str]) -> str | None:
            return ""

        def open(self, source: Path, root: Path, find_robot: Callable[[str], Robot]) -> Backup:
            return Backup(source, root, self.vendor, "controller", "1", (), ())

    one = replace(find_vendor("abb"), name="one", backups=lambda: Loose("one", "mark.txt"))
    other = replace(find_vendor("ur"), name="other", backups=lambda: Marked("other", "sign.txt"))
    registry = Registry({"other": other, "one": one})
    folder = _made(tmp_path, "a.mod", "README.txt", "HOME/log.txt")
    assert opened(folder, registry).vendor == "one"
    _made(tmp_path, "b.script")
    assert find_backup(folder, registry) is None


def test_what_is_no_backup_says_who_would_know_one(tmp_path: Path) -> None:
    folder = _made(tmp_path, "README.md")
    assert find_backup(folder, TWO) is None
    message = str(no_backup(folder, TWO))
    assert "no backup is in this folder: nothing in it marks one of a controller of one, two" in (
        message
    )
    with pytest.raises(InputError, match="there is no such file or folder"):
        find_backup(tmp_path / "missing", TWO)


def test_links_and_version_control_are_passed_over(tmp_path: Path) -> None:
    outside = _made(tmp_path / "outside", "mark.txt")
    folder = _made(tmp_path / "inside", ".git/mark.txt")
    (folder / "mark.txt").symlink_to(outside / "mark.txt")
    (folder / "loop").symlink_to(folder)
    assert find_backup(folder, ONE) is None


@given(st.lists(st.sampled_from(["a", "b", "c"]), max_size=5).map("/".join))
def test_depth_does_not_matter(tmp_path_factory: pytest.TempPathFactory, inside: str) -> None:
    folder = _made(tmp_path_factory.mktemp("deep"), f"{inside}/mark.txt".lstrip("/"))
    assert opened(folder).root == folder / inside


def test_programs_outside_a_backup_are_named(tmp_path: Path) -> None:
    _made(tmp_path, "deep/in/mark.txt", "deep/in/own.mod", "stray/other.mod", "README.md")
    (note,) = opened(tmp_path).notes
    assert "the backup in deep/in is taken" in note.message
    assert note.message.endswith("outside it: stray/other.mod")
    assert opened(tmp_path / "deep").notes == ()


def test_the_only_archive_in_a_folder_is_opened(tmp_path: Path) -> None:
    whole = _made(tmp_path / "whole", "cell/mark.txt", "cell/a.mod")
    folder = _made(tmp_path / "usb", "README.md")
    shutil.make_archive(str(folder / "in" / "b"), "zip", whole)
    backup = opened(folder)
    assert (backup.root.name, backup.source) == ("cell", folder / "in" / "b.zip")
    assert "the backup is that in in/b.zip" in backup.notes[0].message
    shutil.copy(folder / "in" / "b.zip", folder / "in" / "c.zip")
    assert find_backup(folder, ONE) is None
    assert str(no_backup(folder, ONE)).endswith("has written: in/b.zip, in/c.zip, perhaps")
    _made(folder, "mark.txt")
    assert opened(folder).root == folder


def test_a_program_alone_is_no_backup(tmp_path: Path) -> None:
    folder = _made(tmp_path, "a.mod")
    said = str(no_backup(folder / "a.mod", ONE))
    assert "is a program, and no backup" in said and "flyby.emulate" in said


def test_other_archives_are_named(tmp_path: Path) -> None:
    _made(tmp_path, "cell.7z", "old.tar.gz")
    said = str(no_backup(tmp_path, ONE))
    assert said.endswith("archives other than zip have to be unpacked: cell.7z, old.tar.gz")
    said = str(no_backup(tmp_path / "cell.7z", ONE))
    assert "no backup is in this file" in said and said.endswith("have to be unpacked: cell.7z")
