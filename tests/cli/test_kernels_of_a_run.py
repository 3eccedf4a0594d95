"""What `flyby emulate` compiles: each kernel once."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

DEBURRING = Path(__file__).parents[2] / "examples/deburring.mod"
RUN = """
import gc, sys
from numba.core.dispatcher import Dispatcher
from flyby.cli.main import app
try:
    app(sys.argv[1:], prog_name="flyby")
except SystemExit as end:
    assert not end.code
for one in gc.get_objects():
    if isinstance(one, Dispatcher) and one.py_func.__module__.startswith("flyby."):
        if one.overloads:
            print("kernel", one.py_func.__module__, one.py_func.__name__, len(one.overloads))
"""


def test_a_run_compiles_no_kernel_for_a_second_signature() -> None:
    words = "emulate", str(DEBURRING), "--robot", "abb/irb6640-180-255"
    done = subprocess.run(
        [sys.executable, "-c", RUN, *words], capture_output=True, text=True, check=True
    )
    kernels = [line.split()[1:] for line in done.stdout.splitlines() if line.startswith("kernel")]
    assert len(kernels) > 15
    assert [kernel for kernel in kernels if kernel[-1] != "1"] == []
