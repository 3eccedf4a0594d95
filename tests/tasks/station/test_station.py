"""Stations of two and three robots whose answers are known."""

from __future__ import annotations

import math
from collections.abc import Sequence
from pathlib import Path

import numpy as np
import pytest

import flyby
from flyby.core.errors import FlybyError, InputError
from flyby.core.station.clearances import StationProver
from flyby.drawing.station import draw_station
from flyby.tasks.station.changing import StationChangeOptions

from .stations import HOMES, UNUSED, Write


def station(file: Path, **options: object):
    return flyby.station(file, **{"no_proof": True, **options})


def test_a_handshake_makes_one_wait_for_the_other(write: Write) -> None:
    made = station(
        write(
            {
                "one": ["go 0", "go 1", "SetDO doDone,1", "go 0"],
                "two": ["go 0", "WaitDI diGo,1", "go 1"],
            },
            '[links]\n"one.doDone" = { to = "two.diGo", delay_ms = [20, 40] }\n',
        )
    )
    ((name, wait),) = made.waits()
    (done,) = (a for a in made.actions["one"])
    assert name == "two" and wait.action.text == "WaitDI diGo,1"
    assert wait.end == pytest.approx(done.time + 0.030)
    two = made.station.members["two"].run.duration
    assert made.duration == pytest.approx(two + wait.end - wait.begin)
    assert made.deadlock is None and not made.may_lock


def test_two_that_wait_for_each_other_are_a_deadlock_with_its_cycle(write: Write) -> None:
    made = station(
        write(
            {
                "one": ["go 0", "go 1", "WaitDI diTwo,1", "SetDO doOne,1", "go 0"],
                "two": ["go 0", "go 1", "WaitDI diOne,1", "SetDO doTwo,1", "go 0"],
            },
            '[links]\n"one.doOne" = "two.diOne"\n"two.doTwo" = "one.diTwo"\n',
        )
    )
    assert made.deadlock is not None and set(made.deadlock.cycle) == {"one", "two"}
    said = str(made.deadlock)
    assert "one waits at WaitDI diTwo,1" in said and "two.mod:" in said
    assert math.isinf(made.duration) and made.may_lock


LOCKS = "".join(
    f'[logic.{own}{k}]\nand = ["{own}.do{k}", "not plc.{other}{k}"]\nto = "{own}.di{k}"\n'
    for own, other in (("one", "two"), ("two", "one"))
    for k in "12"
)
"""Of two things, each for the one that asks first."""


@pytest.mark.parametrize("swings", [False, True])
def test_who_takes_two_things_in_other_orders_may_lock(write: Write, swings: bool) -> None:
    """One takes the first and the second, two the other way round."""
    programs = {
        name: [
            "go 0",
            f"SetDO do{first},1",
            f"WaitDI di{first},1",
            "go 1",
            f"SetDO do{second},1",
            f"WaitDI di{second},1",
            "go 2",
            "SetDO do1,0",
            "SetDO do2,0",
        ]
        for name, first, second in (("one", 1, 2), ("two", 2, 1))
    }
    blinks = '[logic.blink]\ntimer = { of = "not plc.blink", after_ms = 500 }\n'
    file = write(programs, LOCKS + blinks * swings)
    both = station(file)
    assert both.deadlock is not None and both.deadlock.cycle == ("one", "two")
    assert "s on for two; two waits" in str(both.deadlock)
    file.write_text(file.read_text().replace('"two.mod"\n', '"two.mod"\nbegins_s = 20\n'))
    apart = station(file)
    assert apart.deadlock is None and apart.may_lock


def test_what_nobody_sets_any_more_is_said(write: Write) -> None:
    made = station(
        write(
            {
                "one": ["go 0", "SetDO doOne,1", "SetDO doOne,0", "go 1"],
                "two": ["go 0", "go 1", "go 2", "go 0", "WaitDI diOne,1", "go 1"],
            },
            '[links]\n"one.doOne" = "two.diOne"\n',
        )
    )
    assert made.deadlock is not None and not made.deadlock.cycle
    said = str(made.deadlock)
    assert "nobody sets diOne any more; the last such: one at SetDO doOne,1" in said
    assert "one.mod:7" in said and "two.mod:" in said


def test_a_deadlock_that_timing_hides_is_found(write: Write) -> None:
    """Both ask for both halves, in unlike order: a classic."""
    locks = """
[logic.freeA]
latch = { set = ["one.giveA", "two.giveA"], reset = ["one.takeA", "two.takeA"] }
to = ["one.diA", "two.diA"]
[logic.freeB]
latch = { set = ["one.giveB", "two.giveB"], reset = ["one.takeB", "two.takeB"] }
to = ["one.diB", "two.diB"]
"""
    one = ["go 0", "WaitDI diA,1", "SetDO takeA,1", "go 1", "WaitDI diB,1", "SetDO takeB,1", "go 0"]
    give = ["SetDO takeA,0", "SetDO takeB,0", "SetDO giveA,1", "SetDO giveB,1"]
    two = [
        *("go 0", "go 1", "go 2", "go 1", "go 0", "go 1", "go 2"),
        *("WaitDI diB,1", "SetDO takeB,1", "go 1", "WaitDI diA,1", "SetDO takeA,1", "go 0"),
    ]
    made = station(
        write(
            {"one": [*one, *give], "two": [*two, *give]},
            locks,
        )
    )
    assert made.deadlock is not None or made.may_lock


