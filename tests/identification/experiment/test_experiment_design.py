"""What is designed is what is written, and can be driven."""

from __future__ import annotations

import json
import math
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from flyby.core.cell.cell import Cell, Obstacle
from flyby.core.cell.floor import bare_cell
from flyby.core.cell.geometry import Geometry
from flyby.core.collision.proof.certificate import certify, scenes_of
from flyby.core.dialect import MoveWords
from flyby.core.errors import InputError
from flyby.core.motion.emulator.controller import Controller
from flyby.core.program.move import MoveC, MoveJ, MoveL
from flyby.core.program.program import Program
from flyby.core.program.target import JointTarget
from flyby.core.program.tool import Tool
from flyby.core.program.zone import ContourFraction
from flyby.core.registry import find_robot, find_vendor
from flyby.core.robot.joint import ExternalAxis, ExternalRole, Joint
from flyby.core.robot.shape import Box
from flyby.core.source.patch.edits import difference
from flyby.core.spatial.pose import Pose
from flyby.identification.experiment import postures
from flyby.identification.experiment.design import _unlabelled, design, main_file
from flyby.identification.experiment.kinds import Kind
from flyby.identification.experiment.page import page
from flyby.identification.experiment.plan import Plan
from flyby.identification.experiment.record import record
from flyby.identification.logs import load_run

from .designs import ROBOTS, SMALL, designed

each_robot = pytest.mark.parametrize("name", ROBOTS)


def tcp(robot, q) -> np.ndarray:
    return robot.forward(np.asarray(q))[1]


def leaving(robot, move, at: np.ndarray, end: np.ndarray, q: np.ndarray) -> np.ndarray:
    """Direction in which a move that ends at ``end`` leaves ``at``, or, backwards, arrives there.

    Arcs: the tangent of the circle through three points. Joint moves: a millionth of the way.
    """
    if isinstance(move, MoveJ):
        way = tcp(robot, q[0] + 1e-6 * (q[1] - q[0])) - at
    elif isinstance(move, MoveC):
        via = np.array(move.via.pose.position)
        a, b = via - at, end - at
        # The tangent at the first point: a |b|² − b |a|², turned to the side of the second one.
        way = a * (b @ b) - b * (a @ a)
    else:
        way = end - at
    return way / np.linalg.norm(way)


@each_robot
def test_corners_are_as_designed(name: str) -> None:
    made = designed(name)
    robot = made.robot
    corners = 0
    for run in made.runs:
        if not run.candidate.corners:
            continue
        ends = run.run.path.route.ends
        moves = [run.program.moves[k] for k in run.run.path.route.moves]
        passed = [k for k in range(len(moves) - 1) if k % 2 == 0]
        assert len(passed) == len(run.candidate.corners)
        for k, corner in zip(passed, run.candidate.corners, strict=True):
            first, then = moves[k], moves[k + 1]
            assert first.zone.tcp == pytest.approx(corner.radius, rel=1e-5)
            q = ends.q
            begin, at, end = (tcp(robot, x) for x in (q[k, 0], q[k, 1], q[k + 1, 1]))
            into = -leaving(robot, first, at, begin, q[k][::-1])
            out = leaving(robot, then, at, end, q[k + 1])
            turn = math.acos(np.clip(into @ out, -1, 1))
            assert math.degrees(turn) == pytest.approx(math.degrees(corner.turn), abs=0.05)
            corners += 1
    assert corners >= 3 * 4


@each_robot
def test_limits_and_speeds_hold(name: str) -> None:
    made = designed(name)
    vendor = find_vendor(name.partition("/")[0])
    limits = made.robot.limits
    kinds = {run.candidate.kind for run in made.runs}
    assert kinds == set(SMALL.kinds), made.skipped
    for run in made.runs:
        start = JointTarget(tuple(run.candidate.start))
        driven = Controller(vendor, made.robot).run(run.program, start, 0.002).trajectory
        room = np.minimum(driven.q - limits.lower, limits.upper - driven.q)
        assert room.min() > made.plan.margin - 2e-5
        assert (np.abs(driven.dq) < 1.01 * limits.velocity).all()
        rate = np.linalg.norm(np.diff(driven.position, axis=0), axis=1) / 0.002
        if run.candidate.kind in (Kind.LINES, Kind.LINES_AND_ARCS):
            assert rate.max() == pytest.approx(run.candidate.speed, rel=0.02)
        assert run.certificate.proven
        assert driven.duration == pytest.approx(run.duration, abs=0.01)


