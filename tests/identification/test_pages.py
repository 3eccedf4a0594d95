"""Text that comes into pages stays text, whatever it looks like."""

from __future__ import annotations

import pytest

from flyby.identification.pages import render_markdown

HOSTILE = (
    "x<img src=x onerror=alert(1)>.json",
    '"><script>alert(1)</script>',
    "</pre><svg onload=alert(1)>",
    "{{ 7 * 7 }}{% raw %}",
    "' onmouseover='alert(1)",
    "a & b &lt;script&gt;",
    "\x1b[31m\x00",
)


@pytest.mark.parametrize("told", [*HOSTILE, "[a](javascript:alert(1))", "a|b\n\n# c", "`x`"])
def test_markdown_holds_what_it_is_told_as_text_on_one_line(told: str) -> None:
    page = render_markdown("| {{ told }} |\n", told=told)
    assert page.count("\n") == 1
    assert "<" not in page and ">" not in page
    inside = page[1:-2]
    for k, letter in enumerate(inside):
        assert letter not in "[]|`" or inside[k - 1] == "\\"
    assert not any(ord(letter) < 32 for letter in inside)
