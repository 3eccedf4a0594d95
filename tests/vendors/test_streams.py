"""Motion that a computer sends, driven from a file of joints, in every language."""

from __future__ import annotations

import math
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import flyby
from flyby.core.errors import FlybyError, InputError, Span
from flyby.core.source.execution.streams import Stream, load_stream

SPAN = Span("a.mod", 1, 1, 0, 0)
ROBOTS = {"abb": "abb/irb1600-6-145", "kuka": "kuka/kr30-3", "ur": "ur/ur10e"}
FILES = {"abb": "demo.mod", "kuka": "demo.src", "ur": "demo.script"}
TEXT = {
    "abb": "MODULE demo\nVAR egmident id;\nPROC main()\n"
    "MoveAbsJ [[0,0,0,0,30,0],[9E9,9E9,9E9,9E9,9E9,9E9]],v500,fine,tool0;\n"
    "EGMRunJoint id, EGM_STOP_HOLD\\J1;\n"
    "MoveAbsJ [[0,0,0,0,30,0],[9E9,9E9,9E9,9E9,9E9,9E9]],v500,fine,tool0;\nENDPROC\nENDMODULE\n",
    "kuka": "DEF demo( )\nBAS(#INITMOV,0)\nPTP {A1 0,A2 -90,A3 90,A4 0,A5 30,A6 0}\n"
    "RSI_MOVECORR()\nPTP {A1 0,A2 -90,A3 90,A4 0,A5 30,A6 0}\nEND\n",
    "ur": "def demo():\n  movej([0,-1.57,1.57,-1.57,-1.57,0], a=1.4, v=1.05)\n"
    "  while True:\n    q = read_input_float_register(0)\n    servoj([q,0,0,0,0,0], t=0.008)\n"
    "    if q > 3:\n      break\n    end\n  end\n"
    "  movej([0,-1.57,1.57,-1.57,-1.57,0], a=1.4, v=1.05)\nend\n",
}
KEYS = {"abb": "EGMRunJoint", "kuka": "RSI_MOVECORR", "ur": "servoj"}
HOME = {
    "abb": (0, 0, 0, 0, 30, 0),
    "kuka": (0, -90, 90, 0, 30, 0),
    "ur": (0, -89.95, 89.95, -89.95, -89.95, 0),
}


def table(language: str, factor: float = 1.0, seconds: float = 3.0) -> str:
    lines = ["time,j1,j2,j3,j4,j5,j6"]
    for t in np.linspace(0, seconds, 301):
        phase = t / seconds * 2 * math.pi
        moved = (20 * factor * math.sin(phase), 5 * factor * (1 - math.cos(phase)), 0, 0, 0, 0)
        values = (str(a + b) for a, b in zip(HOME[language], moved, strict=True))
        lines.append(f"{t},{','.join(values)}")
    return "\n".join(lines)


def emulated(language: str, text: str, folder: Path) -> tuple[flyby.Program, flyby.Run]:
    (folder / "sent.csv").write_text(text)
    (folder / "answers.toml").write_text(f'[streams]\n{KEYS[language]} = "sent.csv"\n')
    (folder / FILES[language]).write_text(TEXT[language])
    program = flyby.read(
        folder / FILES[language], robot=ROBOTS[language], answers=folder / "answers.toml"
    )
    return program, flyby.emulate(program)


@pytest.mark.parametrize("language", list(ROBOTS))
def test_a_stream_takes_its_time_and_ends_where_it_says(language, tmp_path) -> None:
    program, run = emulated(language, table(language), tmp_path)
    assert not run.faults
    assert any("is driven here" in note.message for note in program.notes)
    streamed = [m for m in program.moves if m.speed.duration is not None]
    assert 10 < len(streamed) < 150
    assert sum(m.speed.duration for m in streamed) == pytest.approx(3.0)
    assert streamed[-1].target.joints == pytest.approx(np.radians(HOME[language]), abs=1e-9)
    assert run.duration == pytest.approx(3.0, rel=0.15)


@pytest.mark.parametrize("language", list(ROBOTS))
def test_joints_that_turn_too_fast_are_a_fault_with_their_line(language, tmp_path) -> None:
    _, run = emulated(language, table(language, factor=4, seconds=0.5), tmp_path)
    (fault,) = run.faults
    assert "sent.csv, line 3: joint 1 turns at" in fault.message


@settings(max_examples=40, deadline=None)
@given(st.lists(st.tuples(st.floats(0.01, 1), st.floats(-2, 2)), min_size=2, max_size=60))
def test_between_its_targets_a_stream_runs_straight(steps) -> None:
    times = np.cumsum([s for s, _ in steps])
    joints = np.array([[q] for _, q in steps])
    moves = Stream(times, joints, "sent.csv").moves(SPAN, None)
    at = np.cumsum([times[0], *(m.speed.duration for m in moves[1:])])
    found = np.interp(times, at, [m.target.joints[0] for m in moves])
    assert np.abs(found - joints[:, 0]).max() < math.radians(0.0501)


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("", "begins with the line time,j1,j2"),
        ("t,j1\n0,1\n1,2\n", ":1: a stream begins"),
        ("time,j1,j2_rad\n0,1,1\n1,2,2\n", ":1: a stream begins"),
        ("time,j1\n0,1\n", "2 to 1,000,000 rows, not 1"),
        ("time,j1\n0,1\n0,2\n", ":3: times must grow"),
        ("time,j1\n0,1\n1,x\n", ":3: '1,x' are no numbers"),
        ("time,j1\n0,1\n1,nan\n", ":3: 2 finite numbers"),
        ("time,j1\n0,1\n1,2,3\n", ":3: 2 finite numbers"),
    ],
)
def test_files_that_are_no_streams_are_refused_with_their_line(text, message, tmp_path) -> None:
    file = tmp_path / "sent.csv"
    file.write_text(text)
    with pytest.raises(InputError, match=message):
        load_stream(file)


