"""docs/guides/check.md lists the rules that there are."""

from __future__ import annotations

import re
from pathlib import Path

from flyby.core.lint.check import rules

PAGE = (Path(__file__).parents[3] / "docs" / "guides" / "check.md").read_text("utf-8")


def test_the_page_lists_every_rule_as_it_is() -> None:
    rows = re.findall(r"^\| `([a-z-]+)` \| (\w+) \| (.+) \|$", PAGE, re.MULTILINE)
    assert {name: (severity, text) for name, severity, text in rows} == {
        name: (str(severity), text) for name, (severity, text) in rules().items()
    }
