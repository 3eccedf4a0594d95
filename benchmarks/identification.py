"""How well fitted motion models predict logged runs that had no part in the fit.

    FLYBY_LOGS=… python benchmarks/identification.py [--json] [--case table-studio] [--folds 6]

FLYBY_LOGS names a folder of records of runs (see `flyby.identification.logs`). Each run is a case:
greatest distance and 99 % of the log's samples from the emulated path of the TCP (``path_max_mm``,
``path_p99_mm``), the same of joints, time aside (``joint_max_deg``), at their time after one
constant offset (``joint_p99_deg``, with the drift over the run, ``drift_ms``), and emulated over
logged time in motion (``cycle_time_ratio``). Which fit predicts a run depends on the robot:

- Of a robot with fitted figures the runs of the source with the most runs are its *lesson*. Each of
  them is left out in its turn: all figures are fitted anew to the others. The peer is ``in the
  fit``: the same figure where the run takes part.
- Runs of other sources (other programs, the real robot) are predicted by the fit to the lesson.
- Where zones are not recorded one factor on them is fitted to each run, to its odd corners for its
  even ones and the other way round; peer ``own radius``, with the mean factor. It is not predicted.
- A robot without fitted figures is predicted as its vendor's files say.

Stamps of virtual controllers are put right by the clock that the fit to the *other* runs found, as
peer ``clock`` says. Runs whose speeds nobody recorded have no figures of time.

``table-…`` sum up the runs of a source by classes of speed and of moves: medians and the worst of
the greatest distance from the path, of how far cycle times are off, and of joints at their time;
peer ``goal``. The lesson's runs are left out by kinds there, not one by one: all runs of one
program at one speed together, kinds dealt out to ``--folds`` fits to the others. Those of other
sources are predicted as the vendor's files say; those whose zones nobody recorded by the factor
that fits all of their corners, so that this is read off the log it is judged by. ``--folds 0`` fits
nothing: the lesson is predicted by the shipped figures, which it has had part in, and its lines say
so. Runs whose record states neither zones nor speeds are in two lines, as recorded and ``as
driven``, with both as the log and the source's notes show them (`AS_DRIVEN`). Those of a real robot
are in two lines as well: as its type is driven, and with ``own servos``, which `flyby identify`
fits of one robot, fitted to its other runs, left out by kinds likewise.

``kuka-filters`` has the greatest distance from the path of each run of the KR 3 by the length of
the filter (two averages over half of it), and, as peer ``left out``, with the length that the other
runs of its kind would choose.

``fit-abb`` is the fit to the lesson of the IRB 6640 on two cores, from rough starts (no bulge in
corners, all else off by a quarter): seconds from the prepared runs to intervals, and ``cpu_s`` of
all processes, which another load on the machine does not change; ``loss`` beside that of the fit
from the shipped figures.
"""

from __future__ import annotations

import os
import re
import sys
import time
from collections import Counter
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from functools import cache
from pathlib import Path

import numpy as np
from report import Figure, main

from flyby.core.motion.model.motion_model import MotionModel
from flyby.core.program.speed import Speed
from flyby.core.program.zone import ContourFraction, Fine, Radius, Zone
from flyby.core.registry import find_robot, find_vendor
from flyby.identification.fit import Fit, ParameterSet, PreparedRun, fit, prepare
from flyby.identification.fit.emulation import Nuisance
from flyby.identification.fit.holding import FIRST, evened
from flyby.identification.fit.layers import servo_parameters
from flyby.identification.fit.minimum import minimise
from flyby.identification.fit.outcome import predicted
from flyby.identification.fit.parameters import fitted_before
from flyby.identification.fit.problem import first_nuisances
from flyby.identification.fit.run_pool import RunPool
from flyby.identification.fit.selection import LeftOut, leave_out
from flyby.identification.logs import load_run
from flyby.identification.logs.records import find_record
from flyby.identification.logs.run import LoggedRun
from flyby.identification.prediction import Prediction

ABB = "abb/irb6640-180-255"
WORKERS = 2
Goals = tuple[float | None, float | None]
"""Of the median and of the worst."""
ROUGH = 1.25
TABLE = "table-"


