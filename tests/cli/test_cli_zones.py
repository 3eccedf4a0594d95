"""``flyby zones``: what it prints, what it writes where, and what it refuses."""

from __future__ import annotations

import json
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from types import SimpleNamespace

import pytest
import trimesh
from typer.testing import Result

from flyby.core.collision.proof.verdict import Verdict
from flyby.core.errors import InputError
from flyby.core.registry import find_robot, find_vendor
from flyby.core.source.reading import Reading
from flyby.core.source.text.files import SourceFile
from flyby.tasks.files.places import FilePlaces

from .box_program import CELL, module

ROBOT = "abb/irb6640-180-255"
MOVES = "MoveAbsJ p1,v1000,z10,rod; MoveAbsJ p2,v1000,zz,rod; MoveAbsJ p3,v1000,zz,rod;"
IN_PLACE = FilePlaces(None, True, [], False)

Flyby = Callable[..., Result]


def _program(folder: Path, moves: str = MOVES) -> Path:
    path = folder / "m.mod"
    path.write_bytes(module(moves).encode())
    return path


def _zones(path: Path) -> list[float]:
    program = find_vendor("abb").read_file(path, robot=find_robot(ROBOT))
    return [getattr(move.zone, "tcp", 0.0) for move in program.moves]


def test_a_table_and_no_file_unless_one_is_asked_for(flyby: Flyby, cell: Path, tmp_path: Path):
    path = _program(tmp_path)
    before = path.read_bytes()
    result = flyby("zones", path, "--cell", cell)
    assert result.exit_code == 0, result.output
    assert "the rules for neighbouring points" in result.stdout
    assert "cycle time" in result.stdout and "is proven" in result.stdout
    assert "allowed to touch by the cell: J2 and J4" in result.stdout
    assert "nothing was written" in result.stdout
    assert path.read_bytes() == before
    assert sorted(p.name for p in tmp_path.iterdir()) == ["cell.toml", "m.mod"]


def test_files_are_changed_in_place_or_in_a_folder(flyby: Flyby, cell: Path, tmp_path: Path):
    path, out = _program(tmp_path), tmp_path / "new"
    result = flyby("zones", path, "--cell", cell, "--out", out, "--json")
    assert result.exit_code == 0, result.output
    told = json.loads(result.stdout)
    assert told["files"] == [str(out / "m.mod")] and told["proven"]
    assert told["allowed"] == [["J2", "J4"]]
    sizes = _zones(out / "m.mod")
    assert sizes[1] > 0.19 and sizes[2] == sizes[3] > 0.17, "one datum, one zone"
    assert [zone["move"] for zone in told["zones"]] == [2, 3, 4]
    again = flyby("zones", path, "--cell", cell, "--out", out)
    assert again.exit_code == 1 and "--force" in again.stderr
    both = flyby("zones", path, "--cell", cell, "--out", out, "--in-place")
    assert both.exit_code == 2 and "one place or the other" in both.stderr
    assert flyby("zones", path, "--cell", cell, "--in-place").exit_code == 0
    assert path.read_bytes() == (out / "m.mod").read_bytes()
    assert path.read_bytes().startswith(b"MODULE m ! keep me\r\n")
    third = flyby("zones", path, "--cell", cell, "--in-place")
    assert "nothing was written: the program stays as it is" in third.stdout


def test_own_data_part_what_the_text_has_in_one(flyby: Flyby, cell: Path, tmp_path: Path):
    path = _program(tmp_path)
    assert flyby("zones", path, "--cell", cell, "--own", "--in-place").exit_code == 0
    sizes = _zones(path)
    assert sizes[2] > sizes[3] > 0.17


def test_predefined_zones_are_named_in_the_text(flyby: Flyby, cell: Path, tmp_path: Path):
    path = _program(tmp_path, MOVES.replace("zz", "z1"))
    words = ("zones", path, "--cell", cell, "--predefined", "--in-place")
    assert flyby(*words).exit_code == 0
    assert path.read_bytes().count(b"z150,rod") == 3
    kuka = tmp_path / "kuka.toml"
    kuka.write_text('robot = "kuka/kr30-3"\n', "utf-8")
    source = tmp_path / "k.src"
    source.write_text("DEF k()\nPTP {A1 0,A2 -90,A3 90,A4 0,A5 0,A6 0}\nEND\n", "utf-8")
    result = flyby("zones", source, "--cell", kuka, "--predefined")
    assert result.exit_code == 1 and "has no predefined zones" in result.stderr


