"""Checks of a vendor's patcher: the user's own file with other numbers, and nothing else."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from difflib import SequenceMatcher
from typing import Any

import pytest
from hypothesis import assume, given
from hypothesis import strategies as st

from ...core.errors import FlybyError, PluginFault, Span
from ...core.program.move import Move
from ...core.program.origin import MoveOrigin, Origin, Ownership
from ...core.program.program import Program
from ...core.program.target import JointTarget, Target
from ...core.program.zone import Fine, Radius, Zone
from ...core.source.not_executed.search import not_executed
from ...core.source.patch.edits import difference, reading_of
from ...core.source.reading import Files, Reading, ReadOptions
from ...core.source.text.files import SourceFile
from .subject import PROGRAM_EXAMPLES, Subject

_BESIDE = "beside"
PARTS = ("target", "via", "speed", "zone")


@dataclass(frozen=True)
class PartChange:
    """A part of a move that was changed."""

    move: int
    part: str
    program: Program
    origin: Origin
    statement: Span


class PatchingChecks(Subject):
    """A patch gives the changed program and touches nothing else, or it is refused."""

    @PROGRAM_EXAMPLES
    @given(data=st.data())
    def test_a_patch_gives_the_changed_program(self, data: st.DataObject) -> None:
        self.need("reader", "writer", "patcher")
        robot = self.vendor.robot(data.draw(st.sampled_from(self.driven_robots())))
        program = self.read_back(self.vendor.write(data.draw(self.programs(robot)), robot), robot)
        change = self._change(data, program)
        before = reading_of(program)
        try:
            files = self.vendor.patch(change.program, robot)
        except PluginFault:
            raise
        except FlybyError as error:
            assert not must_be_patched(program, change), f"an owned {change.part}: {error}"
            return
        assert {file.name for file in files.values()} <= set(before.files)
        assert not any(name.startswith(("/", "..")) for name in files), "a name leads elsewhere"
        assert difference(change.program, before.again(files)) is None
        check_stretches(before.files, files, change)

    @PROGRAM_EXAMPLES
    @given(data=st.data())
    def test_a_patch_of_nothing_changes_no_file(self, data: st.DataObject) -> None:
        self.need("reader", "writer", "patcher")
        robot = self.vendor.robot(self.driven_robots()[0])
        program = self.read_back(self.vendor.write(data.draw(self.programs(robot)), robot), robot)
        assert dict(self.vendor.patch(program, robot)) == {}

    @PROGRAM_EXAMPLES
    @given(data=st.data())
    def test_no_use_of_a_changed_datum_escapes(self, data: st.DataObject) -> None:
        """Code beside the program that uses it, here its own statement once more, is reported.

        So is code that drives under a setting that stands before the motion.
        """
        self.need("reader", "writer", "patcher")
        wording = None if self.vendor.speaks is None else self.vendor.speaks.wording
        if wording is None:
            pytest.skip(f"the texts of {self.name} are not searched")
        robot = self.vendor.robot(self.driven_robots()[0])
        program = self.read_back(self.vendor.write(data.draw(self.programs(robot)), robot), robot)
        change = self._change(data, program)
        own = change.statement
        known = [span for span in change.origin.numbers if span is not None]
        outside = [s for s in known if s.file != own.file or not own.start <= s.start < own.end]
        if not outside:
            return
        reading = reading_of(program)
        named = change.origin.datum is not None
        for span in (own, change.origin.span) if named else (own,):
            text = reading.files[span.file].text[span.start : span.end]
            told = not_executed(
                _beside(program, reading, text), _beside(change.program, reading, text), wording
            )
            wanted = [one for one in told if one.datum == change.origin.datum or not named]
            assert any(place.file == _BESIDE for one in wanted for place in one.places), (
                f"{change.origin.datum or 'a setting'} is used in {text!r}, and is not reported"
            )

    def _change(self, data: st.DataObject, program: Program) -> PartChange:
        """One part of one move with other numbers."""
        index = data.draw(st.integers(0, len(program.moves) - 1))
        move = program.moves[index]
        part = data.draw(st.sampled_from([p for p in PARTS if hasattr(move, p)]))
        old = getattr(move, part)
        new = data.draw(self._other(part, move))
        assume(new != old)
        moves = list(program.moves)
        moves[index] = replace(move, **{part: new})
        assert isinstance(move.origin, MoveOrigin), "moves that were read know their origin"
        origin = getattr(move.origin, part)
        changed = program.with_moves(tuple(moves))
        return PartChange(index, part, changed, origin, move.origin.statement)

    def _other(self, part: str, move: Move) -> st.SearchStrategy[Any]:
        if part == "zone":
            return self._other_zones(move)
        if part == "speed":
            return self.other_speeds(move).map(lambda s: replace(s, name=move.speed.name))
        target = getattr(move, part)
        return st.integers(-50, 50).map(lambda tenths: shifted(target, 1e-4 * tenths))

    def _other_zones(self, move: Move) -> st.SearchStrategy[Zone]:
        """Any that the language can say; often the move's own, larger or smaller."""
        any_zone = self.said_zones(type(move))
        own = move.zone
        if not isinstance(own, Radius):
            return any_zone
        return any_zone | st.sampled_from([0.5, 0.75, 1.25, 1.5]).map(
            lambda factor: own.resized(factor * own.tcp)
        )


