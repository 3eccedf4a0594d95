"""Certificates of programs that take parts and put them down."""

from __future__ import annotations

from dataclasses import replace
from typing import cast

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from flyby.core.cell.cell import Cell, Obstacle
from flyby.core.cell.geometry import Geometry
from flyby.core.cell.workpiece import Workpiece
from flyby.core.collision.clearance import ClearanceMeter, nearest_of
from flyby.core.collision.handled_scenes import HandledScenes, PartScenes
from flyby.core.collision.proof.certificate import certify
from flyby.core.collision.proof.verdict import Certificate, Verdict, VerdictReader
from flyby.core.handling.handling import handling_of
from flyby.core.motion.emulator.controller import Controller
from flyby.core.motion.emulator.run import Run
from flyby.core.program.move import Move, MoveC, MoveL, Opaque
from flyby.core.program.program import Program
from flyby.core.program.speed import Speed
from flyby.core.program.target import PoseTarget
from flyby.core.program.tool import Tool
from flyby.core.program.zone import FINE, Radius
from flyby.core.registry import find_robot, find_vendor
from flyby.core.robot.shape import Box, Cylinder
from flyby.core.spatial.pose import Pose
from flyby.validation.scenes.solids import plate

UR = find_robot("ur/ur10e")
CONTROLLER = Controller(find_vendor("ur"), UR)
GRIP = Tool("grip", Pose((0.0, 0.0, 0.1)))
ON, OFF = Opaque("on", True), Opaque("off", True)
FLOOR = Obstacle("floor", Geometry(Box((0.6, 1.0, 0.1)), Pose((0.7, 0.0, -0.05))))
WALL = Obstacle("wall", Geometry(Box((0.1, 0.02, 0.2)), Pose((0.6, 0.0, 0.1))))
SLOW = Speed(tcp=0.5)


def place(x: float, y: float, z: float) -> PoseTarget:
    return PoseTarget(Pose((x, y, z), (0.0, 1.0, 0.0, 0.0)))


def to(x: float, y: float, z: float, zone=FINE) -> MoveL:
    return MoveL(place(x, y, z), SLOW, zone, tool=GRIP)


def crate(**more) -> Workpiece:
    """10 cm high, on the floor, its top at 0.1 m."""
    return Workpiece(
        "crate", Geometry(Box((0.1, 0.1, 0.1)), Pose((0.6, 0.2, 0.05))), ("on",), ("off",), **more
    )


CRATES = (crate(),)


def cell_with(*around: Obstacle, parts=CRATES) -> Cell:
    grip = Geometry(Cylinder(0.03, 0.09), Pose((0.0, 0.0, 0.045)))
    return Cell(
        UR,
        "ur",
        tools={"grip": GRIP},
        tool_geometries={"grip": grip},
        obstacles=around,
        parts=parts,
    )


def trip(put: float = 0.1, lift: float = 0.3, zone=FINE, end: float = -0.2) -> Program:
    return Program(
        (
            to(0.6, 0.2, lift),
            to(0.6, 0.2, 0.1),
            ON,
            to(0.6, 0.2, lift, zone),
            to(0.6, end, lift, zone),
            to(0.6, end, put),
            OFF,
            to(0.6, end, lift),
        )
    )


def proof(program: Program, cell: Cell, clearance: float = 0.0, **more) -> Certificate:
    handling, run = handling_of(program, cell), CONTROLLER.run(program)
    scenes = HandledScenes(PartScenes(cell), handling, run.program, run.path, clearance)
    return certify(CONTROLLER, run, scenes, clearance, **more)


@settings(max_examples=8, deadline=None)
@given(lift=st.floats(0.25, 0.45), end=st.floats(-0.3, -0.15), radius=st.floats(0.0, 0.04))
def test_nothing_is_proven_that_samples_contradict(lift, end, radius) -> None:
    program, cell = trip(lift=lift, zone=Radius(radius), end=end), cell_with(FLOOR, WALL)
    run = CONTROLLER.run(program)
    met = nearest_of(ClearanceMeter(cell, program, handling_of(program, cell)).over(run.path, 0))
    sampled = min(side.distance for side in met if side is not None)
    made = proof(program, cell, resolution=1e-5)
    if sampled > 0.0:
        assert made.proven
        # Where what touched comes apart it is near again, which samples count and a proof does not.
        assert made.clearance <= sampled + 1e-6
    else:
        assert made.verdict is Verdict.VIOLATED


