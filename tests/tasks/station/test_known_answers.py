"""Scenes of two robots whose answers are known: where they meet, wait for ever, or keep apart.

Two IRB 120 face each other, 0.65 m apart. `IN` brings one to the place between them, `OUT` turns it
away: both in is a collision, one in is none.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import flyby
from flyby.core.errors import FlybyError, InputError
from flyby.core.station.orders import Orders, explore
from flyby.problems.improve.station import feasibility

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


RAIL = """
[external_axis.rail]
role = "track"
kind = "prismatic"
axis = "y"
range_mm = [-3000, 3000]
speed_mm_s = 1000
acceleration_mm_s2 = 2000
"""


@pytest.mark.parametrize(("stands", "clear"), [(0, False), (1500, True)])
def test_a_rail_carries_an_arm_past_another(write: Write, stands: float, clear: bool) -> None:
    """The arm points at where the other stands; the rail brings it past, or ends before."""

    def rail(y: float) -> str:
        return f"MoveAbsJ [[0,0,0,0,30,0],[{y},9E9,9E9,9E9,9E9,9E9]], v1000, fine, tool0"

    file = write({"one": [rail(2900), rail(stands), rail(2900)], "two": [IN, IN]}, gap=650.0)
    cell = file.parent / "one.toml"
    cell.write_text(cell.read_text() + RAIL)
    made = flyby.station(file)
    (pair,) = made.clearances
    assert pair.any_time.proven == clear and pair.in_time.proven == clear
    if not clear:
        assert pair.least < 0.0
        (conflict,) = list(pair.in_time.conflicts.values())[:1]
        assert conflict.moves[0] == 1


def test_a_rail_is_watched_in_mm(write: Write) -> None:
    """It is where the output is set at the programmed speed, and no angle."""
    by = "MoveAbsJ [[0,0,0,0,30,0],[{},9E9,9E9,9E9,9E9,9E9]], v1000, fine, tool0"
    zone = '[zone.z]\nsignal = "one.doFar"\n'
    programs = {"one": [by.format(0), by.format(1000), by.format(0)], "two": [IN, IN]}

    def opened(ranges: str) -> flyby.DrivenStation:
        file = write(programs, zone + ranges, gap=3000.0)
        cell = file.parent / "one.toml"
        cell.write_text(cell.read_text() + RAIL)
        return flyby.station(file, no_proof=True)

    made = opened("axes_mm = [[7, 400, 3000]]\n")
    times = [action.time for action in made.actions["one"]]
    run = made.station.members["one"].run
    places = [np.interp(time, run.trajectory.t, run.trajectory.q[:, 6]) for time in times]
    assert places == pytest.approx([0.4, 0.4], abs=2e-3)
    for ranges, said in (
        ("axes_deg = [[7, 400, 3000]]\n", "axis 7, rail, is given as axes_mm"),
        ("axes_mm = [[1, 0, 30]]\n", "axis 1, J1, is given as axes_deg"),
    ):
        with pytest.raises(InputError, match=said):
            opened(ranges)


def test_two_arms_hold_one_part(tmp_path: Path) -> None:
    """A bar, held by the one, lies in the other's gripper; both move it along, one programmed at
    half the speed."""
    text = 'clearance_mm = 5\n[allow]\npairs = [["one.bar", "two.J6"], ["one.bar", "two.J5"]]\n'
    for name, y, speed in (("one", 0, "v200"), ("two", 450, "v100")):
        tool = "bar" if name == "one" else "tool0"
        line = "MoveL \\ID:={}, [[420,{},{}],[0,0,1,0],[0,0,0,0],{}], {}, fine, {}"
        moves = [line.format(10 * k, y, z, UNUSED, speed, tool) for k, z in ((1, 450), (2, 350))]
        first = f"MoveJ [[420,{y},350],[0,0,1,0],[0,0,0,0],{UNUSED}], v200, fine, {tool}"
        begun = ["ConfJ \\Off", "ConfL \\Off", first, "SyncMoveOn s1, all"]
        body = ";\n    ".join([*begun, *moves, "SyncMoveOff s2"])
        (tmp_path / f"{name}.mod").write_text(
            f"MODULE {name}\n  VAR syncident s1;\n  VAR syncident s2;\n"
            '  PERS tasks all{2} := [["T1"],["T2"]];\n'
            "  PERS tooldata bar := [TRUE,[[0,0,0],[1,0,0,0]],[1,[0,0,20],[1,0,0,0],0,0,0]];\n"
            f"  PROC main()\n    {body};\n  ENDPROC\nENDMODULE\n"
        )
        cell = f'robot = "abb/irb120-3-058"\nbase = {{ xyz_mm = [0, {y}, 0] }}\n'
        if name == "one":
            cell += (
                "[tool.bar]\nbox_mm = [30, 400, 20]\npose = { xyz_mm = [0, 200, 15] }\n"
                "tcp = { xyz_mm = [0, 0, 0] }\n[allow]\npairs = [['J5', 'bar']]\n"
            )
        (tmp_path / f"{name}.toml").write_text(cell)
        text += f'[robot.{name}]\ncell = "{name}.toml"\nprogram = "{name}.mod"\n'
    file = tmp_path / "station.toml"
    file.write_text(text)
    made = flyby.station(file)
    (pair,) = made.clearances
    assert pair.in_time.proven, made.findings()
    ends = [schedule.end for schedule in made.run.schedules.values()]
    assert ends[0] == pytest.approx(ends[1], abs=1e-6)
    t = np.linspace(0.0, made.duration, 500)
    heights = []
    for name, schedule in made.run.schedules.items():
        trajectory = made.station.members[name].run.trajectory
        heights.append(np.interp(schedule.own(t), trajectory.t, trajectory.position[:, 2]))
    assert abs(heights[0] - heights[1]).max() < 0.01


def carried_by_both(folder: Path, *, apart: float = 0.0, rest: str = "") -> Path:
    """A bar that the one takes lies in the other's hand as well, and both lift it together."""
    text = "clearance_mm = 5\n[allow]\n"
    text += 'pairs = [["one.bar", "two.J6"], ["one.bar", "two.J5"]]\n'
    for name, y, speed in (("one", 0, "v200"), ("two", 450, "v100")):
        line = "MoveL \\ID:={}, [[420,{},{}],[0,0,1,0],[0,0,0,0],{}], {}, fine, tool0"
        off = apart if name == "two" else 0.0
        moves = [
            line.format(10, y + off, 450, UNUSED, speed),
            line.format(20, y, 350, UNUSED, speed),
        ]
        first = f"MoveJ [[420,{y},350],[0,0,1,0],[0,0,0,0],{UNUSED}], v200, fine, tool0"
        above = f"MoveJ [[400,{y},360],[0,0,1,0],[0,0,0,0],{UNUSED}], v200, fine, tool0"
        begun = ["ConfJ \\Off", "ConfL \\Off", above, first, "SetDO grip, 1", "SyncMoveOn s1, all"]
        body = ";\n    ".join([*begun, *moves, "SyncMoveOff s2", "SetDO grip, 0"])
        (folder / f"{name}.mod").write_text(
            f"MODULE {name}\n  VAR syncident s1;\n  VAR syncident s2;\n"
            '  PERS tasks all{2} := [["T1"],["T2"]];\n'
            f"  PROC main()\n    {body};\n  ENDPROC\nENDMODULE\n"
        )
        cell = f'robot = "abb/irb120-3-058"\nbase = {{ xyz_mm = [0, {y}, 0] }}\n'
        if name == "one":
            cell += (
                '[[part]]\nname = "bar"\nbox_mm = [30, 400, 20]\nmass_kg = 1\n'
                "pose = { xyz_mm = [420, 225, 335] }\nattach = 'grip, 1'\nrelease = 'grip, 0'\n"
            )
        (folder / f"{name}.toml").write_text(cell)
        text += f'[robot.{name}]\ncell = "{name}.toml"\nprogram = "{name}.mod"\n'
    file = folder / "station.toml"
    file.write_text(text + rest)
    return file


