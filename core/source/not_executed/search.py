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
from collections.abc import Collection, Iterator, Sequence
from dataclasses import dataclass, replace

from ...dialect import RoutineText, Wording
from ...errors import Span
from ...program.program import Program
from ..patch.edits import reading_of
from ..patch.insertions import Inserted, changes_of
from ..reading import Reading
from ..text.references import Reference, reference_of, references
from .arguments import argument_text, count_arguments, parameter_texts, parts
from .changes import ChangedNumber, changed_numbers, changed_statements
from .mentions import ASSIGNED, Key, Mentioned, ProgramText, Watched
from .renewal import Place

_SIGN = re.compile(r"[^\w\s]")
_RETURNS = "return"
"""What all languages call it when a function gives its value."""
_ENDS = re.compile(r"[ \t]*(?:;|$)", re.MULTILINE)


@dataclass(frozen=True, slots=True)
class NotExecuted:
    """A datum that changes, and where code uses it that was not driven.

    Args:
        datum: its name.
        move: index of the first move that it changes for.
        places: in the text.
    """

    datum: str
    move: int
    places: tuple[Span, ...]


def not_executed(before: Program, after: Program, wording: Wording) -> tuple[NotExecuted, ...]:
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
    numbers = changed_numbers(before, after)
    inserted, _ = changes_of(before, after)
    statements = changed_statements(before, after)
    if not numbers and not inserted and not statements:
        return ()
    watch = _Watch(before, reading_of(before), wording)
    put_in = [*watch.put_in(inserted)]
    groups: dict[object, tuple[int, list[Watched]]] = {}
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
        NotExecuted(datum, move, tuple(dict.fromkeys(places)))
        for datum, (move, places) in found.items()
        if places
    )


