"""External axes of targets that stand behind places of axes that the robot has not."""

from __future__ import annotations

import math
from dataclasses import replace
from pathlib import Path

import pytest

import flyby
from flyby.core.cell.cell import Cell
from flyby.core.cell.cell_text import cell_text
from flyby.core.cell.file import load_cell
from flyby.core.errors import FlybyError, InputError
from flyby.core.program.program import Program
from flyby.core.registry import installed
from flyby.core.spatial.pose import IDENTITY, Pose
from flyby.vendors.abb.motion.external_axes import axis_kinds
from flyby.vendors.abb.record import _columns, _line_routine
from flyby.vendors.abb.write.options import RapidOptions
from flyby.vendors.abb.write.writer import write

CELL = """robot = "abb/irb2600-12-185"
[external_axis.tilt]
role = "table"
kind = "revolute"
axis = "y"
pose = { xyz_mm = [1000, 0, 200] }
range_deg = [-90, 90]
speed_deg_s = 60
acceleration_deg_s2 = 120
number = 2
[external_axis.STN1]
role = "table"
kind = "revolute"
axis = "z"
pose = { xyz_mm = [0, 0, 150] }
range_deg = [-360, 360]
speed_deg_s = 120
acceleration_deg_s2 = 240
carried_by = "tilt"
"""

TEXT = """MODULE weldtable   ! positionneur sur les axes 8 et 9
PERS tooldata tTorch:=[TRUE,[[40,0,310],[0.92388,0,0.382683,0]],[4,[0,0,120],[1,0,0,0],0,0,0]];
TASK PERS wobjdata wPlate:=[FALSE,FALSE,"STN1",[[1611,-7,502],[1,0,0,0]],[[0,0,30],[1,0,0,0]]];
VAR robtarget here; VAR jointtarget jHere;
PROC main( )
ActUnit STN1; ConfL\\Off;ConfJ\\Off;
MoveAbsJ [[0,-10,20,0,60,0],[9E9,0,0,9E9,9E9,9E9]]\\NoEOffs,v500,fine,tTorch;
MoveJ [[60,-40,150],[0,0.707107,0.707107,0],[0,0,0,0],[9E+09,15,-90,9E+09,9E+09,9E+09]],
  v300,fine,tTorch\\WObj:=wPlate;
MoveL [[60, 40,150],[0,0.707107,0.707107,0],[0,0,0,0],[9E+09,15,-60,9E+09,9E+09,9E+09]],
  v50,z1,tTorch\\WObj:=wPlate;
here:=CRobT(\\Tool:=tTorch\\WObj:=wPlate); jHere:=CJointT();
IF here.extax.eax_a<9E8 OR jHere.extax.eax_a<9E8 THEN Stop; MoveAbsJ jMissing,v100,fine,tool0; ENDIF
IF Abs(here.extax.eax_c+60)>0.01 Abs_wrong;
IF Abs(jHere.extax.eax_b-15)>0.01 Abs_wrong;
here.trans.z:=here.trans.z+50;here.extax.eax_c:=jHere.extax.eax_c-15;
MoveL here,v300,fine,tTorch\\WObj:=wPlate;
ENDPROC
ENDMODULE
"""


def cell(tmp_path: Path, text: str = CELL) -> Cell:
    path = tmp_path / "table.cell.toml"
    path.write_text(text)
    return load_cell(path, installed())


def described(tmp_path: Path, text: str = TEXT, said: str = CELL) -> Program:
    return flyby.read(text, robot=cell(tmp_path, said).robot)


NAMED = CELL.replace("number = 2\n", "").replace(".tilt]", ".eax_b]").replace('"tilt"', '"eax_b"')


@pytest.mark.parametrize("said", [CELL, NAMED], ids=["numbered", "named"])
def test_axes_behind_a_place_that_is_none(tmp_path: Path, said: str) -> None:
    program = described(tmp_path, said=said)
    degrees = [[round(math.degrees(v)) for v in move.target.external] for move in program.moves]
    assert degrees == [[0, 0], [15, -90], [15, -60], [15, -75]]
    assert not [note for note in program.notes if "eax_" in note.message]


def test_the_emulation_turns_the_axes(tmp_path: Path) -> None:
    program = described(tmp_path)
    run = flyby.emulate(program)
    ends = run.path.route.ends.q[-1, 1]
    assert [round(math.degrees(v)) for v in ends[6:]] == [15, -75]


def test_the_frame_of_a_unit_counts_and_not_the_one_in_the_data(tmp_path: Path) -> None:
    program = described(tmp_path)
    frame = program.moves[1].work_object
    assert (frame.moved_by, frame.user) == ("STN1", IDENTITY)
    assert frame.frame.position == pytest.approx((0, 0, 0.03))
    (note,) = [note for note in program.notes if "uframe of work object wPlate" in note.message]
    assert "STN1 moves it" in note.message
    zero = TEXT.replace("[[1611,-7,502]", "[[0,0,0]")
    assert not [one for one in described(tmp_path, zero).notes if "uframe" in one.message]


