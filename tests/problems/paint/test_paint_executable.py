"""Painting trajectories as programs: how the gun is held, what is driven, what comes of it."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest
import trimesh
from hypothesis import given, settings
from hypothesis import strategies as st

from flyby.core.arrays import FloatArray
from flyby.core.cell.cell import Cell
from flyby.core.collision.scene.scene import CollisionScene
from flyby.core.errors import InputError, MotionError
from flyby.core.motion.emulator.controller import Controller
from flyby.core.program.move import MoveJ
from flyby.core.program.tool import WORLD, Tool, WorkObject
from flyby.core.registry import find_robot, find_vendor
from flyby.core.spatial.pose import Pose
from flyby.problems.paint.coating.coat import Coat, coat
from flyby.problems.paint.executable.emulated import EmulatedPainting, drive
from flyby.problems.paint.executable.feedback import drive_evenly
from flyby.problems.paint.executable.frames import gun_frames, turned
from flyby.problems.paint.executable.lag import lag_notes
from flyby.problems.paint.executable.spin import GunPosture, choose_posture
from flyby.problems.paint.executable.station import PLAIN_GUN, Station
from flyby.problems.paint.executable.writing import DriveOptions, paint_program, with_run_in
from flyby.problems.paint.spray.signals import GunSignals
from flyby.problems.paint.spray.trajectory import PaintTrajectory
from flyby.problems.paint.surface.part import Part

from .paint_cases import TARGET, plate_case, wandering

ABB, ROBOT = find_vendor("abb"), find_robot("abb/irb6640-180-255")
SPEED = (0.05, 0.8)


def station(x: float = 1.0, vendor: str = "abb", robot: str = "abb/irb6640-180-255") -> Station:
    cell = Cell(find_robot(robot), vendor)
    place = WorkObject("part", Pose((x, -0.5, 0.5)))
    return Station(find_vendor(vendor), cell, part_frame=place)


@pytest.fixture(scope="module")
def held() -> tuple[PaintTrajectory, GunPosture]:
    """The sweeps over the metre plate, and how the robot holds the gun."""
    planned = with_run_in(plate_case(0.25, 11)[1], 0.05)
    return planned, choose_posture(planned, station())


def test_the_robot_holds_the_gun_as_planned(held: tuple[PaintTrajectory, GunPosture]):
    planned, posture = held
    here = station()
    world = planned.moved(here.place)
    assert np.allclose(posture.rotation[:, :, 2], world.nozzle, atol=1e-9)
    R, p = ROBOT.forward(posture.joints)
    tcp = here.gun.tcp.matrix()
    assert np.allclose(p + R @ tcp[:3, 3], world.position, atol=1e-8)
    assert np.allclose(R @ tcp[:3, :3], posture.rotation, atol=1e-8)
    limits = ROBOT.limits
    assert (limits.lower <= posture.joints).all() and (posture.joints <= limits.upper).all()


def test_joints_keep_to_their_speeds(held: tuple[PaintTrajectory, GunPosture]):
    planned, posture = held
    rate = np.abs(np.diff(posture.joints, axis=0)) / planned.duration[:, None]
    assert (rate < 0.5 * ROBOT.limits.velocity).all()


def test_where_a_posture_collides_another_branch_is_taken(held: tuple[PaintTrajectory, GunPosture]):
    planned, cheapest = held
    tried: list[GunPosture] = []

    def clear(joints: FloatArray) -> bool:
        tried.append(GunPosture(cheapest.rotation, joints))
        return len(tried) == 2

    other = choose_posture(planned, station(), clear)
    assert np.array_equal(tried[0].joints, cheapest.joints)
    assert other.joints is tried[1].joints
    assert np.abs(other.joints - cheapest.joints).max() > 0.5
    R, p = ROBOT.forward(other.joints)
    here = station()
    assert np.allclose(p + R @ here.gun.tcp.matrix()[:3, 3], planned.moved(here.place).position)
    # Where all collide, a proof shall say with what.
    none = choose_posture(planned, station(), lambda joints: False)
    assert np.array_equal(none.joints, cheapest.joints)


def test_a_fan_is_held_the_same_way_round_all_along():
    plain = plate_case(0.25, 5)[1]
    fan = np.tile((0.0, 1.0, 0.0), (len(plain.position), 1))
    planned = replace(plain, fan=fan)
    here = station()
    side = choose_posture(planned, here).rotation[:, :, 0] @ fan[0]
    assert np.allclose(side, side[0]) and abs(side[0]) == pytest.approx(1.0)


def test_a_closed_part_is_closed_for_the_proof_too():
    """Its painted skin has copies of vertices along sharp edges."""
    box = trimesh.creation.box((0.2, 0.2, 0.1))
    up = box.face_normals[:, 2] > 0.9
    part = Part.of_triangles(np.array(box.vertices), np.array(box.faces), up)
    assert len(part.vertices) > 8
    cell = station().with_part(part, ("gun",)).cell
    assert not any("watertight" in str(note) for note in CollisionScene(cell, PLAIN_GUN).notes)


def test_a_stretch_out_of_reach_is_named(held: tuple[PaintTrajectory, GunPosture]):
    planned, _ = held
    with pytest.raises(MotionError, match=r"cannot reach .*waypoint.* m along the curve.* mm of"):
        choose_posture(planned, station(1.9))


@settings(max_examples=25, deadline=None)
@given(st.integers(0, 10_000), st.integers(2, 9), st.floats(-7.0, 7.0))
def test_frames_have_the_nozzle_for_their_z_axis(seed: int, waypoints: int, turn: float):
    planned = wandering(waypoints, seed)
    frames = gun_frames(planned)
    for rotation in (frames, turned(frames, np.full(waypoints, turn))):
        assert np.allclose(rotation[:, :, 2], planned.nozzle, atol=1e-12)
        assert np.allclose(np.swapaxes(rotation, 1, 2) @ rotation, np.eye(3), atol=1e-12)
        assert np.allclose(np.linalg.det(rotation), 1.0)


def test_frames_turn_no_more_than_the_nozzle():
    planned = wandering(12, 3)
    frames = gun_frames(planned)
    between = np.swapaxes(frames[:-1], 1, 2) @ frames[1:]
    angle = np.arccos(np.clip(0.5 * (np.trace(between, axis1=1, axis2=2) - 1.0), -1.0, 1.0))
    nozzle = np.arccos(np.einsum("ij,ij->i", planned.nozzle[1:], planned.nozzle[:-1]))
    assert np.allclose(angle, nozzle, atol=1e-7)


def test_a_fan_keeps_its_direction():
    planned = wandering(4, 5, fan=True)
    x = gun_frames(planned)[:, :, 0]
    assert planned.fan is not None
    flat = (
        planned.fan - np.einsum("ij,ij->i", planned.fan, planned.nozzle)[:, None] * planned.nozzle
    )
    assert np.allclose(x, flat / np.linalg.norm(flat, axis=1, keepdims=True))


def test_run_in_goes_straight_on_with_the_gun_off():
    planned = plate_case(0.25, 5)[1]
    longer = with_run_in(planned, 0.05)
    assert np.allclose(longer.lengths[[0, -1]], 0.05)
    assert np.allclose(longer.speeds[[0, -1]], planned.speeds[[0, -1]])
    assert longer.flow[0] == longer.flow[-1] == 0.0
    step = np.diff(longer.position, axis=0) / longer.lengths[:, None]
    assert np.allclose(step[0], step[1]) and np.allclose(step[-1], step[-2])
    assert with_run_in(planned, 0.0) is planned


def test_the_program_switches_the_gun_at_its_waypoints(held: tuple[PaintTrajectory, GunPosture]):
    planned, posture = held
    options = DriveOptions(signals=GunSignals("doGun", delay=0.04))
    program = paint_program(planned, posture, station(), options)
    assert isinstance(program.moves[0], MoveJ) and len(program.moves) == planned.segments + 1
    switched = [(k, e.text) for k, move in enumerate(program.moves) for e in move.events]
    assert switched == [(1, "doGun,1"), (planned.segments - 1, "doGun,0")]
    (text,) = ABB.write(program, ROBOT).values()
    assert "TriggIO trigg10,0.04\\Time\\DOp:=doGun,1;" in text
    assert "z20,gun\\WObj:=part" in text
    again = ABB.read(text, "paint.mod", robot=ROBOT)
    assert [m.speed.tcp for m in again.moves[1:]] == pytest.approx(list(planned.speeds), rel=1e-4)


def test_without_run_in_the_gun_goes_on_where_the_robot_stands():
    planned = plate_case(0.25, 5)[1]
    posture = choose_posture(planned, station())
    program = paint_program(planned, posture, station(), DriveOptions(signals=GunSignals("doGun")))
    (text,) = ABB.write(program, ROBOT).values()
    assert "TriggIO trigg10,0\\Start\\DOp:=doGun,1;" in text


@pytest.mark.parametrize(("vendor", "robot"), [("kuka", "kuka/kr30-3"), ("ur", "ur/ur10e")])
def test_other_vendors_programs_drive_alike(vendor: str, robot: str):
    """As read back from their texts; a small plate that small robots reach."""
    whole = plate_case(0.25, 5)[1]
    small = replace(whole, position=whole.position * (0.35, 0.35, 1.0))
    where = Station(
        find_vendor(vendor),
        Cell(find_robot(robot), vendor),
        part_frame=WorkObject("part", Pose((0.55, -0.18, 0.05))),
    )
    planned = with_run_in(small, 0.03)
    posture = choose_posture(planned, where)
    signals = None if vendor == "ur" else GunSignals("5", delay=0.02)
    program = paint_program(planned, posture, where, DriveOptions(0.01, signals=signals))
    sources = where.vendor.write(program, where.cell.robot)
    text = "\n".join(sources.values())
    assert (vendor == "kuka") == ("DELAY=-20 DO $OUT[5]=TRUE" in text)
    assert program.moves[1].work_object == (WORLD if vendor == "ur" else where.part_frame)
    driven = drive(Controller(where.vendor, where.cell.robot), program, planned, where)
    assert_near(driven, planned, 0.01)


def assert_near(driven: EmulatedPainting, planned: PaintTrajectory, zone: float) -> None:
    """The driven TCP stays within a zone's size of the planned path."""
    along = np.concatenate(([0.0], np.cumsum(planned.lengths)))
    places = np.arange(0.0, along[-1], 1e-3)
    path = np.stack([np.interp(places, along, axis) for axis in planned.position.T], axis=1)
    gaps = np.linalg.norm(driven.trajectory.position[:, None] - path[None], axis=2).min(axis=1)
    assert gaps.max() < zone


