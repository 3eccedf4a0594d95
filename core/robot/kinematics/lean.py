"""How kernels are compiled that are called for every sample of every path.

They make no array, and so need none of numba's reference counts. Counting costs more than what such
a kernel does: two atomic operations for every array of every tuple that it is given.

Of `lean` ones and those that they call, machine code is made once, together: what only other
kernels call is `inner`. numba by itself would optimise each kernel alone and again in each of its
callers, make machine code of it and two wrappers that unpack every array for Python, and do so once
more for every argument that a caller writes as a literal. That is half of what compiling takes.
"""

from __future__ import annotations

from typing import Any

import numba
from numba import njit
from numba.extending import register_jitable

from ...numba_version import LINKED

_PLAIN = {
    "error_model": "numpy",
    # Products and sums in one instruction, rounded once.
    "fastmath": {"contract"},
    "_nrt": False,
    "no_cfunc_wrapper": True,
}


def lean(function: Any) -> Any:
    """Compiles a function that makes no array: where it would, numba refuses to compile it."""
    if numba.version_info.short != LINKED:
        return njit(**_PLAIN, cache=True)(function)
    from .compiling.linked import LeanCompiler, LeanDispatcher

    options = {**_PLAIN, "nopython": True}
    made = LeanDispatcher(function, targetoptions=options, pipeline_class=LeanCompiler)
    made.enable_caching()
    return made


def inner(function: Any) -> Any:
    """Compiles a function that makes no array into the kernels that call it.

    It has no machine code of its own: called from Python, it runs as it is written.
    """
    return _inner(function)


def inlined(function: Any) -> Any:
    """As `inner`, and put in its callers' place where it is called.

    For what is called for each joint of each sample and hands on whole rotations: LLVM by itself
    would keep it apart, and have them written to memory and read again.
    """
    return _inner(function, forceinline=True)


def _inner(function: Any, **options: Any) -> Any:
    if numba.version_info.short != LINKED:
        return register_jitable(error_model="numpy", fastmath={"contract"}, _nrt=False)(function)
    from .compiling.linked import LinkedCompiler

    # With the flags of `lean`: numba compiles anew for each caller that has others.
    options = {**_PLAIN, **options, "no_cpython_wrapper": False}
    return register_jitable(**options, pipeline_class=LinkedCompiler)(function)
