"""The run of a program, as far as the rules for branches and loops need it."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from contextlib import suppress
from typing import NoReturn

from ....core.errors import SourceError, Span
from ....core.source.execution.control_flow.steps import NOTHING, PLACE
from ....core.source.execution.course import Course
from ....core.source.execution.limits import Meter
from ....core.source.execution.outputs import Outputs
from ....core.source.execution.transcript import Transcript
from ..motion.own_position import OwnPosition
from ..motion.position import Position
from ..values.changes import Snapshot
from ..values.data import Data
from ..values.elements import Names
from ..values.predefined import MOTION, NEVER_KNOWN
from ..values.scope import Scope
from ..values.values import Choice, Struct, Unknown, Value
from .exits import Finished


class KrlHost:
    """See `core.source.execution.host.Host`.

    Args:
        course: decides, and remembers what was decided.
        meter: counts what is executed.
        data: of the program.
        names: evaluates initial values.
        scopes: of the routines under way, the innermost last.
        position: follows the robot.
        own_position: is asked by the program.
        transcript: takes notes and pauses.
    """

    def __init__(
        self,
        course: Course,
        meter: Meter,
        data: Data,
        names: Names,
        scopes: Sequence[Scope],
        position: Position,
        own_position: OwnPosition,
        transcript: Transcript,
        system_changed: Callable[[], None],
    ) -> None:
        self.course = course
        self.meter = meter
        self._data = data
        self._names = names
        self._scopes = scopes
        self._position = position
        self._own_position = own_position
        self._transcript = transcript
        self._system_changed = system_changed

    @property
    def outputs(self) -> Outputs:
        """What the program has set its outputs to."""
        return self._data.outputs

    @property
    def position_asked(self) -> int:
        """How often the program has asked where the robot stands."""
        return self._own_position.asked

    @property
    def place(self) -> object:
        """Where the robot stands: another object after every move to another place."""
        return self._position.place

    def snapshot(self, names: frozenset[str] | None, written: frozenset[str]) -> Snapshot:
        """See `core.source.execution.host.Host.snapshot`."""
        scope = self._scopes[-1]
        looked = {
            name: self._data.find(name, scope)
            for name in sorted(written if names is None else names)
        }
        absent = [name for name, cell in looked.items() if cell is None]
        if names is None:
            cells = self._data.named(written, self._scopes)
        else:
            cells = [cell for cell in looked.values() if cell is not None]
        for cell in cells:
            # What has not been read yet is evaluated: else its first read would be a change.
            with suppress(SourceError):
                self._names.settled(cell)
        return Snapshot(cells, absent, lambda name: self._data.find(name, scope))

    def leave_to_others(self, names: frozenset[str], span: Span) -> list[str]:
        """See `core.source.execution.host.Host`: all but a routine's own data."""
        own = self._scopes[-1].cells
        left: list[str] = []
        for name in sorted(names - own.keys() - MOTION - NEVER_KNOWN):
            cell = self._data.find(name, self._scopes[-1])
            if cell is None or cell.constant or cell.signal is not None or cell.shipped:
                continue
            with suppress(SourceError):
                value = self._names.settled(cell)
                cell.value, parts = _written(value, cell.name, span)
                left += parts
        return left

    def leave_supposed(
        self,
        names: frozenset[str],
        settings: frozenset[str],
        reason: str,
        called: frozenset[str] = NOTHING,
    ) -> None:
        """See `core.source.execution.host.Host`."""
        if PLACE in names:
            self._position.suppose(reason)
        scope = self._scopes[-1]
        own = (self._data.find(name, scope) for name in sorted(names))
        for cell in (*filter(None, own), *self._data.named(called | settings, ())):
            if not cell.constant:
                cell.supposed = cell.supposed or reason
        self._system_changed()

    def note_once(self, kind: str, message: str, span: Span) -> None:
        """A note, unless one of its kind was taken before."""
        self._transcript.notes.once(kind, message, span)

    def open_move(self, error: SourceError, span: Span) -> bool:
        """Whether the program goes on behind what cannot be carried out, as an open move."""
        if not self._transcript.leaves_open(error, span):
            return False
        self.meter.move(span)
        self._position.left_out(span)
        return True

    def pause(self, text: str, span: Span) -> None:
        """The robot stands at a loop that waits."""
        self._transcript.pause(text, span)

    def finish(self, message: str, span: Span) -> NoReturn:
        """End the program here, with a note."""
        self._transcript.notes.once("end", message, span)
        raise Finished


def _written(value: Value | None, name: str, span: Span) -> tuple[Value | None, list[str]]:
    """A datum as others may have written it, and the names of its parts of which that holds."""
    if isinstance(value, bool | int | float | str | Choice):
        reason = f"the value of {name}, which others write"
        return Unknown(reason, span, held=value, key=name, others=True), [name]
    if not isinstance(value, Struct):
        return value, []
    fields: dict[str, Value] = {}
    left: list[str] = []
    for field, part in value.fields.items():
        made, parts = _written(part, f"{name}.{field.upper()}", span)
        fields[field] = part if made is None else made
        left += parts
    return Struct(value.type, fields, value.label, value.shipped), left