def test_what_is_put_down_too_deep_is_in_the_floor() -> None:
    assert proof(trip(), cell_with(FLOOR)).proven
    made = proof(trip(put=0.08), cell_with(FLOOR))
    assert made.verdict is Verdict.VIOLATED and set(made.pair or ()) == {"crate", "floor"}
    assert made.move == 4


def test_what_touched_keeps_clear_from_where_it_is_apart() -> None:
    """Lifted on an arc that ends a little above the floor: the crate is near to it again there."""
    arc = MoveC(place(0.6, -0.2, 0.101), SLOW, FINE, tool=GRIP, via=place(0.6, 0.0, 0.25))
    program = Program((to(0.6, 0.2, 0.3), to(0.6, 0.2, 0.1), ON, arc))
    touched = proof(program, cell_with(FLOOR))
    assert touched.proven and "from where they are apart" in touched.message
    near = proof(program, cell_with(FLOOR), 0.005)
    assert near.verdict is Verdict.VIOLATED
    assert set(near.pair or ()) == {"crate", "floor"} and near.move == 2
    assert near.distance is not None and 0.0 < near.distance < 0.005


def test_a_carried_part_takes_clearance_that_the_bare_tool_has() -> None:
    bare = proof(trip(lift=0.29), cell_with(FLOOR, WALL, parts=()))
    laden = proof(trip(lift=0.32), cell_with(FLOOR, WALL), resolution=1e-5)
    assert bare.proven and laden.proven
    assert laden.clearance == pytest.approx(0.02, abs=1e-3)
    assert set(laden.pair or ()) == {"crate", "wall"}
    assert proof(trip(lift=0.29), cell_with(FLOOR, WALL)).verdict is Verdict.VIOLATED


@settings(max_examples=8, deadline=None)
@given(via=st.floats(0.107, 0.16))
def test_what_was_apart_is_not_let_near_again(via) -> None:
    """However little it was lifted: no slack at the beginning swallows where it is near again."""
    arc = MoveC(place(0.6, -0.2, 0.101), SLOW, FINE, tool=GRIP, via=place(0.6, 0.0, via))
    made = proof(Program((to(0.6, 0.2, 0.3), to(0.6, 0.2, 0.1), ON, arc)), cell_with(FLOOR), 0.005)
    assert made.verdict is Verdict.VIOLATED and made.move == 2


def test_what_never_comes_apart_is_said() -> None:
    """Slid along the floor."""
    slid = Program((to(0.6, 0.2, 0.3), to(0.6, 0.2, 0.1), ON, to(0.6, -0.2, 0.1), OFF))
    made = proof(slid, cell_with(FLOOR))
    assert made.proven
    assert "on move 3 they never are apart" in made.message
    assert "never are" not in proof(trip(), cell_with(FLOOR)).message


def test_a_tool_goes_no_deeper_into_a_part_than_where_it_takes_it() -> None:
    """Along an arc that dives through the crate's side before the grip at its top."""
    over, grip = to(0.6, 0.05, 0.102), place(0.6, 0.2, 0.088)
    dive = MoveC(grip, SLOW, FINE, tool=GRIP, via=place(0.6, 0.13, 0.07))
    lift = to(0.6, 0.2, 0.3)
    made = proof(Program((over, dive, ON, lift)), cell_with(FLOOR))
    assert made.verdict is Verdict.VIOLATED and made.move == 1
    assert set(made.pair or ()) == {"crate", "grip"} and "are allowed" in made.message
    straight = Program((to(0.6, 0.2, 0.2), to(0.6, 0.2, 0.088), ON, lift))
    assert proof(straight, cell_with(FLOOR)).proven
    for program, clear in ((straight, True), (Program((over, dive, ON, lift)), False)):
        meter = ClearanceMeter(cell_with(FLOOR), program, handling_of(program, cell_with(FLOOR)))
        met = nearest_of(meter.over(CONTROLLER.run(program).path, 0))[0]
        assert met is not None and met.overlaps is not clear