def test_stops_are_freed_by_number_or_all(flyby: Flyby, cell: Path, tmp_path: Path):
    moves = MOVES.replace("zz", "fine").replace("z10", "fine")
    path = _program(tmp_path, moves)
    refused = flyby("zones", path, "--cell", cell)
    assert refused.exit_code == 1 and "stops at every point" in refused.stderr
    assert flyby("zones", path, "--cell", cell, "--free", "3", "--in-place").exit_code == 0
    assert [size > 0 for size in _zones(path)] == [False, False, True, False, False]
    assert flyby("zones", path, "--cell", cell, "--free", "all", "--in-place").exit_code == 0
    assert [size > 0 for size in _zones(path)] == [False, True, True, True, False]
    for status, option, text, message in (
        (1, "--free", "x", "no move goes there"),
        (1, "--free", "1,3", "name moves by a number"),
        (1, "--free", "9", "moves 1 to 5"),
        (1, "--keep", "0", "moves 1 to 5"),
        (2, "--clearance", "-3", "--clearance -3: a distance in mm"),
        (2, "--clearance", "inf", "--clearance inf"),
    ):
        result = flyby("zones", path, "--cell", cell, option, text)
        assert result.exit_code == status and message in result.stderr


def test_a_zone_that_other_code_reads_bars_the_files_own_place(
    flyby: Flyby, cell: Path, tmp_path: Path
):
    path = _program(tmp_path)
    other = b"  PROC other()\r\n    MoveAbsJ p0,v100,zz,rod;\r\n  ENDPROC\r\nENDMODULE"
    path.write_bytes(path.read_bytes().replace(b"ENDMODULE", other))
    given = path.read_bytes()
    result = flyby("zones", path, "--cell", cell, "--in-place")
    assert result.exit_code == 1 and "zz has changed" in result.stderr.replace("\n", " ")
    assert path.read_bytes() == given
    assert flyby("zones", path, "--cell", cell, "--in-place", "--own").exit_code == 0
    assert b"zz:=[FALSE,30,45,45,4.5,45,4.5]" in path.read_bytes()


def test_what_is_kept_and_freed_at_once_is_refused(flyby: Flyby, cell: Path, tmp_path: Path):
    path = _program(tmp_path, MOVES.replace("zz", "fine"))
    words = ("zones", path, "--cell", cell, "--keep", "3")
    refused = flyby(*words, "--free", "3")
    assert refused.exit_code == 2 and "--free 3: --keep" in refused.stderr
    assert flyby(*words, "--free", "all", "--in-place").exit_code == 0
    assert [size > 0 for size in _zones(path)] == [False, True, False, True, False]


def test_what_is_not_proven_is_not_written_unless_by_name(
    flyby: Flyby, cell: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
):
    import flyby.problems.improve.solve_round_verify as module

    certify = module.certify

    def doubtful(*args, **words):
        return replace(certify(*args, **words), verdict=Verdict.UNPROVEN, message="in doubt")

    monkeypatch.setattr(module, "certify", doubtful)
    path = _program(tmp_path)
    before = path.read_bytes()
    result = flyby("zones", path, "--cell", cell, "--in-place")
    assert result.exit_code == 1 and "in doubt" in result.stderr
    assert path.read_bytes() == before
    words = ("zones", path, "--cell", cell, "--in-place", "--unproven")
    assert flyby(*words).exit_code == 1
    assert path.read_bytes() != before


def test_a_collision_is_told_with_its_line(flyby: Flyby, cell: Path, tmp_path: Path):
    cell.write_text(CELL.replace("1200, 830", "1200, 930").replace("415", "465"), "utf-8")
    result = flyby("zones", _program(tmp_path), "--cell", cell)
    assert result.exit_code == 1
    assert "m.mod:11:" in result.stderr and "move 3" in result.stderr
    assert "rod and box overlap by up to" in result.stderr


