"""What a run has asked of the world, what was answered, and what was decided without an answer.

Without an answer waits are satisfied at once, and branches and loops are decided by rule (see
`flow`). What was decided so is noted with its line.
"""

from __future__ import annotations

from collections.abc import Collection, Iterator
from contextlib import contextmanager
from dataclasses import dataclass, field, replace
from typing import NamedTuple

from ...errors import InputError, Note, SourceError, Span
from ...program.cycle import Cycle
from ...program.question import Answer, Question, QuestionKind
from .answers import TABLES, Answers, Fields, key, placed, stands_at, stands_in
from .guard import Guard, Supposable
from .scopes import alike
from .sections import Sections
from .streams import Stream

STRUCTURE = "structure, with what is read of it here"
"""What an answer is of which no more is known than the components that are used."""
_LONGEST_KEY = 80
"""Characters of a statement that is a key as it stands."""
_MOST_COMPARED = 12
"""Values that are remembered of those with which something that was asked is compared."""
_ALIKE = 0.85
"""Share of its letters in which a name that was asked for is like one that nobody asked for."""

NOT_AT_HAND = "it is in no file at hand"
"""Why a routine cannot be carried out."""


class AnswerError(SourceError):
    """A user's answer is none to what the program asks."""


class About(NamedTuple):
    """What is known of something that a program asks.

    Args:
        span: where it is asked.
        kind: what it is.
        type: what an answer is, in words; empty if that is not known.
        example: an answer.
    """

    span: Span
    kind: QuestionKind = QuestionKind.SIGNAL
    type: str = ""
    example: Answer | None = None