@pytest.mark.parametrize(
    ("away", "keeps"),
    [
        ([to(0.6, -0.2, 0.3)], True),
        ([to(0.6, -0.08, 0.088)], True),
        ([to(0.68, -0.2, 0.3)], True),
        # Along the bar, all the way or until it ends; and into it again, once nearly out.
        ([to(0.72, -0.2, 0.07), to(0.72, -0.2, 0.3)], False),
        ([to(0.9, -0.2, 0.07)], False),
        (
            [MoveC(place(0.68, -0.2, 0.07), SLOW, FINE, tool=GRIP, via=place(0.64, -0.2, 0.1))],
            False,
        ),
    ],
    ids=["up", "aside", "aslant", "along, then up", "out of its end", "out and in"],
)
def test_a_tool_draws_back_from_a_part_and_not_across_it(away: list[Move], keeps: bool) -> None:
    """It is no deeper in the bar there than where it puts it down."""
    bar = replace(crate(near=0.04), geometry=Geometry(Box((0.4, 0.1, 0.1)), Pose((0.6, 0.2, 0.05))))
    cell = replace(cell_with(FLOOR, parts=(bar,)), clearance=0.005)
    there = [to(0.6, 0.2, 0.3), to(0.6, 0.2, 0.07), ON, to(0.6, 0.2, 0.3), to(0.6, -0.2, 0.3)]
    program = Program((*there, to(0.6, -0.2, 0.07), OFF, *away))
    made = proof(program, cell, 0.005)
    assert made.proven is keeps
    met = nearest_of(
        ClearanceMeter(cell, program, handling_of(program, cell)).over(
            CONTROLLER.run(program).path, 0
        )
    )[0]
    assert met is not None and met.overlaps is not keeps
    if not keeps:
        assert made.verdict is Verdict.VIOLATED and set(made.pair or ()) == {"crate", "grip"}


def test_depth_into_a_mesh_is_judged_by_a_smaller_part() -> None:
    """A board with a rim is no convex shape, and nobody knows how deep a crate is in it."""
    board = plate(lambda x, y: 0.05 * (y > 0.4) + 0.0 * x, (0.4, -0.5), (1.0, 0.5), 0.05, 0.1)
    around = cell_with(Obstacle("board", Geometry(board)))
    assert proof(trip(), around).proven
    assert proof(trip(put=0.0985), around).proven
    made = proof(trip(put=0.097), around)
    assert made.verdict is Verdict.VIOLATED and set(made.pair or ()) == {"board", "crate"}
    assert "2.000 mm are allowed" in made.message


def test_what_comes_apart_later_does_not_hide_what_is_apart() -> None:
    """Of two crates side by side one is taken: they slide along each other, off the floor."""
    two = (replace(CRATES[0], count=(1, 2, 1), pitch=(0.0, 0.1005, 0.0)),)
    dip = MoveC(place(0.6, 0.2, 0.2), SLOW, FINE, tool=GRIP, via=place(0.6, 0.205, 0.15))
    made = proof(
        Program((to(0.6, 0.2, 0.3), to(0.6, 0.2, 0.1), ON, dip)), cell_with(FLOOR, parts=two)
    )
    assert made.verdict is Verdict.VIOLATED
    assert set(made.pair or ()) == {"crate 1", "crate 2"}


def test_what_is_apart_by_little_is_proven_there_or_nothing_is() -> None:
    """Lifted by 3 mm on the way, where smoothing may take up more than one: no larger slack at the
    ends makes that a move on which the crate may touch the floor throughout."""
    low = MoveC(place(0.6, -0.2, 0.1), Speed(tcp=2.0), FINE, tool=GRIP, via=place(0.6, 0.0, 0.103))
    program = Program((to(0.6, 0.2, 0.3), to(0.6, 0.2, 0.1), ON, low, OFF, to(0.6, -0.2, 0.3)))
    cell = cell_with(FLOOR)
    for width, verdict in ((0.1, Verdict.PROVEN), (0.25, Verdict.UNPROVEN)):
        smooth = replace(CONTROLLER.model, smoothing=(width,))
        controller = Controller(find_vendor("ur"), UR, smooth)
        handling, run = handling_of(program, cell), controller.run(program)
        made = certify(
            controller, run, HandledScenes(PartScenes(cell), handling, run.program, run.path), 0.0
        )
        assert made.verdict is verdict
    assert set(made.pair or ()) == {"crate", "floor"} and made.move == 2


