"""``flyby emulate``: what it prints, what it writes, and what it refuses."""

from __future__ import annotations

import json
import stat
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
from typer.testing import Result

from flyby.core.motion.command.trajectory import Trajectory
from flyby.core.registry import find_vendor

ROOT = Path(__file__).parents[2]
ROBOT = "abb/irb6640-180-255"
SQUARE = ROOT / "examples" / "square.mod"

Flyby = Callable[..., Result]
Small = Callable[..., Path]


def test_the_table_has_a_line_for_every_move(flyby: Flyby) -> None:
    result = flyby("emulate", SQUARE, "--robot", ROBOT)
    assert result.exit_code == 0
    rows = [line.split() for line in result.stdout.splitlines() if line.split()[1:2]]
    moves = [row for row in rows if row[0].isdigit()]
    program = find_vendor("abb").read_file(SQUARE)
    assert [row[1] for row in moves] == [type(move).__name__ for move in program.moves]
    assert "cycle time" in result.stdout
    assert "no start is known" in result.stderr


def test_json_is_all_that_stdout_holds(flyby: Flyby) -> None:
    result = flyby("emulate", SQUARE, "--robot", ROBOT, "--json")
    report = json.loads(result.stdout)
    parts = ("duration_s", "wait_s", "settling_s")
    spent = sum(move[part] for move in report["moves"] for part in parts)
    assert report["cycle_time_s"] == pytest.approx(spent, abs=1e-6)
    warning = report["warnings"][0]
    assert (warning["file"], warning["line"], warning["move"]) == (str(SQUARE), 7, 1)


def test_a_start_gives_the_first_move_something_to_do(flyby: Flyby) -> None:
    words = ("emulate", SQUARE, "--robot", ROBOT, "--json")
    report = json.loads(flyby(*words, "--start", "10,0,0,0,90,0").stdout)
    assert report["moves"][0]["driven"]
    assert report["moves"][0]["duration_s"] > 0
    # The posture is none that the motion model was fitted to, and nothing else is amiss.
    (warning,) = report["warnings"]
    assert warning["move"] is None and "beyond the runs" in warning["message"]


def test_all_files_are_written(flyby: Flyby, tmp_path: Path) -> None:
    names = {"csv": "a.csv", "npz": "a.npz", "plot": "a.svg", "write": "a.mod"}
    options = [word for key, name in names.items() for word in (f"--{key}", tmp_path / name)]
    result = flyby("emulate", SQUARE, "--robot", ROBOT, "--period", "0.01", *options)
    assert result.exit_code == 0, result.output
    assert {path.name for path in tmp_path.iterdir()} == set(names.values())
    assert all(f"wrote {tmp_path / name}" in result.stdout for name in names.values())
    table, arrays = Trajectory.load_csv(tmp_path / "a.csv"), Trajectory.load_npz(tmp_path / "a.npz")
    assert np.allclose(table.q, arrays.q, atol=1e-7)
    assert np.allclose(np.diff(arrays.t)[:-1], 0.01)
    assert (tmp_path / "a.svg").read_text("utf-8").startswith("<?xml")


def test_files_have_the_usual_permissions(flyby: Flyby, tmp_path: Path) -> None:
    usual = tmp_path / "usual"
    usual.touch()
    flyby("emulate", SQUARE, "--robot", ROBOT, "--csv", tmp_path / "a.csv")
    modes = {stat.S_IMODE(path.stat().st_mode) for path in tmp_path.iterdir()}
    assert len(modes) == 1


def test_the_written_program_takes_as_long(flyby: Flyby, tmp_path: Path) -> None:
    clean = tmp_path / "clean.mod"
    words = ("--robot", ROBOT, "--json")
    first = flyby("emulate", SQUARE, *words, "--write", clean)
    second = flyby("emulate", clean, *words)
    a, b = (json.loads(result.stdout)["cycle_time_s"] for result in (first, second))
    assert a == pytest.approx(b, rel=1e-6)