def test_multimove_tasks_meet(write: Write) -> None:
    made = station(
        write(
            {
                "one": ["go 0", "WaitSyncTask s1, all", "go 1", "WaitSyncTask s2, all", "go 0"],
                "two": [
                    *("go 0", "go 1", "go 2", "go 0", "WaitSyncTask s1, all", "go 1"),
                    *("go 0", "WaitSyncTask s2, all"),
                ],
            }
        )
    )
    waits = made.waits()
    assert [(name, wait.action.text) for name, wait in waits] == [
        ("one", "WaitSyncTask s1, all"),
        ("one", "WaitSyncTask s2, all"),
    ]
    assert made.deadlock is None and made.duration < math.inf


def test_a_meeting_that_one_task_lacks_is_named(write: Write) -> None:
    made = station(
        write(
            {
                "one": ["go 0", "WaitSyncTask s1, all", "go 1", "WaitSyncTask s1, all"],
                "two": ["go 0", "WaitSyncTask s1, all", "go 1"],
            }
        )
    )
    assert made.deadlock is not None
    said = str(made.deadlock)
    assert "one waits at WaitSyncTask s1, all" in said and "one.mod:9" in said
    assert "the last such: two at WaitSyncTask s1, all" in said and "two.mod:7" in said


def test_time_outs_end_waits_and_are_noted(write: Write) -> None:
    made = station(
        write(
            {
                "one": ["go 0", "go 1"],
                "two": ["go 0", "WaitDI diNever,1 \\MaxTime:=0.5", "go 1"],
            },
            '[given]\n"two.diNever" = false\n',
        )
    )
    ((name, wait),) = made.waits()
    assert (name, wait.given_up) == ("two", True)
    assert wait.end - wait.begin == pytest.approx(0.5)
    assert any("error handler" in str(note) for note in made.notes)


def test_an_input_without_a_link_holds_nobody_up_and_is_noted(write: Write) -> None:
    made = station(write({"one": ["go 0", "go 1"], "two": ["go 0", "WaitDI diOther,1", "go 1"]}))
    assert not made.waits()
    assert any("diOther: no link sets it" in str(note) for note in made.notes)


def test_an_output_that_is_on_at_the_start_has_its_input_on(write: Write) -> None:
    made = station(
        write(
            {
                "one": ["go 0", "go 1", "SetDO doFree,0", "go 0"],
                "two": ["WaitDI diFree,1", "go 0", "go 1"],
            },
            '[links]\n"one.doFree" = "two.diFree"\n',
            before='initial = ["one.doFree"]\n',
        )
    )
    assert made.deadlock is None and not made.waits()


def test_counters_and_timers_of_the_plc(write: Write) -> None:
    pulses = ["SetDO doPart,1", "go 1", "SetDO doPart,0", "go 0"]
    made = station(
        write(
            {
                "one": ["go 0", *pulses, *pulses, *pulses],
                "two": ["WaitDI diFull,1", "go 0", "go 1"],
            },
            "[logic.full]\ncounter = { of = 'one.doPart', at = 3 }\n"
            "[logic.settled]\ntimer = { of = 'plc.full', after_ms = 250 }\nto = 'two.diFull'\n",
        )
    )
    third = [a for a in made.actions["one"] if a.text == "SetDO doPart,1"][2]
    ((_, wait),) = made.waits()
    assert wait.end == pytest.approx(third.time + 0.25)


def test_the_station_is_as_long_as_its_slowest_robot(write: Write) -> None:
    made = station(write({"one": ["go 0", "go 1"], "two": ["go 0", "go 1", "go 2", "go 0"]}))
    runs = [member.run.duration for member in made.station.members.values()]
    assert made.duration == pytest.approx(max(runs)) and made.bottleneck == "two"


def test_robots_that_share_space_are_named_with_both_lines(write: Write) -> None:
    made = station(
        write({"one": ["go 1", "go 0", "go 2"], "two": ["go 0", "go 1"]}, gap=300.0),
        no_proof=False,
    )
    assert not made.clear
    (finding,) = [f for f in made.findings() if "one's move" in f][:1]
    assert "one.mod:" in finding and "two.mod:" in finding
    assert "(at " in finding and finding.endswith(" s of the station)")
    (pair,) = made.clearances
    assert pair.least < 0.0
    overlap = f"one and two overlap by {-1e3 * pair.least:.1f} mm at {pair.least_at:.3f} s"
    assert overlap in made.findings()
    assert made.pair_rows()[0][2] == "not kept"


