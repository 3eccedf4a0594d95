"""The reference scenes: what stands in them, and that their programs may be driven."""

from __future__ import annotations

from itertools import pairwise
from pathlib import Path

import numpy as np
import pytest

from flyby.core.cell.file import load_cell
from flyby.core.cell.geometry import Mesh
from flyby.core.collision.proof.certificate import certify, scenes_of
from flyby.core.collision.scene.scene import CollisionScene
from flyby.core.motion.emulator.controller import Controller
from flyby.core.motion.geometry.pieces import Sampling
from flyby.core.motion.model.motion_model import MotionModel
from flyby.core.program.move import MoveC, MoveJ, MoveL
from flyby.core.program.zone import Fine, Radius
from flyby.core.registry import find_vendor, installed
from flyby.core.robot.shape import Box
from flyby.validation.scenes import clutter_layout, files
from flyby.validation.scenes import stud_welding as station
from flyby.validation.scenes.clutter import clutter, clutter_100, swept_arm
from flyby.validation.scenes.clutter_layout import NEAREST, arrange, thing
from flyby.validation.scenes.clutter_places import PLACES, SEED
from flyby.validation.scenes.clutter_shapes import KINDS
from flyby.validation.scenes.scene import PARABOLAS, Scene, with_zone
from flyby.validation.scenes.solids import plate
from flyby.validation.scenes.stud_welding import stud_welding, stud_welding_with_panel
from flyby.validation.scenes.two_joints import two_joints

FINE_SAMPLES = Sampling(joint=0.01)


def duration(scene: Scene, zone: Radius | None = None) -> float:
    """s of all programs of a scene, with stops, or with zones round via points."""
    controller = scene.controller(sampling=FINE_SAMPLES)
    programs = [p if zone is None else with_zone(p, zone) for p in scene.programs]
    return sum(controller.run(program).duration for program in programs)


def from_rest_to_rest(scene: Scene) -> float:
    """s of all legs of a scene: ramps at the largest acceleration, largest speed between."""
    limits, total = scene.cell.robot.limits, 0.0
    for program in scene.programs:
        stops = np.array([program.start.joints, *(m.target.joints for m in program.moves)])
        way = np.maximum(np.abs(np.diff(stops, axis=0)), 1e-15)
        speed, rate = (limits.velocity / way).min(axis=1), (limits.acceleration / way).min(axis=1)
        ramps = 2 * np.sqrt(1 / rate)
        total += float(np.where(rate < speed**2, ramps, 1 / speed + speed / rate).sum())
    return total


@pytest.mark.parametrize(("make", "known"), [(two_joints, 2.291), (stud_welding, 11.642)])
def test_stopping_at_every_via_takes_what_ramps_take(make, known: float) -> None:
    scene = make()
    assert from_rest_to_rest(scene) == pytest.approx(known, abs=5e-4)
    assert duration(scene) == pytest.approx(from_rest_to_rest(scene), rel=1e-3)


def test_zones_save_time() -> None:
    scene = two_joints()
    assert duration(scene, Radius(0.3)) < 0.75 * duration(scene)
    parabolas = scene.controller(PARABOLAS, FINE_SAMPLES)
    assert parabolas.run(with_zone(scene.programs[0], Radius(0.3))).duration < 1.6


def test_tips_of_the_two_joints_scene_are_where_they_are_said_to_be() -> None:
    scene = two_joints()
    program = scene.programs[0]
    targets = [program.start, *(move.target for move in program.moves)]
    places = [(1.12, 0.45), (1.3, 0.85), (1.65, 1.0), (2.1, 0.85), (2.2, 0.5)]
    for target, (x, z) in zip(targets, places, strict=True):
        tip = scene.cell.robot.flange_pose(target.joints) @ scene.tool.tcp
        np.testing.assert_allclose(tip.position, (x, 0.0, z), atol=1e-9)


def test_four_of_the_motions_have_via_points() -> None:
    counts = [len(program.moves) for program in stud_welding().programs]
    assert len(counts) == 24
    assert [k for k, count in enumerate(counts) if count > 1] == [4, 11, 13, 20]


