"""From a robot in its cell to an experiment: postures, runs, the choice among them, their texts."""

from __future__ import annotations

import tempfile
from collections.abc import Callable, Iterable, Iterator
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np

from ...core.cell.cell import Cell
from ...core.cell.floor import FLOOR, lifted
from ...core.collision.proof.certificate import certify, scenes_of
from ...core.collision.proof.verdict import Certificate
from ...core.collision.scene.scene import CollisionScene
from ...core.display import counted
from ...core.errors import FlybyError, InputError
from ...core.language import Sources
from ...core.motion.emulator.controller import Controller
from ...core.motion.emulator.run import Run
from ...core.program.move import Move, MoveC
from ...core.program.program import Program
from ...core.program.target import JointTarget, PoseTarget
from ...core.program.zone import FINE
from ...core.recording import RecordedRun, Recording
from ...core.source.patch.edits import difference
from ...core.vendor import Vendor
from .candidates import PostureFamily
from .checking import Refused, check
from .family import Made
from .information import Informer
from .plan import CandidateRun, Designed, Experiment, Plan, Skipped, usual_radii
from .postures import Clear, Site, find_sites, given_site, reach_of
from .purpose import purpose
from .selection import Option, RunChoice
from .topics import runs_about
from .words import Words

Say = Callable[[str], None]

ROUNDED = 2e-6
"""m, rad, and as a share: how near numbers must be read back (RAPID has single precision)."""
PROGRAM = "flyby_runs"
"""What the program of all runs is called."""
LOG_SUFFIX = ".csv"
SPARE = 0.01
"""m that postures keep beyond the clearance, for the motion round them."""


def design(
    vendor: Vendor, cell: Cell, plan: Plan, *, bare: bool, say: Say = lambda message: None
) -> Experiment:
    """Design an experiment.

    Args:
        vendor: whose controller drives the robot.
        cell: robot, tools, obstacles, clearance.
        plan: what was asked for.
        bare: whether nothing is known of what stands around the robot.
        say: called with what is being done.

    Raises:
        InputError: the vendor's language cannot say or log such motions, the robot has external
            axes, a posture is of no use, or no run is possible.
    """
    if cell.robot.external_axes:
        raise InputError(
            f"{cell.robot.name} has external axes ({', '.join(cell.robot.axis_names[6:])}): "
            "records of runs hold the arm alone; leave them out of the cell file"
        )
    return _Designer(vendor, cell, plan, bare, say).design()


@dataclass(frozen=True)
class _Clearance:
    """Proves clearances, if anything is known of the robot's shape."""

    cell: Cell
    controller: Controller

    def scene(self, plan: Plan) -> CollisionScene | None:
        return CollisionScene(self.cell, plan.tool) if self.cell.robot.shapes else None

    def proof(self, run: Run) -> Certificate | None:
        """None where no shape is known."""
        if not self.cell.robot.shapes:
            return None
        return certify(self.controller, run, scenes_of(self.cell), self.cell.clearance)


