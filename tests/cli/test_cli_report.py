"""``--report`` and ``flyby view``: what the pages of the commands hold."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest
from typer.testing import Result

from ..drawing.page.unpacking import content_of
from .box_program import module
from .test_cli_compare import log  # noqa: F401  a fixture of these tests too

ROOT = Path(__file__).parents[2]
ROBOT = "abb/irb6640-180-255"
SQUARE = ROOT / "examples" / "square.mod"

Flyby = Callable[..., Result]


def page(flyby: Flyby, tmp_path: Path, *words: object, status: int = 0) -> dict[str, Any]:
    """What the page holds that a command writes."""
    path = tmp_path / "page.html"
    result = flyby(*words, "--report", path)
    assert result.exit_code == status, result.output
    assert f"wrote {path}" in result.output
    return content_of(path.read_bytes())[0]


def titles(found: dict[str, Any]) -> list[str]:
    return [table["title"] for table in found["tables"]]


def test_emulate(flyby: Flyby, tmp_path: Path) -> None:
    found = page(flyby, tmp_path, "emulate", SQUARE, "--robot", ROBOT)
    assert found["kind"] == "emulate" and found["title"] == f"Square on {ROBOT}"
    assert titles(found)[:3] == ["Causes", "Lines", "Moves"]
    (track,) = found["tracks"]
    assert [move["number"] for move in track["moves"]] == list(range(1, 8))
    assert track["moves"][3]["line"] == 10
    assert found["sources"][0]["text"].splitlines()[9].strip().startswith("MoveL")
    assert found["facts"]["cycle time"].endswith(" s")
    names = {channel["chart"] for channel in track["channels"]}
    assert {"speed", "torque", "energy", "push"} <= names


def test_a_program_with_a_fault_says_so(flyby: Flyby, tmp_path: Path) -> None:
    text = SQUARE.read_text("utf-8").replace("Offs(p1,200,200,0)", "Offs(p1,9000,200,0)")
    path = tmp_path / "far.mod"
    path.write_text(text, "utf-8")
    found = page(flyby, tmp_path, "emulate", path, "--robot", ROBOT, status=1)
    assert "Faults" in titles(found)
    assert found["notes"] == [
        "1 move cannot be driven, the first is move 4, line 10 (reach): no time is claimed across "
        "them, see Faults"
    ]
    assert [m["number"] for m in found["tracks"][0]["moves"] if m.get("fault")] == [4]
    assert "cycle time" not in found["facts"]


@pytest.fixture
def box(tmp_path: Path) -> Path:
    path = tmp_path / "box.mod"
    moves = [f"MoveAbsJ p{k},v1000,z10,rod;" for k in (1, 2, 3)]
    path.write_text(module(*moves), "utf-8", newline="")
    return path


def test_zones(flyby: Flyby, tmp_path: Path, box: Path, cell: Path) -> None:
    found = page(flyby, tmp_path, "zones", box, "--cell", cell)
    before, after = found["tracks"]
    assert (before["name"], before["ghost"], after["name"]) == ("before", True, "after")
    assert after["duration"] < before["duration"]
    assert after["proof"]["proven"] and len(after["proof"]["first"]) == 3
    changes = found["tables"][0]
    assert changes["title"] == "Changes"
    saved = [row["cells"][4] for row in changes["rows"]]
    assert saved == sorted(saved, reverse=True) and saved[0] > 0.0
    assert sum(saved) == pytest.approx(before["duration"] - after["duration"], abs=2e-3)
    assert {source.get("track", 0) for source in found["sources"]} == {0, 1}
    assert before["meets"]["n"] == after["meets"]["n"] > 3


def test_a_program_that_stays_as_it_is(flyby: Flyby, tmp_path: Path, box: Path, cell: Path) -> None:
    out = tmp_path / "out"
    assert flyby("zones", box, "--cell", cell, "--out", out).exit_code == 0
    found = page(flyby, tmp_path, "zones", out / box.name, "--cell", cell)
    if len(found["tracks"]) == 2:  # by some hundredths of a millimetre
        assert found["tracks"][0]["duration"] - found["tracks"][1]["duration"] < 2e-3
        return
    assert found["facts"]["change"] == "nothing better was found"


def test_check(flyby: Flyby, tmp_path: Path) -> None:
    cell = ROOT / "examples/cell/pick.toml"
    found = page(flyby, tmp_path, "check", ROOT / "examples/pick.script", "--cell", cell)
    findings = found["tables"][0]
    assert findings["title"] == "Findings"
    (near,) = (row for row in findings["rows"] if row["line"] == 18)
    assert near["level"] == "note" and near["t"] > 0.0
    parts = found["tracks"][0]["parts"]
    assert [part["name"] for part in parts] == ["bottle 1", "bottle 2"]
    assert any(place["node"] == found["arms"][0]["flange"] for place in parts[0]["places"])


def test_a_program_that_cannot_be_read_has_a_page_of_its_findings(
    flyby: Flyby, tmp_path: Path
) -> None:
    path = tmp_path / "broken.mod"
    path.write_text("MODULE m\n  PROC main(\n", "utf-8")
    found = page(flyby, tmp_path, "check", path, "--robot", ROBOT, status=1)
    assert found["tables"][0]["rows"][0]["level"] == "error"
    assert "tracks" not in found


def test_diff(flyby: Flyby, tmp_path: Path) -> None:
    other = tmp_path / "other.mod"
    other.write_text(SQUARE.read_text("utf-8").replace("z20", "z50"), "utf-8")
    found = page(flyby, tmp_path, "diff", SQUARE, other, "--robot", ROBOT, status=1)
    assert [(track["name"], track["group"]) for track in found["tracks"]] == [
        ("before", "main"),
        ("after", "main"),
    ]
    assert titles(found)[:3] == ["Routines", "Differences", "Files"]


def test_translate(flyby: Flyby, tmp_path: Path) -> None:
    found = page(
        flyby,
        tmp_path,
        *("translate", SQUARE, "--from", ROBOT, "--robot", "kuka/kr30-3"),
    )
    assert [arm["name"] for arm in found["arms"]] == [ROBOT, "kuka/kr30-3"]
    assert [track["arm"] for track in found["tracks"]] == [0, 1]
    after = found["tracks"][1]["moves"]
    texts = {k: source["text"].splitlines() for k, source in enumerate(found["sources"])}
    assert all(move["line"] for move in after)
    for move in after:
        assert texts[move["source"]][move["line"] - 1].split()[0] in ("PTP", "LIN")


def test_compare(flyby: Flyby, tmp_path: Path, log: Path) -> None:  # noqa: F811
    found = page(flyby, tmp_path, "compare", SQUARE, log, "--robot", ROBOT)
    emulated, measured = found["tracks"]
    assert (emulated["name"], measured["name"], measured["ghost"]) == ("emulated", "measured", True)
    assert {channel["chart"] for channel in measured["channels"]} == {"apart", "late", "speed"}
    assert found["charts"][0]["key"] == "apart"


def test_pareto(flyby: Flyby, tmp_path: Path) -> None:
    found = page(flyby, tmp_path, "pareto", SQUARE, "--robot", ROBOT, "--points", 2)
    points = found["front"]["points"]
    assert points[0]["name"] == "given" and points[0]["track"] == 0
    assert len(points) == len(found["tracks"]) == len(found["tables"][0]["rows"])


def test_an_existing_page_is_kept(flyby: Flyby, tmp_path: Path) -> None:
    path = tmp_path / "page.html"
    path.write_text("mine", "utf-8")
    words = ("emulate", SQUARE, "--robot", ROBOT, "--report", path)
    result = flyby(*words)
    assert result.exit_code == 1 and "--force" in result.output
    assert path.read_text("utf-8") == "mine"
    assert flyby(*words, "--force").exit_code == 0
    assert path.read_bytes().startswith(b"<!doctype html>")


@pytest.mark.parametrize("command", ["emulate", "check", "zones", "optimize", "pareto"])
def test_a_page_is_called_as_one(flyby: Flyby, tmp_path: Path, command: str) -> None:
    result = flyby(command, SQUARE, "--robot", ROBOT, "--report", tmp_path / "page.pdf")
    assert result.exit_code == 2
    assert "the name must end in .html or .htm" in result.output


def test_a_page_of_all_entries_is_refused(flyby: Flyby, tmp_path: Path) -> None:
    words = ("--robot", ROBOT, "--entry", "all", "--report", tmp_path / "page.html")
    result = flyby("emulate", SQUARE, *words)
    assert result.exit_code == 2 and "--report is of one program" in result.output


def test_view_says_where_the_page_is(flyby: Flyby, monkeypatch: pytest.MonkeyPatch) -> None:
    opened: list[str] = []
    monkeypatch.setattr("webbrowser.open", lambda url: opened.append(url) or True)
    result = flyby("view", SQUARE, "--robot", ROBOT)
    assert result.exit_code == 0, result.output
    (path,) = (Path(line) for line in result.stdout.splitlines() if line.endswith(".html"))
    assert path.name == "square.html" and opened == [path.as_uri()]
    assert content_of(path.read_bytes())[0]["title"] == f"Square on {ROBOT}"


def test_view_without_a_browser(flyby: Flyby, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("webbrowser.open", lambda url: False)
    result = flyby("view", SQUARE, "--robot", ROBOT)
    assert result.exit_code == 0
    assert "open the page yourself" in result.output
    assert "no browser" not in flyby("view", SQUARE, "--robot", ROBOT, "--no-browser").output
