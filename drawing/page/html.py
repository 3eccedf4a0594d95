"""The file of a page: one HTML document that asks nothing of any network.

Its script is the viewer as built from ``viewer/``; what a page shows stands beside it as data,
which no browser runs: the document's policy allows the viewer's script alone, by its digest.
"""

from __future__ import annotations

import base64
import hashlib
import html
from functools import cache
from importlib import resources

from ...core.display import shown
from .content import (
    Page,
)
from .packing import Packer

_TEMPLATE = """<!doctype html>
<html lang="en">
<head>
<meta charset="utf-8">
<meta http-equiv="Content-Security-Policy" content="{policy}">
<meta name="viewport" content="width=device-width, initial-scale=1">
<meta name="generator" content="{made_by}">
<title>{title}</title>
</head>
<body>
<noscript>This page draws itself: it needs JavaScript, and no network.</noscript>
<script type="application/json" id="page">{page}</script>
<script type="text/plain" id="arrays">{arrays}</script>
<script>{viewer}</script>
</body>
</html>
"""
HEIGHT = 720
"""Pixels of a page in a notebook."""


def page_html(page: Page) -> bytes:
    """The file of a page."""
    packer = Packer()
    content = packer.json(page)
    script = viewer()
    made = _TEMPLATE.format(
        policy=_policy(script),
        made_by=html.escape(page.made_by),
        title=html.escape(shown(page.title)),
        page=content,
        arrays=packer.arrays(),
        viewer=script,
    )
    return made.encode()


def page_frame(page: bytes) -> str:
    """A page in a frame, for notebooks."""
    content = html.escape(page.decode(), quote=True)
    style = f"width:100%;height:{HEIGHT}px;border:1px solid #8886"
    return f'<iframe sandbox="allow-scripts" style="{style}" srcdoc="{content}"></iframe>'


@cache
def viewer() -> str:
    """The viewer's script, with ends of line as it was built with."""
    data = resources.files(__package__).joinpath("data/viewer.js").read_bytes()
    return data.decode("utf-8").replace("\r\n", "\n")


def _policy(script: str) -> str:
    digest = base64.b64encode(hashlib.sha256(script.encode()).digest()).decode()
    return (
        f"default-src 'none'; script-src 'sha256-{digest}'; style-src 'unsafe-inline'; "
        "img-src data: blob:"
    )
