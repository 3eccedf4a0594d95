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


def lean(function: Any) -> Any:
    """Compiles a function that makes no array: where it would, numba refuses to compile it."""
    plain = {"cache": True, "error_model": "numpy", "_nrt": False, "no_cfunc_wrapper": True}
    if numba.version_info.short != LINKED:
        return njit(**plain)(function)
    from .linked import LeanCompiler

    return njit(**plain, pipeline_class=LeanCompiler)(function)


def inner(function: Any) -> Any:
    """Compiles a function that makes no array into the kernels that call it.

    It has no machine code of its own: called from Python, it runs as it is written.
    """
    plain = {"error_model": "numpy", "_nrt": False}
    if numba.version_info.short != LINKED:
        return register_jitable(**plain)(function)
    from .linked import LinkedCompiler

    # With the flags of `lean`: numba compiles anew for each caller that has others.
    return register_jitable(
        **plain, no_cfunc_wrapper=True, no_cpython_wrapper=False, pipeline_class=LinkedCompiler
    )(function)
