"""Programs remember how they were read."""

from __future__ import annotations

import pytest

from flyby.core.errors import InputError, SourceError, Span
from flyby.core.program.move import Wait
from flyby.core.program.program import Program
from flyby.core.source.patch.edits import reading_of
from flyby.core.source.reading import Files, Reading, ReadOptions, read_with
from flyby.core.source.text.files import SourceFile


def read(files: Files, main: str, options: ReadOptions) -> Program:
    """A language of waits; "+" goes on with another file."""
    statements = []
    for word in files[main].text.split():
        if word in files:
            statements += read(files, word, options).statements
        else:
            try:
                statements.append(Wait(float(word)))
            except ValueError:
                raise SourceError(f"{word} is no number", Span(main, 1, 1, 0, 1)) from None
    return Program(tuple(statements), options.entry or main)


FILES = {"a": SourceFile("a", "1 b 3"), "b": SourceFile("b", "2")}


def durations(program: Program) -> list[float]:
    return [s.duration for s in program.statements if isinstance(s, Wait)]


def test_a_program_can_be_read_again_with_other_text() -> None:
    program = read_with(FILES, "a", ReadOptions(entry="go"), read)
    assert durations(program) == [1, 2, 3] and program.name == "go"
    reading = reading_of(program)
    assert reading == Reading(FILES, "a", ReadOptions(entry="go"), read)
    again = reading.again({"b": SourceFile("b", "7 8")})
    assert durations(again) == [1, 7, 8, 3] and again.name == "go"
    assert durations(reading.again({})) == [1, 2, 3]
    assert reading.files == FILES, "the reading itself does not change"


def test_the_files_are_those_of_the_moment() -> None:
    files = dict(FILES)
    program = read_with(files, "a", ReadOptions(), read)
    del files["b"]
    assert durations(reading_of(program).again({})) == [1, 2, 3]


def test_how_it_was_read_is_no_part_of_the_program() -> None:
    assert read_with(FILES, "a", ReadOptions(), read) == read(FILES, "a", ReadOptions())


def test_what_cannot_be_read_again_says_so() -> None:
    reading = reading_of(read_with(FILES, "a", ReadOptions(), read))
    with pytest.raises(SourceError, match="x is no number"):
        reading.again({"a": SourceFile("a", "x")})


def test_a_program_from_nowhere_has_no_reading() -> None:
    with pytest.raises(InputError, match="'job' was not read from source files"):
        reading_of(Program((), "job"))
