"""What holds of every translation: poses, corners cut alike, joint moves in the same time."""

from __future__ import annotations

import numpy as np
from hypothesis import HealthCheck, assume, given, settings
from hypothesis import strategies as st

from flyby.core.errors import MotionError
from flyby.core.program.move import MoveJ
from flyby.core.program.target import PoseTarget
from flyby.core.registry import find_vendor
from flyby.core.spatial.rotation import rotation_vector

SAME = 1e-6
"""m and rad within which a pose is kept."""
CUT = 0.05
"""Share by which the distance between waypoint and path may differ."""
EXAMPLES = settings(
    max_examples=6, suppress_health_check=[HealthCheck.function_scoped_fixture], deadline=None
)


def apart(first, second) -> float:
    step = (first.inverse() @ second).matrix()
    return float(np.abs([*step[:3, 3], *rotation_vector(step[:3, :3])]).max())


@EXAMPLES
@given(data=st.data())
def test_a_translation_keeps_poses_corners_and_times(pair, data) -> None:
    program = data.draw(pair.programs())
    try:
        old = pair.run_old(program)
        made = pair.translate(program)
    except MotionError:
        assume(False)
    new = pair.run_new(made)
    _check_poses(program, made.program)
    told = {note.move for note in made.losses}
    _check_corners(pair.corners(old), pair.corners(new), told)
    _check_times(program, old, new, told)
    sources = find_vendor(pair.new.split("/")[0]).write(made.program, pair.robot(pair.new))
    assert all(text.isascii() and text.count("\n") > 3 for text in sources.values())


@EXAMPLES
@given(data=st.data())
def test_a_program_comes_back_as_it_was(between, data) -> None:
    pair = between("abb", "kuka")
    program = data.draw(pair.programs())
    try:
        old = pair.run_old(program)
        made = pair.translate(program)
        back = pair.back.translate(made.program)
    except MotionError:
        assume(False)
    _check_poses(program, back.program)
    told = {note.move for note in (*made.losses, *back.losses)}
    again = pair.run_old(back.program, back.start)
    _check_corners(pair.corners(old), pair.corners(again), told)


def _check_poses(program, made) -> None:
    assert len(made.moves) == len(program.moves)
    for old, new in zip(program.moves, made.moves, strict=True):
        assert type(old) is type(new)
        assert isinstance(new.target, PoseTarget)
        assert apart(old.target.pose, new.target.pose) < SAME


def _check_corners(before, after, told) -> None:
    for move, corner in before.items():
        if move not in told:
            assert corner.passed == after[move].passed
            assert abs(after[move].cut - corner.cut) <= max(5e-5, CUT * corner.cut)


def _check_times(program, old, new, told) -> None:
    now = dict(zip(new.path.route.moves, new.timing.settled_durations(), strict=True))
    for move, seconds in zip(old.path.route.moves, old.timing.settled_durations(), strict=True):
        if isinstance(program.moves[move], MoveJ) and move not in told:
            assert abs(now[move] - seconds) < max(0.03, 0.08 * seconds)
