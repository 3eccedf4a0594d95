"""What decides where the text of a URScript leaves its course open."""

from typing import Any

import pytest

from flyby.core.errors import SourceError
from flyby.core.program.move import Opaque, Wait
from flyby.core.program.program import Program
from flyby.core.program.target import JointTarget
from flyby.core.source.execution.answers import Answer, Answers, key
from flyby.core.source.reading import ReadOptions
from flyby.vendors.ur.run.reader import read

GO = "movej([{}, 0, 0, 0, 0, 0])"


def program(text: str, entry: str | None = None, **answers: Any) -> Program:
    return read(text, "t.script", ReadOptions(entry, answers=Answers(**answers)))


def joints(text: str, **answers: Any) -> list[float]:
    """The first joint of every target."""
    targets = [m.target for m in program(text, **answers).moves]
    return [t.joints[0] for t in targets if isinstance(t, JointTarget)]


def refusal(text: str, entry: str | None = None) -> str:
    with pytest.raises(SourceError) as caught:
        program(text, entry)
    return str(caught.value)


def messages(text: str) -> list[str]:
    return [str(note) for note in program(text).notes]


# ------------------------------------------------------------------------- branches

CHOICE = f"""
if get_digital_in(1):
  {GO.format(1)}
elif get_digital_in(2):
  {GO.format(2)}
else:
  {GO.format(3)}
end
"""


def test_the_first_branch_that_moves_is_taken_and_noted() -> None:
    assert joints(CHOICE) == [1]
    (note,) = [m for m in messages(CHOICE) if "condition" in m]
    assert note.startswith(
        "t.script:2:1: the condition depends on get_digital_in(1): branch 1 of 3"
    )


def test_answers_decide_branches_by_value_and_by_line() -> None:
    inputs: dict[str, Answer] = {key("get_digital_in(1)"): False, key("get_digital_in(2)"): True}
    assert joints(CHOICE, values=inputs) == [2]
    assert joints(CHOICE, branches={"t.script:2": 3}) == [3]
    assert joints(CHOICE, branches={"t.script:2": 0}) == [3]


def test_a_branch_that_ends_the_program_is_not_taken() -> None:
    text = f"if get_digital_in(1):\n{GO.format(1)}\nhalt\nend\n{GO.format(2)}"
    assert joints(text) == [2]


def test_what_an_undecided_function_returns_is_not_known_either() -> None:
    text = (
        "def ready():\n  if socket_read_byte_list(3) == [1]:\n    return True\n  end\n"
        "  return False\nend\n"
        f"while not ready():\n  sync()\nend\n{GO.format(1)}"
    )
    first, wait, move = program(text).statements
    assert first == Opaque("socket_read_byte_list(3)")
    assert wait == Opaque("while not ready():\n  sync()\nend", stops=True)
    assert move in program(text).moves


# ---------------------------------------------------------------------------- loops


def test_waits_are_satisfied_at_once_and_stop_the_robot() -> None:
    text = f"{GO.format(1)}\nwhile get_digital_in(0) == False:\n  sleep(0.01)\nend\n{GO.format(2)}"
    _, wait, _ = program(text).statements
    assert isinstance(wait, Opaque)
    assert wait.stops
    assert wait.text.startswith("while get_digital_in(0)")


def test_a_moving_loop_without_a_known_end_runs_once_or_as_answered() -> None:
    text = f"i = 0\nwhile get_digital_in(0):\n  i = i + 1\n  {GO.format('i')}\nend"
    assert joints(text) == [1]
    assert joints(text, passes={"t.script:2": 3}) == [1, 2, 3]
    turns = {key("get_digital_in(0)"): (True, True, False)}
    assert joints(text, sequences=turns) == [1, 2]


def test_the_main_loop_is_read_once() -> None:
    text = f"def prog():\n  while (True):\n    {GO.format(1)}\n    {GO.format(2)}\n  end\nend"
    assert joints(text) == [1, 2]
    endless = "the program is an endless loop (while True): one pass is read"
    assert any(endless in m for m in messages(text))


def test_known_loops_run_to_their_end_whatever_else_is_not_known() -> None:
    text = (
        f"i = 0\nwhile i < 3:\n  i = i + 1\n  {GO.format('i')}\n"
        "  if get_digital_in(7):\n    break\n  end\nend"
    )
    assert joints(text) == [1, 2, 3]


