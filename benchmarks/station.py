"""Several robots in one cell: what proofs of their clearances cost, and whether they hold.

    python benchmarks/station.py [--case four-robots] [--pairs 2000] [--first 0] [--json]

``crossing``: two robots whose tools cross one line, at one instant but for a signal; ``handshake``:
the example of two robots, with the interlock that could be given back earlier; ``studs``: the
example of four robots; ``four-robots``: 100 moves each, two facing pairs that share the middle
under interlocks; the last two beside the same with a stop at every point; ``four-robots-meshes``:
those with welding guns that are meshes of 10 000 triangles, in convex parts that enclose them;
``random-pairs``: stations of two robots of three makes at random, that cross, wait for each other
or hand over a part, proofs beside sampling at ten times the controllers' rate, from seed
``--first`` on.
CPU time of the process, kernels compiled; emulation and bounds of deviation are not counted.
"""

from __future__ import annotations

import math
import time
from collections import Counter
from collections.abc import Callable, Iterator
from itertools import combinations
from pathlib import Path
from tempfile import TemporaryDirectory

import numpy as np
from report import Figure, main

from flyby.core.cell.floor import bare_cell
from flyby.core.cell.geometry import Geometry
from flyby.core.collision.mutual.conflict import ConflictCause
from flyby.core.collision.mutual.meetings import Meetings
from flyby.core.collision.mutual.pair_proof import PairProver
from flyby.core.collision.scene.bodies import tool_like_solids
from flyby.core.errors import FlybyError
from flyby.core.motion.emulator.controller import Controller
from flyby.core.program.move import MoveJ
from flyby.core.program.program import Program
from flyby.core.program.signal import Level, SetSignal, WaitSignal
from flyby.core.program.speed import Speed
from flyby.core.program.target import JointTarget
from flyby.core.registry import find_robot, find_vendor
from flyby.core.spatial.pose import Pose
from flyby.core.station.actions import Action
from flyby.core.station.awaited import bearing
from flyby.core.station.clearances import StationProver
from flyby.core.station.clock import StationClock
from flyby.core.station.interlocks import savings
from flyby.core.station.orders import explore
from flyby.core.station.station import RobotStation, StationRobot, Wire
from flyby.tasks.station.opening import open_station
from flyby.tasks.station.station import station as open_and_prove
from flyby.validation.scenes.four_robots import DRAWN_BACK, four_robots, gun
from flyby.validation.stations.random_stations import RandomStation, random_station
from flyby.validation.stations.samples import Samples, trials_at_any_time, trials_in_time

EXAMPLES = Path(__file__).parents[1] / "examples"
CASES = ("crossing", "handshake", "studs", "four-robots", "four-robots-meshes", "random-pairs")
JITTER = 0.05
CLEARANCE = 0.01
HOME = np.array([0.0, -1.2, 1.6, -1.9, -1.57, 0.0])
ACROSS = np.array([1.0, 0.0, 0.0, 0.0, 0.0, 0.0])


def timed(job: Callable[[], object]) -> tuple[float, object]:
    """CPU seconds of a job, and what it gave."""
    begin = time.process_time()
    made = job()
    return time.process_time() - begin, made


def crossing() -> Iterator[Figure]:
    """Two robots drive towards each other over one line; the second may when the first has been
    there and back."""
    station, actions = _crossing(locked=True)
    free, its_actions = _crossing(locked=False)
    case = "crossing"
    yield from _figures(case, station, actions)
    prover = StationProver(free, its_actions).prover("a", "b")
    conflicts = prover.prove(CLEARANCE, _in_time(2 * JITTER)).conflicts
    yield Figure(case, "conflicts_without_interlock", len(conflicts), "")
    yield Figure(case, "dense_mm without interlock", 1e3 * _sampled(prover), "mm")


def handshake() -> Iterator[Figure]:
    """The example of two robots."""
    opened = open_station(EXAMPLES / "two_robots/station.toml", lambda _: None)
    yield from _figures("handshake", opened.station, opened.actions)


