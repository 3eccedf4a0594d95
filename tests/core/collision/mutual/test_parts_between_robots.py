"""Parts that one robot carries, or has put down, beside another robot."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from flyby.core.cell.cell import Cell, Obstacle
from flyby.core.cell.floor import bare_cell
from flyby.core.cell.geometry import Geometry
from flyby.core.cell.workpiece import Workpiece
from flyby.core.collision.mutual.meetings import Meetings
from flyby.core.collision.mutual.pair_proof import PairProver
from flyby.core.collision.mutual.robot_motion import RobotMotion
from flyby.core.errors import InputError
from flyby.core.handling.handling import handling_of
from flyby.core.motion.emulator.controller import Controller
from flyby.core.program.move import Move, MoveJ, MoveL, Opaque
from flyby.core.program.program import Program
from flyby.core.program.speed import Speed
from flyby.core.program.target import JointTarget, PoseTarget
from flyby.core.program.tool import FLANGE, Tool
from flyby.core.registry import find_robot, find_vendor
from flyby.core.robot.shape import Box
from flyby.core.spatial.pose import Pose
from flyby.validation.scenes.handling import random_handling

CLEARANCE = 0.02
RATE = 0.01
"""s between samples."""
TURNED = (0.0, 0.0, 0.0, 1.0)
UR = find_robot("ur/ur10e")
GRIP = Tool("grip", Pose((0.0, 0.0, 0.1)))
HOME = (0.0, -1.5, 1.9, -2.0, -1.57, 0.0)
CRATE = Box((0.2, 0.2, 0.3))


def turned(scene_cell: Cell, program: Program, by: Pose) -> tuple[Cell, Program]:
    """All of a cell and its program elsewhere."""

    def there(geometry: Geometry) -> Geometry:
        return replace(geometry, placement=by @ geometry.placement)

    robot = scene_cell.robot
    cell = replace(
        scene_cell,
        robot=robot.with_base(by @ robot.base),
        obstacles=tuple(replace(o, geometry=there(o.geometry)) for o in scene_cell.obstacles),
        parts=tuple(replace(p, geometry=there(p.geometry)) for p in scene_cell.parts),
    )
    moves = []
    for move in program.moves:
        assert isinstance(move.target, PoseTarget)
        moves.append(replace(move, target=replace(move.target, pose=by @ move.target.pose)))
    return cell, program.with_moves(tuple(moves))


def motion(name: str, cell: Cell, program: Program) -> RobotMotion:
    controller = Controller(find_vendor("ur"), cell.robot)
    handling = handling_of(program, cell) if cell.parts else None
    run = controller.run(program)
    return RobotMotion(name, controller, run, cell, (), handling, any_speed=True)


def standing(gap: float) -> RobotMotion:
    """An arm that moves a little, opposite of one that takes parts at the origin."""
    robot = UR.with_base(Pose((gap, 0.0, 0.0)))
    to = MoveJ(JointTarget((0.3, *HOME[1:])), Speed(joint=0.6))
    program = Program((to,), start=JointTarget(HOME))
    return motion("other", bare_cell(robot, "ur", floor=False), program)


def drive(*more: Move | Opaque) -> Program:
    low, high = (PoseTarget(Pose((0.6, 0.2, z), (0.0, 1.0, 0.0, 0.0))) for z in (0.35, 0.6))
    side = PoseTarget(Pose((0.6, -0.3, 0.6), (0.0, 1.0, 0.0, 0.0)))
    to = [MoveL(target, Speed(tcp=0.5), tool=GRIP) for target in (low, high, side)]
    return Program((to[0], *more, to[1], to[2]))


@pytest.mark.parametrize("gap", [1.3, 1.42, 1.5])
def test_a_carried_part_is_as_a_tool_of_its_shape(gap: float) -> None:
    """Taken before anything moves, it is there on all moves but the first."""
    place = Pose((0.6, 0.2, 0.2))
    kind = Workpiece("crate", Geometry(CRATE, place), ("on",), ("off",))
    tools = {"grip": GRIP}
    laden = Cell(UR, "ur", tools=tools, parts=(kind,))
    program = drive(Opaque("on", True))
    carried = handling_of(program, laden).arrangements[1][0]
    assert carried.held
    shaped = replace(laden, parts=(), tool_geometries={"grip": Geometry(CRATE, carried.pose)})
    found = []
    for cell in (laden, shaped):
        prover = PairProver(motion("one", cell, program), standing(gap))
        verdict = prover.prove(CLEARANCE, Meetings.at_any_time())
        found.append({moves: c for moves, c in verdict.conflicts.items() if moves[0] > 0})
    assert found[0].keys() == found[1].keys()
    for moves, conflict in found[0].items():
        assert conflict.cause is found[1][moves].cause
    if gap == 1.3:
        assert "crate" in {name for c in found[0].values() for name in c.pair}


def test_a_part_that_was_put_down_stands_in_the_way_from_then_on() -> None:
    kind = Workpiece("crate", Geometry(CRATE, Pose((0.6, 0.2, 0.2))), ("on",), ("off",))
    cell = Cell(UR, "ur", tools={"grip": GRIP}, parts=(kind,))
    program = drive(Opaque("on", True))
    away = MoveL(
        PoseTarget(Pose((0.6, -0.3, 0.9), (0.0, 1.0, 0.0, 0.0))), Speed(tcp=0.5), tool=GRIP
    )
    program = Program((*program.statements, Opaque("off", True), away))
    mine = motion("one", cell, program)
    there = mine.there(np.arange(4))
    names = [own.body.name for own in mine.bodies]
    lying, held, put = (k for k, name in enumerate(names) if name == "crate")
    assert there[:, [lying, held, put]].tolist() == [
        [True, False, False],
        [False, True, False],
        [False, True, False],
        [False, False, True],
    ]
    assert [mine.bodies[k].moves for k in (lying, held, put)] == [False, True, False]
    # Where it stands then another arm must not be, whatever has driven away.
    robot = UR.with_base(Pose((1.5, -0.3, 0.0)))
    reach = PoseTarget(Pose((0.75, -0.3, 0.45), (0.0, 1.0, 0.0, 0.0)))
    reaching = Program((MoveL(reach, Speed(tcp=0.5), tool=FLANGE),), start=JointTarget(HOME))
    other = motion("other", bare_cell(robot, "ur", floor=False), reaching)
    met = PairProver(mine, other).prove(CLEARANCE, Meetings.at_any_time()).conflicts
    assert "crate" in met[3, 0].pair


@settings(max_examples=6, deadline=None, suppress_health_check=list(HealthCheck))
@given(st.integers(0, 10**9), st.floats(1.1, 1.6), st.floats(0.0, 1.0))
def test_nothing_is_proven_that_samples_contradict(seed: int, gap: float, shift: float) -> None:
    one, other = random_handling(seed), random_handling(seed + 1)
    motions = (
        motion("one", one.cell, one.program),
        motion("other", *turned(other.cell, other.program, Pose((gap, 0.0, 0.0), TURNED))),
    )
    prover = PairProver(*motions)
    meetings = Meetings((lambda own: own, lambda own: own + shift), 0.0, every=False)
    t = np.arange(0.0, max(m.run.duration for m in motions) + shift, RATE)
    q, moves = [], []
    for each, own in zip(motions, (t, t - shift), strict=True):
        trajectory = each.run.trajectory
        q.append(np.stack([np.interp(own, trajectory.t, joint) for joint in trajectory.q.T], -1))
        row = np.clip(np.searchsorted(trajectory.t, own, "right") - 1, 0, None)
        moves.append(trajectory.move[row])
    least = prover.nearest(*q, (moves[0], moves[1]))[0]
    if prover.prove(CLEARANCE, meetings).proven:
        assert least >= CLEARANCE - 1e-4
    elif least > 3.0 * CLEARANCE:
        pytest.fail(f"{least} m apart, and not proven")


def test_parts_that_nobody_follows_are_refused() -> None:
    kind = Workpiece("crate", Geometry(CRATE, Pose((0.6, 0.2, 0.2))), ("on",), ("off",))
    around = (Obstacle("floor", Geometry(CRATE, Pose((2.0, 0.0, 0.0)))),)
    cell = Cell(UR, "ur", tools={"grip": GRIP}, parts=(kind,), obstacles=around)
    controller = Controller(find_vendor("ur"), UR)
    with pytest.raises(InputError, match="picked and placed"):
        RobotMotion("one", controller, controller.run(drive()), cell)
