"""What KRL programs ask of files that are not at hand, and how it is answered."""

from __future__ import annotations

from pathlib import Path

import pytest

from flyby.core.driving.past_faults import drive
from flyby.core.motion.emulator.controller import Controller
from flyby.core.program.program import Program
from flyby.core.program.target import PoseTarget
from flyby.core.registry import find_robot, find_vendor
from flyby.core.source.execution.answers import Answers
from flyby.core.source.execution.answers_file import load_answers

KR30 = find_robot("kuka/kr30-3")
VENDOR = find_vendor("kuka")
START = "PTP {A1 0,A2 -90,A3 100,A4 0,A5 60,A6 0}\n"


def read(body: str, folder: Path, values: str = "") -> Program:
    answers = folder / "answers.toml"
    answers.write_text(f"[values]\n{values}\n", "utf-8")
    told = load_answers(answers)
    open_ended = Answers(values=told.values, goes_on=True, file=told.file)
    return VENDOR.read(f"DEF m()\n{body}END\n", "m.src", robot=KR30, answers=open_ended)


def said(program: Program) -> str:
    return " ".join(note.message for note in program.notes)


def test_tools_and_bases_that_no_file_says_are_asked_for(tmp_path: Path) -> None:
    body = "BAS(#TOOL,3)\n$BASE=BASE_DATA[2]\n" + START + "PTP {X 900,Y 0,Z 300,A 0,B 90,C 0}\n"
    program = read(body, tmp_path)
    assert {"TOOL_DATA[3]", "BASE_DATA[2]"} <= {question.key for question in program.questions}
    assert '[values] "BASE_DATA[2]" = …' in said(program)
    told = '"BASE_DATA[2]" = "{X 100,Y 0,Z 400}"\n"TOOL_DATA[3]" = { Z = 50 }'
    answered = read(body, tmp_path, told)
    assert "no $config.dat" not in said(answered)
    move = answered.moves[-1]
    assert move.work_object.pose.position == pytest.approx((0.1, 0.0, 0.4))
    assert move.tool.tcp.position == pytest.approx((0.0, 0.0, 0.05))


def test_faults_of_places_name_the_base_that_is_not_known(tmp_path: Path) -> None:
    body = "BAS(#TOOL,0)\n$BASE=BASE_DATA[2]\n" + START + START.replace("A1 0", "A1 9")
    program = read(body + "PTP {X 90,Y 0,Z 30,A 0,B 90,C 0}\n", tmp_path)
    (fault,) = drive(Controller(VENDOR, KR30), program).faults
    assert "BASE_DATA[2] is not known, and may well be why" in fault.message
    told = read(
        body + "PTP {X 9000,Y 0,Z 30,A 0,B 90,C 0}\n", tmp_path, '"BASE_DATA[2]" = "{X 1,Y 0}"'
    )
    (fault,) = drive(Controller(VENDOR, KR30), told).faults
    assert "may well be why" not in fault.message


def test_homes_are_kukas_own_with_a_note_or_answered(tmp_path: Path) -> None:
    program = read("PTP XHOME\n", tmp_path)
    assert "KUKA's own is taken (A1 0, A2 -90, A3 90" in said(program)
    answered = read("PTP XHOME\n", tmp_path, 'XHOME = "{A1 10,A2 -80,A3 70,A4 0,A5 20,A6 0}"')
    assert "KUKA's own" not in said(answered)
    assert answered.moves[0].target.joints[0] == pytest.approx(0.17453, abs=1e-4)


def test_components_that_routines_give_are_not_known(tmp_path: Path) -> None:
    body = (
        "DECL E6POS p\n" + START + 'r=EKI_GetReal("cam","Pos/X",p.X)\n'
        "p.Y=0\np.Z=900\np.A=0\np.B=90\np.C=0\nLIN p\np.Z=p.Z+50\nLIN p\n"
    )
    program = read(body, tmp_path)
    assert [bool(move.open) for move in program.moves] == [False, True, True]
    assert '[values] "p.X" = …' in program.moves[1].open
    answered = read(body, tmp_path, '"p.X" = 1000')
    target = answered.moves[-1].target
    assert isinstance(target, PoseTarget) and not any(move.open for move in answered.moves)
    assert target.pose.position == pytest.approx((1.0, 0.0, 0.95))


def test_a_position_of_which_a_part_is_written_is_not_known_in_the_others(tmp_path: Path) -> None:
    body = "DECL FRAME p\n" + START + 'r=EKI_GetFrame("cam","Pos",p)\np.Z=p.Z+50\nLIN p\n'
    assert "what EKI_GetFrame gave p" in read(body, tmp_path).moves[-1].open


def test_a_search_finds_at_its_end_what_its_interrupt_puts_down(tmp_path: Path) -> None:
    body = (
        "INTERRUPT DECL 9 WHEN $IN[4]==TRUE DO hit()\n" + START + "INTERRUPT ON 9\n"
        "LIN_REL {Z -100}\nINTERRUPT OFF 9\nf=at\nf.Z=f.Z+30\nLIN f\nEND\nDEF hit()\nBRAKE\n"
        "at=$POS_INT\nRESUME\n"
    )
    program = read(body, tmp_path)
    assert not any(move.open for move in program.moves)
    before, after = (move.target.pose.position for move in program.moves[1:])
    assert after[2] - before[2] == pytest.approx(0.03)


@pytest.mark.parametrize("rest", ["", " Vel=0.3 m/s"])
def test_closed_folds_of_arcs_and_waits(tmp_path: Path, rest: str) -> None:
    body = (
        f"{START}WAIT FOR ( IN 4 'Teil da' )\nARCON WDAT1 LIN P1{rest} CPDAT1 Tool[1] Base[0]\n"
        f"ARCOFF WDAT2 LIN P2{rest} CPDAT2 Tool[1] Base[0]\n"
    )
    points = 'XP1 = "{X 1000,Y 0,Z 900,A 0,B 90,C 0}"\nXP2 = "{X 1000,Y 90,Z 900,A 0,B 90,C 0}"'
    program = read(body, tmp_path, points)
    assert len(program.moves) == 3
    speed = program.moves[1].speed.tcp
    assert (speed == pytest.approx(0.3)) is bool(rest)
