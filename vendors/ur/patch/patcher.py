"""Changed targets, zones and speeds in the user's own scripts; every other byte stays.

What is changed where:

- A number is changed where it stands, be it in the call or in a variable that the call names, if
  all moves that read it are to have the same new value.
- An argument that is not written is put in before the closing bracket.
- Else the change is refused, or, under ``shared=own`` (literals that others read) and
  ``derived=own`` (what the script computes), the call gets a literal in the place of the
  argument.

Of a program's tree (``.urp``) the numbers of its nodes are changed, and the script beside it if
that drives the same.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from contextlib import suppress
from dataclasses import replace

from ....core.errors import FlybyError, InputError, Span
from ....core.program.origin import Ownership
from ....core.program.program import Program
from ....core.robot.model import Robot
from ....core.source.patch.edits import Edit, difference, reading_of, with_one_distance
from ....core.source.patch.plan import PatchPlan, patch_program
from ....core.source.patch.uses import Use
from ....core.source.reading import Files, read_with
from ....core.source.text.files import SourceFile
from ....core.source.write.options import PatcherOptions
from ..urp.changes.tree_file import TreeFile
from .inplace import Argument, ScriptLiterals, arguments
from .places import PUT_IN, MoveCall, MoveCalls
from .trees import trees_of, with_taught_joints


def patch(program: Program, robot: Robot, options: Mapping[str, str]) -> Files:
    """The program's files with its numbers; see `core.source.patch.plan.patch_program`.

    Args:
        options: ``shared`` and ``derived``, each ``refuse`` or ``own``; see `PatcherOptions`.
    """
    chosen = PatcherOptions.of(options, "URScript patcher")
    reading = reading_of(program)
    wanted, trees = with_one_distance(program), trees_of(reading.files)
    if not trees:
        return _patched(wanted, chosen)
    before = reading.again({})
    wanted = with_taught_joints(wanted, before, trees, robot)
    files = _patched(wanted, chosen)
    changed = trees_of(files).values()
    code = {file.name: file for tree in changed for file in tree.code_changed(trees[tree.name])}
    main = files.get(reading.main)
    script = main.beside if isinstance(main, TreeFile) else None
    if script is None or script.name in code:
        return {**files, **code}
    return {**files, **code, **_carried(script, before, wanted, chosen)}


def _patched(program: Program, options: PatcherOptions) -> Files:
    calls = MoveCalls(reading_of(program).files)
    literals = ScriptLiterals(calls)
    return patch_program(program, options, literals, lambda plan: _Edits(plan, calls).all())


def _carried(script: SourceFile, before: Program, after: Program, options: PatcherOptions) -> Files:
    """The script that PolyScope has saved beside a tree, changed as the tree is.

    One that drives something else than the tree did is of another state, and stays as it is.
    """
    reading = reading_of(before)
    with suppress(FlybyError):
        own = read_with({script.name: script}, script.name, reading.options, reading.read)
        if difference(Program(before.moves), Program(own.moves)) is None:
            pairs = zip(own.moves, after.moves, strict=True)
            moves = tuple(replace(new, origin=old.origin) for old, new in pairs)
            return _patched(own.with_moves(moves), options)
    return {}


class _Edits:
    """Finds the edits."""

    def __init__(self, plan: PatchPlan, calls: MoveCalls) -> None:
        self._plan = plan
        self._calls = calls
        self._put_in: dict[Span, dict[str, Edit]] = {}

    def all(self) -> list[Edit]:
        """All edits.

        Raises:
            MotionError: a change has no place.
        """
        for use in self._plan.changes:
            self._check(use)
        found = [edit for use in self._plan.changes for edit in self._edits_for(use)]
        return [*found, *map(self._insertion, self._put_in)]

    def _check(self, use: Use) -> None:
        """Refuse what URScript cannot say, before other moves ask for it."""
        try:
            arguments(use)
        except InputError as error:
            raise use.error(str(error)) from None

    def _edits_for(self, use: Use) -> Iterator[Edit]:
        call = self._calls.at(use.statement)
        written: list[Argument] = []
        try:
            for argument in arguments(use):
                if argument.changed and call.can_be_put_in(argument.name):
                    self._insert(use, argument, call)
                elif argument.changed:
                    written.append(argument)
            if written and not self._fits(use):
                yield from (self._own(use, argument, call) for argument in written)
                return
        except InputError as error:
            raise use.error(str(error)) from None
        for span, text in self._plan.texts(use).items():
            yield Edit(span, text, use.index)

    def _fits(self, use: Use) -> bool:
        """Whether the numbers can be changed where they stand.

        Raises:
            InputError: the options do not allow anything else.
        """
        plan = self._plan
        against = plan.against(use)
        if plan.changeable(use) and plan.wish(use).complete and not against:
            return True
        if use.origin.ownership is Ownership.DERIVED or self._computed(use):
            plan.check_computed()
        else:
            plan.check_shared(use, against)
        return False

    def _computed(self, use: Use) -> bool:
        """Whether a number changes that no literal states."""
        stated = [
            zip(a.spans, a.texts(self._calls.text), strict=True)
            for a in arguments(use)
            if a.changed and not self._calls.at(use.statement).can_be_put_in(a.name)
        ]
        return any(s is None and text is not None for pairs in stated for s, text in pairs)

    def _own(self, use: Use, argument: Argument, call: MoveCall) -> Edit:
        """A literal in the place of the expression at the call."""
        self._check_executions(use, argument)
        expression = call.written(argument.name)
        if expression is None:
            raise InputError("it has no place in the call that a literal could take")
        return Edit(call.span(expression), argument.literal(self._calls.text), use.index)

    def _insert(self, use: Use, argument: Argument, call: MoveCall) -> None:
        """An argument that the call does not write."""
        if not call.takes(argument.name):
            raise InputError(f"{call.call.name} has no such argument: {argument.name}")
        self._check_executions(use, argument)
        text = f", {argument.name}={argument.literal(self._calls.text)}"
        puts = self._put_in.setdefault(use.statement, {})
        puts.setdefault(argument.name, Edit(call.end, text, use.index))

    def _insertion(self, statement: Span) -> Edit:
        """All arguments that are put in at a call, before its closing bracket."""
        puts = self._put_in[statement]
        found = [puts[name] for name in PUT_IN if name in puts]
        text = "".join(edit.text for edit in found)
        return Edit(found[0].span, text, min(edit.move for edit in found))

    def _check_executions(self, use: Use, argument: Argument) -> None:
        """Refuse a literal at a call that is executed again for something else."""

        def said(other: Use) -> object:
            return next(a.new for a in arguments(other) if a.name == argument.name)

        self._plan.check_executions(use, said)
