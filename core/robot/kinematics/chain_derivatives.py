"""Compiled derivatives of a chain's Jacobian.

With (v_j, ω_j) the column of chain joint j, a joint turns or shifts all that follows it:

    ∂(v_j, ω_j)/∂q_k = (ω_k × v_j, ω_k × ω_j)    k at or before j
    ∂(v_j, ω_j)/∂q_k = (ω_j × v_k, 0)            k after j
"""

from __future__ import annotations

import numpy as np
from numba import njit
from numpy.typing import NDArray

from ...arrays import FloatArray
from .chain import Chain
from .chain_kernels import jacobians
from .lean import inner
from .vectors import Vector, cross


def hessians(chain: Chain, q: FloatArray) -> FloatArray:
    """∂J[:, j]/∂q[k], (M, 6, N, N) with j before k, of configurations (M, N)."""
    out = np.zeros((q.shape[0], 6, q.shape[1], q.shape[1]))
    _add_hessians(chain.joint, _columns(chain, q), out)
    return out


def _columns(chain: Chain, q: FloatArray) -> FloatArray:
    """One column per chain joint, (M, 6, K), even where several share a value."""
    single = chain._replace(joint=np.arange(chain.joint.size))
    columns: FloatArray = jacobians(single, np.ascontiguousarray(q[:, chain.joint]))
    return columns


@inner
def _column_change(columns: FloatArray, m: int, j: int, k: int) -> tuple[Vector, Vector]:
    """How column j changes with chain joint k: linear and angular part."""
    v_j = (columns[m, 0, j], columns[m, 1, j], columns[m, 2, j])
    w_j = (columns[m, 3, j], columns[m, 4, j], columns[m, 5, j])
    v_k = (columns[m, 0, k], columns[m, 1, k], columns[m, 2, k])
    w_k = (columns[m, 3, k], columns[m, 4, k], columns[m, 5, k])
    if k <= j:
        return cross(w_k, v_j), cross(w_k, w_j)
    return cross(w_j, v_k), (0.0, 0.0, 0.0)


@njit(cache=True, error_model="numpy")
def _add_hessians(joint: NDArray[np.int64], columns: FloatArray, out: FloatArray) -> None:
    for m in range(columns.shape[0]):
        for j in range(joint.size):
            for k in range(joint.size):
                linear, angular = _column_change(columns, m, j, k)
                for i in range(3):
                    out[m, i, joint[j], joint[k]] += linear[i]
                    out[m, 3 + i, joint[j], joint[k]] += angular[i]
