"""Changed targets, zones and speeds in the user's own scripts; every other byte stays."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Mapping

from ....core.errors import FlybyError, Span
from ....core.program.program import Program
from ....core.robot.model import Robot
from ....core.source.patch.edits import Edit, changed_moves, patched, reading_of, with_one_distance
from ....core.source.reading import Files, Reading
from ....core.source.write.options import PatchOptions, Sharing
from .inplace import Argument, arguments
from .places import MoveCall, MoveCalls

_INSERTED = ("a", "v", "t", "r")
"""Arguments that may be put in, in the order in which they stand."""


def patch(program: Program, robot: Robot, options: Mapping[str, str]) -> Files:
    """The files that a program was read from, with the numbers that it has now.

    A number is changed where it stands, be it in the call or in a variable that the call names.
    An argument that is not written is put in before the closing bracket. Numbers that other moves
    read too are changed only if all of them agree, and what the script computes not at all; with
    ``shared=own`` and ``derived=own`` the call gets a literal of its own in their place.

    Raises:
        InputError: a change has no place in the text, or reading the patched text does not give
            the changed program.
        MotionError: the same of one move.
    """
    chosen = PatchOptions.of(options, "URScript patcher")
    reading = reading_of(program)
    program = with_one_distance(program)
    before = reading.again({})
    if not changed_moves(before, program):
        return {}
    asked = Asked(before, program, reading)
    try:
        return patched(program, reading, asked.edits(chosen, inline_shared=frozenset()))
    except FlybyError:
        # Numbers that all moves agree on may still be read by an expression somewhere.
        again = asked.in_place if chosen.shared is Sharing.OWN else frozenset()
        if not again:
            raise
        return patched(program, reading, asked.edits(chosen, inline_shared=again))


class Asked:
    """What a changed program asks of the text.

    Args:
        before: as the text says it.
        after: as it shall say it.
        reading: of the text.

    Raises:
        MotionError: something changed that has no place in the text.
    """

    def __init__(self, before: Program, after: Program, reading: Reading) -> None:
        self._files = reading.files
        self._calls = MoveCalls(reading.files)
        self._wanted: defaultdict[Span, dict[str, int]] = defaultdict(dict)
        self._executions: defaultdict[tuple[Span, str], list[Argument]] = defaultdict(list)
        self._changed: list[Argument] = []
        for index, (old, new) in enumerate(zip(before.moves, after.moves, strict=True)):
            for argument in arguments(index, old, new):
                self._note(argument)
        self.in_place: frozenset[int] = frozenset()

    def _note(self, argument: Argument) -> None:
        self._executions[argument.statement, argument.name].append(argument)
        for span, text in zip(argument.spans, argument.texts(self._present), strict=True):
            if span is not None and text is not None:
                self._wanted[span].setdefault(text, argument.move)
        if argument.changed:
            self._changed.append(argument)

    def _present(self, span: Span) -> str:
        return self._files[span.file].text[span.start : span.end]

    def edits(self, options: PatchOptions, inline_shared: frozenset[int]) -> list[Edit]:
        """The edits that make the text say it.

        Args:
            options: what may get literals of its own.
            inline_shared: indices in the list of changed arguments that get one in any case.

        Raises:
            MotionError: a change has no place.
        """
        edits: list[Edit] = []
        insertions: dict[Span, dict[str, Argument]] = {}
        in_place: set[int] = set()
        for k, argument in enumerate(self._changed):
            call = self._calls.at(argument.statement)
            if self._is_absent(argument, call):
                self._agreed(argument)
                insertions.setdefault(argument.statement, {})[argument.name] = argument
            elif k in inline_shared or self._needs_own(argument, options):
                edits.append(self._own(argument, call))
            else:
                in_place.add(k)
                edits += self._in_place(argument)
        self.in_place = frozenset(in_place)
        return edits + [self._insert(s, found) for s, found in insertions.items()]

    def _is_absent(self, argument: Argument, call: MoveCall) -> bool:
        """Whether the call does not write the argument, but could."""
        if argument.name not in _INSERTED or call.written(argument.name) is not None:
            return False
        if not call.takes(argument.name):
            raise argument.error(f"{call.call.name} has no such argument")
        return True

    def _needs_own(self, argument: Argument, options: PatchOptions) -> bool:
        """Whether the numbers cannot be changed where they stand.

        Raises:
            MotionError: the options do not allow anything else.
        """
        texts = argument.texts(self._present)
        stated = zip(argument.spans, texts, strict=True)
        if any(span is None and text is not None for span, text in stated):
            if options.derived is Sharing.OWN:
                return True
            raise argument.error(
                "the script computes it, so that there is no number to change; "
                "--own (in Python derived=own) puts a literal in its place"
            )
        if all(span is None or len(self._wanted[span]) == 1 for span in argument.spans):
            return False
        if options.shared is Sharing.OWN:
            return True
        spans = filter(None, argument.spans)
        others = {move for span in spans for move in self._wanted[span].values()} - {argument.move}
        who = f"move {min(others) + 1}" if others else "another argument of the call"
        raise argument.error(
            f"{who} reads the same number and wants another one: give them one value, or let "
            "--own (in Python shared=own) put a literal in its place"
        )

    def _in_place(self, argument: Argument) -> list[Edit]:
        texts = argument.texts(self._present)
        return [
            Edit(span, text, argument.move)
            for span, text in zip(argument.spans, texts, strict=True)
            if span is not None and text is not None and text != self._present(span)
        ]

    def _own(self, argument: Argument, call: MoveCall) -> Edit:
        """A literal in the place of the expression at the call."""
        self._agreed(argument)
        expression = call.written(argument.name)
        if expression is None:
            raise argument.error("it has no place in the call that a literal could take")
        return Edit(call.span(expression), argument.literal(self._present), argument.move)

    def _insert(self, statement: Span, found: Mapping[str, Argument]) -> Edit:
        """Arguments before the closing bracket."""
        parts = [
            f", {name}={found[name].literal(self._present)}" for name in _INSERTED if name in found
        ]
        moves = [argument.move for argument in found.values()]
        return Edit(self._calls.at(statement).end, "".join(parts), min(moves))

    def _agreed(self, argument: Argument) -> None:
        """Refuse a literal at a call that is executed again for something else."""
        for other in self._executions[argument.statement, argument.name]:
            if other.new != argument.new:
                raise argument.error(
                    f"the call is executed for move {other.move + 1} too, which wants another "
                    "value: a literal there cannot say both; change them alike"
                )