@pytest.mark.parametrize(
    "leave",
    ["if get_digital_in(7):\n break\nend", "if get_digital_in(7):\n on = False\nend"],
)
def test_a_loop_that_only_an_input_ends_runs_once(leave: str) -> None:
    text = f"on = True\nwhile on:\n  {GO.format(1)}\n  {leave}\nend\n{GO.format(2)}"
    assert joints(text) == [1, 2]


def test_a_loop_whose_flag_nobody_changes_ends_the_program() -> None:
    leave = "  if stop:\n    break\n  end"
    text = f"stop = False\nwhile True:\n  {GO.format(1)}\n{leave}\nend\n{GO.format(2)}"
    assert joints(text) == [1]


def test_a_loop_that_waits_for_what_the_program_does_not_change_is_satisfied() -> None:
    text = f"on = True\nwhile on:\n  sync()\nend\n{GO.format(2)}"
    assert joints(text) == [2]
    assert any("the loop (while on) only waits" in m for m in messages(text))


BUMP = "def bump():\n  n = n + 1\n  if n >= 3:\n    on = False\n  end\nend\n"


@pytest.mark.parametrize(
    ("before", "lower"),
    [
        ("", "n = n + 1\n if n >= 3:\n  on = False\n end"),
        ("", "n = n + 1\n k = n\n on = k < 3"),
        (
            "left = [3]\n",
            "n = n + 1\n left[0] = 3 - n\n if left[0] == 0:\n  on = False\n end",
        ),
        (BUMP, "bump()"),
    ],
    ids=["branch", "value", "element", "function"],
)
def test_a_loop_goes_on_until_what_it_counts_lowers_its_flag(before: str, lower: str) -> None:
    text = f"on = True\nn = 0\n{before}while on:\n {lower}\n {GO.format('n')}\nend\n{GO.format(9)}"
    assert joints(text) == [1, 2, 3, 9]


# -------------------------------------------------------------------------- threads

THREAD = "thread T():\n{}\nend\n"


def test_threads_that_leave_the_robot_alone_are_kept() -> None:
    text = THREAD.format("  while True:\n    n = n + 1\n    sync()\n  end")
    statements = program(f"n = 0\n{text}h = run T()\n{GO.format(1)}\nkill h").statements
    assert [s.text for s in statements if isinstance(s, Opaque)] == ["h = run T()", "kill h"]


def test_what_a_running_thread_writes_is_not_known() -> None:
    text = "done = False\n" + THREAD.format("  done = get_digital_in(1)")
    assert joints(f"{text}run T()\nwhile not done:\n  sync()\nend\n{GO.format(1)}") == [1]
    assert "which thread T writes" in refusal(
        f"x = 0\n{THREAD.format('x = 1')}run T()\n{GO.format('x')}"
    )


def test_what_a_thread_keeps_to_itself_stays_known_outside() -> None:
    index = "def index(n):\n  text = str_cat('', n)\n  return str_len(text)\nend\n"
    body = "  local x = 7\n  mine = index('aaa')\n  global made = 1"
    text = f"x = 5\n{index}{THREAD.format(body)}run T()\n"
    assert joints(f"{text}{GO.format('index(12)')}\n{GO.format('x')}") == [2, 5]
    assert "'made', which thread T writes" in refusal(f"{text}{GO.format('made')}")
    assert "'mine', which the program does not declare" in refusal(f"{text}{GO.format('mine')}")


def test_a_thread_that_moves_is_carried_out_where_it_is_started() -> None:
    body = f"  {GO.format(1)}\n  flag = 1"
    wait = "while flag == 0:\n  sync()\nend"
    text = f"flag = 0\n{THREAD.format(body)}h = run T()\n{wait}\n{GO.format(2)}"
    assert joints(text) == [1, 2]
    assert joints(text.replace(wait, "join h\nkill h")) == [1, 2]
    assert any("thread T moves the robot" in m for m in messages(text))


