"""Who else names a datum that is to change: code of the same files that was not driven.

Ownership (see `provenance`) follows from what a run reads. Another branch, or a routine that this
run does not call, may use the same datum: it would drive to the changed point too, and nothing has
been proven of it. So the text is searched for the names of changed data, and for every place it is
asked whether it has been executed. A datum that an executed assignment makes of a changed one is
watched as well, and so are a parameter that one is handed to, a function that returns one, what a
routine hands back through a parameter, and a speed or a zone that holds for all motions until it is
set again. Code that gives the datum another value first is left alone.
"""

from __future__ import annotations

import re
from collections import defaultdict
from collections.abc import Collection, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from itertools import pairwise

from ...dialect import Mention, RoutineText, Unsaid, Wording
from ...errors import Span
from ...program.move import Move
from ...program.origin import Origin
from ...program.program import Program
from ..patch.edits import changed_moves, reading_of
from ..patch.insertions import Inserted, changes_of
from ..patch.uses import Kind
from ..reading import Reading
from ..text.files import SourceText, lines_of, unbroken
from ..text.references import Reference, reference_of, references
from .renewal import Blocks, Place

_ASSIGNED = re.compile(r"[ \t]*:?=(?!=)")
_ARGUMENT = re.compile(r"[(,][ \t]*$|\\[ \t]*$")
_SIGN = re.compile(r"[^\w\s]")
_DEFAULT = re.compile(r"=[ \t]*$")
_RETURNS = "return"
"""What all languages call it when a function gives its value."""
_OPENING, _CLOSING = "([{", ")]}"
_INDEX = re.compile(r"[\[{]")
_ENDS = re.compile(r"[ \t]*(?:;|$)", re.MULTILINE)


@dataclass(frozen=True, slots=True)
class Bystander:
    """A datum that changes, and where code uses it that was not driven.

    Args:
        datum: its name.
        move: index of the first move that it changes for.
        places: in the text.
    """

    datum: str
    move: int
    places: tuple[Span, ...]


def bystanders(before: Program, after: Program, wording: Wording) -> tuple[Bystander, ...]:
    """The data that a change of a program's files concerns beyond what was driven.

    Names are searched for in all files, but where they mean a declaration of their own; comments
    and strings do not count. The program is read once more, to learn which statements are executed.

    Args:
        before: as its reader made it.
        after: as it is read from its changed text. A move that has got data of its own there
            leaves the old ones to the others.
        wording: how the language's texts are searched.

    Raises:
        InputError: the program was not read from source files, or statements were added, removed
            or put in another order.
    """
    numbers = _changed_numbers(before, after)
    inserted, _ = changes_of(before, after)
    statements = _changed_statements(before, after)
    if not numbers and not inserted and not statements:
        return ()
    watch = _Watch(before, reading_of(before), wording)
    put_in = [*watch.put_in(inserted)]
    groups: dict[object, tuple[int, list[_Watched]]] = {}
    for move, watched in [
        *((number.move, one) for number in numbers for one in watch.begun(number)),
        *((0, one) for one in put_in),
    ]:
        groups.setdefault((watched.key, watched.label), (move, []))[1].append(watched)
    found: dict[str, tuple[int, list[Span]]] = {}
    for move, started in groups.values():
        _, places = found.setdefault(started[0].label, (move, []))
        places += watch.places(started)
    for move, statement in statements:
        label = f"the motion in line {statement.line}"
        _, places = found.setdefault(label, (move, []))
        places += watch.callers(statement)
    return tuple(
        Bystander(datum, move, tuple(dict.fromkeys(places)))
        for datum, (move, places) in found.items()
        if places
    )


@dataclass(frozen=True, slots=True)
class _Number:
    """A number that changes.

    Args:
        datum: that it belongs to; None for a literal where it is used.
        move: index of the first move that reads it.
        span: of the number.
    """

    datum: str | None
    move: int
    span: Span


