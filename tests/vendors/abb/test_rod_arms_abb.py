"""Arms whose forearm a rod holds: read, driven, labelled, proven and optimised as others."""

from __future__ import annotations

import numpy as np
import pytest

import flyby
from flyby.core.backup.contents import BackupNotes
from flyby.core.errors import FaultCause, MotionError
from flyby.core.registry import find_robot
from flyby.vendors.abb.backup.cfg import parse_parameters
from flyby.vendors.abb.backup.mechanics import mechanics_of

from .backup.station import cfg, one_robot

ARM = "abb/irb2400-16-155"
TEXT = """MODULE Rod
  CONST jointtarget high:=[[0,-20,10,0,40,0],[9E9,9E9,9E9,9E9,9E9,9E9]];
  CONST jointtarget low:=[[0,60,10,0,40,0],[9E9,9E9,9E9,9E9,9E9,9E9]];
  CONST robtarget near:=[[900,200,800],[0,0,1,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]];
  CONST robtarget side:=[[900,-200,800],[0,0,1,0],[-1,0,-1,0],[9E9,9E9,9E9,9E9,9E9,9E9]];
  PROC main()
    MoveAbsJ high,v1000,fine,tool0;
    MoveAbsJ low,v1000,fine,tool0;
    MoveJ near,v1000,z50,tool0;
    MoveL side,v500,fine,tool0;
  ENDPROC
ENDMODULE
"""


@pytest.fixture
def program(tmp_path):
    path = tmp_path / "rod.mod"
    path.write_text(TEXT, "utf-8")
    return flyby.read(path, robot=ARM)


def test_a_move_of_j2_alone_leaves_the_forearm_as_it_lies(program) -> None:
    """From high to low: nothing turns but the upper arm."""
    run = flyby.emulate(program)
    driven = run.trajectory.q[run.trajectory.move == 1]
    R, p = find_robot(ARM).forward(driven)
    assert np.ptp(driven[:, 1]) > 1.0
    np.testing.assert_allclose(R, np.broadcast_to(R[0], R.shape), atol=1e-9)
    # The wrist runs round axis 2 at the length of the upper arm.
    centre = p[0] - 0.705 * np.array([np.sin(driven[0, 1]), 0.0, np.cos(driven[0, 1])])
    np.testing.assert_allclose(np.linalg.norm(p - centre, axis=1), 0.705, atol=1e-9)


def test_zones_of_it_are_proven_and_read_back(program) -> None:
    found = flyby.zones(program)
    assert found.after.time < found.before.time
    assert found.certificate is not None
    assert found.certificate.proven and found.certificate.clearance > 0.0


def test_j3_as_displayed_has_the_range_and_the_joint_has_not() -> None:
    """J3 and J2 at their ends together: the angle between the arms is far beyond J3's range."""
    robot = find_robot(ARM)
    q = np.array([0.0, np.radians(105.0), np.radians(-55.0), 0.0, 0.5, 0.0])
    found = [solution.q for solution in robot.inverse(robot.flange_pose(q))]
    assert min(np.abs(one - q).max() for one in found) < 1e-9
    q[1:3] = np.radians([-20.0, -65.0])  # the joint of J3 at -45 degrees
    beyond = TEXT.replace("[0,60,10,0,40,0]", "[0,-20,-65,0,40,0]")
    with pytest.raises(MotionError, match="J3") as refused:
        flyby.emulate(flyby.read(beyond, robot=ARM), strict=True)
    assert refused.value.cause is FaultCause.LIMIT


def test_a_backup_of_one_opens_with_its_own_ranges() -> None:
    ranges = ((-180, 180), (-42, 85), (-20, 120.5), (-300, 300), (-120, 120), (-360, 360))
    moc = parse_parameters(cfg("MOC", one_robot(ranges=ranges, kind="6660_1.90_205")), "MOC.cfg")
    (found,) = mechanics_of(moc, (), {}, find_robot, BackupNotes()).robots
    assert found.robot is not None and found.robot.name == "abb/irb6660-205-190"
    assert found.robot.joints[2].upper == pytest.approx(np.radians(120.5))
    assert found.robot.joints[2].coupling() == "the joint of J3 turns by J3 - J2"
