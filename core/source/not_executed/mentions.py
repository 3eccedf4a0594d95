"""Where the text of a program names a datum, or concerns it without naming it."""

from __future__ import annotations

import re
from collections.abc import Iterator
from dataclasses import dataclass, replace

from ...dialect import Mention, RoutineText, Unsaid, Wording
from ...errors import Span
from ...program.program import Program
from ..reading import Reading
from ..text.files import SourceText, unbroken
from ..text.references import Reference, reference_of, references
from .executed import executed
from .renewal import FileBlocks, Place

ASSIGNED = re.compile(r"[ \t]*:?=(?!=)")
_ARGUMENT = re.compile(r"[(,][ \t]*$|\\[ \t]*$")
_DEFAULT = re.compile(r"=[ \t]*$")
_INDEX = re.compile(r"[\[{]")

Key = tuple[str, tuple[int | str, ...], str, RoutineText | None]


@dataclass(frozen=True)
class Watched:
    """A datum whose value has changed.

    Args:
        datum: what is looked for.
        file: where it lies, or is a parameter.
        at: offset of a place that names it.
        label: its name, for messages.
        made: where it gets its changed value.
        inside: the routine whose parameter it is; None for data.
    """

    datum: Reference
    file: str
    at: int
    label: str
    made: Place
    inside: RoutineText | None = None

    @property
    def key(self) -> Key:
        """The same for the same datum."""
        return self.datum.name, self.datum.path, self.file, self.inside


@dataclass(frozen=True, slots=True)
class Mentioned:
    """A place that names a datum, or concerns it without naming it."""

    file: str
    reference: Reference
    given: bool = False
    renews: bool = False


@dataclass(frozen=True, slots=True)
class UnsaidNames:
    """What an instruction concerns without naming it, as references to its place."""

    said: Unsaid
    datum: Reference
    source: Reference | None

    @classmethod
    def of(cls, said: Unsaid, wording: Wording) -> UnsaidNames:
        """The references of one."""
        datum, source = (
            None
            if name is None
            else replace(reference_of(name, wording), start=said.start, end=said.end)
            for name in (said.datum, said.source)
        )
        assert datum is not None
        return cls(said, datum, source)


