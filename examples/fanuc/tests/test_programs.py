"""Texts as controllers write them: what they drive, and what becomes of them when it changes."""

from __future__ import annotations

import math
import re
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from flyby_fanuc.plugin import fanuc
from flyby_fanuc.words import CNT, CR
from hypothesis import given
from hypothesis import strategies as st

from flyby.core.cell.floor import bare_cell
from flyby.core.collision.scene.scene import CollisionScene
from flyby.core.errors import FlybyError, SourceError
from flyby.core.motion.emulator.controller import Controller
from flyby.core.program.move import MoveC, MoveJ, MoveL, Opaque, Wait
from flyby.core.program.program import Program
from flyby.core.program.speed import Speed
from flyby.core.program.target import PoseTarget
from flyby.core.program.tool import Tool
from flyby.core.program.zone import FINE, VendorZone
from flyby.core.recording import RecordedRun, Recording
from flyby.core.registry import find_robot, find_vendor
from flyby.core.robot.shape import Capsule
from flyby.core.source.execution.answers import Answers
from flyby.core.source.lines.postures import PostureLabel
from flyby.core.spatial.pose import Pose
from flyby.core.translation.hand_out import check_driven
from flyby.core.translation.translate import translate

FANUC = fanuc()
LR_MATE = FANUC.robot("lr-mate-200id")
PICK = Path(__file__).with_name("pick.ls").read_text()
FRAMES = """\
[*SYSTEM*]$MNUTOOL  Storage: SHADOW  Access: RW  : ARRAY[8,10] OF Position
     [1,1] =
  Group: 1   Config: N D B, 0, 0, 0
  X:      0.000   Y:     0.000   Z:   100.000
  W:     0.000   P:     0.000   R:     0.000
"""
GRIP = "/PROG GRIP\n/MN\n1: DO[1]=ON;\n2: WAIT .50(sec);\n/END\n"
ANSWERS = Answers(
    values={"r[9]": 200.0, **{f"pr[2,{k}]": 50.0 if k == 3 else 0.0 for k in range(1, 7)}}
)


@pytest.fixture
def backup(tmp_path: Path) -> Path:
    """A program, one that it calls, and the frames of the controller."""
    (tmp_path / "PICK.LS").write_text(PICK)
    (tmp_path / "grip.ls").write_text(GRIP)
    (tmp_path / "FRAMEVAR.VA").write_text(FRAMES)
    return tmp_path


def read(backup: Path) -> Program:
    return FANUC.read_file(backup / "PICK.LS", answers=ANSWERS)


def text(*lines: str, positions: str = "") -> str:
    numbered = "".join(f"{k + 1:>4}:{line} ;\n" for k, line in enumerate(lines))
    return f"/PROG  JOB\n/ATTR\nOWNER = MNEDITOR;\n/MN\n{numbered}/POS\n{positions}/END\n"


def pose(number: int, x: float, z: float = 100.0, frames: str = "UF : 0, UT : 0") -> str:
    return (
        f"P[{number}]{{\n   GP1:\n\t{frames},\t\tCONFIG : 'N U T, 0, 0, 0',\n"
        f"\tX = {x:9.3f}  mm,\tY =      .000  mm,\tZ = {z:9.3f}  mm,\n"
        "\tW =   180.000 deg,\tP =     0.000 deg,\tR =     0.000 deg\n};\n"
    )


def test_a_program_of_a_backup_is_read(backup: Path) -> None:
    program = read(backup)
    moves = program.moves
    assert len(moves) == 11
    assert isinstance(moves[0], MoveJ) and moves[0].speed == Speed(joint_fraction=0.5)
    assert moves[0].target.joints[1] == pytest.approx(math.radians(10))
    assert moves[1].speed == Speed(tcp=0.25, acceleration_override=0.8)
    assert moves[1].zone == VendorZone(CNT, 0.5)
    assert moves[1].tool.tcp.position == (0.0, 0.0, 0.1)
    assert moves[1].target.configuration == PostureLabel("NUT", (0, 0, 0))
    assert moves[2].target.pose.position == pytest.approx((0.4, 0.0, 0.15))
    assert isinstance(moves[3], MoveC) and moves[3].via.pose.position[0] == pytest.approx(0.42)
    (event,) = moves[3].events
    assert (event.text, event.time) == ("DO[1]=ON", 0.2)
    assert moves[8].events[0].distance == pytest.approx(0.05)
    kept = [s.text for s in program.statements if isinstance(s, Opaque)]
    assert kept == ["DO[1]=ON", "DO[2]=OFF", "WAIT DI[1]=ON TIMEOUT,LBL[7]", "PAYLOAD[2]"]
    assert 3.0 < Controller(FANUC, LR_MATE).run(program).duration < 10.0


