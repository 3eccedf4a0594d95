"""Stations of programs as they are found: read, run on one clock, and written back."""

from __future__ import annotations

import re
import tomllib
from dataclasses import replace
from functools import cache
from pathlib import Path

import numpy as np
import pytest
from scipy.interpolate import CubicHermiteSpline

import flyby
from flyby.core.arrays import FloatArray
from flyby.core.program.program import Program
from flyby.core.program.target import PoseTarget
from flyby.core.source.patch.edits import difference
from flyby.core.source.reading import Reading
from flyby.tasks.pages.station_page import station_page
from flyby.tasks.results.stations import DrivenStation
from flyby.tasks.setup import setup_of_program

ROOT = Path(__file__).parents[2] / "corpus" / "stations"
STATIONS = {"multimove": ("rob1", "rob2", "stn1"), "roboteam": ("R1", "R2")}
ROBOTS = [(name, robot) for name, robots in STATIONS.items() for robot in robots]
SYNC = re.compile(rb"^.*(?:Sync|\\ID|PROGSYNC).*$", re.MULTILINE | re.IGNORECASE)


@cache
def driven(name: str) -> DrivenStation:
    return flyby.station(ROOT / name / "station.toml")


@cache
def program(name: str, robot: str) -> Program:
    said = tomllib.loads((ROOT / name / "station.toml").read_text())["robot"][robot]
    return flyby.read(ROOT / name / said["program"], cell=ROOT / name / said["cell"])


@pytest.mark.parametrize(
    ("name", "together", "seconds"), [("multimove", [6], 6.71), ("roboteam", [1, 1, 1], 4.92)]
)
def test_they_run_on_one_clock_proven(name: str, together: list[int], seconds: float) -> None:
    made = driven(name)
    assert made.deadlock is None and not made.may_lock and made.clear
    assert all(pair.any_time.proven for pair in made.clearances)
    said = [re.search(r"make (\d+) moves? together", str(note)) for note in made.notes]
    assert [int(found[1]) for found in said if found is not None] == together
    assert made.duration == pytest.approx(seconds, rel=0.02)


def test_who_goes_nowhere_holds_nobody_up() -> None:
    r"""The table stands in its first and last \ID: the welders wait for nothing but each other."""
    waits = [spell for name, spell in driven("multimove").waits() if name == "rob1"]
    assert not [spell for spell in waits if "ID" in spell.action.text]


@pytest.mark.parametrize(("name", "robot"), ROBOTS)
def test_they_are_written_back_with_all_that_joins_them(name: str, robot: str) -> None:
    read = program(name, robot)
    reading, setup = read.reading, setup_of_program(read)
    assert isinstance(reading, Reading)
    assert not setup.vendor.patch(read, setup.robot)
    moves = list(read.moves)
    k = next((i for i, m in enumerate(moves) if isinstance(m.target, PoseTarget)), len(moves) - 1)
    target = moves[k].target
    if isinstance(target, PoseTarget):
        x, y, z = target.pose.position
        target = replace(target, pose=replace(target.pose, position=(x, y, z + 1e-3)))
    else:
        target = replace(target, external=(target.external[0] - 0.01,))
    moves[k] = replace(moves[k], target=target)
    after = read.with_moves(tuple(moves))
    own = {"derived": "own", "shared": "own"}
    patched = setup.vendor.patch(after, setup.robot, own)
    files = {one.name: one for one in patched.values()}
    assert files and difference(after, reading.again(files)) is None
    for file, text in files.items():
        old, new = reading.files[file].data, text.data
        assert old != new and SYNC.findall(old) == SYNC.findall(new)


def test_what_the_station_answers_is_no_finding() -> None:
    """Read by itself a task has no table under its targets, and drives alone."""
    made = flyby.station_check(ROOT / "multimove" / "station.toml", no_proof=True)
    told = [finding.message for found in made.robots.values() for finding in found]
    assert told and not [one for one in told if "no axis of this robot" in one or "alone" in one]


@pytest.mark.parametrize("name", STATIONS)
def test_the_page_draws_moves_that_are_made_together_as_they_are_made(name: str) -> None:
    made = driven(name)
    page = station_page(made)
    for track, (robot, schedule) in zip(page.tracks, made.run.schedules.items(), strict=True):
        run, t = made.station.members[robot].run, track.motion.t.values
        assert track.duration == pytest.approx(schedule.end, abs=1e-6)
        assert t[-1] <= schedule.end + 1e-6 and (np.diff(t) >= 0.0).all()
        # Between knots it is where the station's clock has it, and goes as fast.
        times = np.linspace(0.0, schedule.end, 997)[1:-1]
        own = np.clip(schedule.own(times), 0.0, run.trajectory.t[-1])
        for j, (q, dq) in enumerate(zip(track.motion.q, track.motion.dq, strict=True)):
            wanted = np.interp(own, run.trajectory.t, run.trajectory.q[:, j])
            drawn = CubicHermiteSpline(*_apart(t, q.values, dq.values))(times)
            assert np.abs(drawn - wanted).max() < 2e-3
        waits = sum(spell.end - spell.begin for spell in schedule.waits)
        shares = [one.seconds for one in page.shares if one.track == page.tracks.index(track)]
        assert sum(shares) == pytest.approx(schedule.end - schedule.begin, abs=2e-3)
        assert made.driven(robot) + waits == pytest.approx(schedule.end - schedule.begin)
    if name == "multimove":
        together = [
            [(bar.begin, bar.end) for bar in row.bars if bar.kind == "move"][3:7]
            for row in page.gantt[:2]
        ]
        assert np.abs(np.subtract(*together)).max() < 5e-3
        _, _, table = page.tracks
        assert table.waypoints is not None and not len(table.waypoints.moves.values)
        assert not table.programmed
        # What turns under a torch is as near as it is.
        (near,) = [one for one in page.tracks[0].channels if one.name == "to stn1"]
        assert near.values.values.min() == pytest.approx(315.3, abs=0.5)
        assert near.values.values.max() < 500.0


def _apart(t: FloatArray, q: FloatArray, dq: FloatArray) -> tuple[FloatArray, ...]:
    """Knots at one time a little apart, as splines want them."""
    return np.maximum.accumulate(t) + 1e-9 * np.arange(len(t)), q, dq
