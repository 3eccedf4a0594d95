"""Sets of files appear whole or not at all, wherever a write breaks off."""

from __future__ import annotations

import errno
import itertools
import json
import os
import signal
import subprocess
import sys
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import pytest

from flyby.core.errors import InputError
from flyby.core.files.disk import WriteError
from flyby.core.files.journal import PREFIX
from flyby.core.files.recovery import recover
from flyby.core.files.writing import write_file, write_files

from .killed import NEW, OLD, breaking, interrupt, lay, wanted


def _files(folder: Path) -> dict[str, bytes]:
    """All files, those of interrupted writes as well."""
    return {
        str(path.relative_to(folder)): path.read_bytes()
        for path in folder.rglob("*")
        if path.is_file()
    }


def _recovered(folder: Path) -> dict[str, bytes]:
    for part in sorted({(folder / name).parent for name in NEW}):
        recover(part)
    return _files(folder)


def _fail() -> None:
    raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC))


def test_a_set_is_written_and_nothing_is_left(tmp_path: Path) -> None:
    lay(tmp_path)
    assert write_files(wanted(tmp_path), tmp_path) == ()
    assert _files(tmp_path) == NEW
    assert sorted(p.name for p in tmp_path.rglob(".*")) == []


def test_a_set_that_fails_at_any_step_changes_nothing(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    for step in itertools.count():
        folder = tmp_path / str(step)
        lay(folder)
        broken, count = breaking(step, _fail)
        with monkeypatch.context() as patched:
            for name, function in broken.items():
                patched.setattr(os, name, function)
            try:
                write_files(wanted(folder), folder)
            except InputError as error:
                assert "cannot be written" in str(error)
                assert _files(folder) == OLD, step
                assert not (folder / "c").exists(), step
                continue
        assert _recovered(folder) == NEW, step
        if next(count) <= step:
            break
    assert step > 40  # the steps of four files in three folders were all met


def _killed(folder: Path, what: str) -> list[Path]:
    """The folders that ``what`` of killed.py leaves, by the step at which it was killed.

    A process of its own: this one has grown, and a fork copies the tables of all its pages.
    """
    script = Path(__file__).with_name("killed.py")
    subprocess.run([sys.executable, script, what, folder], check=True)
    return sorted(folder.iterdir(), key=lambda path: int(path.name))


def test_a_set_that_is_killed_at_any_step_is_whole_at_the_next_run(tmp_path: Path) -> None:
    seen = set()
    for folder in _killed(tmp_path, "write"):
        left = {name: data for name, data in _files(folder).items() if PREFIX not in name}
        # Never old beside new, not even before the next run.
        assert left.items() <= OLD.items() or left.items() <= NEW.items(), folder
        found = _recovered(folder)
        assert found in (OLD, NEW), folder
        assert not list(folder.rglob(PREFIX + "*")), folder
        seen.add(found == NEW)
    assert seen == {True, False}


def test_a_recovery_that_is_killed_itself_is_taken_up_again(tmp_path: Path) -> None:
    folders = _killed(tmp_path, "recover")
    for folder in folders:
        assert _recovered(folder) == NEW, folder
    assert len(folders) > 6


def test_the_next_run_says_what_it_finished(
    tmp_path: Path, caplog: pytest.LogCaptureFixture
) -> None:
    lay(tmp_path)
    interrupt(tmp_path)
    recover(tmp_path / "a")
    assert "interrupted, and has been finished" in caplog.text
    assert "p.dat" in caplog.text
    assert _files(tmp_path) == NEW


def test_damaged_new_files_are_taken_back(tmp_path: Path, caplog: pytest.LogCaptureFixture) -> None:
    lay(tmp_path)
    interrupt(tmp_path)
    (draft,) = tmp_path.glob("b/*/*.new")
    draft.write_bytes(b"tor")
    assert _recovered(tmp_path) == OLD
    assert "taken back" in caplog.text


def test_what_the_user_has_changed_since_is_left_and_said(tmp_path: Path) -> None:
    lay(tmp_path)
    interrupt(tmp_path)
    assert not (tmp_path / "b/q.src").exists()
    (tmp_path / "b/q.src").write_bytes(b"from a backup")
    with pytest.raises(InputError, match=r"q\.src has been changed since.*delete these folders"):
        recover(tmp_path / "a")
    assert (tmp_path / "b/q.src").read_bytes() == b"from a backup"
    with pytest.raises(InputError, match="has been changed since"):
        write_file(tmp_path / "a/p.src", b"newer")


def test_a_disk_that_also_refuses_to_take_back_is_said(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    lay(tmp_path)
    renames = itertools.count()
    rename = os.rename

    def failing(*args: Any) -> None:
        if next(renames) >= 4:
            _fail()
        rename(*args)

    with monkeypatch.context() as patched:
        patched.setattr(os, "rename", failing)
        with pytest.raises(InputError, match="neither finished nor taken back: No space left"):
            write_files(wanted(tmp_path), tmp_path)
    assert _recovered(tmp_path) == NEW


def test_a_write_under_way_is_left_alone(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    lay(tmp_path)
    replace = os.replace

    def looking(*args: Any) -> None:
        recover(tmp_path / "a")
        replace(*args)

    monkeypatch.setattr(os, "replace", looking)
    write_files(wanted(tmp_path), tmp_path)
    assert _files(tmp_path) == NEW


def test_a_link_stays_one_and_permissions_are_kept(tmp_path: Path) -> None:
    real, link = tmp_path / "real.mod", tmp_path / "link.mod"
    real.write_bytes(b"old")
    real.chmod(0o640)
    link.symlink_to(real)
    write_files({link: b"new", tmp_path / "other.mod": b"more"})
    assert link.is_symlink()
    assert real.read_bytes() == b"new"
    assert real.stat().st_mode & 0o777 == 0o640


def test_hard_links_are_said(tmp_path: Path) -> None:
    one, other = tmp_path / "one.mod", tmp_path / "other.mod"
    one.write_bytes(b"old")
    other.hardlink_to(one)
    (note,) = write_file(one, b"new")
    assert "1 other name (hard links), which keep the old content" in note.message
    assert (one.read_bytes(), other.read_bytes()) == (b"new", b"old")


def test_what_cannot_be_written_is_named(tmp_path: Path) -> None:
    fifo = tmp_path / "fifo"
    os.mkfifo(fifo)
    for path, reason in (
        (tmp_path / ("n" * 300), "File name too long"),
        (fifo, "it is no regular file"),
        (tmp_path, "it is no regular file"),
        (tmp_path / "a\0b", "null"),
        (fifo / "file", "Not a directory"),
    ):
        with pytest.raises(WriteError, match=reason):
            write_files({tmp_path / "good": b"", path: b""})
    assert list(tmp_path.iterdir()) == [fifo]


def test_one_file_under_two_names_is_refused(tmp_path: Path) -> None:
    (tmp_path / "link").symlink_to(tmp_path / "file")
    with pytest.raises(InputError, match="written twice"):
        write_files({tmp_path / "file": b"1", tmp_path / "link": b"2"})


@pytest.mark.parametrize(
    "row",
    [
        {"name": "../victim"},
        {"name": ".."},
        {"name": "/etc/victim"},
        {"name": "a\0b"},
        {"staging": "../elsewhere"},
        {"staging": f"../{PREFIX}other"},
        {"number": "0"},
        {"before": 3},
        {"digest": None},
    ],
)
def test_a_journal_from_elsewhere_reaches_no_other_file(
    tmp_path: Path, row: Mapping[str, object]
) -> None:
    stick = tmp_path / "stick"
    staging = stick / f"{PREFIX}x"
    staging.mkdir(parents=True)
    (tmp_path / f"{PREFIX}other").mkdir()
    (staging / "0.new").write_bytes(b"evil")
    told = {"staging": staging.name, "number": 0, "name": "p", "digest": "", "before": None}
    (staging / "journal.json").write_text(json.dumps([{**told, **row}]))
    (tmp_path / "victim").write_bytes(b"mine")
    with pytest.raises(InputError, match="not to be understood"):
        recover(stick)
    assert (tmp_path / "victim").read_bytes() == b"mine"


@pytest.mark.parametrize("text", ["", "[", "[[", "{}", "[]", "[1]", "[" * 100_000])
def test_a_misshapen_journal_is_said(tmp_path: Path, text: str) -> None:
    staging = tmp_path / f"{PREFIX}x"
    staging.mkdir()
    (staging / "journal.json").write_text(text)
    with pytest.raises(InputError, match="not to be understood"):
        recover(tmp_path)


def test_a_folder_that_nothing_has_changed_is_looked_through_once(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    lay(tmp_path)
    looked: list[object] = []
    scan = os.scandir
    monkeypatch.setattr("flyby.core.files.recovery.time.time_ns", lambda: 2**62)
    monkeypatch.setattr(os, "scandir", lambda place: looked.append(place) or scan(place))
    recover(tmp_path / "a")
    recover(tmp_path / "a")
    assert looked == [tmp_path / "a"]
    left = tmp_path / "a" / f"{PREFIX}late"
    left.mkdir()
    recover(tmp_path / "a")
    assert not left.exists()


def test_in_place_killed_between_dat_and_src_leaves_nothing_unproven(tmp_path: Path) -> None:
    """As the command line writes, in a process of its own, and read by the next one."""
    dat, src = tmp_path / "p.dat", tmp_path / "p.src"
    dat.write_bytes(b"old dat")
    src.write_bytes(b"old src")
    code = (
        "import os, signal, sys\n"
        "from pathlib import Path\n"
        "from flyby.core.files.writing import write_files\n"
        "rename = os.rename\n"
        "def last(a, b):\n"
        "    if str(b).endswith('p.src'): os.kill(os.getpid(), signal.SIGKILL)\n"
        "    rename(a, b)\n"
        "os.rename = last\n"
        "dat, src = map(Path, sys.argv[1:])\n"
        "write_files({dat: b'new dat', src: b'new src'})\n"
    )
    done = subprocess.run([sys.executable, "-c", code, dat, src], check=False)
    assert done.returncode == -signal.SIGKILL
    assert (dat.read_bytes(), src.exists()) == (b"new dat", False)
    recover(tmp_path)
    assert (dat.read_bytes(), src.read_bytes()) == (b"new dat", b"new src")
    assert sorted(path.name for path in tmp_path.iterdir()) == ["p.dat", "p.src"]
