"""What is given to the command line ends in a message, whatever it is."""

from __future__ import annotations

import json
import os
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st
from typer.testing import Result

from flyby.core.errors import InputError
from flyby.core.registry import find_robot
from flyby.identification.logs import load_run

ROBOT = "abb/irb6640-180-255"
Flyby = Callable[..., Result]
LONG = "n" * 300


def _refused(result: Result, *words: str) -> None:
    assert result.exit_code == 1, result.output
    assert result.stderr.startswith("error: ")
    assert len(result.stderr) < 2000
    for word in words:
        assert word in result.stderr.replace("\n", "")


@pytest.mark.parametrize("value", ["1e300", "1e308", "-1e13", "9" * 400, "nan", "1e400"])
def test_numbers_beyond_all_quantities(flyby: Flyby, small: Any, value: str) -> None:
    start = f"{value},0,0,0,30,0"
    for words in (
        ("emulate", small(), "--robot", ROBOT, "--start", start),
        ("fk", ROBOT, start),
        ("ik", ROBOT, f"{value},0,0"),
    ):
        result = flyby(*words)
        assert result.exit_code == 2
        assert "must lie within" in result.stderr or "is not finite" in result.stderr


@pytest.mark.parametrize(
    "words",
    [
        ("emulate", f"{LONG}.mod", "--robot", ROBOT),
        ("emulate", "SMALL", "--robot", ROBOT, "--write", f"{LONG}.mod"),
        ("emulate", "SMALL", "--robot", ROBOT, "--csv", f"{LONG}.csv"),
        ("emulate", "SMALL", "--robot", ROBOT, "--plot", f"{LONG}.png"),
        ("emulate", "SMALL", "--robot", ROBOT, "--motion", f"{LONG}.toml"),
        ("emulate", "SMALL", "--robot", ROBOT, "--io", f"{LONG}.toml"),
        ("emulate", "SMALL", "--cell", f"{LONG}.toml"),
        ("translate", "SMALL", "--from", ROBOT, "--robot", "ur/ur5e", "--out", LONG),
        ("experiment", "--robot", ROBOT, "--out", LONG),
        ("identify", f"{LONG}.json", "--robot", ROBOT),
        ("compare", f"{LONG}.json", "--robot", ROBOT),
    ],
)
def test_names_too_long_for_files(flyby: Flyby, small: Any, words: tuple[str, ...]) -> None:
    given_words = (small() if word == "SMALL" else word for word in words)
    _refused(flyby(*given_words), "File name too long")


def test_pipes_instead_of_files(flyby: Flyby, small: Any, tmp_path: Path) -> None:
    for name in ("pipe.mod", "pipe.toml", "pipe.json"):
        os.mkfifo(tmp_path / name)
    program, table, run = (tmp_path / f"pipe.{end}" for end in ("mod", "toml", "json"))
    for words in (
        ("emulate", program, "--robot", ROBOT),
        ("emulate", small(), "--robot", ROBOT, "--motion", table),
        ("emulate", small(), "--robot", ROBOT, "--io", table),
        ("emulate", small(), "--cell", table),
        ("compare", run, "--robot", ROBOT),
    ):
        _refused(flyby(*words), "is no regular file but a pipe")


RECORD = {
    "robot": ROBOT,
    "log": {"file": "log.csv"},
    "start_joints_rad": [0, 0, 0, 0, 0.5, 0],
    "moves": [
        {
            "type": "MoveJ",
            "target_joints_rad": [0.1, 0, 0, 0, 0.5, 0],
            "zone": {"fine": True},
            "speed": {"joint_fraction": 0.5},
        },
        {
            "type": "MoveL",
            "target_pose": {"xyz_m": [1.5, 0.2, 1.4], "quat_wxyz": [0, 0, 1, 0]},
            "zone": {"radius_m": 0.01},
            "speed": {"tcp_mps": 0.2},
        },
    ],
}
WRONG = st.sampled_from(
    [None, True, [], {}, "x", 1e308, -1, 1e300, 10**18, [[]], {"a": 1}, "n" * 500, "\x00"]
)


def _places(value: Any, way: tuple[Any, ...] = ()) -> list[tuple[Any, ...]]:
    inner = (
        value.items()
        if isinstance(value, dict)
        else enumerate(value)
        if isinstance(value, list)
        else ()
    )
    return [one for key, sub in inner for one in ((*way, key), *_places(sub, (*way, key)))]


def test_a_record_that_is_no_object_is_called_so(tmp_path: Path) -> None:
    path = tmp_path / "run.json"
    path.write_text("[1, 2, 3]")
    with pytest.raises(InputError, match=r"run\.json: not a run: an object with robot, log"):
        load_run(path, find_robot)


@settings(max_examples=150, suppress_health_check=[HealthCheck.function_scoped_fixture])
@given(place=st.sampled_from(_places(RECORD)), wrong=WRONG)
def test_records_with_wrong_types(tmp_path: Path, place: tuple[Any, ...], wrong: Any) -> None:
    data = json.loads(json.dumps(RECORD))
    inner = data
    for key in place[:-1]:
        inner = inner[key]
    inner[place[-1]] = wrong
    rows = "".join(f"{0.008 * k},{0.001 * k},0,0,0,0.5,0\n" for k in range(20))
    (tmp_path / "log.csv").write_text("t,q1,q2,q3,q4,q5,q6\n" + rows)
    path = tmp_path / "run.json"
    path.write_text(json.dumps(data))
    try:
        load_run(path, find_robot)
    except InputError as error:
        assert "run.json" in str(error)
