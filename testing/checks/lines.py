"""Checks of golden texts of lines: each form, each spelling and each part of a line counts."""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping, Sequence
from copy import copy
from dataclasses import replace
from typing import Any

import pytest

from ...core.errors import FlybyError
from ...core.language import Reader
from ...core.source.lines.driving import MotionGrammar
from ...core.source.lines.expressions import Spelling
from ...core.source.lines.forms import Form, FormGrammar, Found
from ...core.source.lines.language import LineLanguage
from ...core.source.lines.program import Said
from ...core.source.lines.settings import Setting
from ...core.source.lines.statements import Line
from ..golden import GoldenText, differences
from .subject import Subject
from .telling import told

_OPPOSITE = {
    **{"=": "<>", "<>": "=", "<": ">=", ">=": "<", ">": "<=", "<=": ">"},
    **{"AND": "OR", "OR": "AND", "DIV": "MOD", "MOD": "DIV", "+": "-", "-": "+", "*": "/"},
}
"""What a sign or word is taken for, so that it matters which one it is."""
_NUMBERED = re.compile(r"\W?[^\W\d]*\W*\d\W?")
"""A number of one digit, or what is called by one."""
_PARSED = frozenset({"arguments", "first", "last", "step", "time", "value"})
"""Groups whose numbers are read as expressions, of any length."""
_OPENED = re.compile(r"\((?:\?(?:P<\w+>|P=\w+|<?[=!]|[:>#]))?")
"""A bracket of a pattern."""
_IN_BRACKETS = re.compile(r"\[\^?\]?(?:\\.|[^\]\\])*\]")
"""Signs of which one stands there."""


class LineChecks(Subject):
    """What a language of lines has stands in its golden texts."""

    def test_every_form_of_line_counts_in_a_golden_text(self) -> None:
        """Without each form, each alternative of one and of `driving`, each sign, each setting, and
        with something else where nothing is said, a golden text is read otherwise than its author
        says, or what is to be refused is not."""
        language = self._language
        every = (*self.golden_texts, *self.golden_refused)
        texts = [text for text in every if self._means(language, text)]
        unseen = []
        for name, grammar in _without_each(language.grammar):
            other = copy(language)
            other.grammar = grammar
            if all(self._means(other, text) for text in texts):
                unseen += [] if name in unseen else [name]
        assert not unseen, told(
            f"{self.name}: no golden text is read otherwise without {', '.join(unseen)}",
            look="the golden file: add lines of these forms, and what they mean; a move at which "
            "nothing is said, and its speed and zone; of `driving` a text in [[refused]]",
        )

    def _means(self, language: Reader, text: GoldenText) -> bool:
        """Whether a language reads a golden text, or refuses it, as its author says."""
        suite = copy(self)
        suite.__dict__["vendor"] = replace(self.vendor, reader=language)
        try:
            statements = suite.read_files(text).statements
        except FlybyError as error:
            return bool(text.says) and text.says.lower() in str(error).lower()
        if text.says or len(statements) != len(text.statements):
            return False
        return not any(
            differences(stated, statement, self.signals)
            for stated, statement in zip(text.statements, statements, strict=True)
        )

    def test_each_part_of_a_golden_line_is_asked_for(self) -> None:
        """What a named group holds is looked at by the method of the form: the speed that a line
        states is driven, or refused."""
        passed = {
            f"{group} ({found.held[group]}) of {line}"
            for _, line, found in self._found()
            for group in found.left
        }
        assert not passed, told(
            f"{self.name}: parts of lines that a form has groups for are looked at by nobody",
            lines=sorted(passed),
            look="the methods of these forms: use what a group holds, refuse what contradicts, or "
            "let the pattern have no name for it",
        )

    def test_golden_texts_have_numbers_of_two_digits(self) -> None:
        """A tool, a frame, a label whose number is read by its first digit is another one."""
        seen: dict[str, list[str]] = {}
        for name, _, found in self._found():
            for group in sorted(found.read):
                said = found.held[group]
                if said and _takes_two_digits(found.held, group):
                    seen.setdefault(f"{group} of the form {name}", []).append(said)
        short = [name for name, every in seen.items() if all(map(_NUMBERED.fullmatch, every))]
        assert not short, told(
            f"{self.name}: no golden text has a number of two digits for {', '.join(short)}",
            look="the golden file: call tools, frames, points and labels by numbers like 12, too",
        )

    @property
    def _language(self) -> LineLanguage:
        language = self.vendor.reader
        if self.golden is None or not isinstance(language, LineLanguage):
            pytest.skip(f"{self.name} has no golden texts, or no forms of lines")
        return language

    def _found(self) -> list[tuple[str, str, _Asked]]:
        """The form, the line and what is found in it, of all lines of the golden texts."""
        made: list[tuple[str, str, _Asked]] = []

        class Asking(self._language.grammar):  # type: ignore[name-defined, misc]
            def _said(self, name: str, form: Form, line: Line, found: Found) -> Said:
                asked: Any = _Asked(found)
                made.append((name, line.text, asked))
                said: Said = super()._said(name, form, line, asked)
                return said

        language = copy(self._language)
        language.grammar = Asking
        suite = copy(self)
        suite.__dict__["vendor"] = replace(self.vendor, reader=language)
        for text in self.golden_texts:
            suite.read_golden(text)
        return made


