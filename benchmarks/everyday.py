"""Everyday programs made faster by a default `optimize`: what it takes, and what it finds.

    python benchmarks/everyday.py [--json] [--case kuka-tending]

Programs of about twenty moves, joint moves and lines with zones and stops, as `programs/` holds
them, without a cell: the arm, its tools and the plane under the base are what is kept clear of.

- ``given_time_s``, ``optimized_time_s``: before and after.
- ``clearance_mm``: what the optimised program is proven to keep.
- ``moves``: of the program.
- ``cpu_s``: of the whole optimisation, its proof and its text included, in one process; compiled
  code is loaded beforehand.
"""

from __future__ import annotations

import os

os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")

import time
from collections.abc import Iterator
from pathlib import Path

from report import Figure, main

import flyby

PROGRAMS = Path(__file__).parent / "programs"
CASES = {
    "kuka-tending": ("tend.src", "kuka/kr30-3"),
    "abb-palletising": ("pallet.mod", "abb/irb6640-180-255"),
    "ur-screwing": ("screw.script", "ur/ur10e"),
}


def measure(case: str) -> Iterator[Figure]:
    """Figures of one program."""
    name, robot = CASES[case]
    program = flyby.read(PROGRAMS / name, robot=robot)
    if hasattr(os, "sched_setaffinity"):
        # As many processes as processors: here one.
        os.sched_setaffinity(0, {min(os.sched_getaffinity(0))})
    flyby.optimize(program, zones_only=True)
    begin = time.process_time()
    made = flyby.optimize(program)
    spent = time.process_time() - begin
    yield Figure(case, "moves", len(program.moves), "1")
    yield Figure(case, "given_time_s", made.before.time, "s")
    yield Figure(case, "optimized_time_s", made.after.time, "s")
    kept = made.after.clearance
    yield Figure(case, "clearance_mm", float("nan") if kept is None else 1e3 * kept, "mm")
    yield Figure(case, "cpu_s", spent, "s")


if __name__ == "__main__":
    main(__doc__ or "", measure, CASES)