def _beside(program: Program, reading: Reading, text: str) -> Program:
    """The program with a further file, whose text it does not drive."""

    def read(_: Files, main: str, options: ReadOptions) -> Program:
        return reading.read(reading.files, main, options)

    files = {**reading.files, _BESIDE: SourceFile(_BESIDE, f"{text}\n")}
    return replace(program, reading=replace(reading, files=files, read=read))


def shifted(target: Target, step: float) -> Target:
    """The target further along its first axis, m or rad."""
    if isinstance(target, JointTarget):
        first, *rest = target.joints
        return replace(target, joints=(first + step, *rest))
    x, y, z = target.pose.position
    return replace(target, pose=replace(target.pose, position=(x + step, y, z)))


def must_be_patched(program: Program, change: PartChange) -> bool:
    """Whether all numbers of the part stand in the text, and no other move reads them."""
    old, new = (getattr(p.moves[change.move], change.part) for p in (program, change.program))
    same_words = type(old) is type(new) and not isinstance(old, Fine)
    if change.part == "speed":
        same_words = _stated(old) == _stated(new)
    written = bool(change.origin.numbers) and None not in change.origin.numbers
    return change.origin.ownership is Ownership.OWNED and written and same_words


def _stated(speed: object) -> list[str]:
    return [name for name in speed.__slots__ if getattr(speed, name) is not None]  # type: ignore[attr-defined]


def check_stretches(before: Files, after: Files, change: PartChange) -> None:
    """Only the part's own numbers and the move's own statement have become other text, and only
    whole lines, declarations of new data, have come."""
    spans = [change.origin.span, change.statement]
    spans += [span for span in change.origin.numbers if span is not None]
    for file in after.values():
        name = file.name
        old = before[name]
        assert file.codec == old.codec and file.data != old.data
        own = sorted((s.start, s.end) for s in spans if s.file == name)
        assert own, f"{name} has nothing of the change"
        pieces, at = [], 0
        for start, end in own:
            if start >= at:
                pieces.append(old.text[at:start])
            at = max(at, end)
        pieces.append(old.text[at:])
        assert in_order(pieces, file.text) or in_order(
            pieces, without_new_lines(old.text, file.text)
        ), f"{name} changed elsewhere"


def in_order(pieces: Sequence[str], text: str) -> bool:
    """Whether a text is made of these pieces in their order, and of anything between them."""
    first, *middle, last = pieces
    if not text.startswith(first) or not text.endswith(last):
        return False
    at = len(first)
    for piece in middle:
        found = text.find(piece, at)
        if found < 0:
            return False
        at = found + len(piece)
    return at <= len(text) - len(last)


def without_new_lines(before: str, after: str) -> str:
    """A text without the lines that stand between those of ``before``."""
    old, new = before.splitlines(keepends=True), after.splitlines(keepends=True)
    steps = SequenceMatcher(None, old, new, autojunk=False).get_opcodes()
    return "".join("".join(new[a:b]) for step, _, _, a, b in steps if step != "insert")
