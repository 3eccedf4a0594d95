"""Programs folded to loops and routines have the same statements in the same order."""

from __future__ import annotations

from dataclasses import replace

from hypothesis import given
from hypothesis import strategies as st

from flyby.core.errors import Span
from flyby.core.program.folding import Called, Node, Repeat, Said, folded, with_one_cycle
from flyby.core.program.move import Opaque, Statement
from flyby.core.program.program import Program
from flyby.core.program.section import Section

SPAN = Span("a.mod", 1, 1, 0, 0)
NAMES = ("pick", "Pick", "place")


@st.composite
def blocks(draw: st.DrawFn, depth: int = 3) -> list[object]:
    """Statements, loops and calls in one another."""
    leaf = st.sampled_from("abc")
    if depth == 0:
        return draw(st.lists(leaf, max_size=3))
    inner = blocks(depth=depth - 1)
    loop = st.tuples(st.just("loop"), st.lists(inner, min_size=1, max_size=3))
    same = inner.flatmap(lambda b: st.integers(1, 4).map(lambda n: ("loop", [b] * n)))
    call = st.tuples(st.sampled_from(NAMES), inner)
    return draw(st.lists(st.one_of(leaf, loop, same, call), max_size=4))


def run(found: list[Statement], sections: list[Section], block: list[object]) -> None:
    for item in block:
        if isinstance(item, str):
            found.append(Opaque(item))
            continue
        name, inner = item
        at, begin, passes = len(sections), len(found), []
        sections.append(Section(name, begin, begin, SPAN))
        for body in inner if name == "loop" else [inner]:
            passes.append(len(found))
            run(found, sections, body)
        section = replace(sections[at], end=len(found))
        sections[at] = replace(section, passes=tuple(passes)) if name == "loop" else section


def program_of(block: list[object]) -> Program:
    found: list[Statement] = []
    sections: list[Section] = []
    run(found, sections, block)
    kept = (s for s in sections if s.end > s.begin)
    return Program(tuple(found), sections=tuple(kept))


def unfolded(nodes: tuple[Node, ...], bodies: dict[tuple[str, int], list[int]]) -> list[int]:
    """Indices of the statements that a written program drives, each routine being written once."""
    found: list[int] = []
    for node in nodes:
        if isinstance(node, Repeat):
            found += unfolded(node.body, bodies) * (node.count or 1)
        elif isinstance(node, Called):
            key = node.name.casefold(), node.number
            own = unfolded(node.body, bodies)
            found += bodies.setdefault(key, own)
        else:
            found.append(node.index)
    return found


@given(blocks())
def test_what_is_folded_has_the_same_statements(block) -> None:
    program = program_of(block)
    order = unfolded(folded(program), {})
    assert [program.statements[i] for i in order] == list(program.statements)


def test_a_loop_of_equal_passes_is_one_body_and_a_routine_is_written_once() -> None:
    program = program_of([("loop", [["a", ("pick", ["b"])]] * 3), ("Pick", ["b"]), ("pick", ["c"])])
    loop, again, other = folded(program)
    assert isinstance(loop, Repeat)
    assert (loop.count, loop.level) == (3, 0)
    assert [again.number, other.number] == [0, 1]


def test_passes_that_differ_stand_one_after_the_other() -> None:
    assert folded(program_of([("loop", [["a"], ["b"]])])) == (Said(0), Said(1))


def test_sections_of_other_statements_are_left_alone() -> None:
    program = replace(program_of([("loop", [["a"], ["a"]])]), statements=(Opaque("a"),))
    assert folded(program) == (Said(0),)


def test_one_pass_is_left_of_a_production_loop() -> None:
    program = program_of(["a", ("loop", [["b", ("pick", ["c"])]] * 2)])
    endless = replace(program.sections[0], endless=True)
    program = replace(program, sections=(endless, *program.sections[1:]))
    once = with_one_cycle(program)
    assert [s.text for s in once.statements] == ["a", "b", "c"]
    assert folded(once)[1].count is None
