"""``flyby experiment``: programs and records in a folder, and logs that come back."""

from __future__ import annotations

import json
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from typer.testing import Result

from flyby.core.motion.emulator.controller import Controller
from flyby.core.motion.model.blend import Blend
from flyby.core.program.move import MoveJ, MoveL
from flyby.core.program.program import Program
from flyby.core.program.target import JointTarget
from flyby.core.registry import find_robot, find_vendor

ROOT = Path(__file__).parents[2]
Flyby = Callable[..., Result]
SMALL = (
    *("--postures", 1, "--angles", "60,110", "--zones", "8,20", "--speeds", 200),
    *("--minutes", 10, "--kinds", "lines,joints"),
)


@pytest.fixture(scope="module")
def folders(tmp_path_factory: pytest.TempPathFactory) -> Callable[[str], Path]:
    """The folder of a small experiment of a robot, written once."""
    from typer.testing import CliRunner

    from flyby.cli.main import app

    made: dict[str, Path] = {}

    def folder(robot: str) -> Path:
        if robot not in made:
            made[robot] = tmp_path_factory.mktemp("experiment") / "runs"
            words = ["experiment", "--robot", robot, "--out", made[robot], *SMALL]
            result = CliRunner().invoke(app, [str(word) for word in words])
            assert result.exit_code == 0, result.output
        return made[robot]

    return folder


@pytest.mark.parametrize("robot", ["abb/irb6640-180-255", "kuka/kr3-r540", "ur/ur5e"])
def test_a_folder_holds_programs_records_a_page_and_a_picture(folders, robot: str) -> None:
    folder = folders(robot)
    names = sorted(path.stem for path in folder.glob("*.json"))
    assert [name[:3] for name in names] == ["01_", "02_"]
    assert {name[3:] for name in names} == {"p1_line_v200_1", "p1_joint_v200_1"}
    page = (folder / "experiment.html").read_text("utf-8")
    assert "data:image/png;base64," in page and "Safety" in page
    program = {f"program/{path.name}" for path in (folder / "program").iterdir()}
    suffix = {"abb": ".mod", "kuka": ".src", "ur": ".script"}[robot.partition("/")[0]]
    assert f"program/flyby_runs{suffix}" in program
    text = (folder / f"program/flyby_runs{suffix}").read_text("utf-8")
    for name in names:
        told = json.loads((folder / f"{name}.json").read_text("utf-8"))
        assert f"{name}.csv" in page and told["log"]["file"] == f"{name}.csv"
        assert set(told["program"]) == program and text.count(f'{name}.csv"') >= 1
        assert len(told["design"]["corners"]) == 4 and len(told["moves"]) == 9


@pytest.mark.parametrize("away", [0.1, 0.0])
def test_a_log_that_comes_back_is_compared(
    folders, flyby: Flyby, tmp_path: Path, away: float
) -> None:
    """A controller with another motion model drives the run, from elsewhere or from its start, and
    logs it with noise: with the model that it has, what is left is the noise."""
    robot, vendor = find_robot("ur/ur5e"), find_vendor("ur")
    (found,) = folders(robot.name).glob("*_p1_joint_v200_1.json")
    name = found.stem
    record = tmp_path / f"{name}.json"
    record.write_bytes(found.read_bytes())
    whole = vendor.read_file(found.parent / "program" / "flyby_runs.script", robot=robot)
    counts = [
        len(json.loads(path.read_text("utf-8"))["moves"])
        for path in sorted(found.parent.glob("*.json"))
    ]
    begin = sum(counts[: int(name[:2]) - 1])
    program = Program(whole.moves[begin : begin + counts[int(name[:2]) - 1]])
    model = replace(vendor.motion_of(robot), joint=Blend(beta=(1.5,)), smoothing=(0.04,))
    start = JointTarget(tuple(value + away for value in program.moves[0].target.joints))
    driven = Controller(vendor, robot, model).run(program, start, 0.008).trajectory
    noise = np.random.default_rng(3).normal(0, 2e-6, driven.q.shape)
    rows = np.column_stack([100.0 + driven.t, driven.q + noise])
    header = ",".join(["t", *(f"q{k}" for k in range(1, 7))])
    np.savetxt(tmp_path / f"{name}.csv", rows, "%.9g", ",", header=header, comments="")
    motion = tmp_path / "motion.toml"
    motion.write_text(
        '[blend.joint]\nkind = "polynomial"\nbeta = [1.5]\n[time]\nsmoothing_s = 0.04\n'
    )

    def compared(*options: object) -> dict:
        result = flyby("compare", record, "--json", *options)
        assert result.exit_code == 0, result.output
        return json.loads(result.stdout)

    today, known = compared(), compared("--motion", motion)
    assert known["run"] == name and known["robot"] == robot.name
    assert known["path_max_m"] < 3e-5 and known["joint_time_p99_rad"] < 1e-4
    assert known["cycle_time_ratio"] == pytest.approx(1.0, abs=2e-3)
    assert today["path_max_m"] > 1e-3
    assert known["torn"] == 0 and known["compared"] > 0.8 * len(rows)


