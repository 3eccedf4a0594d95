"""The emulator's speed.

    python benchmarks/emulation.py [--json] [--case 1000-moves] [--case kuka] [--case ur]

``1000-moves`` drives a seeded program of 1000 moves (joint, linear and circular legs of 200 to
400 mm at 500 mm/s with zones of 10 to 50 mm) on the IRB 6640 at 4 ms. ``ms_per_move`` is CPU time
of planning, stamping and sampling it over its moves; ``real_time_factor`` the robot's cycle time
over that CPU time; ``derivative_cost_ratio`` the CPU time of duration, energy and both gradients
over that of duration and energy alone. ``kuka`` and ``ur`` drive the same on a KR 30-3 and, in a
box that a UR10e reaches, on that one. ``start-up`` runs a fresh interpreter whose compiled
kernels are in numba's cache already; and ``flyby emulate`` on the README's program in a copy of the
package without compiled kernels, its modules compiled to bytecode as pip leaves them:
``compile_cpu_s`` is the CPU time of the first run beyond that of the next, of which ``command_s``
is the wall time.
"""

from __future__ import annotations

import compileall
import os
import resource
import shutil
import subprocess
import sys
import tempfile
import time
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from report import Figure, cpu_seconds, main

from flyby.core.motion.emulator.controller import Controller
from flyby.core.motion.gradients.derivatives import Derivatives
from flyby.core.program.move import Move, MoveC, MoveJ, MoveL
from flyby.core.program.program import Program
from flyby.core.program.speed import Speed
from flyby.core.program.target import PoseTarget
from flyby.core.program.zone import FINE, Radius
from flyby.core.registry import find_robot, find_vendor
from flyby.core.spatial.pose import Pose
from flyby.core.spatial.rotation import matrix_from_rotation_vector

MOVES = 1000
SPEED = Speed(tcp=0.5, reorientation=np.radians(500), name="v500")
TILT = 0.25  # rad from straight down


@dataclass(frozen=True)
class Box:
    """In front of a robot, tool down, where it meets no singularity and no joint limit; in m."""

    centre: tuple[float, float, float] = (1.5, 0.0, 1.0)
    half: tuple[float, float, float] = (0.3, 0.5, 0.3)


OTHERS = {
    "kuka": ("kuka", "kuka/kr30-3", Box((1.3, 0.0, 1.0))),
    "ur": ("ur", "ur/ur10e", Box((0.65, 0.0, 0.4), (0.12, 0.35, 0.2))),
}
SECONDS = """
import time; begin = time.perf_counter()
import flyby.core.motion.emulator.controller
imported = time.perf_counter() - begin
import sys; sys.path.insert(0, {folder!r})
import emulation
controller, program = emulation.controller(), emulation.program(20)
begin = time.perf_counter(); controller.run(program)
print(imported, time.perf_counter() - begin)
"""


def controller() -> Controller:
    """The ABB controller of an IRB 6640."""
    return Controller(find_vendor("abb"), find_robot("abb/irb6640-180-255"))


def program(count: int, seed: int = 1, box: Box = Box()) -> Program:
    """A program of ``count`` moves after the one that leads to its first point."""
    rng = np.random.default_rng(seed)
    at = np.array(box.centre)
    moves: list[Move] = [MoveJ(_target(rng, at), SPEED, FINE)]
    kinds = rng.choice([MoveJ, MoveL, MoveC], size=count, p=[0.25, 0.5, 0.25])
    for kind in kinds:
        end = _next(rng, at, box)
        radius = float(rng.choice([0.01, 0.02, 0.05]))
        zone = Radius(radius, 1.5 * radius, 1.5 * radius, np.radians(150) * radius)
        if kind is MoveC:
            via = PoseTarget(_pose(rng, 0.5 * (at + end) + _aside(rng, end - at)))
            moves.append(MoveC(_target(rng, end), SPEED, zone, via=via))
        else:
            moves.append(kind(_target(rng, end), SPEED, zone))
        at = end
    return Program(tuple(moves), f"seed {seed}")


def _next(rng: np.random.Generator, at: np.ndarray, box: Box) -> np.ndarray:
    """A point of the box 200 to 400 mm away."""
    while True:
        end = np.array(box.centre) + np.array(box.half) * rng.uniform(-1, 1, 3)
        if 0.2 <= np.linalg.norm(end - at) <= 0.4:
            return end


def _aside(rng: np.random.Generator, leg: np.ndarray) -> np.ndarray:
    """A step square to a leg, a fifth of its length."""
    across = np.cross(leg, rng.normal(size=3))
    return 0.2 * np.linalg.norm(leg) * across / np.linalg.norm(across)


def _pose(rng: np.random.Generator, position: np.ndarray) -> Pose:
    matrix = np.eye(4)
    down = np.diag([-1.0, 1.0, -1.0])
    matrix[:3, :3] = matrix_from_rotation_vector(TILT * rng.uniform(-1, 1, 3)) @ down
    matrix[:3, 3] = position
    return Pose.from_matrix(matrix)


