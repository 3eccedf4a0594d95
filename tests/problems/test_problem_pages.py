"""What the pages on optimal control, velocity tuning and energy show in Python runs as shown."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]
SNIPPETS = {
    f"{page}-{k}": text
    for page in ("free_motion", "velocity_tuning", "energy")
    for k, text in enumerate(
        re.findall(
            r"```python\n(.*?)```", (ROOT / f"docs/guides/{page}.md").read_text("utf-8"), re.DOTALL
        )
    )
}


def test_every_page_shows_something() -> None:
    assert {name.split("-")[0] for name in SNIPPETS} == {
        "free_motion",
        "velocity_tuning",
        "energy",
    }


@pytest.mark.parametrize("name", SNIPPETS)
def test_a_snippet_runs(
    name: str, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.chdir(ROOT)
    exec(compile(SNIPPETS[name], name, "exec"), {})
    assert capsys.readouterr().out
