"""How kernels are compiled that are called for every sample of every path.

They make no array, and so need none of numba's reference counts. Counting costs more than what such
a kernel does: two atomic operations for every array of every tuple that it is given.
"""

from __future__ import annotations

from numba import njit

lean = njit(cache=True, error_model="numpy", _nrt=False)
"""Compiles a function that makes no array: where it would, numba refuses to compile it."""
