"""The run of a program, as far as instructions and the rules for branches and loops need it."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Sequence
from contextlib import suppress
from typing import NoReturn
from weakref import proxy

from ....core.errors import Note, SourceError, Span
from ....core.program.move import Move
from ....core.source.execution.control_flow.steps import NOTHING, PLACE
from ....core.source.execution.course import Course
from ....core.source.execution.limits import Meter
from ....core.source.execution.outputs import Outputs
from ....core.source.execution.streams import Streaming
from ....core.source.execution.transcript import MoveParts, Transcript
from ....core.source.reading import ReadOptions
from ..motion.kinematics import RobotFunctions
from ..motion.position import Position
from ..motion.settings import SettingsInForce
from ..motion.targets import Converter
from ..syntax import tree
from ..values.data import Globals
from ..values.errors import BOOKED
from ..values.evaluator import Evaluator
from ..values.scope import NOWHERE, Home, Scope, Snapshot
from ..values.types import Value
from .recovery import Frame


class Finished(Exception):
    """The program has ended."""


class RapidHost(ABC):
    """Values, position and transcript of a run; see `core.source.execution.host.Host`.

    Args:
        data: modules, routines and data of the program.
        texts: source texts by file, from which kept statements are cut.
        options: answers, limits and the robot.
        external_axes: see `Converter`.

    Attributes:
        left_out: the first move of which nobody knows the target, and why.
    """

    def __init__(
        self,
        data: Globals,
        texts: dict[str, str],
        options: ReadOptions,
        external_axes: Sequence[str] | None,
    ) -> None:
        self.data = data
        self.settings = SettingsInForce()
        self.course = Course(options.answers)
        self.out = Transcript(lambda span: texts[span.file][span.start : span.end], self.course)
        self.meter = Meter(options.limits, options.executed)
        self.convert = Converter(self.settings, self.out.notes, external_axes, options.robot)
        self.position = Position(options.robot, external_axes, options.start)
        self.functions = RobotFunctions(self.position, self.convert, self.settings)
        # Expressions call routines, which evaluate expressions: no reference holds the two
        # together, so that a run is gone, with the syntax tree, as soon as it is over.
        host = proxy(self)
        self.evaluator = Evaluator(
            data, self.course, self.out.text_of, host, self.functions.table(), options.signals
        )
        self.out.streaming = Streaming(
            options.robot,
            lambda move, span: host.streamed(move, span),
            lambda span: host.lost(span),
        )
        self.place: object = None
        self._frames: list[Frame] = []
        self._booked = 0
        self.left_out: Note | None = None

    @abstractmethod
    def call_function(self, routine: tree.Routine, call: tree.Call, scope: Scope) -> Value:
        """See `values.names.Host`."""

    @property
    def home(self) -> Home:
        """The module of the routine that is being run."""
        return self._frames[-1].scope.home if self._frames else NOWHERE

    @property
    def outputs(self) -> Outputs:
        """What the program has set its outputs to."""
        return self.evaluator.outputs

    @property
    def position_asked(self) -> int:
        """How often the program has asked where the robot stands."""
        return self.position.asked

    def snapshot(self, names: frozenset[str] | None, written: frozenset[str]) -> Snapshot:
        """See `core.source.execution.host.Host.snapshot`."""
        scopes = [*self._frames[-1].scope.outwards()]
        if names is None:
            scopes += self.data.scopes()
        found = [s.cells[n] for s in scopes for n in names or written if n in s.cells]
        for cell in found:
            # What has not been read yet is evaluated: else its first write would be no change.
            if cell.pending is not None:
                with suppress(SourceError):
                    self.evaluator.settle(cell)
        if names is None:
            found = [cell for s in scopes for cell in s.cells.values() if not cell.constant]
        return Snapshot(found)

    def leave_to_others(self, names: frozenset[str], span: Span) -> list[str]:
        """See `core.source.execution.host.Host`: data of modules, not those of routines."""
        shared = [cell for scope in self.data.scopes() for cell in scope.cells.values()]
        modules = {id(cell) for cell in shared}
        found = [(name, self._frames[-1].scope.find(name)) for name in sorted(names)]
        cells = [c for _, c in found if c is not None and id(c) in modules and not c.constant]
        return [
            *(name for cell in cells for name in self.evaluator.leave_to_others(cell, span)),
            *(n for n, c in found if c is None and self.evaluator.forget_elsewhere(n)),
        ]

    def leave_supposed(
        self,
        names: frozenset[str],
        settings: frozenset[str],
        reason: str,
        called: frozenset[str] = NOTHING,
    ) -> None:
        """See `core.source.execution.host.Host`."""
        if PLACE in names:
            self.position.suppose(reason)
        cells = [*filter(None, map(self._frames[-1].scope.find, sorted(names)))]
        cells += [s.cells[n] for s in self.data.scopes() for n in sorted(called) if n in s.cells]
        for cell in cells:
            if not cell.constant:
                cell.supposed = cell.supposed or reason
        self.settings.supposed |= dict.fromkeys(settings - self.settings.supposed.keys(), reason)

    def pause(self, text: str, span: Span) -> None:
        """The robot stands at a loop that waits."""
        self.out.pause(text, span)

    def note_once(self, kind: str, message: str, span: Span) -> None:
        """A note, unless one of its kind was taken before."""
        self.out.notes.once(kind, message, span)

    def text_of(self, expression: tree.Expression) -> str:
        """An expression as it stands, on one line."""
        return " ".join(self.out.text_of(expression.span).split())

    def emit_move(self, move: Move, parts: MoveParts) -> None:
        """Put a move at the end of the program.

        Raises:
            SourceError: there are too many.
        """
        self.meter.move(parts.statement)
        self.out.emit_move(move, parts)
        if move.target != self.place:
            self.place = move.target

    def streamed(self, move: Move, span: Span) -> None:
        """The robot has driven what a computer has sent."""
        self.position.moved(move, span)
        self.place = move.target

    def lost(self, span: Span) -> None:
        """Nobody knows where the robot is, behind a move that cannot be read."""
        self.meter.move(span)
        self.position.lose()
        self.place = object()

    def leave_out(self, invoke: tree.Invoke, why: str) -> None:
        """Step over a move that cannot be driven."""
        if self.open_move(SourceError(why, invoke.span), invoke.span):
            return
        self.out.keep(invoke.span, invoke.text, "", stops=True)
        self.course.decided(invoke.span, f"{why}: the move is left out")
        self.left_out = self.left_out or Note(why, span=invoke.span)

    def finish(self, message: str, span: Span) -> NoReturn:
        """End the program here, with a note."""
        self.out.notes.once("end", message, span)
        raise Finished

    def open_move(self, error: SourceError, span: Span) -> bool:
        """Whether the program goes on behind a move that cannot be read, which stays open."""
        if not self.out.leaves_open(error, span):
            return False
        self.lost(span)
        return True

    def note_undeclared(self, name: tree.Name) -> None:
        message = f"'{name.text}' is written and not declared in what is at hand: it is taken to "
        self.out.notes.count(message + "be declared in a module that is not", name.span)

    def book_error(self) -> float:
        """A number for an error of the program's own."""
        self._booked = min(self._booked + 1, BOOKED)
        return float(self._booked)

    def set_error(self, number: float) -> None:
        """What ``ERRNO`` holds."""
        self.data.errno.value = number
