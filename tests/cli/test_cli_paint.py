"""``flyby paint``: what it prints, what it writes where, and what it refuses."""

from __future__ import annotations

import json
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
import trimesh
from typer.testing import Result

from flyby.core.registry import find_robot, find_vendor

ROBOT = "abb/irb6640-180-255"
FOOTPRINT = (
    "reference_distance_mm = 250\nnear_radius_mm = 35\n"
    "radius_mm = [0, 150, 250]\ngrowth_um_s = [2, 20, 0]\n"
)

Flyby = Callable[..., Result]


@pytest.fixture
def panel(tmp_path: Path) -> tuple[Path, Path]:
    """A flat panel of 0.5 m x 0.3 m in millimetres, and a footprint."""
    x, y = np.meshgrid(np.linspace(-250, 250, 6), np.linspace(-150, 150, 4))
    vertices = np.stack([x.ravel(), y.ravel(), 0.0 * x.ravel()], axis=1)
    index = np.arange(24).reshape(4, 6)
    a, b, c, d = (
        i.ravel() for i in (index[:-1, :-1], index[:-1, 1:], index[1:, 1:], index[1:, :-1])
    )
    faces = np.concatenate([np.stack([a, b, c], 1), np.stack([a, c, d], 1)])
    part, footprint = tmp_path / "panel.stl", tmp_path / "bell.toml"
    trimesh.Trimesh(vertices, faces, process=False).export(part)
    footprint.write_text(FOOTPRINT)
    return part, footprint


def words(panel: tuple[Path, Path], *more: object) -> tuple[object, ...]:
    part, footprint = panel
    return ("paint", part, "--footprint", footprint, "--target", "50um", "--units", "mm", *more)


def test_program_and_pictures(flyby: Flyby, panel: tuple[Path, Path], tmp_path: Path):
    out = tmp_path / "out"
    robot = ("--robot", ROBOT, "--place", "1500,0,800", "--signal", "doGun", "--delay", "40")
    result = flyby(*words(panel, *robot, "--points", "300", "--out", out, "--json"))
    assert result.exit_code == 0, result.output
    told = json.loads(result.stdout)
    stages = told["stages"]
    assert list(stages) == ["start", "speed only", "full", "as emulated"]
    assert stages["as emulated"]["std_m"] < stages["full"]["std_m"] + 0.5e-6
    assert stages["full"]["within_10_percent"] == 1.0
    assert told["proven"] is True and told["speed_only"]["duality_gap"] < 1e-6
    written = {path.name for path in out.iterdir()}
    assert written == {"paint.mod", "thickness.png", "curve.png", "histogram.png"}
    assert {str(out / name) for name in written} == set(told["files"])
    assert all((out / n).read_bytes().startswith(b"\x89PNG") for n in written if n[-3:] == "png")
    program = find_vendor("abb").read_file(out / "paint.mod", robot=find_robot(ROBOT))
    assert [e.text for m in program.moves for e in m.events] == ["doGun,1", "doGun,0"]
    again = flyby(*words(panel, "--out", out))
    assert again.exit_code == 1 and "--force replaces it" in again.output


def test_a_language_without_named_tools(flyby: Flyby, panel: tuple[Path, Path], tmp_path: Path):
    """What is read back has a tool of the language's own name; it is the gun all the same."""
    out = tmp_path / "out"
    robot = ("--robot", "ur/ur10e", "--place", "700,0,200,0,0,90", "--speed", "50,200")
    result = flyby(*words(panel, *robot, "--points", "200", "--unproven", "--out", out, "--json"))
    told = json.loads(result.stdout)
    assert told["certificate"] is not None
    assert told["stages"]["as emulated"]["within_10_percent"] > 0.99
    assert (out / "paint.script").exists()


def test_without_a_robot_there_is_no_program(
    flyby: Flyby, panel: tuple[Path, Path], tmp_path: Path
):
    out = tmp_path / "out"
    more = ("--coats", "crossed", "--errors", "2,0", "--points", "100", "--sweep", "250")
    result = flyby(*words(panel, *more, "--out", out))
    assert result.exit_code == 0, result.output
    assert "as emulated" not in result.stdout and "full" in result.stdout
    assert "transfer %" in result.stdout and "paint ml" in result.stdout
    assert {path.name for path in out.iterdir()} == {"thickness.png", "curve.png", "histogram.png"}


def test_what_is_painted_is_narrowed_down(flyby: Flyby, panel: tuple[Path, Path]):
    """The top of a block (0.15 m²) without its sides: the half of it that is not covered."""
    block = panel[0].with_name("block.stl")
    trimesh.creation.box((500, 300, 60)).export(block)
    ask = words(
        (block, panel[1]), "--points", "200", "--view", "0,0,-1", "--facing", "30", "--json"
    )
    half = flyby(*ask, "--covered", "0,-200,-90,300,200,90")
    assert half.exit_code == 0, half.output
    assert json.loads(half.stdout)["area_m2"] == pytest.approx(0.075, rel=0.05)
    none = flyby(*ask, "--inside", "0,0,200,9,9,300")
    assert none.exit_code == 1 and "leave nothing of it to paint" in none.output.replace("\n", " ")