def test_a_run_without_its_log_says_what_is_missing(folders, flyby: Flyby) -> None:
    (record,) = folders("ur/ur5e").glob("*_p1_line_v200_1.json")
    result = flyby("compare", record)
    assert result.exit_code == 1 and f"{record.stem}.csv" in result.stderr


def test_files_are_replaced_only_when_told(folders, flyby: Flyby) -> None:
    folder = folders("ur/ur5e")
    words = ("experiment", "--robot", "ur/ur5e", "--out", folder, *SMALL)
    before = {path: path.read_bytes() for path in folder.rglob("*") if path.is_file()}
    result = flyby(*words)
    assert result.exit_code == 1 and "--force replaces it" in result.stderr
    result = flyby(*words, "--force", "--json")
    assert result.exit_code == 0, result.output
    told = json.loads(result.stdout)
    assert {run["name"] for run in told["runs"]} == {"p1_line_v200_1", "p1_joint_v200_1"}
    assert told["seconds_s"] < 600 and set(told["files"]) == set(map(str, before))
    after = {path: path.read_bytes() for path in before}
    assert after == before


@pytest.mark.parametrize(
    ("status", "options", "message"),
    [
        (2, ("--kinds", "splines"), "--kinds splines: lines, joints"),
        (2, ("--kinds", "rests"), "--kinds rests: lines, joints"),
        (2, ("--about", "turns"), "--kinds and --about: a topic says"),
        (2, ("--tool", "gun"), "give --cell"),
        (2, ("--angles", "0"), "--angles: 0° does not lie between 0 and 180°"),
        (2, ("--speeds", "100,-5"), "--speeds: -5 mm/s does not lie between 0 and 1e+04 mm/s"),
        (2, ("--zones", "5,5"), "--zones: one is given twice"),
        (2, ("--angles", ""), "--angles: an experiment needs at least one"),
        (2, ("--postures", "0"), "--postures: an experiment has 1 to 99, not 0"),
        (2, ("--margin", "0"), "--margin: must be above zero"),
        (2, ("--period", "8"), "--period 8: seconds from 0.001 to 1"),
        (2, ("--zones", "a"), "--zones: 'a' is no number"),
        (1, ("--at", "0,0,0"), "has 6 axes"),
        (1, ("--at", "0,-90,0,-90,0,0"), "singular"),
        (2, ("--minutes", "0"), "--minutes 0: a number above zero"),
        (1, ("--period", "0.003"), "cycles of 0.002 s"),
    ],
)
def test_what_is_no_use_is_refused(
    flyby: Flyby, tmp_path: Path, status: int, options: tuple[str, ...], message: str
) -> None:
    out = tmp_path / "runs"
    result = flyby("experiment", "--robot", "ur/ur5e", "--out", out, *SMALL, *options)
    assert result.exit_code == status and message in " ".join(result.stderr.split())
    assert not out.exists()


