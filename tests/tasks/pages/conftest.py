"""A real browser that is off the net; where there is none, tests are skipped and say so."""

from __future__ import annotations

import shutil
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import pytest

PLACES = ("/usr/bin/chromium", "chromium", "chromium-browser", "google-chrome")
SOFTWARE = ["--use-gl=angle", "--use-angle=swiftshader", "--enable-unsafe-swiftshader"]
"""Flags by which WebGL is drawn without a graphics card."""
Opened = Callable[..., Any]


@pytest.fixture(scope="session")
def browser() -> Iterator[Any]:
    """Headless Chromium."""
    driver = pytest.importorskip(
        "playwright.sync_api", reason="Playwright is not installed: the page is not tested"
    )
    found = next(filter(None, map(shutil.which, PLACES)), None)
    if found is None:
        pytest.skip(f"no browser is here ({', '.join(PLACES)}): the page is not tested in one")
    with driver.sync_playwright() as playwright:
        launched = playwright.chromium.launch(executable_path=found, args=SOFTWARE)
        yield launched
        launched.close()


@pytest.fixture
def opened(browser: Any, tmp_path: Path) -> Iterator[Opened]:
    """Opens the bytes of a page from a file; at the end nothing may have gone wrong."""
    contexts, wrong = [], []

    def open_it(page: bytes, **options: Any) -> Any:
        path = tmp_path / f"page{len(contexts)}.html"
        path.write_bytes(page)
        size = options.pop("viewport", {"width": 1280, "height": 720})
        context = browser.new_context(offline=True, viewport=size, **options)
        contexts.append(context)
        view = context.new_page()
        own = path.resolve().as_uri()
        view.on("request", lambda r: None if r.url.split("#")[0] == own else wrong.append(r.url))
        view.on("pageerror", lambda error: wrong.append(str(error)))
        view.on(
            "console",
            lambda m: wrong.append(m.text) if m.type in ("error", "warning") else None,
        )
        view.goto(own)
        view.evaluate("flyby.ready.then(() => true)")
        return view

    yield open_it
    for context in contexts:
        context.close()
    assert not wrong