def test_the_picture_names_signals_as_they_are_written(write: Write) -> None:
    programs = {"one": ["go 0", "SetDO doLeft,1"], "two": ["WaitDI diFree,1", "go 1"]}
    made = station(write(programs, '[links]\n"one.doLeft" = "two.diFree"\n'))
    drawn = draw_station(made.station, made.run, made.actions, "svg").decode()
    assert "<!-- one.doLeft -->" in drawn and "<!-- two.diFree -->" in drawn


def test_an_interlock_is_proven_or_the_pair_of_moves_is_named(write: Write) -> None:
    """Both turn to the place between them, the second when the first has left it."""
    away = f"MoveAbsJ [[90,0,0,0,30,0],{UNUSED}], v1000, fine, tool0"
    programs = {
        "one": [away, "go 0", away, "SetDO doOut,1"],
        "two": [away, "WaitDI diOut,1", "go 0", away],
    }
    link = '[links]\n"one.doOut" = "two.diOut"\n'
    made = station(write(programs, link, gap=650.0), no_proof=False)
    (pair,) = made.clearances
    assert not pair.any_time.proven and pair.in_time.proven and pair.safe
    open_ones = {**programs, "two": [s for s in programs["two"] if "WaitDI" not in s]}
    made = station(write(open_ones, gap=650.0), no_proof=False)
    (pair,) = made.clearances
    assert not pair.safe and not made.clear


@pytest.mark.parametrize("wait", [0.5, 0.515, 0.53])
def test_the_least_distance_is_met_between_steps_of_fast_robots(write: Write, wait: float) -> None:
    """One stands nearly before two, and later swings past it, where it is nearer for a moment."""
    turn = "MoveAbsJ [[{},0,0,0,30,0]," + UNUSED + "], v5000, fine, tool0"
    one = [turn.format(2), f"WaitTime {wait}", turn.format(91), turn.format(-90)]
    made = station(
        write({"one": one, "two": [turn.format(0), turn.format(0.1)]}, gap=900.0), no_proof=False
    )
    prover = StationProver(made.station, made.actions)
    t = np.arange(0.0, made.duration, 5e-4)
    q = [prover.standing(made.run.schedules[name], t)[0] for name in ("one", "two")]
    dense, at, _ = prover.prover("one", "two").nearest(q[0], q[1])
    assert t[at] > 0.6 and made.clearances[0].least == pytest.approx(dense, abs=2e-5)


def test_who_is_met_while_it_waits_is_met_at_one_time(write: Write) -> None:
    """One stands in the middle and waits; two comes there, and is not said to be late."""
    away, near = (
        f"MoveAbsJ [[{angle},0,0,0,30,0],{UNUSED}], v1000, fine, tool0" for angle in (90, 0)
    )
    programs = {
        "one": [away, near, "WaitDI diGo,1", away],
        "two": [away, "WaitTime 3", near, away, "SetDO doGo,1"],
    }
    file = write(programs, '[links]\n"two.doGo" = "one.diGo"\n', gap=650.0)
    made = station(file, no_proof=False)
    (pair,) = made.clearances
    (conflict,) = pair.in_time.conflicts.values()
    said = made.conflict_said(pair, conflict)
    assert said.endswith(" s of the station)") and "(at 3." in said


def test_robots_are_50_ms_early_or_late_unless_it_is_said() -> None:
    made = flyby.station("examples/two_robots/station.toml")
    assert made.jitter == StationChangeOptions().jitter == pytest.approx(0.05)
    assert made.as_json()["jitter_ms"] == pytest.approx(50.0)
    assert made.pair_rows()[0][2] == "10 mm proven, ± 50 ms"


def test_a_release_that_comes_late_is_found_with_what_it_costs() -> None:
    made = flyby.station("examples/two_robots/station.toml", interlocks=True)
    (saving,) = made.savings
    assert (saving.robot, saving.action.text) == ("left", "SetDO doLeft, 1")
    assert saving.earlier is not None and saving.place > 0.1
    assert 0.5 < saving.seconds <= saving.earlier + 1e-6
    assert made.as_json()["interlocks"][0]["saved_s"] == pytest.approx(saving.seconds)


def test_four_robots_weld_studs_proven_and_quicker_than_with_stops(tmp_path: Path) -> None:
    example = Path("examples/stud_station")
    made = flyby.station(example / "station.toml")
    assert made.clear and not made.may_lock and all(pair.safe for pair in made.clearances)
    shared = [pair.robots for pair in made.clearances if not pair.any_time.proven]
    assert shared == [("a", "b"), ("c", "d")]
    for file in example.iterdir():
        (tmp_path / file.name).write_text(file.read_text().replace("z20", "fine"))
    stops = station(tmp_path / "station.toml").duration
    assert made.duration < 0.85 * stops