def test_statements_of_an_export_become_comments(flyby: Flyby, tmp_path: Path) -> None:
    """A PolyScope export: what is kept of it names threads and variables of its own."""
    export = ROOT / "tests" / "corpus" / "urscript" / "montage_zelle_2.script"
    written = tmp_path / "clean.script"
    words = ("--robot", "ur/ur5e", "--json")
    result = flyby("emulate", export, *words, "--write", written, "--opaque", "keep")
    assert result.exit_code == 1
    assert "does not have" in result.stderr
    assert "(--opaque comment)" in result.stderr
    assert not written.exists()
    texts = []
    for style in ((), ("--opaque", "comment")):
        first = flyby("emulate", export, *words, "--write", written, "--force", *style)
        assert first.exit_code == 0, first.output
        second = flyby("emulate", written, *words)
        assert second.exit_code == 0, second.output
        a, b = (json.loads(result.stdout) for result in (first, second))
        assert len(a["moves"]) == len(b["moves"])
        assert a["cycle_time_s"] == pytest.approx(b["cycle_time_s"], rel=1e-6)
        texts.append(written.read_text("utf-8"))
    kept, comments = (text.count("\n  set_") for text in texts)
    assert kept > comments


def test_statements_are_kept_where_nothing_else_is_asked_for(
    flyby: Flyby, small: Small, tmp_path: Path
) -> None:
    program = small("SetDO doGun, 1", "MoveL Offs(p1,100,0,0), v200, fine, tool0")
    for words, kept in (((), True), (("--opaque", "keep"), True), (("--opaque", "comment"), False)):
        written = tmp_path / "a.mod"
        result = flyby("emulate", program, "--robot", ROBOT, "--write", written, "--force", *words)
        assert result.exit_code == 0, result.output
        lines = [line.strip() for line in written.read_text().splitlines()]
        assert ("SetDO doGun, 1;" in lines) is kept
        assert ("! SetDO doGun, 1;" in lines) is not kept


def test_a_folder_takes_several_files_with_their_options(flyby: Flyby, tmp_path: Path) -> None:
    seam = ROOT / "examples" / "seam.src"
    for place in (tmp_path, tmp_path / "own.src"):
        words = ("--robot", "kuka/kr30-3", "--write", place, "--force", "--opaque", "comment")
        result = flyby("emulate", seam, *words)
        assert result.exit_code == 0, result.output
    assert {path.name for path in tmp_path.iterdir()} >= {"own.src", "own.dat"}


@pytest.mark.parametrize(("suffix", "magic"), [("png", b"\x89PNG"), ("pdf", b"%PDF")])
def test_plots(flyby: Flyby, small: Small, tmp_path: Path, suffix: str, magic: bytes) -> None:
    program = small(
        "MoveL Offs(p1,100,0,0), v200, z10, tool0",
        "MoveC Offs(p1,150,50,0), Offs(p1,100,100,0), v200, fine, tool0",
        "WaitTime 0.5",
        "MoveJ Offs(p1,0,100,0), v200, z10, tool0",
    )
    plot = tmp_path / f"plot.{suffix}"
    result = flyby("emulate", program, "--robot", ROBOT, "--plot", plot)
    assert result.exit_code == 0, result.output
    assert plot.read_bytes().startswith(magic)


def test_a_cell_brings_robot_and_base(flyby: Flyby, tmp_path: Path) -> None:
    cell = tmp_path / "cell.toml"
    cell.write_text(f'robot = "{ROBOT}"\nbase = {{ xyz_mm = [0, 0, 0] }}\nclearance_mm = 5\n')
    by_cell = flyby("emulate", SQUARE, "--cell", cell, "--json")
    by_name = flyby("emulate", SQUARE, "--robot", ROBOT, "--json")
    assert by_cell.exit_code == 0, by_cell.output
    told, bare = json.loads(by_cell.stdout), json.loads(by_name.stdout)
    near = told.pop("clearance")
    assert bare.pop("clearance") == {"to_cell": None, "own": None}
    assert told == bare
    # Nothing stands there but the robot itself.
    assert near["to_cell"] is None
    assert near["own"]["distance_m"] > 0.0
    assert len(near["own"]["pair"]) == 2
    moved = cell.with_name("moved.toml")
    moved.write_text(cell.read_text().replace("[0, 0, 0]", "[0, 0, 9000]"))
    assert "cannot be reached" in flyby("emulate", SQUARE, "--cell", moved).stderr


def test_an_unreachable_target_names_line_and_move(flyby: Flyby, small: Small) -> None:
    program = small("MoveL Offs(p1,9000,0,0), v200, z10, tool0")
    result = flyby("emulate", program, "--robot", ROBOT)
    assert result.exit_code == 1
    assert result.stderr.startswith(f"error: {program}:6:5: move 2: target cannot be reached")


