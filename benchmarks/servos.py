"""What figures of one real robot's servos take off the errors of runs that had no part in them.

    FLYBY_LOGS=… python benchmarks/servos.py [--json]

Runs of the real IRB 6640-180/2.55 are emulated as its type is driven (the shipped motion model),
then with figures that were fitted to the other kinds of runs: lags of all joints
(``elasticity.lag_s``), friction of joints 2 and 3, drag of joints 1 to 3 (``servo``), and several
of them. They are fitted to the joints' path, time aside, by linear least
squares with the weights of `flyby identify`, to runs whose times the emulation holds; the way and
the time of friction are those of nine pairs that leave the others the least. A kind are the runs of
like speeds (``by speed``), or of one program (``by program``). Cases are the kinds of speed;
figures are means over their runs of an error over that without the servos' figures: of the TCP's
path the greatest, 99 % and root mean square, of the joints' path the root mean square. Of distances
medians of seven samples in a row count, as single samples of these logs are torn. Peer ``worst
run`` is the greatest of a kind's. ``fitted`` tells the figures of a fit to all runs.
"""

from __future__ import annotations

import os
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, replace
from functools import cache
from itertools import product
from pathlib import Path

import numpy as np
from report import Figure, main
from scipy.ndimage import median_filter

from flyby.core.arrays import FloatArray
from flyby.core.motion.command.commanded_motion import stamped_motion
from flyby.core.motion.command.servo import offsets_at
from flyby.core.motion.model.motion_model import MotionModel
from flyby.core.motion.model.servo import Servo
from flyby.core.registry import find_robot, find_vendor
from flyby.identification.fit import PreparedRun, prepare
from flyby.identification.fit.outcome import predicted
from flyby.identification.fit.problem import first_nuisances
from flyby.identification.logs import load_run
from flyby.identification.prediction import Prediction

ROBOT = find_robot("abb/irb6640-180-255")
ABB = find_vendor("abb")
TYPE = ABB.motion_of(ROBOT)
FOLDER = "abb_irb6640_real"
SPEEDS = {"50": "50", "300": "300-500", "500": "300-500", "1000": "1000", "max": "max"}
RUBBED = (1, 2)
"""Joints, counted from zero, that turn back in runs of more than one kind."""
GIVING = (0, 1, 2)
"""Joints, counted from zero, that carry the arm."""
IN_TIME = np.radians(1.0)
"""By how much joints may be off at their time in runs that figures are fitted to."""
WAYS = tuple(product((1e-4, 2e-4, 5e-4), (0.3, 0.6, 1.0)))
"""rad within which friction sets in, and s within which it fades."""
UNIT = 1e-3
"""rad of friction, or s of lag, that columns are made with."""
COARSER = 4
"""Samples of the emulation to one of what friction adds."""
MEDIAN = 7
MOST = 800
"""Samples of a run that figures are fitted to, about."""
SLOWEST = 0.02
"""Share of the greatest speed below which a sample tells no direction."""
ERRORS = ("path_max", "path_p99", "path_rms", "joint_path_rms")
SETS = {
    "lag": (True, False, False),
    "friction": (False, True, False),
    "without drag": (True, True, False),
    "all": (True, True, True),
}
"""Which figures there are: lags, friction, drag."""


@dataclass(frozen=True, eq=False)
class Regression:
    """What a run says of figures that the joints' path is linear in, (R,) and (R, P) rows."""

    values: FloatArray
    lag: FloatArray
    drag: FloatArray
    friction: dict[tuple[float, float], FloatArray]


@cache
def runs() -> dict[str, PreparedRun]:
    """By name."""
    folder = Path(os.environ["FLYBY_LOGS"]) / FOLDER
    loaded = (load_run(path, find_robot) for path in sorted(folder.glob("*.json")))
    return {run.name: prepare(run, ABB, ROBOT, TYPE) for run in loaded}


def speed_of(name: str) -> str:
    """The kind of speed of a run."""
    return SPEEDS[name.split("__v")[1].split("_")[0]]


def program_of(name: str) -> str:
    """The program of a run, at any speed."""
    return name.split("__")[0]


KINDS: dict[str, Callable[[str], str]] = {"by speed": speed_of, "by program": program_of}


def emulated(name: str, model: MotionModel) -> Prediction:
    """A run beside its emulation."""
    run = runs()[name]
    return predicted(run, model, replace(first_nuisances([run])[0], clock=1.0))


