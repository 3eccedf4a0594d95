"""The posture in which programs are taken to begin that ask where the robot stands."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import flyby
from flyby.core.errors import FlybyError
from flyby.core.motion.configurations.targets import Targets
from flyby.core.registry import find_robot, installed
from flyby.core.robot.kinematics.chain_kernels import jacobians
from flyby.core.robot.posture import elbow_height
from flyby.core.robot.ready_posture import ready_posture
from flyby.testing.strategies import poses

NAMES = installed().robot_names


@settings(deadline=None, max_examples=60)
@given(st.sampled_from(NAMES), poses())
def test_it_is_in_reach_far_from_singularities_wherever_the_robot_stands(name, base) -> None:
    robot = find_robot(name)
    q = np.array(ready_posture(robot))
    assert np.all(q >= robot.limits.lower) and np.all(q <= robot.limits.upper)
    R, p = robot.forward(q)
    assert R[2, 2] < -0.99
    assert p[0] > 0.1
    singular = np.linalg.svd(jacobians(robot.arm_chain, q[None, : robot.arm_size])[0])[1]
    assert singular[-1] > 1e-2
    np.testing.assert_array_equal(q, ready_posture(robot.with_base(base)))


ASKING = {
    "abb/irb120": """MODULE a
  PROC main()
    MoveL Offs(CRobT(),0,0,50), v100, fine, tool0;
    MoveL RelTool(CRobT(),0,0,20), v100, fine, tool0;
  ENDPROC
ENDMODULE
""",
    "kuka/kr30-3": "DEF a()\nBAS(#INITMOV,0)\nLIN_REL {Z 50}\nLIN_REL {X 20}\nEND\n",
    "ur/ur5e": "def a():\n  p = get_actual_tcp_pose()\n  p[2] = p[2] + 0.05\n  movel(p)\n"
    "  q = get_actual_joint_positions()\n  q[0] = q[0] + 0.2\n  movej(q)\nend\n",
}


@pytest.mark.parametrize("robot", ASKING)
def test_programs_that_ask_where_the_robot_stands_are_driven(robot: str) -> None:
    program = flyby.read(ASKING[robot], robot=robot)
    assert "asks where the robot stands before its first move" in str(program.notes[0])
    run = flyby.emulate(program)
    assert run.faults == ()
    assert len(run.program.moves) == 2
    q = run.parts[0].run.trajectory.q[0]
    np.testing.assert_allclose(q, ready_posture(find_robot(robot)), atol=1e-9)


@pytest.mark.parametrize("robot", ASKING)
def test_a_start_that_is_given_counts(robot: str) -> None:
    q = 0.9 * np.array(ready_posture(find_robot(robot)))
    program = flyby.read(ASKING[robot], robot=robot, start=q)
    assert not any("it is taken to stand" in str(note) for note in program.notes)
    np.testing.assert_allclose(flyby.emulate(program).parts[0].run.trajectory.q[0], q, atol=1e-9)


def test_what_a_start_does_not_help_is_refused_as_before() -> None:
    with pytest.raises(FlybyError, match="nowhere"):
        program = flyby.read(
            "MODULE a\nPROC main()\nMoveL nowhere, v100, fine, tool0;\nENDPROC\nENDMODULE\n",
            robot="abb/irb120",
        )
        flyby.emulate(program)


def test_numbers_made_of_the_present_place_are_no_numbers_from_nowhere() -> None:
    text = """MODULE letters
  VAR pos pen;
  PROC main()
    VAR robtarget here;
    here:=CRobT();
    pen:=[here.trans.x-60,here.trans.y,here.trans.z];
    MoveL [pen,[0,0,1,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]],v100,fine,tool0;
    pen.y:=pen.y+40;
    MoveL [pen,[0,0,1,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]],v100,fine,tool0;
  ENDPROC
ENDMODULE
"""
    program = flyby.read(text, robot="abb/irb1600-6-145")
    assert "asks where the robot stands before its first move" in str(program.notes[0])
    robot = find_robot("abb/irb1600-6-145")
    _, stands = robot.forward(np.array(ready_posture(robot)))
    first = program.moves[0].target.pose.position
    np.testing.assert_allclose(first, stands - (0.06, 0, 0), atol=1e-6)
    assert flyby.emulate(program).faults == ()


@pytest.mark.parametrize("name", ["ur/ur3e", "ur/ur5e", "ur/ur10e", "ur/ur20"])
def test_an_arm_that_is_stretched_out_at_zero_begins_with_its_elbow_above(name: str) -> None:
    """Its first pose says nothing of the posture: the one nearest to zero reaches up from below."""
    robot = find_robot(name)
    q = np.array(ready_posture(robot))
    assert elbow_height(robot, q) > 0.05
    _, place = robot.forward(q)
    reach = float(np.hypot(*place[:2]))
    for turn in np.radians((-120, -60, 0, 60, 120)):
        at = f"{reach * np.cos(turn)}, {reach * np.sin(turn)}"
        first, second = (f"p[{at}, {place[2] - down}, 0, 3.14159, 0]" for down in (0.0, 0.02))
        text = f"movej({first})\nmovel({second})\n"
        run = flyby.emulate(flyby.read(text, robot=name, vendor="ur"))
        assert elbow_height(robot, run.parts[0].run.trajectory.q[0]) > 0.05


@pytest.mark.parametrize("name", ["abb/irb2600-12-165", "kuka/kr16-2"])
def test_arms_that_are_not_begin_near_zero(name: str) -> None:
    robot = find_robot(name)
    limits = robot.limits
    zero = np.clip(np.zeros(robot.size), limits.lower, limits.upper)
    np.testing.assert_array_equal(Targets(robot).rest(), zero)
