"""Reading logged runs, on files made here."""

from __future__ import annotations

import json

import numpy as np
import pytest

from flyby.core.errors import InputError
from flyby.core.program.move import MoveC, MoveJ, MoveL
from flyby.core.program.zone import FINE, Radius
from flyby.core.registry import find_robot
from flyby.identification.logs import load_run, load_samples

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
    assert (run.robot, run.real, run.note, run.name) == ("ur/ur10e", False, "made up", "run")
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
    ("text", "message"),
    [
        ("", r"log\.csv:1"),
        ("a,b\n1,2\n", r"log\.csv:1"),
        ("t,q1\n0,0\n0.1,x\n", r"log\.csv:3"),
        ("t,q1\n0,0\n0.1\n", r"log\.csv:3"),
        ("t,q1\n0,0\n0.1,nan\n", r"log\.csv:3"),
        ("t,q1\n0,0\n", "two samples"),
    ],
)
def test_broken_samples_name_file_and_line(tmp_path, text, message) -> None:
    path = tmp_path / "log.csv"
    path.write_text(text, "utf-8")
    with pytest.raises(InputError, match=message):
        load_samples(path)


def test_samples_whose_time_does_not_increase_are_left_out(tmp_path) -> None:
    path = tmp_path / "log.csv"
    path.write_text("t,q1\n0,0\n0.2,1\n0.1,2\n0.2,3\n0.3,4\n", "utf-8")
    t, q = load_samples(path)
    assert t.tolist() == [0, 0.2, 0.3] and q[:, 0].tolist() == [0, 1, 4]


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