@pytest.mark.parametrize(
    "ending",
    ["sleep(1)\nkill h", "while not get_digital_in(1):\n  sync()\nend\nkill h"],
)
def test_a_move_that_is_stopped_on_the_way_is_refused(ending: str) -> None:
    message = refusal(f"{THREAD.format(GO.format(1))}h = run T()\n{ending}")
    assert "thread T moves the robot and is stopped on the way" in message


def test_two_movers_at_a_time_are_refused() -> None:
    loop = f"while True:\n{GO.format(1)}\nend"
    assert "while thread T moves it" in refusal(f"{THREAD.format(loop)}run T()\n{GO.format(2)}")
    assert joints(f"{THREAD.format(loop)}run T()\nwhile True:\n  sync()\nend") == [1]


# ------------------------------------------------------- calls that nobody declares


def test_unknown_functions_are_stepped_over_and_said() -> None:
    text = f"spray_on(1)\n{GO.format(1)}"
    assert joints(text) == [1]
    (message,) = [m for m in messages(text) if "spray_on" in m]
    assert "nobody declares the function 'spray_on'" in message
    assert "as if it moved nothing" in message and '[calls] "spray_on" = "skip"' in message
    assert joints(text, skipped=frozenset({"spray_on"})) == [1]
    assert "did you mean movej" in refusal("movej_([0,0,0,0,0,0])")
    assert "did you mean movej" in refusal("MoveJ([0,0,0,0,0,0])")


def test_forces_are_stepped_over() -> None:
    forced = "force_mode(tool_pose(), [0,0,1,0,0,0], [0,0,5,0,0,0], 2, [1,1,1,1,1,1])"
    thread = THREAD.format(f"  while True:\n    {forced}\n    sync()\n  end")
    text = (
        f"{thread}h = run T()\n{GO.format(1)}\nend_force_mode()\nkill h\n{forced}\n{GO.format(2)}"
    )
    assert any("force_mode" in m and "stay where it is" in m for m in messages(text))
    assert joints(text) == [1, 2]
    assert joints(text, skipped=frozenset({"force_mode"})) == [1, 2]


def test_newer_functions_of_the_controller_leave_the_robot_alone() -> None:
    calls = ["tool_wrench_limit_disable()", "motion_version_set(2)", "t1 = time(2)"]
    kept = program("\n".join([*calls, "s = t1.sec", "p1 = ros_publisher_factory(topic='a')"]))
    texts = [s.text for s in kept.statements if isinstance(s, Opaque)]
    assert texts == [*calls[:2], "p1 = ros_publisher_factory(topic='a')"]


def test_grippers_and_fieldbuses_are_known_to_leave_the_robot_alone() -> None:
    calls = ["rq_open()", "rg_grip(50, 20)", "vg10_grip(0)", "twofg_grip_ext(1)", "socket_close()"]
    calls += [
        "modbus_set_output_register(1, 2)",
        "rtde_set_watchdog(1, 2)",
        "on_return = rg_grip(1)",
    ]
    text = "\n".join(calls)
    assert [s.text for s in program(text).statements if isinstance(s, Opaque)] == calls


def test_undeclared_variables_are_not_known_until_they_are_answered() -> None:
    text = GO.format("offset_1")
    assert "'offset_1', which the program does not declare" in refusal(text)
    assert joints(text, values={"offset_1": 0.5}) == [0.5]


def test_poses_can_be_answered() -> None:
    text = "movel(Feature_1)"
    for answer in ("p[0.4, 0, 0.3, 0, 3.1, 0]", "p[0.4,0,0.3,0,3.1,0]"):
        (move,) = program(text, values={"feature_1": answer}).moves
        assert move.target.pose.position == (0.4, 0.0, 0.3)  # type: ignore[union-attr]
    asked = {key("get_actual_tcp_pose()"): (0.4, 0.0, 0.3, 0.0, 3.1, 0.0)}
    (move,) = program("movel(get_actual_tcp_pose())", values=asked).moves
    assert move.target.pose.position == (0.4, 0.0, 0.3)  # type: ignore[union-attr]


def test_a_payload_that_is_not_known_leaves_the_one_before() -> None:
    text = f"set_payload(1)\nset_payload(read_input_float_register(1))\n{GO.format(1)}"
    (move,) = program(text).moves
    assert move.tool.load is not None
    assert move.tool.load.mass == 1
    assert any("the TCP of the move" in m for m in messages(f"set_tcp(vision_tcp)\n{GO.format(1)}"))