@pytest.mark.parametrize(
    ("asked", "message"),
    [
        ("speed", "--about speed: short-legs, turns, postures, reversals, blends, drag"),
        (" , ", "--about: name at least one of short-legs"),
    ],
)
def test_unknown_questions_name_the_known(
    flyby: Flyby, tmp_path: Path, asked: str, message: str
) -> None:
    out = tmp_path / "runs"
    result = flyby("experiment", "--robot", "ur/ur5e", "--out", out, "--about", asked)
    assert result.exit_code == 2 and message in " ".join(result.stderr.split())
    assert not out.exists()


def test_runs_about_questions_come_with_a_plan(flyby: Flyby, tmp_path: Path) -> None:
    out = tmp_path / "runs"
    words = ("--about", "postures,reversals", "--postures", 1, "--minutes", 4)
    result = flyby("experiment", "--robot", "kuka/kr3-r540", "--out", out, *words, "--json")
    assert result.exit_code == 0, result.output
    told = json.loads(result.stdout)
    plan = json.loads((out / "plan.json").read_text("utf-8"))
    names = [run["run"] for run in plan["runs"]]
    assert names == [run["name"] for run in told["runs"]] and "p1_rest" in names
    clock = 0.0
    for number, (run, again) in enumerate(zip(plan["runs"], told["runs"], strict=True), 1):
        record = json.loads((out / f"{number:02}_{run['run']}.json").read_text("utf-8"))
        assert run["about"] == again["about"] == record["design"]["about"]
        assert run["figures"] == record["design"]["figures"] and run["question"].endswith("?")
        assert run["over_at_s"] == pytest.approx(clock + run["duration_s"] + 20.0)
        clock = run["over_at_s"]
        for other in run["instead"]:
            changed = (abs(other["longer_s"]), other["apart_m"], other["joints_rad"] or 0.0)
            assert other["if"] and max(changed) > 1e-6
    rest = next(run for run in plan["runs"] if run["about"] == "postures")
    assert any("80 %" in other["if"] and other["longer_s"] > 0.05 for other in rest["instead"])
    text = (out / "experiment.html").read_text("utf-8")
    assert "<h2>What the runs are for</h2>" in text and "<h3>reversals</h3>" in text


def test_a_cell_and_a_posture_are_taken(flyby: Flyby, tmp_path: Path) -> None:
    cell = tmp_path / "cell.toml"
    cell.write_text(
        'robot = "kuka/kr3-r540"\nclearance_mm = 8\n'
        "base = { xyz_mm = [200, 0, 500], abc_deg = [90, 0, 0] }\n"
        "[tool.pin]\ntcp = { xyz_mm = [10, 0, 90] }\ncapsule_mm = [8, 60]\n"
        "pose = { xyz_mm = [0, 0, 40] }\n[allow]\npairs = [['A6', 'pin'], ['A5', 'pin']]\n"
        '[[obstacle]]\nname = "floor"\nbox_mm = [2000, 2000, 20]\n'
        "pose = { xyz_mm = [0, 0, 0] }\n",
        "utf-8",
    )
    out = tmp_path / "runs"
    at = "10,-80,100,20,60,30"
    words = ("experiment", "--cell", cell, "--tool", "pin", "--out", out, "--at", at, *SMALL)
    result = flyby(*words, "--json")
    assert result.exit_code == 0, result.output
    told = json.loads(result.stdout)
    assert told["postures_rad"] == [pytest.approx(np.radians([float(v) for v in at.split(",")]))]
    assert told["notes"] == [] and all("proven" in run["clearance"] for run in told["runs"])
    (path,) = out.glob("*_p1_line_v200_1.json")
    record = json.loads(path.read_text("utf-8"))
    assert record["tool"]["xyz_m"] == [0.01, 0.0, 0.09]
    vendor, robot = find_vendor("kuka"), find_robot("kuka/kr3-r540")
    source = out / "program" / "flyby_runs.src"
    read = vendor.read_file(source, robot=robot)
    assert read.moves[1].tool.tcp.position == pytest.approx((0.01, 0.0, 0.09))
    assert isinstance(read.moves[0], MoveJ) and isinstance(read.moves[1], MoveL)
