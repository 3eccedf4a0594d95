"""Pictures hold names as they stand, and the same picture is the same file."""

from __future__ import annotations

import ast
import re
from datetime import UTC, datetime
from pathlib import Path
from xml.etree import ElementTree

import matplotlib
import pytest
from matplotlib.figure import Figure

import flyby
from flyby.drawing.style import STYLE, figure_file

KINDS = ("png", "pdf", "svg")
NAMES = (
    "a$x$b", "$", "$\\frac{", "$\\notacommand$", "<script>alert(1)</script>", "x & y", "\x1b[1m",
    "\ud800", "名前",
)  # fmt: skip


def _figure(name: str) -> Figure:
    figure = Figure(figsize=(4, 3), layout="constrained")
    axes = figure.subplots()
    axes.plot([0, 1], [0, 1], label=name)
    axes.annotate(name, (0, 0))
    axes.set_title(name)
    axes.legend()
    figure.suptitle(f"{name} on a robot: 1 $ 2 $")
    return figure


@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.parametrize("name", NAMES)
def test_any_name_can_be_drawn(name: str, kind: str) -> None:
    with matplotlib.rc_context(STYLE):
        assert figure_file(_figure(name), kind)


@pytest.mark.parametrize("name", NAMES)
def test_svg_holds_names_as_text(name: str) -> None:
    with matplotlib.rc_context({**STYLE, "svg.fonttype": "none"}):
        made = figure_file(_figure(name), "svg")
    root = ElementTree.fromstring(made)
    told = {"".join(one.itertext()) for one in root.iter("{http://www.w3.org/2000/svg}text")}
    shown = re.sub("[\x1b\ud800]", "\ufffd", name)
    assert shown in told
    assert not list(root.iter("{http://www.w3.org/2000/svg}script"))


@pytest.mark.parametrize("kind", KINDS)
def test_files_bear_no_date_and_are_the_same_again(
    kind: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    made = []
    for epoch in ("1", "1000000000"):
        monkeypatch.setenv("SOURCE_DATE_EPOCH", epoch)
        with matplotlib.rc_context(STYLE):
            made.append(figure_file(_figure("a"), kind))
    assert made[0] == made[1]
    monkeypatch.delenv("SOURCE_DATE_EPOCH")
    with matplotlib.rc_context(STYLE):
        again = figure_file(_figure("a"), kind)
    assert again == made[0]
    assert str(datetime.now(UTC).year).encode() not in again or kind == "png"


def test_pictures_are_saved_in_one_place() -> None:
    root = Path(next(iter(flyby.__path__)))
    found = []
    for room in ("cli", "core", "drawing", "identification", "problems", "testing", "vendors"):
        for file in (root / room).rglob("*.py"):
            for node in ast.walk(ast.parse(file.read_text("utf-8"))):
                if isinstance(node, ast.Attribute) and node.attr == "savefig":
                    found.append(str(file.relative_to(root)))
    assert found == ["drawing/style.py"]
