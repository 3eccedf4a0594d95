"""What is written drives what was driven, without the user's other files, or is refused."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from flyby.core.errors import FlybyError, InputError, MotionError, SourceError
from flyby.core.language import Sources
from flyby.core.motion.emulator.controller import Controller
from flyby.core.program.move import Opaque
from flyby.core.program.program import Program
from flyby.core.read_back import check_alone
from flyby.core.registry import find_robot, find_vendor
from flyby.core.vendor import Vendor

ROBOTS = {"abb": "abb/irb6640-180-255", "kuka": "kuka/kr30-3", "ur": "ur/ur10e"}
AXES = "[9E9,9E9,9E9,9E9,9E9,9E9]"
HOME = f"[[0,-4,42,0,30,0],{AXES}]"
NULL = "{X 0,Y 0,Z 0,A 0,B 0,C 0,S 2,T 2}"
CONFIG = f"DEFDAT $CONFIG PUBLIC\nDECL GLOBAL E6POS POS_NOW={NULL}\nENDDAT\n"
START = "PTP {A1 0,A2 -90,A3 90,A4 0,A5 45,A6 0}\n"


def krl(before: str, after: str) -> str:
    """A program with statements before and after its first move."""
    frames = "$BASE=$NULLFRAME\n$TOOL=$NULLFRAME\n$VEL.CP=0.5\n"
    return f"DEF m()\n{frames}{before}{START}{after}END\n"


DRIVEN: dict[str, tuple[str, dict[str, str]]] = {
    "a motion to where the robot is, before the first": (
        "kuka",
        {
            "m.src": krl("POS_NOW=$POS_ACT\nPTP POS_NOW\n", "LIN_REL {Z -50}\n"),
            "$config.dat": CONFIG,
        },
    ),
    "a pose that is read on the way": (
        "kuka",
        {
            "m.src": krl("", "POS_NOW=$POS_ACT\nPOS_NOW.Z=POS_NOW.Z-50\nLIN POS_NOW\n"),
            "$config.dat": CONFIG,
        },
    ),
    "a datum of another file, changed by the program": (
        "abb",
        {
            "m.mod": "MODULE m\nPROC main()\nMoveAbsJ jHome,v500,z10,tool0;\n"
            "pNow:=CRobT(\\Tool:=tool0\\WObj:=wobj0);\npNow:=Offs(pNow,0,0,-nDeep);\n"
            "MoveL pNow,vOwn,fine,tool0;\nEND\nENDPROC\nENDMODULE\n".replace("\nEND\n", "\n"),
            "data.mod": f"MODULE data\nCONST jointtarget jHome:={HOME};\n"
            "VAR robtarget pNow:=[[0,0,0],[1,0,0,0],[0,0,0,0],"
            f"{AXES}];\nPERS num nDeep:=50;\nPERS speeddata vOwn:=[80,20,50,50];\nENDMODULE\n",
        },
    ),
    "a global and a function of another file": (
        "ur",
        {
            "m.script": "def m():\n  movej(home, a=1, v=0.5)\n  here = get_actual_tcp_pose()\n"
            "  movel(lower(here), a=0.5, v=0.1)\nend\n",
            "lib.script": "global home = [0,-1.5,1.5,0,0.5,0]\n"
            "def lower(p):\n  return pose_trans(p, p[0,0,0.05,0,0,0])\nend\n",
        },
    ),
}


def read(folder: Path, files: dict[str, str], vendor: Vendor, robot: Any) -> Program:
    folder.mkdir(exist_ok=True)
    for name, text in files.items():
        (folder / name).write_text(text)
    main, *others = (folder / name for name in files)
    return vendor.read_file(main, robot=robot, others=others)


def alone(folder: Path, sources: Sources, vendor: Vendor, robot: Any) -> Program:
    folder.mkdir()
    for name, text in sources.items():
        (folder / name).write_text(text)
    main = next(name for name in sources if name.lower().endswith(vendor.suffixes))
    return vendor.read_file(folder / main, robot=robot)


@pytest.mark.parametrize("case", DRIVEN)
def test_what_is_written_drives_alike_alone(case: str, tmp_path: Path) -> None:
    name, files = DRIVEN[case]
    vendor, robot = find_vendor(name), find_robot(ROBOTS[name])
    program = read(tmp_path / "old", files, vendor, robot)
    controller = Controller(vendor, robot)
    run = controller.run(program)
    for how, sources in (
        ("written", vendor.write(program, robot)),
        ("recorded", vendor.record(program, robot, 0.12)),
    ):
        again = alone(tmp_path / how, sources, vendor, robot)
        copy = controller.run(Program(again.moves))
        assert copy.duration == pytest.approx(run.duration, rel=1e-4)
        assert np.abs(copy.path.q[[0, -1]] - run.path.q[[0, -1]]).max() < 1e-6
        for move, other in zip(program.moves, again.moves, strict=True):
            assert type(move.zone) is type(other.zone)


REFUSED: dict[str, tuple[str, dict[str, str], str]] = {
    "kuka": (
        "COUNT",
        {"m.src": krl("DECL INT COUNT\n", "COUNT=3\nWAIT FOR $IN[COUNT]\nLIN_REL {Z -50}\n")},
        "count",
    ),
    "abb": (
        "nParts",
        {
            "m.mod": f"MODULE m\nVAR num nParts:=0;\nCONST jointtarget jHome:={HOME};\n"
            'PROC main()\nMoveAbsJ jHome,v500,fine,tool0;\nnParts:=nParts+1;\nTPWrite "n"'
            "\\Num:=nParts;\nMoveAbsJ jHome,v500,fine,tool0;\nENDPROC\nENDMODULE\n"
        },
        "nparts",
    ),
    "ur": (
        "count",
        {
            "m.script": "def m():\n  movej([0,-1.5,1.5,0,0.5,0], a=1, v=0.5)\n  count = 3\n"
            "  set_digital_out(count, True)\nend\n"
        },
        "count",
    ),
}


@pytest.mark.parametrize("name", REFUSED)
def test_kept_statements_that_cannot_stand_alone_are_refused(name: str, tmp_path: Path) -> None:
    _, files, folded = REFUSED[name]
    vendor, robot = find_vendor(name), find_robot(ROBOTS[name])
    program = read(tmp_path / "old", files, vendor, robot)
    with pytest.raises(SourceError, match=f"names '{folded}'.*opaque=.comment."):
        vendor.write(program, robot)
    assert vendor.write(program, robot, {"opaque": "comment"})


@pytest.mark.parametrize("name", ROBOTS)
def test_a_kept_statement_that_drives_is_refused(name: str, tmp_path: Path) -> None:
    """Whatever has kept it: it would move the robot where nothing was looked at."""
    words = {
        "abb": f"MoveAbsJ [[10,-4,42,0,30,0],{AXES}],v500,fine,tool0;",
        "kuka": "PTP {A1 10,A2 -90,A3 90,A4 0,A5 45,A6 0}",
        "ur": "movej([0.1,-1.5,1.5,0,0.5,0], a=1, v=0.5)",
    }
    vendor, robot = find_vendor(name), find_robot(ROBOTS[name])
    files = next(files for vendor_, files in DRIVEN.values() if vendor_ == name)
    program = read(tmp_path / "old", files, vendor, robot)
    first, *rest = program.statements
    driving = replace(program, statements=(first, Opaque(words[name]), *rest))
    with pytest.raises(MotionError, match=r"written anew, the program has .* kept"):
        vendor.write(driving, robot)


class Careless:
    """A stranger's writer that leaves a part out."""

    def __init__(self, vendor: Vendor, drop: Any) -> None:
        self._writer, self._drop = vendor.writer, drop

    def write(self, program: Program, robot: Any, options: Any) -> Sources:
        return self._writer.write(self._drop(program), robot, options)  # type: ignore[union-attr]


