"""Records which statements of a run come from which routine and loop."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sized
from contextlib import contextmanager
from dataclasses import dataclass, field, replace

from ...errors import Span
from ...program.cycle import Cycle
from ...program.section import Section


@dataclass
class Sections:
    """The routines and loops of one run, in the order in which they begin.

    Attributes:
        statements: that the run has left so far.
    """

    statements: Sized = ()
    _found: list[Section] = field(default_factory=list)

    @contextmanager
    def routine(self, name: str, span: Span) -> Iterator[None]:
        """While a routine runs."""
        index = self._begin(name, span)
        try:
            yield
        finally:
            self._end(index, ())

    @contextmanager
    def loop(self, name: str, span: Span, tested: bool) -> Iterator[Callable[[], None]]:
        """While a loop runs; what it gives is to be called when a pass begins."""
        index = self._begin(name, span, tested)
        passes: list[int] = []
        try:
            yield lambda: passes.append(len(self.statements))
        finally:
            self._end(index, tuple(passes))

    def found(self, cycle: Cycle | None) -> tuple[Section, ...]:
        """Those that have left statements, without the program's own entry.

        Args:
            cycle: the last pass of the loop that production runs in.
        """
        end = len(self.statements)
        found = [s for s in self._found if s.end > s.begin]
        if found and not found[0].passes and (found[0].begin, found[0].end) == (0, end):
            del found[0]
        last = None if cycle is None else cycle.span
        return tuple(
            replace(s, endless=True) if s.passes and s.span == last and s.end == end else s
            for s in found
        )

    def _begin(self, name: str, span: Span, tested: bool = False) -> int:
        begin = len(self.statements)
        self._found.append(Section(name, begin, begin, span, tested=tested))
        return len(self._found) - 1

    def _end(self, index: int, passes: tuple[int, ...]) -> None:
        end = len(self.statements)
        count = len(passes)
        while count > 1 and passes[count - 1] == end:  # a pass that left nothing
            count -= 1
        self._found[index] = replace(self._found[index], end=end, passes=passes[:count])