@dataclass(frozen=True)
class Driven:
    """What a record does not say of a program.

    Args:
        zone: of all of its corners.
        speed: of all of its moves.
    """

    zone: Zone
    speed: Speed

    def of(self, run: LoggedRun) -> LoggedRun:
        """The run with that."""
        moves = (
            replace(
                move, speed=self.speed, zone=move.zone if isinstance(move.zone, Fine) else self.zone
            )
            for move in run.program.moves
        )
        program = run.program.with_moves(tuple(moves))
        return replace(run, program=program, zones_known=True)


AS_DRIVEN = {
    # Zones and accelerations are read off the logs.
    "ur10e_ursim/lin": Driven(Radius(0.1), Speed(tcp=1.0, tcp_acceleration=0.5)),
    "ur10e_ursim/ptp": Driven(Radius(0.1), Speed(joint=0.5, joint_acceleration=0.5)),
    # PTP … C_PTP with $APO.CPTP as BAS(#INITMOV) leaves it, $ACC_AXIS 50 %, says the source; speeds
    # of the leading joints are 10 % in the logs.
    "kuka_kr3_real/ptp": Driven(
        ContourFraction(0.5), Speed(joint_fraction=0.1, joint_acceleration_fraction=0.5)
    ),
}
"""By folder and name of the run."""
FILTERS = (0.0, 0.048, 0.06, 0.072, 0.084, 0.096, 0.108, 0.12)
"""s."""


@cache
def files() -> dict[str, list[Path]]:
    """Records by robot; none if FLYBY_LOGS is not set."""
    folder = os.environ.get("FLYBY_LOGS")
    if folder is None:
        print("FLYBY_LOGS is not set: no logged runs to fit to", file=sys.stderr)
        return {}
    found: dict[str, list[Path]] = {}
    for path in sorted(Path(folder).glob("**/*.json")):
        record = find_record(path)
        if record is not None:
            found.setdefault(record.robot, []).append(path)
    return found


@cache
def parameters(robot: str) -> ParameterSet:
    """What the robot's figures were fitted by."""
    model = find_vendor(robot.split("/")[0]).motion_of(find_robot(robot))
    return ParameterSet.named(model, fitted_before(model))


def prepared(path: Path, as_driven: bool = False) -> PreparedRun:
    """A run, laid on what is emulated today; the same one, however it is asked for."""
    return _prepared(path, as_driven)


@cache
def _prepared(path: Path, as_driven: bool) -> PreparedRun:
    return laid_on(path, as_driven, parameters(loaded(path, as_driven).robot).base)


def laid_on(path: Path, as_driven: bool, model: MotionModel) -> PreparedRun:
    """A run, laid on what a model emulates."""
    run = loaded(path, as_driven)
    return prepare(run, find_vendor(run.robot.split("/")[0]), find_robot(run.robot), model)


@cache
def loaded(path: Path, as_driven: bool) -> LoggedRun:
    """A run as recorded, or as driven."""
    run = load_run(path, find_robot)
    return driven_as(path).of(run) if as_driven else run


def driven_as(path: Path) -> Driven:
    """What its record does not say."""
    name = f"{path.parent.name}/{path.stem}"
    return next(one for key, one in AS_DRIVEN.items() if name.startswith(key))


@cache
def lesson(robot: str) -> tuple[PreparedRun, ...]:
    """The runs that the robot's figures are fitted to; none if it has none."""
    if not parameters(robot).size:
        return ()
    known = [prepared(path) for path in files()[robot]]
    source, _ = Counter(run.run.source for run in known).most_common(1)[0]
    return tuple(run for run in known if run.run.source == source)


@cache
def whole_fit(robot: str) -> Fit:
    """The fit to the whole lesson, from the shipped figures."""
    return fit(parameters(robot), lesson(robot), WORKERS)


def clocks(robot: str) -> dict[str | None, float]:
    """What the whole fit says of the clocks of its runs."""
    own = whole_fit(robot).nuisances
    return {run.clock: one.clock for run, one in zip(lesson(robot), own, strict=True)}


def left_out(case: str) -> Iterator[Figure]:
    """Figures of one run."""
    run = prepared(CASES[case])
    robot = run.robot.name
    if not run.run.zones_known:
        yield from by_other_corners(case, run)
    elif run in lesson(robot):
        yield from by_other_runs(case, run, robot)
    elif lesson(robot):
        own = replace(first_nuisances([run])[0], clock=clocks(robot).get(run.clock, 1.0))
        yield from figures(case, run, predicted(run, whole_fit(robot).model, own), own)
    else:
        own = replace(first_nuisances([run])[0], clock=1.0)
        yield from figures(case, run, predicted(run, parameters(robot).base, own), own)


