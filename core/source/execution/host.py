"""What the rules for branches and loops need of the run of a program."""

from __future__ import annotations

from dataclasses import dataclass
from typing import NoReturn, Protocol

from ...errors import SourceError, Span
from .control_flow.steps import NOTHING
from .course import Course
from .limits import Meter
from .outputs import Outputs


@dataclass(frozen=True, slots=True)
class Undecided:
    """What a condition is that only the running controller knows.

    Args:
        reason: what it depends on.
    """

    reason: str


class Snapshot(Protocol):
    """Data as they were."""

    def changed(self) -> bool:
        """Whether some datum has another value now."""
        ...


class Host(Protocol):
    """The run of a program, as far as branches and loops need it."""

    @property
    def course(self) -> Course:
        """Decides, and remembers what was decided."""
        ...

    @property
    def meter(self) -> Meter:
        """Counts what is executed."""
        ...

    @property
    def outputs(self) -> Outputs:
        """What the program has set its outputs to."""
        ...

    @property
    def position_asked(self) -> int:
        """How often the program has asked where the robot stands."""
        ...

    @property
    def place(self) -> object:
        """Where the robot stands: another object after every move to another place."""
        ...

    def snapshot(self, names: frozenset[str] | None, written: frozenset[str]) -> Snapshot:
        """Data as they are now.

        Args:
            names: of the data, found from where the program stands; None for all data.
            written: names of the data that may be written meanwhile, by routines too.
        """
        ...

    def leave_to_others(self, names: frozenset[str], span: Span) -> list[str]:
        """Make data unknown that something beside the program's course may write: another task, a
        computer, an operator.

        Args:
            names: of data, found from where the program stands.
            span: of the loop that reads them.

        Returns:
            Names of those that are unknown now and were not before, as declared.
        """
        ...

    def leave_supposed(
        self,
        names: frozenset[str],
        settings: frozenset[str],
        reason: str,
        called: frozenset[str] = NOTHING,
    ) -> None:
        """Data and settings have values of a way that was chosen by rule: nothing is proven of
        what reads them, until they are set anew.

        Args:
            names: of data, found from where the program stands; `steps.PLACE` for where the robot
                stands.
            settings: by the names of `Step.sets`.
            reason: what they depend on.
            called: names of data that routines write which were called: of the whole program's.
        """
        ...

    def open_move(self, error: SourceError, span: Span) -> bool:
        """Whether the program goes on behind what cannot be carried out, which stays in it as a
        move that is open: from there on nobody knows where the robot stands."""
        ...

    def pause(self, text: str, span: Span) -> None:
        """The robot stands for as long as the user says that a loop that waits takes.

        Args:
            text: of the loop.
            span: of it.
        """
        ...

    def note_once(self, kind: str, message: str, span: Span) -> None:
        """A note, unless one of its kind was taken before."""
        ...

    def finish(self, message: str, span: Span) -> NoReturn:
        """End the program here, with a note."""
        ...