def test_radians_are_said_by_the_header(tmp_path) -> None:
    file = tmp_path / "sent.csv"
    file.write_text("time,j1_rad\n0,1\n1,2\n")
    assert load_stream(file).joints[:, 0].tolist() == [1.0, 2.0]


IN_A_BRANCH = """def demo():
  while True:
    q = read_input_float_register(0)
    if q != 0:
      servoj([q,0,0,0,0,0], t=0.008)
    end
    sync()
  end
end
"""
"""Nobody decides whether it moves, and it moves by what a computer sends alone."""
IN_A_THREAD = """def demo():
  thread follow():
    while True:
      v = socket_read_ascii_float(6)
      speedj([v[1], v[2], v[3], v[4], v[5], v[6]], 1.0, 0.01)
    end
  end
  run follow()
  while True:
    socket_read_ascii_float(1)
    sync()
  end
end
"""


IN_A_THREAD_OF_A_THREAD = """def demo():
  global goal = [0, 0, 0, 0, 0, 0]
  def hold():
    servoj(goal, t=0.008, lookahead_time=0.1, gain=300)
  end
  thread steer():
    while True:
      hold()
    end
  end
  thread listen():
    local steering = run steer()
    while True:
      got = socket_read_ascii_float(6, "pc")
      if got[0] != 6:
        break
      end
      goal = [got[1], got[2], got[3], got[4], got[5], got[6]]
    end
    join steering
  end
  socket_open("10.0.0.2", 50001, "pc")
  listening = run listen()
  join listening
  socket_close("pc")
end
"""
"""As drivers do: one thread listens, and starts the one that drives."""


@pytest.mark.parametrize(
    ("text", "name"),
    [(IN_A_BRANCH, "servoj"), (IN_A_THREAD, "speedj"), (IN_A_THREAD_OF_A_THREAD, "servoj")],
)
def test_a_program_that_only_streams_asks_for_the_stream_and_drives_it(text, name, tmp_path):
    file, answers = tmp_path / "demo.script", tmp_path / "answers.toml"
    file.write_text(text)
    with pytest.raises(FlybyError, match=rf"\[streams\] {name} = .*time,j1,j2"):
        flyby.emulate(flyby.read(file, robot=ROBOTS["ur"]))
    asked = flyby.ask(file, robot=ROBOTS["ur"]).toml
    assert f'#{name} = "joints.csv"' in asked
    (tmp_path / "joints.csv").write_text(table("ur"))
    answers.write_text(asked.replace(f"#{name}", name))
    run = flyby.emulate(flyby.read(file, robot=ROBOTS["ur"], answers=answers))
    assert run.duration == pytest.approx(3.0, rel=0.15)


@pytest.mark.parametrize("language", list(ROBOTS))
def test_a_stream_is_asked_for(language, tmp_path) -> None:
    (tmp_path / FILES[language]).write_text(TEXT[language])
    asked = flyby.ask(tmp_path / FILES[language], robot=ROBOTS[language]).toml
    assert f'#{KEYS[language]} = "joints.csv"' in asked


def test_a_thread_that_a_computer_drives_is_stopped_where_a_file_ends(tmp_path: Path) -> None:
    """What the file says is all that is driven before; of any other move nobody knows how much."""
    (tmp_path / "j.csv").write_text(
        "time,j1,j2,j3,j4,j5,j6\n0,0,-90,90,0,90,0\n1,9,-90,90,0,90,0\n"
    )
    answers = tmp_path / "answers.toml"
    answers.write_text('[streams]\nspeedj = "j.csv"\n', "utf-8")
    source = tmp_path / "main.script"
    stream = "  while True:\n    speedj(q, 1.0, 0.008)\n  end"
    text = (
        "q = [0,0,0,0,0,0]\nthread T():\n{}\nend\nh = run T()\n"
        "while not get_digital_in(1):\n  sync()\nend\nkill h\n"
    )
    for before, faults in (("", 0), ("  movej([1,-1,1,0,1,0])\n", 1)):
        source.write_text(text.format(before + stream), "utf-8")
        program = flyby.read(source, robot="ur/ur5e", answers=answers)
        assert len(flyby.emulate(program).faults) == faults
    source.write_text(text.format(stream), "utf-8")
    with pytest.raises(FlybyError, match=r"stopped on the way.*\[streams\] speedj = \"joints.csv"):
        flyby.emulate(flyby.read(source, robot="ur/ur5e"))
