"""``flyby diff`` at the command line and under git."""

from __future__ import annotations

import json
import shutil
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path

import pytest
from typer.testing import Result

Flyby = Callable[..., Result]
ROBOT = ("--robot", "abb/irb6640-180-255")


@pytest.fixture
def both(small: Callable[..., Path], tmp_path: Path) -> tuple[Path, Path]:
    """A program before and after a change of a zone and of a speed."""
    path = small("MoveL Offs(p1,0,100,0),v500,z10,tool0", "MoveL Offs(p1,0,0,200),v500,fine,tool0")
    old = tmp_path / "old.mod"
    shutil.copy(path, old)
    path.write_text(path.read_text().replace("z10", "z50").replace("v500,fine", "v200,fine"))
    return old, path


def test_tables_and_status(flyby: Flyby, both: tuple[Path, Path]) -> None:
    result = flyby("diff", *both, *ROBOT)
    assert result.exit_code == 1
    for part in ("z10 (10 mm)", "z50 (50 mm)", "v500 (500 mm/s)", "small.mod:6", "main", "changed"):
        assert part in result.output
    result = flyby("diff", both[0], both[0], *ROBOT)
    assert result.exit_code == 0
    assert "do not differ" in result.output


def test_waits_and_what_is_driven_in_part(flyby: Flyby, both: tuple[Path, Path]) -> None:
    """A wait that differs is a difference; paths that end at a fault are not 0.00 mm apart."""
    old, new = both
    text = old.read_text().replace("v500,z10,tool0;", "v500,fine,tool0; WaitTime 0.2;")
    text = text.replace("ENDPROC", "MoveL Offs(p1,9000,0,0),v500,fine,tool0; ENDPROC", 1)
    old.write_text(text)
    new.write_text(text.replace("0.2", "0.5"))
    result = flyby("diff", old, new, *ROBOT)
    waits = next(line for line in result.output.splitlines() if "0.2 s" in line)
    assert waits.split()[:2] == ["wait", "main,"] and "0.5 s" in waits
    (routine,) = [line for line in result.output.splitlines() if line.split()[:1] == ["main"]]
    assert routine.split() == ["main", *3 * ["not", "driven"]]
    told = json.loads(flyby("diff", old, new, *ROBOT, "--json").stdout)
    assert told["routines"][0]["greatest_path_distance_m"] is None


def test_json_and_markdown(flyby: Flyby, both: tuple[Path, Path]) -> None:
    told = json.loads(flyby("diff", *both, *ROBOT, "--json").stdout)
    assert told["differs"] is True
    assert {one["subject"] for one in told["differences"]} == {"zone", "speed"}
    (routine,) = told["routines"]
    assert routine["cycle_time_after_s"] > routine["cycle_time_before_s"]
    assert 0.0 < routine["greatest_path_distance_m"] < 0.05
    result = flyby("diff", *both, *ROBOT, "--markdown")
    assert "### differences" in result.output
    assert "| zone | main, move 2 | z10 (10 mm) | z50 (50 mm) |" in result.output


def test_errors_have_a_status_of_their_own(flyby: Flyby, both: tuple[Path, Path]) -> None:
    for words in (("a.mod", "b.mod", *ROBOT), ("a.mod", "b.mod"), ("a", "b", "c")):
        result = flyby("diff", *words)
        assert result.exit_code == 2, result.output
        assert "error:" in result.output


def test_one_path_is_listed_a_move_a_line(flyby: Flyby, both: tuple[Path, Path]) -> None:
    lines = flyby("diff", both[0], *ROBOT).stdout.splitlines()
    assert lines[0].startswith("MoveJ p1, v1000, fine, tool0, wobj0, at ")
    assert len(lines) == 3


def test_gits_states_have_what_lies_beside_the_file(flyby: Flyby, tmp_path: Path) -> None:
    """Git has the state before in a folder of its own: a ``.src`` without its ``.dat``."""
    folder, blob = tmp_path / "tree", tmp_path / "git-blob-1"
    folder.mkdir()
    blob.mkdir()
    for name in ("seam.src", "seam.dat"):
        shutil.copy(Path("examples") / name, folder / name)
    text = (folder / "seam.src").read_text("utf-8")
    (blob / "seam.src").write_text(text.replace("corner[side] C_DIS", "corner[side]"), "utf-8")
    old, new = blob / "seam.src", folder / "seam.src"
    words = (new, old, "a1", "100644", new, "a2", "100644")
    result = flyby("diff", "--robot", "kuka/kr16-2", *words)
    assert result.exit_code == 0, result.output
    assert "not compared" not in result.stdout and "seam, move" in result.stdout
    assert sorted(one.name for one in folder.iterdir()) == ["seam.dat", "seam.src"]


def test_data_that_changed_are_compared_by_what_they_do(flyby: Flyby, tmp_path: Path) -> None:
    """A module of data runs nothing: what lies beside it in the working tree does."""
    folder, old = tmp_path / "tree", tmp_path / "git-blob-1"
    station = Path("examples/station/RAPID/TASK1/PROGMOD")
    shutil.copytree(station, folder)
    shutil.copytree(station, old)
    data = folder / "Data.mod"
    data.write_text(data.read_text("latin-1").replace("[0,0,80]", "[0,0,95]"), "latin-1")
    words = (data, old / "Data.mod", "a1", "100644", data, "a2", "100644")
    result = flyby("diff", "--robot", "abb/irb120-3-058", *words)
    assert result.exit_code == 0 and "not compared" not in result.stdout
    (tool,) = [line for line in result.stdout.splitlines() if "tGrip" in line]
    assert "15.000" in tool
    (folder / "MainModule.mod").unlink()
    alone = flyby("diff", "--robot", "abb/irb120-3-058", *words).stdout
    assert f"not compared: {data}:1:1: no routine in it can be run" in alone


