"""Statements that are kept as they stand, and stops of the advance run."""

from __future__ import annotations

from ....core.errors import Span
from ....core.program.move import Opaque, Wait
from ....core.source.execution.transcript import Transcript
from ..values.advance_run import AdvanceRun


class Keeping:
    """Puts them into the program.

    Args:
        transcript: takes them.
        advance: whether ``CONTINUE`` lets the robot pass.
    """

    def __init__(self, transcript: Transcript, advance: AdvanceRun) -> None:
        self._transcript = transcript
        self._advance = advance

    def keep(
        self, span: Span, name: str, why: str, stops: bool = False, device: bool = False
    ) -> None:
        """Keep a statement as it stands, see `Transcript.keep`.

        So is the ``CONTINUE`` that lets the robot pass it.
        """
        if stops and self._advance.passed:
            self._transcript.emit(Opaque("CONTINUE", span=span))
        self._transcript.keep(span, name, why, stops and not self._advance.passed, device)

    def stop(self, span: Span) -> None:
        """Something stops the advance run, and so the robot, unless ``CONTINUE`` lets it pass."""
        if not self._transcript.stopped and not self._advance.passed:
            self._transcript.emit(Wait(0.0, span))
