"""What ``flyby new-vendor`` writes is a plugin, and passes its own tests."""

from __future__ import annotations

import re
import subprocess
import sys
from pathlib import Path

import pytest

from flyby.core.errors import InputError
from flyby.tasks.files.new_vendor import new_vendor


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    place = tmp_path_factory.mktemp("made") / "flyby-zeta"
    new_vendor("zeta", place)
    return place


def test_it_is_a_distribution(folder: Path) -> None:
    files = {path.relative_to(folder).as_posix() for path in folder.rglob("*") if path.is_file()}
    assert {"pyproject.toml", "README.md", "src/flyby_zeta/plugin.py"} <= files
    texts = [path.read_text("utf-8") for path in folder.rglob("*") if path.is_file()]
    assert not any(re.search(r"@\w+@", text) for text in texts)


def test_it_passes_its_own_tests(folder: Path) -> None:
    made = subprocess.run(
        [sys.executable, "-m", "pytest", "-q", "-n", "0", "-p", "no:cacheprovider", "tests"],
        cwd=folder,
        env={"PYTHONPATH": str(folder / "src"), "PATH": ""},
        capture_output=True,
        text=True,
        check=False,
    )
    assert made.returncode == 0, made.stdout[-3000:]


@pytest.mark.parametrize(
    ("name", "said"), [("Zeta", "lower-case"), ("abb", "is installed already"), ("1a", "letter")]
)
def test_a_name_that_is_none_is_refused(name: str, said: str, tmp_path: Path) -> None:
    with pytest.raises(InputError, match=said):
        new_vendor(name, tmp_path / "x")


def test_nothing_is_overwritten(folder: Path) -> None:
    with pytest.raises(InputError, match="no empty folder"):
        new_vendor("zeta", folder)
