"""The figures of a report, against other ways to find them."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import flyby
from flyby.core.arrays import FloatArray
from flyby.core.driving.driven_program import DrivenProgram
from flyby.core.motion.emulator.controller import Controller
from flyby.core.motion.emulator.run import Run
from flyby.core.program.move import MoveC, MoveJ, MoveL, Statement, Wait
from flyby.core.program.program import Program
from flyby.core.program.speed import Speed
from flyby.core.program.target import JointTarget, PoseTarget
from flyby.core.program.zone import FINE, Radius
from flyby.core.registry import find_robot, find_vendor
from flyby.core.robot.kinematics.chain_kernels import poses
from flyby.core.spatial.pose import Pose
from flyby.drawing.geometry import path_geometry
from flyby.tasks.results.report import Report, make_report, target_text

ROBOT = find_robot("abb/irb6640-180-255")
CONTROLLER = Controller(find_vendor("abb"), ROBOT)
HOME = JointTarget((0.0, 0.0, 0.0, 0.0, np.pi / 2, 0.0))
Small = Callable[..., Path]


def drive(path: Path) -> tuple[Run, Report]:
    run = CONTROLLER.run(find_vendor("abb").read_file(path))
    return run, make_report(DrivenProgram.faultless(run), ROBOT)


def target(x: float, y: float, z: float = 0.9) -> PoseTarget:
    return PoseTarget(Pose((x, y, z), (0.0, 0.0, 1.0, 0.0)))


radii = st.sampled_from([0.001, 0.01, 0.03, 0.2])
steps = st.tuples(st.floats(0.05, 0.2), st.floats(-0.15, 0.15), radii, st.sampled_from("JL"))


def legs_of(legs: list[tuple[float, float, float, str]], speed: float) -> list[MoveJ | MoveL]:
    """A way from `HOME` to a first stop and along legs."""
    x, y = 1.2, 0.0
    moves: list[MoveJ | MoveL] = [MoveJ(target(x, y), Speed(tcp=1.0), FINE)]
    for dx, dy, radius, kind in legs:
        x, y = x + dx, y + dy
        make = MoveJ if kind == "J" else MoveL
        moves.append(make(target(x, y), Speed(tcp=speed), Radius(radius)))
    return moves


def stamped_positions(run: Run, t: FloatArray) -> FloatArray:
    """(T, 3) m of the TCP before anything is averaged over time; all moves have one tool."""
    return poses(run.path.route.chains[0], run.timing.states_at(t)[0])[1]


@settings(max_examples=25, deadline=None)
@given(st.lists(steps, min_size=1, max_size=5), st.floats(0.05, 2.0))
def test_the_figures_agree_with_the_motion(
    legs: list[tuple[float, float, float, str]], speed: float
) -> None:
    moves = legs_of(legs, speed)
    run = CONTROLLER.run(Program(tuple(moves), start=HOME), period=0.001)
    report = make_report(DrivenProgram.faultless(run), ROBOT)

    t = np.arange(0.0, run.duration, 0.001)
    walked = np.linalg.norm(np.diff(stamped_positions(run, t), axis=0), axis=1)
    assert report.length == pytest.approx(walked.sum(), rel=1e-3, abs=1e-5)
    assert report.top_speed == pytest.approx(walked.max() / 0.001, rel=0.05)
    for move, row in zip(moves, report.moves, strict=True):
        assert row.top_speed <= (move.speed.tcp or np.inf) * (1 + 1e-6)
        assert sum(limit.share for limit in row.limits) == pytest.approx(1.0)
        assert list(row.limits) == sorted(row.limits, key=lambda limit: -limit.share)
        if isinstance(move.zone, Radius):
            assert max(row.zone.entry, row.zone.exit) <= move.zone.tcp * (1 + 1e-6)
    assert report.moves[-1].zone.stops


MODELS = {
    "as fitted": CONTROLLER.model,
    "stops in position": replace(CONTROLLER.model, in_position=0.02, in_position_time=0.12),
    "nothing averaged": find_vendor("abb").motion(),
    "time comes up to speed": replace(CONTROLLER.model, start_ramp=0.15, settling=None),
}
waits = st.lists(st.sampled_from([0.0, 0.0, 0.2]), min_size=6, max_size=6)


@pytest.mark.parametrize("name", MODELS)
@settings(max_examples=8, deadline=None)
@given(st.lists(steps, min_size=1, max_size=5), st.floats(0.05, 2.0), waits)
def test_times_add_up_and_are_those_of_the_samples(
    name: str, legs: list[tuple[float, float, float, str]], speed: float, rests: list[float]
) -> None:
    model, statements = MODELS[name], list[Statement]()
    for move, rest in zip(legs_of(legs, speed), rests, strict=False):
        statements += [Wait(rest), move] if rest else [move]
    run = Controller(find_vendor("abb"), ROBOT, model).run(Program(tuple(statements), start=HOME))
    report = make_report(DrivenProgram.faultless(run), ROBOT)

    rows = report.moves
    spent = [row.time + row.wait + row.settling for row in rows]
    assert report.first_wait + sum(spent) == pytest.approx(report.cycle_time, abs=1e-9)
    assert report.moving + report.waiting + report.settling == pytest.approx(report.cycle_time)
    assert report.waiting == pytest.approx(sum(rests[: len(rows)]))
    assert report.first_wait == rests[0]
    begins = [row.begin for row in rows]
    assert begins == pytest.approx(report.first_wait + np.cumsum([0.0, *spent[:-1]]), abs=1e-9)
    assert min(row.settling for row in rows) >= 0.0
    assert (report.settling > 0.0) == any(model.smoothing)
    # Samples on the way, not those that rest, belong to a move from when it begins.
    t, sigma = run.trajectory.t, run.trajectory.sigma
    clear = np.abs(t[:, None] - np.array(begins)).min(axis=1) > 1e-6
    clear[1:-1] &= (sigma[1:-1] > sigma[:-2]) & (sigma[2:] > sigma[1:-1])
    expected = np.maximum(np.searchsorted(begins, t, side="right") - 1, 0)
    assert (run.trajectory.move == expected)[clear][1:-1].all()


def test_lengths_of_lines_and_arcs(small: Small) -> None:
    run, report = drive(
        small(
            "MoveL Offs(p1,100,0,0), v200, fine, tool0",
            "MoveC Offs(p1,150,50,0), Offs(p1,100,100,0), v200, fine, tool0",
        )
    )
    assert [move.length for move in report.moves[1:]] == pytest.approx([0.1, 0.05 * np.pi])
    assert [move.kind for move in report.moves] == ["MoveJ", "MoveL", "MoveC"]
    assert not report.moves[0].driven
    assert report.length == pytest.approx(0.1 + 0.05 * np.pi)
    arc = path_geometry(run, ROBOT).nominal[1]
    assert np.linalg.norm(arc - [1.4, 0.15, 0.9], axis=1) == pytest.approx(0.05)
    assert isinstance(run.program.moves[2], MoveC)


def test_a_cut_zone_is_reported_with_its_place(small: Small) -> None:
    program = small(
        "MoveL Offs(p1,100,0,0), v200, z50, tool0",
        "MoveL Offs(p1,100,40,0), v200, z50, tool0",
        "MoveL Offs(p1,300,40,0), v200, fine, tool0",
    )
    run, report = drive(program)
    cut = report.moves[1].zone
    assert (cut.name, cut.radius) == ("z50", 0.05)
    assert (cut.entry, cut.exit) == pytest.approx((0.02, 0.02))
    notes = [note for note in report.notes if "cut to 20 mm" in note.message]
    assert [(note.move, note.span and note.span.line) for note in notes] == [(1, 6), (2, 7)]
    assert path_geometry(run, ROBOT).radius == pytest.approx([0, 0.02, 0.02, 0])


def test_a_wait_makes_a_zone_a_stop(small: Small) -> None:
    _, report = drive(
        small(
            "MoveL Offs(p1,100,0,0), v200, z50, tool0",
            "WaitTime 0.7",
            "MoveL Offs(p1,100,200,0), v200, fine, tool0",
        )
    )
    assert report.moves[1].zone.stops
    assert report.moves[1].wait == pytest.approx(0.7)
    assert report.waiting == pytest.approx(0.7)


def test_what_limits_a_move(small: Small) -> None:
    _, report = drive(
        small(
            "MoveL Offs(p1,200,0,0), v50, fine, tool0",
            "MoveAbsJ [[160,0,0,0,90,0],[9E9,9E9,9E9,9E9,9E9,9E9]], vmax, fine, tool0",
            "MoveAbsJ [[161,0,0,0,90,0],[9E9,9E9,9E9,9E9,9E9,9E9]], vmax, fine, tool0",
            "MoveJ Offs(p1,0,0,0), v100\\T:=20, fine, tool0",
        )
    )
    slow, fast, short, timed = report.moves[1:]
    assert slow.limits[0].name == "programmed TCP speed"
    assert slow.limits[0].share > 0.9
    assert fast.limits[0].name == "J1 velocity"
    assert short.limits[0].name == "J1 torque"
    assert short.limits[0].share == pytest.approx(1.0)
    assert timed.limits[0].name == "programmed time"
    assert timed.time == pytest.approx(20, rel=1e-4)


def test_the_drawn_path_runs_from_waypoint_to_waypoint(small: Small) -> None:
    run, _ = drive(
        small(
            "MoveL Offs(p1,100,0,0), v200, z10, tool0",
            "MoveJ Offs(p1,100,200,0), v200, z10, tool0",
            "MoveL Offs(p1,0,200,0), v200, fine, tool0",
        )
    )
    geometry = path_geometry(run, ROBOT)
    assert len(geometry.nominal) == 3
    for points, start, end in zip(
        geometry.nominal, geometry.waypoints[:-1], geometry.waypoints[1:], strict=True
    ):
        assert points[0] == pytest.approx(start, abs=1e-9)
        assert points[-1] == pytest.approx(end, abs=1e-9)
    assert geometry.waypoints[0] == pytest.approx(run.trajectory.position[0])
    assert geometry.waypoints[-1] == pytest.approx(run.trajectory.position[-1])


def test_computed_targets_are_named_as_they_are_written(tmp_path: Path) -> None:
    points = "[[1200,0,{z}],[0,0,1,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]]"
    program = tmp_path / "m.mod"
    program.write_text(
        "MODULE M\n"
        f" CONST robtarget p10 := {points.format(z=900)};\n"
        " PROC main()\n"
        "  MoveJ p10, v1000, z10, tool0;\n"
        "  MoveL Offs(p10, 0,\n    100, 50), v500, z10, tool0;\n"
        "  MoveL RelTool(p10, 0, 0, -50 \\Rz:=10), v500, fine, tool0;\n"
        "  MoveL RelTool(RelTool(p10, 0, 0, -50), 10, 20, 30 \\Rx:=10), v500, fine, tool0;\n"
        f"  MoveL {points.format(z=800)}, v500, fine, tool0;\n"
        " ENDPROC\nENDMODULE\n",
        "utf-8",
    )
    moves = flyby.emulate(flyby.read(program, robot="abb/irb6640-180-255")).report.moves
    assert [target_text(move) for move in moves] == [
        "p10",
        "Offs(p10, 0, 100, 50)",
        "RelTool(p10, 0, 0, -50 \\Rz:=10)",
        "RelTool(RelTool(p10, 0, 0, -50), 10, 20…",
        "1200.0, 0.0, 800.0",
    ]
    assert moves[3].expression == "RelTool(RelTool(p10, 0, 0, -50), 10, 20, 30 \\Rx:=10)"
