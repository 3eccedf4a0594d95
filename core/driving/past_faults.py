"""Drives a program past the moves that cannot be driven."""

from __future__ import annotations

from ..door import spelt
from ..errors import FaultCause, FlybyError, MotionError
from ..motion.emulator.controller import Controller
from ..motion.emulator.run import Run
from ..program.assumed_places import assumed_places
from ..program.program import Program
from ..program.question import QuestionKind
from ..program.target import JointTarget
from ..robot.singularities import is_singular
from .driven_program import DrivenPart, DrivenProgram, Fault, refusal

_OF_PLACES = (
    FaultCause.REACH,
    FaultCause.LIMIT,
    FaultCause.SINGULARITY,
    FaultCause.CONFIGURATION,
)
"""Faults of where the flange is sent, which the tool and the work object decide."""
ENOUGH = 5
"""Faults after which no more are counted to tell what drives a program better."""
_AHEAD = 4
"""Moves looked at behind a fault at first, or as many as came before it: twice as many each time
that none is found, so that looking takes little more than driving does, however many faults there
are."""


def drive(
    controller: Controller,
    program: Program,
    start: JointTarget | None = None,
    period: float | None = None,
) -> DrivenProgram:
    """As much of a program as can be driven, and what is wrong with the rest.

    Args:
        controller: of the robot.
        program: what to drive.
        start: where the robot stands; None for the program's own start, else its first target.
        period: s between samples; None for the controller's own.

    Returns:
        What was driven; no part of it of a text that was read and moves nothing by itself.

    Raises:
        MotionError: no move of the program is reached, or it goes nowhere at all.
    """
    if moves_nothing(program):
        return DrivenProgram(program, (), ())
    return _Drive(controller, program, period).whole(start)


def count_faults(
    controller: Controller, program: Program, start: JointTarget | None, most: int
) -> int:
    """How many moves of a program cannot be driven; ``most`` of as many or more."""
    drives = _Drive(controller, program, None, most)
    try:
        return min(most, len(drives.whole(start).faults))
    except FlybyError:
        return most


def refuse_faults(
    controller: Controller, program: Program, start: JointTarget | None = None
) -> None:
    """Refuse a program that can only be used as a whole, if a move of it cannot be driven.

    Raises:
        MotionError: it names all moves that cannot be driven.
    """
    try:
        controller.plan(program, start)
    except MotionError as error:
        if error.move is None or error.cause is FaultCause.NOWHERE:
            raise
        faults = drive(controller, program, start).faults
        raise (refusal(faults) if faults else error) from error


def moves_nothing(program: Program) -> bool:
    """Whether a text holds no motion at all, and calls nothing that is not at hand: signals are
    set, data computed, messages sent."""
    if program.moves or program.reading is None or any(entry.moves for entry in program.entries):
        return False
    return not any(q.kind is QuestionKind.ROUTINE and not q.answered for q in program.questions)