def by_other_runs(case: str, run: PreparedRun, robot: str) -> Iterator[Figure]:
    """The run predicted by a fit to the rest of the lesson."""
    found, known = whole_fit(robot), lesson(robot)
    index = known.index(run)
    near = found.parameters.starting_at(found.values)
    left: LeftOut = leave_out(known, found.nuisances, near, [(index,)], WORKERS)[0]
    own = left.nuisances[0]
    inside = predicted(run, found.model, found.nuisances[index])
    yield from figures(case, run, predicted(run, left.model, own), own, inside)


def by_other_corners(case: str, run: PreparedRun) -> Iterator[Figure]:
    """Each half of the corners, predicted with the factor on zones that fits the other half."""
    model = parameters(run.robot.name).base
    path, joints, sizes = [], [], []
    for half in (0, 1):
        taught = run.cluster % 2 == half
        part = run.only(taught)
        with RunPool([part]) as pool:
            (own,) = minimise(pool, ParameterSet(model, ()), first_nuisances([part])).nuisances
        found = predicted(run, model, own)
        other = nearest_waypoint(found) % 2 != half
        path.append(found.residuals.path[other])
        joints.append(np.abs(found.residuals.joint_path[other]).max(axis=1))
        sizes.append(own.size)
    told = "own radius", float(np.mean(sizes))
    away = 1e3 * np.concatenate(path)
    yield Figure(case, "path_max_mm", float(away.max()), "mm", *told)
    yield Figure(case, "path_p99_mm", float(np.percentile(away, 99)), "mm", *told)
    turned = np.degrees(np.concatenate(joints))
    yield Figure(case, "joint_max_deg", float(turned.max()), "deg", *told)


def nearest_waypoint(found: Prediction) -> np.ndarray:
    """(K,) of the samples, as `PreparedRun.cluster` counts them."""
    trajectory, path = found.driven.trajectory, found.driven.path
    passed = np.interp(path.layout.waypoint, trajectory.sigma, trajectory.t)
    return np.searchsorted(0.5 * (passed[1:] + passed[:-1]), found.alignment.time)


def figures(
    case: str,
    run: PreparedRun,
    found: Prediction,
    own: Nuisance,
    inside: Prediction | None = None,
) -> Iterator[Figure]:
    """Of a prediction, beside what the fit says of a run that takes part in it."""
    f, known = found.figures, None if inside is None else inside.figures

    def figure(name: str, key: str, scale: float, unit: str) -> Figure:
        value = scale * getattr(f, key)
        peer = None if known is None else scale * getattr(known, key)
        return Figure(case, name, value, unit, "" if peer is None else "in the fit", peer)

    yield figure("path_max_mm", "path_max", 1e3, "mm")
    yield figure("path_p99_mm", "path_p99", 1e3, "mm")
    yield figure("joint_max_deg", "joint_path_max", np.degrees(1.0), "deg")
    if run.by_place:
        return
    yield figure("joint_p99_deg", "joint_time_p99", np.degrees(1.0), "deg")
    yield figure("drift_ms", "drift", 1e3, "ms")
    yield Figure(case, "cycle_time_ratio", f.cycle_time_ratio, "", "clock", own.clock)


@dataclass(frozen=True)
class RunClass:
    """Runs that one line of the table sums up.

    Args:
        folder: of the logs.
        names: a pattern that names of its runs have.
        path: goals of the greatest distance from the path in mm, median and worst.
        cycle: of how far cycle times are off, in percent, median and worst.
        joints: of joints at their time, in degrees, median and worst.
        as_driven: whether zones and speeds are those of `AS_DRIVEN`, not of the record.
        own_servos: whether the robot's servos are fitted to its other runs.
    """

    folder: str
    names: str
    path: Goals = (None, None)
    cycle: Goals = (None, None)
    joints: Goals = (None, None)
    as_driven: bool = False
    own_servos: bool = False


