"""Waits behind a zone: a robot stops there or passes through, and proofs hold for both."""

from __future__ import annotations

import math
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from scipy.spatial import cKDTree

import flyby
from flyby.core.errors import InputError
from flyby.core.motion.emulator.controller import Controller
from flyby.core.motion.model.rules import Overlap
from flyby.core.registry import find_robot, find_vendor
from flyby.core.station.passing import passing, zones_overlap
from flyby.vendors.ur.signals import SIGNALS

from .stations import UNUSED, module

BESIDE = 795.0
"""mm from the one to the other, that points between where the one stops and where it passes."""


def to(q: tuple[float, ...], zone: str = "fine") -> str:
    return f"MoveAbsJ [[{','.join(map(str, q))}],{UNUSED}], v1000, {zone}, tool0"


def corner(folder: Path, zone: str, gap: float = BESIDE) -> Path:
    """One draws its arm in to a corner, waits there and stretches out again, beside two's hand."""
    out, drawn, on = (0, 40, -20, 0, 0, 0), (40, -30, 30, 0, 0, 0), (80, 40, -20, 0, 0, 0)
    one = [to(out), to(drawn, zone), "WaitDI diGo,1", to(on)]
    two = [to((0, 20, -20, 0, 0, 0)), "SetDO doGo,1", to((0, 20, -20, 0, 0, 20))]
    (folder / "one.mod").write_text(module("one", one))
    (folder / "two.mod").write_text(module("two", two))
    way = math.radians(40)
    x, y, half = gap * math.cos(way), gap * math.sin(way), 0.5 * (way + math.pi)
    turned = f"[{math.cos(half):.9f}, 0, 0, {math.sin(half):.9f}]"
    robot = 'robot = "abb/irb120-3-058"\n'
    (folder / "one.toml").write_text(robot)
    base = f"base = {{ xyz_mm = [{x:.3f}, {y:.3f}, 0], quat_wxyz = {turned} }}\n"
    (folder / "two.toml").write_text(robot + base)
    members = "".join(
        f'[robot.{name}]\ncell = "{name}.toml"\nprogram = "{name}.mod"\n' for name in ("one", "two")
    )
    file = folder / "station.toml"
    file.write_text(members + '[links]\n"two.doGo" = "one.diGo"\n')
    return file


def test_both_paths_are_proven(tmp_path: Path) -> None:
    """Where the robot stops it keeps clear; through the zone it would meet the other's hand."""
    (stopped,) = flyby.station(corner(tmp_path, "fine")).clearances
    assert stopped.any_time.proven and stopped.in_time.proven
    made = flyby.station(corner(tmp_path, "z200"))
    (passed,) = made.clearances
    assert not passed.any_time.proven and not passed.in_time.proven and not passed.safe
    assert passed.least < stopped.least
    assert any("clearances are proven of both" in str(note) for note in made.notes)
    (apart,) = flyby.station(corner(tmp_path, "z200", 1200.0)).clearances
    assert apart.any_time.proven and apart.in_time.proven


def test_what_is_too_late_is_not_passed(tmp_path: Path) -> None:
    """In time there is only what the signals' times let happen; at any time there is all."""
    file = corner(tmp_path, "z200")
    file.write_text(
        file.read_text().replace('= "one.diGo"', '= { to = "one.diGo", delay_ms = 9000 }')
    )
    (late,) = flyby.station(file).clearances
    assert late.in_time.proven and not late.any_time.proven


def test_the_jitter_says_whether_a_robot_passes(tmp_path: Path) -> None:
    """It waits for less than two may be early: then it passes, and meets the other's hand."""
    file = corner(tmp_path, "z200")
    text = file.read_text()
    actions = flyby.station(file, no_proof=True).actions
    (comes,), (sets,) = ([action.time for action in actions[name]] for name in ("one", "two"))
    for late, jitter, proven in ((0.06, 0.01, True), (0.06, 0.05, False)):
        delay = f'{{ to = "one.diGo", delay_ms = {1e3 * (comes - sets + late):.3f} }}'
        file.write_text(text.replace('= "one.diGo"', f"= {delay}"))
        (pair,) = flyby.station(file, jitter=jitter).clearances
        assert pair.in_time.proven is proven, (late, jitter)


def test_programs_are_improved_where_it_is_known_what_they_do(tmp_path: Path) -> None:
    with pytest.raises(InputError, match=r"one: .*one\.mod:\d+.*end the move at a stop"):
        flyby.station_zones(corner(tmp_path, "z200", 1200.0))


KRL = """DEF {name}()
$VEL.CP=0.5
$APO.CPTP=100
PTP {{A1 0,A2 -90,A3 90,A4 0,A5 30,A6 0}}
PTP {{A1 20,A2 -110,A3 110,A4 0,A5 30,A6 0}} C_PTP
{wait}
PTP {{A1 40,A2 -90,A3 90,A4 0,A5 30,A6 0}}
END
"""


