"""What the logs of an IRB 6640 showed, held against the figures that are shipped; no log is needed.

The program is like that of the logs: two lines of 500 mm, bent by 30°, one metre above the floor.
Numbers are measured on the logs, as `measured` does it; where there are logs (FLYBY_LOGS), they are
measured anew. Figures that are spoilt do not give them.
"""

from __future__ import annotations

import os
from dataclasses import dataclass, replace
from functools import cache
from pathlib import Path

import numpy as np
import pytest

from flyby.core.motion.emulator.controller import Controller
from flyby.core.motion.model.elasticity import RIGID
from flyby.core.motion.model.motion_model import MotionModel
from flyby.core.program.move import MoveL
from flyby.core.program.program import Program
from flyby.core.program.speed import Speed
from flyby.core.program.target import JointTarget, PoseTarget
from flyby.core.program.tool import Tool
from flyby.core.program.zone import FINE, Radius, Zone
from flyby.core.registry import find_robot, find_vendor
from flyby.core.spatial.pose import Pose
from flyby.identification.corners import least_distance
from flyby.identification.logs import load_run
from flyby.identification.report.picture import tcp_profiles
from flyby.identification.tcp_path import tcp_positions

VENDOR, ROBOT = find_vendor("abb"), find_robot("abb/irb6640-180-255")


def turned(degrees: float) -> tuple[float, float, float, float]:
    """A turn about y."""
    half = np.radians(degrees) / 2
    return (float(np.cos(half)), 0.0, float(np.sin(half)), 0.0)


GUN = Tool("gun", Pose((0.075, 0.0, 0.4933), turned(30.0)))
START = (0.312, 0.277, 0.402, 0.668, -0.4995, -0.522)
CORNER, END = np.array([2.2001, -0.0002, 1.0]), np.array([2.45, -0.433, 1.0])
"""m; on both legs the tool turns by 22.5° about y."""
CLOCK = 1.00803
"""s that pass while these logs count one."""
LOGS = os.environ.get("FLYBY_LOGS")


@dataclass(frozen=True)
class Measured:
    """Of one run.

    Args:
        rise: s, from a tenth to nine tenths of the speed at the start.
        stop: s below a tenth of the speed at the corner; 0 where it is passed.
        corner: mm, least distance from the corner's waypoint.
        start, end: mm that the TCP leaves the line by, within 100 mm of start and end: commanded
            motors lead their links.
    """

    rise: float
    stop: float
    corner: float
    start: float
    end: float


Shown = dict[str, tuple[float, float]]
"""What logs show, and by how much the emulation may be off."""
SHOWN: dict[tuple[str, float, float], Shown] = {
    ("v500_fine", 0.5, 0.0): {
        "rise": (0.0962, 0.007),
        "stop": (0.0438, 0.004),
        "start": (0.554, 0.04),
        "end": (2.669, 0.13),
    },
    ("v500_z1", 0.5, 0.001): {"corner": (1.755, 0.1), "end": (2.766, 0.1)},
    ("v500_z10", 0.5, 0.01): {"corner": (3.020, 0.05), "end": (2.769, 0.1)},
    ("v500_z50", 0.5, 0.05): {"corner": (6.177, 0.05)},
    ("v50_z10", 0.05, 0.01): {"corner": (1.155, 0.02), "end": (0.582, 0.02)},
}
"""By run: speed in m/s, zone in m."""
SPOILT = {
    "averages shorter by a tenth": lambda m: replace(
        m, smoothing=tuple(0.9 * w for w in m.smoothing)
    ),
    "settling shorter by a tenth": lambda m: replace(m, settling=0.9 * m.settling),
    "no ramp": lambda m: replace(m, ramp=0.0),
    "parabolas": lambda m: replace(m, tcp=replace(m.tcp, beta=())),
    "rigid": lambda m: replace(m, elasticity=RIGID),
    "no slack": lambda m: replace(m, elasticity=replace(m.elasticity, slack=())),
    "no weight on gears": lambda m: replace(
        m, elasticity=replace(m.elasticity, weight=(), spring=())
    ),
    "torque less by a quarter": lambda m: replace(
        m, torque=replace(m.torque, own=tuple(s / 0.75 for s in m.torque.own))
    ),
}