def test_frames_that_nobody_knows_are_asked_for_at_the_line_that_uses_them() -> None:
    job = text("UTOOL_NUM=2", "J P[1] 100% FINE", positions=pose(1, 400, frames="UF : 3, UT : 2"))
    line = job[: job.index("J P[1]")].count("\n") + 1
    asked = FANUC.read(job, "a.ls", answers=Answers(goes_on=True)).questions
    assert [(one.key, one.span.line) for one in asked] == [("UTOOL[2,1]", line)]
    known = {f"{word},{k}]": 0.0 for word in ("UTOOL[2", "UFRAME[3") for k in range(1, 7)}
    lowered = Answers({key.lower(): value for key, value in known.items()})
    asked = FANUC.read(job, "a.ls", answers=lowered).questions
    assert {one.key: one.span.line for one in asked} == dict.fromkeys(known, line)


@pytest.mark.parametrize("name", sorted(fanuc().robots))
def test_an_arm_stands_on_the_plane_that_it_is_mounted_on(name: str) -> None:
    """Z counts from the second axis; the base's own shape ends at the plane."""
    robot = fanuc().robot(name)
    foot = next(one for one in robot.shapes if one.link == 0)
    assert isinstance(foot.shape, Capsule)
    middle = foot.placement.matrix()
    ends = middle[2, 3] - abs(middle[2, 2]) * 0.5 * foot.shape.length - foot.shape.radius
    assert ends == pytest.approx(-robot.base_height, abs=1e-6)
    up = np.zeros(robot.size)
    cell = bare_cell(robot, "fanuc", [Tool("tip", Pose((0.0, 0.0, 0.1)))])
    scene = CollisionScene(cell, cell.tools["tip"])
    assert (scene.distances(up[None]).distance > 0.0).all()


def test_j3_is_counted_from_the_horizontal() -> None:
    """J2 alone leaves the forearm's direction as it was."""
    at = [LR_MATE.flange_pose(np.array([0, q, 0, 0, 0.0, 0])) for q in (0.0, 0.5)]
    assert at[0].quaternion == pytest.approx(at[1].quaternion)
    assert at[0].position == pytest.approx((0.465, 0.0, 0.365))


@pytest.mark.parametrize(
    ("option", "goes"),
    [
        ("", (0.4, 0.0, 0.1)),
        ("Offset,PR[1]", (0.41, 0.02, 0.13)),
        ("Tool_Offset,PR[1]", (0.41, -0.02, 0.07)),
    ],
)
def test_offsets_are_of_frame_or_tool(option: str, goes: tuple[float, ...]) -> None:
    lines = [f"PR[1,{k}]={v}" for k, v in enumerate((10, 20, 30, 0, 0, 0), 1)]
    job = text(*lines, f"L P[1] 100mm/sec FINE {option}", positions=pose(1, 400))
    (move,) = FANUC.read(job, "job.ls").moves
    assert move.target.pose.position == pytest.approx(goes)


def test_increments_count_from_the_position_before() -> None:
    inc = pose(2, 10, -20).replace("W =   180.000", "W =     0.000")
    job = text("L P[1] 100mm/sec FINE", "L P[2] 100mm/sec FINE INC", positions=pose(1, 400) + inc)
    moves = FANUC.read(job, "job.ls").moves
    assert moves[1].target.pose.position == pytest.approx((0.41, 0.0, 0.08))


def test_a_position_register_is_patched_where_its_number_stands() -> None:
    lines = ["PR[1]=P[1]", "PR[1,3]=150", "L PR[1] 100mm/sec CNT50"]
    job = text(*lines, "L P[2] 100mm/sec FINE", positions=pose(1, 400) + pose(2, 420))
    program = FANUC.read(job, "job.ls")
    first, second = program.moves
    x, y, _ = first.target.pose.position
    moved = replace(first.target, pose=replace(first.target.pose, position=(x, y, 0.16)))
    changed = program.with_moves((replace(first, target=moved), second))
    (file,) = FANUC.patch(changed, LR_MATE).values()
    assert file.text == job.replace("PR[1,3]=150", "PR[1,3]=160")


