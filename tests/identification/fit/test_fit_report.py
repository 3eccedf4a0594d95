"""The page of a fit and its pictures show what the fit found."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from flyby.core.motion.emulator.controller import Controller
from flyby.drawing.page.content import (
    Page,
)
from flyby.identification.fit import ParameterSet, fit, motion_file, outcomes
from flyby.identification.logs import clean
from flyby.identification.logs.synthetic import Faults
from flyby.identification.prediction import predict
from flyby.identification.report.corners import cut_corners
from flyby.identification.report.picture import (
    _nearest,
    _round_factor,
    draw_prediction,
    tcp_profiles,
)
from flyby.tasks.files.logged_runs import LoggedRuns
from flyby.tasks.pages.of_results import page_bytes, page_of
from flyby.tasks.results.identified import IdentifiedModel

from .known_truth import ROBOT, START, VENDOR, logged, ready

FITTED = ("blend.tcp.beta[0]", "time.smoothing_s[*]", "elasticity.own_s2[1]")


@pytest.fixture(scope="module")
def fitted():
    runs = [ready(logged(radius, speed)) for radius, speed in ((0.03, 0.3), (0.0, 0.5))]
    return fit(ParameterSet.named(START, FITTED), runs)


@pytest.fixture(scope="module")
def each(fitted):
    return outcomes(fitted)


@pytest.fixture(scope="module")
def file(fitted) -> str:
    return motion_file(fitted, "flyby identify <logs>")


@pytest.fixture(scope="module")
def made(fitted, each, file) -> IdentifiedModel:
    return IdentifiedModel(fitted, tuple(each), None, (), file, LoggedRuns((), (), 0), ())


def rows(page: Page, title: str) -> dict[str, tuple]:
    (table,) = (one for one in page.tables if one.title == title)
    return {row.cells[0]: tuple(row.cells[1:]) for row in table.rows}


def test_the_page_states_what_was_found(fitted, each, made) -> None:
    page = page_of(made)
    known = rows(page, "Parameters")
    for one in fitted.intervals:
        assert float(known[one.name][1]) == pytest.approx(one.value, rel=1e-4)
    left = rows(page, "Runs")
    for one in each:
        before, after, *_ = left[one.run.name]
        assert before == pytest.approx(1e3 * one.before.figures.path_max)
        assert after == pytest.approx(1e3 * one.after.figures.path_max)


def test_the_page_drives_each_run_as_emulated_and_as_measured(each, made) -> None:
    page = page_of(made)
    for one in each:
        tracks = [track for track in page.tracks if track.group == one.run.name]
        assert [(track.name, track.ghost) for track in tracks] == [
            ("before the fit", True),
            ("after it", False),
            ("measured", True),
        ]
        # On the emulation's clock, from its zero on.
        end = float(one.after.residuals.t[-1]) - one.after.alignment.offset
        assert tracks[2].duration == pytest.approx(end)


def test_the_page_says_what_samples_were_as_read(each, made) -> None:
    one = each[0]
    read = replace(one.after.figures, path_max=0.01234, joint_path_max=np.radians(0.567))
    told = replace(one, after=replace(one.after, read=read))
    notes = rows(page_of(replace(made, outcomes=(told,))), "Notes")
    (note,) = (one for one in notes if "as read" in one)
    assert "up to 12.340 mm" in note and "up to 0.567°" in note


def test_the_page_is_whole_in_one_file_and_escapes_what_it_is_told(file, made) -> None:
    shown = page_bytes(made).decode()
    assert "<logs>" in file and "<logs>" not in shown and "\\u003clogs>" in shown
    assert page_bytes(made).decode() == shown


def test_corners_are_those_of_the_program(each) -> None:
    (corner,) = cut_corners(each[0].after)
    assert (corner.waypoint, corner.move) == (1, 0)
    assert corner.radius == pytest.approx(0.03, rel=1e-6)
    assert 0 < corner.logged < corner.radius
    assert abs(corner.logged - corner.emulated) <= corner.off + 1e-5
    assert corner.off <= each[0].after.figures.path_max
    assert cut_corners(each[1].after) == []


@pytest.mark.parametrize(("run", "kind", "start"), [(0, "svg", b"<?xml"), (1, "pdf", b"%PDF")])
def test_pictures_of_runs_with_and_without_corners(each, run, kind, start) -> None:
    assert draw_prediction(each[run].before, kind).startswith(start)


def test_profiles_are_exact_on_parabolas_and_average_noise() -> None:
    rng = np.random.default_rng(1)
    t = np.sort(rng.uniform(0.0, 1.0, 200))
    tcp = np.outer(t**2, [0.3, -0.4, 1.2]) + np.arange(3.0)
    middle, speed, acceleration = tcp_profiles(t, tcp)
    # The slope of a parabola's chord: that at the middle of the window, whatever the stamps.
    assert acceleration == pytest.approx(2 * 1.3, rel=1e-6)
    assert speed == pytest.approx(2 * 1.3 * middle, abs=1e-6)
    short = tcp_profiles(t[:2], tcp[:2])
    assert all(len(values) == 2 for values in short)


def test_logs_with_holes_are_drawn() -> None:
    run = logged(0.03, 0.3, faults=Faults(noise=1e-5, hole=0.14, torn=3))
    found = predict(Controller(VENDOR, ROBOT, START), run.name, run.program, clean(run))
    assert found.log.holes
    assert draw_prediction(found, "png").startswith(b"\x89PNG")


def test_deviations_are_magnified_from_the_nearest_place_by_a_round_factor() -> None:
    line = np.array([[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [1.0, 1.0, 0.0]])
    points = np.array([[0.3, 0.1, 0.0], [1.2, 0.6, 0.0], [-1.0, 0.0, 0.0], [0.9, -0.2, 0.1]])
    feet = np.array([[0.3, 0.0, 0.0], [1.0, 0.6, 0.0], [0.0, 0.0, 0.0], [0.9, 0.0, 0.0]])
    assert _nearest(points, line) == pytest.approx(feet)
    assert [_round_factor(v) for v in (0.2, 1.9, 2.0, 49.0, 730.0)] == [1, 1, 2, 20, 500]
