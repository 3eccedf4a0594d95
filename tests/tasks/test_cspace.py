"""The configuration space of two joints."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from typer.testing import CliRunner

import flyby
from flyby.cli.main import app
from flyby.core.collision.joint_plane import joint_plane
from flyby.core.collision.scene.scene import CollisionScene
from flyby.core.errors import FlybyError, InputError, OptionError

ROOT = Path(__file__).parents[2]
CELL = ROOT / "examples" / "cell" / "two_joints.toml"
PROGRAM = flyby.read(ROOT / "examples" / "cell" / "two_joints.mod", cell=CELL)
SCENE = CollisionScene(flyby.cell(CELL), PROGRAM.moves[0].tool)


@settings(max_examples=15, deadline=None)
@given(
    st.tuples(*[st.floats(-0.6, 0.6)] * 6),
    st.lists(st.integers(0, 5), min_size=2, max_size=2, unique=True),
)
def test_each_point_of_the_plane_is_the_arm_in_that_posture(
    held: tuple[float, ...], axes: list[int]
) -> None:
    window = np.array([[-0.5, 1.2], [-0.8, 0.9]])
    first, second = axes
    plane = joint_plane(SCENE, np.array(held), (first, second), window, 7, 0.005)
    for i, b in enumerate(plane.second):
        for j, a in enumerate(plane.first):
            q = np.array(held)
            q[first], q[second] = a, b
            # Within rounding of touching either answer will do.
            if abs(plane.distance[i, j]) > 1e-6:
                assert bool(SCENE.collides(q)) == (plane.distance[i, j] < 0.0)
    assert 0.0 <= plane.free <= 1.0


def test_the_path_of_a_proven_program_lies_in_the_free_region() -> None:
    found = flyby.cspace(PROGRAM, axes="2,3", steps=81)
    assert found.names == ("J2", "J3") and not found.notes
    plane = found.plane
    assert plane.distance.min() < 0.0 < plane.distance.max()
    for q in found.run.path.q:
        j, i = (int(np.abs(v - x).argmin()) for v, x in ((plane.first, q[1]), (plane.second, q[2])))
        assert plane.distance[i, j] > 0.0
    assert found.picture("svg") == found.picture("svg")


def test_others_are_held_where_it_is_said() -> None:
    by_move = flyby.cspace(PROGRAM, axes=[2, 3], move="p2", steps=11)
    assert by_move.plane.held[1] == pytest.approx(np.radians(-4.739422), abs=1e-6)
    turned = flyby.cspace(PROGRAM, axes="2,3", held="40,0,0,0,0,0", steps=11, whole=True)
    assert "J1 by up to 40°" in "".join(turned.notes) and "J1 40°" in turned.held
    limits = PROGRAM.setup.robot.limits  # type: ignore[union-attr]
    assert turned.plane.first[[0, -1]] == pytest.approx([limits.lower[1], limits.upper[1]])


@pytest.mark.parametrize(
    ("options", "kind", "message"),
    [
        ({"axes": "2"}, OptionError, "two different joints"),
        ({"axes": "2,2"}, OptionError, "two different joints"),
        ({"axes": "2,9"}, InputError, "numbers of joints"),
        ({"axes": "2,3", "move": 1}, InputError, "not driven"),
        ({"axes": "2,3", "move": "p2", "held": "0,0,0,0,0,0"}, OptionError, "both say"),
        ({"axes": "2,3", "steps": 3}, OptionError, "from 11 to 1001"),
    ],
)
def test_what_makes_no_plane_is_refused(
    options: dict[str, object], kind: type[FlybyError], message: str
) -> None:
    with pytest.raises(kind, match=message):
        flyby.cspace(PROGRAM, **options)


def test_the_command_writes_the_picture(tmp_path: Path) -> None:
    plot = tmp_path / "plane.png"
    program = ROOT / "examples" / "cell" / "two_joints.mod"
    words = ["cspace", str(program), "--cell", str(CELL), "--axes", "2,3", "--steps", "21"]
    made = CliRunner().invoke(app, [*words, "--plot", str(plot)])
    assert made.exit_code == 0, made.output
    assert "nothing touches in" in made.stdout and plot.read_bytes()[:4] == b"\x89PNG"
    assert CliRunner().invoke(app, [*words, "--plot", str(plot)]).exit_code == 1  # is not replaced
