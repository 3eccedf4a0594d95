"""The example on the page about collisions runs."""

from __future__ import annotations

import re
from pathlib import Path

import numpy as np
import pytest

PAGE = Path(__file__).parents[3] / "docs" / "reference" / "collision.md"
CELL = """
robot = "ur/ur5"

[tool.gun]
tcp = { xyz_mm = [0, 0, 150] }
capsule_mm = [30, 120]
pose = { xyz_mm = [0, 0, 90] }

[[obstacle]]
name = "post"
box_mm = [200, 200, 900]
pose = { xyz_mm = [-600, 100, 450] }
"""


def test_the_documented_calls_run(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    (code,) = re.findall(r"```python\n(.*?)```", PAGE.read_text("utf-8"), re.DOTALL)
    (tmp_path / "cell.toml").write_text(CELL, "utf-8")
    monkeypatch.chdir(tmp_path)
    many = np.random.default_rng(0).uniform(-1.0, 1.0, (50, 6))
    names = {"q": many[0], "many": many}
    exec(code, names)
    samples, pairs = names["which"]
    assert len(samples) > 0
    assert len(samples) == len(pairs)
