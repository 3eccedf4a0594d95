"""What may change in a program, and the vector of its numbers."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st

from flyby.core.arrays import FloatArray
from flyby.core.errors import InputError, MotionError, Span
from flyby.core.motion.emulator.controller import Controller
from flyby.core.motion.gradients.derivatives import Derivatives
from flyby.core.program.event import Event
from flyby.core.program.move import Move, MoveJ, MoveL, Wait
from flyby.core.program.origin import MoveOrigin, Origin, Ownership
from flyby.core.program.program import Program
from flyby.core.program.speed import Speed
from flyby.core.program.target import JointTarget, PoseTarget
from flyby.core.program.zone import FINE, Radius, Zone
from flyby.core.registry import find_robot, find_vendor
from flyby.core.robot.kinematics.chain_kernels import poses
from flyby.core.spatial.pose import Pose
from flyby.core.spatial.rotation import quaternion_from_matrix, rotation_vector
from flyby.problems.improve.rounding import Rounding
from flyby.problems.improve.waypoints import Fixed, PointBox, WaypointTask
from flyby.problems.improve.waypoints.block_emulation import Driver
from flyby.problems.improve.waypoints.blocks import cut
from flyby.problems.improve.waypoints.changeable import Selection, select
from flyby.problems.improve.waypoints.options import Freedom
from flyby.problems.improve.waypoints.oriented import OrientedPoint
from flyby.problems.improve.waypoints.parts import JOINT_STEP
from flyby.problems.improve.waypoints.variables import ProgramVariables, make_variables

ROBOT = find_robot("abb/irb6640-180-255")
CONTROLLER = Controller(find_vendor("abb"), ROBOT)
START = JointTarget((0.0, 0.2, 0.2, 0.0, 0.9, 0.0))
BOTH = Freedom.WAYPOINTS_AND_ZONES


def joints(*changes: float) -> JointTarget:
    q = np.array(START.joints)
    q[: len(changes)] += changes
    return JointTarget(tuple(map(float, q)))


def posed(target: JointTarget) -> PoseTarget:
    """The TCP's pose at a joint target."""
    chain = CONTROLLER.plan(Program((MoveJ(joints(0.3), Speed(tcp=1.0)),), start=START)).route
    R, p = poses(chain.chains[0], np.array([target.joints]))
    w, i, j, k = map(float, quaternion_from_matrix(R[0]))
    return PoseTarget(Pose((float(p[0, 0]), float(p[0, 1]), float(p[0, 2])), (w, i, j, k)))


def move(target: JointTarget | PoseTarget, zone: Zone = FINE, **more: object) -> MoveJ:
    return MoveJ(target=target, speed=Speed(tcp=1.0, name="v1000"), zone=zone, **more)  # type: ignore[arg-type]


def line(target: JointTarget, zone: Zone = FINE) -> MoveL:
    return MoveL(target=posed(target), speed=Speed(tcp=1.0, name="v1000"), zone=zone)


def four(*zones: Zone) -> Program:
    targets = [joints(0.3), joints(0.3, 0.2), joints(0.0, 0.3), joints(-0.2)]
    return Program(tuple(map(move, targets, zones)), start=START)


def selected(
    program: Program, task: WaypointTask | None = None, freedom: Freedom = BOTH
) -> Selection:
    wanted = replace(task or WaypointTask(), freedom=freedom)
    return select(program, CONTROLLER.plan(program), ROBOT, wanted)


SMALL = Radius(0.05)


def test_stops_and_the_last_point_stay() -> None:
    found = selected(four(SMALL, FINE, SMALL, SMALL))
    assert found.points == ((0,), (2,))
    assert found.zones == ((0,), (2,))
    assert found.reasons == {}


def test_a_wait_makes_a_point_a_task() -> None:
    program = four(SMALL, SMALL, SMALL, FINE)
    statements = (*program.statements[:2], Wait(0.1), *program.statements[2:])
    assert selected(replace(program, statements=statements)).points == ((0,), (2,))


@pytest.mark.parametrize("task", [WaypointTask(keep=[1]), WaypointTask(keep_speeds=["v50"])])
def test_moves_of_the_process_keep_both_their_ends(task: WaypointTask) -> None:
    program = four(SMALL, SMALL, SMALL, FINE)
    moves = list(program.moves)
    moves[1] = replace(moves[1], speed=Speed(tcp=0.05, name="v50"))
    found = selected(program.with_moves(tuple(moves)), task)
    assert found.points == found.zones == ((2,),)
    assert set(found.reasons) == {0, 1}


