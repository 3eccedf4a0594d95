"""``flyby optimize``: what it prints, what it writes where, and what it refuses."""

from __future__ import annotations

import json
import re
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import pytest
from typer.testing import Result

from flyby.core.cell.file import load_cell
from flyby.core.collision.proof.certificate import certify, scenes_of
from flyby.core.motion.emulator.controller import Controller
from flyby.core.program.zone import Radius
from flyby.core.registry import find_robot, find_vendor
from flyby.tasks.catalogue import registry
from flyby.tasks.files.texts import ProgramTexts
from flyby.tasks.setup import Setup

from .box_program import CELL, POINTS, module

PROGRAM = module(
    "MoveAbsJ p1,v1000,z10,rod;",
    "MoveAbsJ p2,v1000,zz,rod;",
    "MoveAbsJ p3,v500,zz,rod; ! keep this too",
)
QUICK = ("--starts", "1", "--generations", "0", "--axes", "2,3")

Flyby = Callable[..., Result]


@pytest.fixture
def program(tmp_path: Path) -> Path:
    path = tmp_path / "m.mod"
    path.write_bytes(PROGRAM.encode())
    return path


def duration(path: Path) -> float:
    vendor, robot = find_vendor("abb"), find_robot("abb/irb6640-180-255")
    return Controller(vendor, robot).run(vendor.read_file(path, robot=robot)).duration


def test_the_program_beside_is_faster_and_proven(
    flyby: Flyby, cell: Path, program: Path, tmp_path: Path
) -> None:
    out, picture = tmp_path / "out", tmp_path / "cell.svg"
    result = flyby(
        "optimize", program, "--cell", cell, *QUICK, "--out", out, "--plot", picture, "--json"
    )
    assert result.exit_code == 0, result.output
    told = json.loads(result.stdout)
    assert told["changed"] and told["proven"] and told["allowed"] == [["J2", "J4"]]
    assert told["files"] == [str(out / "m.mod"), str(picture)]
    assert picture.read_text("utf-8").startswith("<?xml")
    assert program.read_bytes() == PROGRAM.encode()
    new = (out / "m.mod").read_bytes().decode()
    assert "! keep me\r\n" in new and "! keep this too\r\n" in new
    assert duration(out / "m.mod") < 0.85 * duration(program)
    assert f"p0:=[[0,{POINTS[0][0]},{POINTS[0][1]},0,0,0]" in new
    # What is on disk is what was proven.
    where = load_cell(cell, registry())
    vendor = registry().find_vendor("abb")
    controller = Controller(vendor, where.robot)
    run = controller.run(vendor.read_file(out / "m.mod", robot=where.robot))
    assert certify(controller, run, scenes_of(where), 0.005).proven


def test_the_files_own_place(flyby: Flyby, cell: Path, program: Path) -> None:
    before = duration(program)
    result = flyby("optimize", program, "--cell", cell, *QUICK, "--zones-only", "--in-place")
    assert result.exit_code == 0, result.output
    text = program.read_bytes().decode()
    assert duration(program) < before
    for k, (a, b) in enumerate(POINTS):
        assert f"p{k}:=[[0,{a},{b},0,0,0]" in text
    assert "cycle time" in result.stdout and "is proven" in result.stdout


def test_what_is_kept_stays(flyby: Flyby, cell: Path, program: Path, tmp_path: Path) -> None:
    out = tmp_path / "out"
    result = flyby(
        "optimize", program, "--cell", cell, *QUICK, "--keep", "v500", "--keep", "2", "--out", out
    )
    # Move 2 leads to p1, the move at v500 to p3: all zones lie at their ends.
    assert result.exit_code == 0, result.output
    assert not out.exists() and "nothing better was found" in result.stderr.replace("\n", " ")


