"""Programs with larger zones: proven, within the rules, and the same whenever they are made."""

from __future__ import annotations

from dataclasses import replace
from functools import cache

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from flyby.core.cell.cell import Cell, Obstacle
from flyby.core.cell.geometry import Geometry
from flyby.core.collision.proof.verdict import Certificate, Verdict
from flyby.core.errors import InputError, MotionError
from flyby.core.motion.emulator.controller import Controller
from flyby.core.program.event import Event
from flyby.core.program.move import MoveJ, MoveL, Opaque, Wait
from flyby.core.program.program import Program
from flyby.core.program.speed import Speed
from flyby.core.program.target import JointTarget, PoseTarget
from flyby.core.program.tool import Tool
from flyby.core.program.zone import FINE, ContourFraction, Fine, Radius, Zone
from flyby.core.registry import find_robot, find_vendor
from flyby.core.robot.shape import Box, Sphere
from flyby.core.spatial.pose import Pose
from flyby.problems.improve import solve_round_verify
from flyby.problems.improve.rounding import Rounding
from flyby.problems.improve.zones import maximize
from flyby.problems.improve.zones.deviation import segment_deviations
from flyby.problems.improve.zones.maximize import ZoneSolution, maximize_zones
from flyby.problems.improve.zones.options import ZoneTask
from flyby.problems.improve.zones.points import Points, find_points, passable_stops
from flyby.problems.improve.zones.repair import Repair
from flyby.problems.improve.zones.sizes import GRADED, size_of
from flyby.validation.scenes.scene import with_zone
from flyby.validation.scenes.two_joints import two_joints
from flyby.vendors.kuka.zone_kinds import C_VEL

SMALL = Radius(0.01, 0.015, 0.015)
SCENE = two_joints()
CONTROLLER = SCENE.controller()
PROGRAM = with_zone(SCENE.programs[0], SMALL)
BALL = (1.41, -0.044, 0.756)
"""m, a place inside the first corner, which its largest zone cannot pass."""


def _cell(place: tuple[float, float, float] = BALL, radius: float = 0.0759) -> Cell:
    ball = Obstacle("ball", Geometry(Sphere(radius), Pose(place)))
    return replace(SCENE.cell, obstacles=(*SCENE.cell.obstacles, ball))


@cache
def _with_ball() -> ZoneSolution:
    return maximize_zones(CONTROLLER, PROGRAM, _cell())


def _sizes(solution: ZoneSolution) -> list[float]:
    return [size_of(move.zone) for move in solution.program.moves]


def test_the_new_program_is_proven_faster_and_bounded_by_the_ball():
    made = _with_ball()
    assert made.proven and made.changed
    assert made.after.time < made.before.time
    assert [change.move for change in made.zones] == [0, 1, 2]
    first, *others = made.zones
    assert first.limit == "rod and ball" and first.fails is not None
    assert 0.99 * first.fails < size_of(first.after) < first.fails
    assert all(change.limit == "the rules for neighbouring points" for change in others)
    assert all(change.fails is None for change in others)
    assert made.program.moves[-1].zone == FINE


def test_making_it_again_changes_nothing():
    again = maximize_zones(CONTROLLER, _with_ball().program, _cell())
    assert not again.changed and again.program is again.original
    assert again.proven


def test_zones_do_not_depend_on_what_they_were():
    wide = with_zone(SCENE.programs[0], Radius(0.08, 0.12, 0.12))
    other = maximize_zones(CONTROLLER, wide, _cell())
    assert _sizes(other) == pytest.approx(_sizes(_with_ball()), rel=0.01)


@given(
    st.tuples(*[st.floats(-2.0, 2.0)] * 3),
    st.tuples(*[st.floats(-1.0, 1.0)] * 3).filter(lambda v: 0.1 < np.linalg.norm(v) < 1),
)
@settings(max_examples=4)
def test_moving_the_whole_cell_changes_nothing(shift, axis):
    w = float(np.sqrt(1 - np.dot(axis, axis)))
    step = Pose(shift, (w, *axis))
    cell = _cell()
    moved = replace(
        cell,
        robot=cell.robot.with_base(step @ cell.robot.base),
        obstacles=tuple(
            replace(
                obstacle,
                geometry=replace(obstacle.geometry, placement=step @ obstacle.geometry.placement),
            )
            for obstacle in cell.obstacles
        ),
    )
    controller = Controller(find_vendor("abb"), moved.robot, CONTROLLER.model, CONTROLLER.sampling)
    assert _sizes(maximize_zones(controller, PROGRAM, moved)) == pytest.approx(
        _sizes(_with_ball()), rel=0.01
    )


