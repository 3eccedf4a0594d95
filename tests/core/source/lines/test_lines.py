"""Programs of lines: blocks, registers of several numbers, arguments, files."""

from __future__ import annotations

import re
from collections.abc import Mapping
from dataclasses import replace
from pathlib import Path
from types import MappingProxyType

import pytest
from hypothesis import given
from hypothesis import strategies as st

from flyby.core.errors import InputError, SourceError
from flyby.core.program.move import Move, MoveJ, Opaque, Wait
from flyby.core.program.program import Program
from flyby.core.program.speed import Speed
from flyby.core.program.target import JointTarget
from flyby.core.source.lines.expressions import Datum, Number, Truth, parse
from flyby.core.source.lines.files import with_called
from flyby.core.source.lines.interpreter import run_lines
from flyby.core.source.lines.program import Grammar, Said, read_lines
from flyby.core.source.lines.statements import (
    Assign,
    AssignAll,
    Call,
    Close,
    Drive,
    Line,
    Numbers,
    Open,
    Operand,
    Otherwise,
    Pause,
    Routine,
    Situation,
)
from flyby.core.source.reading import ReadOptions
from flyby.core.source.write.numbering import Numbering


class Small(Grammar):
    """``IF …``, ``ELSE``, ``ENDIF``, ``CALL name …``, ``WAIT …``, ``GO V[1]``, assignments."""

    registers = frozenset({"R", "V", "A", "SHIFT"})
    vectors: Mapping[str, int] = MappingProxyType({"V": 2})
    argument = "A"

    def statement(self, line: Line) -> Said:
        word, _, rest = line.text.partition(" ")
        begin, span = line.end - len(rest), line.span
        if word == "ROUTINE":
            return Routine(span, rest)
        if word == "IF":
            return Open(span, parse(line.source, begin, line.end))
        if word == "ELSEIF":
            return Otherwise(span, parse(line.source, begin, line.end))
        if word == "ELSE":
            return Otherwise(span)
        if word == "ENDIF":
            return Close(span)
        if word == "CALL":
            name, _, given = rest.partition(" ")
            at = line.end - len(given)
            return Call(span, name, (parse(line.source, at, line.end),) if given else ())
        if word == "WAIT":
            return Pause(span, parse(line.source, begin, line.end))
        if word == "GO":
            return self._go(line, begin)
        target = parse(line.source, line.start, line.start + line.text.index("="))
        assert isinstance(target, Datum)
        at = line.start + line.text.index("=") + 1
        if target.word == "V" and target.element is None:
            datum = parse(line.source, at, line.end)
            assert isinstance(datum, Datum)
            return AssignAll(span, target, ((1.0, Operand(datum.span, point=datum)),))
        return Assign(span, target, parse(line.source, at, line.end))

    def _go(self, line: Line, begin: int) -> Drive:
        datum = parse(line.source, begin, line.end)
        assert isinstance(datum, Datum)

        def build(
            target: Numbers, speed: Numbers, zone: Numbers, via: Numbers, now: Situation
        ) -> Move:
            return MoveJ(JointTarget(tuple(target)), Speed())

        place = Operand(datum.span)
        return Drive(line.span, Operand(datum.span, point=datum), place, place, build)


def run(text: str, entry: str | None = None) -> Program:
    grammar = Small()
    return run_lines(read_lines(text, "job", grammar, "small"), grammar, ReadOptions(entry))


def waits(program: Program) -> list[float]:
    return [s.duration for s in program.statements if isinstance(s, Wait)]


@given(value=st.integers(0, 4))
def test_one_branch_of_a_block_is_carried_out(value: int) -> None:
    lines = [
        f"R[1]={value}",
        "IF R[1]=1",
        "WAIT 1",
        "ELSEIF R[1]=2",
        "IF R[1]>1",
        "WAIT 2",
        "ENDIF",
    ]
    assert waits(run("\n".join([*lines, "ELSE", "WAIT 3", "ENDIF"]))) == [
        {1: 1, 2: 2}.get(value, 3)
    ]


@pytest.mark.parametrize(
    ("lines", "said"),
    [
        ("IF R[1]=1\nWAIT 1\n", "job:1:1: the block that begins here has no end"),
        ("ENDIF\n", "job:1:1: no block is open here"),
        ("ELSE\n", "job:1:1: no condition stands before it"),
        ("GO V[1]\n", r"a move depends on V\[1,1\]: answer it"),
        ("GO V[1.5]\n", "whole numbers"),
        ("R[1e999]=1\n", "whole numbers"),
    ],
)
def test_an_error_says_where(lines: str, said: str) -> None:
    with pytest.raises(SourceError, match=said):
        run(lines)


def test_arguments_are_what_the_caller_gave() -> None:
    assert waits(run("R[1]=2\nCALL rest R[1]+1\nROUTINE rest\nWAIT A[1]*2\n")) == [6.0]


GO = "V[1,1]=1\nV[1,2]=2\nGO V[1]\n"
IN_ROUTINES = f"ROUTINE near\n{GO}ROUTINE Pick\nCALL near\n{GO}ROUTINE note\nR[1]=1\n"