@pytest.mark.parametrize(
    ("old", "zone", "new"),
    [
        ("CNT50", VendorZone(CNT, 0.72), "CNT72"),
        ("CNT50", FINE, "FINE"),
        ("FINE", VendorZone(CNT, 0.3), "CNT30"),
        ("CNT50", VendorZone(CR, 0.005, 2.0), "CR5,10"),
        ("CR5,10", VendorZone(CR, 0.006, 2.0), "CR6,12"),
    ],
)
def test_a_zone_is_patched_in_place(old: str, zone: VendorZone, new: str) -> None:
    job = text(
        f"L P[1] 100mm/sec {old} ACC80",
        "L P[2] 100mm/sec FINE",
        positions=pose(1, 400) + pose(2, 420),
    )
    program = FANUC.read(job, "job.ls")
    first, second = program.moves
    changed = program.with_moves((replace(first, zone=zone), second))
    (file,) = FANUC.patch(changed, LR_MATE).values()
    assert file.text == job.replace(f"100mm/sec {old} ACC", f"100mm/sec {new} ACC")


def test_speeds_are_patched_below_the_override_and_in_their_own_unit() -> None:
    lines = ["OVERRIDE=50%", "R[1]=400", "L P[1] R[1]mm/sec FINE", "L P[2] 600cm/min FINE"]
    job = text(*lines, positions=pose(1, 400) + pose(2, 420))
    program = FANUC.read(job, "job.ls")
    assert [move.speed.tcp for move in program.moves] == pytest.approx([0.2, 0.05])
    slower = (replace(m, speed=replace(m.speed, tcp=0.5 * m.speed.tcp)) for m in program.moves)
    (file,) = FANUC.patch(program.with_moves(tuple(slower)), LR_MATE).values()
    assert file.text == job.replace("R[1]=400", "R[1]=200").replace("600cm", "300cm")


def test_a_position_keeps_its_decimals() -> None:
    job = text("L P[1] 100mm/sec FINE", positions=pose(1, 450.04))
    program = FANUC.read(job, "job.ls")
    (move,) = program.moves
    moved = replace(move.target, pose=replace(move.target.pose, position=(0.46504, 0.0, 0.0)))
    (file,) = FANUC.patch(program.with_moves((replace(move, target=moved),)), LR_MATE).values()
    assert file.text == job.replace("450.040", "465.040").replace("100.000", "0.000")


def test_what_an_offset_makes_is_no_number_of_the_text() -> None:
    lines = [f"PR[1,{k}]=0" for k in range(1, 7)]
    job = text(*lines, "L P[1] 100mm/sec FINE Offset,PR[1]", positions=pose(1, 400))
    program = FANUC.read(job, "job.ls")
    (move,) = program.moves
    moved = replace(
        move,
        target=PoseTarget(
            replace(move.target.pose, position=(0.4, 0.1, 0.1)), move.target.configuration
        ),
    )
    with pytest.raises(FlybyError, match="the program computes it"):
        FANUC.patch(program.with_moves((moved,)), LR_MATE)


@pytest.mark.parametrize("closing", [[], ["PR[1,1]=0"]])
def test_what_a_branch_sets_that_nobody_decides_is_supposed(closing: list[str]) -> None:
    lines = [f"PR[1,{k}]=0" for k in range(1, 7)]
    lines += ["IF (DI[1]=ON) THEN", "PR[1,1]=10", "ENDIF", *closing]
    lines += ["L P[1] 100mm/sec FINE Offset,PR[1]", "L P[1] 100mm/sec FINE"]
    offset, plain = FANUC.read(text(*lines, positions=pose(1, 400)), "job.ls").moves
    assert bool(offset.supposed) != bool(closing)
    assert "DI[1]" in offset.supposed or closing
    assert not plain.supposed


@pytest.mark.parametrize(
    ("line", "said"),
    [
        ("L P[1] 100mm/sec FINE VOFFSET,VR[1]", r"job\.ls:5:6: .*the option 'VOFFSET.*not known"),
        ("L P[7] 100mm/sec FINE", r"unknown point 'P\[7\]'"),
        ("L P[1] 100 FINE", "this form of a motion is not known"),
        ("JMP LBL[3]", "there is no label 3"),
        ("CALL WELD", r"unknown routine 'WELD'.*skip"),
        ("ENDFOR", "no block is open here"),
        ("IF R[1]=1 THEN", "has no end"),
        ("L P[2] 100mm/sec FINE", r"UTOOL\[3\] is not known: put framevar.va"),
    ],
)
def test_an_error_says_where_and_what_to_do(line: str, said: str) -> None:
    job = text(line, positions=pose(1, 400) + pose(2, 400, frames="UF : 0, UT : 3"))
    with pytest.raises(SourceError, match=said):
        FANUC.read(job, "job.ls")


SEAM = Path(__file__).parents[2] / "seam.src"