# ------------------------------------------------------------------------ the entry


@pytest.mark.parametrize(
    ("text", "first"),
    [
        (f"def a():\n{GO.format(1)}\nend", 1),
        (f"def a():\n{GO.format(1)}\nend\ndef b():\na()\nend", 1),
        (f"def b():\n{GO.format(2)}\nend\ndef main():\n{GO.format(1)}\nend", 1),
        (f"def t():\n{GO.format(1)}\nend\ndef other():\n{GO.format(2)}\nend", 1),
        (f"def a(x=1):\n{GO.format('x')}\nend\na(3)", 3),
        (f"x = 4\ndef a():\n{GO.format('x')}\nend", 4),
        (GO.format(5), 5),
    ],
)
def test_where_a_program_begins(text: str, first: float) -> None:
    assert joints(text) == [first]


def test_an_entry_can_be_chosen() -> None:
    text = f"x = 1\ndef a():\n{GO.format('x')}\nend\ndef b():\n{GO.format(2)}\nend\na()"
    assert [m.target.joints[0] for m in program(text, "b").moves] == [2]  # type: ignore[union-attr]
    assert "there is no function 'c'" in refusal(text, "c")
    both = f"def a():\n{GO.format(1)}\nend\ndef b():\n{GO.format(2)}\nend"
    assert "choose as the entry one of a (1 move), b" in refusal(both)
    assert "choose as the entry one of a(x)" in refusal(f"def a(x):\n{GO.format(1)}\nend")
    assert "it is a library of others" in refusal("def a():\nend\ndef b():\nend")


def test_halt_ends_the_program_everywhere() -> None:
    text = f"def f():\n  if True:\n    halt\n  end\nend\n{GO.format(1)}\nf()\n{GO.format(2)}"
    assert joints(text) == joints(text.replace("halt", "halt()")) == [1]


def test_notes_count_what_is_kept_by_kind() -> None:
    notes = messages("set_digital_out(1, True)\nset_flag(1, True)\nset_digital_out(1, False)")
    (note,) = [m for m in notes if "outputs" in m]
    assert note == (
        "t.script:1:1: statements that set outputs and registers are kept and not carried out: "
        "set_digital_out, set_flag (3 statements, here first)"
    )
    (note,) = messages("stopj(2)")
    assert note.endswith("statements that stop the robot are kept and not carried out: stopj")


def test_remote_procedures_are_kept() -> None:
    text = 'cam = rpc_factory("xmlrpc", "http://127.0.0.1")\nok = cam.shoot(1)\nsleep(0.1)'
    first, second, wait = program(text).statements
    assert first == Opaque('cam = rpc_factory("xmlrpc", "http://127.0.0.1")')
    assert second == Opaque("ok = cam.shoot(1)")
    assert wait == Wait(0.1)


# -------------------------------------------------------- outputs that the program has set


def branch(condition: str) -> str:
    return f"if {condition}:\n  {GO.format(1)}\nend\n{GO.format(9)}\n"


