"""``flyby translate`` and ``record``, and what they share with ``emulate``: answers, files."""

from __future__ import annotations

import json
import re
from collections.abc import Callable
from pathlib import Path

import pytest
from typer.testing import Result

from flyby.core.registry import find_robot, find_vendor

ROBOT = "abb/irb6640-180-255"

Flyby = Callable[..., Result]
Small = Callable[..., Path]
SQUARE = (
    "MoveL Offs(p1,200,0,0), v500, z50, tool0",
    "Set doGlue",
    "MoveL Offs(p1,200,200,0), v500, fine, tool0",
)


@pytest.fixture
def square(small: Small) -> Path:
    return small(*SQUARE)


def test_files_of_the_new_language_are_written_and_losses_listed(
    flyby: Flyby, square: Path, tmp_path: Path
) -> None:
    out = tmp_path / "krc"
    words = ("translate", square, "--to", "kuka", "--robot", "kuka/kr30-3", "--from", ROBOT)
    result = flyby(*words, "--out", out)
    assert result.exit_code == 0, result.output
    assert "becomes a comment: Set doGlue" in result.stdout
    assert "1 could not be carried over" in result.stdout
    (source,) = out.glob("*.src")
    kuka = find_vendor("kuka")
    assert len(kuka.read_file(source, robot=find_robot("kuka/kr30-3")).moves) == 3
    again = flyby(*words, "--out", out)
    assert again.exit_code == 1
    assert "--force" in again.stderr
    assert flyby(*words, "--out", out, "--force").exit_code == 0


def test_one_loss_of_many_lines_is_one_row(flyby: Flyby, small: Small) -> None:
    path = small(
        "AccSet 100,50", *(f"MoveL Offs(p1,{x},0,0), v50, fine, tool0" for x in (50, 100, 150))
    )
    words = ("translate", path, "--robot", "kuka/kr30-3", "--from", ROBOT)
    result = flyby(*words)
    assert re.search(r"\b7, 8, 9 +a reduced jerk \(50%\) has no words", result.stdout), (
        result.stdout
    )
    assert "3 could not be carried over" in result.stdout
    assert len(json.loads(flyby(*words, "--json").stdout)["losses"]) == 3


def test_a_folder_that_cannot_be_one_is_refused_before_work_begins(
    flyby: Flyby, square: Path, tmp_path: Path
) -> None:
    words = ("translate", square, "--robot", "kuka/kr30-3", "--from", ROBOT, "--out")
    for out in (square, square / "a" / "b"):
        result = flyby(*words, out)
        assert result.exit_code == 1
        assert "folder" in result.stderr


def test_without_a_folder_nothing_is_written(flyby: Flyby, square: Path) -> None:
    before = sorted(square.parent.iterdir())
    result = flyby("translate", square, "--robot", "kuka/kr30-3", "--from", ROBOT)
    assert result.exit_code == 0
    assert "nothing was written: --out names a folder" in result.stdout
    assert sorted(square.parent.iterdir()) == before


def test_json_lists_losses_with_lines(flyby: Flyby, square: Path, tmp_path: Path) -> None:
    words = ("translate", square, "--to", "kuka", "--robot", "kr30-3", "--from", ROBOT)
    report = json.loads(flyby(*words, "--json", "--out", tmp_path / "krc").stdout)
    (loss,) = report["losses"]
    assert (loss["line"], loss["file"], loss["move"]) == (7, str(square), None)
    assert report["to"] == "kuka/kr30-3"
    assert all(Path(name).is_file() for name in report["files"])


@pytest.mark.parametrize(
    ("status", "words", "message"),
    [
        (2, ("--robot", "kuka/kr30-3"), "which robot is"),
        (1, ("--robot", "kuka/kr30-3", "--to", "ur", "--from", ROBOT), "is a robot of kuka"),
        (1, ("--robot", "ur/ur3", "--from", ROBOT), "line|small.mod:5"),
        (1, ("--robot", "kuka/iiwa7-r800", "--from", ROBOT), "Java .KUKA Sunrise"),
        (1, ("--robot", "kuka/kr30-3", "--from", "kuka/kr30-3"), "program for abb"),
    ],
)
def test_what_cannot_be_translated_is_one_message(
    flyby: Flyby, square: Path, status: int, words: tuple[str, ...], message: str
) -> None:
    result = flyby("translate", square, *words)
    assert result.exit_code == status
    assert re.search(message, result.stderr.replace("\n", " ")), result.stderr
    assert not result.stdout


def test_a_base_brings_the_new_robot_nearer(flyby: Flyby, square: Path) -> None:
    words = ("translate", square, "--robot", "ur/ur10e", "--from", ROBOT)
    assert flyby(*words).exit_code == 1
    result = flyby(*words, "--base", "800,0,500")
    assert result.exit_code == 0, result.output


