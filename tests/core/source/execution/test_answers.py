"""Answers from a file, and what is decided without one."""

from __future__ import annotations

from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

from flyby.core.errors import InputError, Span, UnknownNameError
from flyby.core.source.execution.answers import Answers, key
from flyby.core.source.execution.answers_file import load_answers
from flyby.core.source.execution.course import About, Course


def span(line: int = 1, file: str = "cell/main.mod") -> Span:
    return Span(file, line, 1, 10 * line, 10 * line + 5)


def saved(folder: Path, text: str) -> Path:
    path = folder / "answers.toml"
    path.write_text(text, "utf-8")
    return path


def test_a_file_of_answers_is_read(tmp_path: Path) -> None:
    text = """
        [values]
        di_Part = true
        "$IN[ 3 ]" = false
        count = 2
        place = [[350, 20.5], ["a"]]
        [sequences]
        "get_digital_in(1)" = [false, true]
        [branches]
        "Main.mod:12" = 1
        [passes]
        "cell\\\\Main.mod:20" = 3
        [calls]
        "rGripper Open" = "skip"
    """.replace("\\\\", "\\\\")
    answers = load_answers(saved(tmp_path, text))
    assert answers.values == {
        "di_part": True,
        "$in[3]": False,
        "count": 2.0,
        "place": ((350.0, 20.5), ("a",)),
    }
    assert answers.sequences == {"get_digital_in(1)": (False, True)}
    course = Course(answers)
    assert course.answered_branch(span(12), 2) == 1
    assert course.passes(span(20), "x", False) == 3
    assert course.skips("RGRIPPEROPEN", span()) and not course.skips("rGripper", span())
    assert [course.value(one) for one in ("DI_PART", "get_digital_in(1)")] == [True, False]
    (unasked,) = course.notes()
    assert unasked.message == (
        f"{tmp_path / 'answers.toml'}: the program, as far as it ran, did not ask for $in[3] in "
        "[values], count in [values], place in [values]"
    )
    course.value("diCount", About(span(30)))
    course.value("Counts", About(span(31)))
    (unasked,) = course.notes()
    assert "count in [values] (did you mean Counts?), place in [values]" in unasked.message
    assert "diCount" not in unasked.message
    for one in ("$IN[3]", "Count", "place"):
        course.value(one)
    assert course.notes() == ()


@pytest.mark.parametrize(
    ("text", "named"),
    [
        ("[value]", "did you mean 'values'"),
        ("values = 1", "is a table"),
        ("[values]\na = 1979-05-27", "a is true or false"),
        ("[values]\na = {b = 1979-05-27}", "a is true or false"),
        ("[values]\na = nan", "a is too large, or no number"),
        ("[values]\na = inf", "a is too large"),
        (f"[values]\na = {10**400}", "integer of more than 64 bits"),
        ("[values]\na = " + "9" * 10_000, "more than 64 bits"),
        ("[values]\na = " + "[" * 10_000, "nested more than 30 deep"),
        ("[sequences]\na = []", "a in .sequences. is a list"),
        ("[sequences]\na = 1", "a in .sequences. is a list"),
        ('[branches]\n"a:1" = true', "whole number"),
        ('[branches]\n"a:1" = -1', "whole number"),
        ('[passes]\n"a:1" = 10001', "whole number"),
        ("[passes]\na = 1", "is no place"),
        ("[calls]\na = true", "a in .calls. is"),
        ("[values", "is not TOML"),
    ],
)
def test_a_wrong_file_is_refused_with_its_name(tmp_path: Path, text: str, named: str) -> None:
    with pytest.raises(InputError, match=named) as caught:
        load_answers(saved(tmp_path, text))
    assert "answers.toml" in str(caught.value)


def test_what_is_no_text_file_is_refused(tmp_path: Path) -> None:
    with pytest.raises(InputError, match="cannot be read"):
        load_answers(tmp_path / "absent.toml")
    (tmp_path / "bytes.toml").write_bytes(b"\xff\xfe\x00")
    with pytest.raises(InputError, match="no UTF-8 text"):
        load_answers(tmp_path / "bytes.toml")
    assert issubclass(UnknownNameError, InputError)


@given(st.text())
def test_blanks_and_case_of_a_name_do_not_count(text: str) -> None:
    assert key(" ".join(text)) == key(text)
    assert key(key(text)) == key(text)


@given(st.lists(st.floats(allow_nan=False), min_size=1, max_size=5), st.integers(1, 12))
def test_sequences_answer_in_turn_and_stay_with_the_last(turn: list[float], asked: int) -> None:
    course = Course(Answers({"x": 7.0}, {"x": tuple(turn)}))
    found = [course.value(" X ") for _ in range(asked)]
    assert found == [turn[min(k, len(turn) - 1)] for k in range(asked)]
    assert course.value("y") is None


@given(st.booleans(), st.integers(1, 5))
def test_loops_run_once_if_they_move(moving: bool, asked: int) -> None:
    course = Course()
    assert [course.passes(span(), "di1", moving) for _ in range(asked)] == [int(moving)] * asked
    (note,) = course.notes()
    assert (f"({asked} times)" in note.message) == (asked > 1)


def test_every_place_is_noted_in_the_order_of_asking() -> None:
    course = Course()
    for line in (3, 1, 3, 2):
        course.decided(span(line), "di1 is not known")
    assert [note.span.line for note in course.notes() if note.span] == [3, 1, 2]


def test_a_branch_that_there_is_not_is_refused() -> None:
    course = Course(Answers(branches={"main.mod:1": 3}, file="a.toml"))
    with pytest.raises(InputError, match=r"a\.toml.*main\.mod:1.*2 branches, not 3"):
        course.answered_branch(span(), 2)


@pytest.mark.parametrize("file", ["main.mod", "cell/main.mod", "cell\\Main.MOD", "/x/y/main.mod"])
def test_places_are_found_by_path_or_by_name(file: str) -> None:
    course = Course(Answers(passes={"main.mod:4": 5}))
    assert course.passes(span(4, file), "di1", False) == 5
    assert course.passes(span(5, file), "di1", False) == 0
