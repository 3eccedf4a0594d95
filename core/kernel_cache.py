"""Where compiled kernels are kept: beside their modules, else wherever a folder can be written.

numba keeps what it compiles beside the module, or in the user's cache folder, and stops where it
can write to neither, as in a container; and it stops at a file that was cut off. Kernels of this
package are kept, in this order, in the folder that ``FLYBY_CACHE`` names, in numba's own places
(``NUMBA_CACHE_DIR``, beside the module, ``XDG_CACHE_HOME`` or the home), or in a folder of the
user's among temporary files; else they are compiled at every start. What lies beside a module that
cannot be written to is still read. A file that is damaged counts as missing, and is written anew.

`install` has numba do so for modules of this package, and for no others. At a terminal it has
compiling announced that takes a while.
"""

from __future__ import annotations

import contextlib
import gc
import hashlib
import inspect
import logging
import os
import pickle
import stat
import sys
import tempfile
import time
from functools import cache
from pathlib import Path
from typing import Any, ClassVar

import numba
from numba.core import caching, event

from .numba_version import LINKED

VARIABLE = "FLYBY_CACHE"
_PACKAGE = __name__.partition(".")[0] + "."
_MARK = b"flyby-sha256:"
"""Stands before the digest at the end of a file; pickles end where they say they do."""
_STANDARD = caching.CompileResultCacheImpl._locator_classes
_UserWide: Any = next(one for one in _STANDARD if one.__name__.endswith("UserWideCacheLocator"))
_log = logging.getLogger("flyby")


class _Given(_UserWide):  # type: ignore[misc]
    """A folder that the user names."""

    def __init__(self, function: Any, file: str) -> None:
        super().__init__(function, file)
        self._cache_path = os.path.join(os.environ[VARIABLE], self.get_suitable_cache_subpath(file))

    @classmethod
    def from_function(cls, function: Any, file: str) -> Any:
        """The locator; None if no folder is named, or it cannot be written."""
        if not os.environ.get(VARIABLE):
            return None
        found = super().from_function(function, file)
        if found is None:
            _say(f"{VARIABLE}={os.environ[VARIABLE]} cannot be written; another folder is taken")
        return found


class _Temporary(_UserWide):  # type: ignore[misc]
    """A folder among temporary files that is the user's alone."""

    def __init__(self, function: Any, file: str) -> None:
        super().__init__(function, file)
        self._cache_path = os.path.join(
            tempfile.gettempdir(), f"flyby-{os.getuid()}", self.get_suitable_cache_subpath(file)
        )

    def ensure_cache_path(self) -> None:
        """Make the folder; compiled code in one of somebody else's would be run as ours."""
        folder = os.path.dirname(self._cache_path)
        with contextlib.suppress(FileExistsError):
            os.mkdir(folder, 0o700)
        state = os.lstat(folder)
        if not stat.S_ISDIR(state.st_mode) or state.st_uid != os.getuid() or state.st_mode & 0o022:
            raise PermissionError(f"{folder} belongs to somebody else")
        super().ensure_cache_path()

    @classmethod
    def from_function(cls, function: Any, file: str) -> Any:
        """The locator; None if there is no such folder."""
        try:
            return super().from_function(function, file)
        except OSError:  # there is no folder for temporary files
            return None


class _Places(caching.CompileResultCacheImpl):  # type: ignore[misc]
    _locator_classes: ClassVar = [_Given, *_STANDARD, _Temporary]

    def rebuild(self, target_context: Any, payload: Any) -> Any:
        """The kernel that was kept."""
        if numba.version_info.short == LINKED:
            from .kernel_loading import load

            return load(target_context, payload)
        target_context.refresh()
        return super().rebuild(target_context, payload)


