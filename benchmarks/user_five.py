"""What `flyby identify` makes of five runs, judged by five others that had no part in it.

    FLYBY_LOGS=… python benchmarks/user_five.py [--json] [--case real-1]

The fit begins with the shipped motion model of the IRB 6640, as a user's would, and is that of
`flyby identify` without ``--fit``: figures of the type, or of the robot's servos. A case is a split
of a source's runs into five to learn from, five to judge by, and the rest, drawn by the case's
number:

- ``other-…``: RobotStudio's virtual controller at places, postures and turns that the shipped
  figures were not fitted to. The robot is the same.
- ``real-…``: the real robot, which differs.
- ``same-…``: RobotStudio's programs, driven by the shipped model itself, with noise.
- ``changed-…``: the same, every fitted figure off by a fifth (standard deviation), and all torque's
  limits by as much together: a robot that differs, and that the model has all figures of.

``loss_ratio`` and ``path_ratio`` are geometric means over the five others of the loss after over
that before, whole and of the TCP's path; below 1 is better. Where runs held back did not show a
gain, no model is handed out (``handed_out`` 0) and the user keeps that before: ratios are 1 then,
peer ``forced`` is what the refused model would have given. ``path_max_mm`` and ``cycle_off`` are
medians over the others (``worst_…`` the greatest), peer ``before``.
"""

from __future__ import annotations

import os
import time
from collections.abc import Iterator, Sequence
from pathlib import Path

import numpy as np
from report import Figure, main

from flyby.core.arrays import FloatArray
from flyby.core.motion.emulator.controller import Controller
from flyby.core.motion.model.motion_model import MotionModel
from flyby.core.registry import find_robot, find_vendor
from flyby.identification.fit import ParameterSet, PreparedRun, fit_usual, prepare
from flyby.identification.fit.minimum import minimise
from flyby.identification.fit.outcome import predicted
from flyby.identification.fit.parameters import fitted_before
from flyby.identification.fit.problem import first_nuisances
from flyby.identification.fit.run_pool import RunPool
from flyby.identification.fit.selection import losses_of
from flyby.identification.logs import LoggedRun, load_run
from flyby.identification.logs.synthetic import Faults, synthetic_run
from flyby.identification.residuals import Figures

ROBOT = find_robot("abb/irb6640-180-255")
ABB = find_vendor("abb")
TYPE = ABB.motion_of(ROBOT)
STUDIO, REAL = "abb_irb6640_robotstudio", "abb_irb6640_real"
OTHER = ("movel2", "close", "lcl", "lll", "smooth", "ori__vmax", "movec_30_ori", "c_30_car__vmax")
"""In the names of RobotStudio's runs that the shipped figures were not fitted to."""
SPLITS = {"other": 2, "real": 5, "same": 1, "changed": 2}
FIVE = 5
OFF = 0.2
TINY = 1e-3
WORKERS = 2


def logs(folder: str) -> list[LoggedRun]:
    """All runs of a source, in the order of their names."""
    found = sorted((Path(os.environ["FLYBY_LOGS"]) / folder).glob("*.json"))
    return [load_run(path, find_robot) for path in found]


def runs_of(kind: str, number: int) -> tuple[list[PreparedRun], list[PreparedRun]]:
    """Five to learn from and five to judge by."""
    rng = np.random.default_rng(number)
    known = logs(REAL if kind == "real" else STUDIO)
    if kind == "other":
        known = [run for run in known if any(part in run.name for part in OTHER)]
    chosen = [known[k] for k in rng.permutation(len(known))[: 2 * FIVE]]
    if kind in ("same", "changed"):
        truth = changed(rng) if kind == "changed" else TYPE
        controller = Controller(ABB, ROBOT, truth)
        chosen = [
            synthetic_run(controller, run.program, run.name, Faults(), k)
            for k, run in enumerate(chosen)
        ]
    ready = [prepare(run, ABB, ROBOT, TYPE) for run in chosen]
    return ready[:FIVE], ready[FIVE:]


def changed(rng: np.random.Generator) -> MotionModel:
    """A robot that differs from its type."""
    parameters = ParameterSet.named(TYPE, fitted_before(TYPE))
    lower, upper = parameters.bounds
    values = parameters.before * (1.0 + OFF * rng.standard_normal(parameters.size))
    return parameters.model(np.clip(values, lower, upper))


def judged(
    model: MotionModel, runs: Sequence[PreparedRun]
) -> tuple[FloatArray, FloatArray, list[Figures]]:
    """Losses of runs, whole and of the TCP's path, and their figures; offsets alone are theirs."""
    with RunPool(runs, WORKERS) as pool:
        end = minimise(pool, ParameterSet(model, ()), first_nuisances(runs))
        whole, path = losses_of(runs, pool.residuals(model, end.nuisances))
    found = [
        predicted(run, model, own).figures for run, own in zip(runs, end.nuisances, strict=True)
    ]
    return np.array(whole), np.array(path), found


def measure(case: str) -> Iterator[Figure]:
    """Figures of one split."""
    kind, _, number = case.partition("-")
    taught, others = runs_of(kind, int(number))
    begin = time.process_time()
    held = fit_usual(TYPE, ROBOT, taught)
    spent = time.process_time() - begin
    judgement = held.judgement
    handed_out = judgement is not None and judgement.better
    before, forced = judged(TYPE, others), judged(held.fit.model, others)
    after = forced if handed_out else before
    yield Figure(case, "handed_out", float(handed_out), "", "hold", held.share)
    for k, name in enumerate(("loss_ratio", "path_ratio")):
        ratios = [
            float(np.exp(np.mean(np.log((one[k] + TINY) / (before[k] + TINY)))))
            for one in (after, forced)
        ]
        yield Figure(case, name, ratios[0], "", "forced", ratios[1])
    for name, unit, of in (
        ("path_max", "_mm", lambda one: 1e3 * one.path_max),
        ("cycle_off", "", lambda one: abs(one.cycle_time_ratio - 1.0)),
        ("joint_p99", "_deg", lambda one: np.degrees(one.joint_time_p99)),
    ):
        now, then = ([of(one) for one in made[2]] for made in (after, before))
        yield Figure(case, name + unit, float(np.median(now)), unit[1:], "before", np.median(then))
        yield Figure(case, f"worst_{name}{unit}", max(now), unit[1:], "before", max(then))
    yield Figure(case, "cpu_s", spent, "s")


if __name__ == "__main__":
    cases = [f"{kind}-{k}" for kind, count in SPLITS.items() for k in range(count)]
    main(__doc__ or "", measure, cases if "FLYBY_LOGS" in os.environ else [])