HELD = '[[held_together]]\npart = "one.bar"\nby = "two"\n'


def test_two_arms_carry_one_part(tmp_path: Path) -> None:
    """Both hands stay where they took it, though one is programmed at half the speed."""
    made = flyby.station(carried_by_both(tmp_path, rest=HELD))
    (pair,) = made.clearances
    assert pair.in_time.proven, made.findings()
    first = made.station.members["one"].run.timing.begins()[-2]
    begin = made.run.schedules["one"].clocked(np.array([[first, first]]))[0, 1]
    t = np.linspace(begin, made.duration, 300)
    heights = []
    for name, schedule in made.run.schedules.items():
        trajectory = made.station.members[name].run.trajectory
        heights.append(np.interp(schedule.own(t), trajectory.t, trajectory.position[:, 2]))
    assert abs(heights[0] - heights[1]).max() < 1e-3


@pytest.mark.parametrize(
    ("apart", "rest", "words"),
    [
        (20.0, HELD, r"two's move 3 .*two\.mod:.*moves its hand by 20\.\d mm .*one\.mod:"),
        (0.0, HELD.replace("one.bar", "one.rod"), "unknown part of the cell of one 'rod'.*bar"),
        (0.0, HELD.replace('"two"', '"one"'), "by"),
        (0.0, HELD.replace("one.bar", "bar"), "names a part of a robot's cell"),
    ],
)
def test_what_two_arms_cannot_carry_is_refused(
    tmp_path: Path, apart: float, rest: str, words: str
) -> None:
    with pytest.raises(InputError, match=words):
        flyby.station(carried_by_both(tmp_path, apart=apart, rest=rest), no_proof=True)