def _target(rng: np.random.Generator, position: np.ndarray) -> PoseTarget:
    return PoseTarget(_pose(rng, position))


def thousand_moves(case: str) -> Iterator[Figure]:
    driver, moves = controller(), program(MOVES)
    path = driver.plan(moves)
    timing = driver.stamp(moves, path)

    def values() -> tuple[float, float]:
        plan = driver.plan(moves)
        stamped = driver.stamp(moves, plan)
        return stamped.duration, driver.energy(moves, stamped).value

    def gradients() -> None:
        plan = driver.plan(moves)
        stamped = driver.stamp(moves, plan)
        driver.energy(moves, stamped)
        derivatives = Derivatives(moves, stamped)
        derivatives.duration()
        derivatives.energy()

    seconds = cpu_seconds(
        {
            "run": lambda: driver.run(moves),
            "plan": lambda: driver.plan(moves),
            "stamp": lambda: driver.stamp(moves, path),
            "sample": lambda: driver.sample(moves, timing),
            "values": values,
            "gradients": gradients,
        },
        budget=0.0,
    )
    whole = seconds["run"]
    yield Figure(case, "ms_per_move", 1e3 * whole / MOVES, "ms", "target", 0.45)
    yield Figure(case, "real_time_factor", timing.duration / whole, "", "target", 1000.0)
    ratio = seconds["gradients"] / seconds["values"]
    yield Figure(case, "derivative_cost_ratio", ratio, "", "target", 4.0)
    yield Figure(case, "cycle_time_s", timing.duration, "s")
    for stage in ("plan", "stamp", "sample"):
        yield Figure(case, f"{stage}_ms_per_move", 1e3 * seconds[stage] / MOVES, "ms")


def other_robot(case: str) -> Iterator[Figure]:
    vendor, name, box = OTHERS[case]
    driver = Controller(find_vendor(vendor), find_robot(name))
    moves = program(MOVES, box=box)
    seconds = cpu_seconds({"run": lambda: driver.run(moves)}, budget=0.0)["run"]
    cycle = driver.run(moves).timing.duration
    yield Figure(case, "ms_per_move", 1e3 * seconds / MOVES, "ms")
    yield Figure(case, "real_time_factor", cycle / seconds, "", "target", 1500.0)


def start_up(case: str) -> Iterator[Figure]:
    script = SECONDS.format(folder=str(Path(__file__).parent))
    found = []
    for _ in range(4):
        begin = time.perf_counter()
        done = subprocess.run(
            [sys.executable, "-c", script], capture_output=True, text=True, check=True
        )
        found.append((*map(float, done.stdout.split()), time.perf_counter() - begin))
    # The first process may have had to compile.
    imported, first, whole = np.median(found[1:], axis=0)
    yield Figure(case, "import_s", float(imported), "s")
    yield Figure(case, "first_call_s", float(first), "s")
    yield Figure(case, "process_s", float(whole), "s", "target", 3.0)
    yield from _first_run(case)


def _first_run(case: str) -> Iterator[Figure]:
    """What ``flyby emulate`` takes without compiled kernels and with them."""
    root = Path(__file__).parents[1]
    with tempfile.TemporaryDirectory() as folder:
        # Kernels beside the modules would be found wherever the cache is.
        leave = shutil.ignore_patterns("__pycache__", ".*", "docs", "tests")
        shutil.copytree(root, Path(folder, "flyby"), ignore=leave)
        compileall.compile_dir(folder, quiet=1)  # as pip leaves what it installs
        around = os.environ | {"PYTHONPATH": folder, "FLYBY_CACHE": str(Path(folder, "cache"))}
        around.pop("PYTHONDONTWRITEBYTECODE", None)  # as an installed package has it
        command = ["emulate", str(root / "examples" / "deburring.mod"), "--robot"]
        command += ["abb/irb6640-180-255"]
        code = "from flyby.cli.main import main; main()"
        spent, walls = [], []
        for _ in range(4):
            before, begin = _children_cpu(), time.perf_counter()
            subprocess.run(
                [sys.executable, "-c", code, *command], env=around, capture_output=True, check=True
            )
            spent.append(_children_cpu() - before)
            walls.append(time.perf_counter() - begin)
    warm = float(np.median(spent[1:]))
    yield Figure(case, "compile_cpu_s", spent[0] - warm, "s", "target", 10.0)
    yield Figure(case, "command_cpu_s", warm, "s")
    yield Figure(case, "command_s", float(np.median(walls[1:])), "s", "target", 1.0)


def _children_cpu() -> float:
    """s of CPU time of the processes that were started and are over."""
    used = resource.getrusage(resource.RUSAGE_CHILDREN)
    return used.ru_utime + used.ru_stime


def measure(case: str) -> Iterator[Figure]:
    """Figures of one case."""
    if case == "1000-moves":
        return thousand_moves(case)
    return other_robot(case) if case in OTHERS else start_up(case)


if __name__ == "__main__":
    main(__doc__ or "", measure, ["1000-moves", *OTHERS, "start-up"])