def test_what_is_switched_on_the_way_stays() -> None:
    program = four(SMALL, SMALL, SMALL, FINE)
    moves = list(program.moves)
    moves[2] = replace(moves[2], events=(Event("SetDO doGun,1;"),))
    found = selected(program.with_moves(tuple(moves)))
    assert found.points == ((0,),)
    assert "switched" in found.reasons[2] and "switched" in found.reasons[1]


def test_a_fixed_point_keeps_its_place_but_not_its_zone() -> None:
    found = selected(four(SMALL, SMALL, SMALL, FINE), WaypointTask(limits={1: Fixed()}))
    assert found.points == ((0,), (2,))
    assert found.zones == ((0,), (1,), (2,))


def test_only_zones_change_where_only_they_may() -> None:
    found = selected(four(SMALL, SMALL, SMALL, FINE), freedom=Freedom.ZONES)
    assert found.points == () and found.zones == ((0,), (1,), (2,)) and found.reasons == {}


def origin(line_number: int, target: Origin) -> MoveOrigin:
    span = Span("p.mod", line_number, 1, 100 * line_number, 100 * line_number + 50)
    own = Origin(Ownership.OWNED, span, numbers=(replace_span(span, 10),))
    return MoveOrigin(span, target, own, own)


def replace_span(span: Span, offset: int) -> Span:
    return span._replace(start=span.start + offset, end=span.start + offset + 5)


def shared(numbers: int, ownership: Ownership = Ownership.SHARED) -> Origin:
    span = Span("p.mod", numbers, 1, numbers, numbers + 5)
    return Origin(ownership, span, "p", (span,))


def with_targets(program: Program, origins: dict[int, Origin]) -> Program:
    moves: list[Move] = []
    for i, old in enumerate(program.moves):
        own = Origin(Ownership.OWNED, Span("p.mod", i + 20, 1, i + 5000, i + 5001), None, ())
        moves.append(replace(old, origin=origin(i + 20, origins.get(i, own))))
    return program.with_moves(tuple(moves))


def test_shared_data_are_one_variable() -> None:
    program = four(SMALL, SMALL, SMALL, FINE)
    moves = list(program.moves)
    moves[2] = replace(moves[2], target=moves[0].target)
    program = with_targets(program.with_moves(tuple(moves)), {0: shared(1), 2: shared(1)})
    found = selected(program)
    assert found.points == ((0, 2), (1,))
    variables = make_variables(program, ROBOT, found, WaypointTask())
    x = variables.start.copy()
    x[0] += 0.1
    changed = variables.applied(x).moves
    assert changed[0].target == changed[2].target != program.moves[0].target


def test_data_shared_with_a_task_stay() -> None:
    program = four(SMALL, SMALL, SMALL, FINE)
    moves = list(program.moves)
    moves[0] = replace(moves[0], target=moves[3].target)
    program = with_targets(program.with_moves(tuple(moves)), {0: shared(1), 3: shared(1)})
    found = selected(program)
    assert 0 not in {i for group in found.points for i in group}
    assert "stops there" in found.reasons[0]


@pytest.mark.parametrize(
    ("source", "word"),
    [
        (Origin(Ownership.DERIVED, Span("p.mod", 1, 1, 0, 5)), "computes"),
        (shared(1), "expression"),
    ],
)
def test_what_the_program_computes_with_stays(source: Origin, word: str) -> None:
    program = with_targets(four(SMALL, SMALL, SMALL, FINE), {1: source})
    found = selected(program)
    assert (1,) not in found.points
    assert word in found.reasons[1]


def test_names_and_numbers_that_there_are_not() -> None:
    program = four(SMALL, SMALL, SMALL, FINE)
    with pytest.raises(InputError, match="move 9"):
        selected(program, WaypointTask(keep=[8]))
    with pytest.raises(InputError, match="vglue"):
        selected(program, WaypointTask(keep_speeds=["vglue"]))


# ------------------------------------------------------------------------ the vector


def mixed() -> Program:
    """Joint moves and lines, to joint and pose targets."""
    targets = [joints(0.3), joints(0.3, 0.15), joints(0.0, 0.2), joints(-0.2, 0.1), joints(-0.3)]
    return Program(
        (
            move(posed(targets[0]), Radius(0.08, 0.12, 0.12)),
            line(targets[1], Radius(0.06)),
            line(targets[2], Radius(0.05)),
            move(targets[3], Radius(0.07)),
            move(targets[4]),
        ),
        start=START,
    )


def variables_of(program: Program, task: WaypointTask | None = None) -> ProgramVariables:
    return make_variables(program, ROBOT, selected(program, task), task or WaypointTask())


