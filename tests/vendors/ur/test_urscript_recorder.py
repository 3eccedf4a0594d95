"""Recorders: the program is driven while a thread sends time and joints to a computer."""

import math
import re
from pathlib import Path

import pytest

from flyby.core.errors import InputError
from flyby.core.program.move import MoveJ, MoveL, Opaque, Wait
from flyby.core.program.program import Program
from flyby.core.program.speed import Speed
from flyby.core.program.target import JointTarget, PoseTarget
from flyby.core.program.tool import Load, Tool
from flyby.core.program.zone import Radius
from flyby.core.recording import Recording
from flyby.core.registry import find_vendor
from flyby.core.source.patch.edits import difference
from flyby.core.spatial.pose import Pose
from flyby.vendors.ur.record import record
from flyby.vendors.ur.run.reader import read

UR = find_vendor("ur")
UR5E, UR5 = UR.robot("ur5e"), UR.robot("ur5")
TOOL = Tool("gun", Pose((0.0, 0.0, 0.1)), Load(1.5, (0.0, 0.0, 0.05)))
READY = JointTarget((0.1, -1.5, 1.5, -1.5, -1.5, 0.0), name="flyby_q")
OVER = PoseTarget(Pose((-0.5, -0.1, 0.4), (0.0, 0.7071067811865476, 0.7071067811865476, 0.0)))
JOB = Program(
    (
        MoveJ(READY, Speed(joint=1.0, joint_acceleration=1.5), Radius(0.01, 0.01, 0.01), TOOL),
        Opaque("set_digital_out(1, True)"),
        MoveL(OVER, Speed(tcp=0.25, tcp_acceleration=1.2), tool=TOOL),
        Wait(0.5),
    ),
    "job",
)


def lines(period: float = 0.008, program: Program = JOB) -> list[str]:
    (text,) = record(Recording.of(program), UR5E, period).values()
    return [line.strip() for line in text.splitlines()]


def test_what_is_recorded_drives_the_same_moves(tmp_path: Path) -> None:
    ((name, text),) = record(Recording.of(JOB), UR5E, 0.008).items()
    assert name == "job.script" and text.isascii()
    path = tmp_path / name
    path.write_text(text, "utf-8")
    again = UR.read_file(path, robot=UR5E)
    assert difference(Program(JOB.moves), Program(again.moves)) is None
    assert not [note for note in again.notes if "refused" in str(note)]


def test_sampling_begins_before_the_first_and_ends_after_the_last_motion() -> None:
    text = lines()
    begin, end = text.index("flyby_thread = run flyby_recorder()"), text.index("join flyby_thread")
    moves = [k for k, line in enumerate(text) if line.startswith(("movej(", "movel("))]
    assert begin < moves[0] and moves[-1] < end
    assert text[end - 1] == "flyby_logging = False" and text[end - 2] == "sleep(0.5)"


def test_the_log_is_one_that_is_read_back() -> None:
    text = "\n".join(lines())
    assert 'socket_send_line("t,q1,q2,q3,q4,q5,q6", "flyby_log")' in text
    assert text.index("t,q1,q2") < text.index("flyby_thread = run")


def test_a_sample_is_time_and_joints_with_commas() -> None:
    """The statements that make a line of the log, carried out by the reader."""
    text = lines()
    first = next(k for k, line in enumerate(text) if line.startswith("flyby_line = to_str("))
    last = text.index('socket_send_line(flyby_line, "flyby_log")')
    made = "\n".join(["flyby_count = 4", "flyby_q = [0.5,-1.5,2.5,0,1,2]", *text[first:last]])
    check = 'if flyby_line == "0.008,0.5,-1.5,2.5,0,1,2":\nmovej([1,0,0,0,0,0])\nend'
    assert len(read(f"{made}\n{check}", "line.script").moves) == 1


@pytest.mark.parametrize(
    ("robot", "period", "cycles", "cycle"),
    [(UR5E, 0.002, 1, "0.002"), (UR5E, 0.1, 50, "0.002"), (UR5, 0.008, 1, "0.008")],
    ids=["e-Series", "slower", "CB3"],
)
def test_the_period_is_counted_in_cycles_of_the_controller(
    robot: object, period: float, cycles: int, cycle: str
) -> None:
    (text,) = record(Recording.of(JOB), robot, period).values()  # type: ignore[arg-type]
    assert f"global flyby_cycles = {cycles}\n" in text
    assert f"to_str(flyby_count * {cycle})" in text
    assert "while flyby_k < flyby_cycles:\n        sync()" in text


@pytest.mark.parametrize("period", [0.0, -0.002, 0.003, 0.001, math.nan, math.inf, 1e-9])
def test_other_periods_are_refused(period: float) -> None:
    with pytest.raises(InputError, match=r"ur5e runs in cycles of 0\.002 s"):
        record(Recording.of(JOB), UR5E, period)
    with pytest.raises(InputError, match=r"ur5 runs in cycles of 0\.008 s"):
        record(Recording.of(JOB), UR5, 0.004)


def test_names_of_the_program_give_way_to_those_of_the_recorder() -> None:
    text = lines(program=Program(JOB.statements, "flyby_recorder"))
    assert "def flyby_recorder_2():" in text
    assert "global flyby_q_2 = [0.1, -1.5, 1.5, -1.5, -1.5, 0]" in text
    defined = [line for line in text if re.match(r"(def|thread) ", line)]
    assert len({re.split(r"[ (]", line)[1] for line in defined}) == len(defined)


def test_statements_that_do_not_move_the_robot_become_comments() -> None:
    text = (
        "def job():\n"
        "  steps = 0\n"
        "  thread Step_Counter():\n    while True:\n      steps = steps + 1\n      sync()\n"
        "    end\n  end\n"
        "  run Step_Counter()\n"  # as PolyScope exports every program
        "  movej([0, -1.5, 1.5, 0, 0, 0])\n"
        "  set_digital_out(0, True)\n"
        "end\njob()\n"
    )
    written = lines(program=read(text, "own.script"))
    assert "# run Step_Counter()" in written and "# set_digital_out(0, True)" in written
    assert not [line for line in written if line.startswith(("run ", "set_digital_out("))]
