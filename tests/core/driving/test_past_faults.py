"""Programs driven past moves that cannot be driven: what is at fault, what comes of the rest."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import flyby
from flyby.core.driving.driven_program import Fault, refusal
from flyby.core.driving.past_faults import drive, refuse_faults
from flyby.core.errors import FaultCause, MotionError, Span
from flyby.core.motion.command.trajectory import Trajectory
from flyby.core.motion.emulator.controller import Controller
from flyby.core.program.move import MoveJ, MoveL, Wait
from flyby.core.program.program import Program
from flyby.core.program.speed import Speed
from flyby.core.program.target import JointTarget, PoseTarget
from flyby.core.program.zone import FINE, Radius
from flyby.core.registry import find_robot, find_vendor
from flyby.core.spatial.pose import Pose
from flyby.vendors.abb.motion.configuration import AbbConfiguration

SPEED = Speed(tcp=0.4, reorientation=3.0)
ZONE = Radius(0.01)
PLACES = ((1, 0, 0), (1, 1, 0), (0, 1, 0), (0, 0, 0.5), (0.5, 0.5, 0.2))
FAR = PoseTarget(Pose((9.0, 0.0, 0.5)))


def beyond(arm) -> JointTarget:
    return JointTarget((0.0, 0.0, 20.0, 0.0, 0.0, 0.0))


def moves_of(arm, kinds: list[str]) -> list[MoveJ | MoveL]:
    """A round of places; those of the kind ``r`` are out of reach, ``l`` is beyond a limit."""
    made: list[MoveJ | MoveL] = []
    for i, kind in enumerate(kinds):
        target = arm.target(PLACES[i % len(PLACES)])
        if kind == "l":
            made.append(MoveJ(beyond(arm), SPEED))
        else:
            made.append(MoveL(FAR if kind == "r" else target, SPEED, ZONE))
    return made


def test_a_program_without_faults_is_driven_as_a_whole(abb) -> None:
    controller = abb.controller()
    program = Program(tuple(moves_of(abb, ["."] * 4)), start=abb.start)
    driven, run = drive(controller, program), controller.run(program)
    assert not driven.faults and len(driven.parts) == 1
    assert driven.duration == run.duration
    np.testing.assert_array_equal(driven.trajectory.q, run.trajectory.q)


@settings(max_examples=12, deadline=None)
@given(st.lists(st.sampled_from("...rl"), min_size=2, max_size=9))
def test_every_fault_is_named_and_all_else_is_driven(abb, kinds: list[str]) -> None:
    controller = abb.controller()
    program = Program(tuple(moves_of(abb, kinds)), start=abb.start)
    bad = {i: kind for i, kind in enumerate(kinds) if kind != "."}
    try:
        driven = drive(controller, program)
    except MotionError as error:
        # Behind each of the faults at most one place is left, which the robot is put at.
        assert bad and error.move == min(bad)
        return
    assert {fault.move: fault.cause for fault in driven.faults} == {
        i: FaultCause.REACH if kind == "r" else FaultCause.LIMIT for i, kind in bad.items()
    }
    done = {part.first + i for part in driven.parts for i in part.run.path.route.moves}
    # A move is left out only where nobody knows where it comes from.
    assert done == {i for i in range(len(kinds)) if i not in bad and i - 1 not in bad}
    for part in driven.parts:
        trajectory = part.run.trajectory
        assert np.abs(trajectory.dq[[0, -1]]).max() < 1e-6
    if bad:
        with pytest.raises(MotionError):
            controller.run(program)


def test_clocks_and_indices_go_on_across_gaps(abb, tmp_path) -> None:
    statements = [*moves_of(abb, ["."] * 3), MoveL(FAR, SPEED, ZONE), Wait(5.0)]
    statements += [*moves_of(abb, ["."] * 2), Wait(0.25), *moves_of(abb, ["."] * 3)]
    driven = drive(abb.controller(), Program(tuple(statements), start=abb.start))
    first, second = driven.parts
    assert (first.first, second.first) == (0, 5)
    # What the robot would have waited for behind the fault is waited for at no place it comes to.
    assert driven.duration == first.run.duration + second.run.duration
    assert second.run.duration < 5.0
    whole = driven.trajectory
    assert whole.gaps == (len(first.run.trajectory.t),)
    assert whole.t[whole.gaps[0]] == whole.t[whole.gaps[0] - 1]
    assert (np.diff(whole.t) >= 0).all() and whole.duration == pytest.approx(driven.duration)
    # The first move behind the gap goes to where the robot is put.
    assert sorted(set(whole.move)) == [0, 1, 2, 5, 6, 7, 8]
    for name, load in (("a.csv", Trajectory.load_csv), ("a.npz", Trajectory.load_npz)):
        getattr(whole, f"save_{name[2:]}")(tmp_path / name)
        back = load(tmp_path / name)
        assert back.gaps == whole.gaps
        np.testing.assert_allclose(back.q, whole.q, atol=1e-8)
        np.testing.assert_array_equal(back.move, whole.move)
    parts = whole.resampled(0.003).parts()
    assert [part.t[0] for part in parts] == [0.0, pytest.approx(first.run.duration)]


def test_the_robot_goes_on_from_where_a_move_at_fault_should_have_ended(abb) -> None:
    target = replace(abb.target((1, 1, 0)), configuration=AbbConfiguration(3, 3, 3, 7))
    moves = (MoveL(abb.target((1, 0, 0)), SPEED), MoveL(target, SPEED), *moves_of(abb, ["."]))
    driven = drive(abb.controller(), Program(moves, start=abb.start))
    (fault,) = driven.faults
    assert (fault.move, fault.cause) == (1, FaultCause.CONFIGURATION)
    start = driven.parts[1].run.trajectory.position[0]
    np.testing.assert_allclose(start, abb.target((1, 1, 0)).pose.position, atol=1e-6)


@pytest.mark.parametrize("every", [6, 40])
def test_many_faults_cost_no_more_than_some_drives(abb, monkeypatch, every) -> None:
    planned = 0
    plan = Controller._plan

    def counted(self, program, start):
        nonlocal planned
        planned += len(program.moves)
        return plan(self, program, start)

    monkeypatch.setattr(Controller, "_plan", counted)
    kinds = ["l" if i % every == every - 1 else "." for i in range(20 * every)]
    driven = drive(abb.controller(), Program(tuple(moves_of(abb, kinds)), start=abb.start))
    assert len(driven.faults) == 20
    assert planned < 4 * len(kinds)


def test_a_start_beyond_its_limits_is_a_fault_of_the_first_move(abb) -> None:
    moves = (MoveJ(abb.target((1, 0, 0)), SPEED), *moves_of(abb, ["."] * 3)[1:])
    program = Program(moves, start=beyond(abb))
    driven = drive(abb.controller(), program)
    assert [fault.move for fault in driven.faults] == [0]
    assert driven.faults[0].message.startswith("the start: ")
    assert [part.first for part in driven.parts] == [1]


def test_a_start_that_nobody_knows_is_one_from_which_the_program_can_be_driven(abb) -> None:
    """From the solution nearest to zero joint 4 would wind up beyond its limit."""
    controller = abb.controller()
    first = abb.target((0, 0, 0))
    turns = [JointTarget((0.0, 0.0, 0.0, 0.0, 0.5, 0.0))]
    options = controller._routes.starts(Program((MoveJ(first, SPEED),)))
    assert len(options) > 2
    far = options[-1]
    # A target of joint values tells that the program was taught in another solution: lines that
    # begin there can only be driven from it.
    label = find_vendor("abb").label(abb.robot, np.array(far.joints))
    second = replace(abb.target((1, 0, 0)), configuration=label)
    program = Program((MoveJ(first, SPEED), MoveL(second, SPEED), MoveJ(turns[0], SPEED)))
    with pytest.raises(MotionError) as refused:
        controller._plan(program, None)
    assert refused.value.cause is FaultCause.CONFIGURATION
    path = controller.plan(program)
    assert any("the robot is taken to stand" in note.message for note in path.notes)
    assert label.mismatch(find_vendor("abb").label(abb.robot, path.q[0])) == 0
    assert not drive(controller, program).faults


def test_all_faults_are_named_where_a_program_is_used_as_a_whole(abb) -> None:
    controller = abb.controller()
    program = Program(tuple(moves_of(abb, [".", ".", "r", ".", ".", "l", "."])), start=abb.start)
    with pytest.raises(MotionError, match="1 further move cannot be driven: move 6") as error:
        refuse_faults(controller, program)
    assert error.value.move == 2
    refuse_faults(controller, Program(tuple(moves_of(abb, ["."] * 3)), start=abb.start))


def test_the_nearest_solution_is_driven_to_where_that_is_wanted(abb) -> None:
    wrong = AbbConfiguration(3, 3, 3, 7)
    target = replace(abb.target((1, 1, 0)), configuration=wrong)
    moves = (MoveL(abb.target((1, 0, 0)), SPEED), MoveJ(target, SPEED), MoveL(target, SPEED))
    program = Program((*moves, *moves_of(abb, ["."])), start=abb.start)
    vendor = replace(find_vendor("abb"), nearest=True)
    run = Controller(vendor, abb.robot).run(program)
    told = [note for note in run.notes if "contradicts the pose" in note.message]
    assert [note.move for note in told] == [1] and str(wrong) in told[0].message
    plain = replace(abb.target((1, 1, 0)), configuration=None)
    without = [replace(move, target=plain) for move in moves[1:]]
    same = Program((moves[0], *without, *moves_of(abb, ["."])), start=abb.start)
    np.testing.assert_array_equal(run.path.q, Controller(vendor, abb.robot).run(same).path.q)


def test_a_program_of_faults_only_names_them(abb) -> None:
    program = Program(tuple(moves_of(abb, ["r", "l", "r"])), start=abb.start)
    with pytest.raises(MotionError, match=r"move 1: .* 2 further moves cannot be driven: move 2 "):
        drive(abb.controller(), program)
    with pytest.raises(MotionError, match="goes nowhere"):
        still = Program((MoveJ(abb.start, SPEED, FINE),), start=abb.start)
        drive(abb.controller(), still)


def test_a_neighbouring_quadrant_is_driven_to_with_a_note(abb) -> None:
    controller = abb.controller()
    plain = Program((MoveJ(abb.target((1, 0, 0)), SPEED), MoveL(abb.target((1, 1, 0)), SPEED)))
    plain = replace(plain, start=abb.start)
    run = controller.run(plain)
    found = find_vendor("abb").label(abb.robot, run.path.q[-1])
    assert isinstance(found, AbbConfiguration)
    label = replace(found, cf6=found.cf6 + 1, edges=(False,) * 3, undecided=0)
    moves = [
        replace(move, target=replace(move.target, configuration=label)) for move in plain.moves
    ]
    tolerated = controller.run(replace(plain, statements=tuple(moves)))
    np.testing.assert_array_equal(tolerated.path.q, run.path.q)
    told = [note for note in tolerated.notes if "the nearest that controllers take" in note.message]
    assert [note.move for note in told] == [0] and "1 other move" in told[0].message


def test_behind_a_fault_no_line_leads_to_another_posture(abb) -> None:
    from flyby.core.robot.posture import posture

    controller = abb.controller()
    places = [abb.target(place) for place in PLACES]
    moves = [MoveL(place, SPEED) for place in (places[0], FAR, places[1], places[2], places[0])]
    driven = drive(controller, Program(tuple(moves), start=abb.start))
    signs = {
        tuple(np.sign(posture(abb.robot, q)))
        for part in driven.parts
        for q in part.run.path.q[:: len(part.run.path.q) // 5]
    }
    assert len(driven.faults) == 1 and len(driven.parts) == 2 and len(signs) == 1


def test_the_moves_of_a_loop_are_named_by_their_line_and_counted() -> None:
    line, other = Span("a.mod", 4, 1, 0, 0), Span("a.mod", 7, 1, 0, 0)
    at = {0: line, 2: line, 4: line, 5: other, 7: other}
    faults = [Fault(k, FaultCause.REACH, f"no way {k}", span) for k, span in at.items()]
    error = refusal(faults)
    assert error.move == 0
    assert error.message == (
        "no way 0. 4 further moves cannot be driven: 2 in this line; "
        "move 6, line 7 (reach, 2 times)"
    )


def test_a_posture_beyond_a_range_is_the_programs_own_value(tmp_path) -> None:
    """Another configuration cannot mend what the program says of the joints themselves."""
    unused = "[9E9,9E9,9E9,9E9,9E9,9E9]"
    postures = ("0,0,0,0,30,0", "0,9,0,0,30,0", "0,0,90,0,30,0", "0,10,0,0,30,0")
    moves = "".join(f"MoveAbsJ [[{q}],{unused}],v500,fine,tool0;\n" for q in postures)
    file = tmp_path / "a.mod"
    file.write_text(f"MODULE M\nPROC main()\n{moves}ENDPROC\nENDMODULE\n")
    run = flyby.emulate(flyby.read(file, robot="abb/irb140-6-081"))
    (fault,) = run.faults
    assert fault.span is not None and fault.span.line == 5
    assert "J3 would stand at 90.00 °" in fault.message
    assert "the program says this value itself" in fault.message
    assert "configuration" not in fault.message


def test_another_start_is_tried_where_a_line_leaves_the_reach_of_the_first() -> None:
    """A wrist turned over takes room: from there the arm is too short for what it else drives."""
    points = "p[0.14,0.04,-0.22,0,3.14,0]", "p[0.28,0.13,-0.22,0,3.14,0]"
    text = "\n".join(f"movel({point}, a=0.5, v=0.1)" for point in points)
    program = flyby.read(text, robot="ur/ur3e")
    controller = Controller(find_vendor("ur"), find_robot("ur/ur3e"))
    with pytest.raises(MotionError, match="leaves its reach") as refused:
        controller._plan(program, None)
    assert refused.value.cause is FaultCause.REACH
    assert not drive(controller, program).faults
    far = flyby.read(text.replace("0.28", "0.9"), robot="ur/ur3e")
    assert controller.furthest_start(far) is None, "no start helps to reach it"