def test_pairs_that_never_come_apart_are_named_where_nothing_else_is_near() -> None:
    reader = VerdictReader(cast(Run, None))
    made = reader.proven([], 1e-5, 0, 0.005, near=(2,))
    assert made.message.startswith("nothing is near that it could touch; a part, and what takes it")
    assert made.message.endswith("on move 3 they never are apart")
    assert reader.proven([], 1e-5, 0, 0.005).message == "nothing is near that it could touch"


def retreat(*heights: float, grip: float = 0.07) -> Program:
    """Puts the crate down, 30 mm in it, and draws back in moves to these heights."""
    put, up = to(0.6, -0.2, grip), [to(0.6, -0.2, z) for z in heights]
    there = (to(0.6, 0.2, 0.3), to(0.6, 0.2, grip), ON, to(0.6, 0.2, 0.3), to(0.6, -0.2, 0.3))
    return Program((*there, put, OFF, *up))


@pytest.mark.parametrize("clearance", [0.0, 0.004])
def test_a_tool_draws_back_in_as_many_moves_as_it_takes(clearance: float) -> None:
    """30 mm deep it is put down; 12 and 3 mm deep it stops on its way out."""
    cell = replace(cell_with(FLOOR), clearance=clearance)
    deep = Geometry(Cylinder(0.03, 0.1), Pose((0.0, 0.0, 0.05)))
    cell = replace(cell, tool_geometries={"grip": deep})
    program = retreat(0.088, 0.097, 0.3)
    made = proof(program, cell, clearance)
    assert made.proven and "never are" not in made.message
    met = nearest_of(
        ClearanceMeter(cell, program, handling_of(program, cell)).over(
            CONTROLLER.run(program).path, 0
        )
    )
    assert met[0] is not None and not met[0].overlaps and met[0].distance >= clearance
    # It goes on coming out: neither deeper nor across.
    assert proof(retreat(0.088, 0.06, 0.3), cell, clearance).verdict is Verdict.VIOLATED
    *there, up, _ = retreat(0.088, 0.3).statements
    across = Program((*there, up, to(0.63, -0.15, 0.088), to(0.63, -0.15, 0.3)))
    made = proof(across, cell, clearance)
    assert made.verdict is Verdict.VIOLATED and set(made.pair or ()) == {"grip", "crate"}
    # Once it was out it must not come back.
    back = proof(retreat(0.088, 0.13, 0.088), cell, clearance)
    assert back.verdict is Verdict.VIOLATED and back.move == 7


def test_a_tool_comes_to_a_part_in_as_many_moves_as_it_takes() -> None:
    deep = Geometry(Cylinder(0.03, 0.1), Pose((0.0, 0.0, 0.05)))
    cell = replace(cell_with(FLOOR), tool_geometries={"grip": deep})
    program = Program((to(0.6, 0.2, 0.3), to(0.6, 0.2, 0.09), to(0.6, 0.2, 0.07), ON))
    assert proof(program, cell).proven
    away = Program((*program.statements[:2], to(0.6, 0.2, 0.2), *program.statements[2:]))
    made = proof(away, cell)
    assert made.verdict is Verdict.VIOLATED and made.move == 1


def test_a_part_is_lifted_a_little_first() -> None:
    """3 mm above the floor it goes on up; across the floor it is too near."""
    here, cell = (to(0.6, 0.2, 0.3), to(0.6, 0.2, 0.1), ON, to(0.6, 0.2, 0.103)), cell_with(FLOOR)
    made = proof(Program((*here, to(0.6, 0.2, 0.3))), cell, 0.005)
    assert made.proven and "never are" not in made.message
    across = proof(Program((*here, to(0.6, -0.2, 0.103))), cell, 0.005)
    assert across.verdict is Verdict.VIOLATED and set(across.pair or ()) == {"crate", "floor"}
    # Put down in two moves it is as well.
    put = (to(0.6, -0.2, 0.103), to(0.6, -0.2, 0.1), OFF, to(0.6, -0.2, 0.3))
    assert proof(Program((*here, to(0.6, 0.2, 0.3), to(0.6, -0.2, 0.3), *put)), cell, 0.005).proven
    low = Program((*here, *put))
    assert proof(low, cell, 0.005).verdict is Verdict.VIOLATED