@pytest.mark.parametrize("make", [mixed, lambda: four(SMALL, SMALL, SMALL, FINE)])
def test_the_start_is_the_program(make: object) -> None:
    program = make()  # type: ignore[operator]
    variables = variables_of(program)
    again = variables.applied(variables.start)
    for old, new in zip(program.moves, again.moves, strict=True):
        assert old.zone == new.zone
        if isinstance(old.target, PoseTarget) and isinstance(new.target, PoseTarget):
            assert old.target.pose.position == pytest.approx(new.target.pose.position)
        else:
            assert old.target == new.target


def test_gradients_are_those_of_the_duration() -> None:
    program = mixed()
    variables = variables_of(program)
    random = np.random.default_rng(1)
    x = variables.start + 0.1 * variables.scale * random.uniform(-1, 1, variables.size)

    def duration(x: FloatArray) -> float:
        changed = variables.applied(x)
        return CONTROLLER.stamp(changed, CONTROLLER.plan(changed)).duration

    changed = variables.applied(x)
    timing = CONTROLLER.stamp(changed, CONTROLLER.plan(changed))
    made = variables.gradient(Derivatives(changed, timing).duration(), x)
    d = random.uniform(-1, 1, variables.size) * variables.scale
    step = 1e-5
    quotient = (duration(x + step * d) - duration(x - step * d)) / (2 * step)
    assert made @ d == pytest.approx(quotient, rel=1e-3, abs=1e-5)


def test_a_written_program_is_near_and_has_no_larger_zones() -> None:
    variables = variables_of(mixed())
    x = variables.start + 0.01234567 * variables.scale
    exact, written = variables.applied(x), variables.written(x, Rounding())
    for one, other in zip(exact.moves, written.moves, strict=True):
        if isinstance(one.zone, Radius) and isinstance(other.zone, Radius):
            assert one.zone.tcp - 1.1e-5 <= other.zone.tcp <= one.zone.tcp + 1e-12
        if isinstance(one.target, JointTarget) and isinstance(other.target, JointTarget):
            assert other.target.joints == pytest.approx(one.target.joints, abs=1e-6)
        if isinstance(one.target, PoseTarget) and isinstance(other.target, PoseTarget):
            assert other.target.pose.position == pytest.approx(one.target.pose.position, abs=6e-6)
            assert other.target.pose.quaternion == pytest.approx(
                one.target.pose.quaternion, abs=1e-8
            )


def test_what_does_not_change_is_written_to_the_last_digit() -> None:
    variables = variables_of(mixed())
    assert [m.target for m in variables.written(variables.start, Rounding()).moves] == [
        m.target for m in variables.program.moves
    ]


def test_a_zone_without_room_becomes_smaller_where_it_is() -> None:
    variables = variables_of(four(SMALL, SMALL, SMALL, FINE))
    smaller = variables.with_smaller_zone(variables.start, 1, 0.01)
    radii = [m.zone.tcp for m in variables.applied(smaller).moves[:3]]  # type: ignore[union-attr]
    assert radii == pytest.approx([0.05, 0.04, 0.05])


def test_chosen_zones_are_predefined_ones_and_stay() -> None:
    zones = (Radius(0.02, 0.03, 0.03, name="z20"), Radius(0.05, name="z50"), Radius(0.06))
    variables = variables_of(four(SMALL, SMALL, SMALL, FINE))
    x = variables.start.copy()
    x[variables.offsets[1]] = 0.049
    x[variables.offsets[3]] = 0.001
    chosen = variables.with_chosen_zones(x, Rounding(predefined=zones))
    held = [part.bounds()[0][0] for part in chosen.parts if part.size == 1]
    assert held == [0.02, 0.02, 0.05]
    written = chosen.written(np.clip(x, chosen.lower, chosen.upper), Rounding(predefined=zones))
    assert [m.zone for m in written.moves[:3]] == [zones[0], zones[0], zones[1]]


def test_ranges_and_axes_bound_the_variables() -> None:
    task = WaypointTask(limit=PointBox(joints=(0.1,) * 6), axes=[0, 1], tilt=math.pi)
    variables = variables_of(four(SMALL, SMALL, SMALL, FINE), task)
    assert variables.size == 3 * (2 + 1)
    points = [k for k, part in enumerate(variables.parts) if part.size == 2]
    for k in points:
        own = slice(variables.offsets[k], variables.offsets[k + 1])
        assert variables.upper[own] - variables.lower[own] == pytest.approx([0.2, 0.2])


# -------------------------------------------------------------- blocks and their paths


