"""The folders show the architecture: small rooms, no circles, few levels of import."""

from __future__ import annotations

import ast
from functools import cache
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[1]
SHELVES = sorted(
    path.name for path in (ROOT / ".typing" / "flyby").iterdir() if path.resolve().is_dir()
)
MOST_FILES = 20
MOST_LEVELS = 8


def modules() -> dict[str, Path]:
    """Dotted name of every module of the package, packages by their name."""
    found = {}
    for shelf in SHELVES:
        for path in (ROOT / shelf).rglob("*.py"):
            parts = path.relative_to(ROOT).with_suffix("").parts
            found[".".join(parts[:-1] if parts[-1] == "__init__" else parts)] = path
    return found


def imports(name: str, path: Path, known: dict[str, Path]) -> set[str]:
    """What a module imports of the package, for types or late included."""
    package = name.split(".") if path.name == "__init__.py" else name.split(".")[:-1]
    found = set()
    for node in ast.walk(ast.parse(path.read_text("utf-8"))):
        if not isinstance(node, ast.ImportFrom):
            continue
        if node.level:
            base = package[: len(package) - node.level + 1]
        elif node.module and node.module.split(".")[0] == "flyby":
            base = []
        else:
            continue
        own = (node.module or "").removeprefix("flyby").strip(".")
        source = ".".join([*base, *([own] if own else [])])
        for alias in node.names:
            full = f"{source}.{alias.name}".strip(".")
            found |= {one for one in (full if full in known else source,) if one in known}
    return found - {name}


MODULES = modules()


@cache
def graph() -> dict[str, set[str]]:
    """What each module imports; seconds to read, so not where tests are collected."""
    return {name: imports(name, path, MODULES) for name, path in MODULES.items()}


def levels(room: str) -> dict[str, int]:
    """How many imports lie below each file of a room; a circle of files is an error."""
    found: dict[str, int] = {}
    above: list[str] = []

    def level(name: str) -> int:
        assert name not in above, " → ".join([*above[above.index(name) :], name])
        if name not in found:
            above.append(name)
            below = [level(other) for other in graph()[name] if other.startswith(room)]
            found[name] = 1 + max(below, default=0)
            above.pop()
        return found[name]

    for name in sorted(graph()):
        if name.startswith(room) and MODULES[name].name != "__init__.py":
            level(name)
    return found


def test_the_graph_is_read() -> None:
    assert len(MODULES) > 600
    assert sum(len(others) for others in graph().values()) > 3000


def test_no_circles_of_files() -> None:
    """Not even by imports that are late, or for types alone."""
    assert levels("")


@pytest.mark.parametrize("shelf", SHELVES)
def test_folders_are_small(shelf: str) -> None:
    for folder in {path.parent for path in (ROOT / shelf).rglob("*.py")}:
        place = folder.relative_to(ROOT).as_posix()
        files = [path for path in folder.glob("*.py") if path.name != "__init__.py"]
        assert len(files) <= MOST_FILES, place


def test_the_motion_has_few_levels() -> None:
    room = levels("core.motion.")
    assert len(room) > 50
    deepest = max(room, key=lambda name: room[name])
    assert room[deepest] <= MOST_LEVELS, deepest
