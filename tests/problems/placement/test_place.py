"""Bases whose answers are known."""

from __future__ import annotations

import math
from pathlib import Path

import numpy as np
import pytest
from typer.testing import CliRunner

import flyby
from flyby.cli.main import app
from flyby.core.errors import FlybyError
from flyby.core.spatial.pose import Pose
from flyby.problems.placement.reach import Stops

UNUSED = "[9E9,9E9,9E9,9E9,9E9,9E9]"


def write(
    folder: Path, places: list[tuple[float, float, float]], rest: str = ""
) -> tuple[Path, ...]:
    """A program of an IRB 120 that goes to places in the world with the flange down."""
    moves = [
        f"MoveJ [[{x},{y},{z}],[0,0,1,0],[0,0,0,0],{UNUSED}], v500, fine, tool0"
        for x, y, z in places
    ]
    body = ";\n    ".join(["ConfJ \\Off", "ConfL \\Off", *moves])
    program, cell = folder / "p.mod", folder / "cell.toml"
    program.write_text(f"MODULE p\n  PROC main()\n    {body};\n  ENDPROC\nENDMODULE\n")
    cell.write_text(f'robot = "abb/irb120-3-058"\nclearance_mm = 5\n{rest}')
    return program, cell


ROUND = [(800 + 120 * math.cos(a), 120 * math.sin(a), 300.0) for a in np.arange(0, 6.3, 0.7)]


def test_what_is_out_of_reach_is_reached_from_the_base_found(tmp_path: Path) -> None:
    program, cell = write(tmp_path, ROUND)
    with pytest.raises(FlybyError):
        flyby.emulate(flyby.read(program, cell=cell), strict=True)
    made = flyby.place(flyby.read(program, cell=cell), room=(0.6, 0.3, 0.0, 0.0))
    assert made.found.before is None and made.proven and made.base is not None
    assert made.base.position[0] > 0.2
    placed = tmp_path / "placed.toml"
    placed.write_text(cell.read_text() + made.line + "\n")
    again = flyby.emulate(flyby.read(program, cell=placed), strict=True)
    assert again.duration == pytest.approx(made.found.best.run.duration, abs=1e-4)


def test_the_base_keeps_out_of_what_stands_around(tmp_path: Path) -> None:
    free = flyby.place(flyby.read(*write(tmp_path, ROUND)[:1], cell=tmp_path / "cell.toml"))
    x, y, _ = free.base.position
    post = (
        f'[[obstacle]]\nname = "post"\nbox_mm = [120, 120, 150]\n'
        f"pose = {{ xyz_mm = [{1e3 * x}, {1e3 * y}, 75] }}\n"
    )
    program, cell = write(tmp_path, ROUND, post)
    made = flyby.place(flyby.read(program, cell=cell))
    assert made.base is not None
    assert np.hypot(made.base.position[0] - x, made.base.position[1] - y) > 0.08
    assert made.found.best.run.duration >= free.found.best.run.duration - 1e-6


def test_never_slower_than_where_it_is(tmp_path: Path) -> None:
    near = [(x - 440, y, z) for x, y, z in ROUND]
    program, cell = write(tmp_path, near)
    made = flyby.place(flyby.read(program, cell=cell), room="100,100,0,20")
    assert made.found.before is not None and made.found.best is not None
    assert made.found.best.run.duration <= made.found.before.run.duration
    as_it_is, best = made.rows()[:2]
    share = 100 * made.found.best.energy / made.found.before.energy
    assert as_it_is[-2] == "100.0" and best[-2] == f"{share:.1f}"
    driven = made.found.before.run.trajectory
    torque = flyby.robot("abb/irb120-3-058").inverse_dynamics(driven.q, driven.dq, driven.ddq)
    whole = np.trapezoid((torque**2).sum(axis=1), driven.t)
    assert made.found.before.energy == pytest.approx(whole, rel=0.05)