def test_a_wait_that_protects_nothing_can_go(write: Write) -> None:
    made = station(
        write(
            {
                "one": ["go 0", "go 1", "go 2", "SetDO doOut,1"],
                "two": ["go 0", "WaitDI diOut,1", "go 1", "go 0"],
            },
            '[links]\n"one.doOut" = "two.diOut"\n',
        ),
        no_proof=False,
        interlocks=True,
    )
    assert made.clear and any(s.earlier is None and s.robot == "two" for s in made.savings)


def test_a_wait_can_go_only_if_it_can_in_every_pass(write: Write) -> None:
    """Who takes the line out takes it out of both passes; only the first could do without."""
    turned = "MoveAbsJ [[{},0,0,0,30,0]," + UNUSED + "], v1000, fine, tool0"
    away, safe, near = turned.format(90), turned.format(110), turned.format(0)
    loop = (
        f"FOR n FROM 1 TO 2 DO\n WaitDI diOut,1;\n IF n=1 THEN\n {safe};\n"
        f" ELSE\n {near};\n ENDIF\n ENDFOR\n WaitTime 0"
    )
    programs = {"one": [away, near, away, "SetDO doOut,1"], "two": [away, loop, away]}
    link = '[links]\n"one.doOut" = "two.diOut"\n'
    made = station(write(programs, link, gap=650.0), no_proof=False, interlocks=True)
    assert made.clear and [wait.action.text for _, wait in made.waits()] == ["WaitDI diOut,1"]
    assert all(saving.earlier is not None for saving in made.savings)


@pytest.mark.parametrize(
    ("rest", "words"),
    [
        ('[links]\n"one.doDoen" = "two.diGo"\n', ("one.doDoen", "one.doDone")),
        ('[links]\n"one.doDone" = "two.diGoo"\n', ("two.diGoo", "two.diGo")),
        ('[links]\n"three.doDone" = "two.diGo"\n', ("three.doDone", "one, two")),
        ('[links]\n"one.doDone" = { to = "two.diGo", delay_ms = [40, 10] }\n', ("delay_ms",)),
        ('[given]\n"two.diGoo" = true\n', ("given", "two.diGoo", "two.diGo")),
        ('[allow]\npairs = [["one.J6", "two.J7"]]\n', ("allow.pairs", "two.J7", "two.J6")),
        ('[allow]\npairs = [["one.gun", "two.J6"]]\n', ("allow.pairs", "one.gun")),
        ('initial = ["one.doDoen"]\n', ("initial", "one.doDoen", "one.doDone")),
        ('[logic.a]\nand = ["plc.b"]\n', ("[logic.b]",)),
        ('[logic.a]\nxor = ["one.doDone"]\n', ("logic.a: needs one of and, or, latch",)),
        ('[logic.a]\nand = ["one.doDoen"]\n', ("logic.a", "one.doDoen", "one.doDone", "[given]")),
        ('[links]\n"one.doDone" = "one.doDone"\n[logic.a]\nand = ["one.doDone"]\n', ("output",)),
        ('[links]\n"two.diGo" = "two.diGo"\n', ("links: two.diGo", "ring", "no output")),
        ('[zone.z]\nsignal = "one.doIn"\nbox_mm = [0,0,0,0,9,9]\n', ("zone.z.box_mm", "space")),
        ("unknown = 1\n", ("unknown",)),
    ],
)
def test_bad_files_are_refused_with_the_place(
    write: Write, rest: str, words: Sequence[str]
) -> None:
    programs = {"one": ["go 0", "go 1", "SetDO doDone,1"], "two": ["go 0", "WaitDI diGo,1", "go 1"]}
    file = write(programs)
    text = file.read_text()
    file.write_text(text + rest if rest.startswith("[") else rest + text)
    with pytest.raises(FlybyError) as caught:
        station(file)
    assert "station.toml" in str(caught.value)
    for word in words:
        assert word in str(caught.value)


def test_two_robots_in_one_place_are_refused(write: Write) -> None:
    with pytest.raises(FlybyError, match="stand at one place"):
        station(write({"one": ["go 0", "go 1"], "two": ["go 0", "go 1"]}, gap=0.0))


def test_logic_that_swings_is_refused(write: Write) -> None:
    file = write(
        {"one": ["go 0", "go 1", "SetDO doDone,1"], "two": ["go 0", "WaitDI diGo,1", "go 1"]},
        "[logic.a]\nand = ['not plc.a']\nto = 'two.diGo'\n",
    )
    with pytest.raises(FlybyError, match="never comes to rest"):
        station(file)


def test_an_output_at_a_fly_by_point_may_come_where_the_zone_begins(write: Write) -> None:
    by = f"MoveAbsJ [{HOMES[1]},{UNUSED}], v1000, z50, tool0"
    made = station(
        write(
            {
                "one": ["go 0", by, "SetDO doBy,1", "go 2", "SetDO doStop,1", "go 0"],
                "two": ["go 0", "WaitDI diGo,1", "WaitDI diOn,1", "go 1"],
            },
            '[links]\n"one.doBy" = "two.diGo"\n"one.doStop" = "two.diOn"\n',
        )
    )
    passing, stopped = made.actions["one"]
    assert passing.soonest < passing.time - 0.01
    assert stopped.soonest == stopped.time


