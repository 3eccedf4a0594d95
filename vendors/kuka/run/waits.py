"""HALT and WAIT, and statements that are kept as they stand."""

from __future__ import annotations

from ....core.errors import SourceError
from ....core.source.execution.transcript import Transcript
from ..syntax.tree import Halt, Keyword, WaitFor, WaitSec
from ..values.evaluator import Evaluator
from ..values.scope import Scope
from ..values.values import Unknown, shown
from .instructions import KEYWORDS, kept
from .keeping import Keeping
from .output_writes import OutputWrites
from .waiting import Waited


class Waits:
    """Carries these statements out.

    Args:
        evaluator: for times.
        waited: what was waited for.
        writes: outputs at uncertain moments.
        transcript: takes waits.
        keeping: takes what is kept.
    """

    def __init__(
        self,
        evaluator: Evaluator,
        waited: Waited,
        writes: OutputWrites,
        transcript: Transcript,
        keeping: Keeping,
    ) -> None:
        self._evaluator = evaluator
        self._waited = waited
        self._writes = writes
        self._transcript = transcript
        self._keeping = keeping

    def halt(self, statement: Halt, scope: Scope) -> None:
        why = "taken as continued at once: waiting takes no time here"
        self._keeping.keep(statement.span, "HALT", why, stops=True)

    def wait_sec(self, statement: WaitSec, scope: Scope) -> None:
        value = self._evaluator.evaluate(statement.time, scope)
        if isinstance(value, Unknown):
            why = f"its time depends on {value.reason} and is taken as zero"
            self._keeping.keep(statement.span, "WAIT SEC", why, stops=True)
            return
        if isinstance(value, bool) or not isinstance(value, int | float):
            raise SourceError(f"WAIT SEC wants a number, not {shown(value)}", statement.time.span)
        below_zero = "the program does not wait, and only the advance run stops"
        self._transcript.wait(float(value), "WAIT SEC", below_zero, statement.span)

    def wait_for(self, statement: WaitFor, scope: Scope) -> None:
        self._waited.suppose(statement.condition, scope)
        why = "taken as satisfied at once: waiting takes no time here"
        self._keeping.keep(statement.span, "WAIT FOR", why, stops=True)

    def keyword(self, statement: Keyword, scope: Scope) -> None:
        why = KEYWORDS.get(statement.word, kept(statement.word))
        if why is not None:
            if statement.word in ("global", "interrupt"):
                text = self._transcript.text_of(statement.span)
                self._writes.interrupted(text, scope, statement.span)
            word = "INTERRUPT" if statement.word == "global" else statement.word.upper()
            self._keeping.keep(statement.span, word, why.why, why.stops)
