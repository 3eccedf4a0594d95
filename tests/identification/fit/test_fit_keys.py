"""Figures by the keys of the motion file, and parameters on top of a model."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from flyby.core.errors import InputError
from flyby.core.motion.model.elasticity import Carried, Elasticity
from flyby.core.motion.model.motion_model import MotionModel
from flyby.core.registry import find_robot, find_vendor, vendors
from flyby.identification.fit.keys import figure_of, value_of, with_value
from flyby.identification.fit.parameters import ParameterSet, parameter, usual_parameters

from .known_truth import START

KEYS = {
    "period_s": ("period_s", 0.004),
    "blend.tcp.beta[0]": ("blend.tcp.beta", 0.0),
    "time.smoothing_s[1]": ("time.smoothing_s", 0.03),
    "time.settling_s": ("time.settling_s", 0.05),
    "limit.joint_acceleration_scale[3:]": ("limit.joint_acceleration_scale", 1.0),
    "elasticity.own_s2[1]": ("elasticity.own_s2", 5e-5),
    "elasticity.carried[0].lead_s2_per_m2[1]": ("elasticity.carried", 2e-5),
}


@pytest.mark.parametrize("key", KEYS)
def test_a_key_reads_and_writes_one_figure(key: str) -> None:
    figure, value = KEYS[key]
    assert value_of(START, key) == value
    assert figure_of(key).key == figure
    made = with_value(START, key, 0.5)
    assert value_of(made, key) == 0.5
    others = [other for other in KEYS if other != key]
    assert [value_of(made, other) for other in others] == [KEYS[k][1] for k in others]


def test_names_that_begin_alike_are_told_apart() -> None:
    model = with_value(replace(START, in_position=6e-3), "time.in_position_time_s", 0.15)
    assert (model.in_position, model.in_position_time) == (6e-3, 0.15)
    for key in ("time.in_position_rad", "time.in_position_time_s"):
        assert figure_of(key).key == key
    assert value_of(with_value(model, "time.in_position_rad", 1e-3), "time.in_position_rad") == 1e-3


@given(value=st.floats(0.01, 10), at=st.integers(0, 5))
def test_a_range_is_one_figure_for_its_entries(value: float, at: int) -> None:
    made = with_value(START, f"limit.joint_acceleration_scale[{at}:]", value)
    assert made.joint_acceleration_scale == (1.0,) * at + (value,) * (6 - at)
    assert with_value(START, "limit.joint_acceleration_scale[*]", value) == with_value(
        START, "limit.joint_acceleration_scale[0:6]", value
    )


def test_a_list_grows_by_what_stands_for_nothing() -> None:
    made = with_value(MotionModel(), "blend.tcp.beta[0]", -0.5)
    assert made.tcp.beta == (-0.5,)
    assert with_value(MotionModel(), "blend.tcp.beta[1]", -0.5).tcp.beta == (0.0, -0.5)
    scaled = with_value(MotionModel(), "limit.joint_acceleration_scale[2]", 1.5)
    assert scaled.joint_acceleration_scale == (1.0, 1.0, 1.5)
    with pytest.raises(InputError, match="0 entries"):
        with_value(MotionModel(), "blend.tcp.beta[*]", -0.5)


@pytest.mark.parametrize(
    ("key", "message"),
    [
        ("time.smoothing", "unknown key of a motion model 'time.smoothing': did you mean"),
        ("time.smoothing_s", "no number, or not a single one"),
        ("time.soothing_s", "did you mean 'time.smoothing_s'"),
        ("elasticity.owned", "did you mean .*'elasticity.own_s2'"),
        ("elasticity.carried", "no number, or not a single one"),
        ("elasticity.carried[0]", "no number, or not a single one"),
        ("elasticity.carried[0].joint", "no number"),
        ("elasticity.carried[0].lead", "there are joint, lead_s2_per_m2"),
        ("elasticity.carried.lead_s2_per_m2[0]", "name one, such as"),
        ("elasticity.own_s2[x]", "an index is"),
        ("zone.overlap", "no number"),
        ("zone.stops_at_pure_reorientation", "no number"),
        ("period_s[0]", "no list"),
        ("period_s.x", "nothing is called 'x'"),
        ("time.smoothing_s[0][0]", "no list"),
        ("blend..beta", "no key of a motion model"),
        ("", "no key of a motion model"),
        ("blend", "unknown key of a motion model 'blend'"),
    ],
)
def test_what_is_no_number_is_refused(key: str, message: str) -> None:
    with pytest.raises(InputError, match=message):
        with_value(START, key, 1.0)


def test_a_value_that_the_model_refuses_is_refused() -> None:
    with pytest.raises(InputError, match="settling_s"):
        parameter(START, "time.settling_s = -1")


def test_texts_name_parameters() -> None:
    one = parameter(START, "blend.tcp.beta[0] + blend.joint.beta[0] = -0.25")
    assert one.keys == ("blend.tcp.beta[0]", "blend.joint.beta[0]") and one.start == -0.25
    assert one.lower < -0.25 < one.upper and one.scale > 0
    assert parameter(START, "time.settling_s").start == 0.05
    one = parameter(START, "elasticity.own_s2[0] = 1e-4 in 0 .. 2e-3")
    assert (one.start, one.lower, one.upper) == (1e-4, 0.0, 2e-3)
    one = parameter(START, "elasticity.own_s2[0] in -1 .. 1")
    assert (one.start, one.lower, one.upper) == (5e-5, -1.0, 1.0)
    with pytest.raises(InputError, match="lies outside"):
        parameter(START, "time.settling_s = 0.1 in 0.2 .. 0.3")
    with pytest.raises(InputError, match="names no parameter"):
        parameter(START, "= 3")
    with pytest.raises(InputError, match="name a start"):
        parameter(MotionModel(), "time.settling_s")
    with pytest.raises(InputError, match="'x' is no number"):
        parameter(START, "time.settling_s = x")
    with pytest.raises(InputError, match="fitted twice"):
        ParameterSet.named(START, ["time.settling_s", "time.settling_s"])


@given(values=st.lists(st.floats(0.01, 0.2), min_size=3, max_size=3))
def test_a_set_is_a_model(values: list[float]) -> None:
    texts = ["time.smoothing_s[0]", "time.smoothing_s[1]", "elasticity.own_s2[0] + time.ramp_s"]
    made = ParameterSet.named(START, texts).model(values)
    assert made.smoothing == tuple(values[:2])
    assert made.elasticity.own[0] == made.ramp == values[2]
    assert replace(made, smoothing=START.smoothing, elasticity=START.elasticity, ramp=0.0) == (
        START
    )


def test_what_is_held_stays_at_its_start_and_what_is_left_out_at_the_base() -> None:
    named = ParameterSet.named(START, ["time.settling_s = 0.09", "blend.tcp.beta[0] = -0.5"])
    assert named.without(["time.settling_s"]).model([-1.0]).settling == 0.05
    np.testing.assert_array_equal(named.starting_at(np.array([0.1, 0.2])).start, [0.1, 0.2])


def test_a_joint_in_a_list_of_masses_is_no_parameter() -> None:
    model = replace(START, elasticity=Elasticity((), (Carried(3, (1e-4, 1e-4)),)))
    with pytest.raises(InputError):
        with_value(model, "elasticity.carried[0].lead_s2_per_m2[5]", 1.0)


@pytest.mark.parametrize("key", ["period_s", "elasticity.carried[0].joint", "zone.overlap"])
def test_what_is_not_fitted_is_refused(key: str) -> None:
    with pytest.raises(InputError, match="is not fitted"):
        parameter(START, f"{key} = 1")


ROBOTS = ("abb/irb6640-180-255", "abb/irb1200-5-090", "kuka/kr3-r540", "ur/ur10e")


@pytest.mark.parametrize("robot", ROBOTS)
def test_usual_parameters_can_be_fitted(robot: str) -> None:
    """To any robot, and to those that figures were fitted for, the same ones again."""
    arm = find_robot(robot)
    model = find_vendor(robot.partition("/")[0]).motion_of(arm)
    named = ParameterSet.named(model, usual_parameters(model, arm))
    assert named.size > 0
    assert np.isfinite(named.start).all()


def test_usual_parameters_are_tried_on_every_vendor() -> None:
    assert {robot.partition("/")[0] for robot in ROBOTS} == {vendor.name for vendor in vendors()}