def test_the_rest_of_the_program_does_not_matter():
    """The same moves behind others, and before others: the same zones."""
    back = tuple(replace(m, zone=SMALL) for m in reversed(PROGRAM.moves[:-1]))
    home = MoveJ(PROGRAM.start, PROGRAM.moves[0].speed, FINE, PROGRAM.moves[0].tool)
    longer = Program((*PROGRAM.moves, *back, home, *PROGRAM.moves), start=PROGRAM.start)
    sizes = _sizes(maximize_zones(CONTROLLER, longer, _cell()))
    alone = _sizes(_with_ball())
    assert sizes[:4] == alone and sizes[-4:] == alone
    # Driven the other way, the corners are the same curves.
    assert sizes[4:7] == pytest.approx(alone[2::-1], rel=0.01)


@given(
    st.tuples(st.floats(1.3, 1.7), st.floats(-0.05, 0.05), st.floats(0.7, 0.95)),
    st.floats(0.01, 0.08),
)
@settings(max_examples=8)
def test_wherever_the_ball_lies_the_result_is_proven_and_never_slower(place, radius):
    try:
        made = maximize_zones(CONTROLLER, PROGRAM, _cell(place, radius))
    except MotionError as error:
        assert "as it is" in str(error)
        return
    assert made.proven
    assert made.after.time <= made.before.time * (1 + 1e-9)
    assert made.certificate is not None and made.certificate.clearance >= 0.00498
    run = CONTROLLER.run(made.program)
    assert not any("cut to" in note.message for note in run.notes)


# What may change


def test_stops_stay_unless_they_are_freed():
    stops = SCENE.programs[0]
    with pytest.raises(InputError, match="stops at every point"):
        maximize_zones(CONTROLLER, stops, SCENE.cell)
    made = maximize_zones(CONTROLLER, stops, SCENE.cell, ZoneTask(freed=[1]))
    zones = [move.zone for move in made.program.moves]
    assert [isinstance(zone, Fine) for zone in zones] == [True, False, True, True]
    assert made.proven and made.after.time < made.before.time
    zone = zones[1]
    assert isinstance(zone, Radius) and zone.reorientation == pytest.approx(1.5 * zone.tcp)


def test_waits_and_events_keep_their_stops():
    moves = PROGRAM.moves
    waiting = Program((moves[0], Wait(0.5), *moves[1:]), start=PROGRAM.start)
    made = maximize_zones(CONTROLLER, waiting, SCENE.cell)
    assert made.program.moves[0].zone == SMALL
    assert any("wait" in note.message and note.move == 0 for note in made.notes)
    stop = replace(moves[0], zone=FINE, events=(Event("SetDO gun, 1"),))
    program = Program((stop, *moves[1:]), start=PROGRAM.start)
    with pytest.raises(MotionError, match="move 1: something is set"):
        maximize_zones(CONTROLLER, program, SCENE.cell, ZoneTask(freed=[0]))
    with pytest.raises(MotionError, match="move 4: the last move"):
        maximize_zones(CONTROLLER, program, SCENE.cell, ZoneTask(freed=[3]))
    with pytest.raises(InputError, match="move 10 cannot be given a zone"):
        maximize_zones(CONTROLLER, program, SCENE.cell, ZoneTask(freed=[9]))


def test_passable_stops_are_those_without_a_reason():
    a, b, c, d = SCENE.programs[0].moves
    statements = (a, Opaque("x", stops=True), b, Opaque("y"), c, Wait(1.0), d)
    assert passable_stops(Program(statements)) == [1]


def test_kept_zones_stay():
    made = maximize_zones(CONTROLLER, PROGRAM, _cell(), ZoneTask(kept=[1]))
    assert made.program.moves[1].zone == SMALL
    assert _sizes(made)[0] == _sizes(_with_ball())[0]
    with pytest.raises(InputError, match="to be kept"):
        maximize_zones(CONTROLLER, PROGRAM, _cell(), ZoneTask(kept=[0, 1, 2]))