def test_millimetres_taken_for_metres(flyby: Flyby, panel: tuple[Path, Path]):
    part, footprint = panel
    result = flyby("paint", part, "--footprint", footprint, "--target", "50um")
    assert result.exit_code == 1
    assert "probably mm, and were taken for m: read it with --units mm" in result.output


def test_a_part_without_triangles(flyby: Flyby, panel: tuple[Path, Path]):
    part = panel[0].with_name("empty.stl")
    part.write_text("solid x\nendsolid x\n")
    result = flyby("paint", part, "--footprint", panel[1], "--target", "50um")
    assert result.exit_code == 1
    assert "empty.stl: there are no triangles in it" in result.output.replace("\n", "")


def test_a_sheet_on_a_seam_is_told(flyby: Flyby, panel: tuple[Path, Path]):
    part = panel[0].with_name("fin.ply")
    mesh = trimesh.load(panel[0])
    a, b = mesh.faces[7][:2]
    top = mesh.vertices[[a, b]].mean(axis=0) + np.array((0.0, 0.0, 50.0))
    vertices = np.concatenate([mesh.vertices, top[None]])
    faces = np.concatenate([mesh.faces, [[a, b, len(mesh.vertices)]]])
    trimesh.Trimesh(vertices, faces, process=False).export(part)
    result = flyby(*words((part, panel[1]), "--points", "200"))
    assert result.exit_code == 0, result.output
    assert "fin.ply: the mesh is not manifold: 1 edges" in result.output.replace("\n", " ")


def test_gaps_between_sweeps_are_predicted(flyby: Flyby, panel: tuple[Path, Path]):
    result = flyby(*words(panel, "--points", "200", "--sweep", "260", "--overhang", "0"))
    assert result.exit_code == 0, result.output
    assert "of its mean on a plane" in result.output


def test_a_stretch_out_of_reach(flyby: Flyby, panel: tuple[Path, Path]):
    robot = ("--robot", ROBOT, "--place", "2600,0,800", "--points", "200")
    result = flyby(*words(panel, *robot))
    assert result.exit_code == 1
    assert "cannot reach the stretch from waypoint" in result.output.replace("\n", " ")


def test_what_is_not_proven_is_not_written(flyby: Flyby, panel: tuple[Path, Path], tmp_path: Path):
    cell = tmp_path / "cell.toml"
    cell.write_text(f'robot = "{ROBOT}"\nclearance_mm = 400\n')
    robot = ("--cell", cell, "--place", "1500,0,800", "--points", "200", "--out", tmp_path / "o")
    result = flyby(*words(panel, *robot))
    assert result.exit_code == 1
    assert "have to be kept" in result.output and "is not written" in result.output
    assert not (tmp_path / "o" / "paint.mod").exists()
    result = flyby(*words(panel, *robot, "--unproven", "--force"))
    assert result.exit_code == 1
    assert (tmp_path / "o" / "paint.mod").exists()


@pytest.mark.parametrize(
    ("status", "more", "message"),
    [
        (2, ("--target", "50"), "a thickness with its unit"),
        (2, ("--target", "xum"), "a thickness with its unit"),
        (2, ("--speed", "800,50"), "least and largest in mm/s"),
        (2, ("--method", "spiral"), "--method spiral: raster or sideways"),
        (2, ("--view", "0,0"), "a direction x,y,z"),
        (2, ("--sweep", "-3"), "a length in mm above zero"),
        (2, ("--tilt", "90"), "degrees between 0 and 80"),
        (2, ("--points", "3"), "a number from 100 on"),
        (2, ("--delay", "30"), "name its switch by --signal"),
        (2, ("--robot", ROBOT), "where does the part stand?"),
        (2, ("--coats", "two"), "--coats two: one or crossed"),
        (2, ("--inside", "1,2,3"), "two corners of a box in mm"),
        (2, ("--facing", "0"), "degrees above 0, 180 at most"),
        (1, ("--target", "5mm"), "at the least speed of 50 mm/s along the first curve"),
        (1, ("--step", "0.5"), "1500 segments are the most"),
        (2, ("--errors", "5"), "height in mm and radius in %"),
        (2, ("--tool", "gun"), "name it by --robot or --cell"),
        (
            1,
            ("--robot", "ur/ur10e", "--place", "500,0,100", "--signal", "1"),
            "no actions at a place",
        ),
        (
            1,
            ("--robot", ROBOT, "--place", "0,0,0", "--signal", "doGun", "--delay", "600"),
            "up to 0.5 s ahead",
        ),
    ],
)
def test_what_is_refused(
    flyby: Flyby, panel: tuple[Path, Path], status: int, more: tuple[str, ...], message: str
):
    result = flyby(*words(panel, *more))
    assert result.exit_code == status
    assert message in result.output.replace("\n", " ")