def test_a_mesh_in_wrong_units_is_suspected_where_the_program_collides(
    flyby: Flyby, cell: Path, tmp_path: Path
):
    trimesh.creation.box((2500.0, 1200.0, 900.0)).export(tmp_path / "bench.stl")
    bench = '[[obstacle]]\nname = "bench"\nmesh = "bench.stl"\nunits = "m"\n'
    cell.write_text(CELL.replace("[allow]", bench + "[allow]"), "utf-8")
    result = flyby("zones", _program(tmp_path), "--cell", cell)
    assert result.exit_code == 1
    assert "with units = 'mm' it would be 2.5 m" in result.stderr.replace("\n", " ")


def test_an_edit_saved_meanwhile_is_not_lost(tmp_path: Path) -> None:
    path = tmp_path / "a.mod"
    read = {str(path): SourceFile(str(path), "old")}
    new = {str(path): SourceFile(str(path), "new")}
    original = SimpleNamespace(name="a", setup=None, reading=Reading(read, str(path), None, None))
    path.write_bytes(b"edited")
    with pytest.raises(InputError, match="has changed since it was read"):
        IN_PLACE.write(new, original)
    assert path.read_bytes() == b"edited"
    path.write_bytes(b"old")
    assert IN_PLACE.write(new, original) == [path]
    assert path.read_bytes() == b"new"


def test_files_that_cannot_be_encoded_leave_the_others_alone(tmp_path: Path) -> None:
    names = [str(tmp_path / name) for name in ("a.mod", "b.mod")]
    read = {name: SourceFile(name, "old") for name in names}
    for name in names:
        Path(name).write_bytes(b"old")
    new = {names[0]: SourceFile(names[0], "new"), names[1]: SourceFile(names[1], "ne中", "cp1252")}
    with pytest.raises(InputError, match="cannot be written"):
        IN_PLACE.write(
            new, SimpleNamespace(setup=None, reading=Reading(read, names[0], None, None))
        )
    assert [Path(name).read_bytes() for name in names] == [b"old", b"old"]


LOW = """MODULE low
  CONST jointtarget h := [[0,0,0,0,30,0],[9E9,9E9,9E9,9E9,9E9,9E9]];
  CONST robtarget p1 := [[1500,-400,500],[0,0,1,0],[-1,0,-1,0],[9E9,9E9,9E9,9E9,9E9,9E9]];
  CONST robtarget p2 := [[1500,0,900],[0,0,1,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]];
  CONST robtarget p3 := [[1500,400,-120],[0,0,1,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]];
  PROC main()
    MoveAbsJ h,v1000,fine,tool0;
    MoveJ p1,v1000,fine,tool0;
    MoveL p2,v1000,z10,tool0;
    MoveL p3,v1000,fine,tool0;
  ENDPROC
ENDMODULE
"""


@pytest.mark.parametrize("command", ["zones", "optimize"])
def test_without_a_cell_there_is_a_floor(flyby: Flyby, tmp_path: Path, command: str) -> None:
    """A program's own targets below it are named, with what helps."""
    program = tmp_path / "low.mod"
    program.write_text(LOW, "utf-8")
    words = [command, program, "--robot", "abb/irb6640-180-255"]
    words += ["--starts", 1, "--generations", 0] if command == "optimize" else []
    refused = flyby(*words)
    assert refused.exit_code == 1
    assert "low.mod:10" in refused.stderr and "below the plane under the base" in refused.stderr
    assert "--no-floor" in refused.stderr
    lifted = flyby(*words, "--no-floor")
    assert lifted.exit_code == 0, lifted.output
    assert "nothing stands around" in lifted.output
    program.write_text(LOW.replace("400,-120", "400,300"), "utf-8")
    above = flyby(*words)
    assert above.exit_code == 0 and "the plane under the base" in above.output


def test_a_cell_says_itself_what_stands_there(flyby: Flyby) -> None:
    cell = Path(__file__).parents[2] / "examples" / "cell"
    words = ["zones", cell / "two_joints.mod", "--cell", cell / "two_joints.toml", "--no-floor"]
    result = flyby(*words)
    assert result.exit_code == 2 and "--no-floor" in result.stderr


