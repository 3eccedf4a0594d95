"""confdata: quadrants, cfx, and what happens on their edges."""

import numpy as np
import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st

from flyby.core.errors import InputError, MotionError
from flyby.core.motion.emulator.controller import Controller
from flyby.core.program.move import MoveJ
from flyby.core.program.program import Program
from flyby.core.program.speed import Speed
from flyby.core.program.target import Configuration, JointTarget, PoseTarget
from flyby.core.program.zone import FINE
from flyby.core.registry import find_vendor
from flyby.core.robot.model import Robot
from flyby.testing.strategies import configurations
from flyby.vendors.abb.motion.configuration import AbbConfiguration, label
from flyby.vendors.ur.motion.configuration import UrConfiguration

ABB = find_vendor("abb")
IRB6640 = ABB.robot("irb6640-180-255")

degrees = st.floats(-350, 350)


def label_of(robot: Robot, *q: float) -> AbbConfiguration:
    found = label(robot, np.radians(q))
    assert found is not None
    return found


@pytest.mark.parametrize(
    ("angle", "quadrant"),
    [(45, 0), (135, 1), (225, 2), (315, 3), (-45, -1), (-135, -2), (-225, -3), (-315, -4)],
)
def test_quadrants_count_both_ways_from_zero(angle: float, quadrant: int) -> None:
    assert label_of(IRB6640, 10, 0, 0, angle, 30, 10) == AbbConfiguration(0, quadrant, 0, 0)
    assert label_of(IRB6640, 10, 0, 0, 10, 30, angle) == AbbConfiguration(0, 0, quadrant, 0)


@pytest.mark.parametrize(
    ("q", "cfx"),
    [
        ((10, 0, 0, 10, 30, 10), 0),
        ((10, 0, 0, 10, -30, 10), 1),
        # The forearm folded back over the lower arm, which leans forward.
        ((10, 80, -150, 10, 30, 10), 2),
        ((10, 80, -150, 10, -30, 10), 3),
        # The lower arm leans back so far that the wrist comes to lie behind axis 1.
        ((10, -64, -40, 10, 30, 10), 4),
        ((10, -64, -40, 10, -30, 10), 5),
        ((10, -60, -90, 10, 30, 10), 6),
        ((10, -60, -90, 10, -30, 10), 7),
    ],
)
def test_cfx_numbers_the_eight_postures(q: tuple[float, ...], cfx: int) -> None:
    assert label_of(IRB6640, *q).cfx == cfx


@pytest.mark.parametrize("name", ABB.robots)
@settings(max_examples=20, deadline=None)  # of more than a hundred arms each
@given(data=st.data())
def test_solutions_of_one_pose_have_different_labels(name: str, data: st.DataObject) -> None:
    robot = ABB.robot(name)
    q = data.draw(configurations(robot, margin=0.0))
    solutions = robot.inverse(robot.flange_pose(q))
    assume(not any(solution.singular for solution in solutions))
    labels = [label(robot, solution.q) for solution in solutions]
    decided = [found for found in labels if found is not None and not found.undecided]
    assert len({found.cfx for found in decided}) == len(decided)


@pytest.mark.parametrize("name", ["irb5400", "irb5400-22", "irb5500-23", "irb580-16"])
@pytest.mark.parametrize(
    "q", [(0, 0, 0, 0, 0, 1), (0, 0, 0, 0, 1e-7, 1), (0.3, 0.2, -0.1, 1, 0, 2)]
)
def test_a_hollow_wrist_is_found_where_it_is_straight(name: str, q: tuple[float, ...]) -> None:
    robot = ABB.robot(name)
    pose = robot.flange_pose(np.array(q, dtype=float))
    for found in robot.inverse(pose):
        np.testing.assert_allclose(robot.flange_pose(found.q).matrix(), pose.matrix(), atol=1e-9)


@given(q=st.tuples(*[degrees] * 6))
def test_a_label_matches_itself(q: tuple[float, ...]) -> None:
    found = label_of(IRB6640, *q)
    assert found.mismatch(found) == 0
    assert isinstance(found, Configuration)
    assert found.admits(found)


