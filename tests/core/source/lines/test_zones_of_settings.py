"""Settings of several numbers, or of words: ``CNT 1, 300, 200``, ``CP OFF``, ``ACCEL 50, 100``."""

from __future__ import annotations

import re
from collections.abc import Callable
from dataclasses import replace
from typing import Any, ClassVar

import pytest
from hypothesis import given
from hypothesis import strategies as st

from flyby.core.dialect import Dialect, MoveWords, Orientation
from flyby.core.errors import FlybyError, InputError, SourceError
from flyby.core.program.program import Program
from flyby.core.program.zone import FINE, VendorZone, Zone, ZoneKind
from flyby.core.source.lines.amounts import Amount
from flyby.core.source.lines.driving import MotionGrammar
from flyby.core.source.lines.expressions import Spelling
from flyby.core.source.lines.language import LineLanguage
from flyby.core.source.lines.positions import PositionForm
from flyby.core.source.lines.settings import Setting, Settings
from flyby.core.source.patch.edits import alike
from flyby.core.source.reading import ReadOptions

NEAR = ZoneKind("CNT", None, largest=0.5, unit=1e-3, step=1e-3)
BEFORE, BEHIND = Amount("zone", 1e-3), Amount("behind", 1e-3)
SHARE = Amount("acceleration_override", 0.01)
SPEED = Setting("SPD", {"": Amount("joint_fraction", 0.01)}, {"": Amount("tcp", 1e-3)}, 100.0)
ACCEL = Setting(
    "ACCEL", {"": SHARE}, {"": SHARE}, (100.0, 100.0), more=(SHARE,), words={"": (100.0, 100.0)}
)
CNT = Setting(
    "CNT",
    {"": BEFORE},
    {"": BEFORE},
    (0.0, 0.0),
    more=(BEHIND,),
    opening="1, ",
    words={"0": (0.0, 0.0), "1": (500.0, 500.0)},
)
SWITCHED = (
    Setting("CP", *[{"": Amount("passing", 1.0)}] * 2, 0.0, words={"OFF": (0.0,), "ON": (1.0,)}),
    Setting("LEAVE", {"": BEFORE}, {"": BEFORE}, 10.0, sign=" = "),
    Setting("REACH", {"": BEHIND}, {"": BEHIND}, 10.0, sign=" = "),
)
BY_NUMBERS = Settings((SPEED, ACCEL, CNT), NEAR)
BY_SWITCH = Settings((SPEED, *SWITCHED), NEAR)
BY_MOTION = Settings((SPEED, *SWITCHED[1:]), NEAR, flying="FLY")
WORDS = MoveWords((NEAR,), frozenset({"tcp", "joint_fraction", "acceleration_override"}))
FORM = PositionForm(Orientation.EULER_ZYZ)
ROBOT: Any = None


def language(held: Settings) -> LineLanguage:
    class Grammar(MotionGrammar):
        form = FORM
        registers = frozenset({"X"})
        settings = held
        spelling = Spelling(names=True)
        driving = re.compile("[JL]MOVE")
        forms: ClassVar = {
            "motion": r"(?P<kind>[JL])MOVE(?P<flying>(?:FLY)?)\s+(?P<point>\w+)",
            "point": r"POINT\s+(?P<name>\w+)\s*=\s*(?P<values>.*)",
            "assigned": r"(?P<target>\w+)\s*=\s*(?P<value>[^=].*)",
        }

    class Language(LineLanguage):
        name, suffix, trailing = "HOLD", ".hold", "'"
        dialect = Dialect(WORDS, WORDS, WORDS, "joint_fraction", "' ")
        grammar = Grammar

    return Language()


NUMBERS, SWITCH, FLY = map(language, (BY_NUMBERS, BY_SWITCH, BY_MOTION))
POINTS = "POINT a = 500, 0, 300, 0, 180, 0\nPOINT b = 500, 50, 300, 0, 180, 0\n"


