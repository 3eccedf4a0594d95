"""How well fitted motion models predict logged runs that had no part in the fit.

    FLYBY_LOGS=… python benchmarks/identification.py [--json] [--case fit-abb] [--folds 10]

FLYBY_LOGS names a folder of records of runs (see `flyby.identification.logs`). All runs of a robot
are divided into ``folds`` groups; each group is predicted by a fit of the robot's fitted figures to
the others. The robot's published and assumed figures are used as they are; of a robot without
figures fitted to numbers, only what belongs to a run itself is. Per run: greatest
distance and 99 % of the log's samples from the emulated path of the TCP (``path_max_mm``,
``path_p99_mm``), the same of joints, time aside (``joint_max_deg``), and at their time after one
constant offset (``joint_p99_deg``), and emulated over logged time in motion (``cycle_time_ratio``).
Stamps of virtual controllers are put right by the clock that the fit to the *other* runs found, as
peer ``clock`` says. Runs whose speeds nobody recorded have no figures of time; zones that nobody
recorded are fitted to the run itself (peer ``own radius``), and are not predicted.

``fit-abb`` is the fit to all virtual runs of the IRB 6640 on two cores, from rough starts
(no bulge in corners, all else off by a quarter): seconds from the prepared runs to intervals, and
``cpu_s`` of all processes, which another load on the machine does not change.
"""

from __future__ import annotations

import os
import sys
import time
from collections.abc import Iterator
from functools import cache
from pathlib import Path

import numpy as np
from report import Figure, main

from flyby.core.registry import find_robot, find_vendor
from flyby.identification.fit import ParameterSet, PreparedRun, fit, prepare
from flyby.identification.fit.outcome import predicted
from flyby.identification.fit.parameters import fitted_before
from flyby.identification.fit.selection import LeftOut, folds, leave_out
from flyby.identification.logs import load_run

ABB = "abb/irb6640-180-255"
WORKERS = 2
ROUGH = 1.25


@cache
def files() -> dict[str, list[Path]]:
    """Records by robot; none if FLYBY_LOGS is not set."""
    from flyby.identification.logs.records import robot_of_record

    folder = os.environ.get("FLYBY_LOGS")
    if folder is None:
        print("FLYBY_LOGS is not set: no logged runs to fit to", file=sys.stderr)
        return {}
    found: dict[str, list[Path]] = {}
    for path in sorted(Path(folder).glob("**/*.json")):
        robot = robot_of_record(path)
        if robot is not None:
            found.setdefault(robot, []).append(path)
    return found


@cache
def runs(robot: str) -> tuple[PreparedRun, ...]:
    """All runs of a robot, laid on what is emulated today."""
    arm, vendor = find_robot(robot), find_vendor(robot.split("/")[0])
    model = vendor.motion_of(arm)
    return tuple(prepare(load_run(path, find_robot), vendor, arm, model) for path in files()[robot])


def parameters(robot: str) -> ParameterSet:
    """What the robot's figures were fitted by."""
    arm = find_robot(robot)
    model = find_vendor(robot.split("/")[0]).motion_of(arm)
    return ParameterSet.named(model, fitted_before(model))


@cache
def predictions(robot: str, count: int) -> dict[str, tuple[PreparedRun, LeftOut, int]]:
    """Each run by a fit in which it had no part."""
    known = runs(robot)
    made = {}
    for left in leave_out(known, parameters(robot), folds(known, count), WORKERS):
        for place, index in enumerate(left.indices):
            made[known[index].name] = known[index], left, place
    return made


def left_out(case: str, count: int) -> Iterator[Figure]:
    """Figures of one run."""
    robot, name = ROBOTS[case], case.split(":")[1]
    run, left, place = predictions(robot, count)[name]
    own = left.nuisances[place]
    found = predicted(run, left.model, own)
    f = found.figures
    peer = "" if run.run.zones_known else "own radius"
    yield Figure(case, "path_max_mm", 1e3 * f.path_max, "mm", peer, None if not peer else own.size)
    yield Figure(case, "path_p99_mm", 1e3 * f.path_p99, "mm")
    yield Figure(case, "joint_max_deg", float(np.degrees(f.joint_path_max)), "deg")
    if run.by_place:
        return
    yield Figure(case, "joint_p99_deg", float(np.degrees(f.joint_time_p99)), "deg")
    yield Figure(case, "drift_ms", 1e3 * f.drift, "ms")
    yield Figure(case, "cycle_time_ratio", f.cycle_time_ratio, "", "clock", own.clock)


def fit_abb(case: str) -> Iterator[Figure]:
    """Wall time of the whole fit."""
    known = [run for run in runs(ABB) if run.run.real is False]
    rough = parameters(ABB)
    starts = np.array(
        [0.0 if p.name.startswith("blend.") else ROUGH * p.start for p in rough.parameters]
    )
    begin, spent = time.perf_counter(), _cpu()
    found = fit(rough.starting_at(starts), known, WORKERS)
    seconds = time.perf_counter() - begin
    yield Figure(case, "wall_s", seconds, "s", "target", 120.0)
    yield Figure(case, "cpu_s", _cpu() - spent, "s")
    yield Figure(case, "iterations", found.iterations, "")
    yield Figure(case, "loss", found.after, "", "at the start", found.before)
    for one in found.intervals:
        yield Figure(case, one.name, one.value, "", "standard deviation", one.deviation)


def _cpu() -> float:
    """s of this process and its children that have ended."""
    return sum(os.times()[:4])


def measure(case: str, folds: int) -> Iterator[Figure]:
    """Figures of one case."""
    return fit_abb(case) if case == "fit-abb" else left_out(case, folds)


def cases() -> dict[str, str]:
    """The robot of each case that leaves out a run."""
    return {f"{robot}:{path.stem}": robot for robot, paths in files().items() for path in paths}


if __name__ == "__main__":
    ROBOTS = cases()
    main(__doc__ or "", measure, [*(["fit-abb"] if ROBOTS else []), *ROBOTS], folds=10)
