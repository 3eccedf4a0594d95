"""docs/reference/motion.md says what the code and the vendors' files say."""

from __future__ import annotations

import re
import subprocess
import sys
from pathlib import Path

import pytest

from flyby.core.motion.model.blend import Blend
from flyby.core.motion.model.rules import LineTurn, OrientationZone, Overlap, Pace
from flyby.core.registry import find_vendor

ROOT = Path(__file__).parents[2]
PAGE = (ROOT / "docs" / "reference" / "motion.md").read_text("utf-8")
ROWS = {
    "blend of the TCP": "blend.tcp.kind",
    "blend of joints": "blend.joint.kind",
    "neighbours": "zone.overlap",
    "orientation": "zone.orientation",
    "TCP move next to a pure turn": "zone.stops_at_pure_reorientation",
    "period": "period_s",
    "averages over the joints": "time.smoothing_s",
}
VENDORS = ("abb", "kuka", "ur")


def cells(row: str) -> list[str]:
    (line,) = re.findall(rf"^\| {re.escape(row)} \|(.*)\|$", PAGE, re.MULTILINE)
    return [cell.strip() for cell in line.split("|")]


@pytest.mark.parametrize("row", sorted(ROWS))
def test_the_vendors_table_states_their_provenance(row: str) -> None:
    for cell, name in zip(cells(row), VENDORS, strict=True):
        status = find_vendor(name).motion().provenance[ROWS[row]].status
        assert f"({status}" in cell, (name, row)


def test_the_vendors_table_states_their_rules() -> None:
    words = {Overlap.HALF: ("half way", "the same"), Overlap.SKIP: ("left out",)}
    for k, name in enumerate(VENDORS):
        model = find_vendor(name).motion()
        assert any(word in cells("neighbours")[k] for word in words[model.overlap])
        own = model.orientation_zone is OrientationZone.OWN
        assert own == ("of its own" in cells("orientation")[k])
        stops = cells("TCP move next to a pure turn")[k].startswith("stop")
        assert stops == model.stops_at_pure_reorientation
        assert cells("period")[k].startswith(f"{1e3 * model.period:g} ms")
        assert ("arc" in cells("blend of the TCP")[k]) == (model.tcp.kind == "arc")
        averages = cells("averages over the joints")[k]
        widths = " × ".join(
            (str(len(model.smoothing)), *(f"{1e3 * w:g}" for w in {*model.smoothing}))
        )
        assert averages.startswith(widths if model.smoothing else "none")
        superposed = model.pace is Pace.SUPERPOSED
        assert superposed == ("superposed (fitted)" in cells("legs in a zone")[k])
        assert cells("turn along lines")[k].startswith(
            "by swivel and rotation" if model.line_turn is LineTurn.SWIVEL else "about one axis"
        )
        assert model.jerk is None


def test_all_laws_of_the_table_pass_the_same_apex() -> None:
    laws = [(0, 1), (0, 0, 3, -2), (0, 0, 0, 10, -15, 6), (0, 0, 0, 0, 35, -84, 70, -20)]
    powers = "⁰¹²³⁴⁵⁶⁷"
    for alpha in laws:
        terms = [
            f"{abs(a) if abs(a) > 1 else ''}s{powers[i] if i > 1 else ''}"
            for i, a in enumerate(alpha)
            if a
        ]
        assert all(term in PAGE for term in terms)
        table = Blend(alpha=alpha).coefficients
        f, g = (sum(c * 0.5**i for i, c in enumerate(table[row])) for row in (1, 2))
        assert (f, g) == pytest.approx((0.75, 0.25))


def test_the_figure_can_be_drawn(tmp_path: Path) -> None:
    script = ROOT / "docs" / "pictures" / "plot_blends.py"
    subprocess.run([sys.executable, str(script), str(tmp_path / "blends.png")], check=True)
    assert (tmp_path / "blends.png").read_bytes()[:4] == b"\x89PNG"
    assert "blends.png" in PAGE and (ROOT / "docs" / "pictures" / "blends.png").exists()