def test_statements_that_nobody_knows_are_no_interlock(write: Write) -> None:
    programs = {
        "one": ["go 0", "SetDO doBusy,1", "go 1", "SetDO\\SDelay:=0.2, doBusy,0", "go 0"],
        "two": ["go 0", "WaitDI diBusy,0", "go 1", 'TPWrite "doBusy"'],
    }
    made = station(write(programs, '[links]\n"one.doBusy" = "two.diBusy"\n'))
    assert made.orders is None
    (note,) = [str(note) for note in made.notes if "not known" in str(note)]
    assert "one.mod:9" in note and "SetDO\\SDelay" in note


def test_targets_in_a_frame_that_another_robot_moves_are_refused(write: Write) -> None:
    """Taken to stand, they would be proven of a path that nobody drives."""
    frames = "[[0,0,0],[1,0,0,0]],[[0,0,0],[1,0,0,0]]"
    held = f'PERS wobjdata wHeld := [FALSE,FALSE,"ROB_2",{frames}]'
    there = "[[900,0,1000],[0,0,1,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]]"
    move = f"MoveJ \\ID:=10, {there}, v100, fine, tool0 \\WObj:=wHeld"
    programs = {
        "one": ["go 0", "SyncMoveOn s1, all", move, "SyncMoveOff s2"],
        "two": ["go 0", "SyncMoveOn s1, all", absolute(1, 10), "SyncMoveOff s2"],
    }
    file = write(programs)
    module = file.parent / "one.mod"
    module.write_text(module.read_text().replace("  PROC main", f"  {held};\n  PROC main"))
    with pytest.raises(InputError, match=r"robot\.one: .*one\.mod:.*move 2: .*wHeld, which ROB_2"):
        station(file)


def absolute(k: int, name: int, zone: str = "fine") -> str:
    """A move to the K-th home that others make with it."""
    return f"MoveAbsJ \\ID:={name}, [{HOMES[k]},{UNUSED}], v1000, {zone}, tool0"


def test_moves_of_one_id_take_what_the_slowest_takes(write: Write) -> None:
    far = f"MoveAbsJ \\ID:=10, [[80,0,0,0,30,0],{UNUSED}], v300, fine, tool0"
    begun, corner = ["go 0", "SyncMoveOn s1, all"], absolute(0, 20, "z10")
    programs = {
        "one": [*begun, absolute(1, 10), corner, absolute(2, 30), "SyncMoveOff s2", "go 0"],
        "two": [*begun, far, corner, absolute(1, 30), "SyncMoveOff s2"],
    }
    made = station(write(programs))
    assert made.deadlock is None and not made.may_lock
    begins, slowest = {}, 0.0
    for name, schedule in made.run.schedules.items():
        run = made.station.members[name].run
        first = run.path.route.moves.index(1)
        spans = np.stack([run.timing.begins()] * 2, -1)
        begins[name] = schedule.clocked(spans)[first : first + 3, 1]
        slowest = max(slowest, run.timing.settled_durations()[first])
    assert begins["one"] == pytest.approx(begins["two"], abs=1e-6)
    assert begins["one"][1] - begins["one"][0] == pytest.approx(slowest, abs=1e-6)
    times = np.linspace(0.0, made.duration, 200)
    schedule = made.run.schedules["one"]
    back = schedule.clocked(np.stack([schedule.own(times)] * 2, -1))
    inside = (times >= back[:, 0] - 1e-6) & (times <= back[:, 1] + 1e-6)
    assert inside[times < schedule.end].all()
    (note,) = [str(note) for note in made.notes if "together" in str(note)]
    assert "one and two make 3 moves together" in note


@pytest.mark.parametrize(
    ("other", "words"),
    [
        ([absolute(1, 10), absolute(0, 20)], ("ID 30", "one.mod:11", "two.mod:7")),
        (
            [absolute(1, 10), absolute(0, 30), absolute(1, 20)],
            ("one.mod:10", "two.mod:9", "order"),
        ),
        ([absolute(1, 10), absolute(0, 20), absolute(1, 30), absolute(0, 30)], ("as many moves",)),
    ],
)
def test_an_id_that_one_task_lacks_is_named_with_both_lines(
    write: Write, other: list[str], words: Sequence[str]
) -> None:
    ids = [absolute(1, 10), absolute(0, 20), absolute(2, 30)]
    file = write(
        {
            "one": ["go 0", "go 0", "SyncMoveOn s1, all", *ids, "SyncMoveOff s2"],
            "two": ["go 0", "SyncMoveOn s1, all", *other, "SyncMoveOff s2"],
        }
    )
    with pytest.raises(FlybyError) as caught:
        station(file)
    for word in ("station.toml", *words):
        assert word in str(caught.value), str(caught.value)