class _Drive:
    """One program on its way."""

    def __init__(
        self,
        controller: Controller,
        program: Program,
        period: float | None,
        most: int | None = None,
    ) -> None:
        self._most = most
        self._controller = controller
        self._program = program
        self._period = period
        self._parts: list[DrivenPart] = []
        self._faults: list[Fault] = []
        self._assumed = assumed_places(program)

    def whole(self, start: JointTarget | None) -> DrivenProgram:
        """All parts from a start."""
        count = len(self._program.moves)
        try:
            return DrivenProgram.faultless(self._controller.run(self._program, start, self._period))
        except MotionError as error:
            if not count or error.cause is FaultCause.NOWHERE:
                raise
            nowhere = error
            begun = start or self._controller.furthest_start(self._program)
            first, at = self._part(0, begun, count, error)
        while first < count and len(self._faults) != self._most:
            if at is None:
                first, at = self._next_place(first)
            else:
                first, at = self._part(first, at, *self._furthest(first, at))
        if not self._parts:
            raise refusal(self._faults) if self._faults else nowhere
        return DrivenProgram(self._program, tuple(self._parts), tuple(self._faults))

    def _part(
        self, first: int, at: JointTarget | None, stop: int, error: MotionError | None
    ) -> tuple[int, JointTarget | None]:
        """Drive moves from ``first`` on, up to the first fault.

        Args:
            first: index of a move.
            at: where the robot stands; None for nobody knows.
            stop: index of the move that is known to be at fault; behind the last if none is.
            error: why.

        Returns:
            The move behind the fault, and where the robot stands before it; None for nowhere.
        """
        if error is not None:
            stop = first + (error.move or 0)
        run: Run | None = None
        while run is None and stop > first:
            # As its last move is a stop, a part may meet what the whole has not met.
            try:
                run = self._controller.run(self._between(first, stop), at, self._period)
            except MotionError as failed:
                if failed.cause is FaultCause.NOWHERE:
                    break
                stop, error = first + (failed.move or 0), failed
        if run is not None:
            self._parts.append(DrivenPart(first, run))
        if error is None:
            return stop, None
        self._fault(stop, error)
        return stop + 1, self._standing(stop)

    def _furthest(self, first: int, at: JointTarget) -> tuple[int, MotionError | None]:
        """Up to which move the robot comes from ``first`` on, and why no further."""
        last = [-1, *(fault.move for fault in self._faults[-2:])]
        ahead, count = max(_AHEAD, last[-1] - last[-2]), len(self._program.moves)
        while True:
            stop = min(first + ahead, count)
            try:
                self._controller.plan(self._between(first, stop), at)
            except MotionError as error:
                if error.cause is not FaultCause.NOWHERE:
                    return stop, error
            if stop == count:
                return count, None
            ahead *= 2

    def _next_place(self, move: int) -> tuple[int, JointTarget | None]:
        """Go on at the target of a move that nobody knows where it comes from."""
        try:
            at = self._controller.standing_at(self._program.moves[move], self._near())
        except MotionError as error:
            self._fault(move, error)
            at = None
        return move + 1, at

    def _standing(self, move: int) -> JointTarget | None:
        """The robot at the target of a move at fault; None where it cannot stand there."""
        try:
            return self._controller.standing_at(self._program.moves[move], self._near())
        except MotionError:
            return None

    def _near(self) -> JointTarget | None:
        """Where the robot was last."""
        return self._parts[-1].run.end if self._parts else None

    def _between(self, first: int, stop: int) -> Program:
        return self._program.between(first, stop)

    def _fault(self, move: int, error: MotionError) -> None:
        span = error.span or self._program.moves[move].statement
        message = error.message + self._of_what_is_assumed(move, error.cause)
        self._faults.append(Fault(move, error.cause, message, span))

    def _of_what_is_assumed(self, move: int, cause: FaultCause) -> str:
        """That a move's tool or work object are not known, which may be why it cannot be driven."""
        if cause not in _OF_PLACES:
            return ""
        if cause is FaultCause.SINGULARITY and self._begins_singular(move):
            before = self._program.moves[move - 1].statement
            return f"; it stands so where the move before ends ({before}), whatever the tool is"
        asked = self._assumed.get(move)
        frame = self._program.moves[move].work_object
        if not asked and frame.not_followed is not None:
            return (
                f"; {frame.name} is taken to stand where it is declared, though "
                f"{frame.not_followed} moves it, which may well be why"
            )
        if not asked:
            return ""
        be = "is" if len(asked) == 1 else "are"
        return (
            f"; {' and '.join(asked)} {be} not known, and may well be why: say what "
            f"{'it is' if be == 'is' else 'they are'} in a file ({spelt('answers')}; `flyby ask` "
            "writes one, and looks for what would do)"
        )

    def _begins_singular(self, move: int) -> bool:
        """Whether the joints that the move before ends at are a singularity themselves."""
        before = self._program.moves[move - 1].target if move else None
        return isinstance(before, JointTarget) and is_singular(
            self._controller.robot, before.joints
        )