def test_an_output_comes_as_early_as_it_may(write: Write) -> None:
    """The first drives on for a while before it lets the second in: the output moves up to where it
    has turned away, and no farther."""
    one = [OUT, IN, OUT, BACK, OUT, BACK, "SetDO done, 1", OUT]
    file = write({"one": one, "two": [OUT, "WaitDI go, 1", IN, OUT]}, ONE_TO_TWO, gap=650.0)
    kept = flyby.station_optimize(file, zones_only=True, full_speed=True)
    assert not kept.changed
    with pytest.raises(FlybyError, match=r"release: .*one\.dnoe.*one\.done"):
        flyby.station_optimize(file, zones_only=True, release=["one.dnoe"])
    made = flyby.station_optimize(file, zones_only=True, full_speed=True, release=["one.done"])
    (text,) = [f.text for f in made.solutions["one"].texts.values()]
    moves = [line.strip() for line in text.split("\n") if "MoveAbsJ" in line or "SetDO" in line]
    assert moves == [f"{line};" for line in (OUT, IN, OUT, "SetDO done, 1", BACK, OUT, BACK, OUT)]
    assert made.after.duration < made.before.duration - 0.3 and made.proven
    flyby.write(made, file.parent / "out")
    again = flyby.station(file.parent / "out/station.toml")
    assert again.duration == pytest.approx(made.after.duration, abs=1e-6)
    (pair,) = again.clearances
    assert pair.safe and not pair.any_time.proven


def test_an_output_that_is_early_enough_stays(write: Write) -> None:
    one = [OUT, IN, OUT, "SetDO done, 1", BACK]
    file = write({"one": one, "two": [OUT, "WaitDI go, 1", IN, OUT]}, ONE_TO_TWO, gap=650.0)
    made = flyby.station_optimize(file, zones_only=True, full_speed=True, release=["one.done"])
    assert not made.changed


@pytest.mark.parametrize(
    "behind",
    [
        (f"IF 1 = 1 THEN\n {OUT};\n {BACK};\n ENDIF", "SetDO done, 1"),
        (OUT, BACK, "IF 1 = 1 THEN\n SetDO done, 1;\n ENDIF"),
        (OUT, BACK, "SetDO done, 1; SetDO other, 1"),
    ],
    ids=["into a block", "out of a block", "with what is not to move"],
)
def test_an_output_stays_on_its_own_condition(write: Write, behind: tuple[str, ...]) -> None:
    """Moved into a block it would not be set where the block is left out, and the other way."""
    one = [OUT, IN, OUT, BACK, *behind, OUT]
    file = write({"one": one, "two": [OUT, "WaitDI go, 1", IN, OUT]}, ONE_TO_TWO, gap=650.0)
    made = flyby.station_optimize(file, zones_only=True, full_speed=True, release=["one.done"])
    assert not made.changed


def test_an_output_moves_past_comments_and_from_the_first_column(write: Write) -> None:
    one = [OUT, IN, OUT, BACK, "! away\n  WaitTime 0.1", OUT, BACK, "! free\nSetDO done, 1", OUT]
    file = write({"one": one, "two": [OUT, "WaitDI go, 1", IN, OUT]}, ONE_TO_TWO, gap=650.0)
    made = flyby.station_optimize(file, zones_only=True, full_speed=True, release=["one.done"])
    assert made.after.duration < made.before.duration - 0.3 and made.proven


def test_what_is_not_known_to_keep_apart_is_not_taken(
    write: Write, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Orders of a changed program that are not known: interlocks prove nothing of it."""
    one = [OUT, IN, OUT, BACK, OUT, BACK, "SetDO done, 1", OUT]
    file = write({"one": one, "two": [OUT, "WaitDI go, 1", IN, OUT]}, ONE_TO_TWO, gap=650.0)
    asked = []

    def once(*given: Any) -> Orders:
        asked.append(given)
        if len(asked) > 1:
            raise InputError("too many orders")
        return explore(*given)

    monkeypatch.setattr(feasibility, "explore", once)
    made = flyby.station_optimize(file, zones_only=True, full_speed=True, release=["one.done"])
    assert len(asked) > 1 and not made.changed
