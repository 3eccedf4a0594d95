"""What the emulator predicts of a logged run, beside the log."""

from __future__ import annotations

from dataclasses import dataclass, replace

from ..core.errors import FlybyError, InputError
from ..core.motion.command.servo import time_to_rest
from ..core.motion.emulator.controller import Controller
from ..core.motion.emulator.run import Run
from ..core.motion.model.rules import ArcTurn
from ..core.program.move import MoveC
from ..core.program.program import Program
from ..core.program.target import JointTarget
from ..core.program.tool import Tool
from ..core.robot.model import Robot
from .alignment import Alignment, align
from .compatibility import check_limits
from .logs.cleaning import CleanLog
from .logs.run import LoggedRun
from .residuals import Figures, Residuals, figures, residuals
from .torn_samples import find_torn, mended
from .unplanned_stops import unplanned_stops, with_stops

PERIOD = 5e-4
"""s between samples of the emulation. At 1 m/s round a radius of 10 mm, chords are 3 µm off."""
STOPPED = 0.5
"""Share of its distance in time, clock aside, that a log may keep that is emulated with a stop."""
_MOST_STOPS = 5
TOLD_APART = 0.75
"""Share of one's distance from the joints' path that another way to turn the tool may leave at most
for a log to tell the two apart. It leaves a tenth and less of logs that the model explains else; of
two at the greatest speed, which it does not, 0.61 and 0.67."""


@dataclass(frozen=True, eq=False)
class Prediction:
    """A log beside its emulation.

    Args:
        name: of the run.
        robot: that moved.
        driven: the emulation.
        log: what was logged, samples that mix two cycles put together.
        alignment: of both.
        residuals: log less emulation.
        figures: the same in numbers.
        read: the numbers of the samples as they were read, if some were put together; None if all
            are as they were read.
        turn: how the log shows that the tool turns along arcs; None if it does not.
        stops: indices of the moves at whose end the log stops although they have a zone: they are
            emulated with a stop.
    """

    name: str
    robot: Robot
    driven: Run
    log: CleanLog
    alignment: Alignment
    residuals: Residuals
    figures: Figures
    read: Figures | None = None
    turn: ArcTurn | None = None
    stops: tuple[int, ...] = ()


def predict(
    controller: Controller,
    name: str,
    program: Program,
    log: CleanLog,
    period: float = PERIOD,
    override: float = 1.0,
) -> Prediction:
    """Emulate a run's program and lay the log on it.

    Along arcs the tool turns as the log shows, whatever the motion model says: by some degrees a
    log is off otherwise, and would be taken for one of another program. Where the log stops at a
    point that the program passes, so does the emulation.

    Args:
        controller: emulates.
        name: of the run.
        program: what was driven; without a start of its own it begins where the log does.
        log: what came of it.
        period: s between samples of the emulation.
        override: share of all speeds that it was driven at.

    Raises:
        InputError: the log does not belong to the program; it says why, and names the run.
        MotionError: the program cannot be driven.
    """
    found = _turned(controller, name, program, log, period, override)
    stops: tuple[int, ...] = ()
    for _ in range(_MOST_STOPS):
        more = unplanned_stops(found.robot, found.driven, found.alignment, found.residuals)
        if not more:
            break
        stops = tuple(sorted({*stops, *more}))
        try:
            stopped = _turned(controller, name, with_stops(program, stops), log, period, override)
        except FlybyError:
            break
        if stopped.figures.joint_clock_rms > STOPPED * found.figures.joint_clock_rms:
            break
        said = (
            f"stops at the end of {_moves(stops)}, which the program passes in a zone; so emulated "
            "(a controller that has not planned the next move in time does so)"
        )
        noted = replace(stopped.log, notes=(*log.notes, *stopped.log.notes[len(log.notes) :], said))
        found = replace(stopped, stops=stops, log=noted)
    return found


def _moves(indices: tuple[int, ...]) -> str:
    numbers = [str(index + 1) for index in indices]
    return f"move{'s' if len(numbers) > 1 else ''} {', '.join(numbers)}"


def _turned(
    controller: Controller,
    name: str,
    program: Program,
    log: CleanLog,
    period: float,
    override: float,
) -> Prediction:
    """See `predict`; the tool turns along arcs as the log shows."""
    own = controller.model.arc_turn
    turns = _turns(own, program)
    found: dict[ArcTurn, Prediction] = {}
    problems: list[FlybyError] = []
    for turn in turns:
        model = replace(controller.model, arc_turn=turn)
        driven_so = controller if turn is own else controller.with_model(model)
        try:
            found[turn] = _predict(driven_so, name, program, log, period, override)
        except FlybyError as error:
            problems.append(error)
    if not found:
        raise problems[0]
    off = {turn: one.figures.joint_path_rms for turn, one in found.items()}
    best = min(off, key=off.__getitem__)
    if len(turns) > 1 and all(off[best] < TOLD_APART * off[k] for k in off if k is not best):
        return replace(found[best], turn=best)
    return next(iter(found.values()))


def _turns(own: ArcTurn, program: Program) -> list[ArcTurn]:
    """The ways to turn the tool along a program's arcs that differ, that of the model first."""
    programmed = [move.orientation for move in program.moves if isinstance(move, MoveC)]
    found: dict[tuple[bool, ...], ArcTurn] = {}
    for turn in (own, *ArcTurn):
        found.setdefault(tuple(map(turn.follows, programmed)), turn)
    return list(found.values())


def _predict(
    controller: Controller,
    name: str,
    program: Program,
    log: CleanLog,
    period: float,
    override: float,
) -> Prediction:
    """See `predict`; the tool turns as the motion model says."""
    robot = controller.robot
    try:
        check_limits(robot, log.q)
        rest = time_to_rest(controller.model.servo)
        driven = controller.run(program, start_of(program, log, robot), period, override, rest)
        aligned = align(robot, driven.trajectory, log)
        torn = find_torn(driven.trajectory, aligned)
        if torn is None:
            return _prediction(name, robot, driven, log, aligned)
        read = _prediction(name, robot, driven, log, aligned).figures
        log = mended(log, driven.trajectory, aligned, torn)
        aligned = align(robot, driven.trajectory, log)
    except InputError as error:
        raise InputError(f"{name}: {error}") from error
    return replace(_prediction(name, robot, driven, log, aligned), read=read)


def _prediction(
    name: str, robot: Robot, driven: Run, log: CleanLog, aligned: Alignment
) -> Prediction:
    """With what is left of the log."""
    found = residuals(robot, _tool(driven.program), driven.trajectory, log, aligned)
    return Prediction(name, robot, driven, log, aligned, found, figures(robot, found, aligned))


def start_of(program: Program, log: CleanLog | LoggedRun, robot: Robot) -> JointTarget | None:
    """Where the log begins, if the program does not say where the robot stands."""
    if program.start is not None:
        return None
    values = tuple(map(float, log.q[0]))
    return JointTarget(values[: robot.arm_size], values[robot.arm_size :])


def _tool(program: Program) -> Tool:
    return program.moves[0].tool