def test_an_answer_file_decides_a_branch(flyby: Flyby, small: Small, tmp_path: Path) -> None:
    path = small(
        "IF diPart=1 THEN MoveL Offs(p1,100,0,0), v500, fine, tool0; ENDIF\n    IF diPart=0 THEN "
        "MoveL Offs(p1,0,50,0), v500, fine, tool0; ENDIF\n    Set doDone"
    )
    answers = tmp_path / "answers.toml"
    moves = []
    for value in (0, 1):
        answers.write_text(f"[values]\ndiPart = {value}\n", "utf-8")
        result = flyby("emulate", path, "--robot", ROBOT, "--io", answers, "--json")
        assert result.exit_code == 0, result.output
        moves.append(json.loads(result.stdout)["moves"][-1]["position_m"])
    assert moves[0] != moves[1]


def test_a_wrong_answer_file_is_named(flyby: Flyby, square: Path, tmp_path: Path) -> None:
    answers = tmp_path / "answers.toml"
    answers.write_text("[guesses]\n", "utf-8")
    result = flyby("emulate", square, "--robot", ROBOT, "--io", answers)
    assert result.exit_code == 1
    assert "answers.toml" in result.stderr


@pytest.fixture
def krl(flyby: Flyby, square: Path, tmp_path: Path) -> Path:
    """A program in two files."""
    out = tmp_path / "krc"
    flyby("translate", square, "--robot", "kuka/kr30-3", "--from", ROBOT, "--out", out)
    (source,) = out.glob("*.src")
    return source


def test_a_program_of_several_files_is_written_beside_each_other(
    flyby: Flyby, krl: Path, tmp_path: Path
) -> None:
    target = tmp_path / "neu.src"
    words = ("emulate", krl, "--robot", "kuka/kr30-3", "--write")
    result = flyby(*words, target)
    assert result.exit_code == 0, result.output
    assert target.is_file()
    assert target.with_suffix(".dat").is_file()
    assert "DEF neu" in target.read_text("ascii")
    target.unlink()
    again = flyby(*words, target)
    assert again.exit_code == 1
    assert "neu.dat" in again.stderr.replace("\n", "")
    wrong = flyby(*words, tmp_path / "neu.txt")
    assert wrong.exit_code == 1
    assert "takes several files" in wrong.stderr


def test_a_folder_takes_all_files(flyby: Flyby, krl: Path, tmp_path: Path) -> None:
    folder = tmp_path / "all"
    folder.mkdir()
    result = flyby("emulate", krl, "--robot", "kuka/kr30-3", "--write", folder)
    assert result.exit_code == 0, result.output
    assert {path.suffix for path in folder.iterdir()} == {".src", ".dat"}


def test_a_recording_program_is_written(flyby: Flyby, square: Path, tmp_path: Path) -> None:
    vendor = find_vendor("abb")
    out = tmp_path / "log"
    result = flyby("record", square, "--robot", ROBOT, "--period", "0.02", "--out", out)
    if vendor.recorder is None:
        assert result.exit_code == 1
        assert "abb has no recorder" in result.stderr
        return
    assert result.exit_code == 0, result.output
    assert list(out.iterdir())
    assert flyby("record", square, "--robot", ROBOT, "--period", "0", "--out", out).exit_code == 2


def test_a_further_file_is_read_with_the_program(
    flyby: Flyby, small: Small, tmp_path: Path
) -> None:
    path = small("Away")
    other = tmp_path / "more.mod"
    other.write_text(
        "MODULE More\n  PROC Away()\n    MoveL Offs(p1,100,0,0), v500, fine, tool0;\n"
        "  ENDPROC\nENDMODULE\n",
        "ascii",
    )
    words = ("emulate", path, "--robot", ROBOT, "--json", "--with", other)
    result = flyby(*words)
    assert result.exit_code == 0, result.output
    assert len(json.loads(result.stdout)["moves"]) == 2


PICKS = (
    "WHILE TRUE DO",
    "  WaitDI diPart, 1;",
    "  FOR i FROM 1 TO 3 DO",
    "    MoveL Offs(p1,100,0,0), v500, z10, tool0;",
    "    MoveL Offs(p1,100,100,0), v500, z10, tool0;",
    "  ENDFOR",
    "  Set doGlue;",
    "ENDWHILE",
)


@pytest.fixture
def picks(small: Small) -> Path:
    return small("\n".join(PICKS).rstrip(";"))


def test_loops_are_kept_unless_all_moves_are_to_stand_one_after_the_other(
    flyby: Flyby, picks: Path, tmp_path: Path
) -> None:
    words = ("translate", picks, "--robot", "kuka/kr30-3", "--from", ROBOT, "--out")
    assert flyby(*words, tmp_path / "kept").exit_code == 0
    (source,) = (tmp_path / "kept").glob("*.src")
    assert "LOOP" in source.read_text()
    assert "FOR flyby_1=1 TO 3" in source.read_text()
    assert flyby(*words, tmp_path / "flat", "--flat").exit_code == 0
    (source,) = (tmp_path / "flat").glob("*.src")
    assert "LOOP" not in source.read_text()
    assert source.read_text().count("LIN ") == 6