@pytest.mark.parametrize(
    ("status", "options", "word"),
    [
        (2, ("--objective", "speed"), "--objective speed"),
        (2, ("--objective", "1.5"), "--objective 1.5"),
        (1, ("--keep", "9"), "--keep 9"),
        (1, ("--keep", "vglue"), "a speed (v1000, v500)"),
        (1, ("--free", "5"), "move 5"),
        (2, ("--limit", "2=ball:3"), "--limit 2=ball:3"),
        (2, ("--limit", "2=cone:190"), "--limit 2=cone:190: a cone's angle"),
        (1, ("--axes", "7"), "--axes 7"),
        (2, ("--vias", "some"), "--vias some"),
        (1, ("--clearance", "200"), "clearance"),
        (2, ("--clearance=-3",), "--clearance -3: a distance in mm"),
        (2, ("--clearance", "nan"), "--clearance nan"),
        (2, ("--starts", "0"), "--starts 0: a number from 1 on"),
        (2, ("--generations=-1",), "--generations -1"),
        (2, ("--seed=-1",), "--seed -1"),
        (2, ("--axes", ""), "--axes ''"),
        (2, ("--axes", "2;3"), "--axes 2;3"),
        (2, ("--limit", ""), "--limit"),
        (2, ("--limit", "2=box:-5"), "--limit 2=box:-5: ranges are zero or more"),
        (2, ("--limit", "2=box:"), "--limit 2=box:"),
        (1, ("--limit", "9=fixed"), "--limit 9: the program has moves 1 to 5"),
        (1, ("--limit", "p9=fixed"), "--limit p9: no move goes there"),
        (1, ("--keep", ""), "--keep ''"),
        (2, ("--keep", "2", "--free", "2"), "--free 2: --keep has this stop stay"),
        (2, ("--zones-only", "--limit", "2=fixed"), "--zones-only"),
        (2, ("--zones-only", "--vias", "change"), "--zones-only"),
        (2, ("--plot", "cell.txt"), "--plot"),
        (2, ("--in-place", "--out", "x"), "--out"),
    ],
)
def test_refusals_name_the_option(
    flyby: Flyby, cell: Path, program: Path, status: int, options: tuple[str, ...], word: str
) -> None:
    result = flyby("optimize", program, "--cell", cell, *options)
    assert result.exit_code == status
    assert word in result.stderr.replace("\n", " ")
    assert program.read_bytes() == PROGRAM.encode()


def test_what_is_written_has_few_digits(
    flyby: Flyby, cell: Path, program: Path, tmp_path: Path
) -> None:
    out = tmp_path / "out"
    result = flyby("optimize", program, "--cell", cell, *QUICK, "--own", "--out", out)
    assert result.exit_code == 0, result.output
    text = (out / "m.mod").read_text("utf-8")
    joints = re.findall(r"jointtarget p[123]:=\[\[0,([^,]+),([^,]+),0,0,0\]", text)
    assert len(joints) == 3
    zones = re.findall(r"zonedata \w+:=\[FALSE,([^]]+)\]", text)
    assert len(zones) >= 2
    for number in (*sum(joints, ()), *",".join(zones).split(",")):
        assert len(number.partition(".")[2]) <= 4, text


def test_predefined_zones_are_named_in_the_text(
    flyby: Flyby, cell: Path, program: Path, tmp_path: Path
) -> None:
    out = tmp_path / "out"
    program.write_bytes(PROGRAM.replace("zz,rod", "z1,rod").encode())
    result = flyby("optimize", program, "--cell", cell, *QUICK, "--predefined", "--out", out)
    assert result.exit_code == 0, result.output
    text = (out / "m.mod").read_text("utf-8")
    zones = re.findall(r"MoveAbsJ p[123],v\d+,(z\d+),rod", text)
    assert len(zones) == 3 and "zFb" not in text, text
    assert duration(out / "m.mod") < 0.9 * duration(program)


def test_code_that_was_not_driven_is_told_and_bars_the_files_own_place(
    flyby: Flyby, cell: Path, program: Path, tmp_path: Path
) -> None:
    other = "  PROC other()\r\n    MoveAbsJ p2,v100,fine,rod;\r\n  ENDPROC\r\nENDMODULE"
    program.write_bytes(PROGRAM.replace("ENDMODULE", other).encode())
    given = program.read_bytes()
    refused = flyby("optimize", program, "--cell", cell, *QUICK, "--in-place")
    told = refused.stderr.replace("\n", " ")
    assert refused.exit_code == 1 and "nothing was written" in told
    assert "p2 has changed, and is also used in line 17" in told
    assert program.read_bytes() == given
    beside = flyby("optimize", program, "--cell", cell, *QUICK, "--out", tmp_path / "out")
    assert beside.exit_code == 0 and "p2 has changed" in beside.stderr.replace("\n", " ")
    zones = flyby("zones", program, "--cell", cell, "--in-place")
    assert zones.exit_code == 0, "the other code reads no zone that changes"


def test_a_limit_for_all_holds_every_point(
    flyby: Flyby, cell: Path, program: Path, tmp_path: Path
) -> None:
    out = tmp_path / "out"
    result = flyby(
        "optimize", program, "--cell", cell, *QUICK, "--limit", "all=joints:2", "--out", out
    )
    assert result.exit_code == 0, result.output
    new = Controller(find_vendor("abb"), find_robot("abb/irb6640-180-255"))
    read = find_vendor("abb").read_file(out / "m.mod", robot=new.robot)
    for move, (a, b) in zip(read.moves, POINTS, strict=True):
        q = [value * 180 / 3.141592653589793 for value in move.target.joints]  # type: ignore[union-attr]
        assert abs(q[1] - a) <= 2.0001 and abs(q[2] - b) <= 2.0001