def test_a_user_frame_on_a_unit_is_written_as_part_of_the_object_frame(tmp_path: Path) -> None:
    program = described(tmp_path)
    frame = replace(program.moves[1].work_object, user=Pose((0.1, 0, 0)))
    moves = [replace(move, work_object=frame) for move in program.moves[1:3]]
    kinds = axis_kinds(cell(tmp_path).robot)
    assert kinds is not None
    text = write(Program(tuple(moves), "again"), RapidOptions(external_axes=kinds))
    assert '"STN1",[[0,0,0],[1,0,0,0]],[[100,0,30],[1,0,0,0]]' in text
    assert "[9E+09,15,-90,9E+09,9E+09,9E+09]" in text
    back = flyby.read(text, robot=cell(tmp_path).robot)
    assert [move.target.external for move in back.moves] == [m.target.external for m in moves]


def test_an_axis_without_a_value_before_one_that_has_one(tmp_path: Path) -> None:
    said = CELL.replace("number = 2\n", "")
    with pytest.raises(FlybyError, match=r"eax_a has no value \(9E9\), and eax_b behind") as e:
        flyby.emulate(described(tmp_path, said=said))
    assert "number = 2 is eax_b" in str(e.value)


def test_an_axis_at_a_place_that_is_none_must_stand(tmp_path: Path) -> None:
    text = TEXT.replace("[9E+09,15,-60", "[120,15,-60").replace("[9E+09,15,-90", "[100,15,-90")
    fault, *_ = flyby.emulate(described(tmp_path, text)).faults
    assert "eax_a is moved from 100 to 120, and the robot has eax_b, eax_c only" in str(fault)


def test_places_rise(tmp_path: Path) -> None:
    wrong = CELL.replace('carried_by = "tilt"', 'carried_by = "tilt"\nnumber = 1')
    with pytest.raises(InputError, match="STN1 is eax_a of targets, or behind it"):
        axis_kinds(cell(tmp_path, wrong).robot)
    with pytest.raises(InputError, match="has the number 7: RAPID has six"):
        axis_kinds(cell(tmp_path, CELL.replace("number = 2", "number = 7")).robot)


def test_numbers_stand_in_cell_files(tmp_path: Path) -> None:
    first = cell(tmp_path)
    path = tmp_path / "again.cell.toml"
    path.write_text(cell_text(first.robot, first.robot.name, {}, {}))
    assert load_cell(path, installed()).robot.external_axes == first.robot.external_axes
    for wrong in ("0", "1.5"):
        with pytest.raises(InputError, match=r"tilt\.number"):
            cell(tmp_path, CELL.replace("number = 2", f"number = {wrong}"))


def test_the_recorder_logs_axes_that_are_there(tmp_path: Path) -> None:
    kinds = axis_kinds(cell(tmp_path).robot)
    assert kinds == ("none", "rotating", "rotating")
    options = RapidOptions(external_axes=kinds)
    logged = "".join(_line_routine(options))
    assert len(_columns(options)) == 8
    assert "eax_a" not in logged and "eax_b*pi/180" in logged and "eax_c*pi/180" in logged


HELD = """MODULE partner
TASK PERS wobjdata wInHand:=[FALSE,FALSE,"{unit}",[[0,0,0],[1,0,0,0]],[[0,0,40],[1,0,0,0]]];
PROC main()
MoveAbsJ [[0,-10,20,0,60,0],[9E9,9E9,9E9,9E9,9E9,9E9]],v500,fine,tool0;
MoveJ [[5000,0,90],[0,0,1,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]],v500,fine,tool0\\WObj:=wInHand;
ENDPROC
ENDMODULE
"""


@pytest.mark.parametrize(
    ("unit", "told"),
    [
        ("ROB_2", "another robot, by its name"),
        ("DREH1", "if tilt or STN1 carries it, call that axis so in the cell file"),
    ],
)
def test_a_frame_that_something_else_moves_is_said_where_a_target_is_out_of_reach(
    tmp_path: Path, unit: str, told: str
) -> None:
    program = described(tmp_path, HELD.replace("{unit}", unit))
    (note,) = [note.message for note in program.notes if "wInHand" in note.message]
    assert told in note and ("[external_axis." in note) is False
    with pytest.raises(FlybyError) as caught:
        flyby.emulate(program)
    said = str(caught.value)
    assert f"wInHand is taken to stand where it is declared, though {unit} moves it" in said
    assert "of the catalogue" not in said  # of an arm at a table nobody can say
