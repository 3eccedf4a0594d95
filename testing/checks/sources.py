"""Checks of where numbers stand in golden texts: reads, patches, and code that is not driven."""

from __future__ import annotations

import re
from collections import defaultdict
from collections.abc import Callable, Iterator
from dataclasses import fields, replace
from typing import Any

import pytest

from ...core.dialect import Mention, Wording
from ...core.errors import FlybyError, PluginFault, Span
from ...core.program.arc_orientation import ArcOrientation
from ...core.program.move import Move, MoveC
from ...core.program.origin import Origin, Ownership
from ...core.program.program import Program
from ...core.program.target import JointTarget, PoseTarget, Target
from ...core.program.zone import Fine, Radius, VendorZone
from ...core.source.not_executed.search import not_executed
from ...core.source.patch.edits import alike, difference, reading_of
from ...core.source.reading import Files, Reading
from ...core.spatial.pose import Pose
from ..golden import GoldenText
from .golden import stated_speeds
from .patching import PARTS, PartChange, check_stretches, must_be_patched, shifted
from .subject import Subject
from .telling import line_of, told

_STEP = 0.0025
"""m or rad by which targets are shifted; 1 of 400 by which literals are changed."""
_BY: tuple[Callable[[float], float], ...] = (
    lambda value: value * (1 + _STEP) if value else _STEP,
    lambda value: value * (1 - _STEP),
    lambda value: value + 1,
)
"""What literals become; of two limits the larger one may not count."""
_NO_VALUE = 1e8
"""Literals from here on stand for no value (9E9)."""
_FINEST = 1e-12

Place = tuple[int, str]
"""A move and a part of it."""