def test_every_stud_is_met_along_the_normal() -> None:
    scene = stud_welding()
    for (x, y), program in zip(station.STUD_PLACES, scene.programs[:-1], strict=True):
        pose = scene.cell.robot.flange_pose(program.moves[-1].target.joints) @ scene.tool.tcp
        normal = station.panel_normal(x, y)
        stud = np.array([x, y, float(station.panel_height(x, y))])
        np.testing.assert_allclose(pose.position, stud + station.STANDOFF * normal, atol=1e-8)
        np.testing.assert_allclose(pose.matrix()[:3, 2], -normal, atol=1e-8)


def test_motions_go_from_stud_to_stud_and_home() -> None:
    programs = stud_welding().programs
    for before, after in pairwise(programs):
        assert before.moves[-1].target == after.start
    assert programs[0].start == programs[-1].moves[-1].target


@pytest.mark.parametrize("motion", [4, 11, 13, 20])
def test_a_tower_stands_in_the_straight_way(motion: int) -> None:
    scene = stud_welding()
    program = scene.programs[motion]
    ends = np.array([program.start.joints, program.moves[-1].target.joints])
    share = np.linspace(0.0, 1.0, 50)[:, None]
    straight = (1 - share) * ends[0] + share * ends[1]
    found = CollisionScene(scene.cell, scene.tool)
    assert found.collides(straight).any()
    hit = found.contact(straight[int(np.argmax(found.collides(straight)))])
    assert {hit.first, hit.second} == {"gun", f"tower{motion}"}


def test_the_panel_is_a_plate_just_above_its_formula() -> None:
    panel = stud_welding_with_panel().cell.obstacles[-1]
    mesh = panel.geometry.shape
    assert isinstance(mesh, Mesh) and mesh.notes == ()
    corners = mesh.vertices[mesh.faces]
    upper = corners[(np.cross(*np.diff(corners, axis=1).swapaxes(0, 1))[:, 2] > 1e-12)]
    middles = upper.mean(axis=1)
    above = middles[:, 2] - station.panel_height(middles[:, 0], middles[:, 1])
    assert above.min() >= 0.0 and above.max() < 1e-4


def test_a_flat_plate_has_its_volume() -> None:
    mesh = plate(lambda x, y: 0.0 * x, (0.0, 0.0), (0.3, 0.2), 0.07, 0.01)
    a, b, c = (mesh.vertices[mesh.faces[:, k]] for k in range(3))
    volume = np.einsum("fi,fi->", a, np.cross(b, c)) / 6
    assert volume == pytest.approx(0.3 * 0.2 * 0.01)
    assert np.ptp(mesh.vertices, axis=0) == pytest.approx((0.3, 0.2, 0.01))


@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.parametrize("seed", range(5))
def test_things_are_closed_and_face_outwards(kind, seed: int) -> None:
    mesh = kind("thing", np.random.default_rng(seed))
    assert len(mesh.faces) == 10_000
    assert mesh.notes == ()
    a, b, c = (mesh.vertices[mesh.faces[:, k]] for k in range(3))
    assert np.einsum("fi,fi->", a, np.cross(b, c)) > 0
    edges = np.concatenate([mesh.faces[:, [0, 1]], mesh.faces[:, [1, 2]], mesh.faces[:, [2, 0]]])
    assert len(np.unique(edges, axis=0)) == len(edges)  # each edge once either way: one surface
    assert 0.05 < np.ptp(mesh.vertices, axis=0).max() < 0.5


@pytest.fixture(scope="module")
def cluttered() -> CollisionScene:
    scene = clutter()
    return CollisionScene(scene.cell, scene.tool)


def test_clutter_has_what_it_should(cluttered: CollisionScene) -> None:
    scene = clutter()
    meshes = [o for o in scene.cell.obstacles if isinstance(o.geometry.shape, Mesh)]
    assert len(meshes) >= 20
    assert all(len(o.geometry.shape.faces) == 10_000 for o in meshes)
    moves = scene.programs[0].moves
    assert len(moves) >= 10
    assert {type(move) for move in moves} == {MoveJ, MoveL, MoveC}
    assert [type(moves[k]) for k in scene.process] == [MoveC] * 4
    assert len(clutter_100().programs[0].moves) == 100
    q = scene.controller().plan(scene.programs[0]).q
    assert (np.ptp(q, axis=0) > 0.3).all()  # all six joints take part


