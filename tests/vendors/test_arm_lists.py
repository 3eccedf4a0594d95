"""The arms that vendors list: each loads, stands where it should, and is found by its names."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

import flyby
from flyby.core.errors import InputError, UnknownNameError
from flyby.core.registry import find_robot, installed
from flyby.core.robot.catalogue import SPREAD, TRUST
from flyby.testing.strategies import allowed

VENDORS = Path(flyby.__file__).parent / "vendors"
ROWS = [
    json.loads(line)
    for file in sorted(VENDORS.glob("*/data/arms.jsonl"))
    for line in file.read_text("utf-8").splitlines()
]
DRIVEN = [row for row in ROWS if "robot" in row]


def test_there_are_as_many_as_are_promised() -> None:
    assert len(installed().robot_names) >= 250


@pytest.mark.parametrize("vendor", ["abb", "kuka", "ur"])
def test_each_arm_stands_where_it_should(vendor) -> None:
    """Check points of an independent forward kinematics; both kinds of inverse come back."""
    rng = np.random.default_rng(0)
    for row in DRIVEN:
        if not row["name"].startswith(f"{vendor}/"):
            continue
        robot = find_robot(row["name"])
        at = robot.flange_pose(np.array(row["check"]["q_rad"])).position
        np.testing.assert_allclose(1e3 * np.array(at), row["check"]["flange_mm"], atol=0.005)
        q = allowed(robot, rng.uniform(robot.limits.lower, robot.limits.upper))
        while np.any(np.abs(q - np.clip(q, robot.limits.lower, robot.limits.upper)) > 0.0):
            q = allowed(robot, rng.uniform(robot.limits.lower, robot.limits.upper))
        pose = robot.flange_pose(q)
        found = [one.q for one in robot.inverse(pose, arm_angle=robot.arm_angle(q))]
        apart = [np.abs(np.remainder(x - q + np.pi, 2 * np.pi) - np.pi).max() for x in found]
        assert min(apart) < 1e-6, robot.name
        for x in found:
            np.testing.assert_allclose(robot.flange_pose(x).matrix(), pose.matrix(), atol=1e-8)


def test_what_is_assumed_has_a_spread() -> None:
    for row in DRIVEN:
        robot = row["robot"]
        for group in SPREAD:
            assumed = robot["origin"][group].startswith("assumed")
            assert assumed == (group in robot.get("spread", {})), (row["name"], group)
        for origin in robot["origin"].values():
            assert origin.split(":")[0] in TRUST
        assert row["payload_kg"] == robot["payload_kg"]


@given(row=st.sampled_from(ROWS))
def test_each_is_found_by_its_makers_name(row) -> None:
    found = {arm.name for arm in installed().robots_like(row["model"])}
    assert row["name"] in found
    assert row["name"] in {arm.name for arm in installed().robots_like(row["model"].lower())}


@given(name=st.text(max_size=40))
def test_no_name_crashes(name) -> None:
    for arm in installed().robots_like(name):
        assert arm.name.partition("/")[0] in installed().vendors


CALLED = {
    "IRB 120": "abb/irb120-3-058",
    "irb120-3/0.6": "abb/irb120-3-058",
    "abb/IRB 4600-40/2.55": "abb/irb4600-40-255",
    "#KR6R900 C4SR FLR": "kuka/kr6-r900-sixx",
    "KR180R2500EXTRA": "kuka/kr180-r2500-extra",
    "KR5ARC": "kuka/kr5-arc",
    "IRB140-6/0.8": "abb/irb140-6-081",
    "KR 120 R2700-2": "kuka/kr120-r2700-2",
    "#KR210R2700_2 C4 FLR": "kuka/kr210-r2700-2",
    "UR 5e": "ur/ur5e",
    "ur5e": "ur/ur5e",
    "IRB_120_3kg_0.58m": "abb/irb120-3-058",
    "IRB120_3_58_01": "abb/irb120-3-058",
    "irb1200_7_70": "abb/irb1200-7-070",
    "IRB4600_40_255_G_01": "abb/irb4600-40-255",
    "IRB 4600-20/2.50 Type C": "abb/irb4600-20-250",
    "IRB 2400-16/1.55 IRC5": "abb/irb2400-16-155",
    "GoFa 5": "abb/crb15000-5-095",
    "CRB 15000 GoFa 10 OmniCore": "abb/crb15000-10-152",
    "#KR6R900_2 C4SR FLR": "kuka/kr6-r900-2",
    "KR210R2700PRIME": "kuka/kr210-r2700-prime",
    "#KR180R3200PA C4 FLR": "kuka/kr180-r3200-pa",
    "KR CYBERTECH KR 8 R2010": "kuka/kr8-r2010",
    "KR C4 KR 30-3": "kuka/kr30-3",
    "Universal Robots UR 10 e": "ur/ur10e",
    "UR-16e": "ur/ur16e",
    "UR5 CB3": "ur/ur5",
    "IRB 6700-150/3.20 LeanID": "abb/irb6700-150-320-lid",
    "IRB 5710-90/2.30 Lean ID": "abb/irb5710-90-230-lid",
    "yumi left": "abb/irb14000-05-056-left",
    "YuMi right": "abb/irb14000-05-056-right",
    "IRB 14000-0.5/0.5 L": "abb/irb14000-05-056-left",
    "ROB_R_14000_05_05": "abb/irb14000-05-056-right",
    "IRB 14050": "abb/irb14050-05-056",
    "IRB 14050-0.5/0.5 YuMi": "abb/irb14050-05-056",
}


@pytest.mark.parametrize("name", CALLED)
def test_names_that_people_and_controllers_write(name) -> None:
    assert installed().robot_called(name) == CALLED[name]
    assert find_robot(name).name == CALLED[name]


@pytest.mark.parametrize("name", ["YuMi", "IRB 14000-0.5/0.5", "14000"])
def test_which_arm_of_two_has_to_be_said(name) -> None:
    with pytest.raises(InputError, match=r"irb14000-05-056-left .*irb14000-05-056-right"):
        find_robot(name)


@pytest.mark.parametrize("name", ["irb6640-180-254", "IRB 2400-10/1.60", "irb120-3/0.7"])
def test_a_reach_is_rounded_and_not_guessed(name) -> None:
    """Another reach is another arm, or a slip of the pen."""
    with pytest.raises(UnknownNameError, match="near it are"):
        find_robot(name)


@pytest.mark.parametrize(
    "name",
    ["IRB 6700-150/3.20", "IRB 5710-90/2.30", "KR 180-2", "KR 40", "KR 60-4", "KR 210 R2900 prime"],
)
def test_a_variant_is_another_arm_than_the_one_without(name) -> None:
    """The only listed arm whose name begins so is a sister: it is offered, and not taken."""
    (sister,) = installed().robots_like(name)
    with pytest.raises(UnknownNameError, match=f"near it are {sister.name} ") as caught:
        find_robot(name)
    assert "kg" in str(caught.value)


@given(name=st.text(max_size=30))
def test_near_names_are_offered_and_never_taken(name) -> None:
    near = installed().robots_near(name)
    assert len(near) == len({arm.name for arm in near}) <= 6
    if not installed().robots_like(name):
        with pytest.raises(UnknownNameError):
            installed().robot_called(name)


@pytest.mark.parametrize("row", DRIVEN[::3], ids=lambda row: row["name"])
def test_a_slip_of_the_pen_is_offered_the_arm(row) -> None:
    model = row["model"]
    slip = model[:-1] + ("7" if model[-1] != "7" else "8")
    if not installed().robots_like(slip):
        assert row["name"] in {arm.name for arm in installed().robots_near(slip)}


def test_where_several_may_be_meant_they_are_offered() -> None:
    with pytest.raises(InputError, match=r"which\? .*kr210-2 \(210 kg, 2\.701 m\)"):
        find_robot("KR 210")


def test_an_arm_that_is_not_modelled_says_why() -> None:
    with pytest.raises(InputError, match=r"IRB 580-12s cannot be driven: .*"):
        find_robot("IRB 580-12s")