class SourceChecks(Subject):
    """Where numbers stand is recorded, patches change them there, and only where they may."""

    def test_recorded_reads_are_those_of_the_text(self) -> None:
        """Each literal that is recorded is changed: the parts that change are those that say they
        read it."""
        self.need("reader", "patcher")
        for text in self.golden_texts:
            program = self.read_golden(text)
            varied, effective = set[Place](), set[Place]()
            for span, claimed in _literals(program).items():
                changed = self._changed_by(program, span)
                if changed is None:
                    continue
                derived = {place for place in changed if _is_derived(program, place)}
                number = repr(_at(program, span))
                what = f"{text.about!r}, {span.line}:{span.column}: the number {number}"
                unsaid = sorted(changed - derived - claimed)
                assert not unsaid, told(
                    f"{what} is read by moves that do not say so",
                    written=_shown(claimed),
                    read=_shown(unsaid),
                    look="the origin of the part (`MoveOrigin`): every literal that it is made of",
                )
                varied |= {place for place in claimed if not _is_switched_off(program, place)}
                effective |= changed
                owned = [p for p in claimed if _origin(program, p).ownership is Ownership.OWNED]
                moves = {index for index, _ in claimed}
                assert not owned or len(moves) == 1, told(
                    f"{what} is owned by one move, and several read it",
                    written=_shown(claimed),
                    look="Ownership: what several moves read is shared",
                )
            assert varied <= effective, told(
                f"{text.about!r}: none of the numbers that are recorded for a part changes it",
                read=_shown(varied - effective),
                look="the spans of `Origin.numbers`: they belong to other numbers",
            )

    def _changed_by(self, program: Program, span: Span) -> set[Place] | None:
        """The parts that are read otherwise when a literal is another one; None where no other one
        can stand there."""
        read = [*filter(None, (_with_literal_changed(program, span, by) for by in _BY))]
        rigid = self.vendor.speaks is not None and self.vendor.speaks.rigid_arcs
        found = [set(_changed_parts(program, again, rigid)) for again in read]
        return next((one for one in found if one), found[0] if found else None)

    def test_patches_of_golden_texts(self) -> None:
        self.need("reader", "patcher")
        for text in self.golden_texts:
            if text.robot is None:
                continue
            robot = self.vendor.robot(text.robot)
            program = self.read_golden(text)
            before = reading_of(program)
            patched = 0
            for change in changes(program):
                move = program.moves[change.move]
                what = f"{text.about!r}, move {change.move + 1}: its {change.part}"
                new = getattr(change.program.moves[change.move], change.part)
                try:
                    files = self.vendor.patch(change.program, robot)
                except PluginFault:
                    raise
                except FlybyError as error:
                    assert not must_be_patched(program, change), told(
                        f"{what} is its own, and not patched: {error}",
                        written=new,
                        read=line_of(text.files, move),
                        look="the patcher: literals that one move owns are changed in place",
                    )
                    continue
                found = _difference(change.program, before, files)
                assert found is None, told(
                    f"{what} is patched, and the text says another program: {found}",
                    written=new,
                    read="\n".join(file.text for file in files.values()),
                    look="where the patcher writes, how it rounds, and what else reads the number",
                )
                check_stretches(before.files, files, change)
                patched += 1
            assert patched, f"{self.name}: nothing in {text.about!r} can be patched"

    def test_code_that_is_not_driven_stops_a_patch(self) -> None:
        """What golden texts say that code uses which is not driven is reported, and only that."""
        self.need("reader", "patcher")
        wording = self.wording
        for text in self.golden_texts:
            if text.robot is None:
                continue
            program = self.read_golden(text)
            rows = [row for row in text.statements if row["kind"].startswith("Move")]
            stated = {(k, part) for k, row in enumerate(rows) for part in row.get("not_driven", ())}
            tried = set[Place]()
            for change in changes(program):
                if change.part not in ("target", "via"):
                    continue
                try:
                    files = self.vendor.patch(change.program, self.vendor.robot(text.robot))
                except PluginFault:
                    raise
                except FlybyError:
                    continue
                after = reading_of(program).again(files)
                reported = not_executed(program, after, wording)
                tried.add((change.move, change.part))
                wanted = (change.move, change.part) in stated
                assert bool(reported) == wanted, told(
                    f"{text.about!r}: the {change.part} of move {change.move + 1} is "
                    f"{'used' if wanted else 'used nowhere'} in code that is not driven, and "
                    f"{'not reported' if wanted else 'reported'}",
                    written=line_of(text.files, program.moves[change.move]),
                    read=reported,
                    look="Wording: names, mentions, routines, heads, what is silent",
                )
            assert stated <= tried, told(
                f"{text.about!r}: {_shown(stated - tried)} cannot be patched, and nothing shows "
                "whether code is found that is not driven",
                look="the golden text: let one move own a datum that such code uses",
            )

    def test_the_wording_finds_what_texts_say(self) -> None:
        self.need("reader")
        wording = self.wording
        for text in self.golden_texts:
            program = self.read_golden(text)
            texts = {name: one.text for name, one in reading_of(program).files.items()}
            quiet = {name: wording.quiet(one) for name, one in texts.items()}
            declared = {
                wording.folded(name) for one in quiet.values() for name, _ in wording.declared(one)
            }
            for move in program.moves:
                self._check_named(text, move, wording, quiet, declared)
            self._check_silent(text, texts, quiet)

    def _check_named(
        self,
        text: GoldenText,
        move: Move,
        wording: Wording,
        quiet: dict[str, str],
        declared: set[str],
    ) -> None:
        if move.origin is None:
            return
        span = move.origin.statement
        said = quiet[span.file][span.start : span.end]
        used = {
            wording.folded(name)
            for name, mention in wording.mentions(said)
            if mention is Mention.USED
        }
        line = line_of(text.files, move)
        assert said.strip(), told(
            f"{text.about!r}: a motion counts as a comment", read=line, look="Wording.silent"
        )
        for part in ("target", "via"):
            datum = getattr(getattr(move, part, None), "name", None)
            if datum is None:
                continue
            name = wording.folded(datum)
            assert name in declared, told(
                f"{text.about!r}: the declaration of {datum} is not found",
                written=line,
                read=f"declared: {', '.join(sorted(declared))}",
                look="Wording.targets and Wording.name",
            )
            assert name in used, told(
                f"{text.about!r}: that {datum} is used here is not found",
                written=line,
                read=f"used: {', '.join(sorted(used))}",
                look="Wording.name and Wording.named",
            )

    def _check_silent(self, text: GoldenText, texts: dict[str, str], quiet: dict[str, str]) -> None:
        sign = self.comment_sign
        for name, one in texts.items():
            pairs = zip(one.splitlines(), quiet[name].splitlines(), strict=True)
            for number, (line, left) in enumerate(pairs, 1):
                if sign and _NUMBERED.sub("", line).strip().startswith(sign):
                    assert not left.strip(), told(
                        f"{text.about!r}: a comment counts as text",
                        written=f"{name}:{number}: {line}",
                        read=left,
                        look="Wording.silent",
                    )

    @property
    def wording(self) -> Wording:
        """How texts are searched; skips the check if they are not."""
        if self.vendor.speaks is None or self.vendor.speaks.wording is None:
            pytest.skip(f"the texts of {self.name} are not searched")
        return self.vendor.speaks.wording