def _changed_numbers(before: Program, after: Program) -> list[_Number]:
    """Changed data by their first number, and changed literals outside of the move itself."""
    found: dict[object, _Number] = {}
    _, kept = changes_of(before, after)
    for index, old, new in changed_moves(before, after):
        for kind in Kind:
            origin: Origin | None = getattr(old.origin, kind, None)
            if origin is None or getattr(old, kind) == getattr(new, kind):
                continue
            if not _same_datum(origin, new, kind):
                continue
            assert old.origin is not None
            own = old.origin.statement
            for k, span in enumerate(origin.numbers):
                if span is None or (span.file, span.line) in kept:
                    continue
                datum = origin.datum_of(k)
                inside = span.file == own.file and own.start <= span.start < own.end
                if datum is not None or not inside:
                    found.setdefault(datum or span, _Number(datum, index, span))
    return list(found.values())


def _changed_statements(before: Program, after: Program) -> list[tuple[int, Span]]:
    """Motion instructions with other numbers or words of their own, and their first moves."""
    found: dict[Span, int] = {}
    reading = reading_of(before)
    _, kept = changes_of(before, after)
    for index, old, new in changed_moves(before, after):
        assert old.origin is not None
        own = old.origin.statement
        if kept:
            changed = any((own.file, line) not in kept for line in _lines(own, reading))
        else:
            parts = (
                getattr(old.origin, k, None)
                for k in Kind
                if getattr(old, k, 0) != getattr(new, k, 0)
            )
            spans = [span for part in parts if part is not None for span in part.numbers]
            changed = any(
                s is not None and s.file == own.file and own.start <= s.start < own.end
                for s in spans
            )
        if changed:
            found.setdefault(own, index)
    return [(index, span) for span, index in found.items()]


def _same_datum(old: Origin, new: Move, kind: Kind) -> bool:
    origin: Origin | None = getattr(new.origin, kind, None)
    return origin is not None and origin.datum == old.datum


_Key = tuple[str, tuple[int | str, ...], str, RoutineText | None]


@dataclass(frozen=True)
class _Watched:
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
    def key(self) -> _Key:
        """The same for the same datum."""
        return self.datum.name, self.datum.path, self.file, self.inside


@dataclass(frozen=True, slots=True)
class _Mention:
    """A place that names a datum, or concerns it without naming it."""

    file: str
    reference: Reference
    given: bool = False
    renews: bool = False


@dataclass(frozen=True, slots=True)
class _Unsaid:
    """What an instruction concerns without naming it, as references to its place."""

    said: Unsaid
    datum: Reference
    source: Reference | None

    @classmethod
    def of(cls, said: Unsaid, wording: Wording) -> _Unsaid:
        """The references of one."""
        datum, source = (
            None
            if name is None
            else replace(reference_of(name, wording), start=said.start, end=said.end)
            for name in (said.datum, said.source)
        )
        assert datum is not None
        return cls(said, datum, source)


