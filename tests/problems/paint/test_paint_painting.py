"""From part to coat: the stages, what is hidden, footprints in files."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from flyby.core.cell.cell import Cell
from flyby.core.errors import InputError
from flyby.core.program.tool import WorkObject
from flyby.core.registry import find_robot, find_vendor
from flyby.core.spatial.pose import Pose
from flyby.problems.paint.coating.sight import sight
from flyby.problems.paint.executable.execute import execute
from flyby.problems.paint.executable.station import Station
from flyby.problems.paint.executable.writing import DriveOptions
from flyby.problems.paint.initial.plan import SweepPlan
from flyby.problems.paint.painting import Judge, Painting, PaintingStage, Wishes, paint
from flyby.problems.paint.spray.footprint import Footprint, ring
from flyby.problems.paint.spray.footprint_file import load_footprint
from flyby.problems.paint.spray.strokes import section
from flyby.problems.paint.spray.trajectory import PaintTrajectory
from flyby.problems.paint.surface.part import Part
from flyby.problems.paint.thickness.options import OuterLoop
from flyby.validation.surfaces.sheets import plate, saddle

TARGET = 50e-6
BELL = ring(0.25).scaled(2e-5)
WISHES = Wishes(TARGET, SweepPlan(0.18), loop=OuterLoop(rounds=3, iterations=2), points=400)


@pytest.fixture(scope="module")
def painting() -> Painting:
    return paint(saddle(1.0, 61, 0.6), BELL, WISHES)


def test_each_stage_is_better_than_the_one_before(painting: Painting):
    start, speed, full = (
        painting.coats[s].by_area
        for s in (PaintingStage.START, PaintingStage.SPEED, PaintingStage.FULL)
    )
    assert start.mean == pytest.approx(TARGET, rel=2e-3)
    assert full.std < 0.1 * speed.std < 0.1 * start.std
    assert full.within_10_percent == 1.0
    assert np.ptp(painting.trajectories[PaintingStage.START].speeds) < 1e-9
    assert painting.best is painting.trajectories[PaintingStage.FULL]


def test_the_coat_as_emulated_is_as_even_as_planned(painting: Painting):
    place = WorkObject("part", Pose((1.4, 0.0, 0.8)))
    cell = Cell(find_robot("abb/irb6640-180-255"), "abb")
    station = Station(find_vendor("abb"), cell, part_frame=place)
    made = execute(painting, station, DriveOptions(), WISHES.limits.speed)
    full = painting.coats[PaintingStage.FULL].by_area
    assert made.coat.by_area.std < full.std + 0.5e-6
    assert made.certificate is not None and made.certificate.proven


def test_a_target_beyond_the_speeds_is_told():
    quick = replace(WISHES, loop=OuterLoop(rounds=1, iterations=1))
    with pytest.raises(InputError, match="at the least speed of 50 mm/s along the first curve"):
        paint(plate(31), BELL.scaled(0.01), quick)
    with pytest.raises(InputError, match="at the largest speed of 800 mm/s along the first curve"):
        paint(plate(31), BELL.scaled(100.0), quick)


def shaded() -> tuple[Part, Part]:
    """A plate with a small roof 0.1 m above its middle, and the plate alone."""
    base = plate(21)
    roof = plate(3, 0.2)
    vertices = np.concatenate([base.vertices, roof.vertices + np.array((0.0, 0.0, 0.1))])
    faces = np.concatenate([base.faces, roof.faces + len(base.vertices)])
    painted = np.arange(len(faces)) < len(base.faces)
    return Part.of_triangles(vertices, faces, painted), base


def test_what_is_below_something_gets_no_paint():
    part, base = shaded()
    over = PaintTrajectory.at_speed([(-0.05, 0, 0.3), (0.05, 0, 0.3)], [(0, 0, -1.0)] * 2, 0.2)
    seen = sight(part, BELL, over)
    points = part.samples.points
    # The roof's shadow from (0, 0, 0.3) on the plate is 1.5 times as wide as the roof.
    inside = np.abs(points[:, :2]).max(axis=1) < 0.14
    outside = np.abs(points[:, :2]).max(axis=1) > 0.16
    assert not seen[inside].any() and seen[outside].all()
    assert sight(base, BELL, over).all()
    hidden, free = (Judge(one, BELL, TARGET).coat(over) for one in (part, base))
    assert (hidden.thickness[inside] == 0.0).all()
    assert hidden.thickness[outside] == pytest.approx(free.thickness[outside])
    assert Judge(base, BELL, TARGET).visible(over) is None


def test_a_profile_in_a_file(tmp_path: Path):
    file = tmp_path / "bell.toml"
    file.write_text(
        "reference_distance_mm = 250\nnear_radius_mm = 35\n"
        "radius_mm = [0, 150, 250]\ngrowth_um_s = [2, 20, 0]\n"
    )
    found = load_footprint(file)
    wanted = ring(0.25).scaled(2e-5)
    r = np.linspace(0.0, 0.3, 50)
    assert found.footprint(r) == pytest.approx(wanted(r), abs=1e-12)
    assert found.footprint.source_distance == pytest.approx(wanted.source_distance)
    assert found.fit is None and found.strokes == ()


def strokes_file(tmp_path: Path, gun: Footprint) -> Path:
    file = tmp_path / "strokes.toml"
    text = "reference_distance_mm = 250\nfar_radius_mm = 250\nnear_radius_mm = 35\n"
    across = np.linspace(-0.3, 0.3, 61)
    for distance in (0.2, 0.25):
        thickness = section(gun, across, distance, 0.25)
        text += (
            f"[[stroke]]\ndistance_mm = {1e3 * distance}\nspeed_mm_s = 250\n"
            f"across_mm = {[float(1e3 * y) for y in across]}\n"
            f"thickness_um = {[float(1e6 * h) for h in thickness]}\n"
        )
    file.write_text(text)
    return file


def test_strokes_in_a_file_give_their_footprint(tmp_path: Path):
    found = load_footprint(strokes_file(tmp_path, BELL))
    r = np.linspace(0.02, 0.25, 40)  # strokes hold little of the centre
    assert found.footprint(r) == pytest.approx(BELL(r), abs=0.1 * float(BELL(r).max()))
    assert found.footprint.rate == pytest.approx(BELL.rate, rel=0.01)
    assert len(found.strokes) == 2 and found.fit is not None
    assert found.fit.rms < 0.02 * max(float(s.thickness.max()) for s in found.strokes)


PROFILE = (
    "radius_mm = [0, 150, 250]\ngrowth_um_s = {}\nreference_distance_mm = {}\nnear_radius_mm = 35\n"
)


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("radius_mm = 3 4", "is not TOML"),
        ("radius = [1]", "no such key: radius; there are"),
        ("near_radius_mm = 35", "radius_mm is missing"),
        (PROFILE.format("[2, 20, 0]", "'a'"), "finite number, not 'a'"),
        (PROFILE.format("[2, nan, 0]", 250), "growth_um_s is a list of finite numbers"),
        (PROFILE.format("[2, 0]", 250), "radius_mm, growth_um_s: as many numbers in each"),
        (PROFILE.format("[2, 20, 0]", "inf"), "reference_distance_mm is a finite number, not inf"),
        (PROFILE.format("[2, -20, 0]", 250), "paint cannot be taken away"),
        ("stroke = 3", r"one table \[\[stroke\]\]"),
        ("[[stroke]]\nacross_mm = [1]", "stroke 1: thickness_um is missing"),
    ],
)
def test_what_is_wrong_in_a_file_is_named(tmp_path: Path, text: str, message: str):
    file = tmp_path / "bell.toml"
    file.write_text(text)
    with pytest.raises(InputError, match=message) as caught:
        load_footprint(file)
    assert str(file) in str(caught.value)


def test_a_target_in_micrometres_taken_for_metres_is_refused():
    with pytest.raises(InputError, match="thickness is in metres"):
        Wishes(50.0, SweepPlan(0.18))