@pytest.mark.parametrize("wait, passes", [("", False), ("CONTINUE", True)])
def test_krl_passes_where_it_is_let(tmp_path: Path, wait: str, passes: bool) -> None:
    """A wait stops the advance run, and the robot, unless ``CONTINUE`` stands before it."""
    members = ""
    for name, y in (("one", 0), ("two", 9000)):
        text = KRL.format(
            name=name, wait=f"{wait}\nWAIT FOR $IN[1]" if name == "one" else "$OUT[1]=TRUE"
        )
        (tmp_path / f"{name}.src").write_text(text)
        cell = f'robot = "kuka/kr16-2"\nbase = {{ xyz_mm = [0, {y}, 0] }}\n'
        (tmp_path / f"{name}.toml").write_text(cell)
        members += f'[robot.{name}]\ncell = "{name}.toml"\nprogram = "{name}.src"\n'
    file = tmp_path / "station.toml"
    file.write_text(members + '[links]\n"two.$OUT[1]" = "one.$IN[1]"\n')
    made = flyby.station(file)
    one = made.station.members["one"]
    assert (one.passing is not None) is passes
    if one.passing is not None:
        assert one.passing.run.duration < one.run.duration
    assert any("clearances are proven of both" in str(note) for note in made.notes) is passes
    assert all(pair.any_time.proven for pair in made.clearances)


SCRIPT = """def one():
  movej([0, -1.2, 1.6, -2, -1.57, 0])
  movel(p[0.5, -0.2, 0.4, 0, 3.14, 0], v=0.2)
  movel(p[0.5, 0.0, 0.4, 0, 3.14, 0], v=0.2, r=RADIUS)
  while not get_digital_in(1):
    sync()
  end
  movel(p[0.54, 0.0, 0.44, 0, 3.14, 0], v=0.2, r=RADIUS)
  while not get_digital_in(2):
    sync()
  end
  movel(p[0.54, 0.2, 0.44, 0, 3.14, 0], v=0.2)
end
"""


def overlapping(folder: Path, radius: float) -> Path:
    """Blends of a UR on a way of 57 mm, behind both of which it waits."""
    (folder / "one.script").write_text(SCRIPT.replace("RADIUS", str(radius)))
    sets = [f"set_digital_out({i}, True)" for i in (1, 2)]
    two = ["def two():", "movej([0, -1.2, 1.6, -2, -1.57, 0])", *sets, "end"]
    (folder / "two.script").write_text("\n".join(two) + "\n")
    for name, x in (("one", 0), ("two", 9000)):
        base = f"base = {{ xyz_mm = [{x}, 0, 0] }}\n"
        (folder / f"{name}.toml").write_text('robot = "ur/ur10e"\n' + base)
    members = "".join(
        f'[robot.{name}]\ncell = "{name}.toml"\nprogram = "{name}.script"\n'
        for name in ("one", "two")
    )
    links = "".join(f'"two.digital_out[{i}]" = "one.digital_in[{i}]"\n' for i in (1, 2))
    file = folder / "station.toml"
    file.write_text(f"{members}[links]\n{links}")
    return file


def test_zones_that_change_each_other_are_passed_all_or_refused(tmp_path: Path) -> None:
    """Through one blend alone the robot drives another path than through both and through none."""
    (apart,) = flyby.station(overlapping(tmp_path, 0.02)).clearances
    assert apart.any_time.proven
    with pytest.raises(InputError, match="behind moves 3, 4 it waits, zones there overlap"):
        flyby.station(overlapping(tmp_path, 0.04))


@pytest.mark.parametrize("overlap", list(Overlap))
@pytest.mark.parametrize("radius", [0.02, 0.04])
def test_paths_through_some_zones_are_known_where_none_overlap(
    tmp_path: Path, overlap: Overlap, radius: float
) -> None:
    script = tmp_path / "one.script"
    script.write_text(SCRIPT.replace("RADIUS", str(radius)))
    program = flyby.read(script, robot="ur/ur10e")
    vendor, robot = find_vendor("ur"), find_robot("ur/ur10e")
    controller = Controller(
        vendor, robot, replace(Controller(vendor, robot).model, overlap=overlap)
    )
    runs = {
        which: controller.run(passing(program, SIGNALS, which))
        for which in ((), (2,), (3,), (2, 3))
    }
    near = cKDTree(np.concatenate([runs[which].trajectory.q for which in ((), (2, 3))]))
    beside = max(
        float(near.query(runs[which].trajectory.q, p=np.inf)[0].max()) for which in ((2,), (3,))
    )
    assert (beside > 0.005) is zones_overlap(runs[()], runs[2, 3])