def without_last(program: Program) -> Program:
    return replace(program, statements=program.statements[:-1])


def elsewhere(program: Program) -> Program:
    first, *rest = program.moves
    target = replace(first.target, joints=(0.3, *first.target.joints[1:]))  # type: ignore[union-attr]
    return program.with_moves((replace(first, target=target), *rest))


@pytest.mark.parametrize("drop", [without_last, elsewhere])
@pytest.mark.parametrize("name", ROBOTS)
def test_any_vendors_text_is_held_to_its_program(name: str, drop: Any, tmp_path: Path) -> None:
    sound, robot = find_vendor(name), find_robot(ROBOTS[name])
    case = next(k for k, (vendor, _) in reversed(DRIVEN.items()) if vendor == name)
    program = read(tmp_path / "old", DRIVEN[case][1], sound, robot)
    with pytest.raises(FlybyError, match="written anew"):
        replace(sound, writer=Careless(sound, drop)).write(program, robot)
    unread = replace(sound, writer=Garbled())
    with pytest.raises(InputError, match="cannot be written anew"):
        unread.write(program, robot)


class Garbled:
    """A writer whose text nobody reads."""

    def write(self, program: Program, robot: Any, options: Any) -> Sources:
        return {f"m{suffix}": ")" for suffix in (".mod", ".src", ".script")}


@pytest.mark.parametrize(("kept", "comments"), [(False, False), (True, False), (True, True)])
def test_comments_are_offered_where_they_would_help(kept: bool, comments: bool) -> None:
    vendor, robot = find_vendor("abb"), find_robot(ROBOTS["abb"])
    text = (
        f"MODULE m\nPROC main()\nMoveAbsJ {HOME},v500,fine,tool0;\nSetDO x,1;\nENDPROC\nENDMODULE\n"
    )
    program = vendor.read(text, "m.mod")
    if not kept:
        program = replace(program, statements=program.moves)
    other = {"m.mod": text.replace("30,0]", "40,0]")}
    assert vendor.reader is not None
    with pytest.raises(MotionError) as caught:
        check_alone(program, robot, other, vendor.reader, (".mod",), comments=comments)
    assert ("make kept statements comments" in str(caught.value)) == (kept and not comments)
    assert "patch the program's own files" in str(caught.value)