def changes(program: Program) -> Iterator[PartChange]:
    """Each part of each move with other numbers, one after the other."""
    for index, move in enumerate(program.moves):
        if move.origin is None:
            continue
        for part in PARTS:
            old = getattr(move, part, None)
            new = None if old is None else _other(part, old, move)
            if new is None:
                continue
            moves = list(program.moves)
            moves[index] = replace(move, **{part: new})
            changed = program.with_moves(tuple(moves))
            origin = getattr(move.origin, part)
            yield PartChange(index, part, changed, origin, move.origin.statement)


_NUMBERED = re.compile(r"^\s*\d+\s*:")
"""The number of a line, where a language has them."""


def _other(part: str, old: Any, move: Move) -> Any:
    """The part with other numbers of the same words; None where there are none."""
    if part in ("target", "via"):
        return replace(shifted(old, _STEP), name=old.name)
    if part == "speed":
        stated = stated_speeds(move)
        if not stated:
            return None
        first = "duration" if "duration" in stated else stated[0]
        return replace(old, **{first: 0.5 * getattr(old, first)}, name=None)
    if isinstance(old, Fine) or getattr(old, fields(old)[0].name) == 0:
        return None
    if isinstance(old, Radius):
        return old.resized(0.5 * old.tcp)
    if isinstance(old, VendorZone):
        size = old.kind.rounded(0.5 * old.size)
        return replace(old, size=size) if size > 0.0 else None
    return replace(old, **{fields(old)[0].name: 0.5 * getattr(old, fields(old)[0].name)})


def _difference(wanted: Program, before: Reading, files: Files) -> str | None:
    """In what the program of patched files differs from the wanted one."""
    try:
        found = difference(wanted, before.again(files))
    except FlybyError as error:
        return str(error)
    if found is None:
        return None
    return f"another {found[1]} of move {found[0] + 1}" if found[0] >= 0 else found[1]


def _literals(program: Program) -> dict[Span, set[Place]]:
    """The parts that say they read each literal."""
    found: defaultdict[Span, set[Place]] = defaultdict(set)
    for index, move in enumerate(program.moves):
        for part in PARTS:
            origin = None if move.origin is None else getattr(move.origin, part)
            for span in () if origin is None else origin.numbers:
                if span is not None:
                    found[span].add((index, part))
    return found


def _with_literal_changed(
    program: Program, span: Span, by: Callable[[float], float]
) -> Program | None:
    """The program with another literal; None where that is no text of the language."""
    reading = reading_of(program)
    try:
        value = float(_at(program, span))
    except ValueError:
        return None
    if abs(value) >= _NO_VALUE:
        return None
    new = f"{by(value):.9f}".rstrip("0").rstrip(".")
    file = reading.files[span.file]
    try:
        again = reading.again({span.file: file.edited([(span.start, span.end, new)])})
    except PluginFault:
        raise
    except FlybyError:
        return None
    return again if len(again.moves) == len(program.moves) else None


def _changed_parts(before: Program, after: Program, rigid: bool) -> Iterator[Place]:
    """Parts that two programs have otherwise; where arcs turn the tool by themselves (``rigid``),
    its orientation at their ends is no number of the text."""
    for index, (one, other) in enumerate(zip(before.moves, after.moves, strict=True)):
        if rigid and isinstance(one, MoveC) and one.orientation is ArcOrientation.FOLLOWS_ARC:
            one, other = (replace(m, target=_unturned(m.target)) for m in (one, other))
        for part in PARTS:
            if not alike(getattr(one, part, None), getattr(other, part, None), _FINEST):
                yield index, part


def _unturned(target: Target) -> Target:
    return target if isinstance(target, JointTarget) else PoseTarget(Pose(target.pose.position))


def _origin(program: Program, place: Place) -> Origin:
    origin = getattr(program.moves[place[0]].origin, place[1])
    assert isinstance(origin, Origin)
    return origin


def _is_derived(program: Program, place: Place) -> bool:
    return _origin(program, place).ownership is Ownership.DERIVED


def _is_switched_off(program: Program, place: Place) -> bool:
    """Whether a part is a stop that one of several settings makes: the others do not count."""
    index, part = place
    stops = part == "zone" and isinstance(program.moves[index].zone, Fine)
    return stops and len(_origin(program, place).numbers) > 1


def _at(program: Program, span: Span) -> str:
    return reading_of(program).files[span.file].text[span.start : span.end]


def _shown(places: Any) -> str:
    return ", ".join(f"the {part} of move {index + 1}" for index, part in sorted(places))
