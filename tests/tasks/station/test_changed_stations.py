"""Programs of a station that are improved beside each other."""

from __future__ import annotations

import shutil
from collections.abc import Sequence
from pathlib import Path

import pytest

import flyby
from flyby.core.errors import FlybyError

EXAMPLE = Path("examples/two_robots")
UNUSED = "[9E9,9E9,9E9,9E9,9E9,9E9]"
DOWN = {"left": "[0,0,1,0]", "right": "[0,1,0,0]"}


def go(robot: str, x: float, y: float, zone: str, z: float = 1000.0) -> str:
    return f"MoveL [[{x},{y},{z}],{DOWN[robot]},[0,0,0,0],{UNUSED}], v500, {zone}, rod"


def write(folder: Path, programs: dict[str, Sequence[str]], rest: str = "") -> Path:
    """A station of the two robots of the example, 3.3 m apart, with rods that point down."""
    text = f"clearance_mm = 20 # of each other\n{rest}"
    for name, statements in programs.items():
        shutil.copy(EXAMPLE / f"{name}.toml", folder)
        lines = ";\n    ".join(["ConfJ \\Off", "ConfL \\Off", *statements])
        (folder / f"{name}.mod").write_text(
            f"MODULE {name}\n  PERS tooldata rod := [TRUE,[[0,0,300],[1,0,0,0]],"
            "[20,[0,0,150],[1,0,0,0],0,0,0]];\n"
            f"  PROC main()\n    {lines};\n  ENDPROC\nENDMODULE\n"
        )
        text += f"[robot.{name}]\ncell = '{name}.toml'\nprogram = \"{name}.mod\" # its own\n"
    file = folder / "station.toml"
    file.write_text(text)
    return file


def round_the_other(zone: str = "z1") -> dict[str, Sequence[str]]:
    """The left rod goes round the right one, which stands: a large zone cuts towards it."""
    return {
        "left": [
            go("left", 1480, -450, "fine"),
            go("left", 1300, 0, zone),
            go("left", 1480, 450, "fine"),
        ],
        "right": [
            go("right", 1650, 0, "fine"),
            go("right", 1650, 0, "fine", 1010),
            go("right", 1650, 0, "fine"),
        ],
    }


@pytest.fixture
def station(tmp_path: Path) -> Path:
    return write(tmp_path, round_the_other())


def test_zones_end_where_another_robot_stands(station: Path, tmp_path: Path) -> None:
    left = flyby.read(tmp_path / "left.mod", cell=tmp_path / "left.toml")
    alone = flyby.zones(left).zones[0].after
    made = flyby.station_zones(station)
    beside = made.solutions["left"].zones[0].after
    assert 0.01 < beside.tcp < 0.9 * alone.tcp
    assert made.after.duration < made.before.duration and made.proven
    out = tmp_path / "out"
    flyby.write(made, out)
    again = flyby.station(out / "station.toml")
    assert again.clear and again.duration == pytest.approx(made.after.duration, abs=1e-6)
    text = (tmp_path / "left.mod").read_text()
    before, after = text.split("\n"), (out / "left/left.mod").read_text().split("\n")
    gone = [line for line in before if line not in after]
    assert len(gone) == 1 and "z1, rod" in gone[0]
    assert (out / "right/right.mod").read_bytes() == (tmp_path / "right.mod").read_bytes()
    assert "# of each other" in (out / "station.toml").read_text()


def test_what_does_not_keep_clear_is_not_improved(tmp_path: Path) -> None:
    programs = round_the_other()
    programs["left"] = [line.replace("[1300,0", "[1400,0") for line in programs["left"]]
    with pytest.raises(FlybyError, match=r"(?s)do not keep clear.*left\.mod.*right\.mod"):
        flyby.station_zones(write(tmp_path, programs))


def test_places_that_cannot_be_changed_are_refused_before_work_begins(tmp_path: Path) -> None:
    """Else the new station file would name the programs as they were."""
    file = write(tmp_path, round_the_other())
    head, *robots = file.read_text().split("[robot.")
    inline = [
        f"{name} = {{ cell = '{name}.toml', program = '{name}.mod' }}\n"
        for name in (robot.partition("]")[0] for robot in robots)
    ]
    file.write_text("".join([head, "[robot]\n", *inline]))
    assert flyby.station(file, no_proof=True).duration > 0.0
    with pytest.raises(FlybyError, match=r"left's program .* below \[robot\.left\]"):
        flyby.station_zones(file)


def test_options_say_of_which_robot(station: Path) -> None:
    with pytest.raises(FlybyError, match=r"keep 2: of which robot\? Write left\.2"):
        flyby.station_zones(station, keep=["2"])
    made = flyby.station_zones(station, keep=["left.2"])
    assert not made.changed
    with pytest.raises(FlybyError, match="left: keep 9: the program has moves 1 to 3"):
        flyby.station_zones(station, keep=["left.9"])
    with pytest.raises(FlybyError, match="nowhere"):
        flyby.station_zones(station, keep=["nowhere"])


def test_robots_that_would_wait_drive_slower(tmp_path: Path) -> None:
    """The left one ends early, the right one waits for it first: what it drives then is no slower
    than what the wait leaves."""
    made = flyby.station_optimize(EXAMPLE / "station.toml", zones_only=True)
    before, after = made.before, made.after
    assert after.duration < 0.98 * before.duration
    fastest = [
        abs(s.station.members["left"].run.trajectory.dq[-200:]).max() for s in (before, after)
    ]
    assert fastest[1] < 0.7 * fastest[0]
    assert after.run.schedules["left"].end <= after.duration
    (spell,) = after.run.schedules["right"].waits
    assert spell.end < before.run.schedules["right"].waits[0].end
    flyby.write(made, tmp_path / "out")
    again = flyby.station(tmp_path / "out/station.toml")
    assert again.clear and again.duration == pytest.approx(after.duration, abs=1e-6)
    quick = flyby.station_optimize(EXAMPLE / "station.toml", zones_only=True, full_speed=True)
    assert quick.after.duration == pytest.approx(after.duration, rel=1e-3)
    assert quick.after.run.schedules["left"].end < after.run.schedules["left"].end - 1.0


def test_a_robot_comes_slower_to_a_wait(tmp_path: Path) -> None:
    """The second drives to a wait in a second, and may go on after three."""
    left = [go("left", 1300, (-1) ** k * 300, "fine") for k in range(3)]
    right = [go("right", 2050, 300, "fine"), go("right", 2050, 0, "fine"), "WaitDI diGo, 1"]
    programs = {"left": [*left, "SetDO doGo, 1"], "right": [*right, go("right", 2050, 300, "fine")]}
    file = write(tmp_path, programs)
    file.write_text(file.read_text() + '[links]\n"left.doGo" = "right.diGo"\n')
    made = flyby.station_optimize(file, zones_only=True)
    (before,), (after,) = (
        [s for s in state.run.schedules["right"].waits if s.end > s.begin]
        for state in (made.before, made.after)
    )
    assert after.end - after.begin < 0.5 * (before.end - before.begin)
    assert made.after.duration <= made.before.duration