def studs() -> Iterator[Figure]:
    """The example of four robots that weld studs, beside the same with a stop at every point."""
    opened = open_station(EXAMPLES / "stud_station/station.toml", lambda _: None)
    with TemporaryDirectory() as folder:
        for file in (EXAMPLES / "stud_station").iterdir():
            text = file.read_text().replace("z20", "fine")
            (Path(folder) / file.name).write_text(text)
        stopping = open_station(Path(folder) / "station.toml", lambda _: None)
    stops = StationClock(stopping.station, stopping.actions).run().duration
    yield from _figures("studs", opened.station, opened.actions, stops)


def four() -> Iterator[Figure]:
    """Four robots of 100 moves."""
    station, actions = four_robots()
    stopping, its_actions = four_robots(stops=True)
    stops = StationClock(stopping, its_actions).run().duration
    yield from _figures("four-robots", station, actions, stops)


def four_with_meshes() -> Iterator[Figure]:
    """The same with guns that are meshes of 10 000 triangles."""
    case, shape = "four-robots-meshes", Geometry(gun())
    solids, _ = tool_like_solids("gun", shape)
    yield Figure(case, "triangles", len(gun().faces), "")
    yield Figure(case, "convex_parts", len(solids), "")
    yield from _figures(case, *four_robots(shape=shape, home=DRAWN_BACK))


def _figures(case: str, station, actions, stops: float | None = None) -> Iterator[Figure]:
    """What every case has."""
    run = StationClock(station, actions).run()
    peer = () if stops is None else ("stops only", stops)
    yield Figure(case, "station_time_s", run.duration, "s", *peer)
    actions = bearing(station, actions)
    _prove_all(StationProver(station, actions), station, run, actions)  # compiles
    swept, prover = timed(lambda: _swept(station, actions))
    yield Figure(case, "sweep_cpu_s", swept, "s")
    rows = _prove_all(prover, station, run, actions)
    yield Figure(case, "proof_cpu_s", sum(cpu for _, cpu, _ in rows), "s")
    yield Figure(case, "proven_mm", max(proven for _, _, proven in rows), "mm")
    for name, cpu, proven in rows:
        yield Figure(case, f"proof_cpu_s {name}", cpu, "s")
        yield Figure(case, f"proven_mm {name}", proven, "mm")
    orders = explore(station, actions)
    clearances = prover.all(run, JITTER, orders)
    yield Figure(case, "dense_mm", 1e3 * min(pair.least for pair in clearances), "mm")
    found = savings(station, actions, prover, clearances, orders)
    saved = max((saving.seconds for saving in found), default=0.0)
    yield Figure(case, "interlock_time_saved_s", saved, "s")


def _swept(station, actions) -> StationProver:
    """A prover with all motions swept."""
    prover = StationProver(station, actions)
    for pair in combinations(station.members, 2):
        prover.prover(*pair)
    return prover


def _prove_all(prover, station, run, actions) -> list[tuple[str, float, float]]:
    """CPU seconds of each question over all pairs, and the clearance in mm where it is proven."""
    orders = explore(station, actions)
    spent, fine = dict.fromkeys(("in time", "any time", "interlocked"), 0.0), {}
    for one, other in combinations(station.members, 2):
        pair = prover.prover(one, other)
        clocks = tuple(run.schedules[name].clocked for name in (one, other))
        jobs = {
            "in time": lambda p=pair, c=clocks: p.prove(
                CLEARANCE, Meetings(c, 2 * JITTER, every=False)
            ),
            "any time": lambda p=pair: p.prove(CLEARANCE, Meetings.at_any_time()),
            "interlocked": lambda a=one, b=other: prover.interlocked(a, b, orders, actions),
        }
        for name, job in jobs.items():
            cpu, verdict = timed(job)
            spent[name] += cpu
            fine[name] = fine.get(name, True) and verdict.proven
    return [(name, spent[name], 1e3 * CLEARANCE if fine[name] else 0.0) for name in spent]


