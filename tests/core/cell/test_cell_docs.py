"""The page about the cell file shows a cell that can be read."""

from __future__ import annotations

import re
from pathlib import Path

import trimesh

from flyby.core.cell.file import load_cell
from flyby.core.registry import installed

PAGE = Path(__file__).parents[3] / "docs" / "reference" / "cell.md"


def test_the_documented_cell_can_be_read(tmp_path: Path) -> None:
    (text,) = re.findall(r"```toml\n(.*?)```", PAGE.read_text("utf-8"), re.DOTALL)
    text = text.replace('carried_by = "tilt"', "# no tilting axis in this copy")
    (tmp_path / "cell.toml").write_text(text, "utf-8")
    for name in ("gun.stl", "fixture.stl"):
        trimesh.creation.box((100, 100, 100)).export(tmp_path / name)
    cell = load_cell(tmp_path / "cell.toml", installed())
    assert cell.robot.name == "abb/irb6640-180-255"
    assert set(cell.tools) == {"tool0", "gun"}
    assert [obstacle.name for obstacle in cell.obstacles] == ["fixture", "wall"]
    assert cell.check_meshes() == ()