def turned(target: JointTarget, other: JointTarget) -> float:
    """rad by which the flange is turned between two joint targets."""
    R = ROBOT.forward(np.array([target.joints, other.joints]))[0]
    return float(np.linalg.norm(rotation_vector(R[1] @ R[0].T)))


@settings(deadline=None)
@given(values=st.lists(st.floats(-0.25, 0.25), min_size=9, max_size=9))
def test_tools_keep_their_orientation_at_via_points(values: list[float]) -> None:
    """Joint targets move over three coordinates, all of which keep the tool as it is turned."""
    program = four(SMALL, SMALL, SMALL, FINE)
    variables = variables_of(program)
    assert [part.size for part in variables.parts] == [3, 1, 3, 1, 3, 1]
    x = variables.start.copy()
    x[np.flatnonzero(variables.scale == JOINT_STEP)] = values
    try:
        made = variables.applied(x)
        written = variables.written(x, Rounding())
    except MotionError:
        assume(False)
    for then, now, text in zip(program.moves, made.moves, written.moves, strict=True):
        assert turned(then.target, now.target) < 1e-9
        assert turned(then.target, text.target) < math.radians(3e-4)


def test_what_keeps_its_orientation_has_derivatives() -> None:
    program = four(SMALL, SMALL, SMALL, FINE)
    variables = variables_of(program)
    part = variables.parts[2]
    assert isinstance(part, OrientedPoint)
    values, step = np.array([0.1, -0.05, 0.07]), 1e-6
    move = program.moves[part.moves[0]]

    def joints_at(x: FloatArray) -> FloatArray:
        target = part.applied(move, x).target
        assert isinstance(target, JointTarget)
        return np.array(target.joints)

    found = [(joints_at(values + d) - joints_at(values - d)) / (2 * step) for d in step * np.eye(3)]
    assert part.slope(values) == pytest.approx(np.array(found).T, abs=1e-7)


def test_points_that_can_only_move_by_turning_the_tool_stay() -> None:
    program = four(SMALL, SMALL, SMALL, FINE)
    one = selected(program, WaypointTask(axes=[1]))
    assert one.points == () and "allow a tilt" in one.reasons[0]
    assert selected(program, WaypointTask(axes=[1], tilt=0.1)).points == ((0,), (1,), (2,))
    parallel = variables_of(program, WaypointTask(axes=[1, 2]))
    assert [part.size for part in parallel.parts] == [1, 1, 1, 1, 1, 1]


def test_blocks_are_cut_at_stops() -> None:
    program = four(SMALL, FINE, SMALL, FINE)
    path = CONTROLLER.plan(program)
    blocks = cut(program, path, variables_of(program), ROBOT.arm_size)
    assert [(block.first, block.last) for block in blocks] == [(0, 1), (2, 3)]
    whole = CONTROLLER.stamp(program, path).segment_durations()
    alone = [
        CONTROLLER.stamp(block.program, CONTROLLER.plan(block.program)).segment_durations()
        for block in blocks
    ]
    assert np.concatenate(alone) == pytest.approx(whole, rel=1e-9)


def test_configurations_change_as_differences_say_on_mixed_paths() -> None:
    program = mixed()
    path = CONTROLLER.plan(program)
    (block,) = cut(program, path, variables_of(program), ROBOT.arm_size)
    driver = Driver(CONTROLLER, block)
    variables = block.variables
    here = driver.drive(variables.start)
    assert here is not None
    which = np.arange(len(here.q))
    change = driver.change(here, which)
    random = np.random.default_rng(2)
    free = variables.free
    d = np.zeros(variables.size)
    d[free] = random.uniform(-1, 1, len(free)) * variables.scale[free]
    step = 1e-5
    ahead, behind = driver.drive(here.x + step * d), driver.drive(here.x - step * d)
    assert ahead is not None and behind is not None
    quotient = (ahead.q - behind.q) / (2 * step)
    assert change.q @ d[free] == pytest.approx(quotient, abs=5e-5 * float(np.abs(quotient).max()))
    rooms = [
        (b.left.value - a.left.value) / (2 * step)
        for a, b in zip(behind.rooms, ahead.rooms, strict=True)
    ]
    assert change.rooms @ d[free] == pytest.approx(np.array(rooms), abs=1e-6)


def test_what_cannot_be_driven_has_no_drive() -> None:
    program = mixed()
    (block,) = cut(program, CONTROLLER.plan(program), variables_of(program), ROBOT.arm_size)
    driver = Driver(CONTROLLER, block)
    far = block.variables.start.copy()
    far[:3] += 5.0
    assert driver.drive(far) is None
    assert math.isfinite(driver.places.share.sum())
