"""``flyby compare``: a log against the emulation of its program."""

from __future__ import annotations

import json
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
from typer.testing import Result

ROOT = Path(__file__).parents[2]
ROBOT = "abb/irb6640-180-255"
SQUARE = ROOT / "examples" / "square.mod"

Flyby = Callable[..., Result]


@pytest.fixture
def log(flyby: Flyby, tmp_path: Path) -> Path:
    """The emulation's own trajectory, from the first target on, as a log with a late clock."""
    path = tmp_path / "emulated.csv"
    result = flyby("emulate", SQUARE, "--robot", ROBOT, "--period", "0.008", "--csv", path)
    assert result.exit_code == 0, result.output
    # Controllers log the motors.
    data = np.loadtxt(path, delimiter=",", skiprows=1)[:, [0, *range(-6, 0)]]
    rest = np.repeat(data[[0]], 20, axis=0)
    rest[:, 0] = 0.008 * np.arange(-20, 0)
    data = np.concatenate([rest, data])
    data[:, 0] += 100.0
    path = tmp_path / "log.csv"
    save(path, data)
    return path


def save(path: Path, data: np.ndarray, header: str = "t,q1,q2,q3,q4,q5,q6") -> None:
    np.savetxt(path, data, "%.9g", ",", header=header, comments="")


def load(path: Path) -> np.ndarray:
    return np.loadtxt(path, delimiter=",", skiprows=1)


def test_a_log_of_the_emulation_is_predicted(flyby: Flyby, log: Path) -> None:
    result = flyby("compare", SQUARE, log, "--robot", ROBOT, "--json")
    assert result.exit_code == 0, result.output
    found = json.loads(result.stdout)
    assert found["robot"] == ROBOT and found["run"] == "log"
    assert found["path_max_m"] < 1e-5
    assert found["joint_path_max_rad"] < 1e-5
    assert found["joint_time_max_rad"] < 1e-3
    # The clock counts from the first sample, which is 20 periods before the motion.
    assert found["offset_s"] == pytest.approx(0.16, abs=1e-3)
    assert found["cycle_time_ratio"] == pytest.approx(1.0, abs=0.01)
    assert (found["torn"], found["held"], found["holes"], found["notes"]) == (0, 0, [], [])
    assert len(found["axes"]) == 6
    assert found["as_read"] is None


def test_faults_are_warned_of_and_shown(flyby: Flyby, log: Path, tmp_path: Path) -> None:
    data = load(log)
    speed = np.abs(np.diff(data[:, 1:], axis=0)).max(axis=1)
    torn = int(np.argmax(speed[60:-60])) + 60
    data[torn, 1:4] = data[torn - 1, 1:4]
    data = np.delete(data, slice(torn + 20, torn + 40), axis=0)
    save(log, data)
    plot = tmp_path / "picture.svg"
    result = flyby("compare", SQUARE, log, "--robot", ROBOT, "--plot", plot)
    assert result.exit_code == 0, result.output
    assert "1 samples off the path" in result.stderr and "1 holes" in result.stderr
    assert "path of the TCP, mm" in result.stdout and "1 off the path" in result.stdout
    assert f"wrote {plot}" in result.stdout
    text = plot.read_text("utf-8")
    assert text.startswith("<?xml") and len(text) > 50_000
    assert flyby("compare", SQUARE, log, "--robot", ROBOT, "--plot", plot).exit_code == 1


def test_what_was_read_stands_beside_samples_put_together(
    flyby: Flyby, log: Path, tmp_path: Path
) -> None:
    data = load(log)
    late = np.stack([np.interp(data[:, 0] + 0.004, data[:, 0], q) for q in data[:, 1:].T], -1)
    breaks = np.random.default_rng(0).integers(1, 6, len(data))
    data[:, 1:] = np.where(np.arange(6) >= breaks[:, None], late, data[:, 1:])
    save(log, data)
    words = ("compare", SQUARE, log, "--robot", ROBOT)
    found = json.loads(flyby(*words, "--json").stdout)
    assert found["as_read"]["path_p99_m"] > 5 * found["path_p99_m"]
    assert any("mix joints of two cycles" in note for note in found["notes"])
    result = flyby(*words)
    assert "mix joints of two cycles" in " ".join(result.stderr.split())
    assert "path of the TCP, mm, as read" in result.stdout


