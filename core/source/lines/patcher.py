"""Changed numbers in the user's own lines; every other byte stays."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import fields, replace
from typing import Protocol

from ...errors import InputError, Span
from ...program.move import Move
from ...program.origin import Ownership
from ...program.program import Program
from ...program.speed import Speed
from ...program.zone import VendorZone
from ..patch.edits import Edit, reading_of
from ..patch.plan import PatchPlan, Wish, patch_program
from ..patch.uses import MovePart, Use, UseKind
from ..reading import Files
from ..text.numerals import in_proportion, nine_decimals, with_decimals_of
from ..write.options import PatcherOptions

Text = Callable[[Span], str]


class Patching(Protocol):
    """What a language says of its numbers (`core.source.lines.language.LineLanguage`)."""

    trailing: str

    def numbers(self, kind: UseKind, part: MovePart, move: Move) -> Sequence[float | None]:
        """Of a part of a move, in the order in which a line has them; None for one that may be
        anything."""
        ...

    def own(self, use: Use, later: Sequence[Move]) -> Iterable[Edit]:
        """What gives a part of a move numbers, or words, of its own; what it puts in right behind
        the move stands behind its line, and the comment there. ``later``: the moves behind it."""
        ...

    def gives(self, use: Use) -> bool:
        """Whether `own` can."""
        ...

    def reworded(self, use: Use) -> bool:
        """Whether a word at the motion, and no number, says the part."""
        ...

    def rewritten(self, use: Use, text: Text) -> Mapping[Span, str]:
        """What literals that are more than a number must say for a part, by their places."""
        ...


def patch_lines(program: Program, options: PatcherOptions, language: Patching) -> Files:
    """The files of a program with the numbers that it has now.

    A number is changed where it stands, in a point or at the move, if all moves that read it are to
    have the same; else, as the options say, the change is refused, or the move gets numbers of its
    own.

    Args:
        program: read by `interpreter.run_lines`, then changed.
        options: what may get numbers of its own.
        language: that it is in.

    Returns:
        The files that changed, by name.

    Raises:
        FlybyError: a change has no place in the text, or the text is not read as ``program``.
    """
    reading = reading_of(program)

    def text_at(span: Span) -> str:
        return reading.files[span.file].text[span.start : span.end]

    def behind(edit: Edit, use: Use) -> Edit:
        at = edit.span
        if not at.start == at.end == use.statement.end:
            return edit
        rest = re.split(r"[\r\n]", reading.files[at.file].text[at.end :], maxsplit=1)[0]
        comment = language.trailing
        if rest.strip() and not (comment and rest.strip().startswith(comment)):
            return edit
        end = at.end + len(rest.rstrip())
        return replace(edit, span=Span(at.file, at.line, at.column, end, end))

    def edits(plan: PatchPlan) -> list[Edit]:
        return [
            behind(edit, use)
            for use in plan.changes
            for edit in _edits(plan, use, language, program.moves[use.index + 1 :])
        ]

    return patch_program(program, options, _Literals(text_at, language), edits)


class _Literals:
    """What the numbers of the lines must say; see `core.source.patch.plan.Literals`."""

    def __init__(self, text: Text, language: Patching) -> None:
        self.text = text
        self._language = language

    def wish(self, use: Use) -> Wish:
        """What the literals of a part must say."""
        spans = use.origin.numbers
        old = self._language.numbers(use.kind, use.old, use.move)
        new = self._language.numbers(use.kind, use.new, use.move)
        words = (not spans and use.changes) or self._language.reworded(use)
        if words or len(spans) != len(new) or len(old) != len(new) or not _same_words(use):
            return Wish({s: self.text(s) for s in spans if s is not None}, complete=False)
        texts = dict(self._language.rewritten(use, self.text))
        missing = False
        for span, before, value in zip(spans, old, new, strict=True):
            if span is None:
                missing = missing or (before != value and value is not None)
            elif span not in texts:
                texts[span] = self._changed(use, span, before, value)
        return Wish(texts, complete=not missing)

    def _changed(self, use: Use, span: Span, before: float | None, value: float | None) -> str:
        """What stands at a place, with as many decimals as there are, where those are enough."""
        stated = self.text(span)
        if before == value or value is None:
            return stated
        return with_decimals_of(stated, self._said(use, span, before, value))

    def _said(self, use: Use, span: Span, before: float | None, value: float) -> str:
        """A number in the unit that it has in the text, and below an override that is on it:
        speeds and zones grow as their numbers do."""
        if use.kind not in (UseKind.SPEED, UseKind.ZONE) or not before:
            return nine_decimals(value)
        return nine_decimals(in_proportion(self.text(span), before, value))


def _same_words(use: Use) -> bool:
    """Whether the numbers of a part mean the same as before: a share and no distance, mm/s and no
    degrees/s."""
    if isinstance(use.old, VendorZone) and isinstance(use.new, VendorZone):
        return use.old.kind == use.new.kind
    if isinstance(use.old, Speed) and isinstance(use.new, Speed):
        return _stated(use.old) == _stated(use.new)
    return True


def _stated(speed: Speed) -> list[bool]:
    return [getattr(speed, field.name) is not None for field in fields(speed)]


def _edits(plan: PatchPlan, use: Use, language: Patching, later: Sequence[Move]) -> list[Edit]:
    try:
        against = plan.against(use)
        if plan.changeable(use) and plan.wish(use).complete and not against:
            return [Edit(span, text, use.index) for span, text in plan.texts(use).items()]
        at_move = use.origin.ownership is not Ownership.DERIVED and not any(
            use.origin.datum_of(k) for k in range(len(use.origin.numbers))
        )
        if language.reworded(use) or (at_move and not against):
            pass  # other words at the move itself: a stop becomes a zone
        elif use.origin.numbers:
            plan.check_shared(use, against, language.gives(use))
        else:
            plan.check_computed(language.gives(use))
        plan.check_executions(use)
        return list(language.own(use, later))
    except InputError as error:
        raise use.error(str(error)) from None
