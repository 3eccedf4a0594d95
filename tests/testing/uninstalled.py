"""Example distributions, loaded as if they were installed."""

from __future__ import annotations

import sys
from importlib import metadata, util
from pathlib import Path
from types import SimpleNamespace
from typing import Any

from flyby.core.registry import Registry

EXAMPLES = Path(__file__).parents[2] / "examples"


def registry_of(name: str) -> Registry:
    """A registry of one distribution alone, found through its entry point."""
    source = str(EXAMPLES / name / "src")
    if source not in sys.path:
        sys.path.insert(0, source)
    point = metadata.EntryPoint(name, f"flyby_{name}.plugin", "flyby")
    vars(point).update(dist=SimpleNamespace(name=f"flyby-{name}", version="0.1.0"))
    return Registry.discover([point])


def own_tests(name: str) -> dict[str, Any]:
    """The tests of a distribution, and the fixtures that they take."""
    registry_of(name)
    found: dict[str, Any] = {}
    for path in sorted((EXAMPLES / name / "tests").glob("test_*.py")):
        module_name = f"flyby_{name}_{path.stem}"
        spec = util.spec_from_file_location(module_name, path)
        assert spec is not None and spec.loader is not None
        module = sys.modules[module_name] = util.module_from_spec(spec)
        spec.loader.exec_module(module)
        found.update({k: v for k, v in vars(module).items() if not k.startswith("_")})
    return found
