"""Text that comes into pages stays text, whatever it looks like."""

from __future__ import annotations

from html.parser import HTMLParser

import pytest
from hypothesis import given
from hypothesis import strategies as st

from flyby.identification.pages import render_html, render_markdown

HOSTILE = (
    "x<img src=x onerror=alert(1)>.json",
    '"><script>alert(1)</script>',
    "</pre><svg onload=alert(1)>",
    "{{ 7 * 7 }}{% raw %}",
    "' onmouseover='alert(1)",
    "a & b &lt;script&gt;",
    "\x1b[31m\x00",
)


class Seen(HTMLParser):
    def __init__(self) -> None:
        super().__init__()
        self.tags: list[tuple[str, list[tuple[str, str | None]]]] = []
        self.text = ""

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        self.tags.append((tag, attrs))

    def handle_data(self, data: str) -> None:
        self.text += data


@pytest.mark.parametrize("told", HOSTILE)
def test_html_holds_what_it_is_told_as_text(told: str) -> None:
    page = render_html('<p>{{ told }}</p><img alt="of {{ told }}">', told=told)
    seen = Seen()
    seen.feed(page)
    assert [tag for tag, _ in seen.tags] == ["p", "img"]
    shown = told.replace("\x1b", "\ufffd").replace("\x00", "\ufffd")
    assert seen.text == shown
    assert seen.tags[1][1] == [("alt", f"of {shown}")]


@given(st.text(max_size=60))
def test_html_is_never_more_than_its_template(told: str) -> None:
    seen = Seen()
    seen.feed(render_html("<b>{{ told }}</b>", told=told))
    assert [tag for tag, _ in seen.tags] == ["b"]


@pytest.mark.parametrize("told", [*HOSTILE, "[a](javascript:alert(1))", "a|b\n\n# c", "`x`"])
def test_markdown_holds_what_it_is_told_as_text_on_one_line(told: str) -> None:
    page = render_markdown("| {{ told }} |\n", told=told)
    assert page.count("\n") == 1
    assert "<" not in page and ">" not in page
    inside = page[1:-2]
    for k, letter in enumerate(inside):
        assert letter not in "[]|`" or inside[k - 1] == "\\"
    assert not any(ord(letter) < 32 for letter in inside)