@pytest.mark.parametrize("make", [clutter, clutter_100])
def test_clutter_is_free_and_near(make, cluttered: CollisionScene) -> None:
    scene = make()
    q = scene.controller(sampling=Sampling(halvings=1)).plan(scene.programs[0]).q
    least = cluttered.clearance(q, 0.05).min()
    assert scene.cell.clearance + 1e-3 < least < 0.02


def test_clutter_forbids_wide_zones(cluttered: CollisionScene) -> None:
    for scene in (clutter(), clutter_100()):
        wide = with_zone(scene.programs[0], Radius(0.3))
        q = scene.controller(sampling=Sampling(halvings=1)).plan(wide).q
        assert cluttered.clearance(q, 0.05).min() < scene.cell.clearance


def test_things_are_drawn_from_the_seed() -> None:
    for index in range(4):
        first, again, other = thing(index, 1), thing(index, 1), thing(index, 2)
        assert first == again and first != other


def test_stored_places_keep_the_gaps_of_the_layout() -> None:
    """Against the same cloud of the arm that they were arranged by, but for rounding."""
    arm = swept_arm(SEED)
    for index, place in enumerate(PLACES):
        matrix = place.matrix()
        points = thing(index, SEED).vertices @ matrix[:3, :3].T + matrix[:3, 3]
        assert arm.gap(points) > NEAREST - 1e-3


def test_arranging_puts_a_thing_into_room(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(clutter_layout, "COUNT", 1)
    arm = swept_arm(SEED)
    (place,) = arrange(arm, SEED)
    np.testing.assert_allclose(place.position, PLACES[0].position, atol=1e-3)
    matrix = place.matrix()
    points = thing(0, SEED).vertices @ matrix[:3, :3].T + matrix[:3, 3]
    assert NEAREST - 1e-3 < arm.gap(points) < 0.02


def test_scenes_are_written_as_files_that_say_the_same(tmp_path: Path) -> None:
    scene = stud_welding_with_panel()
    (tmp_path / "meshes").mkdir()
    files.write_meshes(scene, tmp_path / "meshes")
    files.write_module(scene, tmp_path)
    file = tmp_path / "station.toml"
    file.write_text(files.cell_text(scene, "meshes"), "utf-8")
    cell = load_cell(file, installed())
    assert cell.clearance == scene.cell.clearance
    assert cell.allowed == scene.cell.allowed
    assert cell.tool("gun").load == scene.tool.load
    for read, made in zip(cell.obstacles, scene.cell.obstacles, strict=True):
        assert read.name == made.name
        if isinstance(made.geometry.shape, Box):
            np.testing.assert_allclose(read.geometry.shape.size, made.geometry.shape.size)
        else:
            spread = np.ptp(made.geometry.shape.vertices, axis=0)
            np.testing.assert_allclose(
                np.ptp(read.geometry.shape.vertices, axis=0), spread, atol=1e-6
            )
    vendor = find_vendor("abb")
    text = (tmp_path / f"{scene.name}.mod").read_text("utf-8")
    program = vendor.read(text, f"{scene.name}.mod", robot=cell.robot)
    whole = files.whole_program(scene)
    assert len(program.moves) == len(whole.moves) == 33
    assert [isinstance(m.zone, Fine) for m in program.moves] == [
        isinstance(m.zone, Fine) for m in whole.moves
    ]


@pytest.mark.parametrize("model", [PARABOLAS, None])
def test_the_written_station_is_proven(tmp_path: Path, model: MotionModel | None) -> None:
    """On the catalogue's arm, whose shapes are others than the scene's, and as ABB drives it.

    What is proven is no more than the links keep, and hardly less.
    """
    scene = stud_welding()
    file = tmp_path / "station.toml"
    file.write_text(files.cell_text(scene, "meshes"), "utf-8")
    cell = load_cell(file, installed())
    controller = Controller(find_vendor("abb"), cell.robot, model)
    run = controller.run(files.whole_program(scene))
    proof = certify(controller, run, scenes_of(cell), cell.clearance, resolution=1e-4)
    kept = scenes_of(cell)(scene.tool).clearance(run.trajectory.q, 0.05).min()
    assert proof.proven and kept - 0.0002 < proof.clearance <= kept