class _Files(caching.IndexDataCacheFile):  # type: ignore[misc]
    """numba's files, with a digest at the end: machine code that is not whole is never run."""

    def _load_index(self) -> Any:
        try:
            names = super()._load_index()
        except Exception:  # whatever unpickling a damaged file raises
            return {}
        sound = isinstance(names, dict) and all(isinstance(one, str) for one in names.values())
        return names if sound else {}

    def _load_data(self, name: str) -> Any:
        data = Path(self._data_path(name)).read_bytes()
        content, mark, digest = data.rpartition(_MARK)
        if mark and hashlib.sha256(content).digest() != digest:
            return None
        try:
            return pickle.loads(data)
        except Exception:  # likewise, of a file that numba alone has written
            return None

    def _dump(self, obj: Any) -> bytes:
        content = bytes(super()._dump(obj))
        return content + _MARK + hashlib.sha256(content).digest()


class KernelCache(caching.FunctionCache):  # type: ignore[misc]
    """A kernel's cache; raises RuntimeError if there is no place for one."""

    _impl_class = _Places

    def __init__(self, function: Any) -> None:
        super().__init__(function)
        stamp, base = self._impl.locator.get_source_stamp(), self._impl.filename_base
        self._cache_file = _Files(self._cache_path, base, stamp)
        beside = os.path.join(os.path.dirname(inspect.getfile(function)), "__pycache__")
        self._beside = None if beside == self._cache_path else _Files(beside, base, stamp)

    def load_overload(self, sig: Any, target_context: Any) -> Any:
        """What is kept of a signature; None if nothing, or nothing that can be used."""
        try:
            found = self._load_overload(sig, target_context)
            if found is None and self._beside is not None:
                key = self._index_key(sig, target_context.codegen())
                data = self._beside.load(key)
                found = None if data is None else self._impl.rebuild(target_context, data)
        except Exception:  # it can be compiled anew, whatever is wrong with what was kept
            return None
        return found

    def save_overload(self, sig: Any, data: Any) -> None:
        """Keep a compiled signature, if the disk lets us."""
        try:
            super().save_overload(sig, data)
        except OSError as error:
            _say(
                f"compiled kernels cannot be kept in {self._cache_path}: {error.strerror or error}"
            )


def install(dispatcher: Any) -> None:
    """Have numba's dispatchers of this package's functions use these caches."""
    standard = dispatcher.FunctionCache

    def cache_of(function: Any) -> Any:
        if not str(function.__module__).startswith(_PACKAGE):
            return standard(function)
        try:
            return KernelCache(function)
        except RuntimeError:
            _say(
                "no folder can be written for compiled kernels, so that they are compiled at "
                f"every start, which takes a minute or more: name one by {VARIABLE}"
            )
            return caching.NullCache()

    dispatcher.FunctionCache = cache_of
    event.register("numba:compile", _Uncollected())
    if sys.stderr is not None and sys.stderr.isatty():
        event.register("numba:compile", Announcer())


class _Uncollected(event.Listener):  # type: ignore[misc]
    """Leaves garbage while a kernel is compiled: searching for it took a tenth of the time.

    It is collected between kernels that Python calls, as ever.
    """

    def __init__(self) -> None:
        self._depth = 0
        self._collected = False

    def on_start(self, event: Any) -> None:
        """A kernel is compiled, maybe for another."""
        if self._depth == 0:
            self._collected = gc.isenabled()
            gc.disable()
        self._depth += 1

    def on_end(self, event: Any) -> None:
        """It is done."""
        self._depth -= 1
        if self._depth == 0 and self._collected:
            gc.enable()


class Announcer(event.Listener):  # type: ignore[misc]
    """Says once that kernels of this package are compiled, when that has taken a while.

    Args:
        patience: s of compiling without a word.
    """

    def __init__(self, patience: float = 2.0) -> None:
        self._left = patience
        self._open: list[bool] = []
        self._last = 0.0

    def on_start(self, event: Any) -> None:
        """A kernel is compiled, maybe for another."""
        self._count()
        module = str(event.data["dispatcher"].py_func.__module__)
        self._open.append(module.startswith(_PACKAGE))

    def on_end(self, event: Any) -> None:
        """It is done."""
        self._count()
        self._open.pop()

    def _count(self) -> None:
        now = time.perf_counter()
        if self._open and self._open[0]:
            self._left -= now - self._last
            if self._left <= 0.0:
                _say("kernels are compiled, which is done once: this takes up to a minute")
        self._last = now


@cache
def _say(message: str) -> None:
    """Once, not for each kernel."""
    _log.warning(message)
