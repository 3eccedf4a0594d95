"""Where the numbers of a move stand in a URScript, and who else reads them."""

from hypothesis import given
from hypothesis import strategies as st

from flyby.core.errors import Span
from flyby.core.program.move import MoveC
from flyby.core.program.origin import MoveOrigin, Origin, Ownership
from flyby.vendors.ur.run.reader import read

OWNED, SHARED, DERIVED = Ownership.OWNED, Ownership.SHARED, Ownership.DERIVED


def origins(text: str) -> list[MoveOrigin]:
    return [move.origin for move in read(text, "t.script").moves if move.origin is not None]


def at(text: str, span: Span | None) -> str | None:
    return None if span is None else text[span.start : span.end]


def shown(text: str, origin: Origin) -> list[str | None]:
    return [at(text, span) for span in origin.numbers]


def test_literals_at_the_move_are_its_own() -> None:
    text = "movel(p[.1, -0.2, - 0.3, 0, 3.1, 1e-2], a=1.5, v=0.5, r=0.02)"
    (origin,) = origins(text)
    assert shown(text, origin.target) == [".1", "-0.2", "- 0.3", "0", "3.1", "1e-2"]
    assert shown(text, origin.speed) == ["1.5", "0.5", None]
    assert shown(text, origin.zone) == ["0.02"]
    assert {origin.target.ownership, origin.speed.ownership, origin.zone.ownership} == {OWNED}
    assert at(text, origin.speed.span) == "a=1.5, v=0.5"
    assert at(text, origin.zone.span) == "r=0.02"
    assert at(text, origin.statement) == text


def test_positional_arguments_have_their_places_too() -> None:
    text = "movej([0, 1, 2, 3, 4, 5], 1.5, 0.5, 2, 0.02)"
    (origin,) = origins(text)
    assert shown(text, origin.target) == ["0", "1", "2", "3", "4", "5"]
    assert shown(text, origin.speed) == ["1.5", "0.5", "2"]
    assert shown(text, origin.zone) == ["0.02"]


def test_what_is_not_written_has_an_empty_place_before_the_bracket() -> None:
    text = "def f():\n  movej([0, 1, 2, 3, 4, 5] )\nend"
    (origin,) = origins(text)
    for part in (origin.speed, origin.zone):
        assert part.ownership is DERIVED
        assert part.numbers == ()
        assert part.span.start == part.span.end == text.index(")\nend")
        assert (part.span.line, part.span.column) == (2, 28)


def test_a_variable_assigned_once_is_one_datum() -> None:
    text = (
        "global home_p=p[1, 2, 3, 4, 5, 6]\nglobal home_q=[6, 5, 4, 3, 2, 1]\nspeed = 0.5\n"
        "movej(get_inverse_kin(home_p, qnear=home_q), v=speed)\nmovel(home_p, v=speed, a=1)"
    )
    first, second = origins(text)
    assert shown(text, first.target) == list("123456654321")
    assert first.target.datum is None
    assert shown(text, second.target) == list("123456")
    assert second.target.datum == "home_p"
    assert first.target.ownership is second.target.ownership is SHARED
    assert shown(text, first.speed) == [None, "0.5", None]
    assert shown(text, second.speed) == ["1", "0.5", None]
    assert first.speed.ownership is SHARED


def test_a_datum_of_one_move_is_owned_until_something_else_reads_it() -> None:
    text = "a = p[1, 2, 3, 4, 5, 6]\nmovel(a)\n"
    (origin,) = origins(text)
    assert (origin.target.ownership, origin.target.datum) == (OWNED, "a")
    (origin,) = origins(text + "textmsg(a[2])")
    assert origin.target.ownership is SHARED
    (origin,) = origins(text + "b = pose_inv(a)")
    assert origin.target.ownership is SHARED


def test_computed_targets_are_derived_and_make_their_data_shared() -> None:
    text = "a = p[1, 2, 3, 4, 5, 6]\nmovel(pose_trans(a, p[0, 0, 1, 0, 0, 0]))\nmovel(a)"
    first, second = origins(text)
    assert first.target.ownership is DERIVED
    assert second.target.ownership is SHARED


def test_partly_written_out_targets_name_the_numbers_that_are() -> None:
    text = "z = 0.5\nmovel(p[0.1, 0.2 + 0.1, z, 0, d2r(90), 1])"
    (origin,) = origins(text)
    assert shown(text, origin.target) == ["0.1", None, "0.5", "0", None, "1"]
    assert origin.target.ownership is OWNED


def test_elements_keep_their_literals_until_they_are_assigned() -> None:
    text = "a = p[1, 2, 3, 4, 5, 6]\na[2] = 0.7\na[3] = a[3] * 2\nmovel(a)"
    (origin,) = origins(text)
    assert shown(text, origin.target) == ["1", "2", "0.7", None, "5", "6"]
    text = "l = [p[1, 2, 3, 4, 5, 6], p[6, 5, 4, 3, 2, 1]]\ni = 1\nmovel(l[i])"
    (origin,) = origins(text)
    assert shown(text, origin.target) == list("654321")


def test_arguments_and_returned_values_keep_their_literals() -> None:
    text = (
        "def go(to, speed=0.4):\n  movel(to, v=speed)\n  return to\nend\n"
        "x = go(p[1, 2, 3, 4, 5, 6])\nmovel(x, v=0.4)"
    )
    first, second = origins(text)
    assert shown(text, first.target) == shown(text, second.target) == list("123456")
    assert first.target.ownership is SHARED
    assert shown(text, first.speed) == [None, "0.4", None]
    assert first.speed.numbers != second.speed.numbers


def test_a_move_in_a_loop_shares_with_itself() -> None:
    text = "i = 0\nwhile i < 2:\n  movel(p[1, 2, 3, 4, 5, 6])\n  i = i + 1\nend"
    first, second = origins(text)
    assert first.target == second.target
    assert first.target.ownership is SHARED


def test_a_reassigned_variable_has_the_new_literal() -> None:
    text = "a = p[1, 2, 3, 4, 5, 6]\nmovel(a)\na = p[6, 5, 4, 3, 2, 1]\nmovel(a)"
    first, second = origins(text)
    assert shown(text, first.target) == list("123456")
    assert shown(text, second.target) == list("654321")
    assert first.target.ownership is second.target.ownership is OWNED


def test_arcs_have_two_targets() -> None:
    text = "movel(p[0,0,0,0,0,0])\nmovec(p[1, 0, 0, 0, 0, 0], p[2, 1, 0, 0, 0, 0], r=0.1)"
    origin = origins(text)[1]
    assert isinstance(read(text, "t.script").moves[1], MoveC)
    assert origin.via is not None
    assert shown(text, origin.via) == list("100000")
    assert shown(text, origin.target) == list("210000")


numbers = st.floats(-9, 9, allow_subnormal=False).map(repr)


@given(st.lists(numbers, min_size=6, max_size=6), st.sampled_from(["", "  ", "\n", " # x\n"]))
def test_every_number_is_found_where_it_stands(literals: list[str], gap: str) -> None:
    text = f"movel(p[{f',{gap}'.join(literals)}], r=0.1)"
    (origin,) = origins(text)
    assert shown(text, origin.target) == literals
    for span in origin.target.numbers:
        assert span is not None
        lines = text[: span.start].split("\n")
        assert (span.line, span.column) == (len(lines), len(lines[-1]) + 1)