CYCLE, REAL_CYCLE = (0.5, 3.0), (1.0, 5.0)
STUDIO, REAL, KUKA = "abb_irb6640_robotstudio", "abb_irb6640_real", "kuka_kr3_real"
CLASSES = {
    "studio-50": RunClass(STUDIO, "__v50_", (0.05, 0.6), CYCLE, (0.1, 0.1)),
    "studio-500": RunClass(STUDIO, "__v500_", (0.15, 0.6), CYCLE, (0.1, 0.1)),
    "studio-1000-vmax": RunClass(STUDIO, "__v(1000|max)_", (0.3, 0.6), CYCLE),
    "studio-1000": RunClass(STUDIO, "__v1000_", joints=(0.1, 0.1)),
    "studio-vmax": RunClass(STUDIO, "__vmax_", joints=(0.3, 0.3)),
    "real-500": RunClass(REAL, "__v[35]0?0_", (0.2, None), REAL_CYCLE, (0.1, 0.1)),
    "real-1000": RunClass(REAL, "__v1000_", (0.6, None), REAL_CYCLE, (0.1, 0.1)),
    "real-vmax": RunClass(REAL, "__vmax_", (1.0, None), REAL_CYCLE, (0.3, 0.3)),
    "real-500, own servos": RunClass(
        REAL, "__v[35]0?0_", (0.2, None), REAL_CYCLE, (0.1, 0.1), own_servos=True
    ),
    "real-1000, own servos": RunClass(
        REAL, "__v1000_", (0.6, None), REAL_CYCLE, (0.1, 0.1), own_servos=True
    ),
    "real-vmax, own servos": RunClass(
        REAL, "__vmax_", (1.0, None), REAL_CYCLE, (0.3, 0.3), own_servos=True
    ),
    "ursim-movel": RunClass("ur10e_ursim", "^lin", (0.01, None), as_driven=True),
    "ursim-movel, as recorded": RunClass("ur10e_ursim", "^lin"),
    "ursim-movej": RunClass("ur10e_ursim", "^ptp", (0.05, None), as_driven=True),
    "ursim-movej, as recorded": RunClass("ur10e_ursim", "^ptp"),
    "kuka-lin": RunClass("kuka_kr3_real", "^lin", (0.12, None)),
    "kuka-ptp": RunClass("kuka_kr3_real", "^ptp", (0.2, None), as_driven=True),
    "kuka-ptp, as recorded": RunClass("kuka_kr3_real", "^ptp"),
}


def table(case: str, folds: int) -> Iterator[Figure]:
    """Medians and worst of the classes of one source."""
    wanted = case.removeprefix(TABLE)
    if folds and wanted == "studio":
        yield Figure(case, "folds", folds, "", "runs in the lesson", len(lesson(ABB)))
    for name, one in CLASSES.items():
        if not name.startswith(f"{wanted}-") or (one.own_servos and not folds):
            continue
        chosen = [
            path
            for path in CASES.values()
            if path.parent.name == one.folder and re.search(one.names, path.stem)
        ]
        made = [held_back(path, folds, one) for path in chosen]
        timed = [
            found.figures
            for found, path in zip(made, chosen, strict=True)
            if not prepared(path).by_place
        ]
        known = wanted == "studio" and not folds
        yield Figure(case, f"{name}: runs{' in the fit' if known else ''}", len(made), "")
        for what, unit, values, goals in (
            ("path_max", "mm", [1e3 * found.figures.path_max for found in made], one.path),
            ("path_p99", "mm", [1e3 * found.figures.path_p99 for found in made], (None, None)),
            ("cycle_off", "%", [1e2 * abs(f.cycle_time_ratio - 1) for f in timed], one.cycle),
            ("joint_p99", "deg", [np.degrees(f.joint_time_p99) for f in timed], one.joints),
        ):
            for how, of, goal in zip(("median", "worst"), (np.median, np.max), goals, strict=True):
                if values:
                    told = "" if goal is None else "goal"
                    yield Figure(case, f"{name}: {what} {how}", float(of(values)), unit, told, goal)


def held_back(path: Path, folds: int, one: RunClass) -> Prediction:
    """A run as figures predict it that it had no part in, as far as there are such."""
    run = prepared(path, one.as_driven)
    robot = run.robot.name
    if one.own_servos:
        model, _ = servos_by_kinds(robot, folds)[path.stem]
        return by_model(run, model)
    if folds and run in lesson(robot):
        model, own = by_kinds(robot, folds)[path.stem]
        return predicted(run, model, own)
    return by_model(run, parameters(robot).base)


def by_model(run: PreparedRun, model: MotionModel) -> Prediction:
    """A run as a model predicts it, but for what is its own."""
    with RunPool([run]) as pool:
        (own,) = minimise(pool, ParameterSet(model, ()), first_nuisances([run])).nuisances
    return predicted(run, model, own)


