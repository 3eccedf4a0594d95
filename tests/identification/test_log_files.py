"""Reading records of runs and their logs, on files made here."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest

from flyby.core.errors import InputError, OptionError
from flyby.core.files.reading import read_json
from flyby.core.program.arc_orientation import ArcOrientation
from flyby.core.program.move import MoveC, MoveJ, MoveL
from flyby.core.program.zone import FINE, Radius
from flyby.core.registry import find_robot, find_vendor
from flyby.identification.logs import load_run, read_samples, records
from flyby.tasks.files.logged_runs import find_runs, robot_of_records

HOME = [0.2, -1.4, -1.8, -1.4, 1.5, 0.3]
HEADER = "t,q1,q2,q3,q4,q5,q6"


def write(folder, change=None, samples=None):
    robot = find_robot("ur/ur10e")
    pose = robot.flange_pose(np.array(HOME))
    at = {"xyz_m": list(pose.position), "quat_wxyz": list(pose.quaternion)}
    data = {
        "robot": "UR10e",
        "real": False,
        "start_joints_rad": HOME,
        "note": "made up",
        "log": {"file": "run.csv"},
        "moves": [
            {
                "type": "MoveL",
                "target_pose": at,
                "speed": {"tcp_mps": 0.2, "ori_radps": 1.0},
                "zone": {"radius_m": 0.01, "pzone_ori_m": 0.015, "zone_ori_rad": 0.03},
            },
            {"type": "MoveJ", "target_joints_rad": HOME, "params": {"v": 0.8, "a": 1.0}},
            {"type": "PTP", "target_joints_rad": HOME, "params": {"t": 3.0}},
            {"type": "CIRC", "target_pose": at, "via_pose": at},
        ],
    }
    data.update(change or {})
    rows = samples or [[0.0, *HOME], [0.1, *(np.array(HOME) + 0.01)]]
    text = "\n".join([HEADER, *(",".join(map(str, row)) for row in rows)])
    (folder / "run.csv").write_text(text, "utf-8")
    (folder / "run.json").write_text(json.dumps(data), "utf-8")
    return folder / "run.json"


def test_a_run_is_read_as_it_stands(tmp_path) -> None:
    run = load_run(write(tmp_path), find_robot)
    line, joint, timed, arc = run.program.moves
    assert [type(m) for m in run.program.moves] == [MoveL, MoveJ, MoveJ, MoveC]
    assert line.zone == Radius(0.01, 0.015, 0.015, 0.03)
    assert line.speed.tcp == 0.2 and line.speed.reorientation == 1.0
    assert (joint.speed.joint, joint.speed.joint_acceleration) == (0.8, 1.0)
    assert timed.speed.duration == 3.0
    assert arc.via.pose.position == arc.target.pose.position
    assert joint.zone == FINE
    assert run.program.start.joints == tuple(HOME)
    assert (run.robot, run.real, run.name) == ("ur/ur10e", False, "run")
    assert run.notes == ("made up",)
    assert run.q.shape == (2, 6)


def test_ends_that_were_moved_are_taken_from_the_log(tmp_path) -> None:
    checks = {"log_start_to_first_target_mm": 100.0, "log_end_to_last_target_mm": 100.0}
    run = load_run(write(tmp_path, {"checks": checks}), find_robot)
    assert run.program.start.joints == tuple(run.q[0])
    end = find_robot("ur/ur10e").flange_pose(run.q[-1])
    assert run.program.moves[-1].target.pose.position == pytest.approx(end.position)


def test_an_orientation_that_was_not_recorded_is_that_of_the_nearest_sample(tmp_path) -> None:
    path = write(tmp_path)
    data = json.loads(path.read_text("utf-8"))
    del data["moves"][0]["target_pose"]["quat_wxyz"]
    run = load_run(write(tmp_path, {"moves": data["moves"]}), find_robot)
    wanted = find_robot("ur/ur10e").flange_pose(np.array(HOME)).quaternion
    assert run.program.moves[0].target.pose.quaternion == pytest.approx(wanted)


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"robot": "R2-D2"}, "no catalogue robot"),
        ({"moves": [{"type": "Spline", "target_pose": {"xyz_m": [0, 0, 0]}}]}, "unknown type"),
        ({"moves": [{"type": "MoveL"}]}, "target_pose"),
        ({"log": {}}, "file"),
        ({"start_joints_rad": "home"}, "not a run"),
    ],
)
def test_broken_records_name_the_file(tmp_path, change, message) -> None:
    with pytest.raises(InputError, match=rf"run\.json: .*({message})"):
        load_run(write(tmp_path, change), find_robot)


def test_no_json_and_no_file_are_refused(tmp_path) -> None:
    (tmp_path / "run.json").write_text("{", "utf-8")
    for name in ("run.json", "absent.json"):
        with pytest.raises(InputError, match=name):
            load_run(tmp_path / name, find_robot)


@pytest.mark.parametrize(
    "text",
    [
        "[]",
        "3",
        '"x"',
        "{}",
        '{"robot": 3, "log": 4}',
        "[" * 100_000,
        '{"log": {"file": "run.csv"}}',
    ],
)
def test_hostile_records_are_refused_by_name(tmp_path, text) -> None:
    path = write(tmp_path)
    path.write_text(text, "utf-8")
    with pytest.raises(InputError, match=r"run\.json"):
        load_run(path, find_robot)


def test_a_record_may_name_the_catalogue_robot(tmp_path) -> None:
    assert load_run(write(tmp_path, {"robot": "ur/ur10e"}), find_robot).robot == "ur/ur10e"


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("", r"log\.csv: an empty log"),
        ("a,b\n1,2\n", r"log\.csv:1"),
        (
            f"{HEADER}\n0,0,0,0,0,0,0\n0.1,0,0,x,0,0,0\n",
            r"log\.csv:3: column 'q3': 'x' is no number",
        ),
        (f"{HEADER}\n0,0\n0.1,0,0,0,0,0,0\n", r"log\.csv:2: the line has no column 'q2'"),
        (
            f"{HEADER}\n0,0,0,0,0,0,0\n0.1,0,nan,0,0,0,0\n",
            r"log\.csv:3: column 'q2'.*not finite, or beyond any quantity; delete",
        ),
        (f"{HEADER}\n0,0,0,0,0,0,0\n", "two samples"),
        (f"{HEADER}\n", "two samples"),
        (f"{HEADER}\n" + "1,0,0,0,0,0,0\n" * 9, "time stands still"),
        ("t,q1,q2,q4\n0,0,0,0\n1,0,0,0\n", r"column 'q3' is missing"),
        ("t,q1,q2,q2,q3\n0,0,0,0,0\n1,0,0,0,0\n", r"column 'q2' stands 2 times"),
        ("t,q1,q2\n0,0,0\n1,0,0\n", r"2 joints are logged, but ur/ur10e has 6 axes"),
    ],
)
def test_broken_samples_name_file_and_line(tmp_path, text, message) -> None:
    path = tmp_path / "log.csv"
    path.write_text(text, "utf-8")
    with pytest.raises(InputError, match=message):
        read_samples(path, find_robot("ur/ur10e"))


def samples_at(times) -> str:
    return "\n".join([HEADER, *(f"{t},{k},0,0,0,0,0" for k, t in enumerate(times)), ""])


def test_single_samples_whose_time_does_not_increase_are_left_out(tmp_path) -> None:
    path = tmp_path / "log.csv"
    path.write_text(samples_at([0, 0.1, 0.2, 0.15, 0.3, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8]), "utf-8")
    samples = read_samples(path, find_robot("ur/ur10e"))
    assert samples.t.tolist() == [0, 0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8]
    assert samples.q[:, 0].tolist() == [0, 1, 2, 4, 6, 7, 8, 9, 10]
    assert samples.notes == ("2 samples whose time does not increase are left out",)


@pytest.mark.parametrize(
    ("times", "message"),
    [
        ([*np.arange(0, 3, 0.1), *np.arange(0, 3, 0.1)], r"log\.csv:32: time runs back by 2\.9"),
        (np.repeat(np.arange(0, 3, 0.1), 2), "30 of 60 samples does not increase"),
        (np.arange(3, 0, -0.1), r"log\.csv:3: time runs back"),
    ],
)
def test_time_that_is_none_is_refused(tmp_path, times, message) -> None:
    path = tmp_path / "log.csv"
    path.write_text(samples_at(times), "utf-8")
    with pytest.raises(InputError, match=message):
        read_samples(path, find_robot("ur/ur10e"))


def test_a_joint_move_whose_end_was_moved_goes_where_the_log_ends(tmp_path) -> None:
    path = write(tmp_path)
    moves = json.loads(path.read_text("utf-8"))["moves"][:2]
    change = {"moves": moves, "checks": {"log_end_to_last_target_mm": 100.0}}
    run = load_run(write(tmp_path, change), find_robot)
    end = find_robot("ur/ur10e").flange_pose(run.q[-1])
    assert run.program.moves[-1].target.pose.position == pytest.approx(end.position)


def test_a_time_of_zero_is_none(tmp_path) -> None:
    path = write(tmp_path)
    moves = json.loads(path.read_text("utf-8"))["moves"][:2]
    moves[1]["params"]["t"] = 0
    run = load_run(write(tmp_path, {"moves": moves}), find_robot)
    assert (run.program.moves[1].speed.duration, run.program.moves[1].speed.joint) == (None, 0.8)


@pytest.mark.parametrize(
    ("robot", "said", "turn"),
    [
        ("abb/irb6640-180-255", None, ArcOrientation.FOLLOWS_ARC),
        ("kuka/kr3-r540", None, ArcOrientation.FIXED_FRAME),
        ("ur/ur10e", None, ArcOrientation.FIXED_FRAME),
        ("ur/ur10e", "follows_arc", ArcOrientation.FOLLOWS_ARC),
    ],
)
def test_arcs_turn_the_tool_as_the_language_has_it(tmp_path, robot, said, turn) -> None:
    at = {"xyz_m": [0.4, 0.1, 0.5], "quat_wxyz": [0.0, 1.0, 0.0, 0.0]}
    arc = {"type": "MoveC", "target_pose": at, "via_pose": at}
    moves = [arc if said is None else {**arc, "arc_orientation": said}]
    run = load_run(write(tmp_path, {"robot": robot, "moves": moves}), find_robot)
    assert run.program.moves[0].orientation is turn


def test_the_records_of_a_folder_are_parsed_once(tmp_path, monkeypatch) -> None:
    path = write(tmp_path)
    robot = find_robot(load_run(path, find_robot).robot)
    parsed: list[Path] = []

    def counted(file: Path) -> object:
        parsed.append(file)
        return read_json(file)

    monkeypatch.setattr(records, "read_json", counted)
    found = find_runs([tmp_path], find_vendor(robot.name.partition("/")[0]), robot)
    assert len(found.runs) == 1 and parsed == [path]


def test_records_say_whose_runs_they_are(tmp_path) -> None:
    (one := tmp_path / "one").mkdir()
    robot = load_run(write(one), find_robot).robot
    (one / "notes.json").write_text('{"by": "me"}')
    assert robot_of_records([one]) == robot_of_records([one, one / "x.mod"]) == robot
    assert robot_of_records([one / "notes.json", tmp_path / "none.json"]) is None
    (other := tmp_path / "other").mkdir()
    write(other, {"robot": "IRB 6640-180/2.55"})
    said = "runs of abb/irb6640-180-255 and ur/ur10e: give robot, whose"
    with pytest.raises(OptionError, match=said):
        robot_of_records([tmp_path])
