"""The pictures of docs/examples.md can be drawn from the shipped examples, and are shown."""

from __future__ import annotations

import runpy
from pathlib import Path

ROOT = Path(__file__).parents[2]
LARGEST = 250_000
"""Bytes of a picture on the page."""


def test_the_pictures_of_the_examples_can_be_drawn(tmp_path: Path) -> None:
    script = runpy.run_path(str(ROOT / "docs" / "pictures" / "plot_examples.py"))
    page = (ROOT / "docs" / "examples.md").read_text("utf-8")
    for name in script["PICTURES"]:
        shown = ROOT / "docs" / "pictures" / f"{name}.png"
        assert f"(pictures/{name}.png)" in page and shown.stat().st_size < LARGEST
    script["main"](str(tmp_path), ("example_abb", "example_ur", "example_station"))
    # That of KUKA is the zones' own test.
    drawn = {path.stem for path in tmp_path.iterdir()}
    assert drawn == {"example_abb", "example_ur", "example_station"}
    assert all(path.read_bytes()[:4] == b"\x89PNG" for path in tmp_path.iterdir())
