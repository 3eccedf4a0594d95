"""Scripts whose data, devices or last lines are not all there: driven as far as they can be."""

from __future__ import annotations

import re

import pytest

import flyby
from flyby.core.driving.past_faults import drive
from flyby.core.errors import LeftOpenError, MotionError, SourceError
from flyby.core.motion.emulator.controller import Controller
from flyby.core.program.move import Opaque
from flyby.core.program.program import Program
from flyby.core.registry import find_robot, find_vendor
from flyby.core.source.execution.answers import Answers
from flyby.core.source.reading import ReadOptions
from flyby.vendors.ur.language import UrScript
from flyby.vendors.ur.run.reader import read

HOME = "movej([0,-1.57,1.57,-1.57,-1.57,0])\n"
POSE = "p[-0.45,0.1,%s,2.2214,2.2214,0]"


def script(text: str) -> Program:
    return read(text, "t.script", ReadOptions())


def said(program: Program) -> str:
    return " ".join(note.message for note in program.notes)


def heights(program: Program) -> list[float]:
    return [round(move.target.pose.position[2], 6) for move in program.moves[1:]]  # type: ignore[union-attr]


@pytest.mark.parametrize(
    ("text", "height"),
    [
        (f"h = 0.3 + get_standard_analog_in(0) * 0.01\nmovel({POSE % 'h'})", 0.3),
        (f"h = 0.3 - cam.height()\nmovel({POSE % 'h'})", 0.3),
        (f"off = cam.offset()\nmovel(pose_trans({POSE % 0.3}, off))", 0.3),
        (f"r = cam.xy()\nmovel(pose_trans({POSE % 0.3}, p[r[0], r[1], 0, 0, 0, r[2]]))", 0.3),
        (f"movel(pose_add({POSE % 0.3}, cam.shift()))", 0.3),
        (f"a = {POSE % 0.3}\na[2] = a[2] + read_input_float_register(3)\nmovel(a)", 0.3),
        (f"movel({POSE % 0.3}, a=1.2, v=speed_slow)", 0.3),
        (f"set_tcp(vision_tcp)\nmovel({POSE % 0.3})", 0.3),
    ],
)
def test_what_others_add_to_a_target_counts_as_nothing(text: str, height: float) -> None:
    program = script(HOME + 'cam = rpc_factory("xmlrpc", "http://10.0.0.2")\n' + text)
    assert heights(program) == [height]
    assert "depends on" in said(program) and "[values]" in said(program)


@pytest.mark.parametrize(
    ("line", "says"),
    [
        ("row = lanes[7]", "7"),
        ("lanes[k + 3] = 0", "5"),
        ("row = 12 / (k - 2)", "division by zero"),
        ("x = sqrt(-k)", "sqrt"),
    ],
)
def test_an_error_of_the_controller_ends_the_program_behind_what_was_driven(
    line: str, says: str
) -> None:
    head = "lanes = [1, 2, 3]\nk = 2\n"
    text = f"{line}\nmovel({POSE % 0.3})\n"
    going = ReadOptions(answers=Answers(goes_on=True))
    program = read(head + HOME + text, "t.script", going)
    assert [bool(move.open) for move in program.moves] == [False, True]
    message = program.moves[-1].open
    assert message.endswith(": the controller stops the program here")
    assert says in message
    with pytest.raises(SourceError, match=r"t\.script:4:"):
        read(head + HOME + text, "t.script", ReadOptions())
    with pytest.raises(SourceError, match=r"t\.script:3:"):
        read(head + text, "t.script", going)


def test_a_move_to_what_nobody_knows_is_left_out() -> None:
    text = (
        f"movel({POSE % 0.3})\nmovel(cam_pose)\n"
        f"movel(pose_add(get_actual_tcp_pose(), p[0,0,0.1,0,0,0]))\nmovel({POSE % 0.4})"
    )
    program = script(HOME + text)
    assert heights(program) == [0.3, 0.4]
    kept = [s.text for s in program.statements if isinstance(s, Opaque)]
    assert kept[0] == "movel(cam_pose)" and len(kept) == 2
    assert "the motion is left out: the " in said(program)
    assert "after the move of line 3, which is left out" in said(program)


def test_a_script_of_which_all_is_missing_says_so() -> None:
    with pytest.raises(LeftOpenError, match="'home_q', which the program does not declare"):
        script("movej(home_q)\nmovej(start_q)")


def test_a_script_that_only_lacks_its_last_line() -> None:
    program = script(f"def cut():\n  {HOME}  movel({POSE % 0.3})\n")
    assert heights(program) == [0.3]
    assert "the file ends without the 'end' of 'def cut' in line 1" in said(program)


