"""What the languages say of signals is read as it was said; the map finds each language's name."""

from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st

from flyby.core.program.signal import Joined, Level, SetSignal, WaitSignal, negated
from flyby.core.registry import find_vendor
from flyby.core.translation.signals import SignalMap

NAMES = {
    "abb": ("doGrip", "diPart", "do_1"),
    "kuka": ("$OUT[3]", "$IN[17]", "$OUT[120]"),
    "ur": ("digital_out[1]", "digital_in[2]", "tool_digital_out[0]", "configurable_digital_in[7]"),
}


def words(vendor: str):
    return find_vendor(vendor).speaks.signals


@st.composite
def conditions(draw: st.DrawFn, names: tuple[str, ...], depth: int = 2, every=None):
    level = st.builds(Level, st.sampled_from(names), st.booleans())
    if depth == 0 or draw(st.booleans()):
        return draw(level)
    every = draw(st.booleans()) if every is None else every
    inner = conditions(names, depth - 1, not every)
    return Joined(tuple(draw(st.lists(inner, min_size=2, max_size=3))), every)


@st.composite
def actions(draw: st.DrawFn, vendor: str):
    if draw(st.booleans()):
        return WaitSignal(draw(conditions(NAMES[vendor])))
    name = NAMES[vendor][0]
    pulse = draw(st.sampled_from([None, 0.5])) if vendor != "ur" else None
    value = True if pulse else draw(st.booleans())
    return SetSignal(name, value, pulse)


@pytest.mark.parametrize("vendor", list(NAMES))
@given(data=st.data())
def test_what_is_said_is_read_as_it_was(vendor, data) -> None:
    action = data.draw(actions(vendor))
    text = words(vendor).said(action)
    assert words(vendor).read(text) == action


@given(conditions(("a", "b", "c"), 3))
def test_what_holds_when_a_condition_does_not_is_turned_twice_the_same(condition) -> None:
    assert negated(negated(condition)) == condition


@pytest.mark.parametrize(
    ("vendor", "text", "action"),
    [
        ("abb", "SetDO \\Sync, doA, high;", SetSignal("doA", True)),
        ("abb", "Reset doA;", SetSignal("doA", False)),
        ("abb", "SetAO aoFlow, 2.5;", SetSignal("aoFlow", 2.5)),
        ("abb", "PulseDO \\PLength:=0.5, doA;", SetSignal("doA", True, 0.5)),
        ("abb", "WaitDI diA, 0\\MaxTime:=2;", WaitSignal(Level("diA", False), 2.0)),
        (
            "abb",
            "WaitUntil diA = 1 AND NOT (diB = 1 OR DInput(diC) <> 1);",
            WaitSignal(
                Joined(
                    (Level("diA", True), Joined((Level("diB", False), Level("diC", True)), True)),
                    True,
                )
            ),
        ),
        ("abb", "SetDO \\SDelay:=0.2, doA, 1;", None),
        ("abb", "SetDO doA, bState;", None),
        ("abb", "WaitUntil nParts > 3;", None),
        ("abb", "WaitUntil diA = 1 \\TimeFlag:=late;", None),
        ("kuka", "$OUT[ 3 ] = TRUE", SetSignal("$OUT[3]", True)),
        ("kuka", "PULSE( $OUT[1], TRUE, 0.3 )", SetSignal("$OUT[1]", True, 0.3)),
        (
            "kuka",
            "WAIT FOR $IN[7] AND NOT $IN[8]",
            WaitSignal(Joined((Level("$IN[7]", True), Level("$IN[8]", False)), True)),
        ),
        ("kuka", "WAIT FOR $IN[nr]", None),
        ("kuka", "WAIT FOR counter > 3", None),
        ("ur", "set_digital_out(8, True)", SetSignal("tool_digital_out[0]", True)),
        ("ur", "set_standard_digital_out(2, False)", SetSignal("digital_out[2]", False)),
        (
            "ur",
            "while (get_standard_digital_in(2) == False):\n sync()\nend",
            WaitSignal(Level("digital_in[2]", True)),
        ),
        ("ur", "while x < 3:\n  sync()\nend", None),
        ("ur", "set_digital_out(n, True)", None),
    ],
)
def test_what_a_statement_does_with_signals(vendor, text, action) -> None:
    assert words(vendor).read(text) == action


@pytest.mark.parametrize("old", list(NAMES))
@pytest.mark.parametrize("new", list(NAMES))
def test_one_row_of_the_map_serves_all_directions(old, new) -> None:
    row = {"abb": "do_gripper", "kuka": "$OUT[3]", "ur": "digital out 1"}
    table = SignalMap.of({"do_gripper": ["$OUT[3]", "digital out 1"]})
    expected = {**row, "ur": "digital_out[1]"}[new]
    name = words(old).spelt(row[old])
    assert table.name(name, words(old), words(new)) == (None if old == new else expected)
    assert table.name("other", words(old), words(new)) is None


@pytest.mark.parametrize(
    ("vendor", "name"),
    [("kuka", "$IN[1]"), ("kuka", "$anin[2]"), ("ur", "digital_in[1]"), ("ur", "analog_in[0]")],
)
def test_no_program_sets_an_input(vendor, name) -> None:
    value = 0.5 if "an" in name else True
    assert words(vendor).said(SetSignal(name, value)) is None