def _without_each(
    grammar: type[MotionGrammar],
) -> Iterator[tuple[str, type[MotionGrammar]]]:
    """The grammar, each of whose forms and settings in turn the lines do not say, or of which
    something else holds where nothing is said."""

    def other(**parts: object) -> type[MotionGrammar]:
        return type("Grammar", (grammar,), parts)

    def silent(name: str) -> str:
        return f"nothing.{name}"

    for name, pattern in grammar.forms.items():
        if name.partition(".")[0] not in ("nothing", "routine"):
            forms = {silent(k) if k == name else k: v for k, v in grammar.forms.items()}
            yield f"the form {name}", other(forms=forms)
            for word, narrowed in _alternatives(pattern):
                yield f"{word!r} of the form {name}", other(forms={**grammar.forms, name: narrowed})
    if grammar.driving.pattern != FormGrammar.driving.pattern:
        yield "`driving`", other(driving=FormGrammar.driving)
        for word, narrowed in _alternatives(grammar.driving.pattern):
            driving = re.compile(narrowed, grammar.driving.flags)
            yield f"{word!r} of `driving`", other(driving=driving)
    for name, spelling in _spelt_otherwise(grammar.spelling):
        yield name, other(spelling=spelling)
    for one in grammar.settings:
        rest = tuple(setting for setting in grammar.settings if setting is not one)
        held = replace(grammar.settings, settings=rest)
        forms = {silent(one.word): one.pattern.pattern.replace("(?P<", "(?P<_"), **grammar.forms}
        yield f"the setting {one.word}", other(forms=forms, settings=held)
        for name, changed in _said_otherwise(one):
            every = (changed if setting is one else setting for setting in grammar.settings)
            held = replace(grammar.settings, settings=tuple(every))
            yield f"{name} of the setting {one.word}", other(settings=held)


def _said_otherwise(setting: Setting) -> Iterator[tuple[str, Setting]]:
    """A setting of which something else holds where a program, or a line, says nothing."""

    def moved(numbers: Sequence[float]) -> tuple[float, ...]:
        return tuple(number / 2 if number else 1.0 for number in numbers)

    first = setting.initial
    if first is not None:
        several = moved(first if isinstance(first, Sequence) else [first])
        yield "`initial`", replace(setting, initial=several)
    if setting.omitted:
        yield "`omitted`", replace(setting, omitted=moved(setting.omitted))
    if setting.always is not None:
        yield "`always`", replace(setting, always=None)
    for word, numbers in setting.words.items():
        yield f"the word {word!r}", replace(setting, words={**setting.words, word: moved(numbers)})


def _spelt_otherwise(spelling: Spelling) -> Iterator[tuple[str, Spelling]]:
    """A spelling whose signs and truths mean something else, or that knows fewer data."""
    for sign, usual in spelling.signs.items():
        others = {**spelling.signs, sign: _OPPOSITE.get(usual, sign)}
        yield f"the sign {sign!r}", replace(spelling, signs=others)
    for word, truth in spelling.truths.items():
        if spelling.truths != Spelling().truths:
            yield (
                f"the word {word!r}",
                replace(spelling, truths={**spelling.truths, word: not truth}),
            )
    if spelling.datum is not None:
        for one, narrowed in _alternatives(spelling.datum.pattern):
            datum = re.compile(narrowed, spelling.datum.flags)
            yield f"{one!r} of `Spelling.datum`", replace(spelling, datum=datum)


def _alternatives(pattern: str) -> Iterator[tuple[str, str]]:
    """Each alternative of a pattern, and the pattern in which nothing fits it."""
    at, opened = 0, [[0]]
    every: list[list[int]] = []
    while at < len(pattern):
        if pattern[at] == "\\":
            at += 2
            continue
        if found := _IN_BRACKETS.match(pattern, at):
            at = found.end()
            continue
        if found := _OPENED.match(pattern, at):
            at = found.end()
            opened.append([at])
            continue
        if pattern[at] == "|":
            opened[-1] += at, at + 1
        elif pattern[at] == ")":
            every.append([*opened.pop(), at])
        at += 1
    for ends in (*every, [*opened[0], at]):
        for start, end in zip(ends[::2], ends[1::2], strict=True):
            if len(ends) > 2:
                yield pattern[start:end], f"{pattern[:start]}(?!){pattern[start:]}"


def _takes_two_digits(found: Found, group: str) -> bool:
    """Whether a number of one digit in a group might have two."""
    said, text = found[group], found.string
    if said.isdecimal() and group in _PARSED:
        return False
    if not _NUMBERED.fullmatch(said):
        return True
    start, end = found.span(group)
    longer = re.sub(r"\d", "12", said)
    line = text[found.start() : start] + longer + text[end : found.end()]
    other = found.re.fullmatch(line)
    return other is not None and other[group] == longer


class _Asked:
    """What a form has found in a line, that knows for which of its groups nobody has asked."""

    def __init__(self, held: Found) -> None:
        self.held = held
        self.re = held.re
        self.read = set[str]()  # whose text, and not only where it stands
        self.left = {group for group, said in held.groupdict().items() if (said or "").strip()}

    def __getitem__(self, group: str) -> str | Any:
        self.left.discard(group)
        self.read.add(group)
        return self.held[group]

    def group(self, *groups: str) -> Any:
        found = tuple(self[group] for group in groups)
        return found if len(found) > 1 else found[0]

    def groupdict(self) -> Mapping[str, str | Any]:
        return _Groups(self)

    def span(self, group: str | int = 0) -> tuple[int, int]:
        self.left.discard(str(group))
        return self.held.span(group)

    def start(self, group: str | int = 0) -> int:
        return self.span(group)[0]

    def end(self, group: str | int = 0) -> int:
        return self.span(group)[1]


class _Groups(Mapping[str, Any]):
    def __init__(self, found: _Asked) -> None:
        self._found = found

    def __getitem__(self, group: str) -> Any:
        if group not in self._found.re.groupindex:
            raise KeyError(group)
        return self._found[group]

    def __iter__(self) -> Iterator[str]:
        return iter(self._found.re.groupindex)

    def __len__(self) -> int:
        return len(self._found.re.groupindex)