@pytest.mark.parametrize(
    ("text", "driven"),
    [
        # The program knows what it has written.
        ("set_digital_out(1, False)\n" + branch("get_digital_out(1)"), [9]),
        ("set_digital_out(1, True)\n" + branch("get_digital_out(1)"), [1, 9]),
        ("set_standard_digital_out(1, False)\n" + branch("get_digital_out(1)"), [9]),
        ("set_tool_digital_out(1, False)\n" + branch("get_digital_out(9)"), [9]),
        (
            "set_configurable_digital_out(2, False)\n"
            + branch("get_configurable_digital_out(2) == True"),
            [9],
        ),
        ("set_flag(3, False)\n" + branch("get_flag(3)"), [9]),
        (
            "write_output_integer_register(4, 7)\n" + branch("read_output_integer_register(4) > 7"),
            [9],
        ),
        (
            "write_output_boolean_register(0, True)\n"
            + branch("not read_output_boolean_register(0)"),
            [9],
        ),
        (
            "write_output_float_register(0, 0.5)\n" + branch("read_output_float_register(0) < 0.4"),
            [9],
        ),
        (
            "n = 2\nset_digital_out(n, False)\nn = n + 1\nset_digital_out(n, True)\n"
            + branch("get_digital_out(2)"),
            [9],
        ),
        (
            "def put(n, v):\n  set_standard_digital_out(n, v)\nend\nput(1, False)\n"
            + branch("get_standard_digital_out(1)"),
            [9],
        ),
        # Inputs, and what nobody has written, are not known: branches that move are taken.
        (branch("get_digital_out(1)"), [1, 9]),
        ("set_digital_out(1, False)\n" + branch("get_digital_in(1)"), [1, 9]),
        ("set_digital_out(1, False)\n" + branch("get_digital_out(2)"), [1, 9]),
        (
            "write_output_integer_register(4, 7)\n" + branch("read_input_integer_register(4) > 7"),
            [1, 9],
        ),
        # Nor is what others may write, or what is not certain.
        (
            "set_standard_analog_out(0, 0.5)\n" + branch("get_standard_analog_out(0) > 1"),
            [1, 9],
        ),
        (
            "set_digital_out(1, False)\nset_digital_out(1, get_digital_in(1))\n"
            + branch("get_digital_out(1)"),
            [1, 9],
        ),
        (
            "set_digital_out(1, False)\nset_digital_out(read_input_integer_register(0), True)\n"
            + branch("get_digital_out(1)"),
            [1, 9],
        ),
        (
            "thread blink():\n  while True:\n    set_digital_out(1, True)\n    sync()\n  end\nend\n"
            "h = run blink()\nset_digital_out(1, False)\n" + branch("get_digital_out(1)"),
            [1, 9],
        ),
        (
            "thread blink():\n  set_digital_out(1, True)\nend\nh = run blink()\njoin h\n"
            "set_digital_out(1, False)\n" + branch("get_digital_out(1)"),
            [9],
        ),
        ("set_tool_digital_out(0, False)\nrg_grip(20)\n" + branch("get_digital_out(8)"), [1, 9]),
        # Somebody else changes what a loop waits for.
        (
            "set_digital_out(1, True)\nwhile get_digital_out(1):\n  sync()\nend\n" + GO.format(9),
            [9],
        ),
        (
            "set_digital_out(1, True)\nwhile get_digital_out(1):\n"
            + f"  {GO.format(3)}\nend\n"
            + GO.format(9),
            [3, 9],
        ),
        # The loop changes it itself.
        (
            "set_digital_out(1, True)\nn = 0\nwhile get_digital_out(1):\n  n = n + 1\n"
            + f"  {GO.format('n')}\n  if n == 3:\n    set_digital_out(1, False)\n  end\nend\n"
            + GO.format(9),
            [1, 2, 3, 9],
        ),
    ],
)
def test_outputs_keep_what_the_program_sets(text: str, driven: list[float]) -> None:
    assert joints(text) == driven


def test_answers_to_outputs() -> None:
    text = "set_digital_out(1, False)\n" + branch("get_digital_out(1)")
    assert joints(text, values={key("get_digital_out(1)"): True}) == [9]
    assert joints(text, sequences={key("get_digital_out(1)"): (True,)}) == [1, 9]
    skipped = "set_digital_out(1, False)\ngrip_it()\n" + branch("get_digital_out(1)")
    assert joints(skipped, skipped=frozenset({"grip_it"})) == [1, 9]


def test_a_thread_is_chosen_as_the_entry() -> None:
    text = """def prog():
  set_tcp(p[0, 0, 0.1, 0, 0, 0])
  low = [0, -1, 1, -1, -1, 0]
  thread watch():
    while True:
      movej(low)
      movej([0, -1, 1, -1, -1, 1])
    end
  end
  run watch()
  movej([0, -1.2, 1, -1, -1, 0])
end
"""
    program = read(text, "prog.script", ReadOptions(entry="watch"))
    assert len(program.moves) == 2
    assert program.moves[0].tool.tcp.position == (0.0, 0.0, 0.1)
    assert program.moves[0].target == JointTarget((0.0, -1.0, 1.0, -1.0, -1.0, 0.0), name="low")
    with pytest.raises(SourceError, match=r"define prog \(\d moves\), watch \(2 moves\)"):
        read(text, "prog.script", ReadOptions(entry="guard"))
