"""Several programs are loaded at once, and driven one after the other."""

from __future__ import annotations

import runpy
import socket
import threading
import time
from pathlib import Path

import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from flyby.core.program.move import MoveJ
from flyby.core.program.program import Program
from flyby.core.program.speed import Speed
from flyby.core.program.target import JointTarget
from flyby.core.program.zone import FINE
from flyby.core.recording import RecordedRun, Recording, comments, listed
from flyby.core.registry import find_robot, find_vendor

from ..vendors.grammars.check import checks

ROBOTS = {
    "abb": ("abb/irb6640-180-255", Speed(tcp=0.5)),
    "kuka": ("kuka/kr30-3", Speed()),
    "ur": ("ur/ur5e", Speed(joint=1.0, joint_acceleration=1.0)),
}
MAIN = {"abb": "flyby_runs.mod", "kuka": "flyby_runs.src", "ur": "flyby_runs.script"}


def recording(speed: Speed, count: int, jogged: set[int]) -> Recording:
    def program(number: int) -> Program:
        ends = [(0.1 * number + 0.01 * k, -1.2, 1.2, 0.0, 0.4, 0.0) for k in range(3)]
        return Program(tuple(MoveJ(JointTarget(q), speed, FINE) for q in ends))

    runs = (
        RecordedRun(program(n), f"{n:02}_a.csv", by_hand=n in jogged) for n in range(1, count + 1)
    )
    return Recording("flyby_runs", tuple(runs))


@pytest.mark.parametrize("vendor", ROBOTS)
@settings(max_examples=6, deadline=None, suppress_health_check=list(HealthCheck))
@given(count=st.integers(2, 6), jogged=st.sets(st.integers(1, 6)))
def test_a_start_drives_the_runs_up_to_one_that_is_jogged_to(
    tmp_path_factory: pytest.TempPathFactory, vendor: str, count: int, jogged: set[int]
) -> None:
    """What the controller would drive from its first start, as the package reads the text."""
    name, speed = ROBOTS[vendor]
    robot, made = find_robot(name), recording(speed, count, jogged)
    sources = find_vendor(vendor).record_runs(made, robot, 0.016)
    checks()[vendor]({name: text for name, text in sources.items() if not name.endswith(".py")})
    folder = tmp_path_factory.mktemp("runs")
    for file, text in sources.items():
        (folder / file).write_bytes(text.encode())
    path = folder / MAIN[vendor]
    if vendor == "ur":  # the number that the operator gives
        text = path.read_text("utf-8")
        asked = [line for line in text.split("\n") if "request_integer_from" in line]
        assert len(asked) == bool(made.jogged)
        for line in asked:
            text = text.replace(line, "  flyby_run = 1")
        path.write_text(text, "utf-8")
    driven = find_vendor(vendor).read_file(path, robot=robot).moves
    until = min(made.jogged, default=count + 1) - 1
    wanted = [move.target.joints for run in made.runs[:until] for move in run.program.moves]
    assert [move.target.joints for move in driven] == [pytest.approx(q, abs=1e-5) for q in wanted]
    text = "".join(sources.values())
    assert all(run.log in text for run in made.runs)
    steps = " ".join(find_vendor(vendor).recorder.steps(made, 0.016))
    assert (f"Before {listed(made.jogged)} it" in steps) if made.jogged else "Before" not in steps


def test_rapid_takes_no_option_of_the_controller_from_ten_milliseconds_on() -> None:
    name, speed = ROBOTS["abb"]
    made, vendor = recording(speed, 2, set()), find_vendor("abb")
    one = vendor.record_runs(made, find_robot(name), vendor.recorder.usual_period(find_robot(name)))
    assert set(one) == {"flyby_runs.mod"} and "Multitasking" not in "".join(
        vendor.recorder.steps(made, 0.012)
    )
    assert "ITimer \\Single,0.012,fbTimer;" in one["flyby_runs.mod"]
    two = vendor.record_runs(made, find_robot(name), 0.004)
    assert set(two) == {"flyby_runs.mod", "FlybyLogger.mod"}
    assert (
        'fbBegin "02_a.csv";' in two["flyby_runs.mod"] and "File:=fbName" in two["FlybyLogger.mod"]
    )


def test_the_listener_writes_each_log_under_its_name(tmp_path: Path) -> None:
    """The script that is handed out, run, with a client that sends as the robot does."""
    name, speed = ROBOTS["ur"]
    sources = find_vendor("ur").record_runs(recording(speed, 2, set()), find_robot(name), 0.008)
    script = tmp_path / "flyby_listen.py"
    script.write_text(sources["flyby_listen.py"], "utf-8")
    with socket.create_server(("127.0.0.1", 0)) as free:
        port = free.getsockname()[1]
    listener = runpy.run_path(str(script))
    folder = tmp_path / "logs"
    threading.Thread(target=listener["main"], args=(folder, port), daemon=True).start()
    head = "t,q1,q2,q3,q4,q5,q6\n"
    sent = {"01_a.csv": head + "0,0,0,0,0,0,0\n" * 3, "02_a.csv": head + "0,1,1,1,1,1,1\n" * 500}
    for first, text in (*sent.items(), ("../evil.csv", head), ("x/../../evil.csv", head), ("", "")):
        for _ in range(100):
            try:
                client = socket.create_connection(("127.0.0.1", port), 5)
            except ConnectionRefusedError:
                time.sleep(0.05)
            else:
                break
        with client:
            client.sendall(f"# {first}\n{text}".encode())
            client.shutdown(socket.SHUT_WR)
            assert client.recv(1) == b""  # it has taken all, and closed
    written = {path.name: path.read_text("ascii") for path in folder.iterdir()}
    assert written == sent and not (tmp_path / "evil.csv").exists()


@given(st.lists(st.text("ab cd", min_size=1, max_size=300), max_size=4))
def test_comments_keep_all_words_in_short_lines(sentences: list[str]) -> None:
    lines = comments("!", sentences)
    assert all(line.startswith("! ") and (len(line) <= 90 or " " not in line[2:]) for line in lines)
    said = " ".join(line[2:] for line in lines)
    if all(len(word) < 80 for one in sentences for word in one.split()):
        assert said.split() == " ".join(sentences).split()


def test_numbers_are_listed_as_words() -> None:
    assert listed((3,)) == "run 3" and listed((3, 5, 7)) == "runs 3, 5 and 7"
