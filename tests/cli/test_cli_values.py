"""Numbers as users type them."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from flyby.cli.kinematics import _turns
from flyby.core.errors import InputError
from flyby.core.registry import find_robot
from flyby.tasks.options.texts import configuration, numbers, pose

finite = st.floats(-1e6, 1e6)
turns = st.floats(-180, 180)


@settings(deadline=None)
@given(st.lists(finite), st.sampled_from([",", " ", ", ", "  "]))
def test_numbers_are_read_as_written(values: list[float], separator: str) -> None:
    assert list(numbers(separator.join(map(repr, values)), "values")) == values


@settings(deadline=None)
@given(st.tuples(finite, finite, finite), st.tuples(turns, st.floats(-89, 89), turns))
def test_turns_come_back(position: tuple[float, ...], angles: tuple[float, ...]) -> None:
    text = ",".join(map(repr, (*position, *angles)))
    found = pose(text, "pose")
    assert found.position == pytest.approx(np.array(position) / 1e3)
    back = np.array(_turns(found)) - angles
    assert (back + 180) % 360 - 180 == pytest.approx(np.zeros(3), abs=1e-6)


def test_turns_are_about_fixed_axes() -> None:
    # A quarter turn about x and then one about the fixed z take y to z and x to y.
    matrix = pose("0,0,0,90,0,90", "pose").matrix()[:3, :3]
    assert matrix @ [0, 1, 0] == pytest.approx(np.array([0, 0, 1]))
    assert matrix @ [1, 0, 0] == pytest.approx(np.array([0, 1, 0]))


@settings(deadline=None)
@given(st.tuples(finite, finite, finite, finite))
def test_quaternions_are_normalised_or_refused(values: tuple[float, ...]) -> None:
    norm = float(np.linalg.norm(values))
    text = "1,2,3," + ",".join(map(repr, values))
    if abs(norm - 1) > 0.01:
        with pytest.raises(InputError, match="length 1"):
            pose(text, "pose")
    else:
        assert np.linalg.norm(pose(text, "pose").quaternion) == pytest.approx(1)


def test_a_configuration_is_in_degrees() -> None:
    q = configuration("180,0,0,0,90,0", "joints", find_robot("ur/ur5e"))
    assert q == pytest.approx([np.pi, 0, 0, 0, np.pi / 2, 0])


@pytest.mark.parametrize("text", ["1,2,x", "inf", "1,,nan", "1;2"])
def test_what_is_no_number_is_named(text: str) -> None:
    with pytest.raises(InputError, match="--start"):
        numbers(text, "--start")