class _Watch:
    """Looks for changed data in the files of a program.

    Args:
        program: as its reader made it.
        reading: its files.
        wording: how they are searched.
    """

    def __init__(self, program: Program, reading: Reading, wording: Wording) -> None:
        self._wording = wording
        self._texts = {
            name: wording.quiet(unbroken(file.text)) for name, file in reading.files.items()
        }
        self._sources = {name: SourceText(text, name) for name, text in self._texts.items()}
        self._routines = {name: [*wording.routines(t)] for name, t in self._texts.items()}
        self._declared = {name: [*wording.declared(text)] for name, text in self._texts.items()}
        self._unsaid = {
            name: [_Unsaid.of(one, wording) for one in wording.unsaid(text)]
            for name, text in self._texts.items()
        }
        self._blocks = Blocks(self._texts, self._routines, wording)
        self._called: defaultdict[str, list[tuple[str, RoutineText]]] = defaultdict(list)
        for name, routines in self._routines.items():
            for one in routines:
                self._called[wording.folded(one.name)].append((name, one))
        self._executed = _executed(program, reading)
        self._back: list[tuple[Reference, Place]] = []

    def begun(self, number: _Number) -> Iterator[_Watched]:
        """The data that a changed number is the value of."""
        span = number.span
        if number.datum is not None:
            datum = reference_of(number.datum, self._wording)
            own = self._definition(datum, span)
            at = span.start if own is None else own.start
            yield _Watched(datum, span.file, at, number.datum, (span.file, at))
            return
        place = Reference("", (), span.start, span.end)
        statement = self._statement(span.file, place)
        if statement is not None:
            yield from self._handed_on(span.file, statement, place)
        else:
            yield from self._default(span)

    def _default(self, number: Span) -> Iterator[_Watched]:
        """The parameter whose default a number in a routine's heading is."""
        text = self._texts[number.file]
        for one in self._routines[number.file]:
            if one.start <= number.start < one.body:
                names = [*self._wording.name.finditer(text, one.start, number.start)]
                datum = Reference(self._wording.folded(names[-1][0]), ())
                made = number.file, one.body
                yield _Watched(datum, number.file, one.start, names[-1][0], made, one)

    def put_in(self, inserted: Sequence[Inserted]) -> Iterator[_Watched]:
        """What lines that are put in give another value than it had; to be asked first."""
        for one in inserted:
            text = self._wording.quiet(one.text)
            for found in self._wording.name.finditer(text):
                datum = reference_of(text[found.start() :], self._wording)
                behind = found.start() + datum.end
                if not _ASSIGNED.match(text, behind):
                    continue
                label = text[found.start() : behind]
                watched = _Watched(datum, one.file, one.at, label, (one.file, one.at))
                if self._is_back(watched, text[behind:]):
                    self._back.append((datum, (one.file, one.at)))
                else:
                    yield watched
                break

    def _is_back(self, watched: _Watched, value: str) -> bool:
        """Whether a line that is put in says again what the text has said before it."""
        file, text = watched.file, self._texts[watched.file]
        routine = self._blocks.routine(file, watched.at)
        said = [
            one.reference
            for one in self._named(watched)
            if one.given
            and one.file == file
            and one.reference.start < watched.at
            and self._blocks.routine(file, one.reference.start) == routine
        ]
        if not said:
            return False
        last = max(said, key=lambda one: one.start)
        end = text.find("\n", last.end)
        line = text[last.end : len(text) if end < 0 else end]
        return line.strip() == value.strip() and self._blocks.renewed(
            (file, watched.at), [(file, last.start)], []
        )

    def places(self, started: Sequence[_Watched]) -> Iterator[Span]:
        """Where code uses a datum, or what is made of it, that was not executed.

        Args:
            started: the datum, for every place where it gets a changed value.
        """
        queue = [*started]
        made: defaultdict[_Key, set[Place]] = defaultdict(set)
        seen: dict[_Key, list[_Mention]] = {}
        while queue:
            watched = queue.pop()
            made[watched.key].add(watched.made)
            if watched.key in seen:
                continue
            named = [*self._named(watched)]
            seen[watched.key] = named
            for one in named:
                statement = self._statement(one.file, one.reference)
                statement = statement or self._declaration(one.file, one.reference)
                if statement is not None and not one.given:
                    queue += self._handed_on(one.file, statement, one.reference, watched)
        for key, named in seen.items():
            given = {(one.file, one.reference.start) for one in named if one.renews}
            given |= {at for one, at in self._back if (one.name, one.path) == key[:2]}
            sure = given - made[key], made[key]
            for one in named:
                at = one.file, one.reference.start
                declared = self._declaration(one.file, one.reference) is not None
                if one.given or declared or self._blocks.renewed(at, *sure):
                    continue
                if self._statement(one.file, one.reference) is None:
                    yield self._sources[one.file].span(one.reference.start, one.reference.end)
                elif key[-1] is None:
                    yield from self._callers(at, *sure)

    def callers(self, statement: Span) -> Iterator[Span]:
        """Calls that were not executed of the routine that a changed instruction lies in."""
        return self._callers((statement.file, statement.start))

    def _callers(
        self, at: Place, given: Collection[Place] = (), changed: Collection[Place] = ()
    ) -> Iterator[Span]:
        """Calls that were not executed of the routine that an executed place lies in.

        Args:
            at: the place, where a changed datum is used.
            given, changed: where the datum gets other values (see `Blocks.renewed`).
        """
        queue, seen = [at], set()
        while queue:
            file, offset = queue.pop()
            routine = self._blocks.routine(file, offset)
            if routine is None or (file, routine.start) in seen:
                continue
            seen.add((file, routine.start))
            own = any(f == file and routine.start <= one < routine.end for f, one in changed)
            for site in self._blocks.sites[self._wording.folded(routine.name)]:
                if not own and self._blocks.renewed(site, given, changed):
                    continue
                name = Reference("", (), site[1], site[1] + len(routine.name))
                if self._statement(site[0], name) is None:
                    yield self._sources[site[0]].span(name.start, name.end)
                else:
                    queue.append(site)

    def _definition(self, datum: Reference, number: Span) -> Reference | None:
        """The datum's own name before its first number."""
        text = self._texts[number.file]
        places = [
            one
            for one in references(datum.name, text[: number.start], self._wording)
            if one.meets(datum) and _ASSIGNED.match(text, one.end)
        ]
        return places[-1] if places else None

    def _named(self, watched: _Watched) -> Iterator[_Mention]:
        """Where a datum is used or given a value; declarations name it without using it."""
        datum, inside = watched.datum, watched.inside
        meant = self._meant(datum.name, watched.file, watched.at)
        for file in self._texts:
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

    def _mentions(self, datum: Reference, file: str) -> Iterator[_Mention]:
        text = self._texts[file]
        for one in references(datum.name, text, self._wording):
            if self._names_it(file, one):
                continue
            given = _ASSIGNED.match(text, one.end) is not None
            if given and _ARGUMENT.search(text, max(0, one.start - 80), one.start):
                continue  # the name of an argument
            sure = given and self._holds_all(one, datum, text)
            yield _Mention(file, one, given, sure)
        for unsaid in self._unsaid[file]:
            one, given = unsaid.datum, unsaid.said.given
            if one.name == datum.name:
                sure = given and unsaid.said.certain and one.path == datum.path[: len(one.path)]
                yield _Mention(file, one, given, sure)
            if unsaid.source is not None and unsaid.source.name == datum.name:
                yield _Mention(file, unsaid.source)

    @staticmethod
    def _holds_all(one: Reference, datum: Reference, text: str) -> bool:
        """Whether what is given a value is all of a datum, and known to be."""
        indices = len(_INDEX.findall(text, one.start, one.end))
        known = indices <= sum(isinstance(step, int) for step in one.path)
        return known and one.path == datum.path[: len(one.path)]

    def _names_it(self, file: str, one: Reference) -> bool:
        """Whether a place declares the name: in a routine's heading, or a declaration of any
        type."""
        text = self._texts[file]
        if any(routine.start <= one.start < routine.body for routine in self._routines[file]):
            return not _DEFAULT.search(text, 0, one.start)
        line = text[text.rfind("\n", 0, one.start) + 1 : one.start]
        bare = re.match(r"[\w$]+", text[one.start :])
        mentions = [*self._wording.mentions(line + ("" if bare is None else bare[0]))]
        return bool(mentions) and mentions[-1][1] is Mention.DECLARED

    def _meant(self, name: str, file: str, at: int) -> frozenset[tuple[str, int]]:
        """The declarations that a name at a place may mean; none if it is declared elsewhere."""
        module = self._wording.module(file)
        outside: list[tuple[str, int]] = []
        nearest: tuple[int, tuple[str, int]] | None = None
        for other, declared in self._declared.items():
            for found, place in declared:
                if self._wording.folded(found) != name:
                    continue
                routine = self._blocks.routine(other, place)
                if routine is None:
                    outside += [(other, place)] * (self._wording.module(other) == module)
                elif other == file and place <= at and routine.start <= at < routine.end:
                    size = routine.end - routine.start
                    if nearest is None or size <= nearest[0]:
                        nearest = (size, (other, place))
        return frozenset(outside if nearest is None else [nearest[1]])

    def _statement(self, file: str, one: Reference) -> tuple[int, int] | None:
        """The executed statement that a reference stands in, with all round an executed call."""
        line = self._sources[file].span(one.start, one.end).line
        around = (
            (start, end)
            for start, end in self._executed.get((file, line), ())
            if start <= one.start and one.end <= self._head_end(file, start, end)
        )
        return max(around, key=lambda found: found[1] - found[0], default=None)

    def _declaration(self, file: str, one: Reference) -> tuple[int, int] | None:
        """The declaration whose initial value a reference is part of, from its name on."""
        text = self._texts[file]
        start = max((at for _, at in self._declared[file] if at < one.start), default=None)
        if start is None:
            return None
        behind = start + reference_of(text[start : one.start], self._wording).end
        sign = _ASSIGNED.match(text, behind, one.start)
        if sign is None or re.search(r"[;\r\n]", text[behind : one.start]):
            return None
        return start, one.end

    def _head_end(self, file: str, start: int, end: int) -> int:
        """Where what is executed of a statement itself ends, if it holds others."""
        heads = self._wording.heads
        found = None if heads is None else heads.match(self._texts[file], start, end)
        return end if found is None else found.end()

    def _handed_on(
        self,
        file: str,
        statement: tuple[int, int],
        one: Reference,
        watched: _Watched | None = None,
    ) -> Iterator[_Watched]:
        """What an executed statement makes of a changed datum, or number, that it names."""
        text = self._texts[file]
        start = statement[0]
        for found in self._wording.name.finditer(text, start, one.start):
            target = reference_of(text[found.start() : one.start], self._wording)
            behind = found.start() + target.end
            alone = not _SIGN.search(text, start, found.start())
            if alone and (sign := _ASSIGNED.match(text, behind, one.start)):
                path = target.path
                if watched is not None and not text[sign.end() : one.start].strip():
                    # A copy: what has changed of it is what has changed of the other.
                    copied = _ENDS.match(text, one.end) is not None
                    path += watched.datum.path[len(one.path) :] if copied else ()
                made = replace(target, path=path, start=0, end=0)
                label = text[found.start() : behind].strip()
                yield _Watched(made, file, found.start(), label, (file, found.start()))
                yield from self._handed_back(file, target.name, found.start())
            if alone and self._wording.folded(found[0]).lower() == _RETURNS:
                yield from self._returned(file, found.start())
            for other, routine in self._called.get(target.name, ()):
                yield from self._parameters(other, routine, text[behind : one.start])
        for unsaid in self._unsaid[file]:
            said, source = unsaid.said, unsaid.source
            if not said.given or not said.start <= one.start < said.end:
                continue
            if source is None or (watched is not None and source.meets(watched.datum)):
                made = replace(unsaid.datum, start=0, end=0)
                yield _Watched(made, file, said.start, said.datum, (file, said.start))

    def _parameters(self, file: str, routine: RoutineText, before: str) -> Iterator[_Watched]:
        """The parameters that an argument behind ``before`` may be handed to."""
        wanted = _parameter_texts(routine)
        index = _arguments(before)
        for part in wanted[index : index + 1] or wanted:
            name = self._parameter_name(part)
            if name is not None:
                made = file, routine.body
                yield _Watched(Reference(name, ()), file, routine.start, name, made, routine)

    def _parameter_name(self, part: str) -> str | None:
        # Behind the name there may be dimensions, a direction or a default.
        names = self._wording.name.findall(re.split(r"[:=\[{]", part)[0])
        return self._wording.folded(names[-1]) if names else None

    def _returned(self, file: str, at: int) -> Iterator[_Watched]:
        """The function that gives the value of a return: to name it is to name that value."""
        routine = self._blocks.routine(file, at)
        if routine is not None:
            name = self._wording.folded(routine.name)
            yield _Watched(Reference(name, ()), file, routine.start, routine.name, (file, at))

    def _handed_back(self, file: str, name: str, at: int) -> Iterator[_Watched]:
        """What executed calls give to the parameter that an assignment is to."""
        routine = self._blocks.routine(file, at)
        if routine is None:
            return
        names = [self._parameter_name(part) for part in _parameter_texts(routine)]
        if name not in names:
            return
        index = names.index(name)
        for other, text in self._texts.items():
            for call in references(self._wording.folded(routine.name), text, self._wording):
                statement = self._statement(other, call)
                if statement is None:
                    continue
                arguments = _parts(_argument_text(text[call.end : statement[1]]))
                given = [part for part in arguments if part.strip()]
                for part in given[index : index + 1] or given:
                    found = self._wording.name.search(part)
                    if found is not None:
                        datum = reference_of(part[found.start() :], self._wording)
                        made = replace(datum, start=0, end=0)
                        place = other, call.start
                        yield _Watched(made, *place, found[0], place)


