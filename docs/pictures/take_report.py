"""report.png: the page of examples/pick.script, as headless Chromium shows it."""

from __future__ import annotations

import tempfile
from pathlib import Path

from playwright.sync_api import sync_playwright

import flyby

HERE = Path(__file__).parent
EXAMPLES = HERE.parents[1] / "examples"
FLAGS = ["--use-gl=angle", "--use-angle=swiftshader", "--enable-unsafe-swiftshader"]
AT = 5.2
"""s."""

program = flyby.read(EXAMPLES / "pick.script", cell=EXAMPLES / "cell/pick.toml")
run = flyby.emulate(program)
with tempfile.TemporaryDirectory() as folder, sync_playwright() as playwright:
    page = flyby.report(run, Path(folder) / "page.html")
    browser = playwright.chromium.launch(executable_path="/usr/bin/chromium", args=FLAGS)
    view = browser.new_page(viewport={"width": 1280, "height": 720})
    view.goto(f"{page.as_uri()}#t={AT}")
    view.evaluate("flyby.ready.then(() => true)")
    view.wait_for_timeout(500)
    view.screenshot(path=HERE / "report.png")
    browser.close()
