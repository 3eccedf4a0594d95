"""``flyby identify``: a motion model fitted to logs."""

from __future__ import annotations

import json
import re
import shlex
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from typer.testing import Result

from flyby.core.motion.emulator.controller import Controller
from flyby.core.motion.model.blend import Blend
from flyby.core.motion.model.motion_file import load_motion_model
from flyby.core.registry import find_robot, find_vendor
from flyby.identification.fit import Judgement
from flyby.identification.logs.synthetic import Faults, synthetic_run

from ..drawing.page.unpacking import columns, content_of

ROOT = Path(__file__).parents[2]
ROBOT = "abb/irb6640-180-255"
SQUARE = ROOT / "examples" / "square.mod"
FIT = ("--fit", "blend.tcp.beta[0] = -0.3", "--fit", "time.smoothing_s[*] = 0.045")
OTHER_PATH = np.array([0, 0.5, 0.4, -0.3, 0.2, 0.1, 0.4])
TRUE = {"blend.tcp.beta[0]": -0.9, "time.smoothing_s[*]": 0.03}

Flyby = Callable[..., Result]


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A program with a log beside it: how a controller drove that is not the vendor's."""
    vendor, robot = find_vendor("abb"), find_robot(ROBOT)
    model = replace(
        vendor.motion_of(robot),
        tcp=Blend(beta=(-0.9,)),
        smoothing=(0.03,) * 3,
    )
    told = vendor.read_file(SQUARE, None, robot)
    run = synthetic_run(Controller(vendor, robot, model), told, "square", Faults(torn=4), 1)
    out = tmp_path_factory.mktemp("logs")
    (out / "square.mod").write_text(SQUARE.read_text("utf-8"), "utf-8")
    save(out / "square.csv", np.column_stack([run.t, run.q]))
    return out


def save(path: Path, data: np.ndarray, header: str = "t,q1,q2,q3,q4,q5,q6") -> None:
    np.savetxt(path, data, "%.9g", ",", header=header, comments="")


def copied(folder: Path, to: Path, change: Callable[[np.ndarray], np.ndarray]) -> Path:
    """The run with another log."""
    (to / "square.mod").write_text((folder / "square.mod").read_text("utf-8"), "utf-8")
    save(to / "square.csv", change(np.loadtxt(folder / "square.csv", delimiter=",", skiprows=1)))
    return to / "square.mod"


def test_a_model_is_fitted_and_written(flyby: Flyby, folder: Path, tmp_path: Path) -> None:
    out = tmp_path / "params.toml"
    result = flyby(
        "identify", folder, "--robot", ROBOT, "--vendor", "abb", *FIT, "--workers", 1, "--json",
        "--out", out,
    )  # fmt: skip
    assert result.exit_code == 0, result.output
    found = json.loads(result.stdout)
    for one in found["parameters"]:
        assert one["lower"] <= TRUE[one["name"]] <= one["upper"], one
    (run,) = found["runs"]
    assert run["after"]["path_max"] < 0.3 * run["before"]["path_max"]
    assert run["after"]["joint_time_p99"] < run["before"]["joint_time_p99"]
    vendor = find_vendor("abb")
    robot = find_robot(ROBOT)
    made = load_motion_model(out, vendor.motion_of(robot), ROBOT)
    assert made.tcp.beta[0] == pytest.approx(-0.9, abs=0.02)
    origin = made.provenance["blend.tcp.beta"].fit
    assert origin is not None and origin.name == folder.name
    told = shlex.split(origin.command)
    assert told == ["flyby", "identify", folder.name, "--robot", ROBOT, *FIT]
    # The file is what --motion takes: the log is predicted with it.
    again = flyby(
        "compare", folder / "square.mod", folder / "square.csv", "--robot", ROBOT, "--motion", out,
        "--json",
    )  # fmt: skip
    assert again.exit_code == 0, again.output
    assert json.loads(again.stdout)["path_max_m"] == pytest.approx(
        run["after"]["path_max"], rel=0.1
    )


def test_tables(flyby: Flyby, folder: Path) -> None:
    result = flyby("identify", folder / "square.mod", "--robot", ROBOT, *FIT, "--workers", 1)
    assert result.exit_code == 0, result.output
    for text in ("blend.tcp.beta[0]", "path max, mm", "cycle time ratio", "square", "→"):
        assert text in result.stdout
    # One of the four that were torn may be where nothing moves.
    assert re.search(r"square: [34] samples off the path", result.stderr)