def test_what_lists_no_moves_is_listed_as_it_is(flyby: Flyby, tmp_path: Path) -> None:
    """Git stops at a textconv that fails, with all files that are still to come."""
    text = "MODULE Data\n  PERS num nCount:=3;\nENDMODULE\n"
    broken = "MODULE Main\n  PROC main(\n  <<<<<<< HEAD\n"
    for name, content in (("Data.mod", text), ("Broken.mod", broken), ("seam.dat", "DEFDAT A\n")):
        (tmp_path / name).write_text(content, "utf-8")
        result = flyby("diff", tmp_path / name)
        assert result.exit_code == 0, result.output
        assert result.stdout.splitlines() == content.splitlines()
    for data in (bytes(range(256)), b"\x1f\x8b\x08 cut short"):
        (tmp_path / "a.urp").write_bytes(data)
        result = flyby("diff", tmp_path / "a.urp")
        assert result.exit_code == 0 and result.stdout.startswith("not read: a.urp: ")
    assert flyby("diff", tmp_path / "gone.mod").exit_code != 0


@pytest.mark.skipif(shutil.which("git") is None, reason="git is not installed")
def test_git_calls_it(both: tuple[Path, Path], tmp_path: Path) -> None:
    folder = tmp_path / "repository"
    folder.mkdir()

    def git(*words: str) -> str:
        own = ("-c", "user.name=a", "-c", "user.email=a@b")
        done = subprocess.run(
            ["git", *own, *words], cwd=folder, capture_output=True, text=True, check=True
        )
        return done.stdout

    git("init", "-q")
    (folder / ".gitattributes").write_text("*.mod diff=rapid\n")
    shutil.copy(both[0], folder / "job.mod")
    git("add", "-A")
    git("commit", "-qm", "before")
    shutil.copy(both[1], folder / "job.mod")
    command = f"{Path(sys.executable).parent / 'flyby'} diff {' '.join(ROBOT)}"
    assert "z50 (50 mm)" in git("-c", f"diff.rapid.command={command}", "diff")
    shown = git("-c", f"diff.rapid.textconv={command}", "diff")
    assert "-MoveL 1300.00, 200.00, 900.00" in shown
    assert ", z50, tool0" in shown
    (folder / "job.mod").write_bytes(both[0].read_bytes().replace(b"z10", b"z50"))
    git("mv", "job.mod", "other.mod")
    renamed = git("-c", f"diff.rapid.command={command}", "diff", "-M", "HEAD")
    assert "diff of job.mod → other.mod" in renamed and "z50 (50 mm)" in renamed


def test_without_a_robot_what_needs_none_is_compared(
    flyby: Flyby, both: tuple[Path, Path], tmp_path: Path
) -> None:
    result = flyby("diff", *both)
    assert result.exit_code == 1
    for part in ("z50 (50 mm)", "v200 (200 mm/s)", "not compared: cycle times", "--robot"):
        assert part in result.output
    assert "not driven" not in result.output
    told = json.loads(flyby("diff", *both, "--json").stdout)
    assert "--robot" in told["not_driven"]
    assert {one["subject"] for one in told["differences"]} == {"zone", "speed"}
    assert told["routines"][0]["cycle_time_before_s"] is None
    same = flyby("diff", both[0], both[0])
    assert same.exit_code == 0
    assert "do not differ" in same.output and "not compared: cycle times" in same.output
    assert flyby("diff", *both, "--report", tmp_path / "page.html").exit_code == 1
    assert "Nothing is driven" in (tmp_path / "page.html").read_text("utf-8")
    listed = flyby("diff", both[0]).stdout.splitlines()
    assert listed[0].startswith("MoveJ p1, v1000, fine, tool0, wobj0, at ")


def test_options_of_a_robot_ask_for_one(flyby: Flyby, both: tuple[Path, Path]) -> None:
    result = flyby("diff", *both, "--start", "0,0,0,0,0,0")
    assert result.exit_code == 2 and "which robot?" in result.output


@pytest.mark.parametrize("robot", [(), ROBOT])
def test_what_nobody_can_read_is_not_called_the_same(
    flyby: Flyby, both: tuple[Path, Path], tmp_path: Path, robot: tuple[str, ...]
) -> None:
    broken = [tmp_path / "one.mod", tmp_path / "two.mod"]
    for path, whole in zip(broken, both, strict=True):
        path.write_text(whole.read_text().replace("PROC main()", "PROC main("))
    result = flyby("diff", *broken, *robot)
    assert result.exit_code == 2 and "one.mod:" in result.output
    result = flyby("diff", both[0], broken[0], *robot)
    assert result.exit_code == 1
    assert "new fault, main: ','" in result.output
    assert "point" not in result.output and "mended" not in result.output
    result = flyby("diff", broken[0], both[0], *robot)
    assert result.exit_code == 1 and "mended, main: ','" in result.output


def test_what_cannot_be_driven_on_either_side_is_said(
    flyby: Flyby, both: tuple[Path, Path]
) -> None:
    both[0].write_text(both[0].read_text().replace("0,100,0", "0,9100,0"))
    result = flyby("diff", both[0], both[0], *ROBOT)
    assert result.exit_code == 0
    assert "on both sides, main:" in result.output and "cannot be reached" in result.output
