"""The textbook problems' pictures can be drawn, and are shown in docs/sqp.md."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]


@pytest.mark.parametrize("name", ["cubic", "double_integrator", "point_mass"])
def test_the_picture_can_be_drawn(name: str, tmp_path: Path) -> None:
    picture = tmp_path / f"{name}.png"
    script = ROOT / "examples" / f"plot_{name}.py"
    subprocess.run([sys.executable, str(script), str(picture)], check=True)
    assert picture.read_bytes()[:4] == b"\x89PNG"
    assert f"({name}.png)" in (ROOT / "docs" / "sqp.md").read_text("utf-8")
    assert (ROOT / "docs" / f"{name}.png").exists()