def test_a_krl_program_becomes_one_of_tp_and_is_driven_alike() -> None:
    kuka, robot = find_vendor("kuka"), find_robot("kuka/kr30-3")
    program, other = kuka.read_file(SEAM, robot=robot), FANUC.robot("r-2000ic-165f")
    made = translate(program, (kuka, robot), (FANUC, other))
    sources = FANUC.write(made.program, other, {"opaque": "comment"})
    check_driven(made, sources, FANUC, other)
    (listing,) = sources.values()
    assert "L P[5] 300mm/sec FINE ACC17 ;" in listing and "!$OUT[4]=TRUE ;" in listing
    times = (
        Controller(kuka, robot).run(program).duration,
        Controller(FANUC, other).run(made.program).duration,
    )
    assert times[1] == pytest.approx(times[0], rel=0.1)


def test_a_tp_program_becomes_one_of_rapid(backup: Path) -> None:
    abb, other = find_vendor("abb"), find_robot("abb/irb1200-7-070")
    made = translate(read(backup), (FANUC, LR_MATE), (abb, other))
    sources = abb.write(made.program, other, {"opaque": "comment"})
    check_driven(made, sources, abb, other)
    assert any("CirPathMode \\ObjectFrame" in source for source in sources.values())
    assert any("commented" in n.message or "comment" in n.message for n in made.losses)


@given(first=st.integers(-3, 3), last=st.integers(-3, 3), down=st.booleans())
def test_a_loop_counts_as_its_ends_say(first: int, last: int, down: bool) -> None:
    way = "DOWNTO" if down else "TO"
    lines = [f"FOR R[1]={first} {way} {last}", "WAIT R[1]", "ENDFOR", "L P[1] 100mm/sec FINE"]
    program = FANUC.read(text(*lines, positions=pose(1, 400)), "job.ls")
    passes = range(first, last - 1, -1) if down else range(first, last + 1)
    waits = [s.duration for s in program.statements if isinstance(s, Wait)]
    assert waits == [max(0.0, k) for k in passes]


@pytest.mark.parametrize("chosen", [1, 2, 3])
def test_one_case_of_a_selection_is_done(chosen: int) -> None:
    cases = ["SELECT R[1]=1,CALL ONE", "       =2,CALL TWO", "       ELSE,CALL OTHER"]
    routines = "".join(
        f"/PROG {name}\n/MN\n1: R[1]=R[1]+1;\n2: WAIT {k}(sec);\n/END\n"
        for k, name in enumerate(("ONE", "TWO", "OTHER"), 1)
    )
    job = text(f"R[1]={chosen}", *cases, "L P[1] 100mm/sec FINE", positions=pose(1, 400))
    program = FANUC.read(job + routines, "job.ls", entry="job")
    assert [s.duration for s in program.statements if isinstance(s, Wait)] == [chosen]


def test_arcs_by_a_go_through_every_second_position() -> None:
    lines = [f"A P[{k}] 100mm/sec CNT100" for k in (1, 2, 3, 4, 5)]
    places = "".join(
        pose(k, x).replace("Y =      .000", f"Y = {y:9.3f}")
        for k, (x, y) in enumerate([(400, 0), (420, 20), (400, 40), (380, 60), (400, 80)], 1)
    )
    moves = FANUC.read(text(*lines, positions=places), "job.ls").moves
    assert [type(m) for m in moves] == [MoveL, MoveC, MoveC]
    assert moves[2].via.pose.position == pytest.approx((0.38, 0.06, 0.1))
    with pytest.raises(SourceError, match="the arc before has no end"):
        FANUC.read(text(*lines[:2], "L P[3] 9mm/sec FINE", positions=places), "job.ls")


def test_several_runs_are_called_and_each_has_its_log(tmp_path: Path) -> None:
    runs = [FANUC.read(text(f"J P[1] {k}0% FINE", positions=pose(1, 400)), "a.ls") for k in (1, 2)]
    recorded = (RecordedRun(runs[0], "one.csv"), RecordedRun(runs[1], "two.csv", by_hand=True))
    recording = Recording("both", recorded)
    sources = FANUC.recorder.record(recording, LR_MATE, FANUC.recorder.usual_period(LR_MATE))
    for file, said in sources.items():
        (tmp_path / file).write_text(said)
    assert list(sources) == ["BOTH.ls", "RUN01.ls", "RUN02.ls", "flyby_log.kl"]
    again = FANUC.read_file(tmp_path / "BOTH.ls")
    assert [move.speed.joint_fraction for move in again.moves] == pytest.approx([0.1, 0.2])
    called = re.findall(r"CALL \w+|PAUSE", sources["BOTH.ls"])
    assert called == ["CALL RUN01", "PAUSE", "CALL RUN02"]
    assert "CASE (2): OPEN FILE log_file ('RW', 'UD1:two.csv')" in sources["flyby_log.kl"]
    assert "R[100]=2" in sources["RUN02.ls"]
    assert any("run 2 it pauses" in step for step in FANUC.recorder.steps(recording, 0.024))