class _Watch:
    """Looks for changed data in the files of a program.

    Args:
        program: as its reader made it.
        reading: its files.
        wording: how they are searched.
    """

    def __init__(self, program: Program, reading: Reading, wording: Wording) -> None:
        self._text = text = ProgramText(program, reading, wording)
        self._called: defaultdict[str, list[tuple[str, RoutineText]]] = defaultdict(list)
        for name, routines in text.routines.items():
            for one in routines:
                self._called[wording.folded(one.name)].append((name, one))
        self._back: list[tuple[Reference, Place]] = []

    def begun(self, number: ChangedNumber) -> Iterator[Watched]:
        """The data that a changed number is the value of."""
        span = number.span
        if number.datum is not None:
            datum = reference_of(number.datum, self._text.wording)
            own = self._text.definition(datum, span)
            at = span.start if own is None else own.start
            yield Watched(datum, span.file, at, number.datum, (span.file, at))
            return
        place = Reference("", (), span.start, span.end)
        statement = self._text.statement(span.file, place)
        if statement is not None:
            yield from self._handed_on(span.file, statement, place)
        else:
            yield from self._default(span)

    def _default(self, number: Span) -> Iterator[Watched]:
        """The parameter whose default a number in a routine's heading is."""
        text = self._text.texts[number.file]
        for one in self._text.routines[number.file]:
            if one.start <= number.start < one.body:
                names = [*self._text.wording.name.finditer(text, one.start, number.start)]
                datum = Reference(self._text.wording.folded(names[-1][0]), ())
                made = number.file, one.body
                yield Watched(datum, number.file, one.start, names[-1][0], made, one)

    def put_in(self, inserted: Sequence[Inserted]) -> Iterator[Watched]:
        """What lines that are put in give another value than it had; to be asked first."""
        for one in inserted:
            text = self._text.wording.quiet(one.text)
            for found in self._text.wording.name.finditer(text):
                datum = reference_of(text[found.start() :], self._text.wording)
                behind = found.start() + datum.end
                if not ASSIGNED.match(text, behind):
                    continue
                label = text[found.start() : behind]
                watched = Watched(datum, one.file, one.at, label, (one.file, one.at))
                if self._is_back(watched, text[behind:]):
                    self._back.append((datum, (one.file, one.at)))
                else:
                    yield watched
                break

    def _is_back(self, watched: Watched, value: str) -> bool:
        """Whether a line that is put in says again what the text has said before it."""
        file, text = watched.file, self._text.texts[watched.file]
        routine = self._text.blocks.routine(file, watched.at)
        said = [
            one.reference
            for one in self._text.named(watched)
            if one.given
            and one.file == file
            and one.reference.start < watched.at
            and self._text.blocks.routine(file, one.reference.start) == routine
        ]
        if not said:
            return False
        last = max(said, key=lambda one: one.start)
        end = text.find("\n", last.end)
        line = text[last.end : len(text) if end < 0 else end]
        return line.strip() == value.strip() and self._text.blocks.renewed(
            (file, watched.at), [(file, last.start)], []
        )

    def places(self, started: Sequence[Watched]) -> Iterator[Span]:
        """Where code uses a datum, or what is made of it, that was not executed.

        Args:
            started: the datum, for every place where it gets a changed value.
        """
        queue = [*started]
        made: defaultdict[Key, set[Place]] = defaultdict(set)
        seen: dict[Key, list[Mentioned]] = {}
        while queue:
            watched = queue.pop()
            made[watched.key].add(watched.made)
            if watched.key in seen:
                continue
            named = [*self._text.named(watched)]
            seen[watched.key] = named
            for one in named:
                statement = self._text.statement(one.file, one.reference)
                statement = statement or self._text.declaration(one.file, one.reference)
                if statement is not None and not one.given:
                    queue += self._handed_on(one.file, statement, one.reference, watched)
        for key, named in seen.items():
            given = {(one.file, one.reference.start) for one in named if one.renews}
            given |= {at for one, at in self._back if (one.name, one.path) == key[:2]}
            sure = given - made[key], made[key]
            for one in named:
                at = one.file, one.reference.start
                declared = self._text.declaration(one.file, one.reference) is not None
                if one.given or declared or self._text.blocks.renewed(at, *sure):
                    continue
                if self._text.statement(one.file, one.reference) is None:
                    yield self._text.sources[one.file].span(one.reference.start, one.reference.end)
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
            routine = self._text.blocks.routine(file, offset)
            if routine is None or (file, routine.start) in seen:
                continue
            seen.add((file, routine.start))
            own = any(f == file and routine.start <= one < routine.end for f, one in changed)
            for site in self._text.blocks.sites[self._text.wording.folded(routine.name)]:
                if not own and self._text.blocks.renewed(site, given, changed):
                    continue
                name = Reference("", (), site[1], site[1] + len(routine.name))
                if self._text.statement(site[0], name) is None:
                    yield self._text.sources[site[0]].span(name.start, name.end)
                else:
                    queue.append(site)

    def _handed_on(
        self,
        file: str,
        statement: tuple[int, int],
        one: Reference,
        watched: Watched | None = None,
    ) -> Iterator[Watched]:
        """What an executed statement makes of a changed datum, or number, that it names."""
        text = self._text.texts[file]
        start = statement[0]
        for found in self._text.wording.name.finditer(text, start, one.start):
            target = reference_of(text[found.start() : one.start], self._text.wording)
            behind = found.start() + target.end
            alone = not _SIGN.search(text, start, found.start())
            if alone and (sign := ASSIGNED.match(text, behind, one.start)):
                path = target.path
                if watched is not None and not text[sign.end() : one.start].strip():
                    # A copy: what has changed of it is what has changed of the other.
                    copied = _ENDS.match(text, one.end) is not None
                    path += watched.datum.path[len(one.path) :] if copied else ()
                made = replace(target, path=path, start=0, end=0)
                label = text[found.start() : behind].strip()
                yield Watched(made, file, found.start(), label, (file, found.start()))
                yield from self._handed_back(file, target.name, found.start())
            if alone and self._text.wording.folded(found[0]).lower() == _RETURNS:
                yield from self._returned(file, found.start())
            for other, routine in self._called.get(target.name, ()):
                yield from self._parameters(other, routine, text[behind : one.start])
        for unsaid in self._text.unsaid[file]:
            said, source = unsaid.said, unsaid.source
            if not said.given or not said.start <= one.start < said.end:
                continue
            if source is None or (watched is not None and source.meets(watched.datum)):
                made = replace(unsaid.datum, start=0, end=0)
                yield Watched(made, file, said.start, said.datum, (file, said.start))

    def _parameters(self, file: str, routine: RoutineText, before: str) -> Iterator[Watched]:
        """The parameters that an argument behind ``before`` may be handed to."""
        wanted = parameter_texts(routine)
        index = count_arguments(before)
        for part in wanted[index : index + 1] or wanted:
            name = self._parameter_name(part)
            if name is not None:
                made = file, routine.body
                yield Watched(Reference(name, ()), file, routine.start, name, made, routine)

    def _parameter_name(self, part: str) -> str | None:
        # Behind the name there may be dimensions, a direction or a default.
        names = self._text.wording.name.findall(re.split(r"[:=\[{]", part)[0])
        return self._text.wording.folded(names[-1]) if names else None

    def _returned(self, file: str, at: int) -> Iterator[Watched]:
        """The function that gives the value of a return: to name it is to name that value."""
        routine = self._text.blocks.routine(file, at)
        if routine is not None:
            name = self._text.wording.folded(routine.name)
            yield Watched(Reference(name, ()), file, routine.start, routine.name, (file, at))

    def _handed_back(self, file: str, name: str, at: int) -> Iterator[Watched]:
        """What executed calls give to the parameter that an assignment is to."""
        routine = self._text.blocks.routine(file, at)
        if routine is None:
            return
        names = [self._parameter_name(part) for part in parameter_texts(routine)]
        if name not in names:
            return
        index = names.index(name)
        for other, text in self._text.texts.items():
            for call in references(
                self._text.wording.folded(routine.name), text, self._text.wording
            ):
                statement = self._text.statement(other, call)
                if statement is None:
                    continue
                arguments = parts(argument_text(text[call.end : statement[1]]))
                given = [part for part in arguments if part.strip()]
                for part in given[index : index + 1] or given:
                    found = self._text.wording.name.search(part)
                    if found is not None:
                        datum = reference_of(part[found.start() :], self._text.wording)
                        made = replace(datum, start=0, end=0)
                        place = other, call.start
                        yield Watched(made, *place, found[0], place)
