"""Kept kernels are loaded without what compiling takes, and serve what is compiled later."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

import numba
import pytest

from flyby.core.numba_version import LINKED

KERNELS = """
import numpy as np
from numba import njit

@njit(cache=True)
def squares(x):
    made = np.empty_like(x)
    for k in range(len(x)):
        made[k] = x[k] * x[k]
    return made

@njit(cache=True)
def total(x):
    return squares(x).sum()
"""
LOADS = """
import importlib.util, sys
import numpy as np, flyby
spec = importlib.util.spec_from_file_location("flyby.fake", sys.argv[1])
fake = importlib.util.module_from_spec(spec)
sys.modules["flyby.fake"] = fake
spec.loader.exec_module(fake)
x = np.array([1.0, 2.0, 3.0])
print(fake.squares(x).tolist(), dict(fake.squares.stats.cache_hits) != {},
      "numba.np.arraymath" in sys.modules)
print(fake.total(x), fake.total.inspect_llvm(fake.total.signatures[0]) != "")
"""


@pytest.mark.skipif(numba.version_info.short != LINKED, reason="with others numba loads by itself")
def test_a_kept_kernel_is_loaded_without_what_compiling_takes(tmp_path: Path) -> None:
    module = tmp_path / "fake.py"
    module.write_text(KERNELS)
    around = os.environ | {"FLYBY_CACHE": str(tmp_path / "cache")}

    def process() -> list[str]:
        done = subprocess.run(
            [sys.executable, "-c", LOADS, str(module)],
            env=around,
            capture_output=True,
            text=True,
            check=True,
        )
        return done.stdout.split("\n")

    assert process()[:2] == ["[1.0, 4.0, 9.0] False True", "14.0 True"]
    for kept in (tmp_path / "cache").rglob("*total*.nbi"):
        kept.unlink()  # it has to be compiled, with the kernel that was loaded in it
    assert process()[:2] == ["[1.0, 4.0, 9.0] True False", "14.0 True"]


DOT = """
import sys
import numpy as np, flyby
from numba import njit

x = np.array([1.0, 2.0, 3.0])
print(njit(lambda x: x.sum())(x), "scipy.linalg" in sys.modules)
print(njit(lambda x: np.dot(x, x))(x), "scipy.linalg" in sys.modules)
"""


def test_linear_algebra_is_imported_for_kernels_that_need_it_alone() -> None:
    done = subprocess.run([sys.executable, "-c", DOT], capture_output=True, text=True, check=True)
    assert done.stdout.split("\n")[:2] == ["6.0 False", "14.0 True"]