SHARED = """MODULE shared
  PERS zonedata own := [FALSE,12,18,18,1.8,18,1.8];
  CONST robtarget p1 := [[1500,-200,900],[0,0,1,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]];
  PROC main()
    ConfL\\Off;
    ConfJ\\Off;
    MoveJ p1,v1000,fine,tool0;
    MoveL Offs(p1,0,200,0),v500,own,tool0;
    MoveL Offs(p1,0,200,200),v500,own,tool0;
    MoveL Offs(p1,0,0,200),v500,fine,tool0;
  ENDPROC
ENDMODULE
"""


def test_a_datum_that_another_move_needs_stays_with_a_note(flyby: Flyby, tmp_path: Path) -> None:
    """The command goes on, and its advice is an option that it has."""
    program = tmp_path / "shared.mod"
    program.write_text(SHARED, "utf-8")
    words = ["zones", program, "--robot", "abb/irb6640-180-255", "--keep", 2]
    result = flyby(*words)
    assert result.exit_code == 0, result.output
    told = " ".join(result.output.split())
    assert "its zone stays as it is:" in told and "is read by move 2 as well" in told
    assert "--own" in told
    assert flyby(*words, "--own").exit_code == 0


OVERLAPPING = """def overlapping():
  movej([-0.3,-1.4,1.9,-2.0,-1.57,0],a=1.4,v=1.05)
  movej(get_inverse_kin(p[0.5,-0.2,0.35,2.2,2.2,0]),a=1.4,v=1.05)
  movel(p[0.5,-0.15,0.35,2.2,2.2,0],a=1.2,v=0.25,r=0.04)
  movel(p[0.5,-0.15,0.38,2.2,2.2,0],a=1.2,v=0.25,r=0.02)
  movel(p[0.5,0.1,0.38,2.2,2.2,0],a=1.2,v=0.25,r=0.02)
  movel(p[0.5,0.1,0.5,2.2,2.2,0],a=1.2,v=0.25)
end
"""


@pytest.mark.parametrize("command", ["zones", "optimize"])
def test_a_waypoint_that_is_left_out_does_not_return(
    flyby: Flyby, tmp_path: Path, command: str
) -> None:
    """Its blend overlaps the next one's; with smaller ones the robot would go there, and slower."""
    program = tmp_path / "overlapping.script"
    program.write_text(OVERLAPPING, "utf-8")
    words = [command, program, "--robot", "ur/ur10e", "--no-floor", "--json"]
    words += ["--starts", 1, "--generations", 0] if command == "optimize" else []
    result = flyby(*words)
    assert result.exit_code == 0, result.output
    told = json.loads(result.stdout)
    times = next(row for row in told["figures"] if row["what"] == "cycle time")
    assert times["after"] <= times["before"]
    if command == "zones":
        assert any("leaves the waypoint of move 4 out" in n["message"] for n in told["notes"])


@pytest.mark.parametrize("command", ["zones", "optimize"])
def test_what_a_target_is_taken_for_is_not_proven(
    flyby: Flyby, tmp_path: Path, command: str
) -> None:
    """It would hold for the number that nobody gave alone; what else is not known is said."""
    at = "[[{},400],[0,0,1,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]]"
    points = [
        f"CONST robtarget p{k}:={at.format(xy)};" for k, xy in enumerate(("400,0", "400,200"))
    ]
    file = tmp_path / "a.mod"
    file.write_text(
        "\n".join(
            (
                "MODULE a",
                "VAR iodev dev;",
                *points,
                "PROC main()",
                "VAR num h;",
                "IF di1=1 WaitTime 1;",
                "h:=ReadNum(dev);",
                "MoveJ p0,v500,fine,tool0;",
                "MoveL Offs(p1,0,0,h),v500,z10,tool0;",
                "MoveL p0,v500,fine,tool0;",
                "ENDPROC",
                "ENDMODULE",
            )
        )
    )
    result = flyby(command, file, "--robot", "abb/irb120-3-058", "--no-floor")
    assert result.exit_code != 0
    assert "as it is taken to run; --io says" in result.stderr
    assert "a.mod:10:1: the target of MoveL depends on the value of ReadNum(dev)" in result.stderr
    answers = tmp_path / "answers.toml"
    answers.write_text('[values]\n"ReadNum(dev)" = 10\n')
    result = flyby(command, file, "--robot", "abb/irb120-3-058", "--no-floor", "--io", answers)
    assert result.exit_code == 0 and "nothing can be proven" not in result.stderr