def read(text: str, own: LineLanguage = NUMBERS) -> Program:
    return own.read(POINTS + text, "job.hold", ReadOptions())


def zones(text: str, own: LineLanguage = NUMBERS) -> list[Zone]:
    """Of the moves; ratios without what quotients leave behind."""
    every = (move.zone for move in read(text, own).moves)
    return [replace(z, ratio=round(z.ratio, 12)) if isinstance(z, VendorZone) else z for z in every]


def patched(
    text: str, change: Callable[[int, Zone], Zone], own: LineLanguage = NUMBERS, **options: str
) -> str:
    program = read(text, own)
    moves = (replace(m, zone=change(k, m.zone)) for k, m in enumerate(program.moves))
    files = own.patch(program.with_moves(tuple(moves)), ROBOT, options)
    return files["job.hold"].text.removeprefix(POINTS) if files else text


def near(before: float, behind: float) -> VendorZone:
    return VendorZone(NEAR, before / 1000, round(behind / before, 12))


def test_numbers_and_words_stand_behind_one_word() -> None:
    text = "LMOVE a\nCNT 1, 300, 200\nLMOVE b\ncnt 1,50\nLMOVE a\nCNT 1\nLMOVE b\nCNT 0\nLMOVE a\n"
    assert zones(text) == [FINE, near(300, 200), near(50, 50), near(500, 500), FINE]
    through = zones("X = 40\nCNT 1, X, 20\nLMOVE a\n")
    assert through == [near(40, 20)]
    with pytest.raises(SourceError, match="CNT has no more than 2 numbers"):
        read("CNT 1, 2, 3, 4\n")
    with pytest.raises(SourceError, match=r"ACCEL 20 differs from another setting"):
        read("ACCEL 50, 20\nLMOVE a\n")
    shares = [
        m.speed.acceleration_override for m in read("ACCEL 50\nLMOVE a\nACCEL\nLMOVE a").moves
    ]
    assert shares == [0.5, 1.0]


@pytest.mark.parametrize(
    ("text", "new", "wanted"),
    [
        ("CNT 1, 300.0, 200  ' near\nLMOVE a\n", near(250, 200), "CNT 1, 250.0, 200  ' near"),
        ("CNT 1,300\nLMOVE a\n", near(250, 250), "CNT 1,250"),
        ("CNT 1,300\nLMOVE a\n", near(300, 30), "CNT 1,300, 30"),
        ("CNT 1, 300, 200\nLMOVE a\n", FINE, "CNT 0"),
        ("CNT 0 ' stop\nLMOVE a\n", near(30, 60), "CNT 1, 30, 60 ' stop"),
        ("CNT 1\nLMOVE a\n", near(30, 30), "CNT 1, 30, 30"),
    ],
)
def test_zones_are_patched_where_they_stand(text: str, new: Zone, wanted: str) -> None:
    assert patched(text, lambda _, zone: new) == f"{wanted}\nLMOVE a\n"


def test_numbers_of_registers_are_patched_there() -> None:
    text = "X = 300\nCNT 1, X, 200\nLMOVE a\n"
    assert patched(text, lambda *_: near(150, 200)) == text.replace("300", "150")
    with pytest.raises(FlybyError, match="change"):
        patched(text.replace("300", "100 + 200"), lambda *_: near(150, 200))


def test_one_move_gets_a_zone_of_its_own_and_comments_stay() -> None:
    text = "CNT 1, 30, 20\n  LMOVE a\n  LMOVE b   ' the press\n  LMOVE a ' out\n"
    with pytest.raises(FlybyError, match="CNT is read by move"):
        patched(text, lambda k, zone: FINE if k == 1 else zone)
    own = patched(text, lambda k, zone: FINE if k == 1 else zone, shared="own")
    assert own == (
        "CNT 1, 30, 20\n  LMOVE a\n  CNT 0\n  LMOVE b   ' the press\n  CNT 1, 30, 20\n"
        "  LMOVE a ' out\n"
    )


