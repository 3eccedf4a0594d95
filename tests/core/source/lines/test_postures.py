"""Labels by letters: what is in front is stated, wherever an arm's own zero lies."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from flyby.core.errors import InputError
from flyby.core.robot.catalogue import load_robot
from flyby.core.robot.model import Robot
from flyby.core.source.lines.postures import PostureLabel, PostureLetters

ARM = Path(__file__).parents[4] / "testing" / "skeleton" / "arm-1.toml.txt"
LETTERS = PostureLetters("NF", "UD", "TB", turning=(3,))


def arm(folder: Path, **changes: str) -> Robot:
    """The template's arm: at zero its upper arm is upright, its forearm stretched to the front."""
    text = ARM.read_text("utf-8").replace("@name@", "acme")
    for old, new in changes.values():
        assert old in text
        text = text.replace(old, new)
    (folder / "arm-1.toml").write_text(text, "utf-8")
    return load_robot(folder / "arm-1.toml")


@pytest.fixture(scope="module")
def arms(tmp_path_factory: pytest.TempPathFactory) -> tuple[Robot, Robot]:
    """The same arm, whose joint 3 is at zero where it is stretched to the front, and where it
    points back."""
    back = ("xyz_mm = [0, 0, 400]\n", "xyz_mm = [0, 0, 400]\nrpy_deg = [0, -170, 0]\n")
    wide = ("lower_deg = -180\nupper_deg = 70", "lower_deg = -10\nupper_deg = 240")
    make = tmp_path_factory.mktemp
    return arm(make("front")), arm(make("back"), place=back, ranges=wide)


@given(q=st.lists(st.floats(-1.2, 1.2), min_size=6, max_size=6))
def test_the_letters_do_not_depend_on_where_zero_is(
    arms: tuple[Robot, Robot], q: list[float]
) -> None:
    front, back = arms
    there = np.array(q)
    other = there + np.radians([0, 0, 170, 0, 0, 0])
    assert np.allclose(front.flange_pose(there).position, back.flange_pose(other).position)
    assert str(LETTERS.label(front, there)) == str(LETTERS.label(back, other))


def test_front_is_where_the_arm_says(arms: tuple[Robot, Robot]) -> None:
    bent = np.array([0.0, 0.3, -0.5, 0.0, 0.7, 0.0])
    assert LETTERS.label(arms[0], bent) == PostureLabel("FUT", (0,))
    behind = PostureLetters("NF", "UD", "TB", (3,), front=(-1, 0, 0))
    assert LETTERS.label(arms[0], bent) != behind.label(arms[0], bent)
    across = PostureLetters("NF", "UD", "TB", (3,), front=(0, 1, 0))
    with pytest.raises(InputError, match="acme/arm-1: with joint 1 at zero axis 2 swings the arm"):
        across.label(arms[0], bent)


@given(
    label=st.builds(PostureLabel, st.sampled_from(["NUT", "FDB"]), st.tuples(st.integers(-1, 1)))
)
def test_what_is_written_is_read(label: PostureLabel) -> None:
    assert LETTERS.read(LETTERS.written(label)) == label
    with pytest.raises(InputError, match="a letter each of NF, UD, TB"):
        LETTERS.read("N U, 0")