@pytest.mark.parametrize("name", ["MoveJ", "movej_", "Movel", "movelin"])
def test_moves_that_are_mistyped_are_not_stepped_over(name: str) -> None:
    with pytest.raises(Exception, match=f"nobody declares the function '{name}'"):
        script(f"{HOME}{name}([0,0,0,0,0,0])")


def test_a_script_in_a_text_file(tmp_path) -> None:
    file = tmp_path / "sent.txt"
    file.write_text(f"{HOME}movel({POSE % 0.3})\n")
    assert heights(UrScript().read_file(file, ReadOptions())) == [0.3]


ASKS = """def asks():
  set_tcp(my_tcp)
  n = socket_read_ascii_float(2, "cam")
  text = socket_read_string("cam")
  if ready_flag and count_of() > 3:
    textmsg(text)
  end
  pose = cam_pose()
  movel(pose, a=1.2, v=slow)
  movel(racks[0], a=1.2, v=speeds[1])
  movej(get_inverse_kin(above), a=1.4, v=1.05)
  if read_input_integer_register(3) == 1:
    movel(p[n[1], n[2], 0.3, 0, 3.14, 0], a=read_input_float_register(2))
  end
  bridge = rpc_factory("xmlrpc", "http://127.0.0.1:4321")
end
"""


def test_questions_say_what_an_answer_looks_like(tmp_path) -> None:
    file = tmp_path / "asks.script"
    file.write_text(ASKS)
    asked = {q.key: q for q in flyby.ask(file, robot="ur/ur5e") if q.table == "values"}
    pose, goal = "pose, m and rad", "pose (m and rad), or six joint values (rad)"
    assert {key: question.type for key, question in asked.items()} == {
        "my_tcp": pose,
        'socket_read_ascii_float(2, "cam")': "list: how many numbers have come, and the numbers",
        "ready_flag": "true or false",
        "count_of()": "number",
        'socket_read_string("cam")': "text",
        "cam_pose()": goal,
        "slow": "number",
        "racks": f"list of: {goal}",
        "speeds": "list of: number",
        "above": pose,
        "read_input_integer_register(3)": "whole number",
        "read_input_float_register(2)": "number",
    }
    assert asked['socket_read_ascii_float(2, "cam")'].example == (2.0, 0.0, 0.0)


def test_the_examples_of_all_questions_are_answers(tmp_path) -> None:
    """A file of which every # is taken away is read, and leaves nothing to ask for."""
    file, answers = tmp_path / "asks.script", tmp_path / "answers.toml"
    file.write_text(ASKS)
    asked = flyby.ask(file, robot="ur/ur5e").toml
    answers.write_text(re.sub(r"(?m)^#(?=[\"\w])", "", asked))
    again = flyby.ask(file, robot="ur/ur5e", answers=answers)
    assert all(q.answered for q in again if q.table == "values")


@pytest.mark.parametrize(
    ("used", "example", "type_"),
    [
        ("movel(p[c[0],c[1],0.3,0,3.14,c[5]])", "p[0, 0, 0, 0, 0, 0]", "pose (m and rad), or six"),
        ("x = c[5] + 1\n  movel(c)", "p[0, 0, 0, 0, 0, 0]", "pose (m and rad), or six joint"),
        ("x = c[3] + 1", (0.0,) * 4, "list of: number"),
        ("x = c[1000000] + 1", (0.0,) * 100, "list of: number"),
        ("d = c\n  x = d[2] + 1", (0.0,) * 3, "list of: number"),
        ("x = c[2][1] + 1", (((0.0,) * 2),) * 3, "list of: list of: number"),
    ],
)
def test_what_is_read_by_indices_has_as_many_elements(used, example, type_) -> None:
    text = f"def m():\n  {HOME}  c = cam.get()\n  {used}\n  {HOME}end\n"
    program = read(text, "t.script", ReadOptions(answers=Answers(goes_on=True)))
    (asked,) = (question for question in program.questions if question.key == "cam.get()")
    assert asked.example == example and asked.type.startswith(type_)


def test_a_program_that_goes_nowhere_names_the_data_of_its_targets() -> None:
    text = (
        f"{HOME}off = socket_read_ascii_float(3)\nhere = get_actual_tcp_pose()\n"
        "movel(pose_trans(here, p[off[1], off[2], off[3], 0, 0, 0]), a=0.5, v=0.1)\n"
    )
    robot = find_robot("ur/ur5e")
    going = Answers(goes_on=True)
    program = find_vendor("ur").read(text, "t.script", robot=robot, answers=going)
    with pytest.raises(MotionError, match=r"targets may depend on socket_read_ascii_float\(3\)"):
        drive(Controller(find_vendor("ur"), robot), program)
