"""The example modules: an arm can drive them, mostly an IRB 6640; they survive being written."""

from pathlib import Path

import numpy as np
import pytest

from flyby.core.arrays import FloatArray
from flyby.core.program.move import Move, MoveC, MoveJ, Opaque
from flyby.core.program.program import Program
from flyby.core.program.target import JointTarget, PoseTarget
from flyby.core.program.zone import Radius
from flyby.core.registry import find_vendor
from flyby.core.robot.model import Robot
from flyby.vendors.abb.motion.configuration import label
from flyby.vendors.abb.run.reader import read, read_file
from flyby.vendors.abb.write.options import RapidOptions, ZoneStyle
from flyby.vendors.abb.write.writer import write

EXAMPLES = Path(__file__).parents[3] / "examples"
MODULES = sorted(EXAMPLES.glob("*.mod"))
ROBOT = find_vendor("abb").robot("irb6640-180-255")
SMALLER = {"Tray": find_vendor("abb").robot("irb120-3-058")}


def robot_of(program: Program) -> Robot:
    """That drives it."""
    return SMALLER.get(program.name, ROBOT)


def drive(program: Program) -> list[tuple[Move, FloatArray]]:
    """Each move with the joint values (6,) of its target; the configuration must be met."""
    robot = robot_of(program)
    at = np.zeros(6)
    driven = []
    for move in program.moves:
        at = joints(move, at, robot)
        driven.append((move, at))
    return driven


def joints(move: Move, before: FloatArray, robot: Robot) -> FloatArray:
    if isinstance(move.target, JointTarget):
        return np.array(move.target.joints)
    flange = move.work_object.pose @ move.target.pose @ move.tool.tcp.inverse()
    turns = [turn for found in robot.inverse(flange) for turn in robot.turns(found.q)]
    assert move.target.configuration is not None
    fitting = [
        turn
        for turn in turns
        if move.target.configuration.mismatch(label(robot, turn)) == 0  # type: ignore[arg-type]
    ]
    assert fitting, f"{move.target} fits none of {[label(robot, turn) for turn in turns]}"
    return min(fitting, key=lambda turn: float(np.abs(turn - before).max()))


def tcp(move: Move, q: FloatArray) -> FloatArray:
    return np.array((ROBOT.flange_pose(q) @ move.tool.tcp).position)


@pytest.fixture(scope="module", params=MODULES, ids=lambda path: path.name)
def example(request: pytest.FixtureRequest) -> Program:
    return read_file(request.param)


def test_there_are_examples() -> None:
    assert {path.name for path in MODULES} >= {"square.mod", "deburring.mod"}


def test_every_target_is_reached_in_its_configuration_away_from_limits(example: Program) -> None:
    limits = robot_of(example).limits
    driven = drive(example)
    for number, (move, q) in enumerate(driven, 1):
        margin = np.degrees(np.minimum(q - limits.lower, limits.upper - q)).min()
        assert margin > 10, f"move {number}: {margin:.1f} degrees from a limit"
        assert abs(np.degrees(q[4])) > 25, f"move {number}: near the wrist singularity"
        if not isinstance(move, MoveJ):
            turn = np.degrees(np.abs(q - driven[number - 2][1])).max()
            assert turn < 45, f"move {number}: an axis turns by {turn:.0f} degrees"


def test_one_zone_of_the_deburring_example_is_too_large() -> None:
    driven = drive(read_file(EXAMPLES / "deburring.mod"))
    points = [tcp(move, q) for move, q in driven]
    large = []
    for k in range(1, len(driven) - 1):
        zone = driven[k][0].zone
        room = min(np.linalg.norm(points[k] - points[k + d]) for d in (-1, 1)) / 2
        if isinstance(zone, Radius) and max(zone.tcp, zone.reorientation, zone.external) > room:
            large.append(zone.name)
    assert large == ["z200"]


def test_the_deburring_example_is_as_untidy_as_real_programs() -> None:
    data = (EXAMPLES / "deburring.mod").read_bytes()
    assert data.startswith(b"%%%\r\n") and not data.endswith(b"\n")
    assert data.count(b"\n") == data.count(b"\r\n")
    with pytest.raises(UnicodeDecodeError):
        data.decode()
    assert "Größe" in data.decode("cp1252")
    program = read_file(EXAMPLES / "deburring.mod")
    assert any(isinstance(move, MoveC) for move in program.moves)
    assert any(isinstance(move.target, JointTarget) for move in program.moves)
    assert any(isinstance(statement, Opaque) for statement in program.statements)
    assert {move.load.mass for move in program.moves if move.load} == {8.4}
    names = {m.target.name for m in program.moves if isinstance(m.target, PoseTarget)}
    assert {None, "pPick", "pC10"} <= names


@pytest.mark.parametrize("zones", ZoneStyle)
def test_examples_survive_being_written(example: Program, zones: ZoneStyle) -> None:
    options = RapidOptions(zones=zones)
    text = write(example, options)
    back = read(text, "written.mod")
    assert write(back, options) == text
    assert len(back.moves) == len(example.moves)
    for (move, q), (again, r) in zip(drive(example), drive(back), strict=True):
        assert type(move) is type(again)
        assert np.abs(q - r).max() < 1e-5