def test_what_is_driven_is_what_was_planned_but_for_corners(
    held: tuple[PaintTrajectory, GunPosture],
):
    planned, posture = held
    program = paint_program(planned, posture, station(), DriveOptions())
    driven = drive(Controller(ABB, ROBOT), program, planned, station())
    assert_near(driven, planned, 0.02)
    assert driven.trajectory.nozzle == pytest.approx(
        np.tile((0, 0, -1.0), (len(driven.trajectory.nozzle), 1)), abs=2e-3
    )
    assert (np.diff(driven.passed) > 0.0).all()
    spent = np.asarray(driven.share.sum(axis=0)).ravel()
    assert spent == pytest.approx(np.diff(driven.passed), abs=1e-9)
    painted = float(driven.trajectory.duration @ driven.trajectory.flow)
    assert painted == pytest.approx(driven.passed[-2] - driven.passed[1], abs=1e-9)


@pytest.mark.parametrize("zone", [0.01, 0.05])
def test_speeds_make_up_for_the_controller(held: tuple[PaintTrajectory, GunPosture], zone: float):
    """Even a path with corners and one speed gets a better coat than it had."""
    planned, posture = held
    deposition, start = plate_case(0.25, 21)
    controller = Controller(ABB, ROBOT)
    options = DriveOptions(zone)
    made = drive_evenly(controller, planned, posture, station(), options, deposition, TARGET, SPEED)
    best = coat(deposition, start, TARGET).by_area.std
    assert made.coat.by_area.std == min(made.rounds) < made.rounds[0]
    assert made.coat.by_area.std < best - 1e-6
    assert (made.planned.speeds <= SPEED[1] * (1 + 1e-9)).all()
    assert (made.planned.speeds >= SPEED[0] * (1 - 1e-9)).all()


