"""Lines that turn the tool by half a turn: the programmed configuration decides which way round."""

from __future__ import annotations

import math

import numpy as np
import pytest

from flyby.core.driving.driven_program import DrivenProgram
from flyby.core.driving.past_faults import drive
from flyby.core.errors import MotionError
from flyby.core.motion.emulator.controller import Controller
from flyby.core.registry import find_robot, find_vendor

ROBOT = "abb/irb2600-20-165"
HERE = "[[650,-330,650],[0,0,1,0],[-1,0,-1,0],[9E9,9E9,9E9,9E9,9E9,9E9]]"


def driven(configuration: str, more: float = 0.0) -> DrivenProgram:
    """A move to a place, and a line that turns the tool about its own axis by half a turn, and by
    so many rad more."""
    half = 0.5 * (math.pi + more)
    there = [0.0, math.sin(half), math.cos(half), 0.0]
    text = (
        f"MODULE m\nPROC main()\nMoveJ {HERE},v500,fine,tool0;\n"
        f"MoveL [[700,100,600],[{','.join(f'{v:.12f}' for v in there)}],{configuration},"
        "[9E9,9E9,9E9,9E9,9E9,9E9]],v500,fine,tool0;\nENDPROC\nENDMODULE\n"
    )
    vendor, robot = find_vendor("abb"), find_robot(ROBOT)
    return drive(Controller(vendor, robot), vendor.read(text, "m.mod", robot=robot))


@pytest.mark.parametrize(("configuration", "way"), [("[0,0,2,0]", -1), ("[0,0,-2,0]", 1)])
def test_the_programmed_configuration_decides_the_way_round(configuration, way) -> None:
    made, near = driven(configuration), driven(configuration, 0.01 * way)
    assert not made.faults
    assert made.trajectory.q[-1] == pytest.approx(near.trajectory.q[-1], abs=0.02)
    assert any("turns the tool by half a turn" in note.message for note in made.notes)
    assert not any("half a turn" in note.message for note in near.notes)
    # The wrong way round is refused where there is no doubt which way it is.
    with pytest.raises(MotionError, match="contradicts the path"):
        driven(configuration, -0.01 * way)


def test_the_target_itself_is_kept() -> None:
    made = driven("[0,0,-2,0]")
    (part,) = made.parts
    ends = part.run.path.route.ends.rotation[-1]
    turned = ends[0].T @ ends[1]
    assert np.trace(turned) == pytest.approx(-1.0, abs=1e-9)


def test_neither_way_round_is_taken_for_another_configuration() -> None:
    with pytest.raises(MotionError, match=r"arrives with \[0,0,-?2,0\]"):
        driven("[1,0,0,0]")