def kuka_filters(case: str) -> Iterator[Figure]:
    """What lengths of the filter make of the runs of lines, and of joint moves."""
    for kind, as_driven in (("lin", False), ("ptp", True)):
        chosen = [path for path in CASES.values() if path.parent.name == KUKA]
        chosen = [path for path in chosen if path.stem.startswith(kind)]
        off = np.zeros((len(chosen), len(FILTERS)))
        for k, path in enumerate(chosen):
            base = parameters(prepared(path).robot.name).base
            for n, length in enumerate(FILTERS):
                widths = (0.5 * length,) * 2
                model = replace(base, smoothing=widths, joint_smoothing=widths)
                found = by_model(laid_on(path, as_driven, model), model)
                off[k, n] = 1e3 * found.figures.path_max
        for k, path in enumerate(chosen):
            own = int(np.argmin(np.delete(off, k, axis=0).sum(axis=0)))
            for n, length in enumerate(FILTERS):
                name = f"{path.stem}: path_max, {1e3 * length:.0f} ms"
                told = ("left out", off[k, own]) if n == own else ("", None)
                yield Figure(case, name, off[k, n], "mm", *told)


@cache
def by_kinds(robot: str, folds: int) -> dict[str, tuple[MotionModel, Nuisance]]:
    """Of each run of the lesson, a model that was fitted without its kind, and what is its own."""
    return without_kinds(lesson(robot), parameters(robot), folds)


@cache
def servos_by_kinds(robot: str, folds: int) -> dict[str, tuple[MotionModel, Nuisance]]:
    """The same of the runs of a real robot, with figures of its servos."""
    base = parameters(robot).base
    known = [prepared(path) for path in files()[robot] if path.parent.name == REAL]
    runs, first = evened(base, known, WORKERS)
    wanted = ParameterSet.named(base, servo_parameters(base, find_robot(robot)))
    return without_kinds(runs, replace(wanted, hold=FIRST * first), folds)


def without_kinds(
    known: Sequence[PreparedRun], wanted: ParameterSet, folds: int
) -> dict[str, tuple[MotionModel, Nuisance]]:
    """Of each run a model that was fitted without its kind, and what is its own."""
    kinds = [run.name.rpartition("_")[0] for run in known]
    fold = {kind: k % folds for k, kind in enumerate(sorted(set(kinds)))}
    groups = [tuple(k for k, kind in enumerate(kinds) if fold[kind] == f) for f in range(folds)]
    begin = first_nuisances(known)
    made: dict[str, tuple[MotionModel, Nuisance]] = {}
    for left in leave_out(known, begin, wanted, [one for one in groups if one], WORKERS):
        for k, own in zip(left.indices, left.nuisances, strict=True):
            made[known[k].name] = left.model, own
    return made


def fit_abb(case: str) -> Iterator[Figure]:
    """Wall time of the whole fit."""
    known, shipped = lesson(ABB), whole_fit(ABB)
    rough = parameters(ABB)
    starts = np.array(
        [0.0 if p.name.startswith("blend.") else ROUGH * p.start for p in rough.parameters]
    )
    begin, spent = time.perf_counter(), _cpu()
    found = fit(rough.starting_at(starts), known, WORKERS)
    seconds = time.perf_counter() - begin
    yield Figure(case, "wall_s", seconds, "s")
    yield Figure(case, "cpu_s", _cpu() - spent, "s", "goal", 40.0)
    yield Figure(case, "iterations", found.iterations, "")
    yield Figure(case, "loss_before", found.before, "")
    yield Figure(case, "loss", found.after, "", "from shipped", shipped.after)
    for one in found.intervals:
        yield Figure(case, one.name, one.value, "", "standard deviation", one.deviation)


def _cpu() -> float:
    """s of this process and its children that have ended."""
    return sum(os.times()[:4])


def measure(case: str, folds: int) -> Iterator[Figure]:
    """Figures of one case."""
    if case.startswith(TABLE):
        return table(case, folds)
    if case == "kuka-filters":
        return kuka_filters(case)
    return fit_abb(case) if case == "fit-abb" else left_out(case)


if __name__ == "__main__":
    CASES = {
        f"{path.parent.name}/{path.stem}": path for paths in files().values() for path in paths
    }
    tables = dict.fromkeys(TABLE + name.partition("-")[0] for name in CLASSES)
    sums = [*tables, "kuka-filters", "fit-abb"] if CASES else []
    main(__doc__ or "", measure, [*sums, *CASES], sums, folds=6)
