"""A program's start is written as its first move, so that no leg is lost."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from flyby.core.language import Sources
from flyby.core.motion.emulator.controller import Controller
from flyby.core.program.move import MoveJ, Wait
from flyby.core.program.program import Program
from flyby.core.program.speed import Speed
from flyby.core.program.target import JointTarget
from flyby.core.registry import find_robot, find_vendor
from flyby.core.translation.translate import translate
from flyby.core.vendor import Vendor

START = JointTarget((0.0, 0.0, 0.0, 0.0, 0.5, 0.0))
BENT = {"kuka": (0.0, -1.5, 1.5, 0.0, 0.5, 0.0), "ur": (0.0, -1.5, 1.5, 0.0, 0.5, 0.0)}
ROBOTS = {"abb": "abb/irb6640-180-255", "kuka": "kuka/kr30-3", "ur": "ur/ur10e"}
SPEEDS = {
    "abb": Speed(tcp=1.0),
    "kuka": Speed(joint_fraction=0.5),
    "ur": Speed(joint=0.6, joint_acceleration=1.0),
}


def planned(vendor: str) -> Program:
    """Two joint moves from where the robot stands."""
    start = JointTarget(BENT.get(vendor, START.joints))
    targets = [replace(start, joints=(a, *start.joints[1:])) for a in (0.5, 1.2)]
    moves = tuple(MoveJ(target, SPEEDS[vendor]) for target in targets)
    return Program(moves, "planned", start)


def read_alone(vendor: Vendor, sources: Sources, folder: Path) -> Program:
    for name, text in sources.items():
        (folder / name).write_text(text)
    main = next(name for name in sources if name.lower().endswith(vendor.suffixes))
    return vendor.read_file(folder / main)


@pytest.mark.parametrize("name", ROBOTS)
def test_as_written_it_lasts_as_long_as_planned(name: str, tmp_path: Path) -> None:
    vendor, robot = find_vendor(name), find_robot(ROBOTS[name])
    controller, program = Controller(vendor, robot), planned(name)
    run = controller.run(program)
    sources = vendor.write(program, robot)
    written = controller.run(read_alone(vendor, sources, tmp_path))
    assert written.duration == pytest.approx(run.duration, rel=1e-4)
    assert np.abs(written.trajectory.q[0] - program.start.joints).max() < 1e-6  # type: ignore[union-attr]
    assert vendor.write(written.program, robot) == sources
    lost = controller.run(replace(program, start=None))
    assert lost.duration < 0.8 * run.duration
    recorded = read_alone(vendor, vendor.record(program, robot, 0.12), tmp_path)
    drives = Program(recorded.moves)
    assert controller.run(drives).duration == pytest.approx(run.duration, rel=1e-4)


@pytest.mark.parametrize("name", ROBOTS)
def test_who_drives_there_first_gets_no_other_move(name: str, tmp_path: Path) -> None:
    vendor, robot = find_vendor(name), find_robot(ROBOTS[name])
    program = planned(name)
    assert program.start is not None
    there = MoveJ(program.start, SPEEDS[name])
    begun = replace(program, statements=(Wait(1.0), there, *program.statements))
    assert len(read_alone(vendor, vendor.write(begun, robot), tmp_path).moves) == 3


def test_a_translation_keeps_it(tmp_path: Path) -> None:
    abb, ur = (find_vendor(name) for name in ("abb", "ur"))
    old, new = find_robot("abb/irb1200-5-090"), find_robot("ur/ur10e")
    first, second = planned("abb"), Controller(ur, new)
    made = translate(first, (abb, old), (ur, new))
    driven = second.run(made.program, made.start)
    written = second.run(read_alone(ur, ur.write(made.program, new), tmp_path))
    assert written.duration == pytest.approx(driven.duration, rel=1e-3)