class ProgramText:
    """The files of a program, searched for data; comments and strings do not count.

    Args:
        program: as its reader made it.
        reading: its files.
        wording: how they are searched.
    """

    def __init__(self, program: Program, reading: Reading, wording: Wording) -> None:
        self.wording = wording
        self.texts = {
            name: wording.quiet(unbroken(file.text)) for name, file in reading.files.items()
        }
        self.sources = {name: SourceText(text, name) for name, text in self.texts.items()}
        self.routines = {name: [*wording.routines(t)] for name, t in self.texts.items()}
        self._declared = {name: [*wording.declared(text)] for name, text in self.texts.items()}
        self.unsaid = {
            name: [UnsaidNames.of(one, wording) for one in wording.unsaid(text)]
            for name, text in self.texts.items()
        }
        self.blocks = FileBlocks(self.texts, self.routines, wording)
        self._executed = executed(program, reading)

    def definition(self, datum: Reference, number: Span) -> Reference | None:
        """The datum's own name before its first number."""
        text = self.texts[number.file]
        places = [
            one
            for one in references(datum.name, text[: number.start], self.wording)
            if one.meets(datum) and ASSIGNED.match(text, one.end)
        ]
        return places[-1] if places else None

    def named(self, watched: Watched) -> Iterator[Mentioned]:
        """Where a datum is used or given a value; declarations name it without using it."""
        datum, inside = watched.datum, watched.inside
        meant = self._meant(datum.name, watched.file, watched.at)
        for file in self.texts:
            if inside is not None and file != watched.file:
                continue
            declared = {at for _, at in self._declared[file]}
            for one in self._mentions(datum, file):
                start = one.reference.start
                if start in declared or not one.reference.meets(datum):
                    continue
                if inside is not None:
                    if inside.body <= start < inside.end:
                        yield one
                    continue
                here = self._meant(datum.name, file, start)
                if not (meant and here) or meant & here:
                    yield one

    def _mentions(self, datum: Reference, file: str) -> Iterator[Mentioned]:
        text = self.texts[file]
        for one in references(datum.name, text, self.wording):
            if self._names_it(file, one):
                continue
            given = ASSIGNED.match(text, one.end) is not None
            if given and _ARGUMENT.search(text, max(0, one.start - 80), one.start):
                continue  # the name of an argument
            sure = given and self._holds_all(one, datum, text)
            yield Mentioned(file, one, given, sure)
        for unsaid in self.unsaid[file]:
            one, given = unsaid.datum, unsaid.said.given
            if one.name == datum.name:
                sure = given and unsaid.said.certain and one.path == datum.path[: len(one.path)]
                yield Mentioned(file, one, given, sure)
            if unsaid.source is not None and unsaid.source.name == datum.name:
                yield Mentioned(file, unsaid.source)

    @staticmethod
    def _holds_all(one: Reference, datum: Reference, text: str) -> bool:
        """Whether what is given a value is all of a datum, and known to be."""
        indices = len(_INDEX.findall(text, one.start, one.end))
        known = indices <= sum(isinstance(step, int) for step in one.path)
        return known and one.path == datum.path[: len(one.path)]

    def _names_it(self, file: str, one: Reference) -> bool:
        """Whether a place declares the name: in a routine's heading, or a declaration of any
        type."""
        text = self.texts[file]
        if any(routine.start <= one.start < routine.body for routine in self.routines[file]):
            return not _DEFAULT.search(text, 0, one.start)
        line = text[text.rfind("\n", 0, one.start) + 1 : one.start]
        bare = re.match(r"[\w$]+", text[one.start :])
        mentions = [*self.wording.mentions(line + ("" if bare is None else bare[0]))]
        return bool(mentions) and mentions[-1][1] is Mention.DECLARED

    def _meant(self, name: str, file: str, at: int) -> frozenset[tuple[str, int]]:
        """The declarations that a name at a place may mean; none if it is declared elsewhere."""
        module = self.wording.module(file)
        outside: list[tuple[str, int]] = []
        nearest: tuple[int, tuple[str, int]] | None = None
        for other, declared in self._declared.items():
            for found, place in declared:
                if self.wording.folded(found) != name:
                    continue
                routine = self.blocks.routine(other, place)
                if routine is None:
                    outside += [(other, place)] * (self.wording.module(other) == module)
                elif other == file and place <= at and routine.start <= at < routine.end:
                    size = routine.end - routine.start
                    if nearest is None or size <= nearest[0]:
                        nearest = (size, (other, place))
        return frozenset(outside if nearest is None else [nearest[1]])

    def statement(self, file: str, one: Reference) -> tuple[int, int] | None:
        """The executed statement that a reference stands in, with all round an executed call."""
        line = self.sources[file].span(one.start, one.end).line
        around = (
            (start, end)
            for start, end in self._executed.get((file, line), ())
            if start <= one.start and one.end <= self._head_end(file, start, end)
        )
        return max(around, key=lambda found: found[1] - found[0], default=None)

    def declaration(self, file: str, one: Reference) -> tuple[int, int] | None:
        """The declaration whose initial value a reference is part of, from its name on."""
        text = self.texts[file]
        start = max((at for _, at in self._declared[file] if at < one.start), default=None)
        if start is None:
            return None
        behind = start + reference_of(text[start : one.start], self.wording).end
        sign = ASSIGNED.match(text, behind, one.start)
        if sign is None or re.search(r"[;\r\n]", text[behind : one.start]):
            return None
        return start, one.end

    def _head_end(self, file: str, start: int, end: int) -> int:
        """Where what is executed of a statement itself ends, if it holds others."""
        heads = self.wording.heads
        found = None if heads is None else heads.match(self.texts[file], start, end)
        return end if found is None else found.end()
