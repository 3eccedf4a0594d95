"""Orders hold every state that a play of the same rules in time can come to."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from flyby.core.errors import InputError
from flyby.core.program.signal import Level, Meet, SetSignal, WaitSignal
from flyby.core.station.actions import Action
from flyby.core.station.awaited import bearing
from flyby.core.station.clock import StationClock
from flyby.core.station.orders import explore
from flyby.core.station.station import (
    ClockPace,
    Gate,
    GateKind,
    Input,
    RobotStation,
    Wire,
)

Doings = dict[str, tuple[Action, ...]]


def on(name: str, pulse: float | None = None) -> SetSignal:
    return SetSignal(name, True, pulse)


def off(name: str) -> SetSignal:
    return SetSignal(name, False)


def wait(name: str, level: bool = True) -> WaitSignal:
    return WaitSignal(Level(name, level))


def station(programs: dict[str, list[Any]], **joined: Any) -> tuple[RobotStation, Doings]:
    """Robots that do one thing a second."""
    actions = {
        name: tuple(
            Action(does, 1.0 + k, k, str(does), None)
            for k, does in enumerate(doings)
            if does is not None
        )
        for name, doings in programs.items()
    }
    members = {
        name: SimpleNamespace(
            run=SimpleNamespace(duration=2.0 + len(doings), timing=SimpleNamespace(lag=0.0)),
            begins=0.0,
            pace=ClockPace.steady(),
        )
        for name, doings in programs.items()
    }
    return RobotStation(members, **joined), actions  # type: ignore[arg-type]


def ends(made: RobotStation, actions: Doings) -> bool:
    """Whether all robots come to their ends; orders hold what the clock passes."""
    orders = explore(made, actions)
    run = StationClock(made, actions).run()
    last = tuple(map(len, actions.values()))
    if not run.stuck:
        assert last in orders.reachable
    return last in orders.reachable


def test_a_change_brings_what_the_source_is_then() -> None:
    """The output was on, and the input is off all the same: going off, it does not switch it on."""
    wires = (Wire("a.x", "b.y"),)
    programs = {"a": [off("x")], "b": [wait("y")]}
    made, actions = station(programs, wires=wires, initial=frozenset({"a.x"}), given={"b.y": False})
    assert not ends(made, actions)


def test_two_outputs_on_one_input() -> None:
    wires = (Wire("a.x", "c.y"), Wire("b.x", "c.y"))
    programs = {"a": [on("x")], "b": [None, on("x")], "c": [None, None, None, wait("y")]}
    made, actions = station(programs, wires=wires)
    assert ends(made, actions)
    orders = explore(made, actions)
    assert max(orders.reachable)[:2] == (1, 1) and not orders.stuck


def test_a_pulse_may_end_after_another_robot_has_seen_it() -> None:
    gates = {
        "held": Gate(GateKind.AND, (Input("a.x"), Input("b.seen"))),
        "let": Gate(GateKind.AND, (Input("b.seen"), Input("a.x", False))),
    }
    wires = (Wire("a.x", "b.y"), Wire("plc.held", "b.held"), Wire("plc.let", "c.let"))
    programs = {
        "a": [on("x", 1.7)],
        "b": [wait("y"), on("seen"), wait("held", False)],
        "c": [wait("let")],
    }
    made, actions = station(programs, wires=wires, gates=gates)
    assert ends(made, actions)


@pytest.mark.parametrize("names", [("full", "any"), ("any", "full")])
def test_counters_count_what_gates_behind_them_bring(names: tuple[str, str]) -> None:
    made_of = {
        "any": Gate(GateKind.OR, (Input("a.x"), Input("a.z"))),
        "full": Gate(GateKind.COUNTER, (Input("plc.any"),), least=2),
    }
    gates = {name: made_of[name] for name in names}
    programs = {"a": [on("x"), off("x"), on("z"), off("z")], "b": [wait("go")]}
    made, actions = station(programs, wires=(Wire("plc.full", "b.go"),), gates=gates)
    assert ends(made, actions)


def test_a_counter_counts_what_is_on_at_the_beginning() -> None:
    gates = {"full": Gate(GateKind.COUNTER, (Input("a.x"),), least=2)}
    programs = {"a": [off("x"), on("x")], "b": [wait("go")]}
    made, actions = station(
        programs, wires=(Wire("plc.full", "b.go"),), gates=gates, initial=frozenset({"a.x"})
    )
    assert ends(made, actions)


def test_many_changes_that_nobody_has_seen_yet() -> None:
    """The third robot goes on when the first has done all: by then no change has arrived."""
    toggles = [does for _ in range(6) for does in (on("x"), off("x"))]
    wires = (Wire("a.x", "b.y", 20.0, 20.0), Wire("a.done", "b.go"))
    waits = [does for _ in range(6) for does in (wait("y"), wait("y", False))]
    programs = {"a": [*toggles, on("done")], "b": [wait("go"), *waits]}
    made, actions = station(programs, wires=wires)
    assert ends(made, actions)


def test_meetings_of_one_name_among_others() -> None:
    programs = {
        "a": [Meet("m", (0, 1)), Meet("m", (0, 2))],
        "b": [Meet("m", (0, 1))],
        "c": [None, Meet("m", (0, 2))],
    }
    made, actions = station(programs)
    assert ends(made, actions)


def test_logic_that_never_rests_is_refused() -> None:
    gates = {"a": Gate(GateKind.AND, (Input("plc.a", False), Input("a.x")))}
    made, actions = station({"a": [on("x")], "b": [wait("y")]}, gates=gates)
    with pytest.raises(InputError, match="rest"):
        explore(made, actions)


class Watched(StationClock):
    """A clock that notes how far all robots are whenever something has happened."""

    seen: set[tuple[int, ...]]

    def _settle(self, now: float) -> None:
        super()._settle(now)
        self.seen.add(tuple(robot.next for robot in self._robots.values()))


INPUTS = st.builds(
    Input, st.sampled_from(["a.x", "a.y", "b.x", "b.y", "plc.g", "plc.h", "b.i"]), st.booleans()
)
GATES = st.builds(
    Gate,
    st.sampled_from(GateKind),
    st.lists(INPUTS, min_size=1, max_size=2).map(tuple),
    st.lists(INPUTS, max_size=1).map(tuple),
    st.integers(1, 3),
    st.floats(0.0, 2.0),
)
WIRES = st.builds(
    lambda source, target, delay: Wire(source, target, delay, delay),
    st.sampled_from(["a.x", "a.y", "b.x", "plc.g", "plc.h"]),
    st.sampled_from(["a.i", "a.j", "b.i", "b.j"]),
    st.sampled_from([0.0, 0.3, 1.4, 5.0]),
)
DOINGS = st.one_of(
    st.builds(
        SetSignal,
        st.sampled_from("xy"),
        st.booleans(),
        st.sampled_from([None, None, 0.2, 1.5, 4.0]),
    ),
    st.builds(
        WaitSignal,
        st.builds(Level, st.sampled_from("ij"), st.booleans()),
        st.sampled_from([None, None, None, 2.0]),
    ),
    st.builds(Meet, st.sampled_from("mn")),
    st.none(),
)


@settings(max_examples=120, deadline=None)
@given(
    st.fixed_dictionaries({name: st.lists(DOINGS, max_size=5) for name in "ab"}),
    st.dictionaries(st.sampled_from("gh"), GATES, max_size=2),
    st.lists(WIRES, max_size=4, unique_by=lambda wire: (wire.source, wire.target)),
    st.frozensets(st.sampled_from(["a.x", "b.x", "a.i", "b.i"]), max_size=2),
)
def test_what_the_clock_comes_to_is_among_the_orders(
    programs: dict[str, list[Any]],
    gates: dict[str, Gate],
    wires: list[Wire],
    initial: frozenset[str],
) -> None:
    made, actions = station(programs, wires=tuple(wires), gates=gates, initial=initial)
    clock = Watched(made, actions)
    clock.seen = set()
    try:
        with pytest.MonkeyPatch.context() as patch:
            patch.setattr("flyby.core.station.orders._MOST_STATES", 1000)
            orders = explore(made, actions)
        clock.run()
    except InputError:
        return
    assert clock.seen <= orders.reachable


@settings(max_examples=60, deadline=None)
@given(
    st.fixed_dictionaries({name: st.lists(DOINGS, max_size=5) for name in "ab"}),
    st.dictionaries(st.sampled_from("gh"), GATES, max_size=2),
    st.lists(WIRES, max_size=4, unique_by=lambda wire: (wire.source, wire.target)),
)
def test_what_bears_on_nothing_changes_no_order(
    programs: dict[str, list[Any]], gates: dict[str, Gate], wires: list[Wire]
) -> None:
    """All orders, with the actions that count alone, are those of the actions that count."""
    made, actions = station(programs, wires=tuple(wires), gates=gates)
    count = bearing(made, actions)
    try:
        with pytest.MonkeyPatch.context() as patch:
            patch.setattr("flyby.core.station.orders._MOST_STATES", 2000)
            every, fewer = explore(made, actions), explore(made, count)
    except InputError:
        return
    passed = {
        tuple(
            sum(action in count[name] for action in actions[name][:at])
            for name, at in zip(actions, state, strict=True)
        )
        for state in every.reachable
    }
    assert passed == fewer.reachable
    assert bool(every.stuck) == bool(fewer.stuck)


def test_welding_guns_and_unlinked_inputs_bear_on_nothing() -> None:
    programs = {"a": [on("weld"), off("weld"), on("x"), wait("other")], "b": [wait("y")]}
    made, actions = station(programs, wires=(Wire("a.x", "b.y"),))
    assert [[a.text for a in doings] for doings in bearing(made, actions).values()] == [
        [str(on("x"))],
        [str(wait("y"))],
    ]


@pytest.mark.parametrize("delay", [0.0, 0.1])
def test_signals_that_blink_for_ever_do_not_hold_the_clock(delay: float) -> None:
    gates = {"g": Gate(GateKind.AND, (Input("b.i", False),))}
    wires = (Wire("plc.g", "b.i", delay, delay),)
    made, actions = station({"a": [on("x")], "b": [wait("k")]}, gates=gates, wires=wires)
    clock = StationClock(made, actions)
    if delay > 0.0:
        assert clock.run().duration == 3.0
    else:
        with pytest.raises(InputError, match="never come to rest"):
            clock.run()