@pytest.mark.parametrize(
    ("text", "entry", "begun", "moves"),
    [
        (IN_ROUTINES, None, "Pick", 2),
        (f"ROUTINE note\nR[1]=1\nROUTINE Near\n{GO}", None, "Near", 1),
        ("R[1]=1\n" + IN_ROUTINES + "ROUTINE Main\nCALL Pick\n", None, "Main", 2),
        (IN_ROUTINES + f"ROUTINE all\n{GO}", "all", "all", 1),
        (GO + IN_ROUTINES, None, "main", 1),
    ],
)
def test_a_program_begins_where_it_drives(text, entry, begun, moves) -> None:
    program = run(text, entry)
    assert (program.name, len(program.moves)) == (begun, moves)


def test_routines_are_listed_and_told() -> None:
    listed = run(IN_ROUTINES, "all")
    assert [(e.name, e.moves) for e in listed.entries] == [("near", 1), ("Pick", 2), ("note", 0)]
    assert "begins with Pick, the first of 2 routines" in str(run(IN_ROUTINES).notes)
    with pytest.raises(SourceError, match=r"no routine 'pck'.*near .1 move., Pick"):
        run(IN_ROUTINES, "pck")
    alone = run(f"ROUTINE note\nR[1]=1\nROUTINE near\n{GO}", "note")
    assert [(e.name, e.begun) for e in alone.entries] == [("note", True), ("near", False)]


def test_a_program_needs_no_lines_before_its_routines() -> None:
    read = read_lines(IN_ROUTINES, "p", Small(), "Small")
    routines = {key: body for key, body in read.routines.items() if key}
    assert len(run_lines(replace(read, routines=routines), Small(), ReadOptions()).moves) == 2


class Several(Small):
    """``BOTH``, ``APART``, ``HALT`` and ``FLY V[1]``: lines of several statements."""

    def statement(self, line: Line) -> Said:
        def output(number: int, said: str | None = None) -> Assign:
            datum = Datum(line.span, "DO", Number(line.span, float(number)))
            return Assign(line.span, datum, Truth(line.span, True), said)

        if line.text == "HALT":
            return output(5), Pause(line.span, condition=Truth(line.span, True))
        if line.text == "APART":
            return output(5, "OUT 5"), output(6, "OUT 6")
        if line.text == "FLY V[1]":
            return self._go(line, line.start + 4), output(5)
        return (output(5), output(6)) if line.text == "BOTH" else super().statement(line)


def test_a_line_of_several_statements_is_kept_once() -> None:
    lines = f"{GO}BOTH\nBOTH\nAPART\nHALT\n"
    grammar = Several()
    program = run_lines(read_lines(lines, "job", grammar, "small"), grammar, ReadOptions())
    kept = [(s.text, s.stops) for s in program.statements if isinstance(s, Opaque)]
    assert kept == [(one, one == "HALT") for one in ("BOTH", "BOTH", "OUT 5", "OUT 6", "HALT")]
    with pytest.raises(SourceError, match=r"job:4:1: this line drives and says something else"):
        run_lines(read_lines(f"{GO}FLY V[1]\n", "job", grammar, "small"), grammar, ReadOptions())


def test_numbers_of_a_register_know_their_literals() -> None:
    text = "V[1,1]=0.5\nV[1,2]=R[9]\nR[1]=1\nV[2]=V[1]\nGO V[R[1]+1]\n"
    with pytest.raises(SourceError, match=r"depends on R\[9\]"):
        run(text)
    (move,) = run(text.replace("R[9]", "0.25")).moves
    assert move.target == JointTarget((0.5, 0.25))
    assert move.origin is not None
    spans = [span for span in move.origin.target.numbers if span is not None]
    stated = text.replace("R[9]", "0.25")
    assert [stated[span.start : span.end] for span in spans] == ["0.5", "0.25"]


def test_programs_that_are_called_are_read_and_what_they_call(tmp_path: Path) -> None:
    for name, text in (("a", "CALL B"), ("B", "CALL c"), ("C", ""), ("d", "CALL a"), ("f", "")):
        (tmp_path / f"{name}.TXT").write_text(text)
    called = re.compile(r"CALL (\w+)").findall
    files = with_called(tmp_path / "a.TXT", ReadOptions(), (".txt",), called, ("f.txt",))
    assert sorted(Path(name).stem for name in files) == ["B", "C", "a", "f"]
    alone = ReadOptions(beside=(tmp_path / "B.TXT",))
    files = with_called(tmp_path / "a.TXT", alone, (".txt",), called)
    assert [Path(name).stem for name in files] == ["a", "B"]


def test_lines_without_a_heading_are_called_as_their_file_is() -> None:
    grammar = Small()
    first = read_lines("CALL rest 2\nCALL more", "main.x", grammar, "small")
    other = read_lines("WAIT A[1]\nROUTINE more\nWAIT 5", "dir/REST.x", grammar, "small")
    program = run_lines(first.with_file(other), grammar, ReadOptions())
    assert waits(program) == [2.0, 5.0]


@given(names=st.lists(st.sampled_from([None, "tool3", "UTOOL[2]", "gun", "T99"]), max_size=8))
def test_each_value_has_a_number_of_its_own(names: list[str | None]) -> None:
    numbering: Numbering[int] = Numbering("tools", 8)
    given_ = [numbering.of(k, name) for k, name in enumerate(names)]
    assert len(set(given_)) == len(given_) and all(1 <= k <= 8 for k in given_)
    assert [numbering.of(k) for k in range(len(names))] == given_


def test_there_are_only_so_many_numbers() -> None:
    numbering: Numbering[int] = Numbering("tools", 1)
    numbering.of(0)
    with pytest.raises(InputError, match="no more than 1 tools"):
        numbering.of(1)
