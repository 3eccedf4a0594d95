"""What the folders say, the build configuration says too."""

from __future__ import annotations

import re
import subprocess
import sys
import tomllib
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[1]
PYPROJECT = tomllib.loads((ROOT / "pyproject.toml").read_text("utf-8"))
SETUPTOOLS = PYPROJECT["tool"]["setuptools"]
SHELVES = ("cli", "core", "drawing", "identification", "problems", "tasks", "testing", "vendors")
CHECKED = (*SHELVES, "validation")
"""Folders that type checkers read; validation is for tests and benchmarks, not shipped."""
LINKS = (*CHECKED, "__init__.py", "py.typed")


def dotted(folder: Path) -> str:
    return ".".join(("flyby", *folder.relative_to(ROOT).parts))


def folder_of(package: str) -> Path:
    return ROOT.joinpath(*package.split(".")[1:])


def test_every_folder_with_code_is_packaged() -> None:
    on_disk = {dotted(file.parent) for shelf in SHELVES for file in (ROOT / shelf).rglob("*.py")}
    assert {"flyby"} | on_disk == set(SETUPTOOLS["packages"])


def test_every_package_has_an_init() -> None:
    for name in SETUPTOOLS["packages"]:
        assert (folder_of(name) / "__init__.py").is_file(), name


def test_every_data_file_is_packaged() -> None:
    shipped = {
        path
        for name, patterns in SETUPTOOLS["package-data"].items()
        for pattern in patterns
        for path in folder_of(name).glob(pattern)
    }
    caches = {"__pycache__", ".mypy_cache"}
    on_disk = {
        path
        for shelf in SHELVES
        for path in (ROOT / shelf).rglob("*")
        if path.is_file() and path.suffix != ".py" and not caches & set(path.parts)
    }
    assert on_disk <= shipped


def test_the_root_holds_no_stray_module() -> None:
    assert {path.name for path in ROOT.glob("*.py")} == {"__init__.py", "__main__.py"}


@pytest.mark.parametrize("name", LINKS)
def test_type_checkers_reach_the_folder(name: str) -> None:
    link = ROOT / ".typing" / "flyby" / name
    assert link.is_symlink()
    assert not Path(link.readlink()).is_absolute(), "a clone elsewhere must find it too"
    assert link.resolve() == (ROOT / name).resolve()


def test_type_checkers_see_nothing_else() -> None:
    assert {path.name for path in (ROOT / ".typing" / "flyby").iterdir()} == set(LINKS)
    files = PYPROJECT["tool"]["mypy"]["files"]
    assert set(files) == {f".typing/flyby/{shelf}" for shelf in CHECKED}


def test_every_entry_point_is_packaged() -> None:
    project = PYPROJECT["project"]
    targets = [*project["entry-points"]["flyby"].values(), *project["scripts"].values()]
    for target in targets:
        package, _, module = target.partition(":")[0].rpartition(".")
        assert package in SETUPTOOLS["packages"], target
        assert (folder_of(package) / f"{module}.py").is_file(), target


def test_extras_that_are_named_exist() -> None:
    """In docs, messages and scripts."""
    known = PYPROJECT["project"]["optional-dependencies"]
    named = {
        (extra.strip(), path.name)
        for pattern in (
            "*.md",
            "docs/**/*.md",
            "benchmarks/*.py",
            *(f"{s}/**/*.py" for s in SHELVES),
        )
        for path in ROOT.glob(pattern)
        for extras in re.findall(r"(?:flyby|\.)\[([a-z, ]+)\]'?", path.read_text("utf-8"))
        if "pip install" in path.read_text("utf-8")
        for extra in extras.split(",")
    }
    assert len(named) > 3
    for extra, place in named:
        assert extra in known, (extra, place)


def test_the_package_is_the_command() -> None:
    said = subprocess.run(
        [sys.executable, "-m", "flyby", "--version"], capture_output=True, text=True, check=True
    )
    assert said.stdout.startswith("flyby ")