@each_robot
def test_sources_and_records_hold_the_same_program(name: str, tmp_path: Path) -> None:
    made = designed(name)
    vendor = find_vendor(name.partition("/")[0])
    for run in made.runs:
        for file, text in run.sources.items():
            (tmp_path / file).write_bytes(text.encode())
        read = vendor.read_file(tmp_path / main_file(run.sources, vendor), robot=made.robot)
        told = record(run, made.robot, "run.csv", made.period, run.sources)
        (tmp_path / "run.json").write_text(json.dumps(told), "utf-8")
        header = ",".join(["t", *(f"q{k}" for k in range(1, 7))])
        rows = np.column_stack([0.008 * np.arange(9), np.tile(run.candidate.start, (9, 1))])
        np.savetxt(tmp_path / "run.csv", rows, delimiter=",", header=header, comments="")
        loaded = load_run(tmp_path / "run.json", find_robot)
        assert loaded.robot == name
        assert loaded.program.start.joints == pytest.approx(run.candidate.start)
        assert told["design"]["start_rad"] == run.candidate.start.tolist()
        again = _unlabelled(loaded.program)
        # RAPID's quaternions are of length 1 to single precision; records' are exactly.
        assert difference(_unlabelled(read), again, 1e-7) is None
        # They differ from the design by no more than the language's precision.
        assert difference(_unlabelled(run.candidate.program), again, 2e-6) is None


@pytest.mark.parametrize("name", ROBOTS[1:3])
def test_a_seed_gives_one_design(name: str) -> None:
    vendor = find_vendor(name.partition("/")[0])
    plan = replace(SMALL, kinds=(Kind.LINES,))
    cell = Cell(find_robot(name), vendor.name)
    first, again, other = (
        design(vendor, cell, replace(plan, seed=seed), bare=True) for seed in (5, 5, 6)
    )
    texts = [[run.sources for run in made.runs] for made in (first, again, other)]
    assert texts[0] == texts[1] != texts[2]
    assert page(first, None) == page(again, None)


def test_what_is_not_possible_is_said() -> None:
    plan = replace(SMALL, radii=(0.01, 0.15), speeds=(0.1, 2.5), kinds=(Kind.LINES,))
    made = designed("kuka/kr3-r540", plan)
    said = {entry.what: entry.reason for entry in made.skipped}
    assert "longer legs" in said["lines at 100 mm/s, posture 1, zone 150 mm"]
    assert "speed would not be reached" in said["lines at 2500 mm/s, posture 1"]
    text = page(made, "cell.toml")
    assert "<h2>Not possible</h2>" in text and "lines at 2500 mm/s" in text and "cell.toml" in text


def test_time_is_kept() -> None:
    plan = replace(SMALL, minutes=4.0, overhead=70.0)
    made = designed("ur/ur10e", plan)
    assert 2 <= len(made.runs) <= 3 and made.seconds <= 240.0
    assert made.unused and any("has no place in the time" in note for note in made.notes)


def cell_of(name: str, *boxes: tuple[tuple[float, ...], tuple[float, ...]]) -> Cell:
    obstacles = tuple(
        Obstacle(f"box {k}", Geometry(Box(edges), Pose(place)))
        for k, (edges, place) in enumerate(boxes)
    )
    return Cell(find_robot(name), name.partition("/")[0], 0.01, obstacles=obstacles)


def test_obstacles_are_kept_clear_of(monkeypatch: pytest.MonkeyPatch) -> None:
    vendor = find_vendor("ur")
    cell = cell_of("ur/ur10e", ((3.0, 3.0, 0.1), (0, 0, -0.1)), ((0.1, 3.0, 2.0), (1.0, 0, 0.5)))
    plan = replace(SMALL, kinds=(Kind.LINES, Kind.SINGLE_AXES), postures=2)
    made = design(vendor, cell, plan, bare=False)
    assert made.runs
    for run in made.runs:
        proof = certify(Controller(vendor, cell.robot), run.run, scenes_of(cell), cell.clearance)
        assert proof.proven
        assert run.run.trajectory.position[:, 0].max() < 0.95
    assert made.runs[0].way_proven is None
    assert all(run.way_proven is not None for run in made.runs[1:])
    monkeypatch.setattr(postures, "_TRIES", 100)
    full = cell_of("ur/ur10e", ((0.8, 3.0, 3.0), (0.75, 0, 0.5)))
    with pytest.raises(InputError, match="no posture"):
        design(vendor, full, plan, bare=False)


