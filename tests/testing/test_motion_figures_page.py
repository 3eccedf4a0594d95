"""docs/reference/motion_figures.md holds the table of all figures of a motion model.

`python tests/testing/test_motion_figures_page.py` writes it anew.
"""

from __future__ import annotations

from pathlib import Path

from flyby.core.motion.model.figures import Figure, FitRange, Member, Tables
from flyby.core.motion.model.kinds import RealNumber, Row
from flyby.core.motion.model.motion_model import FIGURES

PAGE = Path(__file__).parents[2] / "docs" / "reference" / "motion_figures.md"
HEAD = "| key | what it is | unit | what it may be | for each | without | enters | fitted within |"


def rows() -> list[str]:
    """The table's lines, one for each figure and for each member of one of several tables."""
    found = [HEAD, "|" + "---|" * HEAD.count(" | ") + "---|"]
    for key, one in FIGURES.items():
        found.append(line(key, one, neutral(one), one.stage.name.lower()))
        if isinstance(one.kind, Tables):
            found += [line(f"{key}[…].{m.key}", m, "", "") for m in one.kind.members]
    return found


def line(key: str, one: Figure | Member, without: str, stage: str) -> str:
    per = one.kind.per if isinstance(one.kind, Row) else ""
    entries = f"`{key}`", one.help, one.unit, str(one.kind), per, without, stage, fitted(one.fit)
    return f"| {' | '.join(entries)} |"


def neutral(one: Figure) -> str:
    """What stands for nothing; of lists, what an entry does that is not stated."""
    if isinstance(one.kind, Row) and not one.neutral:
        return f"{one.kind.neutral:g}"
    entry = one.kind.entry(one.neutral)
    return "none" if entry in ([], "none") else str(entry)


def fitted(fit: FitRange | None) -> str:
    if fit is None:
        return ""
    if fit.upper == float("inf"):
        return f"{fit.lower:g} and more"
    return f"{fit.lower:g} to {fit.upper:g}"


def test_the_page_is_the_table() -> None:
    written = [text for text in PAGE.read_text("utf-8").splitlines() if text.startswith("|")]
    assert written == rows()
    assert sum(isinstance(one.kind, RealNumber | Row) for one in FIGURES.values()) > 20


if __name__ == "__main__":
    kept = [text for text in PAGE.read_text("utf-8").splitlines() if not text.startswith("|")]
    PAGE.write_text("\n".join([*kept, *rows()]) + "\n", "utf-8")
