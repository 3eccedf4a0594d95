"""Example distributions, loaded as if they were installed."""

from __future__ import annotations

import sys
from collections.abc import Mapping
from importlib import metadata, util
from pathlib import Path
from types import SimpleNamespace
from typing import Any

from flyby.core.registry import Registry

EXAMPLES = Path(__file__).parents[2] / "examples"


def on_path(name: str) -> None:
    """Have a distribution's modules found."""
    source = str(EXAMPLES / name / "src")
    if source not in sys.path:
        sys.path.insert(0, source)


def install(site: Path, distribution: str, points: Mapping[str, str]) -> None:
    """Have a distribution with entry points found in a folder, as one that pip has installed."""
    info = site / f"{distribution.replace('-', '_')}-1.0.dist-info"
    info.mkdir()
    head = f"Metadata-Version: 2.1\nName: {distribution}\nVersion: 1.0\n"
    (info / "METADATA").write_text(head, "utf-8")
    lines = [f"{name} = {module}" for name, module in points.items()]
    (info / "entry_points.txt").write_text("\n".join(["[flyby]", *lines, ""]), "utf-8")


def registry_of(name: str) -> Registry:
    """A registry of one distribution alone, found through its entry point."""
    on_path(name)
    point = metadata.EntryPoint(name, f"flyby_{name}.plugin", "flyby")
    vars(point).update(dist=SimpleNamespace(name=f"flyby-{name}", version="0.1.0"))
    return Registry.discover([point])


def own_tests(name: str) -> dict[str, Any]:
    """The tests of a distribution, and the fixtures that they take."""
    on_path(name)
    found: dict[str, Any] = {}
    for path in sorted((EXAMPLES / name / "tests").glob("test_*.py")):
        module_name = f"flyby_{name}_{path.stem}"
        spec = util.spec_from_file_location(module_name, path)
        assert spec is not None and spec.loader is not None
        module = sys.modules[module_name] = util.module_from_spec(spec)
        spec.loader.exec_module(module)
        found.update({k: v for k, v in vars(module).items() if not k.startswith("_")})
    return found
