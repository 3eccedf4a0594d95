"""Kernels that other kernels call, compiled into them."""

from __future__ import annotations

import pytest
from numba import njit

from flyby.core.numba_version import LINKED
from flyby.core.robot.kinematics import lean


@pytest.mark.parametrize("linked", [LINKED, (0, 0)], ids=["as installed", "another numba"])
def test_inner_kernels_serve_with_any_numba(linked, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(lean, "LINKED", linked)

    @lean.inner
    def squared(x: float) -> float:
        return x * x

    @njit(error_model="numpy")
    def summed(count: int) -> float:
        total = 0.0
        for k in range(count):
            total += squared(float(k))
        return total

    assert squared(3.0) == 9.0
    assert summed(4) == 14.0