class _Designer:
    def __init__(self, vendor: Vendor, cell: Cell, plan: Plan, bare: bool, say: Say) -> None:
        self.words = Words(vendor, cell.robot)
        self.vendor, self.cell, self.plan, self.bare, self.say = vendor, cell, plan, bare, say
        self.controller = Controller(vendor, cell.robot)
        self.random = np.random.default_rng(plan.seed)
        self.reach = reach_of(cell.robot, plan.tool)
        self.clearance = _Clearance(cell, self.controller)
        self.skipped: list[Skipped] = []

    def design(self) -> Experiment:
        sites = self._sites()
        candidates = self._candidates(sites)
        period = self._period(candidates)
        informer = Informer.of(self.vendor, self.cell.robot, period, self.plan.about)
        choice = RunChoice(self._options(candidates, informer), self.plan)
        runs = self._chosen(choice, period)
        if not runs:
            reasons = "; ".join(f"{s.what}: {s.reason}" for s in self.skipped[:3])
            lift = f"; {lifted()}" if FLOOR in reasons else ""
            raise InputError(f"no run of this experiment is possible: {reasons}{lift}")
        runs = list(self._with_ways(runs))
        recording = Recording(PROGRAM, tuple(_recorded(runs)))
        recorder = self.vendor.recorder
        assert recorder is not None  # it has taken a period
        self.say("writing the program of all runs")
        return Experiment(
            self.cell.robot,
            self.plan,
            self.controller.model,
            period,
            tuple(sites),
            tuple(runs),
            tuple(self.skipped),
            tuple(choice.left_over()),
            informer.precision(choice.information),
            tuple(self._notes(choice, len(sites))),
            self.vendor.record_runs(recording, self.cell.robot, period),
            tuple(recorder.steps(recording, period)),
        )

    def _sites(self) -> list[Site]:
        robot, plan = self.cell.robot, self.plan
        self.say("looking for postures")
        if plan.postures is not None and not isinstance(plan.postures, int):
            for q in plan.postures:
                if np.shape(q) != (robot.size,):
                    raise InputError(f"a posture of {robot.name} has {robot.size} joint values")
            rows = [np.asarray(q, dtype=float) for q in plan.postures]
            return [given_site(robot, plan.tool, q, plan.margin, self.random) for q in rows]
        count = plan.posture_count
        return find_sites(robot, plan.tool, count, plan.margin, self._clear(), self.random)

    def _clear(self) -> Clear:
        scene = self.clearance.scene(self.plan)
        if scene is None:
            return lambda q: True
        wanted = self.cell.clearance + SPARE
        return lambda q: bool(scene.clearance(q, 2 * wanted).min() >= wanted)

    def _candidates(self, sites: Iterable[Site]) -> list[CandidateRun]:
        radii = tuple(sorted(self.plan.radii or usual_radii(self.reach)))
        found: list[CandidateRun] = []
        for number, site in enumerate(sites):
            self.say(f"designing runs at posture {number + 1}")
            family = PostureFamily(
                self.words,
                self.controller,
                self.plan,
                radii,
                number,
                site,
                self.reach,
                self.random,
            )
            for made in self._family_runs(family):
                if isinstance(made, Skipped):
                    self.skipped.append(made)
                elif made[1].duration > 1.5 * self.plan.longest:
                    reason = f"would last {made[1].duration:.0f} s"
                    self.skipped.append(Skipped(made[0].name, reason))
                else:
                    found.append(made[0])
        return found

    def _family_runs(self, family: PostureFamily) -> Iterator[Made]:
        if not self.plan.about:
            return family.candidates()
        topics = self.plan.topics_at(family.number)
        return (made for topic in topics for made in runs_about(topic, family))

    def _period(self, candidates: list[CandidateRun]) -> float:
        """The plan's, or what the recorder usually takes."""
        program = candidates[0].program if candidates else Program(())
        recorder, period = self.vendor.recorder, self.plan.period
        if period is None and recorder is not None:
            period = recorder.usual_period(self.cell.robot)
        self.vendor.record(program, self.cell.robot, period or 0.0)
        assert period is not None  # a vendor without recorder is refused
        return period

    def _options(self, candidates: list[CandidateRun], informer: Informer) -> list[Option]:
        options = []
        for k, candidate in enumerate(candidates):
            self.say(f"what would run {k + 1} of {len(candidates)} tell?")
            try:
                information = informer.information(candidate)
            except FlybyError as error:
                self.skipped.append(Skipped(candidate.name, str(error)))
                continue
            duration = self.controller.run(candidate.program).duration
            options.append(Option(candidate, information, duration))
        return options

    # The choice

    def _chosen(self, choice: RunChoice, period: float) -> list[Designed]:
        runs: list[Designed] = []
        while (option := choice.best()) is not None:
            self.say(f"proving {option.candidate.name}")
            try:
                made = self._made(option.candidate, period)
            except FlybyError as error:
                self.skipped.append(Skipped(option.candidate.name, str(error)))
                choice.refuse(option)
                continue
            runs.append(replace(made, gain=choice.take(option)))
        return runs

    def _made(self, candidate: CandidateRun, period: float) -> Designed:
        """The run as text, read back, looked at and proven.

        Raises:
            FlybyError: it cannot be said, is not read back, or does not keep clear.
        """
        robot = self.cell.robot
        sources = self.vendor.record(candidate.program, robot, period)
        program = self._read_back(sources)
        found = difference(_unlabelled(candidate.program), _unlabelled(program), ROUNDED)
        if found is not None:
            raise Refused(f"its text is read back with another {found[1]}")
        first = program.moves[0].target
        assert isinstance(first, JointTarget)
        # Not every language keeps the names of tools, by which the cell knows their shapes.
        moves = tuple(replace(move, tool=self.plan.tool) for move in program.moves)
        program = replace(program.with_moves(moves), name=candidate.name, start=first)
        candidate = replace(candidate, start=np.array(first.joints))
        run = check(self.controller, candidate, self.plan.margin, program)
        certificate = self.clearance.proof(run)
        if certificate is not None and not certificate.proven:
            raise Refused(str(certificate))
        told = purpose(self.controller, candidate, run)
        return Designed(candidate, program, sources, run, certificate, 0.0, purpose=told)

    def _read_back(self, sources: Sources) -> Program:
        with tempfile.TemporaryDirectory() as name:
            folder = Path(name)
            for file, text in sources.items():
                (folder / file).write_bytes(text.encode())
            return self.vendor.read_file(
                folder / main_file(sources, self.vendor), robot=self.cell.robot
            )

    def _with_ways(self, runs: list[Designed]) -> Iterable[Designed]:
        """The runs, each with whether the way to it from the one before keeps clear."""
        before: Designed | None = None
        for made in runs:
            yield made if before is None else replace(made, way_proven=self._way(before, made))
            before = made

    def _way(self, before: Designed, then: Designed) -> bool | None:
        """Whether the joint line from the end of a run to the start of another keeps clear."""
        if not self.cell.robot.shapes:
            return None
        stand = JointTarget(tuple(map(float, before.run.trajectory.q[-1])))
        first = replace(then.program.moves[0], zone=FINE)
        try:
            run = self.controller.run(Program((first,)), stand)
        except FlybyError:
            return False
        proof = self.clearance.proof(run)
        return proof is not None and proof.proven

    def _notes(self, choice: RunChoice, sites: int) -> Iterable[str]:
        if sites < self.plan.posture_count:
            yield f"only {sites} of {self.plan.posture_count} postures were found"
        if not self.cell.robot.shapes:
            yield "nothing is known of the robot's shape: no collision is excluded"
        elif self.bare:
            floor = [o.name for o in self.cell.obstacles if o.name == FLOOR]
            proven = f"neither itself nor {FLOOR}" if floor else "not itself"
            yield (
                f"no cell was given: it is proven that the arm touches {proven}, and nothing of "
                "tools and surroundings"
            )
        missing = choice.missing()
        for topic in self.plan.about:
            count = sum(level.startswith(f"{topic}: ") for level in missing)
            if count:
                pairs = counted(count, "pair of conditions", "pairs of conditions")
                yield f"{topic}: {pairs} have no place in the time there is"
        if not self.plan.about:
            yield from (f"{level} has no place in the time there is" for level in missing)


def _recorded(runs: Iterable[Designed]) -> Iterator[RecordedRun]:
    for number, run in enumerate(runs, 1):
        log = run.stem(number) + LOG_SUFFIX
        yield RecordedRun(run.program, log, by_hand=not run.way_proven)


def main_file(sources: Sources, vendor: Vendor) -> str:
    """The file with the program, among those of a recording."""
    return next(file for file in sources if Path(file).suffix.lower() in vendor.suffixes)


def _unlabelled(program: Program) -> Program:
    """The moves, without the labels of configurations on the way of lines and arcs: they are those
    that the arm arrives with, and not every language keeps them."""

    return Program(tuple(_bare(move) for move in program.moves))


def _bare(move: Move) -> Move:
    if isinstance(move.target, PoseTarget):
        move = replace(move, target=replace(move.target, configuration=None))
    if isinstance(move, MoveC):
        move = replace(move, via=replace(move.via, configuration=None))
    return move