@pytest.mark.parametrize(
    ("change", "message"),
    [
        (lambda data: data[: len(data) // 2], "shorter than the program"),
        (lambda data: np.column_stack([data[:, 0], np.degrees(data[:, 1:])]), "degrees"),
        (lambda data: np.column_stack([1e3 * data[:, 0], data[:, 1:]]), "time in"),
        (lambda data: np.concatenate([data[50:], data[:50]]), "time runs back"),
        (lambda data: data + OTHER_PATH, "does not follow this program"),
    ],
    ids=["short", "degrees", "milliseconds", "backwards", "elsewhere"],
)
def test_logs_that_are_no_runs_of_the_program(
    flyby: Flyby,
    folder: Path,
    tmp_path: Path,
    change: Callable[[np.ndarray], np.ndarray],
    message: str,
) -> None:
    program = copied(folder, tmp_path, change)
    result = flyby("identify", program, "--robot", ROBOT, *FIT)
    assert result.exit_code == 1
    assert "square" in result.stderr and message in result.stderr


@pytest.mark.parametrize(
    ("header", "message"),
    [
        ("t,q1,q2,q3,q4,q5,q5", "q5"),
        ("t,q1,q2,q3,q4,q5,other", "5 joints are logged"),
        ("q1,q2,q3,q4,q5,q6,other", "no known form of log"),
    ],
)
def test_columns_that_are_missing_or_double(
    flyby: Flyby, folder: Path, tmp_path: Path, header: str, message: str
) -> None:
    program = copied(folder, tmp_path, lambda data: data)
    data = np.loadtxt(folder / "square.csv", delimiter=",", skiprows=1)
    save(tmp_path / "square.csv", data, header)
    result = flyby("identify", program, "--robot", ROBOT, *FIT)
    assert result.exit_code == 1 and message in result.stderr


@pytest.mark.parametrize(
    ("status", "arguments", "message"),
    [
        (1, ("--robot", ROBOT, "--vendor", "kuka"), "is driven by abb"),
        (2, ("--robot", ROBOT, "--fit", "time.nonsense"), "--fit: unknown key of a motion model"),
        (2, ("--robot", ROBOT, "--fit", "zone.overlap"), "is not fitted"),
        (2, ("--robot", ROBOT, "--fit", "time.settling_s = x"), "'x' is no number"),
        (2, ("--robot", ROBOT, "--fit", "time.smoothing_s[a]"), "an index is [2]"),
        (1, ("--robot", ROBOT, "--fit", "torque.carried[7].share_s2_per_m2[0]"), "states nothing"),
        (2, (), "which robot"),
    ],
)
def test_refusals(
    flyby: Flyby, folder: Path, status: int, arguments: tuple[str, ...], message: str
) -> None:
    result = flyby("identify", folder, *arguments)
    assert result.exit_code == status and message in result.stderr


def test_no_runs(flyby: Flyby, tmp_path: Path) -> None:
    result = flyby("identify", tmp_path, "--robot", ROBOT)
    assert result.exit_code == 1 and "no run of abb/irb6640-180-255" in result.stderr
    (tmp_path / "lonely.mod").write_text(SQUARE.read_text("utf-8"), "utf-8")
    result = flyby("identify", tmp_path / "lonely.mod", "--robot", ROBOT)
    assert result.exit_code == 1 and "no log of the same name" in result.stderr


def test_the_page_of_a_fit(flyby: Flyby, folder: Path, tmp_path: Path) -> None:
    """Each run with its program's text beside it, before and after the fit and as measured, on one
    clock or by waypoint."""
    path = tmp_path / "fit.html"
    result = flyby(
        "identify", folder / "square.mod", "--robot", ROBOT, *FIT, "--workers", 1, "--report", path
    )
    assert result.exit_code == 0, result.output
    content, arrays = content_of(path.read_bytes())
    tracks = content["tracks"]
    assert [track["name"] for track in tracks] == ["before the fit", "after it", "measured"]
    for k, track in enumerate(tracks[:2]):
        for move in track["moves"]:
            source = content["sources"][move["source"]]
            assert source.get("track", 0) == k and source["name"] == "square.mod"
            assert source["text"].splitlines()[move["line"] - 1].split()[0] == (
                "MoveAbsJ" if "home" in move["label"] else move["label"].split()[0]
            )
    motion = [source for source in content["sources"] if source["name"] == "motion file"]
    assert [source.get("track", 0) for source in motion] == [0, 1, 2]
    # What was fitted is where the log is at the log's own times, what was before it is not.
    before, after, measured = (columns(arrays, track["meets"]) for track in tracks)
    assert len(before) == len(after) == len(measured)
    assert np.abs(after - measured).max() < 0.02 < np.abs(before - measured).max()


def test_no_file_is_replaced_unasked(flyby: Flyby, folder: Path, tmp_path: Path) -> None:
    out = tmp_path / "params.toml"
    out.write_text("mine")
    result = flyby("identify", folder, "--robot", ROBOT, *FIT, "--out", out)
    assert result.exit_code == 1 and "--force" in result.stderr
    assert out.read_text() == "mine"
    inside = folder / "square.csv"
    result = flyby("identify", folder, "--robot", ROBOT, *FIT, "--out", inside, "--force")
    assert result.exit_code == 1 and "would overwrite" in result.stderr


def test_a_record_of_another_robot(flyby: Flyby, folder: Path, tmp_path: Path) -> None:
    record = tmp_path / "run.json"
    record.write_text(json.dumps({"robot": "UR10e", "moves": [], "log": {"file": "x.csv"}}))
    result = flyby("identify", folder, record, "--robot", ROBOT, *FIT)
    assert result.exit_code == 1


JOINTS = """MODULE joints
  PROC main()
    MoveAbsJ [[0,0,0,0,30,0],[9E9,9E9,9E9,9E9,9E9,9E9]], v500, fine, tool0;
    MoveAbsJ [[30,20,10,20,30,40],[9E9,9E9,9E9,9E9,9E9,9E9]], v500, z10, tool0;
    MoveAbsJ [[-20,10,-10,-20,50,-40],[9E9,9E9,9E9,9E9,9E9,9E9]], v500, fine, tool0;
  ENDPROC
ENDMODULE
"""
SCRIPT = """def prog():
  set_tcp(p[0,0,0,0,0,0])
  movej([0,-1.57,1.57,-1.57,-1.57,0], a=1.4, v=1.05)
  movel(p[0.4,-0.3,0.4,0,3.14,0], a=1.2, v=0.25, r=0.05)
  movel(p[0.4,0.1,0.4,0,3.14,0], a=1.2, v=0.25, r=0.05)
  movel(p[0.6,0.1,0.5,0,3.14,0], a=1.2, v=0.25)
end
"""


@pytest.mark.parametrize(
    ("name", "text", "robot"),
    [("joints.mod", JOINTS, "abb/irb1200-5-090"), ("prog.script", SCRIPT, "ur/ur10e")],
)
def test_robots_whose_lists_are_empty_are_fitted(
    flyby: Flyby, tmp_path: Path, name: str, text: str, robot: str
) -> None:
    """Without --fit; figures that the log does not show stay as they are, and lists that are
    empty stay so."""
    program = tmp_path / name
    program.write_text(text, "utf-8")
    vendor, arm = find_vendor(robot.split("/")[0]), find_robot(robot)
    truth = replace(vendor.motion_of(arm), smoothing=(0.03,))
    told = vendor.read_file(program, None, arm)
    run = synthetic_run(Controller(vendor, arm, truth), told, "run", Faults(), 1)
    save(program.with_suffix(".csv"), np.column_stack([run.t, run.q]))
    out = tmp_path / "out.toml"
    result = flyby("identify", program, "--robot", robot, "--workers", 1, "--out", out, "--json")
    assert result.exit_code == 0, result.stderr
    found = json.loads(result.stdout)
    assert found["loss_after"] < 0.2 * found["loss_before"]
    assert found["held_back"]["better"] and found["held_back"]["by_corners"]
    unseen = {one["name"] for one in found["not_identifiable"]}
    assert "limit.joint_acceleration_scale[5]" in unseen
    made = load_motion_model(out, vendor.motion_of(arm), robot)
    assert made.smoothing == pytest.approx((0.03,), abs=2e-3)


def test_a_log_that_is_only_slower_is_not_explained_by_physics(
    flyby: Flyby, folder: Path, tmp_path: Path
) -> None:
    def slower(data: np.ndarray) -> np.ndarray:
        return np.column_stack([1.02 * data[:, 0], data[:, 1:]])

    program = copied(folder, tmp_path, slower)
    result = flyby("identify", program, "--robot", ROBOT, *FIT, "--workers", 1, "--json")
    assert result.exit_code == 0, result.output
    found = json.loads(result.stdout)
    for one in found["parameters"]:
        assert one["value"] == pytest.approx(TRUE[one["name"]], rel=0.05)
    (scale,) = found["time_scales"]
    assert "took 2.0 % longer than emulated, evenly" in scale["says"]
    assert "check override and clock" in scale["says"]


def test_a_model_that_predicts_worse_is_not_written_unforced(
    flyby: Flyby, folder: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    worse = Judgement(("square",), (0.1,), (0.2,), (0.1,), (0.2,), True, ("runs at 50 mm/s",))
    monkeypatch.setattr("flyby.identification.fit.holding.judge", lambda *given: worse)
    out, report = tmp_path / "params.toml", tmp_path / "page.html"
    words = ("identify", folder, "--robot", ROBOT, *FIT, "--workers", 1, "--out", out)
    result = flyby(*words, "--report", report)
    told = " ".join(result.stderr.split())
    assert result.exit_code == 1 and not out.exists()
    for text in ("predicts worse", "0.1 → 0.2", "runs at 50 mm/s", "--force writes it"):
        assert text in told
    assert "predicts worse" in report.read_text("utf-8")
    assert flyby(*words, "--force").exit_code == 0 and out.exists()