def test_an_id_where_nothing_is_made_together_is_named(write: Write) -> None:
    programs = {
        "one": ["go 0", "SyncMoveOn s1, all", absolute(1, 10), "SyncMoveOff s2"],
        "two": ["go 0", absolute(1, 10)],
    }
    with pytest.raises(FlybyError, match=r"station\.toml: two's move 2 \(.*two\.mod:7.*SyncMoveOn"):
        station(write(programs))


def test_samples_that_seem_too_near_hide_nothing(
    write: Write, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Where a proof contradicts samples, everything behind them is looked at as well."""
    away = f"MoveAbsJ [[90,0,0,0,30,0],{UNUSED}], v1000, fine, tool0"
    programs = {"one": [away, "go 0"], "two": [away, "go 0"]}
    monkeypatch.setattr(StationProver, "_sampled", lambda *_: (0.0, -1.0))
    made = station(write(programs, gap=450.0), no_proof=False)
    assert not made.clearances[0].in_time.proven


def test_a_kuka_and_a_ur_join_hands(tmp_path: Path) -> None:
    axes = "A2 -90,A3 90,A4 0,A5 45,A6 0"
    (tmp_path / "k.src").write_text(
        f"DEF k( )\nPTP {{A1 0,{axes}}}\nPTP {{A1 40,{axes}}}\n$OUT[3]=TRUE\n"
        f"WAIT FOR $IN[5]\nPTP {{A1 0,{axes}}}\nEND\n"
    )
    (tmp_path / "u.script").write_text(
        "def u():\n  movej([0,-1.2,1.6,-1.9,-1.57,0])\n"
        "  while (get_digital_in(0) == False):\n    sync()\n  end\n"
        "  movej([0.8,-1.2,1.6,-1.9,-1.57,0])\n  set_digital_out(2, True)\n"
        "  movej([0,-1.2,1.6,-1.9,-1.57,0])\nend\n"
    )
    (tmp_path / "kuka.toml").write_text('robot = "kuka/kr30-3"\n')
    (tmp_path / "ur.toml").write_text('robot = "ur/ur5e"\nbase = { xyz_mm = [1500, 900, 0] }\n')
    file = tmp_path / "station.toml"
    file.write_text(
        'clearance_mm = 20\n[robot.kuka]\ncell = "kuka.toml"\nprogram = "k.src"\n'
        '[robot.ur]\ncell = "ur.toml"\nprogram = "u.script"\n'
        '[links]\n"kuka.$OUT[3]" = { to = "ur.digital_in[0]", delay_ms = 30 }\n'
        '"ur.digital_out[2]" = "kuka.$IN[5]"\n'
    )
    made = station(file, no_proof=False)
    (first, asked), (second, given) = made.waits()
    assert (first, second) == ("ur", "kuka")
    (out,) = (a for a in made.actions["kuka"] if a.text.startswith("$OUT"))
    assert asked.end == pytest.approx(out.time + 0.030)
    assert given.end > asked.end and made.deadlock is None
    assert made.clear and made.clearances[0].any_time.proven


def test_the_motion_behind_a_motion_sync_of_krl_is_made_together(tmp_path: Path) -> None:
    axes = "A2 -90,A3 90,A4 0,A5 45,A6 0"
    text = "clearance_mm = 20\n"
    for k, (name, far) in enumerate((("left", 20), ("right", 80))):
        (tmp_path / f"{name}.src").write_text(
            f'DEF {name}( )\nPTP {{A1 0,{axes}}}\nSYNCCMD(#MotionSync, "A", 3)\n'
            f"PTP {{A1 {far},{axes}}}\nPTP {{A1 0,{axes}}}\nEND\n"
        )
        base = f"base = {{ xyz_mm = [{9000 * k}, 0, 0] }}"
        (tmp_path / f"{name}.toml").write_text(f'robot = "kuka/kr30-3"\n{base}\n')
        text += f'[robot.{name}]\ncell = "{name}.toml"\nprogram = "{name}.src"\n'
    file = tmp_path / "station.toml"
    file.write_text(text)
    made = station(file)
    assert any("make 1 move together" in str(note) for note in made.notes), made.notes
    drives = {name: member.run for name, member in made.station.members.items()}
    quick, slow = (run.timing.settled_durations()[-2] for run in drives.values())
    assert quick < slow
    ends = made.run.schedules["left"].end
    assert ends == pytest.approx(drives["left"].duration + slow - quick, abs=1e-6)


AWAY = f"MoveAbsJ [[90,0,0,0,30,0],{UNUSED}], v1000, fine, tool0"


@pytest.mark.parametrize(
    "space", ["box_mm = [200, -300, 0, 900, 300, 1500]", "axes_deg = [[1, -60, 60]]"]
)
def test_a_world_zone_is_an_interlock_of_its_own(write: Write, space: str) -> None:
    """Both turn to the place between them; no program sets the output that keeps them apart."""
    programs = {
        "one": [AWAY, "go 0", "WZDOSet \\Stat, wz1 \\Inside, box1, doInside, 1", AWAY],
        "two": [AWAY, "WaitDI diInside,0", "go 0", AWAY],
    }
    rest = '[links]\n"one.doInside" = "two.diInside"\n[zone.middle]\nsignal = "one.doInside"\n'
    rest += f"{space}\n"
    made = station(write(programs, rest, gap=650.0))
    entered, left = (a for a in made.actions["one"] if "middle" in a.text)
    assert (entered.does.value, left.does.value) == (True, False)
    assert entered.soonest < entered.time < left.time
    assert made.orders is not None, made.notes
    late = {
        **programs,
        "two": [*([AWAY] * 1), "WaitDI diInside,1", "WaitDI diInside,0", "go 0", AWAY],
    }
    made = station(write(late, rest, gap=650.0), no_proof=False)
    waits = [spell for name, spell in made.waits() if name == "two"]
    assert waits[-1].end == pytest.approx(
        next(c.time for c in made.run.changes if not c.on), abs=1e-6
    )
    (pair,) = made.clearances
    assert pair.in_time.proven and pair.safe


WORLD_ZONES = """
  CONST pos low := [200,-300,0];
  VAR wzstationary wz1;
  PROC power_on()
    VAR shapedata vol;
    {define}
    WZDOSet \\Stat, wz1 {option}, vol, doInside, {value};
  ENDPROC
  PROC main()"""
BOX = "WZBoxDef \\Inside, vol, low, [900,300,1500];"


@pytest.mark.parametrize(
    ("define", "zone"),
    [
        (BOX, "box_mm = [200, -300, 0, 900, 300, 1500]"),
        ("WZSphDef \\Inside, vol, [350,0,600], 300;", "ball_mm = [350, 0, 600, 300]"),
        (
            "WZCylDef \\Inside, vol, [350,0,1500], 300, -1500;",
            "cylinder_mm = [350, 0, 1500, 300, -1500]",
        ),
        (
            f"WZLimJointDef \\Inside, vol, [[-60,-90,-90,-180,-90,-360],{UNUSED}], "
            f"[[60,90,90,180,90,360],{UNUSED}];",
            "axes_deg = [[1, -60, 60]]",
        ),
        (
            f"WZHomeJointDef \\Inside, vol, [[0,0,0,0,30,0],{UNUSED}], "
            f"[[60,90,90,180,90,360],{UNUSED}];",
            "axes_deg = [[1, -60, 60]]",
        ),
    ],
)
def test_world_zones_of_a_program_are_those_of_the_station_file(
    write: Write, define: str, zone: str
) -> None:
    """They are set up in a routine that nobody calls, and set the output at the same times."""
    programs = {"one": [AWAY, "go 0", AWAY], "two": [AWAY, "WaitDI diInside,0", "go 0", AWAY]}
    links = '[links]\n"one.doInside" = "two.diInside"\n'
    stated = station(write(programs, f'{links}[zone.z]\nsignal = "one.doInside"\n{zone}\n'))
    wanted = [(a.time, a.does.value) for a in stated.actions["one"]]
    assert [on for _, on in wanted] == [True, False]

    def read(option: str = "\\Inside", value: str = "1", defined: str = define) -> object:
        file = write(programs, links)
        module = file.parent / "one.mod"
        set_up = WORLD_ZONES.format(define=defined, option=option, value=value)
        module.write_text(module.read_text().replace("  PROC main()", set_up, 1))
        return station(file)

    made = read()
    assert [(a.time, a.does.value) for a in made.actions["one"]] == wanted
    (note,) = [str(note) for note in made.notes if "world zone" in str(note)]
    assert "doInside" in note and "one.mod:" in note
    outside = read(defined=define.replace("\\Inside", "\\Outside"), value="0")
    assert [(a.time, a.does.value) for a in outside.actions["one"]] == wanted
    early = read("\\Before")
    assert any("\\Before" in str(note) for note in early.notes)


def test_a_world_zone_that_is_calculated_is_said_and_what_it_allows_is_not(write: Write) -> None:
    programs = {"one": [AWAY, "go 0"], "two": ["go 0", "WaitDI diInside,1", "go 1"]}
    file = write(programs, '[links]\n"one.doInside" = "two.diInside"\n')
    module = file.parent / "one.mod"
    define = "WZBoxDef \\Inside, vol, low, Offs(low,1,2,3);"
    set_up = WORLD_ZONES.format(define=define, option="\\Inside", value="1")
    module.write_text(module.read_text().replace("  PROC main()", set_up, 1))
    with pytest.raises(FlybyError, match="doInside: the zone that sets it is not followed: its"):
        station(file)


@pytest.mark.parametrize(
    ("rest", "words"),
    [
        ('signal = "one.doIn"\n', ("box_mm",)),
        ('signal = "doIn"\nbox_mm = [0,0,0,1,1,1]\n', ("left.doInside",)),
        ('signal = "three.doIn"\nbox_mm = [0,0,0,1,1,1]\n', ("three.doIn", "one, two")),
        ('signal = "one.doIn"\naxes_deg = [[9, 0, 1]]\n', ("axes 1 to 6, no axis 9",)),
        ('signal = "one.doIn"\naxes_deg = [[1, 5, 1]]\n', ("[[1, -30, 30]]",)),
        ('signal = "one.doIn"\nball_mm = [0, 0, 0, 0]\n', ("radius",)),
        ('signal = "one.doIn"\ncylinder_mm = [0, 0, 0, 9, 0]\n', ("cylinder_mm", "height")),
    ],
)
def test_bad_zones_are_refused(write: Write, rest: str, words: Sequence[str]) -> None:
    file = write({"one": ["go 0", "go 1"], "two": ["go 0", "go 1"]}, f"[zone.z]\n{rest}")
    with pytest.raises(FlybyError) as caught:
        station(file)
    for word in ("station.toml", *words):
        assert word in str(caught.value), str(caught.value)


def test_what_controllers_may_do_otherwise_is_noted(write: Write) -> None:
    by = f"MoveAbsJ [{HOMES[1]},{UNUSED}], v1000, z50, tool0"
    programs = {
        "one": ["go 0", "SetDO doGo,1", "WaitSyncTask s1, all", "go 1"],
        "two": ["go 0", by, "WaitDI diGo,1", "go 2"],
    }
    made = station(write(programs, '[links]\n"one.doGo" = "two.diGo"\n'))
    notes = [str(note) for note in made.notes]
    assert any("two.mod:8" in note and "passes through the zone" in note for note in notes), notes
    assert any("one.mod:8" in note and "comes to this meeting" in note for note in notes), notes


def test_several_backups_are_opened_at_once(tmp_path: Path) -> None:
    """Two archives of one robot each: robots are called as their files, and where they stand has to
    be said."""
    axes = "A2 -90,A3 90,A4 0,A5 45,A6 0"
    for k, name in enumerate(("left", "right")):
        source = tmp_path / f"{name}.src"
        source.write_text(f"DEF {name}( )\nPTP {{A1 0,{axes}}}\nPTP {{A1 40,{axes}}}\nEND\n")
        cell = tmp_path / f"{name}.toml"
        cell.write_text(f'robot = "kuka/kr30-3"\nbase = {{ xyz_mm = [{9000 * k}, 0, 0] }}\n')
    with pytest.raises(InputError, match="of programs alone nobody says which robots"):
        station([tmp_path / "left.src", tmp_path / "right.src"])
    with pytest.raises(InputError, match="stands for itself"):
        station([tmp_path / "left.toml", tmp_path / "right.src"])


@pytest.mark.parametrize(
    ("statement", "words"),
    [
        ('SYNCCMD(#GeoLink, "A", 3)', r"robot\.right: .*right\.src:3.*#GeoLink.*not followed"),
        ("$BASE=BASE_DATA[2]", r"robot\.right: .*right\.src:4.*BASE_DATA\[2\] is not known"),
    ],
)
def test_nothing_is_proven_of_frames_that_nobody_knows(
    tmp_path: Path, statement: str, words: str
) -> None:
    axes = "A2 -90,A3 90,A4 0,A5 45,A6 0"
    text = ""
    for name, y, line in (("left", -4000, ""), ("right", 0, statement)):
        (tmp_path / f"{name}.src").write_text(
            f"DEF {name}( )\nPTP {{A1 0,{axes}}}\n{line}\n"
            "PTP {X 1400,Y 0,Z 1500,A 0,B 135,C 0}\nEND\n"
            if line
            else f"DEF {name}( )\nPTP {{A1 0,{axes}}}\nPTP {{A1 9,{axes}}}\nEND\n"
        )
        base = f"base = {{ xyz_mm = [0, {y}, 0] }}"
        (tmp_path / f"{name}.toml").write_text(f'robot = "kuka/kr30-3"\n{base}\n')
        text += f'[robot.{name}]\ncell = "{name}.toml"\nprogram = "{name}.src"\n'
    file = tmp_path / "station.toml"
    file.write_text(text)
    with pytest.raises(InputError, match=words):
        station(file, no_proof=False)


def test_a_tool_that_nobody_knows_is_refused_until_it_is_answered(
    write: Write, tmp_path: Path
) -> None:
    at = "MoveL [[%d,0,500],[0,0,1,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]],v100,fine,tHand"
    file = write({"one": ["go 0", at % 300, at % 330], "two": ["go 0", "go 1"]})
    refused = r"robot\.one: .*one\.mod:7.*tHand is not known: nothing"
    with pytest.raises(InputError, match=refused):
        station(file, no_proof=False)
    with pytest.raises(InputError, match=refused):
        flyby.station_zones(file)
    tool = '[values]\ntHand = "[TRUE,[[0,0,50],[1,0,0,0]],[1,[0,0,20],[1,0,0,0],0,0,0]]"\n'
    (tmp_path / "answers.toml").write_text(tool)
    file.write_text(
        file.read_text().replace('"one.mod"\n', '"one.mod"\nanswers = "answers.toml"\n')
    )
    station(file)