def test_predefined_zones_are_the_largest_that_fit():
    zones = find_vendor("abb").speaks.zones()
    assert [zone.name for zone in zones][:3] == ["z0", "z1", "z5"]
    made = maximize_zones(
        CONTROLLER, PROGRAM, _cell(), ZoneTask(rounding=Rounding(predefined=zones))
    )
    free = _sizes(_with_ball())
    for move, size in zip(made.program.moves[:-1], free, strict=False):
        fitting = [zone for zone in zones if zone.tcp <= size]
        assert move.zone == max(fitting, key=lambda zone: zone.tcp)
    assert made.proven


def test_a_share_of_the_contour_grows_to_the_whole_half():
    program = PROGRAM.with_moves(
        tuple(replace(m, zone=ContourFraction(0.1)) for m in PROGRAM.moves[:-1])
        + PROGRAM.moves[-1:]
    )
    made = maximize_zones(CONTROLLER, program, SCENE.cell)
    assert [size_of(change.after) for change in made.zones] == [1.0, 1.0, 1.0]


# Neighbours that share a leg


@cache
def _ur() -> tuple[Controller, Program, Cell]:
    """Lines of a UR10e round corners, at unlike distances."""
    robot, vendor = find_robot("ur/ur10e"), find_vendor("ur")
    tool = Tool("tip", Pose((0.0, 0.0, 0.1)))
    speed = Speed(tcp=0.5, tcp_acceleration=1.0)
    down = (0.0, 1.0, 0.0, 0.0)
    points = [(0.7, -0.3, 0.4), (0.7, 0.0, 0.4), (0.7, 0.1, 0.3), (0.6, 0.4, 0.3), (0.5, 0.4, 0.5)]
    first, *others = (PoseTarget(Pose(point, down)) for point in points)
    zone = Radius(0.005, 0.005, 0.005)
    moves = [MoveL(target, speed, zone, tool) for target in others]
    moves[-1] = replace(moves[-1], zone=FINE)
    begin = MoveJ(first, Speed(joint=1.0, joint_acceleration=1.0), FINE, tool)
    q = (-0.6, -1.4, 1.9, -2.1, -1.57, 0.97)
    cell = Cell(robot, "ur", 0.005, {"tip": tool})
    return Controller(vendor, robot), Program((begin, *moves), start=JointTarget(q)), cell


def test_neighbours_share_their_leg_and_no_waypoint_is_left_out():
    controller, program, cell = _ur()
    made = maximize_zones(controller, program, cell)
    assert made.proven
    path = controller.plan(made.program)
    assert path.route.left_out == ()
    places = np.array([move.target.pose.position for move in made.program.moves])
    legs = np.linalg.norm(np.diff(places, axis=0), axis=1)
    radii = np.array([0.0, *_sizes(made)[1:-1], 0.0])
    taken = radii[:-1] + radii[1:]
    assert (taken <= legs).all()
    assert (radii[1:-1] > 0.02).all()
    # Nobody can grow without taking from a neighbour that is no larger.
    for i in range(1, len(radii) - 1):
        full = [k for k in (i - 1, i) if taken[k] > 0.995 * legs[k]]
        assert full
        assert any(radii[k if k != i else k + 1] <= radii[i] * 1.001 for k in full)


def test_shared_legs_are_shared_again_in_the_same_way():
    controller, program, cell = _ur()
    made = maximize_zones(controller, program, cell)
    assert not maximize_zones(controller, made.program, cell).changed
    kept = maximize_zones(controller, program, cell, ZoneTask(kept=[2]))
    assert size_of(kept.program.moves[2].zone) == 0.005
    assert _sizes(kept)[1] > _sizes(made)[1]


# Programs that cannot be improved


def test_a_program_that_collides_names_move_bodies_and_depth():
    box = Obstacle("wall", Geometry(Box((0.1, 0.4, 0.4)), Pose((1.9, 0.0, 0.9))))
    cell = replace(SCENE.cell, obstacles=(box,))
    with pytest.raises(MotionError, match=r"collides as it is: .* and wall overlap by .* mm"):
        maximize_zones(CONTROLLER, PROGRAM, cell)


def test_a_clearance_that_the_program_does_not_have_is_refused_with_the_one_it_has():
    with pytest.raises(MotionError, match=r"this program keeps \d+\.\d+ mm") as caught:
        maximize_zones(CONTROLLER, PROGRAM, SCENE.cell, ZoneTask(clearance=0.3))
    kept = 1e-3 * float(str(caught.value).split("keeps ")[1].split(" mm")[0])
    options = ZoneTask(clearance=kept - 1e-5)
    assert maximize_zones(CONTROLLER, PROGRAM, SCENE.cell, options).proven