def measured(t: np.ndarray, tcp: np.ndarray, speed: float) -> Measured:
    """Of a TCP (T, 3) m at times (T,) s."""
    at, v, _ = tcp_profiles(t, tcp)
    fast = int(np.argmax(v > 0.9 * speed))
    slow = fast - 1 - int(np.argmax(v[:fast][::-1] < 0.1 * speed))
    rise = crossing(at, v, fast - 1, 0.9 * speed) - crossing(at, v, slow, 0.1 * speed)
    below = v < 0.1 * speed
    falls = np.flatnonzero(~below[:-1] & below[1:])
    rises = np.flatnonzero(below[:-1] & ~below[1:])
    stop = 0.0
    if len(falls) and falls[0] < rises[-1]:
        first, last = (crossing(at, v, k, 0.1 * speed) for k in (falls[0], rises[-1]))
        stop = last - first
    first, last = (off_the_line(tcp, a, b) for a, b in ((tcp[0], CORNER), (CORNER, END)))
    return Measured(
        rise,
        stop,
        1e3 * least_distance(tcp - CORNER),
        1e3 * float(first[0][first[1] < 0.1].max()),
        1e3 * float(last[0][last[1] > np.linalg.norm(END - CORNER) - 0.1].max()),
    )


def crossing(t: np.ndarray, v: np.ndarray, k: int, level: float) -> float:
    """When v passes a level between samples k and k + 1."""
    return float(t[k] + (t[k + 1] - t[k]) * (level - v[k]) / (v[k + 1] - v[k]))


def off_the_line(p: np.ndarray, a: np.ndarray, b: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Distances (T,) of points from a line, and how far along it they are, m."""
    u = (b - a) / np.linalg.norm(b - a)
    along = (p - a) @ u
    return np.linalg.norm(p - a - np.outer(along, u), axis=1), along


@cache
def shipped() -> MotionModel:
    return VENDOR.motion_of(ROBOT)


def emulated(model: MotionModel, speed: float, radius: float) -> Measured:
    told = Speed(tcp=speed, reorientation=8.7)
    zone: Zone = FINE
    if radius > 0:
        zone = Radius(radius, 1.5 * radius, 1.5 * radius, np.radians(0.15 * 1e3 * radius))
    moves = tuple(
        MoveL(PoseTarget(Pose(tuple(to), turned(tilt))), told, kind, tool=GUN)
        for to, tilt, kind in ((CORNER, 112.5, zone), (END, 90.0, FINE))
    )
    program = Program(moves, start=JointTarget(START))
    found = Controller(VENDOR, ROBOT, model).run(program, period=0.004 * CLOCK).trajectory
    return measured(found.t, tcp_positions(ROBOT, GUN, found.q_motor), speed)


def faults(model: MotionModel) -> list[str]:
    """What a model says otherwise than the logs."""
    found = []
    for (run, speed, radius), shown in SHOWN.items():
        made = emulated(model, speed, radius)
        for name, (value, tolerance) in shown.items():
            is_so = getattr(made, name)
            if abs(is_so - value) > tolerance:
                found.append(f"{run}: {name} {is_so:.4g}, logged {value:g}")
    return found


def test_the_shipped_figures_say_what_the_logs_showed() -> None:
    assert faults(shipped()) == []


@pytest.mark.parametrize("how", SPOILT)
def test_spoilt_figures_do_not(how: str) -> None:
    assert faults(SPOILT[how](shipped()))


@pytest.mark.skipif(LOGS is None, reason="FLYBY_LOGS names no folder of logged runs")
@pytest.mark.parametrize("run", SHOWN)
def test_the_numbers_are_those_of_the_logs(run: tuple[str, float, float]) -> None:
    (path,) = Path(LOGS or "").glob(f"**/abb_irb6640_robotstudio/movel_30_car__{run[0]}.json")
    logged = load_run(path, find_robot)
    tcp = tcp_positions(ROBOT, GUN, logged.q)
    made = measured(CLOCK * logged.t, tcp, run[1])
    for name, (value, _) in SHOWN[run].items():
        assert getattr(made, name) == pytest.approx(value, rel=2e-3), name
