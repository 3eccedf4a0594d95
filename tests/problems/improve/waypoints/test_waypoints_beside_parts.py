"""Via points and zones of programs that take parts and put them down."""

from __future__ import annotations

from dataclasses import replace

from hypothesis import given, settings
from hypothesis import strategies as st

from flyby.core.cell.cell import Cell, Obstacle
from flyby.core.cell.geometry import Geometry
from flyby.core.cell.workpiece import Workpiece
from flyby.core.collision.handled_scenes import HandledScenes, PartScenes
from flyby.core.collision.proof.certificate import certify, renumbered
from flyby.core.collision.scene.scene import CollisionScene
from flyby.core.errors import MotionError
from flyby.core.handling.handling import handling_of
from flyby.core.motion.emulator.controller import Controller
from flyby.core.motion.geometry.pieces import Sampling
from flyby.core.program.move import MoveL, Opaque
from flyby.core.program.program import Program
from flyby.core.program.speed import Speed
from flyby.core.program.target import PoseTarget
from flyby.core.program.tool import Tool
from flyby.core.program.zone import FINE, Radius
from flyby.core.registry import find_robot, find_vendor
from flyby.core.robot.shape import Box, Cylinder
from flyby.core.spatial.pose import Pose
from flyby.problems.improve.solution import Solution
from flyby.problems.improve.waypoints import Effort, Fixed, WaypointTask, optimize_waypoints
from flyby.problems.improve.waypoints.changeable import beside_parts, select
from flyby.problems.improve.waypoints.via_selection import Counted, idle_points
from flyby.validation.scenes.handling import random_handling, worst_fault

UR = find_robot("ur/ur10e")
CONTROLLER = Controller(find_vendor("ur"), UR)
GRIP = Tool("grip", Pose((0.0, 0.0, 0.2)))
ON, OFF = Opaque("on", True), Opaque("off", True)
BRIEF = Effort(starts=1, generations=0, iterations=8, proofs=2, workers=1)
DENSE = Sampling(step=0.002, turn=0.01, joint=0.003, halvings=1, most=5000)
TOP = 0.1
"""m above the floor, of the crate's top."""


def cell_of(**more) -> Cell:
    shape = Geometry(Cylinder(0.02, 0.2), Pose((0.0, 0.0, 0.1)))
    crate = Workpiece(
        "crate", Geometry(Box((0.1, 0.1, TOP)), Pose((0.6, 0.2, 0.5 * TOP))), ("on",), ("off",)
    )
    floor = Obstacle("floor", Geometry(Box((0.6, 1.0, 0.1)), Pose((0.7, 0.0, -0.05))))
    return Cell(
        UR,
        "ur",
        tools={"grip": GRIP},
        tool_geometries={"grip": shape},
        obstacles=(floor,),
        parts=(crate,),
        **more,
    )


def to(y: float, z: float, zone=FINE) -> MoveL:
    target = PoseTarget(Pose((0.6, y, z), (0.0, 1.0, 0.0, 0.0)))
    return MoveL(target, Speed(tcp=0.5), zone, tool=GRIP)


def trip(grip: float = TOP) -> Program:
    """Move 3 lifts the crate, move 5 puts it down."""
    small = Radius(0.01)
    return Program(
        (
            to(0.2, 0.3),
            to(0.2, grip),
            ON,
            to(0.2, 0.3, small),
            to(-0.2, 0.3, small),
            to(-0.2, grip),
            OFF,
            to(-0.2, 0.3),
        )
    )


def optimized(program: Program, cell: Cell, effort: Effort = BRIEF, **more) -> Solution:
    task = WaypointTask(handling=handling_of(program, cell), **more)
    return optimize_waypoints(CONTROLLER, program, cell, task, effort)


def shift_of_touching(program: Program, cell: Cell, move: int, clearance: float) -> float:
    """m that the crate is shifted along a move while it is nearer to the floor than that."""
    handling, path = handling_of(program, cell), CONTROLLER.plan(program)
    scene = CollisionScene(cell, GRIP, handling.arrangements[move])
    pair = [k for k in range(len(scene.pairs)) if set(scene.pair_names(k)) == {"crate", "floor"}]
    q = path.q[path.sample_moves() == move]
    near = scene.distances(q).distance[:, pair[0]] < clearance
    assert near.any()
    return float(scene.shifts(q[near], q[0 if near[0] else -1])[:, pair[0]].max())