def test_a_cell_without_the_programs_tool_is_refused():
    cell = replace(SCENE.cell, tools={}, tool_geometries={})
    with pytest.raises(InputError, match="has no tool"):
        maximize_zones(CONTROLLER, PROGRAM, cell)


@pytest.mark.parametrize(
    "wrong", [{"clearance": -1.0}, {"residual": float("nan")}, {"tolerance": 0.0}]
)
def test_options_out_of_range_are_refused(wrong):
    with pytest.raises(InputError, match=f"the {next(iter(wrong))}"):
        ZoneTask(**wrong)


def test_what_is_certified_is_what_was_read_back():
    """Rounding on the way to the text counts."""

    def coarse(program: Program) -> Program:
        def rounded(zone):
            return zone if isinstance(zone, Fine) else GRADED.resized(round(zone.tcp, 2) or 0.01)

        return program.with_moves(
            tuple(replace(move, zone=rounded(move.zone)) for move in program.moves)
        )

    made = maximize_zones(CONTROLLER, PROGRAM, SCENE.cell, read_back=coarse)
    assert [round(1e3 * size, 6) % 10 for size in _sizes(made)] == [0.0] * 4


def test_an_interrupt_keeps_what_was_found_so_far():
    told: list[str] = []

    def tell(message: str) -> None:
        told.append(message)
        if message == "1 of 3 zones are grown":
            raise KeyboardInterrupt

    made = maximize_zones(CONTROLLER, PROGRAM, _cell(), tell=tell)
    assert made.proven and made.changed
    left = [change for change in made.zones if change.limit == "the search was interrupted"]
    assert len(left) == 2 and all(change.after == SMALL for change in left)
    assert told[0] == "looking at the program as it is"


BY_SPEED = """DEF corners()
$VEL.CP=0.5
$APO.CDIS=10
$APO.CVEL=50
PTP {A1 0,A2 -90,A3 90,A4 0,A5 30,A6 0}
LIN {X 1240,Y 0,Z 1710,A 0,B 90,C 0} C_VEL
LIN {X 1240,Y 0,Z 1610,A 0,B 90,C 0} C_DIS
LIN {X 1340,Y 0,Z 1610,A 0,B 90,C 0}
END
"""


def test_a_zone_by_speed_grows_by_its_share_and_keeps_its_kind():
    vendor, robot = find_vendor("kuka"), find_robot("kuka/kr30-3")
    program = vendor.read(BY_SPEED, "corners.src", robot=robot)
    points = find_points(Controller(vendor, robot), program, None, {}, (), False, {})
    growth, _ = points.growths.values()
    assert [points.move[corner] for corner in points.growths] == [1, 2]
    assert growth.rounded(0.678, Rounding()) == C_VEL.sized(0.67)
    assert growth.zone(3.0) == C_VEL.sized(1.0)
    assert growth.zone(0.0) == FINE


# Ways back


def _enlarged() -> tuple[Points, dict[int, Zone], Repair]:
    points = find_points(CONTROLLER, PROGRAM, None, {}, (), False, {})
    zones = {i: GRADED.resized(0.1) for i in points.growths}
    return points, zones, Repair(points, PROGRAM, zones, Rounding())


def test_zones_that_cost_time_are_put_back_until_none_is_lost():
    *_, repair = _enlarged()
    slow, fast = CONTROLLER.run(PROGRAM), CONTROLLER.run(repair.program)
    assert fast.duration < slow.duration
    assert not repair.slower(slow, fast), "nothing to repair"
    for count in (1, 2, 3):
        assert repair.slower(fast, slow)
        assert sum(zone == SMALL for zone in repair.zones.values()) == count
    assert not repair.changed and not repair.slower(fast, slow)


def test_zones_that_are_not_proven_become_smaller_and_at_last_what_they_were():
    points, zones, repair = _enlarged()
    run = CONTROLLER.run(repair.program)
    at = float(run.path.layout.waypoint[2])
    refused = Certificate(Verdict.UNPROVEN, 0.0, "no", 1, (at - 0.01, at + 0.01))
    sizes = [0.1]
    while repair.refused(run, refused):
        sizes.append(size_of(repair.zones[1]))
    assert sizes == sorted(sizes, reverse=True) and sizes[-1] == SMALL.tcp and len(sizes) == 6
    assert sizes[1] == pytest.approx(0.099)
    assert repair.zones[0] == zones[0] and repair.zones[2] == zones[2]
    elsewhere = Certificate(Verdict.UNPROVEN, 0.0, "no", 1, (0.0, 0.01))
    assert not repair.refused(run, elsewhere)
    assert len(points.groups) == 3


