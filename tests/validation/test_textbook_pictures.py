"""The textbook problems' pictures can be drawn, and are shown in docs/reference/sqp.md."""

from __future__ import annotations

import runpy
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]


# Few nodes: what many show is tested with the problem itself.
ARGUMENTS = {"cubic": {}, "double_integrator": {}, "point_mass": {"counts": (12, 16, 20)}}


@pytest.mark.parametrize("name", ARGUMENTS)
def test_the_picture_can_be_drawn(name: str, tmp_path: Path) -> None:
    picture = tmp_path / f"{name}.png"
    example = runpy.run_path(str(ROOT / "docs" / "pictures" / f"plot_{name}.py"))
    example["main"](str(picture), **ARGUMENTS[name])
    assert picture.read_bytes()[:4] == b"\x89PNG"
    assert f"pictures/{name}.png)" in (ROOT / "docs" / "measurements" / "solver.md").read_text(
        "utf-8"
    )
    assert (ROOT / "docs" / "pictures" / f"{name}.png").exists()