def test_code_for_another_vendor_stands_beside(
    flyby: Flyby, cell: Path, program: Path, tmp_path: Path
) -> None:
    out = tmp_path / "out"
    words = (*QUICK, "--zones-only", "--also", "kuka/kr30-3", "--out", out, "--json")
    result = flyby("optimize", program, "--cell", cell, *words)
    assert result.exit_code == 0, result.output
    told = json.loads(result.stdout)
    names = ["m.mod", "kuka/m.src", "kuka/m.dat"]
    assert sorted(told["files"]) == sorted(str(out / name) for name in names)
    said = [note["message"] for note in told["notes"]]
    assert any("nothing is proven of the program for kuka/kr30-3" in text for text in said)
    # The other robot stands where the first one does, and puts its tool to the same places.
    abb, kuka = registry().find_vendor("abb"), registry().find_vendor("kuka")
    arm = find_robot("kuka/kr30-3")
    old = abb.read_file(out / "m.mod", robot=find_robot("abb/irb6640-180-255"))
    new = kuka.read_file(out / "kuka" / "m.src", robot=arm)
    paths = [
        Controller(abb, find_robot("abb/irb6640-180-255")).plan(old),
        Controller(kuka, arm).plan(new),
    ]
    places = [path.segments.ends.position[:, 1] for path in paths]
    assert len(old.moves) == len(new.moves)
    assert places[0] == pytest.approx(places[1], abs=1e-4)


@pytest.mark.parametrize(
    ("status", "options", "word"),
    [
        (2, ("--also", "kuka/kr30-3"), "name a folder by --out"),
        (
            1,
            ("--also", "kuka", "--out", "o"),
            "--also kuka: which of its",
        ),
        (1, ("--also", "fanuc", "--out", "o"), "fanuc"),
        (1, ("--also", "kuka/iiwa7-r800", "--out", "o"), "no program can be written"),
        (1, ("--also", "kuka/kr3-r540", "--out", "o"), "kuka/kr3-r540 cannot reach"),
    ],
)
def test_what_another_vendor_cannot_have_is_refused_before_work_begins(
    flyby: Flyby,
    cell: Path,
    program: Path,
    tmp_path: Path,
    status: int,
    options: tuple[str, ...],
    word: str,
) -> None:
    words = [tmp_path / "o" if word == "o" else word for word in options]
    result = flyby("optimize", program, "--cell", cell, *words)
    assert result.exit_code == status
    assert word in result.stderr.replace("\n", " ")
    assert not (tmp_path / "o").exists()


def test_other_moves_are_no_patch(flyby: Flyby, cell: Path, program: Path) -> None:
    result = flyby("optimize", program, "--cell", cell, "--vias", "change", "--in-place")
    assert result.exit_code == 2 and "name a folder by --out" in result.stderr.replace("\n", " ")
    assert program.read_bytes() == PROGRAM.encode()


def test_other_via_points_are_written_beside(
    flyby: Flyby, cell: Path, program: Path, tmp_path: Path
) -> None:
    """With nothing in the way, a via point that may hardly move is better left out."""
    cell.write_text(CELL.split("[[obstacle]]")[0] + CELL[CELL.index("[allow]") :], "utf-8")
    lines = [line for line in PROGRAM.split("\r\n") if " p2," not in line and " p3," not in line]
    program.write_bytes("\r\n".join(lines).encode())
    out = tmp_path / "out"
    words = (*QUICK, "--vias", "change", "--limit", "2=joints:1", "--out", out)
    result = flyby("optimize", program, "--cell", cell, *words)
    assert result.exit_code == 0, result.output
    vendor, robot = find_vendor("abb"), find_robot("abb/irb6640-180-255")
    (file,) = out.iterdir()
    old, new = (vendor.read_file(path, robot=robot) for path in (program, file))
    assert len(new.moves) == len(old.moves) - 1
    assert duration(file) < duration(program)


def test_other_moves_are_written_anew(program: Path) -> None:
    vendor, robot = find_vendor("abb"), find_robot("abb/irb6640-180-255")
    read = vendor.read_file(program, robot=robot)
    fewer = replace(read, statements=(*read.statements[:2], *read.statements[3:]))
    emission = ProgramTexts(Setup(vendor, robot), read, own=False)
    again = emission.read_back(fewer)
    assert emission.last and str(program) not in {file.name for file in emission.last.values()}
    assert len(again.moves) == len(read.moves) - 1
    for one, other in zip(fewer.moves, again.moves, strict=True):
        assert isinstance(one.zone, Radius) == isinstance(other.zone, Radius)
        assert one.target.joints == pytest.approx(other.target.joints)  # type: ignore[union-attr]
    assert emission.read_back(read).moves == read.moves and not emission.last
