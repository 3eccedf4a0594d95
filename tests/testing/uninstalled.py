"""Example plugins, loaded as if they were installed."""

from __future__ import annotations

import sys
from importlib import metadata, util
from pathlib import Path
from types import ModuleType, SimpleNamespace
from typing import Any

from flyby.core.registry import Registry
from flyby.core.vendor import Vendor

EXAMPLES = Path(__file__).parents[2] / "examples"


def vendor_of(example: str, name: str) -> Vendor:
    """The vendor of a distribution under ``examples``, through its entry point."""
    source = str(EXAMPLES / example / "src")
    if source not in sys.path:
        sys.path.insert(0, source)
    point = metadata.EntryPoint(name, f"flyby_{name}.plugin", "flyby")
    vars(point).update(dist=SimpleNamespace(name=f"flyby-{name}", version="0"))
    registry = Registry.discover([point])
    assert registry.broken == ()
    return registry.find_vendor(name)


def tests_of(example: str, file: str) -> Any:
    """A file of the distribution's own tests, as a module."""
    name = f"{example}_{file}"
    spec = util.spec_from_file_location(name, EXAMPLES / example / "tests" / f"{file}.py")
    assert spec is not None and spec.loader is not None
    module: ModuleType = util.module_from_spec(spec)
    sys.modules[name] = module
    spec.loader.exec_module(module)
    return module
