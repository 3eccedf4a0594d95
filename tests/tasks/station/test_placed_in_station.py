"""A base for one robot of a station, beside the others."""

from __future__ import annotations

import re
import shutil
from dataclasses import replace
from pathlib import Path

import pytest

import flyby
from flyby.core.errors import FlybyError
from flyby.core.motion.emulator.controller import Controller
from flyby.core.spatial.pose import Pose
from flyby.tasks.setup import setup_of_program, start_of
from flyby.tasks.station.changing import feasibility_of
from flyby.tasks.station.opening import open_station

EXAMPLE = Path("examples/two_robots")
STATION = EXAMPLE / "station.toml"


def test_the_base_found_holds_in_the_station(tmp_path: Path) -> None:
    made = flyby.station_place(STATION, of="left", room=(0.3, 0.2))
    assert made.proven and made.found.before is not None and made.found.best is not None
    assert made.found.best.run.duration < made.found.before.run.duration
    folder = shutil.copytree(EXAMPLE, tmp_path / "station")
    cell = folder / "left.toml"
    text = re.sub(r"(?m)^base = .*\n", "", cell.read_text("utf-8"))
    cell.write_text(text.replace("\n", f"\n{made.line}\n", 1), "utf-8")
    before, after = flyby.station(STATION), flyby.station(folder / "station.toml")
    assert after.duration <= before.duration + 1e-6 and after.clear
    at = after.station.members["left"].cell.robot.base.position
    assert at == pytest.approx(made.base.position if made.base else None, abs=1e-6)


def test_a_base_in_the_other_robots_way_does_not_hold() -> None:
    opened = open_station(STATION, lambda _: None)
    feasibility = feasibility_of(opened, 0.05, lambda _: None)
    member = opened.station.members["left"]
    vendor = replace(setup_of_program(member.program).vendor, nearest=True)
    x, y, z = member.cell.robot.base.position

    def said(dx: float, dy: float) -> str:
        robot = member.cell.robot.with_base(Pose((x + dx, y + dy, z)))
        controller = Controller(vendor, robot)
        found = feasibility.placed(
            "left", controller, controller.run(member.program, start_of(member.program))
        )
        return "" if found is None else found.message

    assert said(0.0, 0.0) == ""
    assert said(0.0, -0.9) == "the station would take longer"
    assert re.match("left's J2 and right's rod come to .* mm: left's move 3", said(2.1, -1.3))


@pytest.mark.parametrize(
    ("options", "words"),
    [({}, "left, right"), ({"of": "lefd"}, "'left'"), ({"of": "left", "robot": "x"}, "robot")],
)
def test_what_is_no_robot_of_the_station_is_refused(options: dict[str, str], words: str) -> None:
    with pytest.raises(FlybyError, match=words):
        flyby.station_place(STATION, **options)
