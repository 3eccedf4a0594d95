"""Pages for people: Markdown and HTML from templates that escape every value they are given.

Names of files, runs, tools and figures come from anywhere, and may be written to be run by what
shows the page. Templates alone hold marks; values are text, whatever they look like.
"""

from __future__ import annotations

import re
from functools import cache
from typing import Any

from jinja2 import Environment, StrictUndefined
from markupsafe import Markup, escape

from ..core.display import shown

_MARKS = re.compile(r"([\\`\[\]|])")
"""Of Markdown, those that could begin a link or end a cell; HTML is escaped as in HTML."""


def render_markdown(template: str, **values: Any) -> str:
    """A page of Markdown; every value stays on one line, so that it begins no block."""
    return _environment().from_string(template).render(values)


def render_html(template: str, **values: Any) -> str:
    """A page of HTML."""
    environment = _environment().overlay(finalize=lambda value: _text(value))
    return environment.from_string(template).render(values)


@cache
def _environment() -> Environment:
    return Environment(
        autoescape=True,
        undefined=StrictUndefined,
        trim_blocks=True,
        lstrip_blocks=True,
        keep_trailing_newline=True,
        finalize=_line,
    )


def _text(value: Any) -> Any:
    return value if isinstance(value, Markup) else shown(str(value))


def _line(value: Any) -> Any:
    if isinstance(value, Markup):
        return value
    told = shown(" ".join(str(value).split()))
    return Markup(_MARKS.sub(r"\\\1", str(escape(told)).replace("&#39;", "'")))