@dataclass
class Course:
    """Decides what the text of a program leaves open, and remembers what was decided.

    Args:
        answers: what the user has to say.

    Attributes:
        turned: how often an answer in turn was another one than that before it.
        cycle: the last pass of a loop that production runs in; None if there is none.
        sections: which routines and loops have left which statements.
        supposed: what the data depend on that were read since the statement began and have the
            values of a way that was chosen by rule; empty if on nothing.
        guards: the ways out that were not taken, as nobody decides them.
    """

    answers: Answers = field(default_factory=Answers)
    turned: int = 0
    cycle: Cycle | None = None
    sections: Sections = field(default_factory=Sections)
    supposed: str = ""
    guards: list[Guard] = field(default_factory=list)
    _asked: set[tuple[str, str]] = field(default_factory=set)
    _turns: dict[str, int] = field(default_factory=dict)
    _decided: dict[tuple[str, int, str], tuple[Note, int]] = field(default_factory=dict)
    _questions: dict[tuple[str, str], Question] = field(default_factory=dict)
    _elements: dict[str, int] = field(default_factory=dict)

    def suppose(self, reason: str) -> None:
        """What is read now depends on a way that was chosen by rule; nothing if ``reason`` is
        empty."""
        self.supposed = self.supposed or reason

    def sets(self, datum: Supposable, whole: bool = True) -> None:
        """A datum, or a part of it, is given what the statement under way reads."""
        datum.supposed = (not whole and datum.supposed) or self.supposed
        for guard in self.guards:
            guard.written.append(datum)

    @contextmanager
    def apart(self) -> Iterator[None]:
        """What is read inside is nothing that the statement under way reads."""
        outer, self.supposed = self.supposed, ""
        try:
            yield
        finally:
            self.supposed = outer

    def value(self, text: str, about: About | None = None) -> Answer | None:
        """The answer to a name or call as it stands in the program; None if there is none.

        Args:
            text: of the name or call.
            about: what is known of it, if it is to be listed among the program's questions.
        """
        name = key(text)
        self._asked |= {("values", name), ("sequences", name)}
        turns = self.answers.sequences.get(name)
        told = self.answers.values.get(name) if turns is None else turns
        if about is not None and text:
            table = "values" if turns is None else "sequences"
            self._ask(
                Question(
                    about.kind,
                    table,
                    " ".join(text.split()),
                    about.span,
                    about.type,
                    told,
                    "not known",
                    about.example,
                    answered=told is not None,
                )
            )
        if turns is None:
            return told
        turn = self._turns.get(name, 0)
        self._turns[name] = turn + 1
        self.turned += turn < len(turns)
        return turns[min(turn, len(turns) - 1)]

    def lasting(self, text: str) -> Answer | None:
        """The answer to a name or call that stays so; None if there is none, or they come in
        turn."""
        name = key(text)
        if name in self.answers.values:
            self._asked.add(("values", name))
        return self.answers.values.get(name)

    def stated(self, text: str) -> float | None:
        """What the controller is known to say to a call; None if that is not known."""
        return self.answers.stated.get(key(text))

    def used_as(
        self, text: str, type_: str, example: Answer, instead: Collection[str] = ()
    ) -> None:
        """What was asked turns out to be of a type, as it is used so.

        Args:
            text: under which it was asked.
            type_: what an answer is, in words.
            example: an answer.
            instead: types that tell less than this one does.
        """
        place = "values", key(text)
        asked = self._questions.get(place)
        if asked is not None and (not asked.type or asked.type in instead):
            self._questions[place] = replace(asked, type=type_, example=example)

    def compared(self, text: str, answer: Answer) -> None:
        """What was asked is compared with what may be an answer."""
        place = "values", key(text)
        asked = self._questions.get(place)
        if asked is None or len(asked.compared) >= _MOST_COMPARED:
            return
        if not any(type(one) is type(answer) and one == answer for one in asked.compared):
            self._questions[place] = replace(asked, compared=(*asked.compared, answer))

    def used_with(self, text: str, component: str) -> None:
        """What was asked turns out to be a structure, as a component of it is used."""
        place = "values", key(text)
        asked = self._questions.get(place)
        if asked is None or asked.type not in ("", STRUCTURE):
            return
        fields = dict(asked.example) if isinstance(asked.example, Fields) else {}
        shown = Fields({**fields, component: fields.get(component, 1.0)}.items())
        self._questions[place] = replace(asked, type=STRUCTURE, example=shown)

    def element_read(self, text: str, count: int) -> None:
        """Of what was asked so many elements are there at least, as the last of them is read."""
        self._elements[key(text)] = max(count, self.elements(text))

    def elements(self, text: str) -> int:
        """How many elements of what was asked are known to be there; see `element_read`."""
        return self._elements.get(key(text), 0)

    def withdraw(self, text: str) -> None:
        """What was asked is known after all, and not listed."""
        self._questions.pop(("values", key(text)), None)

    def lists(self, text: str) -> bool:
        """Whether a name or call is among what was asked."""
        return ("values", key(text)) in self._questions

    def needless(self, text: str) -> None:
        """What was asked just now is needed for nothing but what is asked itself: an argument of
        a call. It is not listed, unless it was asked before."""
        place = "values", key(text)
        asked = self._questions.get(place)
        if asked is not None and asked.count == 1 and not asked.answered:
            del self._questions[place]

    def questions(self) -> tuple[Question, ...]:
        """What the program has asked, in the order in which it came up."""
        return tuple(self._questions.values())

    def pause(self, text: str, span: Span, listed: bool = True) -> float:
        """s that the user says the robot stands at a statement, 0 if nobody says it.

        Args:
            text: of the statement.
            span: of it.
            listed: whether it is listed among the program's questions, answered or not.
        """
        if not listed and not self.answers.durations:
            return 0.0
        found = [k for k in self.answers.durations if stands_at(k, text, span)]
        self._asked |= {("durations", k) for k in found}
        told = max((self.answers.durations[k] for k in found), default=0.0)
        if not listed and not found:
            return 0.0
        shown = " ".join(text.split()).rstrip(";")
        plain = len(shown) <= _LONGEST_KEY and stands_in(key(shown), text)
        name = shown if plain else f"{placed(span.file).rpartition('/')[2]}:{span.line}"
        self._ask(
            Question(QuestionKind.PAUSE, "durations", name, span, "s", told, answered=bool(found))
        )
        return told

    def sent(self, name: str, span: Span) -> None:
        """A computer sends the motion at a statement; listed among the program's questions.

        Args:
            name: of the function or instruction that takes it.
            span: of the statement.
        """
        told = any(
            stands_at(k, name, span) or stands_in(key(name), k) for k in self.answers.streams
        )
        self._ask(
            Question(
                QuestionKind.STREAM,
                "streams",
                name,
                span,
                "file",
                meanwhile="the robot is taken to stay where it is",
                example="joints.csv",
                answered=told,
            )
        )

    def stream(self, text: str, span: Span) -> Stream | None:
        """What is sent to the robot at a statement, if the user says it and it was not yet sent."""
        for name, stream in self.answers.streams.items():
            if ("streams", name) not in self._asked and stands_at(name, text, span):
                self._asked.add(("streams", name))
                return stream
        return None

    def _ask(self, question: Question) -> None:
        """Remember a question; what has several answers meanwhile has none that can be stated."""
        place = question.table, key(question.key)
        before = self._questions.get(place)
        if before is None:
            self._questions[place] = question
            return
        same = before.taken == question.taken
        if not before.type and question.type:
            before = replace(
                before, kind=question.kind, type=question.type, example=question.example
            )
        self._questions[place] = replace(
            before,
            count=before.count + 1,
            taken=before.taken if same else None,
            meanwhile=before.meanwhile if same else f"{before.meanwhile}; not always alike",
        )

    def changing(self, text: str) -> bool:
        """Whether a name or call has one answer after the other."""
        self._asked.add(("sequences", key(text)))
        return key(text) in self.answers.sequences

    def skips(self, routine: str, span: Span, why: str = NOT_AT_HAND) -> bool:
        """Whether a routine that is not carried out is stepped over, as the user or a rule says.

        Args:
            routine: its name.
            span: of the call.
            why: it cannot.
        """
        self._asked.add(("calls", key(routine)))
        told = key(routine) in self.answers.skipped
        skipped = told or self.answers.goes_on
        if told:
            self._routine(routine, span, answered=True)
        elif skipped:
            message = f"{routine} is stepped over, as if it moved nothing: {why}"
            self.stepped_over(routine, span, message)
        return skipped

    def stepped_over(self, routine: str, span: Span, message: str) -> None:
        """A routine is stepped over by rule; the message says why."""
        self._routine(routine, span, answered=False)
        self.decided(span, message)

    def _routine(self, routine: str, span: Span, answered: bool) -> None:
        kind = QuestionKind.ROUTINE
        self._ask(Question(kind, "calls", routine, span, "", "skip", answered=answered))

    def answered_branch(self, span: Span, count: int) -> int | None:
        """The branch that the user says is taken at a place: from 1, 0 for none of them.

        Args:
            span: of the condition.
            count: of the branches.

        Raises:
            InputError: there is no such branch.
        """
        answer = self._at("branches", span)
        if answer is not None and answer > count:
            there = "there is 1 branch" if count == 1 else f"there are {count} branches"
            raise InputError(
                f"{self.answers.file}: [branches] at {span.file}:{span.line}: {there}, not {answer}"
            )
        return answer

    def answered_passes(self, span: Span) -> int | None:
        """How often the user says that the loop at a place runs."""
        return self._at("passes", span)

    def passes(
        self, span: Span, reason: str, moving: bool, driven: int = 0, leaves: bool = False
    ) -> int:
        """How often a loop runs of which nobody knows when it ends.

        Args:
            span: of the condition.
            reason: what it depends on.
            moving: whether its body moves the robot.
            driven: passes that have been read before that was met.
            leaves: whether it ends by a way out in its body, which follows the passes; then it has
                been entered, and one at least is read.
        """
        answer = self.answered_passes(span)
        passes = max(driven, 1) if moving or leaves else 0
        told = passes if answer is None else answer
        self._at_place(QuestionKind.LOOP, "passes", span, told, reason, answer is not None)
        if answer is not None:
            return max(answer, 1) if leaves else answer
        how = "it does not move the robot and is left at once"
        if passes:
            how = f"its body runs {'once' if passes == 1 else f'{passes} times'}"
        if leaves:
            how += ", and then this way out is taken"
        self.decided(span, f"the end of the loop depends on {reason}: {how}")
        return passes

    def notes(self) -> tuple[Note, ...]:
        """What was decided without an answer, in the order in which it came up.

        Then which answers nothing asked for: their names or lines may be mistyped.
        """
        told = [
            replace(note, message=note.message + (f" ({count} times)" if count > 1 else ""))
            for note, count in self._decided.values()
        ]
        unasked = [
            f"{name} in [{table}]{self._meant(table, name)}"
            for table in TABLES
            for name in self.answers.names(table)
            if (table, name) not in self._asked
        ]
        if unasked:
            told.append(
                Note(
                    f"{self.answers.file or 'answers'}: the program, as far as it ran, did not ask "
                    f"for {', '.join(unasked)}"
                )
            )
        return tuple(told)

    def _meant(self, table: str, name: str) -> str:
        """What is asked for and not answered, if that is a name which is nearly written so."""
        asked = self._questions.items() if table == "values" else ()
        known = {key: one.key for (of, key), one in asked if of == table and not one.answered}
        near = alike(name, tuple(known), 1, _ALIKE)
        return f" (did you mean {known[near[0]]}?)" if near else ""

    def _at(self, table: str, span: Span) -> int | None:
        """The entry for a place."""
        file = placed(span.file)
        for name in (file, file.rpartition("/")[2]):
            self._asked.add((table, f"{name}:{span.line}"))
        return self.answers.at(table, f"{file}:{span.line}")

    @property
    def guessed(self) -> bool:
        """Whether anything was decided without an answer."""
        return bool(self._decided)

    def branch(self, span: Span, reason: str, taken: int, count: int, answered: bool) -> None:
        """A branch is taken on a condition that is not known.

        Args:
            span: of the condition.
            reason: what it depends on.
            taken: its number, 0 for none.
            count: of the branches.
            answered: whether the user said so.
        """
        self._at_place(QuestionKind.BRANCH, "branches", span, taken, reason, answered, count)

    def _at_place(
        self,
        kind: QuestionKind,
        table: str,
        span: Span,
        taken: int,
        reason: str,
        answered: bool,
        count: int | None = None,
    ) -> None:
        place = f"{span.file.replace(chr(92), '/').rpartition('/')[2]}:{span.line}"
        range_ = f"0 to {count}" if count is not None else "0 or more"
        about = f"depends on {reason}"
        self._ask(Question(kind, table, place, span, range_, taken, about, answered=answered))

    def decided(self, span: Span, message: str, listed: bool = True) -> None:
        """Note what was decided without an answer; how often is counted.

        Args:
            span: where.
            message: what.
            listed: whether the program's questions say it as well.
        """
        place = (span.file, span.start, message)
        note, count = self._decided.get(place, (Note(message, span=span, asked=listed), 0))
        self._decided[place] = note, count + 1
