"""What ``flyby new-vendor`` writes is a plugin, and passes its own tests."""

from __future__ import annotations

import re
import shutil
import subprocess
import sys
import zipfile
from pathlib import Path

import pytest

from flyby.core.errors import InputError
from flyby.tasks.files.new_vendor import new_vendor

CHOSEN = "golden or word or planted or program_is_read"


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


def test_it_is_built_by_what_builds_flyby(folder: Path, tmp_path: Path) -> None:
    """Without a network: nothing is asked for but setuptools."""
    shutil.copytree(folder, tmp_path / "zeta")
    build = "import sys; from setuptools.build_meta import build_wheel as b; b(sys.argv[1])"
    command = [sys.executable, "-c", build, str(tmp_path)]
    subprocess.run(command, cwd=tmp_path / "zeta", check=True, capture_output=True)
    (wheel,) = tmp_path.glob("*.whl")
    with zipfile.ZipFile(wheel) as made:
        names = made.namelist()
        points = next(name for name in names if name.endswith("entry_points.txt"))
        assert "zeta = flyby_zeta.plugin" in made.read(points).decode()
    packed = {"flyby_zeta/language.py", "flyby_zeta/data/motion.toml"}
    assert {*packed, "flyby_zeta/data/robots/arm-1.toml"} <= set(names)


def own_tests(folder: Path, chosen: str) -> subprocess.CompletedProcess[str]:
    """Its own tests but those of the emulator, which FANUC's and Yaskawa's go through."""
    command = ["pytest", "-q", "-n", "0", "-p", "no:cacheprovider", "-k", chosen, "tests"]
    return subprocess.run(
        [sys.executable, "-m", *command],
        cwd=folder,
        env={"PYTHONPATH": str(folder / "src"), "PATH": ""},
        capture_output=True,
        text=True,
        check=False,
    )


def test_it_passes_its_own_tests(folder: Path) -> None:
    made = own_tests(folder, CHOSEN)
    assert made.returncode == 0, made.stdout[-3000:]
    assert int(re.findall(r"(\d+) passed", made.stdout)[0]) > 50


def test_its_own_tests_find_a_fault(folder: Path, tmp_path: Path) -> None:
    """Reader and writer are wrong alike: only the golden text shows it."""
    wrong = tmp_path / "wrong"
    shutil.copytree(folder, wrong)
    language = wrong / "src" / "flyby_zeta" / "language.py"
    text = language.read_text("utf-8")
    faulty = text.replace('Amount("tcp", 1e-3)', 'Amount("tcp", 1e-2)')
    assert faulty != text
    language.write_text(faulty, "utf-8")
    made = own_tests(wrong, "golden_texts_mean")
    assert made.returncode == 1
    assert "speed.tcp: 0.25 stated, 2.5 read" in made.stdout


@pytest.mark.parametrize(
    ("name", "said"), [("Zeta", "lower-case"), ("abb", "is installed already"), ("1a", "letter")]
)
def test_a_name_that_is_none_is_refused(name: str, said: str, tmp_path: Path) -> None:
    with pytest.raises(InputError, match=said):
        new_vendor(name, tmp_path / "x")


def test_nothing_is_overwritten(folder: Path) -> None:
    with pytest.raises(InputError, match="no empty folder"):
        new_vendor("zeta", folder)
