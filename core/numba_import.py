"""Installs `kernel_cache` when numba is imported, and not before: many commands do without it.

numba looks for a BLAS when it is imported, and by that imports all of SciPy's linear algebra, which
takes a third as long as numba. It is put off until a kernel is compiled, or called, that needs it.
"""

from __future__ import annotations

import sys
from collections.abc import Sequence
from importlib.abc import Loader, MetaPathFinder
from importlib.machinery import ModuleSpec, PathFinder
from importlib.util import find_spec
from types import ModuleType

_DISPATCHER = "numba.core.dispatcher"
_ARRAYS, _ALGEBRA = "numba.np.arraymath", "numba.np.linalg"


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


def _have_blas() -> None:
    """As numba's `ensure_blas`, but that a SciPy which is there is taken to have one."""
    if find_spec("scipy") is None:
        raise ImportError("SciPy is required for linear algebra")


class _Finder(MetaPathFinder):
    """Finds two modules, each once, as they would be found without this."""

    def __init__(self) -> None:
        self._awaited: dict[str, type[_Loader]] = {_DISPATCHER: _Loader, _ARRAYS: _BlasLoader}

    def find_spec(
        self, fullname: str, path: Sequence[str] | None, target: ModuleType | None = None
    ) -> ModuleSpec | None:
        loader = self._awaited.pop(fullname, None)
        if loader is None:
            return None
        if not self._awaited:
            sys.meta_path.remove(self)
        spec = PathFinder.find_spec(fullname, path, target)
        if spec is not None and spec.loader is not None:
            spec.loader = loader(spec.loader)
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


class _BlasLoader(_Loader):
    """Loads the module that looks for a BLAS, without importing one."""

    def exec_module(self, module: ModuleType) -> None:
        algebra = sys.modules.get(_ALGEBRA)
        ensure = getattr(algebra, "ensure_blas", None)
        if algebra is None or ensure is None:
            self._loader.exec_module(module)
            return
        names = vars(algebra)
        names["ensure_blas"] = _have_blas
        try:
            self._loader.exec_module(module)
        finally:
            names["ensure_blas"] = vars(module)["ensure_blas"] = ensure
