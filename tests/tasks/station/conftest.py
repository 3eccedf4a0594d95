"""Stations as files."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

import pytest

from .stations import Write, module


@pytest.fixture
def write(tmp_path: Path) -> Write:
    """Writes a station of robots far apart."""

    def made(
        programs: dict[str, Sequence[str]], rest: str = "", gap: float = 9000.0, before: str = ""
    ) -> Path:
        text = f"clearance_mm = 10\n{before}"
        for k, (name, statements) in enumerate(programs.items()):
            turned = "[0, 0, 0, 1]" if k % 2 else "[1, 0, 0, 0]"
            base = f"{{ xyz_mm = [{k * gap}, 0, 0], quat_wxyz = {turned} }}"
            cell = f'robot = "abb/irb120-3-058"\nbase = {base}\n'
            (tmp_path / f"{name}.toml").write_text(cell)
            (tmp_path / f"{name}.mod").write_text(module(name, statements))
            text += f'[robot.{name}]\ncell = "{name}.toml"\nprogram = "{name}.mod"\n'
        file = tmp_path / "station.toml"
        file.write_text(text + rest)
        return file

    return made