@settings(max_examples=2)
@given(st.integers(0, 10**9), st.sampled_from([0.0, 0.003, 0.006]))
def test_no_program_is_handed_out_that_dense_samples_contradict(seed, clearance) -> None:
    """A larger run of the same: ``python benchmarks/certificate.py --case parts-optimized``."""
    scene = random_handling(seed)
    cell, program = replace(scene.cell, clearance=clearance), scene.program
    controller = Controller(find_vendor("ur"), cell.robot)
    handling = handling_of(program, cell)
    task = WaypointTask(handling=handling)
    effort = replace(BRIEF, iterations=2, proofs=1)
    try:
        made = optimize_waypoints(controller, program, cell, task, effort)
    except MotionError:
        return
    again = handling_of(made.program, cell)
    dense = Controller(find_vendor("ur"), cell.robot, controller.model, DENSE).plan(made.program)
    assert made.proven and made.after.time <= made.before.time
    assert worst_fault(cell, again, dense, clearance).by < 1.1e-5
    assert [made.program.moves[i].target for i in again.targets] == [
        program.moves[i].target for i in handling.targets
    ]


def test_points_move_and_the_crate_is_not_slid_along_the_floor() -> None:
    cell = cell_of(clearance=0.005)
    program = trip()
    made = optimized(program, cell, replace(BRIEF, iterations=12))
    assert made.proven and made.after.time < 0.9 * made.before.time
    assert {2, 3} <= {moved.move for moved in made.moved}
    for move in (2, 4):
        before, after = (shift_of_touching(p, cell, move, 0.005) for p in (program, made.program))
        assert after < 2.0 * before + 0.005


def test_nobody_knows_another_way_out_of_a_part_that_the_tool_is_in() -> None:
    """It reaches 30 mm into the crate: the point over it stays, its zone changes."""
    program = trip(TOP - 0.03)
    over = to(-0.2, 0.3, Radius(0.01))
    program = replace(program, statements=(*program.statements[:-1], over, to(0.3, 0.3)))
    made = optimized(program, cell_of())
    assert made.proven and made.program.moves[5].target == over.target
    assert made.program.moves[5].zone != over.zone
    said = {note.move: note.message for note in made.notes}
    assert "30.0 mm in the part that it releases there" in said[5]


def test_what_is_handled_on_the_fly_stays() -> None:
    taken = replace(trip().moves[1], zone=Radius(0.002))
    program = replace(
        trip(), statements=(trip().moves[0], taken, Opaque("on", False), *trip().statements[3:])
    )
    made = optimized(program, cell_of())
    assert made.program.moves[1] == taken
    assert {n.message for n in made.notes if n.move == 1} == {
        "stays as it is: a part is taken or released there"
    }


def test_points_over_places_do_not_go() -> None:
    """Of three points above, the one in the middle alone is tried without."""
    statements = list(trip().statements)
    statements.insert(4, to(0.0, 0.3, Radius(0.01)))
    program, cell = Program(tuple(statements)), cell_of()
    run, handling = CONTROLLER.run(program), handling_of(program, cell)
    scenes = HandledScenes(PartScenes(cell), handling, run.program, run.path)
    task = beside_parts(WaypointTask(handling=handling), program, run.path, scenes)
    best = Counted(run, certify(CONTROLLER, run, scenes, 0.0), 1.0, task)
    tried = []

    def judged(fewer: Program, task: WaypointTask) -> float | None:
        own = renumbered(scenes, task.given or ())
        tried.append(task.given)
        return float(certify(CONTROLLER, CONTROLLER.run(fewer), own, 0.0).proven)

    assert list(idle_points(best, select(program, run.path, UR, task), judged)) == [3]
    assert tried == [(0, 1, 2, 4, 5, 6)]


def test_a_new_point_on_the_way_is_driven_with_what_is_carried_there() -> None:
    task = WaypointTask(keep=(4,))
    more = task.renumbered(lambda k: k + (k >= 2), 7)
    assert more.given == (0, 1, 2, 2, 3, 4, 5) and list(more.keep) == [5]
    fewer = more.renumbered(lambda k: None if k == 4 else k - (k > 4), 6)
    assert fewer.given == (0, 1, 2, 2, 4, 5) and list(fewer.keep) == [4]


def test_points_at_which_what_touches_is_not_apart_stay() -> None:
    """Put down 30 mm deep, the tool draws back by 10 mm first."""
    statements = list(trip(TOP - 0.03).statements)
    statements.insert(-1, to(-0.2, TOP - 0.02, Radius(0.002)))
    program, cell = Program(tuple(statements)), cell_of()
    run, handling = CONTROLLER.run(program), handling_of(program, cell)
    scenes = HandledScenes(PartScenes(cell), handling, program, run.path)
    task = beside_parts(WaypointTask(handling=handling), program, run.path, scenes)
    assert certify(CONTROLLER, run, scenes, 0.0).proven
    assert {5, 6} <= set(task.ways) and "not apart yet" in task.settled[5]
    reasons = select(program, run.path, UR, task).reasons
    assert reasons[5] == task.settled[5]


def test_ways_become_no_longer_again_and_again() -> None:
    """Where points come and go a program is searched many times, each from the one before."""
    task = WaypointTask(ways=(2, 4))
    assert {i for i, limit in task.spent().limits.items() if limit == Fixed()} == {1, 2, 3, 4}
    more = task.renumbered(lambda k: k + (k >= 1), 7).spent()
    assert set(more.limits) == {2, 3, 4, 5}