def test_columns_are_mapped_by_a_file(flyby: Flyby, log: Path, tmp_path: Path) -> None:
    data = load(log)
    data[:, 0] *= 1e3
    data[:, 1:] = np.degrees(data[:, 1:])
    save(log, data, "ms,a,b,c,d,e,f")
    columns = tmp_path / "columns.toml"
    columns.write_text(
        'time = { column = "ms", unit = "ms" }\n'
        'joints = { columns = ["a", "b", "c", "d", "e", "f"], unit = "deg" }\n',
        "utf-8",
    )
    words = ("compare", SQUARE, log, "--robot", ROBOT, "--json", "--columns", columns)
    assert json.loads(flyby(*words).stdout)["path_max_m"] < 1e-5


def test_what_does_not_belong_is_refused_with_the_reason(flyby: Flyby, log: Path) -> None:
    data = load(log)
    words = ("compare", SQUARE, log, "--robot", ROBOT)
    save(log, np.column_stack([data[:, 0], np.degrees(data[:, 1:])]))
    result = flyby(*words)
    assert result.exit_code == 1 and "seem to be in degrees" in result.stderr
    save(log, np.column_stack([data[:, 0], np.radians(data[:, 1:])]))
    result = flyby(*words)
    assert result.exit_code == 1 and "were taken for degrees" in result.stderr
    save(log, data[: len(data) // 2])
    result = flyby(*words)
    assert result.exit_code == 1 and "shorter than the program" in result.stderr
    save(log, data[:, :6], "t,q1,q2,q3,q4,q5")
    result = flyby(*words)
    assert result.exit_code == 1 and "5 joints are logged" in result.stderr


def test_a_record_brings_its_program_and_log(flyby: Flyby, log: Path, tmp_path: Path) -> None:
    data = load(log)[:, 1:]
    record = tmp_path / "run.json"
    turn = [float(v) for v in data[0] + np.array([0.3, 0, 0, 0, 0, 0])]
    told = {
        "robot": "ur/ur10e",
        "start_joints_rad": data[0].tolist(),
        "log": {"file": "turn.csv"},
        "moves": [{"type": "MoveJ", "target_joints_rad": turn, "params": {"v": 0.5, "a": 1.0}}],
    }
    t = np.arange(0, 2, 0.008)
    share = np.clip((t - 0.5) / 0.8, 0, 1)[:, None]
    share = share**2 * (3 - 2 * share)
    save(tmp_path / "turn.csv", np.column_stack([t, (1 - share) * data[0] + share * turn]))
    record.write_text(json.dumps(told), "utf-8")
    found = json.loads(flyby("compare", record, "--json").stdout)
    assert found["robot"] == "ur/ur10e"
    assert found["path_max_m"] < 1e-5
    result = flyby("compare", record, log)
    assert result.exit_code == 1 and "names its log" in result.stderr
    result = flyby("compare", record, "--robot", ROBOT)
    assert result.exit_code == 1 and "one of ur/ur10e" in result.stderr


def test_a_program_without_a_log_is_asked_for_it(flyby: Flyby) -> None:
    result = flyby("compare", SQUARE, "--robot", ROBOT)
    assert result.exit_code == 2 and "which log?" in result.stderr


def test_a_clock_or_an_override_is_found_to_explain_a_log(flyby: Flyby, log: Path) -> None:
    data = load(log)
    data[:, 0] = data[0, 0] + 1.02 * (data[:, 0] - data[0, 0])
    save(log, data)
    words = ("compare", SQUARE, log, "--robot", ROBOT)
    found = json.loads(flyby(*words, "--json").stdout)
    assert found["time_scale"]["cause"] == "clock"
    assert found["time_scale"]["value"] == pytest.approx(1.02, abs=1e-3)
    told = " ".join(flyby(*words).stderr.split())
    assert "the robot took 2.0 % longer than emulated, evenly: check override and clock" in told
