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


def test_a_part_is_drawn_where_its_giver_has_it_until_it_is_taken(tmp_path: Path) -> None:
    """Each of the two cells has it; the page shows it once, and says when it changes hands."""
    made = flyby.station(hand_over(tmp_path))
    page = station_page(made)
    (giver,), (taker,) = (track.parts for track in page.tracks)
    assert giver.begins is None and giver.ends == taker.begins and taker.ends is None
    (table,) = [one for one in page.tables if one.title == "Hand-overs"]
    (row,) = table.rows
    part, left, let_go, _, right, taken, where = row.cells
    assert (part, left, right) == ("bar", "left", "right")
    assert isinstance(let_go, float) and isinstance(taken, float)
    # The giver waits until the taker holds it, and the taker until the giver is away.
    assert taken <= let_go and taken == giver.ends == row.t
    assert where == "taker.script:11"
    # There it stands with the part, on the page as well.
    track = page.tracks[1]
    at = np.searchsorted(track.motion.t.values, taken)
    assert max(abs(axis.values[at]) for axis in track.motion.dq) < 1e-6
    held = [place for place in taker.places if place.node == page.arms[1].flange]
    begins = track.moves[held[0].move].begin
    assert begins is not None and taken <= begins


def test_a_part_that_is_never_taken_stays_where_its_giver_has_it(tmp_path: Path) -> None:
    file = hand_over(tmp_path)
    script = file.parent / "giver.script"
    text = script.read_text("utf-8")
    assert "digital_out(1, True)" in text
    script.write_text(text.replace("digital_out(1, True)", "digital_out(1, False)"), "utf-8")
    made = flyby.station(file, no_proof=True)
    assert made.deadlock is not None
    page = station_page(made)
    (table,) = [one for one in page.tables if one.title == "Hand-overs"]
    assert table.rows[0].level == "error" and table.rows[0].cells[5] == "never"
    (giver,), (taker,) = (track.parts for track in page.tracks)
    assert giver.ends == taker.begins == max(track.duration for track in page.tracks)