def test_a_switch_says_whether_there_is_a_zone() -> None:
    text = "LMOVE a\nCP ON\nLMOVE b\nREACH = 30\nLMOVE a\nCP OFF\nLMOVE b\n"
    assert zones(text, SWITCH) == [FINE, near(10, 10), near(10, 30), FINE]
    text = "CP ON\nLEAVE = 20\nREACH = 30\nLMOVE a\n"
    assert patched(text, lambda *_: FINE, SWITCH) == text.replace("ON", "OFF")
    off = text.replace("ON", "OFF")
    assert patched(off, lambda *_: near(20, 5), SWITCH) == text.replace("30", "5")


def test_a_motion_may_say_that_there_is_a_zone() -> None:
    text = "LMOVE a\nLMOVEFLY b\nREACH = 30\nLMOVEFLY a\nLMOVE b\n"
    assert zones(text, FLY) == [FINE, near(10, 10), near(10, 30), FINE]
    text = "LEAVE = 20\nLMOVEFLY a\n"
    assert patched(text, lambda *_: near(40, 10), FLY) == text.replace("20", "40")
    assert patched(text, lambda *_: FINE, FLY) == text.replace("FLY", "")
    stop = "LEAVE = 20\nLMOVE a\nLMOVEFLY b ' on\nLMOVEFLY a\n"
    some = [near(20, 10), near(40, 10), near(5, 5)]
    for zone in some:
        made = patched(stop, lambda k, old, new=zone: old if k else new, FLY)
        assert zones(made, FLY) == [zone, near(20, 10), near(20, 10)]
    assert patched(stop, lambda k, old: some[0], FLY) == stop.replace("LMOVE a", "LMOVEFLY a")
    assert zones(patched(stop, lambda k, old: some[k], FLY, shared="own"), FLY) == some
    (move,) = read("LMOVE a\n", FLY).moves
    assert list(BY_MOTION.lines(move, {})) == ["SPD 100"]


def test_a_sphere_has_one_distance() -> None:
    with pytest.raises(InputError, match="a Radius has one distance"):
        Settings((CNT,))
    with pytest.raises(InputError, match="'0' stands for 1 numbers"):
        replace(SWITCHED[0], words={"0": ()})


@given(
    st.lists(
        st.just(FINE)
        | st.builds(near, st.integers(1, 500).map(float), st.integers(1, 900).map(float)),
        min_size=1,
        max_size=4,
    ),
    st.sampled_from([(NUMBERS, BY_NUMBERS), (SWITCH, BY_SWITCH)]),
)
def test_what_is_said_before_moves_is_read_again(
    wanted: list[Zone], spoken: tuple[LineLanguage, Settings]
) -> None:
    own, held = spoken
    said: dict[str, str] = {}
    lines: list[str] = []
    for zone in wanted:
        (move,) = read("LMOVE a\n", own).moves
        lines += [*held.lines(replace(move, zone=zone), said), "LMOVE a"]
    for one, other in zip(zones("\n".join(lines), own), wanted, strict=True):
        assert alike(one, other)


@given(
    st.sampled_from([NUMBERS, SWITCH]),
    st.lists(
        st.just(FINE) | st.builds(near, st.just(20.0), st.sampled_from([20.0, 40.0])),
        min_size=3,
        max_size=3,
    ),
)
def test_patches_give_the_wanted_zones_or_are_refused(
    own: LineLanguage, wanted: list[Zone]
) -> None:
    first = "CNT 1, 30, 30\n" if own is NUMBERS else "CP ON\nLEAVE = 30\n"
    text = f"{first}LMOVE a\nLMOVE b\nLMOVE a\n"
    try:
        made = patched(text, lambda k, _: wanted[k], own, shared="own")
    except FlybyError:
        assert own is SWITCH
        return
    assert alike(zones(made, own), wanted)
