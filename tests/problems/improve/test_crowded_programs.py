"""Zones and via points of programs with arcs, short legs and shared zones: never an error of a
trial, never a slower program."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import HealthCheck, Phase, assume, given, settings
from hypothesis import strategies as st

from flyby.core.cell.floor import bare_cell
from flyby.core.errors import InputError, MotionError
from flyby.core.motion.emulator.controller import Controller
from flyby.core.program.arc_orientation import ArcOrientation
from flyby.core.program.program import Program
from flyby.core.program.speed import Speed
from flyby.core.program.zone import FINE
from flyby.core.registry import find_robot, find_vendor
from flyby.problems.improve.rounding import Rounding
from flyby.problems.improve.waypoints import (
    Effort,
    Freedom,
    WaypointTask,
    optimize_waypoints,
)
from flyby.problems.improve.zones.maximize import maximize_zones
from flyby.problems.improve.zones.options import ZoneTask
from flyby.tasks.files.texts import ProgramTexts
from flyby.tasks.setup import Setup
from flyby.testing.crowded import crowded_programs

CASES = {
    "abb": (
        "abb/irb1600-6-145",
        [0.1, 0.2, 0.2, 0.1, 1.0, 0.1],
        Speed(tcp=0.3, reorientation=2.0),
        Speed(tcp=0.3, reorientation=2.0),
    ),
    "kuka": (
        "kuka/kr30-3",
        [0.1, -1.6, 1.7, 0.1, 1.2, 0.1],
        Speed(joint_fraction=0.3),
        Speed(tcp=0.3, tcp_acceleration=2.0),
    ),
    "ur": (
        "ur/ur5e",
        [0.3, -1.7, 1.9, -1.8, -1.6, 0.2],
        Speed(joint=0.8, joint_acceleration=1.4),
        Speed(tcp=0.25, tcp_acceleration=1.2),
    ),
}
TURNING = {
    "abb": ArcOrientation.FOLLOWS_ARC,
    "kuka": ArcOrientation.FOLLOWS_ARC,
    "ur": ArcOrientation.FIXED_FRAME,
}
EVERY = settings(
    max_examples=4,
    deadline=None,
    phases=[Phase.generate],
    suppress_health_check=[HealthCheck.too_slow, HealthCheck.filter_too_much],
)
BRIEF = Effort(starts=1, generations=0, iterations=2, proofs=1, workers=1)


class Driven:
    """A vendor's program as read from its text, with its run."""

    def __init__(self, data: st.DataObject, vendor: str, tmp_path) -> None:
        name, q, joint, path = CASES[vendor]
        self.vendor, self.robot = find_vendor(vendor), find_robot(name)
        program = data.draw(crowded_programs(self.robot, np.array(q), joint, path, TURNING[vendor]))
        self.controller = Controller(self.vendor, self.robot)
        try:
            sources = self.vendor.write(program, self.robot)
            for file, text in sources.items():
                (tmp_path / file).write_bytes(text.encode())
            main = next(f for f in sources if "." + f.rpartition(".")[2] in self.vendor.suffixes)
            self.program = self.vendor.read_file(tmp_path / main, robot=self.robot)
            self.given = self.controller.run(self.program)
        except MotionError:
            assume(False)
        assume(any(move.zone != FINE for move in self.program.moves))
        tools = dict.fromkeys(move.tool for move in self.program.moves)
        self.cell = bare_cell(self.robot, vendor, tools, floor=False)
        self.rounding = Rounding.of(self.vendor.speaks)
        self.read_back = ProgramTexts(
            Setup(self.vendor, self.robot), self.program, own=False
        ).read_back

    def no_slower(self, program: Program) -> None:
        assert self.controller.run(program).duration <= self.given.duration * (1 + 1e-9)


@pytest.mark.parametrize("vendor", CASES)
@given(data=st.data(), apart=st.booleans())
@EVERY
def test_zones_never_fail_and_never_cost_time(vendor: str, tmp_path_factory, data, apart) -> None:
    case = Driven(data, vendor, tmp_path_factory.mktemp("crowded"))
    options = ZoneTask(rounding=case.rounding, apart=apart)
    try:
        # With zones that are to part, and a text that is not to get new data, some have no place.
        made = maximize_zones(
            case.controller, case.program, case.cell, options, read_back=case.read_back
        )
    except InputError as error:
        assert "no zone can be changed" in str(error)
        return
    case.no_slower(made.program)


@pytest.mark.parametrize("vendor", CASES)
@given(data=st.data(), points=st.booleans())
@settings(EVERY, max_examples=2)
def test_searches_never_fail_and_never_cost_time(
    vendor: str, tmp_path_factory, data, points: bool
) -> None:
    case = Driven(data, vendor, tmp_path_factory.mktemp("crowded"))
    freedom = Freedom.WAYPOINTS_AND_ZONES if points else Freedom.ZONES
    task = WaypointTask(rounding=case.rounding, freedom=freedom)
    made = optimize_waypoints(case.controller, case.program, case.cell, task, BRIEF, case.read_back)
    case.no_slower(made.program)