def test_what_cannot_be_proven_goes_back_to_the_program_that_can(monkeypatch):
    certify, count = solve_round_verify.certify, 0

    def once(*args, **words):
        nonlocal count
        count += 1
        proof = certify(*args, **words)
        return proof if count == 1 else replace(proof, verdict=Verdict.UNPROVEN, sigma=None)

    monkeypatch.setattr(solve_round_verify, "certify", once)
    made = maximize_zones(CONTROLLER, PROGRAM, _cell())
    assert count == 2 and not made.changed and made.proven
    assert all(change.after == SMALL for change in made.zones)


def test_a_zone_at_which_the_controller_stops_all_the_same_stays():
    robot = find_robot("abb/irb6640-180-255")
    tool = Tool("tip", Pose((0.0, 0.0, 0.1)))
    down, turned = (0.0, 0.0, 1.0, 0.0), (0.0, 0.1, float(np.sqrt(0.99)), 0.0)
    places = [((1.3, -0.2, 1.0), down), ((1.3, 0.0, 1.0), down), ((1.3, 0.0, 1.0), turned)]
    places += [((1.3, 0.2, 1.0), turned), ((1.3, 0.4, 1.2), turned)]
    moves = [MoveL(PoseTarget(Pose(p, q)), Speed(tcp=0.5), SMALL, tool) for p, q in places]
    moves[-1] = replace(moves[-1], zone=FINE)
    cell = Cell(robot, "abb", 0.005, {"tip": tool}, allowed=(("J2", "J4"),))
    controller = Controller(find_vendor("abb"), robot)
    made = maximize_zones(controller, Program(tuple(moves)), cell)
    limits = {change.move: change.limit for change in made.zones}
    stops = "the robot stops here whatever the zone"
    assert [limits[k] == stops for k in (1, 2, 3)] == [True, True, False]
    assert [size_of(move.zone) > 0.01 for move in made.program.moves] == [False] * 3 + [True, False]


def test_zones_that_the_controller_cuts_to_the_largest_stay_as_they_are():
    wide = with_zone(SCENE.programs[0], Radius(0.5, 0.75, 0.75))
    assert not maximize_zones(CONTROLLER, wide, SCENE.cell).changed
    mixed = wide.with_moves((PROGRAM.moves[0], *wide.moves[1:]))
    made = maximize_zones(CONTROLLER, mixed, _cell())
    assert made.program.moves[1:] == wide.moves[1:]
    assert _sizes(made)[0] == _sizes(_with_ball())[0]


@pytest.mark.parametrize("settling", [None, 0.0])
def test_zones_leave_room_for_what_their_own_smoothing_does(
    settling: float | None, monkeypatch: pytest.MonkeyPatch
) -> None:
    """What the new program's joints deviate is no more than what its zones were grown with."""
    model = replace(CONTROLLER.model, smoothing=(0.08, 0.05), settling=settling)
    controller = Controller(find_vendor("abb"), SCENE.cell.robot, model)
    grown: list[np.ndarray] = []

    class Noting(maximize.Clearing):
        def __init__(self, *given) -> None:
            super().__init__(*given)
            grown.append(given[2])

    refused: list[Certificate] = []
    monkeypatch.setattr(maximize, "Clearing", Noting)
    monkeypatch.setattr(Repair, "refused", lambda *given: refused.append(given[2]))
    slow = PROGRAM.with_moves(tuple(replace(move, speed=Speed(tcp=1.0)) for move in PROGRAM.moves))
    made = maximize_zones(controller, slow, _cell())
    assert made.proven and made.changed and not refused
    run = controller.run(made.program)
    needed = segment_deviations(controller, run, run.path.route.moves)
    assert (needed <= grown[-len(needed) :]).all() and needed.max() > 1e-4


def test_without_a_clearance_zones_end_before_contact():
    cell = replace(_cell(radius=0.0805), clearance=0.0)
    made = maximize_zones(CONTROLLER, PROGRAM, cell)
    assert made.proven and made.zones[0].fails is not None
    assert made.certificate is not None and 0.0 < made.certificate.clearance < 1e-3
