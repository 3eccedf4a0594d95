"""Which arms can take the places of a program."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import flyby
from flyby.core.driving.fitting_arms import TakenPlaces
from flyby.core.errors import InputError, MotionError
from flyby.core.registry import all_listed, find_robot, find_vendor
from flyby.core.robot.arm_list import Listed
from flyby.core.source.reading import ReadOptions
from flyby.vendors.abb.run.reader import read

UNUSED = "[9E9,9E9,9E9,9E9,9E9,9E9]"
SMALL, LARGE = "abb/irb120-3-058", "abb/irb6640-180-255"


def places(*moves: str, data: str = "") -> TakenPlaces:
    body = "\n".join(moves)
    text = f"MODULE M\n{data}\nPROC main()\n{body}\nENDPROC\nENDMODULE"
    return TakenPlaces.of(read(text, "a.mod", ReadOptions()))


def posture(*degrees: float) -> str:
    return f"MoveAbsJ [[{','.join(map(str, degrees))}],{UNUSED}],v100,fine,tool0;"


def at(x: float, y: float, z: float, confdata: str = "0,0,0,0", tool: str = "tool0") -> str:
    return f"MoveJ [[{x},{y},{z}],[0,0,1,0],[{confdata}],{UNUSED}],v100,fine,{tool};"


def names(found: TakenPlaces, *robots: str) -> list[str]:
    arms = [Listed(robot, robot, axes=6, reach=number) for number, robot in enumerate(robots)]
    return [arm.name for arm in found.taken_by(find_vendor("abb"), arms)]


def test_postures_and_poses_tell_small_arms_from_large_ones() -> None:
    near, far = at(300, 50, 300), at(1600, 100, 900)
    assert names(places(near), SMALL, LARGE) == [SMALL]
    assert names(places(far), SMALL, LARGE) == [LARGE]
    assert names(places(near, far), SMALL, LARGE) == []
    assert names(places(posture(0, 0, -150, 0, 20, 0)), SMALL, LARGE) == [LARGE]
    assert names(places(posture(0, 0, 0, 0, 0, 5000)), SMALL, LARGE) == []


def test_programmed_configurations_go_first() -> None:
    """Of two arms that both can, the one comes first whose solutions have them."""
    moves = [at(420, y, 300, "0,-1,0,0") for y in (20, 60, 100)]
    both = names(places(*moves), "abb/irb1200-5-090", SMALL)
    assert sorted(both) == sorted(["abb/irb1200-5-090", SMALL])
    counted = [places(*moves)._fit(find_vendor("abb"), find_robot(robot)) for robot in both]
    assert counted == sorted(counted, reverse=True)


@pytest.mark.parametrize(
    "move",
    [
        at(9000, 0, 0, tool="tGone"),
        f"MoveL [[9000,0,0],[0,0,1,0],[0,0,0,0],{UNUSED}],v100,fine,tool0\\WObj:=wGone;",
        f"MoveL [[9000,0,0],[0,0,1,0],[0,0,0,0],{UNUSED}],v100,fine,tool0\\WObj:=wBelt;",
    ],
)
def test_what_hangs_on_what_nobody_knows_is_left_out(move: str) -> None:
    belt = 'PERS wobjdata wBelt:=[FALSE,FALSE,"CNV1",[[0,0,0],[1,0,0,0]],[[0,0,0],[1,0,0,0]]];'
    assert places(move, data=belt).count == 0
    assert places(move, at(300, 0, 300), data=belt).count == 1


def test_arms_that_are_not_driven_or_have_other_axes_are_no_answer() -> None:
    found = places(at(300, 0, 300))
    arms = [Listed(SMALL, "a", axes=7), Listed("abb/none", "b", axes=6, refused="it is")]
    assert found.taken_by(find_vendor("abb"), arms) == []


@settings(max_examples=15, deadline=None)
@given(data=st.data())
def test_an_arm_takes_every_place_that_it_stands_in(data: st.DataObject) -> None:
    robot = find_robot(data.draw(st.sampled_from([SMALL, LARGE, "abb/irb1600-6-145"])))
    span = zip(robot.limits.lower, robot.limits.upper, strict=True)
    q = np.array([data.draw(st.floats(0.9 * lo, 0.9 * hi)) for lo, hi in span])
    pose = robot.flange_pose(q)
    found = TakenPlaces((tuple(q),), ((pose, find_vendor("abb").label(robot, q)),))
    assert not found.missed_by(find_vendor("abb"), robot)


def test_who_names_no_robot_hears_which_would_do(tmp_path: Path) -> None:
    file = tmp_path / "a.mod"
    moves = "\n".join([posture(0, 0, -100, 0, 20, 0), at(300, 50, 300), at(320, 60, 300)])
    file.write_text(f"MODULE M\nPROC main()\n{moves}\nENDPROC\nENDMODULE\n")
    with pytest.raises(InputError, match=rf"which robot\?.*of the catalogue .*{SMALL}.*3 places"):
        flyby.read(file)


def test_a_robot_that_is_too_small_is_doubted(tmp_path: Path) -> None:
    file = tmp_path / "a.mod"
    far = [at(1700, 100 + 10 * k, 900) for k in range(3)]

    def emulated(*moves: str) -> flyby.Run:
        body = "\n".join(moves)
        file.write_text(f"MODULE M\nPROC main()\n{body}\nENDPROC\nENDMODULE\n")
        return flyby.emulate(flyby.read(file, robot=SMALL, configuration="nearest"))

    with pytest.raises(MotionError, match=r"is it the right one, and does it stand in the world"):
        emulated(*far)
    run = emulated(at(300, 0, 300), at(320, 0, 300), *far)
    (note,) = (n for n in run.notes if "the right one" in n.message)
    assert note.message.startswith(f"{SMALL} cannot take them all, wherever it comes from; of the")
    assert run.faults
    fine = emulated(at(300, 0, 300), at(320, 0, 300))
    assert not any("the right one" in n.message for n in fine.notes)


def test_all_arms_of_the_catalogue_can_be_asked() -> None:
    vendor = find_vendor("abb")
    found = places(at(300, 50, 300)).taken_by(vendor, all_listed(vendor))
    assert SMALL in {arm.name for arm in found}
    assert len(found) < len(vendor.robots)
