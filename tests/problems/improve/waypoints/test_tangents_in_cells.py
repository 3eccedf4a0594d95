"""Paths change as their exact tangents say, in cells that move more than an arm about its base."""

from __future__ import annotations

import math
from pathlib import Path

import numpy as np
import pytest

import flyby
from flyby.problems.improve.waypoints import WaypointTask
from flyby.problems.improve.waypoints.block_emulation import Driver
from flyby.problems.improve.waypoints.blocks import cut
from flyby.problems.improve.waypoints.changeable import select
from flyby.problems.improve.waypoints.variables import make_variables
from flyby.tasks.setup import controller_of, setup_of_program

NINE = "9E9,9E9,9E9,9E9,9E9"
TABLE = """robot = "abb/irb4600-45-205"
[external_axis.table]
role = "table"
kind = "revolute"
axis = [0.1, 0.2, 0.97]
pose = { xyz_mm = [1200, 0, 500] }
range_deg = [-360, 360]
speed_deg_s = 90
acceleration_deg_s2 = 180
[frame.part]
pose = { xyz_mm = [0, 0, 100], abc_deg = [20, 5, 0] }
moved_by = "table"
"""
TRACK = """robot = "abb/irb4600-45-205"
[external_axis.track]
role = "track"
kind = "prismatic"
axis = "y"
pose = { xyz_mm = [0, 0, 0] }
range_mm = [-2000, 2000]
speed_mm_s = 1000
acceleration_mm_s2 = 2000
"""
TURNED = """robot = "abb/irb4600-45-205"
base = { xyz_mm = [100, -50, 800], abc_deg = [30, 20, 10] }
"""
HELD = """robot = "abb/irb4600-45-205"
[tool.grinder]
tcp = { xyz_mm = [1100, 100, 900], abc_deg = [10, 0, 180] }
robot_held = false
"""


def module(tool: str, work: str, points: list[str], kinds: str) -> str:
    """Points as ``x,y,z,w,i,j,k,axis``, driven in zones between stops."""
    lines = []
    for k, (kind, point) in enumerate(zip(kinds, points, strict=True)):
        x, y, z, *rotation, axis = point.split(",")
        length = math.hypot(*map(float, rotation))
        quaternion = ",".join(f"{float(value) / length:.9f}" for value in rotation)
        target = f"[[{x},{y},{z}],[{quaternion}],[0,0,0,0],[{axis},{NINE}]]"
        zone = "fine" if k in (0, len(points) - 1) else "z30"
        lines.append(f"    Move{kind} {target},v600,{zone},{tool}\\WObj:={work};")
    held = (
        ""
        if tool != "grinder"
        else (
            "  PERS tooldata grinder:=[FALSE,[[1100,100,900],[0,0.0868,-0.996,0]],"
            "[1,[0,0,1],[1,0,0,0],0,0,0]];\n"
            '  PERS wobjdata piece:=[TRUE,TRUE,"",[[0,0,120],[1,0,0,0]],[[20,0,0],[1,0,0,0]]];\n'
        )
    )
    frame = (
        ""
        if work != "part"
        else (
            '  PERS wobjdata part:=[FALSE,FALSE,"table",[[0,0,100],[1,0,0,0]],'
            "[[0,0,0],[1,0,0,0]]];\n"
        )
    )
    return f"MODULE m\n{held}{frame}  PROC main()\n" + "\n".join(lines) + "\n  ENDPROC\nENDMODULE\n"


CASES = {
    "turned base": (TURNED, "tool0", "wobj0", [
        "1400,700,1300,0,0,1,0,9E9", "1450,500,1350,0.1,0,1,0.05,9E9",
        "1400,300,1300,0,0.2,1,0,9E9", "1350,100,1300,0,0,1,0,9E9"], "JLLL"),
    "track": (TRACK, "tool0", "wobj0", [
        "1300,200,900,0,0,1,0,0", "1300,-100,950,0.1,0,0.99,0.05,-200",
        "1200,-300,900,0,0.1,1,0,-500", "1300,-500,900,0,0,1,0,-600"], "JLJL"),
    "turning table": (TABLE, "tool0", "part", [
        "100,100,200,0,0,1,0,0", "200,-100,220,0.1,0,0.99,0,30",
        "0,-150,200,0,0.1,1,0,80", "-100,0,200,0,0,1,0,120"], "JLLL"),
    "large turns": ('robot = "abb/irb4600-45-205"\n', "tool0", "wobj0", [
        "1300,200,1000,0,0,1,0,9E9", "1250,-100,1050,0,0.7071,0.7071,0,9E9",
        "1200,-200,950,0,0.99,0.1,0.05,9E9", "1300,-300,1000,0,0.5,-0.8,0.1,9E9"], "JLLL"),
    "stationary tool": (HELD, "grinder", "piece", [
        "0,0,0,1,0,0,0,9E9", "80,20,10,0.99,0.1,0,0.05,9E9",
        "40,95,-20,0.97,0,0.2,0.1,9E9", "0,50,0,1,0,0,0,9E9"], "JLLL"),
}  # fmt: skip


@pytest.mark.parametrize("name", CASES)
def test_in_a_cell(name: str, tmp_path: Path) -> None:
    cell, *words = CASES[name]
    (tmp_path / "cell.toml").write_text(cell)
    (tmp_path / "m.mod").write_text(module(*words))
    program = flyby.read(tmp_path / "m.mod", cell=tmp_path / "cell.toml", configuration="nearest")
    setup = setup_of_program(program)
    controller = controller_of(program, setup)
    task = WaypointTask(tilt=0.5)
    path = controller.plan(program)
    chosen = select(program, path, setup.robot, task)
    assert len(chosen.points) == 2, chosen.reasons
    made = make_variables(program, setup.robot, chosen, task)
    blocks = cut(program, path, made, setup.robot.arm_size)
    (block,) = [one for one in blocks if one.variables.size]
    driver, variables = Driver(controller, block), block.variables
    here = driver.drive(variables.start)
    assert here is not None
    which = np.arange(len(here.q))
    change, free, step = driver.change(here, which), variables.free, 2e-6
    random = np.random.default_rng(5)
    for _ in range(4):
        d = np.zeros(variables.size)
        d[free] = random.uniform(-1, 1, len(free)) * variables.scale[free]
        ahead, behind = driver.drive(here.x + step * d), driver.drive(here.x - step * d)
        assert ahead is not None and behind is not None
        quotient = (ahead.q - behind.q) / (2 * step)
        size = float(np.abs(quotient).max())
        assert size > 1e-2
        assert change.q @ d[free] == pytest.approx(quotient, abs=2e-4 * size)