@cache
def regression(name: str) -> Regression:
    """A run's rows."""
    found = emulated(name, TYPE)
    made, time = found.driven.trajectory, found.alignment.time

    def then(values: FloatArray, t: FloatArray) -> FloatArray:
        return np.stack([np.interp(time, t, column) for column in values.T], -1)

    speed = then(made.dq_motor, made.t)
    size = np.linalg.norm(speed, axis=1)
    moving = np.flatnonzero(size > SLOWEST * size.max())
    moving = moving[:: max(len(moving) // MOST, 1)]
    along = speed / np.maximum(size, 1e-9)[:, None]
    weight = (1.0 / (20e-6 + 1e-4 * size) / np.sqrt(len(moving)))[:, None]

    def aside(values: FloatArray) -> FloatArray:
        rest = values - along * np.sum(values * along, axis=1, keepdims=True)
        return np.asarray((weight * rest)[moving].ravel())

    def columns(values: FloatArray, joints: Sequence[int]) -> FloatArray:
        one = np.eye(values.shape[1])
        return np.stack([aside(values * one[joint]) for joint in joints], -1)

    controller, driven = runs()[name].controller(TYPE), found.driven
    smoothing = controller.smoothing(driven.program, driven.path)
    coarse = made.t[::COARSER]
    stamped = stamped_motion(driven.timing)
    states = smoothing.command(stamped, coarse)
    friction = {}
    for rise, fade in WAYS:
        servo = Servo((UNIT,) * ROBOT.size, rise=rise, fade=fade)
        rubbed = offsets_at(servo, smoothing, stamped, coarse, states)
        friction[rise, fade] = columns(then(rubbed, coarse), RUBBED)
    dragged = Servo(drag=(UNIT,) * ROBOT.size)
    drag = then(offsets_at(dragged, smoothing, stamped, coarse, states), coarse)
    off = median_filter(found.alignment.off, (MEDIAN, 1), mode="nearest")
    lag = columns(UNIT * speed, range(ROBOT.size))
    return Regression(aside(off), lag, columns(drag, GIVING), friction)


@cache
def in_time(name: str) -> bool:
    """Whether the emulation holds a run's times."""
    return emulated(name, TYPE).figures.joint_time_p99 < IN_TIME


def fitted(names: Sequence[str], lags: bool, rubs: bool, drags: bool) -> MotionModel:
    """The motion model with figures that are fitted to runs."""
    rows = [regression(name) for name in names if in_time(name)]
    best = np.inf, TYPE
    for ways in WAYS if rubs else WAYS[:1]:
        parts = [
            np.hstack([r.lag] * lags + [r.friction[ways]] * rubs + [r.drag] * drags) for r in rows
        ]
        found, loss = robust(np.vstack(parts), rows)
        lag, rest = np.split(found, [ROBOT.size * lags])
        friction, drag = (np.zeros(ROBOT.size) for _ in range(2))
        held, dragged = np.split(rest, [len(RUBBED) * rubs])
        friction[list(RUBBED)[: len(held)]] = held
        drag[list(GIVING)[: len(dragged)]] = dragged
        model = TYPE
        if lags:
            shifts = tuple(map(float, UNIT * (lag - lag.mean())))
            model = replace(model, elasticity=replace(model.elasticity, lag=shifts))
        if rubs or drags:
            rub, pull = (tuple(map(float, UNIT * one)) for one in (friction, drag))
            servo = Servo(rub, *ways, drag=pull)
            model = replace(model, servo=servo)
        best = min(best, (loss, model), key=lambda pair: pair[0])
    return best[1]


def robust(columns: FloatArray, rows: Sequence[Regression]) -> tuple[FloatArray, float]:
    """Least pseudo-Huber loss of rows: where, and what it is."""
    values = np.concatenate([r.values for r in rows])
    share = np.concatenate([np.full(r.values.size, (r.values.size / 6) ** 0.5) for r in rows])
    held = np.ones(values.size)
    for _ in range(12):
        weighted = columns * held[:, None] ** 2
        found = np.linalg.pinv(columns.T @ weighted, 1e-9, True) @ (weighted.T @ values)
        off = (values - columns @ found) * share / 2.0
        held = (1.0 + off**2) ** -0.25
    return found, float(np.sum((np.sqrt(1.0 + off**2) - 1.0) / share**2))


def errors(name: str, model: MotionModel) -> FloatArray:
    """`ERRORS` of a run."""
    found = emulated(name, model)
    path = median_filter(found.residuals.path, MEDIAN, mode="nearest")
    joints = median_filter(np.abs(found.residuals.joint_path).max(axis=1), MEDIAN, mode="nearest")
    rms = [float(np.sqrt(np.mean(values**2))) for values in (path, joints)]
    return np.array([path.max(), np.percentile(path, 99), *rms])


@cache
def left_out(by: str, kind: str, figures: str) -> MotionModel:
    """Fitted to all runs that are not of a kind."""
    return fitted([name for name in runs() if KINDS[by](name) != kind], *SETS[figures])


def measure(case: str) -> Iterator[Figure]:
    """Figures of one case."""
    if case == "fitted":
        for figures in SETS:
            model = fitted(list(runs()), *SETS[figures])
            servo = model.servo
            told = {
                "lag": model.elasticity.lag,
                "friction": servo.friction,
                "drag": servo.drag,
            }
            for key, values in told.items():
                for joint, value in enumerate(values):
                    if value:
                        yield Figure(case, f"{figures}: {key} {joint + 1}", 1e3 * value, "1e-3")
            if any(model.servo.friction):
                yield Figure(case, f"{figures}: rise", 1e3 * model.servo.rise, "1e-3")
                yield Figure(case, f"{figures}: fade", model.servo.fade, "s")
        return
    names = [name for name in runs() if speed_of(name) == case]
    without = np.array([errors(name, TYPE) for name in names])
    for k, error in enumerate(ERRORS):
        unit, scale = ("mm", 1e3) if k < 3 else ("mrad", 1e3)
        worst = scale * without[:, k].max()
        yield Figure(case, f"without: {error}", scale * without[:, k].mean(), unit, "worst", worst)
    for by, kind in KINDS.items():
        for figures in SETS:
            share = (
                np.array([errors(name, left_out(by, kind(name), figures)) for name in names])
                / without
            )
            for k, error in enumerate(ERRORS):
                told = f"{by}, {figures}: {error}"
                yield Figure(case, told, share[:, k].mean(), "", "worst run", share[:, k].max())


if __name__ == "__main__":
    cases = [*dict.fromkeys(SPEEDS.values()), "fitted"] if "FLYBY_LOGS" in os.environ else []
    main(__doc__ or "", measure, cases)