def test_estimates_tell_reach(tmp_path: Path) -> None:
    program, cell = write(tmp_path, ROUND[:3])
    read = flyby.read(program, cell=cell)
    robot = flyby.robot("abb/irb120-3-058")
    stops = Stops.of(robot, read, None)
    assert len(stops.ends) == 3 and not stops.anywhere
    assert math.isinf(stops.route(robot)[0])
    seconds, q = stops.route(robot.with_base(Pose((0.4, 0.0, 0.0))))
    assert math.isfinite(seconds)
    for end, row in zip(stops.ends, q, strict=True):
        near = robot.with_base(Pose((0.4, 0.0, 0.0))).flange_pose(row)
        assert np.allclose(near.matrix(), end.matrix(), atol=1e-6)


@pytest.mark.parametrize("room", ["-1,0", "1", "1,2,3,4,5", "20000,0", (0.1,)])
def test_ranges_that_are_none_are_refused(tmp_path: Path, room: str) -> None:
    program, cell = write(tmp_path, ROUND)
    with pytest.raises(FlybyError, match="room"):
        flyby.place(flyby.read(program, cell=cell), room=room)


def test_targets_by_joint_values_alone_have_no_base(tmp_path: Path) -> None:
    program, cell = write(tmp_path, [])
    text = program.read_text()
    moves = [f"MoveAbsJ [[{q},0,0,0,30,0],{UNUSED}], v500, fine, tool0;" for q in (0, 20)]
    program.write_text(text.replace("ConfL \\Off;", "ConfL \\Off;\n" + "\n".join(moves)))
    with pytest.raises(FlybyError, match="any base will do"):
        flyby.place(flyby.read(program, cell=cell))


def test_the_command_says_the_line_of_the_cell_file(tmp_path: Path) -> None:
    program, cell = write(tmp_path, ROUND)
    words = ["place", str(program), "--cell", str(cell), "--room", "600,300"]
    made = CliRunner().invoke(app, words)
    assert made.exit_code == 0 and "base = { xyz_mm = [" in made.stdout
    made = CliRunner().invoke(app, [*words[:-1], "10,10"])
    assert made.exit_code == 1 and "no base is proven" in made.stdout


def test_configurations_that_a_base_contradicts_are_said(tmp_path: Path) -> None:
    """The program as it stands would stop there: neither time is one that it drives."""
    program, cell = write(tmp_path, [(x - 440, y, z) for x, y, z in ROUND])
    kept = flyby.place(flyby.read(program, cell=cell), room=(0.0, 0.0, 0.0, 0.0))
    assert not kept.notes
    text = program.read_text().replace("ConfJ \\Off;", "").replace("ConfL \\Off;", "")
    program.write_text(text.replace("[0,0,0,0],", "[0,-2,0,1],", 1))
    made = flyby.place(flyby.read(program, cell=cell), room=(0.0, 0.0, 0.0, 0.0))
    assert made.proven
    before, best = (note.message for note in made.notes)
    assert before.startswith("as it is: ") and best.startswith("the best: ")
    assert "[0,-2,0,1] contradicts the pose" in best


def test_the_line_says_the_base_that_is_proven(tmp_path: Path) -> None:
    program, _ = write(tmp_path, [(x - 440, y, z) for x, y, z in ROUND])
    cell = tmp_path / "cell.toml"
    cell.write_text(cell.read_text() + "base = { xyz_mm = [0, 0, 12.3456789] }\n")
    made = flyby.place(flyby.read(program, cell=cell), room=(1 / 3, 0.0, 0.0, 0.0))
    assert made.base is not None
    placed = tmp_path / "placed.toml"
    text = cell.read_text()
    placed.write_text(text[: text.index("base")] + made.line + "\n")
    base = flyby.read(program, cell=placed).setup.robot.base
    assert np.allclose(base.position, made.base.position, atol=1e-8)