@pytest.mark.parametrize(
    ("status", "words", "message"),
    [
        (1, ("--robot", "abb/irb664"), "near it are"),
        (1, ("--robot", "kuka/kr3-r540"), "is a program for abb"),
        (1, ("--robot", ROBOT, "--start", "1,2"), "--start: abb/irb6640-180-255 has 6 axes"),
        (2, ("--robot", ROBOT, "--period", "0"), "--period 0: seconds from 1e-05 to 1"),
        (2, ("--robot", ROBOT, "--period", "4"), "--period 4: seconds from 1e-05 to 1"),
        (2, ("--robot", ROBOT, "--period", "nan"), "--period nan: seconds from"),
        (1, ("--robot", ROBOT, "--entry", "foo"), "foo"),
        (2, ("--robot", ROBOT, "--plot", "a.gif"), "must end in .png, .pdf, .svg"),
        (1, ("--robot", ROBOT, "--csv", "/nowhere/a.csv"), "there is no folder /nowhere"),
        (1, ("--robot", ROBOT, "--csv", ROOT), "is no regular file"),
        (1, ("--cell", "nowhere.toml"), "nowhere.toml"),
        (2, ("--robot", ROBOT, "--opaque", "comment"), "--opaque comment is of the program that"),
    ],
)
def test_wrong_input_is_one_message(
    flyby: Flyby, status: int, words: tuple[str, ...], message: str
) -> None:
    result = flyby("emulate", SQUARE, *words)
    assert result.exit_code == status
    assert message in result.stderr
    assert result.stderr.startswith("error: ")
    assert result.stderr.count("\n") == 1
    assert not result.stdout


@pytest.mark.parametrize("content", [None, b"", b"\x00\x01\xff" * 50, "schön".encode()])
def test_files_that_hold_no_program(flyby: Flyby, tmp_path: Path, content: bytes | None) -> None:
    path = tmp_path / "program.mod"
    if content is not None:
        path.write_bytes(content)
    result = flyby("emulate", path, "--robot", ROBOT)
    assert result.exit_code == 1
    assert result.stderr.startswith(f"error: {path}")
    assert result.stderr.count("\n") == 1


def test_an_input_is_never_written_to(flyby: Flyby, small: Small, tmp_path: Path) -> None:
    program = small("MoveL Offs(p1,100,0,0), v200, fine, tool0")
    before = program.read_bytes()
    link = tmp_path / "link.mod"
    link.symlink_to(program)
    for name in (program, link, tmp_path / "." / "small.mod"):
        result = flyby("emulate", program, "--robot", ROBOT, "--write", name, "--force")
        assert result.exit_code == 1
        assert "would overwrite" in result.stderr
    assert program.read_bytes() == before


def test_two_outputs_need_two_names(flyby: Flyby, tmp_path: Path) -> None:
    same = tmp_path / "a"
    result = flyby("emulate", SQUARE, "--robot", ROBOT, "--csv", same, "--npz", same)
    assert result.exit_code == 1
    assert "would overwrite the file of --csv" in result.stderr
    assert not same.exists()


def test_existing_outputs_are_kept_without_force(flyby: Flyby, tmp_path: Path) -> None:
    kept = tmp_path / "a.csv"
    kept.write_text("mine")
    words = ("emulate", SQUARE, "--robot", ROBOT, "--csv", kept)
    assert "--force replaces it" in flyby(*words).stderr
    assert kept.read_text() == "mine"
    assert flyby(*words, "--force").exit_code == 0
    assert kept.read_text().startswith("t,q1,")


def test_nothing_is_written_when_the_program_cannot_be_driven(
    flyby: Flyby, small: Small, tmp_path: Path
) -> None:
    program = small("MoveL Offs(p1,9000,0,0), v200, z10, tool0")
    result = flyby("emulate", program, "--robot", ROBOT, "--csv", tmp_path / "a.csv")
    assert result.exit_code == 1
    assert list(tmp_path.iterdir()) == [program]


def test_clearances_are_told_with_bodies_move_and_line(flyby: Flyby) -> None:
    examples = SQUARE.parent
    result = flyby("emulate", examples / "pick.script", "--cell", examples / "cell" / "pick.toml")
    assert result.exit_code == 0, result.output
    told = " ".join(result.stdout.split())
    assert "to the cell: 40.0 mm between bottle 1 and bottle 2 (move 4, line 18)" in told
    assert "clearance between the arm's own parts:" in told


PLACES = "[9E9,9E9,9E9,9E9,9E9,9E9]"
TURN = f"MoveAbsJ [[%d,0,0,0,30,0],{PLACES}],v1000,fine,tool0;"


def two_routines(tmp_path: Path, *bodies: str, damaged: str = "") -> Path:
    routines = "".join(
        f"PROC {name}()\n{body}\nENDPROC\n" for name, body in zip("abc", bodies, strict=False)
    )
    path = tmp_path / "two.mod"
    path.write_text(f"MODULE two\n{damaged}{routines}ENDMODULE\n")
    return path


