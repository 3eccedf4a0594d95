"""What the page of a station holds."""

from __future__ import annotations

import shutil
from pathlib import Path

import numpy as np

import flyby
from flyby.tasks.pages.station_page import station_page

from ..station.hand_over_scene import hand_over

EXAMPLE = Path(__file__).parents[3] / "examples/two_robots"


def test_a_robot_stands_until_its_program_begins(tmp_path: Path) -> None:
    """From the station's beginning on it is there, at rest, and so is its distance."""
    shutil.copytree(EXAMPLE, tmp_path / "station")
    file = tmp_path / "station/station.toml"
    late = file.read_text().replace('program = "right.mod"', 'program = "right.mod"\nbegins_s = 5')
    file.write_text(late)
    made = flyby.station(file)
    page = station_page(made)
    left, right = page.tracks
    for track in (left, right):
        assert track.motion.t.values[0] == 0.0
    before = right.motion.t.values < 5.0
    assert before.sum() > 10
    assert all(np.ptp(axis.values[before]) < 1e-9 for axis in right.motion.q)
    (speed,) = [one for one in right.channels if one.name == "driven" and one.chart == "speed"]
    assert np.abs(speed.values.values[before]).max() < 1e-3
    (near,) = [one for one in right.channels if one.name == "to left"]
    assert np.ptp(near.values.values[before]) > 100.0


def test_what_interlocks_keep_apart_is_said_to_be_proven(tmp_path: Path) -> None:
    """By times alone nobody can be sure that a part is taken in time; by the signals it is."""
    made = flyby.station(hand_over(tmp_path))
    assert made.clear and not made.clearances[0].in_time.proven
    page = station_page(made)
    assert page.facts["proven under interlocks"] == "5 mm"
    (distances,) = [table for table in page.tables if table.title == "Distances"]
    assert [row.level for row in distances.rows] == [""]
