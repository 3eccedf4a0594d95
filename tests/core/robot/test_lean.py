"""Kernels that other kernels call, compiled into them."""

from __future__ import annotations

import pytest
from numba import njit

from flyby.core.robot.kinematics import lean


@pytest.mark.parametrize("version", [lean.LINKED, (0, 0)], ids=["linked", "by itself"])
def test_inner_kernels_serve_with_any_numba(version, monkeypatch: pytest.MonkeyPatch) -> None:
    """With the version that `linked` builds on, and with others."""
    import numba

    if version == lean.LINKED and numba.version_info.short != version:
        pytest.skip(f"numba {numba.__version__} is not the one that `linked` builds on")
    monkeypatch.setattr(lean, "LINKED", version if version == lean.LINKED else (0, 0))

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