def test_signals_are_named_once_and_carried_with_their_lines(
    flyby: Flyby, picks: Path, tmp_path: Path
) -> None:
    words = ("translate", picks, "--robot", "kuka/kr30-3", "--from", ROBOT)
    told = flyby(*words).stdout
    assert told.count('"doGlue" = "$OUT[?]"') == 1
    assert told.count('"diPart" = "$IN[?]"') == 1
    report = json.loads(flyby(*words, "--json").stdout)
    assert report["unmapped_signals"] == {"diPart": "$IN[?]", "doGlue": "$OUT[?]"}
    answers = tmp_path / "io.toml"
    answers.write_text('[signals]\ndoGlue = "$OUT[3]"\ndiPart = ["digital_in[1]", "$IN[7]"]\n')
    out = tmp_path / "krc"
    result = flyby(*words, "--io", answers, "--out", out)
    assert "[signals]" not in result.stdout
    (source,) = out.glob("*.src")
    assert "WAIT FOR $IN[7]" in source.read_text()
    assert "$OUT[3]=TRUE" in source.read_text()
    answers.write_text("[signals]\ndoGlue = 3\n")
    assert "doGlue in [signals] is the name of a signal" in flyby(*words, "--io", answers).stderr


def test_folders_in_folders_are_made_and_nothing_is_left_of_what_is_refused(
    flyby: Flyby, square: Path, tmp_path: Path
) -> None:
    words = ("translate", square, "--from", ROBOT, "--out", tmp_path / "a" / "b")
    assert flyby(*words, "--robot", "ur/ur3").exit_code == 1
    assert not (tmp_path / "a").exists()
    assert flyby(*words, "--robot", "kuka/kr30-3").exit_code == 0
    assert len(list((tmp_path / "a" / "b").iterdir())) == 2


def test_the_input_is_never_written_over(flyby: Flyby, square: Path) -> None:
    before = square.read_text()
    words = ("translate", square, "--robot", "abb/irb6640-235-255", "--from", ROBOT, "--force")
    result = flyby(*words, "--out", square.parent)
    assert square.read_text() == before or "would overwrite" in result.stderr


def test_every_routine_gets_a_folder_of_its_name(
    flyby: Flyby, small: Small, tmp_path: Path
) -> None:
    path = small(*SQUARE)
    text = path.read_text().replace(
        "ENDMODULE",
        "  PROC pick()\n    MoveL Offs(p1,50,0,0), v500, fine, tool0;\n"
        "    MoveL Offs(p1,90,0,0), v500, fine, tool0;\n  ENDPROC\n"
        "  PROC place(num n)\n    MoveJ Offs(p1,n,0,0), v500, fine, tool0;\n  ENDPROC\nENDMODULE",
    )
    path.write_text(text)
    words = ("translate", path, "--robot", "kuka/kr30-3", "--from", ROBOT, "--entry")
    out = tmp_path / "krc"
    result = flyby(*words, "all", "--out", out)
    assert result.exit_code == 0, result.output
    assert sorted(p.name for p in out.iterdir()) == ["main", "pick"]
    assert "--entry 'place(n)'" in result.stdout
    assert flyby(*words, "all", "--json").exit_code == 2
    made = tmp_path / "one"
    assert flyby(*words, "place(40)", "--start", "0,0,0,0,30,0", "--out", made).exit_code == 0
    assert list(made.glob("*.src"))


def test_a_program_that_would_meet_what_stands_around_is_not_written(
    flyby: Flyby, tmp_path: Path
) -> None:
    ends = "[0,0,1,0],[0,0,1,0],[9E9,9E9,9E9,9E9,9E9,9E9]];"
    program = tmp_path / "cell.mod"
    program.write_text(
        f"MODULE M\n  CONST robtarget p0:=[[1050,-100,750],{ends}\n"
        f"  CONST robtarget p1:=[[1050,100,750],{ends}\n  PROC main()\n    ConfJ \\Off;\n"
        "    MoveJ p0, v500, fine, tool0;\n    MoveJ p1, v500, fine, tool0;\n  ENDPROC\nENDMODULE\n"
    )
    cell = tmp_path / "cell.toml"
    for away, status in ((0, 1), (900, 0)):
        cell.write_text(
            'robot = "abb/irb1600-6-145"\n[[obstacle]]\nname = "post"\nbox_mm = [80, 80, 200]\n'
            f"pose = {{ xyz_mm = [1050, {100 + away}, 800] }}\n"
        )
        out = tmp_path / str(away)
        words = ("translate", program, "--cell", cell, "--robot", "kuka/kr30-3", "--out", out)
        result = flyby(*words)
        assert result.exit_code == status, result.output
        assert out.exists() == (status == 0)
        if status:
            assert re.search(r"cell.mod:7:5: move 2: .*overlap", result.stderr.replace("\n", " "))
