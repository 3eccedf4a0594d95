"""Property tests try the same examples wherever and whenever they run; exploring ones do not."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

import pytest

CONFTEST = Path(__file__).parents[1] / "conftest.py"
PROPERTY = """
from pathlib import Path
{imports}
from hypothesis import given, strategies as st

@given(st.integers(), st.floats(), st.text(max_size=5))
def test_nothing(whole, real, text):
    with Path("seen").open("a") as seen:
        print(whole, real, ascii(text), file=seen)
"""


def tried(folder: Path, imports: str, *options: str) -> str:
    """The examples of one run, in a folder that the next run finds as this one has left it."""
    (folder / "conftest.py").write_text(CONFTEST.read_text())
    # A module of the user's own, in which Hypothesis would look for numbers.
    (folder / "odd.py").write_text("NUMBERS = 918273645, 0.918273645, 'odd'\n" * 40)
    (folder / "test_it.py").write_text(PROPERTY.format(imports=imports))
    (folder / "seen").unlink(missing_ok=True)
    command = [sys.executable, "-m", "pytest", "-q", "-p", "no:cacheprovider", *options]
    subprocess.run(command, cwd=folder, check=True, capture_output=True)
    return (folder / "seen").read_text()


def test_what_else_is_imported_and_when_does_not_matter(tmp_path: Path) -> None:
    first = tried(tmp_path, "")
    assert len(first.splitlines()) >= 50
    assert tried(tmp_path, "import odd") == first


def test_fresh_seeds_are_an_option(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("CI", "true")  # which Hypothesis reads, and then has no fresh seeds itself
    option = "--hypothesis-profile=explore"
    assert tried(tmp_path, "", option) != tried(tmp_path, "", option)