def test_a_file_without_a_beginning_is_driven_routine_by_routine(
    flyby: Flyby, tmp_path: Path
) -> None:
    path = two_routines(tmp_path, *(f"{TURN % 0}\n{TURN % n}" for n in (10, 20)), "WaitTime 1;")
    result = flyby("emulate", path, "--robot", ROBOT)
    assert result.exit_code == 0
    assert [line for line in result.stdout.splitlines() if line.endswith("(2 moves)")] == [
        "a (2 moves)",
        "b (2 moves)",
    ]
    assert "there is no PROC main: each routine that moves the robot is driven" in result.stderr
    result = flyby("emulate", path, "--robot", ROBOT, "--json")
    assert result.exit_code == 0
    routines = json.loads(result.stdout)["routines"]
    assert [(one["entry"], one["moves"]) for one in routines] == [("a", 2), ("b", 2)]
    assert 0.0 < routines[0]["run"]["cycle_time_s"] < routines[1]["run"]["cycle_time_s"]
    result = flyby("emulate", path, "--robot", ROBOT, "--csv", tmp_path / "a.csv")
    assert result.exit_code == 1
    assert "choose as the entry one of a (2 moves), b (2 moves), c (no moves)" in result.stderr


def test_routines_with_faults_and_arguments_are_listed_in_json(
    flyby: Flyby, tmp_path: Path
) -> None:
    path = two_routines(tmp_path, f"{TURN % 0}\nMoveL pGone,v100,fine,tool0;\n{TURN % 10}")
    path.write_text(path.read_text().replace("ENDMODULE", NEEDY + "ENDMODULE"), "utf-8")
    result = flyby("emulate", path, "--robot", ROBOT, "--entry", "all", "--json")
    assert result.exit_code == 1
    faulty, needy = json.loads(result.stdout)["routines"]
    lost = faulty["run"]["moves"][1]
    assert (lost["kind"], lost["position_m"], lost["driven"]) == ("move", None, False)
    assert (needy["entry"], needy["moves"]) == ("needy(v)", 2)
    assert [one["driven"] for one in needy["run"]["moves"]] == [False, True]


def test_routines_that_go_where_their_arguments_say_are_no_failure(
    flyby: Flyby, tmp_path: Path
) -> None:
    path = two_routines(tmp_path, *(f"{TURN % 0}\n{TURN % n}" for n in (10, 20)))
    path.write_text(path.read_text().replace("ENDMODULE", NEEDY + OPEN + "ENDMODULE"), "utf-8")
    result = flyby("emulate", path, "--robot", ROBOT)
    assert result.exit_code == 0
    assert "3 of 4 routines driven to the end, 1 of them with arguments" in result.stdout
    assert "depends on the argument p of open" in result.stderr
    assert "with arguments: --entry 'open(p)'" in result.stderr
    asked = flyby("ask", path, "--robot", ROBOT)
    assert asked.exit_code == 0
    assert "\n#v = [" in asked.stdout and "\n#p = [" in asked.stdout
    path.write_text(f"MODULE two\n{OPEN}ENDMODULE\n", "utf-8")
    assert flyby("emulate", path, "--robot", ROBOT).exit_code == 1


NEEDY = f"""PROC needy(speeddata v)
  {TURN % 0}
  {TURN.replace("v1000", "v") % 20}
ENDPROC
"""
OPEN = """PROC open(robtarget p)
  MoveL p,v100,fine,tool0;
ENDPROC
ENDMODULE"""


def test_what_moves_nothing_is_refused_as_such(flyby: Flyby, tmp_path: Path) -> None:
    path = two_routines(tmp_path, "WaitTime 1;", "Stop;")
    result = flyby("emulate", path, "--robot", ROBOT)
    assert result.exit_code == 1
    assert "no routine in it moves the robot: there is nothing to drive" in result.stderr
    assert "warning" not in result.stderr


def test_an_error_leaves_standing_what_was_said_before_it(flyby: Flyby, tmp_path: Path) -> None:
    damaged = "CONST robtarget p:=[[1,2 3],[1,0,0,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]];\n"
    path = two_routines(tmp_path, "MoveJ p,v100,fine,tool0;", damaged=damaged)
    result = flyby("emulate", path, "--robot", ROBOT)
    assert result.exit_code == 1
    assert "two.mod:2:26: the number 3 stands where" in " ".join(result.stderr.split())
    assert "error: " in result.stderr
