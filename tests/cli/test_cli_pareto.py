"""``flyby pareto``: what it prints, what it writes where, and what it refuses."""

from __future__ import annotations

import json
from collections.abc import Callable
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest
from typer.testing import Result

from flyby.core.motion.emulator.controller import Controller
from flyby.core.registry import find_robot, find_vendor
from flyby.tasks.results import fronts

ROBOT = "abb/irb6640-180-255"
REST = "[9E9,9E9,9E9,9E9,9E9,9E9]"
POINTS = ((-4.19, 69.06), (-21.07, 62.34), (22.3, 18.62))
PROGRAM = "\r\n".join(
    (
        "MODULE m ! keep me",
        *(
            f"  CONST jointtarget p{k}:=[[0,{a},{b},0,0,0],{REST}];"
            for k, (a, b) in enumerate(POINTS)
        ),
        "  PROC main()",
        "    MoveAbsJ p0,v1000,fine,tool0;",
        "    MoveAbsJ p1,v2000,z100,tool0;",
        "    MoveAbsJ p2,v2000,fine,tool0;",
        "  ENDPROC",
        "ENDMODULE",
        "",
    )
)
SCRIPT = """def m():
  movej([0,-1.6,0.1,-1.6,0,0], a=6, v=3)
  movej([1.2,-1.5,0,-1.6,0,0], a=6, v=3, r=0.05)
  movej([2.4,-1.6,0.1,-1.6,0,0], a=6, v=3)
end
"""
FAST = ("--points", "2")

Flyby = Callable[..., Result]


@pytest.fixture
def module(tmp_path: Path) -> Path:
    path = tmp_path / "m.mod"
    path.write_bytes(PROGRAM.encode())
    return path


def test_each_point_is_code_that_drives_as_told(flyby: Flyby, module: Path, tmp_path: Path):
    out, plot = tmp_path / "out", tmp_path / "front.svg"
    result = flyby(
        *("pareto", module, "--robot", ROBOT, *FAST, "--out", out, "--plot", plot, "--json")
    )
    assert result.exit_code == 0, result.output
    told = json.loads(result.stdout)
    assert told["unit"] == "N² m² s"
    assert told["files"] == [str(plot)] and plot.read_bytes().startswith(b"<?xml")
    points = told["points"]
    assert len(points) >= 2
    vendor, robot = find_vendor("abb"), find_robot(ROBOT)
    controller = Controller(vendor, robot)
    for k, point in enumerate(points):
        (file,) = map(Path, point["files"])
        assert file.parent == out / f"point-{k + 1}"
        run = controller.run(vendor.read_file(file, robot=robot))
        assert run.timing.duration == pytest.approx(point["time_s"], rel=1e-6)
        energy = controller.energy(run.program, run.timing).value
        assert energy == pytest.approx(point["energy"], rel=1e-6)
    assert [p["time_s"] for p in points] == sorted(p["time_s"] for p in points)
    assert points[-1]["energy"] < points[0]["energy"]
    assert module.read_bytes() == PROGRAM.encode()


def test_a_script_is_patched(flyby: Flyby, tmp_path: Path):
    """URScript says speed and acceleration at the move: the user's own text keeps its form."""
    script, out = tmp_path / "m.script", tmp_path / "out"
    script.write_text(SCRIPT, "ascii")
    result = flyby("pareto", script, "--robot", "ur/ur5e", *FAST, "--out", out)
    assert result.exit_code == 0, result.output
    text = (out / "point-2" / "m.script").read_text("ascii")
    assert text.startswith("def m():\n  movej([0,-1.6,0.1,-1.6,0,0], a=") and text != SCRIPT
    assert "wrote" in result.stdout and "torque² % of given" in result.stdout


def test_an_energy_that_comes_back_is_less_when_more_comes_back():
    given, point = (
        SimpleNamespace(duration=t, energy=e, by_joint=np.array([j]), certificate=None)
        for t, e, j in ((2.0, -100.0, -50.0), (2.2, -120.0, -40.0))
    )
    assert fronts._row(given, point, [0], "J")[1:5] == ("+10.0", "-0.12", "-20.0", "+20.0")


def test_motors_count_in_joules(flyby: Flyby, module: Path, tmp_path: Path):
    motors = tmp_path / "motors.toml"
    motors.write_text("copper_w_per_nm2 = [1e-5, 1e-5, 1e-5]\nrecuperation = 0.5\n", "ascii")
    result = flyby("pareto", module, "--robot", ROBOT, *FAST, "--motors", motors, "--json")
    assert result.exit_code == 0, result.output
    assert json.loads(result.stdout)["unit"] == "J"


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("copper = [1]", "copper_w_per_nm2: is missing"),
        ("recuperation = 0.5", "copper_w_per_nm2: is missing"),
        ("copper_w_per_nm2 = 3", "must be a list of numbers, not 3"),
        ("copper_w_per_nm2 = [true]", "must be a number, not True"),
        ("copper_w_per_nm2 = [1]\nrecuperation = 2", "recuperation: must be from 0 to 1, not 2"),
        ("copper_w_per_nm2 = [nan]", "copper_w_per_nm2: must be finite, not nan"),
        ("copper_w_per_nm2 = [-1]", "copper_w_per_nm2: must be zero or more, not -1"),
        ("copper_w_per_nm2 = [1]\nheat = 2", "heat: unknown key"),
        ("copper_w_per_nm2 = [1]\nrecuperation = nan", "recuperation: must be finite"),
        ("copper_w_per_nm2 = [1]\nrecuperation = 'all'", "recuperation: must be a number"),
        ("copper_w_per_nm2 = [1, 1, 1, 1, 1, 1, 1]", "has 6 axes"),
        ("copper_w_per_nm2 = [", "is not TOML"),
    ],
)
def test_motor_files_that_are_refused(
    flyby: Flyby, module: Path, tmp_path: Path, text: str, message: str
):
    motors = tmp_path / "motors.toml"
    motors.write_text(text, "ascii")
    result = flyby("pareto", module, "--robot", ROBOT, "--motors", motors)
    assert result.exit_code == 1
    assert message in " ".join(result.stderr.split())


@pytest.mark.parametrize(
    ("status", "words", "message"),
    [
        (2, ("--out", "new"), "which robot is"),
        (2, ("--robot", ROBOT, "--points", "1"), "--points 1: a number from 2 on"),
        (2, ("--robot", ROBOT, "--free", "all"), "--free needs a cell"),
        (2, ("--robot", ROBOT, "--axes", "2,3"), "--axes needs a cell"),
        (2, ("--robot", ROBOT, "--starts", "0"), "--starts 0"),
        (1, ("--robot", ROBOT, "--keep", "9"), "--keep 9"),
        (2, ("--robot", ROBOT, "--plot", "front.txt"), "the name must end in"),
    ],
)
def test_what_is_refused(
    flyby: Flyby, module: Path, status: int, words: tuple[str, ...], message: str
):
    result = flyby("pareto", module, *words)
    assert result.exit_code == status
    assert message in " ".join(result.stderr.split())


def test_files_that_exist_stay(flyby: Flyby, module: Path, tmp_path: Path):
    out = tmp_path / "out"
    (out / "point-1").mkdir(parents=True)
    (out / "point-1" / "m.mod").write_text("mine", "ascii")
    result = flyby("pareto", module, "--robot", ROBOT, *FAST, "--out", out)
    assert result.exit_code == 1
    assert (out / "point-1" / "m.mod").read_text("ascii") == "mine"
    assert not list((out / "point-2").glob("*"))
