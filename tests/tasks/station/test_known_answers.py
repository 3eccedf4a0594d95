"""Scenes of two robots whose answers are known: where they meet, wait for ever, or keep apart.

Two IRB 120 face each other, 0.65 m apart. `IN` brings one to the place between them, `OUT` turns it
away: both in is a collision, one in is none.
"""

from __future__ import annotations

from dataclasses import dataclass, field

import pytest

import flyby

from .stations import UNUSED, Write

IN = f"MoveAbsJ [[0,0,0,0,30,0],{UNUSED}], v1000, fine, tool0"
OUT = f"MoveAbsJ [[90,0,0,0,30,0],{UNUSED}], v1000, fine, tool0"
BACK = f"MoveAbsJ [[120,0,0,0,30,0],{UNUSED}], v1000, fine, tool0"
MUTEX = """
[logic.one_has]
and = ["one.ask", "not plc.two_has"]
to = "one.has"
[logic.two_has]
and = ["two.ask", "not plc.one_has"]
to = "two.has"
"""
TAKE, GIVE = ["SetDO ask, 1", "WaitDI has, 1"], ["SetDO ask, 0", "WaitDI has, 0"]


@dataclass(frozen=True)
class Scene:
    """A station and what is known of it.

    Args:
        one, two: statements of the two programs.
        rest: of the station file.
        ends: whether this run ends.
        in_time, any_time, safe: what is proven of the two; safe in every order of the signals.
        may_lock: whether some order ends in a deadlock.
        later: s after which the second begins.
    """

    one: list[str]
    two: list[str]
    rest: str = ""
    ends: bool = True
    in_time: bool = True
    any_time: bool = False
    safe: bool = True
    may_lock: bool = False
    later: float = 0.0
    gap: float = field(default=650.0)


def both(signal: str) -> str:
    """Links of a signal of each to the other."""
    return f'[links]\n"one.{signal}" = "two.other"\n"two.{signal}" = "one.other"\n'


ONE_TO_TWO = '[links]\n"one.done" = "two.go"\n'
SCENES = {
    "crossing at one instant": Scene([OUT, IN, OUT], [OUT, IN, OUT], in_time=False, safe=False),
    "crossing one after the other": Scene([OUT, IN, OUT], [OUT, IN, OUT], safe=False, later=4.0),
    "never near": Scene([OUT, IN, OUT], [OUT, IN, OUT], any_time=True, gap=3000.0),
    "turned away": Scene([OUT, BACK, OUT], [OUT, BACK, OUT], any_time=True),
    "a handshake": Scene(
        [OUT, IN, OUT, "SetDO done, 1"], [OUT, "WaitDI go, 1", IN, OUT], ONE_TO_TWO
    ),
    "a handshake given before it is left": Scene(
        [OUT, IN, "SetDO done, 1", OUT],
        [OUT, "WaitDI go, 1", IN, OUT],
        ONE_TO_TWO,
        safe=False,
    ),
    "a handshake that deadlocks": Scene(
        [OUT, "WaitDI other, 1", IN, OUT, "SetDO done, 1"],
        [OUT, "WaitDI other, 1", IN, OUT, "SetDO done, 1"],
        both("done"),
        ends=False,
        may_lock=True,
    ),
    "a place that the PLC gives to one": Scene(
        [OUT, *TAKE, IN, OUT, *GIVE], [OUT, *TAKE, IN, OUT, *GIVE], MUTEX
    ),
    "a place that is asked for twice, and the old answer taken for the new": Scene(
        [OUT, *TAKE, IN, OUT, GIVE[0], *TAKE, IN, OUT, *GIVE],
        [OUT, *TAKE, IN, OUT, *GIVE],
        MUTEX,
        safe=False,
        later=6.0,
    ),
    "looked, then taken: both may see it free": Scene(
        [OUT, "WaitDI other, 0", "SetDO busy, 1", IN, OUT, "SetDO busy, 0"],
        [OUT, "WaitDI other, 0", "SetDO busy, 1", IN, OUT, "SetDO busy, 0"],
        both("busy"),
        safe=False,
        later=4.0,
    ),
    "a swap without a place to go: the second comes while the first is in": Scene(
        [OUT, IN, "SetDO done, 1", "WaitDI other, 1", OUT],
        [OUT, "WaitDI other, 1", IN, OUT, "SetDO done, 1"],
        both("done"),
        in_time=False,
        safe=False,
    ),
    "meetings keep them apart": Scene(
        [OUT, IN, OUT, "WaitSyncTask s1, all", "WaitSyncTask s2, all"],
        [OUT, "WaitSyncTask s1, all", IN, OUT, "WaitSyncTask s2, all"],
    ),
    "a meeting that one does not come to": Scene(
        [OUT, IN, OUT, "WaitSyncTask s1, all", "WaitSyncTask s1, all"],
        [OUT, "WaitSyncTask s1, all", IN, OUT],
        ends=False,
        may_lock=True,
    ),
}


@pytest.mark.parametrize("name", SCENES)
def test_scenes(write: Write, name: str) -> None:
    scene = SCENES[name]
    file = write({"one": scene.one, "two": scene.two}, scene.rest, gap=scene.gap)
    text = file.read_text()
    file.write_text(text.replace("[robot.two]\n", f"[robot.two]\nbegins_s = {scene.later}\n"))
    made = flyby.station(file)
    (pair,) = made.clearances
    found = {
        "ends": made.deadlock is None,
        "in_time": pair.in_time.proven,
        "any_time": pair.any_time.proven,
        "safe": pair.safe,
        "may_lock": made.may_lock,
    }
    assert found == {key: getattr(scene, key) for key in found}
    assert made.clear == scene.in_time
    if not scene.in_time:
        assert any("one.mod:" in said and "two.mod:" in said for said in made.findings())
