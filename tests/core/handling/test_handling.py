"""Parts that a program takes and releases: which, where, what they weigh, and what is said."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from flyby.core.cell.cell import Cell
from flyby.core.cell.geometry import Geometry
from flyby.core.cell.workpiece import Workpiece
from flyby.core.errors import InputError, Span
from flyby.core.handling.arrangement import distance_to_box
from flyby.core.handling.flange import FlangeFollower
from flyby.core.handling.handling import handling_of
from flyby.core.handling.loads import with_loads
from flyby.core.program.call import Call
from flyby.core.program.event import Event, EventAnchor
from flyby.core.program.move import Move, MoveL, Opaque
from flyby.core.program.program import Program
from flyby.core.program.speed import Speed
from flyby.core.program.target import JointTarget, PoseTarget
from flyby.core.program.tool import Load, Tool, WorkObject
from flyby.core.registry import find_robot
from flyby.core.robot.inertia import Inertia, carried_inertia
from flyby.core.robot.joint import ExternalAxis, ExternalRole, Joint
from flyby.core.robot.shape import Box
from flyby.core.spatial.pose import Pose
from flyby.core.spatial.rotation import matrix_from_rotation_vector

ROBOT = find_robot("abb/irb1200-5-090")
TURNTABLE = ExternalAxis(
    Joint("turntable", Pose((0.6, 0.0, 0.1)), (0.0, 0.0, 1.0), -3.0, 3.0, 1.0, 2.0),
    ExternalRole.TABLE,
)
TOOL = Tool("grip", Pose((0.02, 0.0, 0.15), (0.8, 0.0, 0.6, 0.0)), Load(1.5, (0.0, 0.0, 0.05)))
ON, OFF = Opaque("SetDO grip,1;", span=Span("m.mod", 7, 1, 0, 1)), Opaque("SetDO grip,0;")
SIZE = (0.06, 0.04, 0.1)


def part(at=(0.5, 0.0, 0.3), **more) -> Workpiece:
    told = {"attach": ("SetDO grip,1",), "release": ("SetDO grip,0",), **more}
    return Workpiece("crate", Geometry(Box(SIZE), Pose(at)), **told)


def to(at, turn=(0.0, np.pi, 0.0), **more) -> MoveL:
    matrix = np.eye(4)
    matrix[:3, :3] = matrix_from_rotation_vector(np.array(turn, dtype=float))
    matrix[:3, 3] = at
    external = more.pop("external", ())
    target = PoseTarget(Pose.from_matrix(matrix), external=external)
    return MoveL(target, Speed(tcp=0.2), **{"tool": TOOL, **more})


def handled(*statements, parts=None, robot=ROBOT, **more):
    cell = Cell(robot, "abb", parts=(part(),) if parts is None else parts, file=Path("cell.toml"))
    return handling_of(Program(statements, **more), cell)


def said(made) -> str:
    return " ".join(map(str, made.notes))


def alike(first: Pose, second: Pose) -> bool:
    return bool(np.allclose(first.matrix(), second.matrix(), atol=1e-9))


places = st.tuples(*(st.floats(-0.8, 0.8) for _ in range(3)))
turns = st.tuples(*(st.floats(-3.0, 3.0) for _ in range(3)))
poses = st.builds(lambda at, turn: to(at, turn).target.pose, places, turns)


@settings(max_examples=60, deadline=None)
@given(poses, poses, places, st.floats(-2.5, 2.5), st.booleans())
def test_a_released_part_lies_to_the_tcp_as_when_it_was_taken(
    taken: Pose, put: Pose, on_tcp, angle: float, on_table: bool
) -> None:
    robot = ROBOT.with_external_axes([TURNTABLE])
    kind = part(near=10.0, released_on="turntable" if on_table else None)
    kind = replace(kind, geometry=Geometry(Box(SIZE), taken @ Pose(on_tcp)))
    take = replace(to((0, 0, 0)), target=PoseTarget(taken, external=(0.3,)))
    give = replace(to((0, 0, 0)), target=PoseTarget(put, external=(angle,)))
    made = handled(take, ON, give, OFF, take, parts=(kind,), robot=robot)
    assert not made.notes
    (lying,), (carried,), (released,) = made.arrangements
    assert [one.held for one in (lying, carried, released)] == [False, True, False]
    # Where the TCP is, the part is by the same way from it.
    way = taken.inverse() @ kind.geometry.placement
    assert alike(TOOL.tcp @ way, carried.pose)
    follower = FlangeFollower(robot, None)
    follower.moved(give)
    assert alike(put @ way, follower.frame(released.carrier) @ released.pose)
    assert released.carrier == ("turntable" if on_table else None)


@settings(max_examples=40, deadline=None)
@given(st.integers(1, 4), st.integers(1, 3), st.integers(1, 2), st.randoms())
def test_a_tray_is_emptied_part_by_part(nx: int, ny: int, nz: int, random) -> None:
    kind = part(count=(nx, ny, nz), pitch=(0.1, -0.08, 0.15), near=0.01)
    spots = [(name, pose.position) for name, pose in kind.pieces()]
    random.shuffle(spots)
    steps = [s for _, at in spots for s in (to(at), ON, to((-0.5, 0.0, 0.6)), OFF)]
    made = handled(*steps, to(spots[0][1]), ON, parts=(kind,))
    held = [[p.name for p in made.arrangements[k] if p.held] for k in range(2 * len(spots))]
    assert held == [names for name, _ in spots for names in ([], [name])]
    # In the end none lies where it was, and the last attempt says so.
    assert "none is near" in said(made)
    assert len(made.notes) == 1


def test_the_part_that_is_nearest_is_taken() -> None:
    kind = part(count=(3, 1, 1), pitch=(0.1, 0.0, 0.0))
    made = handled(to((0.61, 0.0, 0.3)), ON, to((0.0, 0.4, 0.5)), parts=(kind,))
    assert [p.name for p in made.arrangements[1] if p.held] == ["crate 2"]
    nothing, crate = frozenset[str](), frozenset({"crate 2"})
    assert (made.before, made.behind) == ((nothing, crate), (crate, nothing))


def test_moves_that_go_nowhere_are_no_way_to_a_part() -> None:
    here, there = to((0.5, 0.0, 0.3)), to((0.0, 0.4, 0.5))
    made = handled(there, here, here, ON, here, there, there)
    crate = frozenset({"crate"})
    assert [bool(names) for names in made.behind] == [False, True, True, False, False, False]
    assert [names == crate for names in made.before] == [False] * 3 + [True, True, False]


def test_what_is_said_once_more_at_the_same_place_takes_no_other() -> None:
    kind = part(count=(2, 1, 1), pitch=(0.07, 0.0, 0.0))
    made = handled(to((0.5, 0.0, 0.3)), ON, ON, to((0.0, 0.4, 0.5)), parts=(kind,))
    assert [p.held for p in made.arrangements[1]] == [True, False]
    assert not [note for note in made.notes if "release" not in note.message]


def test_parts_that_are_not_there_are_said_with_their_line() -> None:
    made = handled(OFF, to((0.9, 0.0, 0.3)), ON, to((0.5, 0.0, 0.3)), OFF)
    far, none = made.notes
    assert str(far).startswith("m.mod:7")
    assert "370 mm away from crate" in far.message
    assert "near_mm" in far.message
    assert "none is held" in none.message
    assert not any(p.held for p in made.arrangements[1])


def test_a_part_whose_statements_never_come_is_said() -> None:
    made = handled(to((0.5, 0.0, 0.3)), parts=(part(attach=("doOther",)),))
    (note,) = made.notes
    assert "cell.toml" in note.message
    assert "'doOther'" in note.message
    kept = handled(to((0.5, 0.0, 0.3)), ON, to((0.4, 0.0, 0.3)))
    (note,) = kept.notes
    assert "it stays on the tool" in note.message


def test_a_statement_that_takes_and_releases_is_refused_with_its_line() -> None:
    with pytest.raises(InputError, match=r"m\.mod:7.*both attaches and releases 'crate'"):
        handled(to((0.5, 0.0, 0.3)), ON, parts=(part(attach=("grip",), release=("setdo",)),))


def test_nobody_takes_a_part_from_nowhere() -> None:
    nowhere = replace(to((0.5, 0.0, 0.3)), open="its target is not known")
    assert "nobody knows where" in said(handled(nowhere, ON))
    assert "nobody knows where" in said(handled(ON, to((0.5, 0.0, 0.3))))
    lost = handled(to((0.5, 0.0, 0.3)), ON, nowhere, OFF, to((0.5, 0.0, 0.3)))
    assert "it stays on the tool" in said(lost)
    assert lost.arrangements[2][0].held


def test_a_joint_target_is_a_place_too() -> None:
    q = (0.3, 0.2, 0.1, 0.4, 0.5, 0.6)
    at = (ROBOT.flange_pose(q) @ TOOL.tcp).position
    move = replace(to((0, 0, 0)), target=JointTarget(q))
    made = handled(move, ON, to((0.5, 0.0, 0.3)), parts=(part(at),))
    assert made.arrangements[1][0].held
    started = handled(ON, to((0.5, 0.0, 0.3)), parts=(part(at),), start=JointTarget(q))
    # Before the first move nobody knows which tool is mounted: the flange is what is near.
    assert "none is near" in said(started)


def test_a_work_object_on_a_table_moves_the_place() -> None:
    robot = ROBOT.with_external_axes([TURNTABLE])
    frame = WorkObject("wob", moved_by="turntable")
    kind = part((0.0, 0.1, 0.0), carried_by="turntable")
    move = to((0.0, 0.1, 0.0), work_object=frame, external=(1.2,))
    made = handled(move, ON, to((0.5, 0.0, 0.3)), parts=(kind,), robot=robot)
    assert made.arrangements[1][0].held
    elsewhere = to((0.6, 0.1, 0.1), external=(1.2,))
    assert "none is near" in said(handled(elsewhere, ON, parts=(kind,), robot=robot))


def test_a_stationary_tool_is_come_to_by_the_flange() -> None:
    gun = Tool("gun", Pose((0.6, 0.0, 0.5)), robot_held=False)
    frame = WorkObject("held", robot_held=True)
    move = to((0.0, 0.0, 0.2), (0.0, 0.0, 0.0), tool=gun, work_object=frame)
    made = handled(move, ON, move, parts=(part((0.6, 0.0, 0.3)),))
    assert alike(made.arrangements[1][0].pose, Pose())


def test_events_on_the_way_count_at_the_end_that_they_are_counted_from() -> None:
    here, there = to((0.5, 0.0, 0.3)), to((0.0, 0.4, 0.5))
    before = replace(here, events=(Event("SetDO grip,1", EventAnchor.END, 0.01),))
    behind = replace(there, events=(Event("SetDO grip,1", EventAnchor.START),))
    for made in (handled(before, there), handled(here, behind)):
        assert [arrangement[0].held for arrangement in made.arrangements] == [False, True]


def test_a_call_counts_before_what_its_body_does() -> None:
    place = Span("m.mod", 3, 1, 0, 1)
    calls = (Call("Grip 1;", 1, place), Call("Grip 0;", 2, place))
    kind = part(attach=("Grip 1",), release=("Grip 0",))
    steps = [to((0.5, 0.0, 0.3)), to((0.0, 0.4, 0.5)), to((0.0, 0.3, 0.5))]
    made = handled(*steps, parts=(kind,), calls=calls)
    assert [arrangement[0].held for arrangement in made.arrangements] == [False, True, False]


def test_what_leaves_the_cell_is_gone_and_not_taken_again() -> None:
    kind = part(leaves=True)
    steps = [to((0.5, 0.0, 0.3)), ON, to((0.0, 0.4, 0.5)), OFF, to((0.0, 0.4, 0.5)), ON]
    made = handled(*steps, parts=(kind,))
    assert made.arrangements[2][0].gone
    assert "none is left" in said(made)


# Loads


def loaded(*statements, parts) -> tuple[list[Move], str]:
    cell = Cell(ROBOT, "abb", parts=parts)
    program = Program(statements)
    made, notes = with_loads(program, handling_of(program, cell))
    return list(made.moves), " ".join(map(str, notes))


@settings(max_examples=60, deadline=None)
@given(poses, st.floats(0.01, 50), st.tuples(*[st.floats(0.001, 1.0)] * 3), places, st.booleans())
def test_a_carried_part_weighs_as_a_body_where_it_is(
    at: Pose, mass: float, inertia, centre, before: bool
) -> None:
    own = Load(0.7, (0.0, 0.1, 0.0), (0.01, 0.02, 0.03)) if before else None
    kind = part(near=10.0, load=Load(mass, centre, inertia))
    take = replace(to((0, 0, 0), load=own), target=PoseTarget(at))
    moves, notes = loaded(take, ON, take, OFF, take, parts=(kind,))
    assert not notes
    assert moves[0].load == moves[2].load == own
    flange = at @ TOOL.tcp.inverse()
    alone = Inertia.of_load(kind.load, flange.inverse() @ kind.geometry.placement)
    whole = carried_inertia(TOOL, own) + alone
    found = carried_inertia(TOOL, moves[1].load)
    assert found.mass == pytest.approx(whole.mass)
    assert np.allclose(found.centre, whole.centre, atol=1e-9)
    assert np.allclose(found.tensor, whole.tensor, rtol=1e-6, atol=1e-6 * mass)


def test_a_load_that_the_program_declares_while_it_carries_counts() -> None:
    kind = part(load=Load(2.0))
    here = to((0.5, 0.0, 0.3))
    same, other = Load(2.0, (0.0, 0.0, 0.1), name="crate"), Load(3.0, name="crate")
    moves, notes = loaded(here, ON, replace(here, load=same), parts=(kind,))
    assert moves[1].load == same
    assert not notes
    moves, notes = loaded(here, ON, replace(here, load=other), parts=(kind,))
    assert moves[1].load == other
    assert "4.5 kg with the tool" in notes
    assert "3.5 kg" in notes


def test_a_part_without_mass_weighs_nothing() -> None:
    moves, _ = loaded(to((0.5, 0.0, 0.3)), ON, to((0.0, 0.4, 0.5)), parts=(part(),))
    assert moves[1].load is None


@settings(max_examples=60, deadline=None)
@given(places, poses, st.tuples(*[st.floats(0.01, 0.5)] * 3))
def test_the_distance_to_a_box_is_that_of_its_nearest_point(point, place: Pose, size) -> None:
    found = distance_to_box(point, place, Geometry(Box(size)).box)
    local = np.array((place.inverse() @ Pose(point)).position)
    nearest = np.clip(local, -np.array(size) / 2, np.array(size) / 2)
    assert found == pytest.approx(float(np.linalg.norm(local - nearest)), abs=1e-12)