@given(st.integers(-3, 3), st.floats(-0.05, 0.05))
def test_at_a_quadrant_edge_both_neighbours_match(quarter: int, off: float) -> None:
    """Five written digits of a quaternion move an axis by up to 0.01 degrees."""
    found = label_of(IRB6640, 10, 0, 0, 90 * quarter + off, 30, 10)
    below, above = (AbbConfiguration(0, cf4, 0, 0) for cf4 in (quarter - 1, quarter))
    assert below.mismatch(found) == above.mismatch(found) == 0
    assert AbbConfiguration(0, quarter + 1, 0, 0).mismatch(found) == 1
    assert AbbConfiguration(0, quarter - 2, 0, 0).mismatch(found) == 1


@given(st.integers(-3, 3), st.floats(0.1, 89.9))
def test_inside_a_quadrant_only_that_one_matches(quarter: int, inside: float) -> None:
    found = label_of(IRB6640, 10, 0, 0, 90 * quarter + inside, 30, 10)
    matching = [k for k in range(-6, 7) if AbbConfiguration(0, k, 0, 0).mismatch(found) == 0]
    assert matching == [quarter]


def test_an_undecided_axis_5_fits_either_sign() -> None:
    found = label_of(IRB6640, 10, 0, 0, 10, 0, 10)
    assert [AbbConfiguration(0, 0, 0, k).mismatch(found) for k in range(8)] == [
        *(0, 0, 1, 1, 1, 1, 2, 2)
    ]


def test_without_a_spherical_wrist_quadrants_alone_count() -> None:
    """No source says what cfx counts on a CRB 15000: any fits."""
    gofa = find_vendor("abb").robot("crb15000-5-095")
    found = label(gofa, np.radians([10.0, 20.0, -30.0, -100.0, 40.0, 95.0]))
    assert found is not None and (found.cf1, found.cf4, found.cf6) == (0, -2, 1)
    assert all(AbbConfiguration(0, -2, 1, cfx).mismatch(found) == 0 for cfx in range(8))
    assert AbbConfiguration(0, -2, 0, 0).mismatch(found) > 0
    seven = find_vendor("kuka").robot("iiwa14-r820")
    assert label(seven, np.zeros(7)) is None


def test_what_cannot_be_compared_or_is_no_cfx_is_refused() -> None:
    with pytest.raises(InputError, match="cannot be compared"):
        AbbConfiguration(0, 0, 0, 0).mismatch(UrConfiguration((0.0,)))
    with pytest.raises(InputError, match="from 0 to 7"):
        AbbConfiguration(0, 0, 0, 8)


@given(st.integers(-3, 3), st.floats(0.1, 89.9), st.integers(0, 7))
def test_a_neighbouring_quadrant_is_admitted_and_no_other_posture(
    quarter: int, inside: float, cfx: int
) -> None:
    found = label_of(IRB6640, 10, 0, 0, 90 * quarter + inside, 30, 10)
    admitted = [k for k in range(-6, 7) if AbbConfiguration(0, k, 0, 0).admits(found)]
    assert admitted == list(range(quarter - 1, quarter + 2))
    assert AbbConfiguration(0, quarter, 0, cfx).admits(found) is (cfx == 0)


def test_arms_whose_cfx_nobody_knows_take_no_neighbouring_quadrant_at_random() -> None:
    """Several postures of a CRB 15000 are within a quadrant of what is programmed."""
    robot = ABB.robot("crb15000-5-095")
    taught = np.array([1.43, -0.93, 0.46, -1.3, 1.09, 0.17])
    pose = robot.flange_pose(taught)
    own = label(robot, taught)
    assert own is not None and own.undecided == 7
    controller = Controller(ABB, robot)

    def arrived(cf6: int) -> np.ndarray:
        target = PoseTarget(pose, AbbConfiguration(own.cf1, own.cf4, cf6, 0))
        move = MoveJ(target, Speed(joint_fraction=0.5), FINE)
        run = controller.run(Program((move,), start=JointTarget((0.0,) * 6)), None, None)
        assert not any("postures of this arm" in str(note) for note in run.notes)
        return run.trajectory.q[-1]

    assert arrived(own.cf6) == pytest.approx(taught, abs=1e-6)
    with pytest.raises(MotionError, match="contradicts the pose"):
        arrived(own.cf6 + 1)