def test_without_a_cell_nothing_goes_below_the_base() -> None:
    """Of a robot that hangs, the plane is above: nothing goes through the ceiling."""
    hanging = find_robot("kuka/kr3-r540").with_base(Pose((0.0, 0.0, 2.0), (0.0, 1.0, 0.0, 0.0)))
    plan = replace(SMALL, kinds=(Kind.JOINTS, Kind.SINGLE_AXES), postures=2)
    made = design(find_vendor("kuka"), bare_cell(hanging, "kuka"), plan, bare=True)
    assert len(made.runs) > 1
    for run in made.runs:
        for q in run.run.trajectory.q[::5]:
            assert hanging.flange_pose(q).position[2] < 2.0
    # Every way between runs is looked at, too.
    assert all(run.way_proven is not None for run in made.runs[1:])
    assert any("the plane under the base" in note for note in made.notes)
    low = replace(plan, postures=(np.radians([0.0, 10.0, 60.0, 0.0, 50.0, 0.0]),))
    with pytest.raises(InputError, match="no_floor=True"):
        design(find_vendor("kuka"), bare_cell(hanging, "kuka"), low, bare=True)
    assert design(find_vendor("kuka"), bare_cell(hanging, "kuka", floor=False), low, bare=True).runs


def test_what_cannot_be_said_is_refused() -> None:
    kuka, robot = find_vendor("kuka"), find_robot("kuka/kr3-r540")
    cell = Cell(robot, "kuka")
    with pytest.raises(InputError, match="kuka has no recorder"):
        design(replace(kuka, recorder=None), cell, SMALL, bare=True)
    with pytest.raises(InputError, match="Java"):
        design(kuka, Cell(find_robot("kuka/iiwa7-r800"), "kuka"), SMALL, bare=True)
    words = MoveWords((ContourFraction,), kuka.speaks.joint.speeds)
    without = replace(kuka, speaks=replace(kuka.speaks, joint=words))
    with pytest.raises(InputError, match="no zone with a radius for MoveJ"):
        design(without, cell, SMALL, bare=True)
    with pytest.raises(InputError, match="3000 mm/s at most"):
        design(kuka, cell, replace(SMALL, kinds=(Kind.LINES,), speeds=(5.0,)), bare=True)
    joint = Joint("E1", Pose(), (0.0, 0.0, 1.0), -1.0, 1.0, 1.0, 1.0)
    track = robot.with_external_axes([ExternalAxis(joint, ExternalRole.TABLE)])
    with pytest.raises(InputError, match="external axes"):
        design(kuka, Cell(track, "kuka"), SMALL, bare=True)
    singular = replace(SMALL, postures=(np.array([0.0, -1.5, 1.5, 0.0, 0.0, 0.0]),))
    with pytest.raises(InputError, match="singular"):
        design(kuka, cell, singular, bare=True)


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"turns": (math.pi,)}, "angles: 180°"),
        ({"turns": ()}, "angles: an experiment needs"),
        ({"radii": (-0.01,)}, "zones"),
        ({"speeds": (0.1, 0.1)}, "given twice"),
        ({"speeds": (math.nan,)}, "speeds"),
        ({"postures": 0}, "1 to 99"),
        ({"minutes": 0.0}, "minutes: must be above zero"),
        ({"overhead": -1.0}, "overhead"),
        ({"longest": math.inf}, "longest"),
        ({"kinds": ()}, "kinds: an experiment needs at least one"),
        ({"tool": Tool("fixed", robot_held=False)}, "stands still"),
    ],
)
def test_nonsense_is_refused(change: dict, message: str) -> None:
    with pytest.raises(InputError, match=message):
        Plan(**change)


def test_a_robot_on_a_pedestal_has_the_same_records() -> None:
    """Poses of records are in the robot's base."""
    vendor, plan = find_vendor("abb"), replace(SMALL, kinds=(Kind.LINES,))
    robot = find_robot(ROBOTS[0])
    half = math.sqrt(0.5)
    moved = robot.with_base(Pose((0.5, -0.25, 1.0), (half, 0.0, 0.0, half)))
    made = design(vendor, Cell(moved, "abb"), plan, bare=True)
    for run in made.runs:
        told = record(run, moved, "run.csv", made.period, run.sources)
        assert told["robot"] == robot.name
        ends = run.run.path.route.ends.q
        lines = [entry for entry in told["moves"] if entry["type"] == "MoveL"]
        assert len(lines) == len(ends)
        for entry, q in zip(lines, ends[:, 1], strict=True):
            assert entry["target_pose"]["xyz_m"] == pytest.approx(tcp(robot, q), abs=1e-5)
        assert isinstance(run.program.moves[1], MoveL)
        assert isinstance(run.program, Program)
