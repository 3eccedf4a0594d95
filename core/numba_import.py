"""Installs `kernel_cache` when numba is imported, and not before: many commands do without it."""

from __future__ import annotations

import sys
from collections.abc import Sequence
from importlib.abc import Loader, MetaPathFinder
from importlib.machinery import ModuleSpec, PathFinder
from types import ModuleType

_DISPATCHER = "numba.core.dispatcher"


def install() -> None:
    """Watch for numba, or install at once where it is there already."""
    loaded = sys.modules.get(_DISPATCHER)
    if loaded is not None:
        _install(loaded)
    elif not any(isinstance(finder, _Finder) for finder in sys.meta_path):
        sys.meta_path.insert(0, _Finder())


def _install(dispatcher: ModuleType) -> None:
    from .kernel_cache import install

    install(dispatcher)


class _Finder(MetaPathFinder):
    """Finds the one module, once, as it would be found without this."""

    def find_spec(
        self, fullname: str, path: Sequence[str] | None, target: ModuleType | None = None
    ) -> ModuleSpec | None:
        if fullname != _DISPATCHER:
            return None
        sys.meta_path.remove(self)
        spec = PathFinder.find_spec(fullname, path, target)
        if spec is not None and spec.loader is not None:
            spec.loader = _Loader(spec.loader)
        return spec


class _Loader(Loader):
    """Loads as another loader does, then installs."""

    def __init__(self, loader: Loader) -> None:
        self._loader = loader

    def create_module(self, spec: ModuleSpec) -> ModuleType | None:
        return self._loader.create_module(spec)

    def exec_module(self, module: ModuleType) -> None:
        self._loader.exec_module(module)
        _install(module)
