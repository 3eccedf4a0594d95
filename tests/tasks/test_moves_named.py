"""Moves named by number, line or target, and options that would change nothing."""

from __future__ import annotations

from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

import flyby
from flyby.core.errors import InputError, OptionError
from flyby.tasks.options.moves import moves_named

ROOT = Path(__file__).parents[2]
CELL = ROOT / "examples" / "cell" / "two_joints.toml"
KUKA = flyby.read(ROOT / "examples" / "seam.src", robot="kuka/kr30-3")
ABB = flyby.read(ROOT / "examples" / "deburring.mod", robot="abb/irb6640-180-255")
FOLDED = flyby.read(ROOT / "examples" / "cell" / "two_joints.mod", cell=CELL)


@given(st.sampled_from(range(len(ABB.moves))))
def test_every_move_is_found_by_number_line_and_target(index: int) -> None:
    move = ABB.moves[index]
    assert moves_named(ABB, index + 1, "keep") == [index]
    assert moves_named(ABB, str(index + 1), "keep") == [index]
    assert move.statement is not None
    line = move.statement.line
    by_line = moves_named(ABB, f"line:{line}", "keep")
    assert index in by_line
    assert all(m.statement.line == line for m in map(ABB.moves.__getitem__, by_line) if m.statement)
    assert by_line == moves_named(ABB, f"line:deburring.mod:{line}", "keep")
    if move.target.name is not None:
        assert index in moves_named(ABB, move.target.name, "keep")


def test_a_line_of_a_loop_names_all_its_moves_and_a_range_all_lines_in_it() -> None:
    assert moves_named(ABB, "line:178", "keep") == [43, 48, 53, 58]
    assert moves_named(ABB, "line:176-178", "keep") == [42, 43, 47, 48, 52, 53, 57, 58]


def test_targets_are_named_in_any_case_and_by_their_datum() -> None:
    assert moves_named(KUKA, "ABOVE", "keep") == moves_named(KUKA, "above", "keep") == [1, 7]
    assert moves_named(KUKA, "corner[1]", "keep") == [2, 6]


@pytest.mark.parametrize(
    ("text", "kind", "message"),
    [
        ("0", InputError, "moves 1 to 98"),
        ("pC11", InputError, "did you mean pC10"),
        ("nothing", InputError, "targets: jHome, jConv"),
        ("line:119", InputError, "no move is driven from there; the nearest are from lines"),
        ("line:other.mod:114", InputError, "no move of that file"),
        ("line:x", OptionError, "line:44"),
    ],
)
def test_a_name_of_no_move_says_what_would_do(
    text: str, kind: type[InputError], message: str
) -> None:
    with pytest.raises(kind, match=message):
        moves_named(ABB, text, "keep")


def test_kept_by_line_or_target_is_kept_by_number() -> None:
    made = [flyby.zones(FOLDED, keep=keep) for keep in (3, "line:14", "p2")]
    zones = [[move.zone for move in one.program.moves] for one in made]
    assert zones[0] == zones[1] == zones[2]
    assert zones[0][2] == FOLDED.moves[2].zone != flyby.zones(FOLDED).program.moves[2].zone


def test_an_option_without_effect_is_noted() -> None:
    for options in ({"keep": "line:12"}, {"keep": 5}):
        notes = [note.message for note in flyby.zones(FOLDED, **options).notes]
        assert any("has no effect" in note for note in notes), options
    quick = {"starts": 1, "generations": 0}
    made = flyby.optimize(FOLDED, limit="5=box:10", **quick)
    assert "limit 5 has no effect: the robot stops there" in "".join(map(str, made.notes))
    square = flyby.read(ROOT / "examples/square.mod", robot="abb/irb6640-180-255")
    made = flyby.optimize(square, limit="line:10=box:10", **quick)
    told = [note.message for note in made.notes]
    assert "limit line:10 has no effect: the program computes its target" in told
    # Its zone does change, so it is not all of the move that stays.
    assert "its target stays as it is: the program computes its target" in told
    made = flyby.optimize(FOLDED, limit="line:13=joints:2", **quick)
    assert not any("no effect" in note.message for note in made.notes)
    moved = made.program.moves[1].target.joints
    was = FOLDED.moves[1].target.joints
    assert 0.0 < max(abs(a - b) for a, b in zip(moved, was, strict=True)) <= 0.0350


def test_what_is_gained_at_the_waypoints_is_what_is_gained() -> None:
    made = flyby.zones(FOLDED)
    assert set(made.gained) >= {change.move for change in made.zones}
    assert sum(made.gained.values()) == pytest.approx(made.before.time - made.after.time, abs=2e-3)


def test_what_zones_finds_is_a_candidate_of_optimize() -> None:
    wide = flyby.zones(FOLDED, predefined=True)
    made = flyby.optimize(FOLDED, zones_only=True, predefined=True, starts=1, generations=0)
    assert made.proven and made.after.time <= wide.after.time + 1e-9 < wide.before.time
    # What is written is what was chosen, not what was read back on the way.
    assert b"".join(made.files.values()).count(b"z150") == sum(
        getattr(move.zone, "name", None) == "z150" for move in made.program.moves
    )


def test_what_zones_finds_is_a_candidate_of_pareto() -> None:
    wide = flyby.zones(FOLDED)
    front = flyby.pareto(FOLDED, points=2, change="zones")
    assert front.points[0].duration <= wide.after.time + 1e-6
    # Its text is its own: read again it is that program.
    (name,) = front.folders[0]
    read = flyby.read(front.folders[0][name].decode(), cell=CELL)
    assert [move.zone for move in read.moves] == [m.zone for m in front.points[0].program.moves]
    assert flyby.emulate(read).duration == pytest.approx(front.points[0].duration, abs=5e-3)