def _parameter_texts(routine: RoutineText) -> list[str]:
    return [part for part in _parts(routine.parameters) if part.strip()]


def _argument_text(behind: str) -> str:
    """What a call hands over, of the text behind the routine's name."""
    text = behind.lstrip(" \t")
    if not text.startswith("("):
        return re.split(r"[;\r\n]", text, maxsplit=1)[0]
    depth = 0
    for at, sign in enumerate(text):
        depth += (sign in _OPENING) - (sign in _CLOSING)
        if depth == 0:
            return text[1:at]
    return text[1:]


def _parts(text: str) -> list[str]:
    """A text at its commas and backslashes; brackets that are closed keep theirs."""
    cuts: list[int] = []
    opened: list[int] = []
    for at, sign in enumerate(text):
        if sign in _OPENING:
            opened.append(len(cuts))
        elif sign in _CLOSING and opened:
            del cuts[opened.pop() :]
        elif sign in ",\\":
            cuts.append(at)
    return [text[a + 1 : b] for a, b in pairwise([-1, *cuts, len(text)])]


def _arguments(text: str) -> int:
    """How many arguments end in a text that begins behind a routine's name."""
    count = depth = 0
    blank = True
    for sign in text.strip().removeprefix("("):
        depth += (sign in "([{") - (sign in ")]}")
        if depth == 0 and sign in ",\\":
            count += not blank
            blank = True
        else:
            blank = blank and sign.isspace()
    return count


def _executed(program: Program, reading: Reading) -> Mapping[tuple[str, int], set[tuple[int, int]]]:
    """Start and end of every executed statement, by file and line."""
    found: defaultdict[tuple[str, int], set[tuple[int, int]]] = defaultdict(set)

    def executed(span: Span) -> None:
        found[span.file, span.line].add((span.start, span.end))

    reading.read(reading.files, reading.main, replace(reading.options, executed=executed))
    for move in program.moves:
        if move.origin is not None:
            # All lines of a motion instruction, where of a block only the first one is executed.
            span = move.origin.statement
            for line in _lines(span, reading):
                found[span.file, line].add((span.start, span.end))
    return found


def _lines(span: Span, reading: Reading) -> range:
    text = reading.files[span.file].text[span.start : span.end]
    return range(span.line, span.line + len(lines_of(text)))
