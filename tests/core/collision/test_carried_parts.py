"""Parts in scenes: carried they are the tool's, lying they are obstacles; clearances along runs."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from flyby.core.cell.cell import Cell, Obstacle
from flyby.core.cell.geometry import Geometry, Mesh, Triangles
from flyby.core.cell.workpiece import Workpiece
from flyby.core.collision.clearance import STEP, ClearanceMeter, in_steps, nearest_of
from flyby.core.collision.proof.certificate import scenes_of
from flyby.core.collision.scene.scene import CollisionScene
from flyby.core.errors import InputError
from flyby.core.handling.arrangement import PlacedPart
from flyby.core.handling.handling import handling_of
from flyby.core.motion.emulator.controller import Controller
from flyby.core.program.move import MoveL, Opaque
from flyby.core.program.program import Program
from flyby.core.program.speed import Speed
from flyby.core.program.target import PoseTarget
from flyby.core.program.tool import FLANGE, Tool
from flyby.core.registry import find_robot, find_vendor
from flyby.core.robot.shape import Box, Capsule, Cylinder, Sphere
from flyby.core.spatial.pose import IDENTITY, Pose

from .conftest import arm, cell_of, configurations, table, u_profile

FEW = settings(max_examples=40, deadline=None)
GUN = Tool("gun")
AROUND = (
    Obstacle("block", Geometry(Box((0.3, 0.4, 0.5)), Pose((0.9, 0.3, 0.6)))),
    Obstacle("ball", Geometry(Sphere(0.15), Pose((-0.7, -0.5, 1.1)))),
)
U = u_profile()
PROFILE = Mesh(Path("u.stl"), "m", Triangles(U.vertices, U.faces))
shapes = st.sampled_from((Box((0.3, 0.2, 0.1)), Cylinder(0.1, 0.3), Capsule(0.06, 0.4), PROFILE))
convex = st.sampled_from((Box((0.3, 0.2, 0.1)), Cylinder(0.1, 0.3), Sphere(0.1)))
places = st.builds(
    lambda x, y, z, turned: Pose((x, y, z), (0.8, 0.36, 0.48, 0.0) if turned else (1, 0, 0, 0)),
    *(st.floats(-0.3, 0.3) for _ in range(3)),
    st.booleans(),
)


def part(shape, at: Pose = IDENTITY, **more) -> Workpiece:
    return Workpiece("crate", Geometry(shape, at), ("on",), ("off",), **more)


def by_pair(scene: CollisionScene, q, crate: str) -> dict[frozenset[str], float]:
    """Least distances by what touches, the crate by one name."""
    found: dict[frozenset[str], float] = {}
    distances = scene.distances(q).distance.min(axis=0)
    for row, (a, b) in enumerate(scene.pairs):
        names = frozenset(
            "crate" if scene.bodies[k].part == crate else scene.bodies[k].name for k in (a, b)
        )
        found[names] = min(found.get(names, np.inf), float(distances[row]))
    return found


@FEW
@given(shapes, places, st.integers(0, 10**6))
def test_a_carried_part_is_as_a_tool_of_its_shape(shape, place: Pose, seed: int) -> None:
    robot, kind = arm(), part(shape)
    bare = cell_of(robot, tools={"gun": GUN}, obstacles=AROUND, parts=(kind,))
    held = CollisionScene(bare, GUN, (PlacedPart("crate", kind, place, held=True),))
    shaped = cell_of(
        robot, tools={"gun": GUN}, obstacles=AROUND, tool_geometries={"gun": Geometry(shape, place)}
    )
    tool = CollisionScene(shaped, GUN)
    q = configurations(robot, 8, seed)
    first, second = by_pair(held, q, "crate"), by_pair(tool, q, "gun")
    assert first.keys() == second.keys()
    assert [first[k] for k in first] == pytest.approx([second[k] for k in first], abs=1e-9)


@FEW
@given(convex, places, st.integers(0, 10**6), st.booleans())
def test_a_lying_part_is_as_an_obstacle_there(shape, place, seed: int, turned: bool) -> None:
    robot, kind = arm(table()), part(shape)
    x, y, z = place.position
    place, carrier = replace(place, position=(1.0 + x, y, z)), "table" if turned else None
    lying = (PlacedPart("crate", kind, place, carrier=carrier),)
    scene = CollisionScene(cell_of(robot, parts=(kind,)), FLANGE, lying)
    thing = Obstacle("crate", Geometry(shape, place), carrier)
    other = CollisionScene(cell_of(robot, obstacles=(thing,)), FLANGE)
    q = configurations(robot, 8, seed)
    assert by_pair(scene, q, "crate") == pytest.approx(by_pair(other, q, "crate"), abs=1e-9)


def placed(kind: Workpiece, *places: tuple[Pose, bool]) -> tuple[PlacedPart, ...]:
    return tuple(PlacedPart(f"crate {k}", kind, at, held) for k, (at, held) in enumerate(places, 1))


@FEW
@given(places, places, st.integers(0, 10**6))
def test_a_rearranged_scene_is_as_one_made_anew(first: Pose, second: Pose, seed: int) -> None:
    kind = part(Box((0.1, 0.1, 0.1)))
    cell = cell_of(arm(), obstacles=AROUND, parts=(kind,))
    here = placed(kind, (first, True), (second, False))
    there = placed(kind, (second, False), (first, True))
    moved = CollisionScene(cell, FLANGE, here).rearranged(there)
    anew = CollisionScene(cell, FLANGE, there)
    q = configurations(cell.robot, 5, seed)
    assert np.array_equal(moved.pairs, anew.pairs)
    assert np.array_equal(moved.distances(q).distance, anew.distances(q).distance)
    assert moved.outlines.corners == pytest.approx(anew.outlines.corners)


def test_parts_on_the_arm_keep_off_those_that_lie() -> None:
    kind = part(Sphere(0.1))
    cell = cell_of(arm(), parts=(kind,))
    places = ((Pose((0, 0, 0.2)), True), (Pose((1, 0, 0)), False), (Pose((2, 0, 0)), False))
    scene = CollisionScene(cell, FLANGE, placed(kind, *places))
    pairs = {frozenset(scene.pair_names(k)) for k in range(len(scene.pairs))}
    assert frozenset({"crate 1", "crate 2"}) in pairs
    assert frozenset({"crate 2", "crate 3"}) not in pairs
    allowed = replace(cell, allowed=(("crate", "crate"),))
    fewer = CollisionScene(allowed, FLANGE, placed(kind, *places))
    names = {frozenset(fewer.pair_names(k)) for k in range(len(fewer.pairs))}
    assert frozenset({"crate 1", "crate 2"}) not in names
    gone = tuple(replace(one, gone=one.name == "crate 2") for one in placed(kind, *places))
    left = scene.rearranged(gone)
    assert "crate 2" not in {name for k in range(len(left.pairs)) for name in left.pair_names(k)}


@FEW
@given(st.integers(0, 10**6), st.floats(0.0, 0.5))
def test_the_nearest_is_the_least_of_all_distances(seed: int, within: float) -> None:
    mesh = Obstacle("profile", Geometry(PROFILE, Pose((0.7, 0.2, 0.6))))
    scene = CollisionScene(cell_of(arm(), obstacles=(*AROUND, mesh)), FLANGE)
    q = configurations(scene.robot, 20, seed)
    pairs = np.arange(0, len(scene.pairs), 2)
    every = scene.distances(q).distance[:, pairs]
    met = scene.nearest(q, pairs)
    assert met is not None
    cut = scene.nearest(q, pairs, within)
    if every.min() <= 1e-7:
        # How deep meshes are in each other is not told in full.
        assert met[0] <= 1e-7
    else:
        assert met[0] == pytest.approx(every.min(), abs=1e-7)
        assert every[met[1], list(pairs).index(met[2])] == pytest.approx(met[0], abs=1e-7)
    if every.min() < within - 1e-7:
        assert cut is not None
        assert cut[0] == pytest.approx(met[0], abs=1e-7)
    elif every.min() > within + 1e-7:
        assert cut is None


def test_proofs_refuse_cells_whose_parts_are_not_followed() -> None:
    cell = cell_of(arm(), parts=(part(Sphere(0.1)),))
    with pytest.raises(InputError, match=r"parts that are picked and placed \('crate'\)"):
        scenes_of(cell)(FLANGE)


@FEW
@given(st.tuples(*[st.floats(-3, 3)] * 3), st.integers(2, 40), st.floats(0.1, 2.0))
def test_steps_are_small_and_follow_the_path(wave, count: int, length: float) -> None:
    a, b, c = wave

    def path(sigma):
        return np.stack([a * sigma + b * np.sin(sigma), np.cos(c * sigma)], axis=1)

    sigma = np.linspace(0.0, length, count)
    q = path(sigma)
    dq = np.stack([a + b * np.cos(sigma), -c * np.sin(c * sigma)], axis=1)
    steps = in_steps(q, dq, sigma)
    # A cubic is at most three times as steep as its chord.
    assert np.abs(np.diff(steps, axis=0)).max(initial=0.0) <= 3 * STEP + 1e-9
    for row in q:
        assert np.abs(steps - row).max(axis=1).min() < 1e-9
    fine = path(np.linspace(0.0, length, 2000))
    off = np.abs(fine[:, None] - steps).max(axis=2).min(axis=1).max()
    chords = np.abs(np.diff(q, axis=0)).max(initial=0.0)
    assert off <= 2 * STEP + chords**2


# Along runs

UR = find_robot("ur/ur10e")
GRIP = Tool("grip", Pose((0.0, 0.0, 0.1)))
ON, OFF = Opaque("on", True), Opaque("off", True)
FLOOR = Obstacle("floor", Geometry(Box((0.6, 1.0, 0.1)), Pose((0.7, 0.0, -0.05))))


def to(x: float, y: float, z: float) -> MoveL:
    return MoveL(PoseTarget(Pose((x, y, z), (0.0, 1.0, 0.0, 0.0))), Speed(tcp=0.5), tool=GRIP)


def clearances(
    program: Program, parts: tuple[Workpiece, ...], clearance: float = 0.0, around=(FLOOR,)
):
    cell = Cell(
        UR,
        "ur",
        clearance=clearance,
        tools={"grip": GRIP},
        tool_geometries={"grip": Geometry(Cylinder(0.03, 0.09), Pose((0.0, 0.0, 0.045)))},
        obstacles=around,
        parts=parts,
    )
    handling = handling_of(program, cell)
    run = Controller(find_vendor("ur"), UR).run(program)
    meter = ClearanceMeter(cell, program, handling)
    return meter.over(run.path, 0)


def crate(**more) -> Workpiece:
    """10 cm high, on the floor, its top at 0.1 m."""
    return part(Box((0.1, 0.1, 0.1)), Pose((0.6, 0.2, 0.05)), **more)


def trip(put: float = 0.1, lift: float = 0.3) -> Program:
    return Program(
        (
            to(0.6, 0.2, lift),
            to(0.6, 0.2, 0.1),
            ON,
            to(0.6, 0.2, lift),
            to(0.6, -0.2, lift),
            to(0.6, -0.2, put),
            OFF,
            to(0.6, -0.2, lift),
            to(0.6, 0.2, lift),
        )
    )


def test_what_is_taken_and_put_down_may_touch_what_it_rests_on() -> None:
    moves = clearances(trip(), (crate(),))
    cell, own = nearest_of(moves)
    assert cell is not None
    assert cell.distance > 0.0
    assert own is not None
    # Carried 0.2 m above the floor, the crate is what is nearest to it.
    across = next(move for move in clearances(trip(), (crate(),), 0.25) if move.move == 3)
    assert across.cell is not None
    assert set(across.cell.pair) == {"crate", "floor"}
    assert across.cell.distance == pytest.approx(0.2, abs=1e-3)


def test_what_is_put_down_too_deep_is_in_the_floor() -> None:
    moves = clearances(trip(put=0.08), (crate(),))
    cell, _ = nearest_of(moves)
    assert cell is not None
    assert cell.distance == pytest.approx(-0.02, abs=1e-3)
    assert set(cell.pair) == {"crate", "floor"}
    assert cell.move == 4


def test_what_was_put_down_stands_in_the_way() -> None:
    # Back across the place at which the crate was released, near the floor.
    low = Program((*trip().statements, to(0.6, -0.2, 0.3), to(0.4, -0.2, 0.3), to(0.4, -0.2, 0.05)))
    clear = nearest_of(clearances(low, (crate(),)))[0]
    through = Program((*low.statements, to(0.8, -0.2, 0.05)))
    hit = nearest_of(clearances(through, (crate(),)))[0]
    gone = nearest_of(clearances(through, (crate(leaves=True),)))[0]
    assert clear is not None and hit is not None and gone is not None
    assert clear.distance > 0.0
    assert set(hit.pair) == {"grip", "crate"}
    assert hit.distance < 0.0
    assert hit.move == 10
    assert gone.distance > 0.0


def test_a_carried_part_takes_clearance_that_the_bare_tool_has() -> None:
    wall = Obstacle("wall", Geometry(Box((0.1, 0.02, 0.2)), Pose((0.6, 0.0, 0.1))))
    bare = nearest_of(clearances(trip(lift=0.35), (), around=(wall,)))[0]
    laden = nearest_of(clearances(trip(lift=0.35), (crate(),), around=(wall,)))[0]
    assert bare is not None and laden is not None
    assert bare.distance > laden.distance + 0.03
    assert set(laden.pair) == {"crate", "wall"}
    assert laden.distance == pytest.approx(0.05, abs=2e-3)