def _crossing(locked: bool) -> tuple[RobotStation, dict[str, tuple[Action, ...]]]:
    """Two UR5e that turn over the line between them, and back."""
    members, actions = {}, {}
    for name, base in (
        ("a", Pose((0.0, 0.0, 0.0), (0.0, 0.0, 0.0, 1.0))),
        ("b", Pose((1.0, 0, 0))),
    ):
        robot = find_robot("ur/ur5e").with_base(base)
        side, other = (JointTarget(tuple(HOME + ACROSS * sign)) for sign in (1.0, -1.0))
        moves = tuple(MoveJ(there, Speed(joint=0.8)) for there in (other, side))
        program = Program(moves, start=side, name=name)
        controller = Controller(find_vendor("ur"), robot)
        run = controller.run(program, None, None)
        cell = bare_cell(robot, "ur", floor=False)
        members[name] = StationRobot(name, program, controller, cell, run)
        does = SetSignal("out", True) if name == "a" else WaitSignal(Level("in", True))
        when = run.duration if name == "a" else 0.0
        act = Action(does, when, 1 if name == "a" else -1, str(does), None)
        actions[name] = (act,) if locked else ()
    wires = (Wire("a.out", "b.in", 0.01, 0.04),) if locked else ()
    return RobotStation(members, wires, clearance=CLEARANCE), actions


def random_stations(count: int, first: int) -> Iterator[Figure]:
    """Stations of two robots at random, proofs beside dense samples of them as they may run.

    Where samples of runs in time keep more than twice the clearance it should be proven. At any
    time and under interlocks each conflict is a place that is too near; what is not is counted.
    """
    told: Counter[str] = Counter()
    cpu = 0.0
    for seed in range(first, first + count):
        with TemporaryDirectory() as folder:
            scene = random_station(Path(folder), seed)
            try:
                spent, made = timed(lambda s=scene: open_and_prove(s.file, jitter=JITTER))
            except FlybyError:
                told["refused"] += 1
                continue
            cpu += spent
            told.update(_judged(scene, made, np.random.default_rng(seed)))
    case, roomy = "random-pairs", max(told["roomy"], 1)
    wrong = told["wrong in time"] + told["wrong at any time"]
    yield Figure(case, "cases", count, "")
    yield Figure(case, "proven_but_nearer", wrong, "")
    yield Figure(case, "not_proven_of_twice_the_clearance", told["not proven, roomy"] / roomy, "")
    for name, number in sorted(told.items()):
        yield Figure(case, name, number, "")
    yield Figure(case, "cpu_s", cpu / count, "s")


def _judged(scene: RandomStation, made, rng: np.random.Generator) -> Iterator[str]:
    """What a station counts as."""
    (pair,) = made.clearances
    wanted, samples = made.station.clearance, Samples(scene, made)
    yield "crossing" if scene.hands is None else "handed over"
    if any(member.passing is not None for member in made.station.members.values()):
        yield "zones that may be passed"
    least = min(map(samples.least, trials_in_time(made, rng, JITTER, 2)))
    if pair.in_time.proven:
        yield "proven in time"
        if least < wanted - 2e-5:
            yield "wrong in time"
    if least > 2 * wanted:
        yield "roomy"
        if not pair.in_time.proven:
            yield "not proven, roomy"
    safe = pair.any_time if pair.any_time.proven else pair.interlocked
    if safe is None:
        return
    if not safe.proven:
        causes = {conflict.cause for conflict in safe.conflicts.values()}
        yield "open, too near" if ConflictCause.NEAR in causes else "open, otherwise"
        return
    yield "proven at any time" if pair.any_time.proven else "proven under interlocks"
    if min(map(samples.least, trials_at_any_time(made, rng, 3))) < wanted - 2e-5:
        yield "wrong at any time"


def _in_time(apart: float) -> Meetings:
    return Meetings((lambda own: own, lambda own: own), apart, every=False)


def _sampled(prover: PairProver) -> float:
    """m, the least distance at ten times the controller's rate."""
    runs = prover.one.run, prover.other.run
    period = 0.1 * float(np.diff(runs[0].trajectory.t[:2])[0])
    t = np.arange(0.0, max(run.duration for run in runs) + period, period)
    q = [
        np.stack([np.interp(t, run.trajectory.t, joint) for joint in run.trajectory.q.T], -1)
        for run in runs
    ]
    least = prover.nearest(q[0], q[1])[0]
    return least if math.isfinite(least) else math.inf


def measure(case: str, pairs: int, first: int) -> Iterator[Figure]:
    """The figures of a case."""
    jobs = {
        "crossing": crossing,
        "handshake": handshake,
        "studs": studs,
        "four-robots": four,
        "four-robots-meshes": four_with_meshes,
    }
    yield from random_stations(pairs, first) if case not in jobs else jobs[case]()


if __name__ == "__main__":
    main(__doc__ or "", measure, CASES, pairs=200, first=0)