def test_progress_ends_the_rounds(held: tuple[PaintTrajectory, GunPosture]):
    planned, posture = held
    deposition, _ = plate_case(0.25, 11)
    seen: list[int] = []

    def enough(number: int, found: object) -> bool:
        seen.append(number)
        return True

    made = drive_evenly(
        Controller(ABB, ROBOT),
        planned,
        posture,
        station(),
        DriveOptions(),
        deposition,
        TARGET,
        SPEED,
        progress=enough,
    )
    assert seen == [0] and len(made.rounds) == 1


def test_a_station_checks_who_holds_what():
    fixed = Tool("gun", robot_held=False)
    with pytest.raises(InputError, match="the robot holds the gun"):
        Station(ABB, Cell(ROBOT, "abb"), fixed)
    with pytest.raises(InputError, match="may move"):
        Station(ABB, Cell(ROBOT, "abb"), part_frame=WorkObject("part", moved_by="table"))


def test_zones_are_the_vendors_own_where_there_are_any():
    assert station().zone(0.02).name == "z20"
    assert station().zone(0.023).name is None
    assert station().zone(0.023).reorientation == pytest.approx(0.0345)
    assert math.isclose(station(vendor="ur", robot="ur/ur10e").zone(0.02).reorientation, 0.02)


def test_a_robot_that_does_not_keep_up_is_told_with_the_stretch() -> None:
    position = np.stack([0.1 * np.arange(6), np.zeros(6), np.full(6, 0.25)], axis=1)
    planned = PaintTrajectory.at_speed(position, np.tile((0.0, 0.0, -1.0), (6, 1)), 0.5)
    took = planned.duration * (1.0, 1.02, 2.0, 1.5, 1.0)
    even, uneven = (
        Coat(np.array((50e-6 - off, 50e-6 + off)), np.ones(2), 50e-6, 1e-4, 1.0)
        for off in (1e-7, 2e-6)
    )
    assert lag_notes(planned, took, even, even) == ()
    (note,) = lag_notes(planned, took, uneven, even)
    assert "2.00 µm off the target (root mean square) against 0.10 µm" in note.message
    assert "1.8 times as long as programmed on the stretch from waypoint 3 to 5" in note.message
    (note,) = lag_notes(planned, planned.duration, uneven, even)
    assert "smaller zones" in note.message
    thick = Coat(np.full(2, 53e-6), np.ones(2), 50e-6, 1e-4, 1.0)
    (note,) = lag_notes(planned, took, thick, even)
    assert "3.00 µm off the target (root mean square) against 0.10 µm" in note.message
