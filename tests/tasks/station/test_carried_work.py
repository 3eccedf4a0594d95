"""Robots that work on what another one turns: MultiMove with a positioner."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from hypothesis import HealthCheck, example, given, settings
from hypothesis import strategies as st

import flyby
from flyby.core.arrays import FloatArray
from flyby.core.collision.scene.scene import CollisionScene
from flyby.core.errors import FlybyError
from flyby.tasks.results.stations import DrivenStation

from .positioner_scene import X, turn, weld, write_station

ON, OFF, MET = "SyncMoveOn s1, all", "SyncMoveOff s2", "WaitSyncTask s3, all"
ABOVE = "MoveAbsJ [[0,0,0,0,90,0],[9E9,9E9,9E9,9E9,9E9,9E9]], v500, fine, torch"
ALLOWED = '[allow]\npairs = [["one.torch", "table.disc"]]\n'


def joints_at(made: DrivenStation, name: str, t: FloatArray) -> FloatArray:
    """(T, N), where a robot is at times of the station."""
    trajectory, own = made.station.members[name].run.trajectory, made.run.schedules[name].own(t)
    return np.stack([np.interp(own, trajectory.t, q) for q in trajectory.q.T], -1)


def on_the_table(made: DrivenStation, name: str, t: FloatArray) -> FloatArray:
    """(T, 3) m, a robot's torch on the table, of the joints of the arm and of the table alone."""
    robot = flyby.robot("abb/irb120-3-058").with_base(made.station.members[name].cell.robot.base)
    R, p = robot.forward(joints_at(made, name, t)[:, :6])
    tip = p + R @ np.array([0.0, 0.0, 0.12])
    angle = joints_at(made, "table", t)[:, 6]
    x, y, z = (tip - np.array([1e-3 * X, 0.0, 0.2])).T
    c, s = np.cos(angle), np.sin(angle)
    return np.stack([c * x + s * y, c * y - s * x, z], -1)


def block(made: DrivenStation, name: str, first: int, last: int) -> FloatArray:
    """Times of the station from one move to another, ends left out."""
    run = made.station.members[name].run
    k, j = (run.path.route.moves.index(move) for move in (first, last))
    begins, lengths = run.timing.begins(), run.timing.settled_durations()
    edges = begins[k], begins[j] + lengths[j]
    begin, end = made.run.schedules[name].clocked(np.stack([edges] * 2, -1))[:, 1]
    return np.linspace(begin, end, 200)[1:-1]


def off_line(points: FloatArray, a: Sequence[float], b: Sequence[float]) -> FloatArray:
    """mm from the line through two points in mm."""
    start, along = np.array(a), np.subtract(b, a)
    along = along / np.linalg.norm(along)
    off = 1e3 * points - start
    return np.linalg.norm(off - (off @ along)[:, None] * along, axis=1)


def sampled(made: DrivenStation, t: FloatArray) -> float:
    """m, the least distance of the first robot to what lies on the table, by the clocks of both."""
    member, table = (made.station.members[name] for name in ("one", "table"))
    cell = replace(
        member.cell,
        obstacles=[replace(o, carried_by="STN1") for o in table.cell.obstacles],
        allowed=(*member.cell.allowed, ("torch", "disc")),
    )
    scene = CollisionScene(cell, member.run.program.moves[-1].tool)
    its = np.array([body.thing in ("disc", "post") for body in scene.bodies])
    q = np.column_stack([joints_at(made, "one", t)[:, :6], joints_at(made, "table", t)[:, 6]])
    pairs = scene.pairs[its[scene.pairs].sum(axis=1) == 1]
    return float(scene.of_pairs(pairs).distances(q, 1.0).distance.min())


@settings(
    max_examples=4, deadline=None, suppress_health_check=[HealthCheck.function_scoped_fixture]
)
@given(
    angle=st.floats(2.0, 120.0) | st.floats(-120.0, -2.0),
    y=st.floats(-60.0, 60.0),
    speed=st.sampled_from(["v50", "v200"]),
    fast=st.sampled_from(["vrot50", "v1000"]),
)
def test_the_torch_is_on_its_line_on_the_table_that_turns(
    tmp_path: Path, angle: float, y: float, speed: str, fast: str
) -> None:
    """Wherever the table is at that instant, by its own program and clock."""
    a, b = (-40.0, y, 60.0), (60.0, -y / 2, 60.0)
    programs = {"one": [ABOVE, weld(*a, kind="J"), ON, weld(*b, 10, speed=speed), OFF]}
    file = write_station(tmp_path, programs, [turn(0), ON, turn(angle, 10, speed=fast), OFF])
    made = flyby.station(file, no_proof=True)
    t = block(made, "one", 2, 2)
    assert off_line(on_the_table(made, "one", t), a, b).max() < 0.05
    turned = np.ptp(joints_at(made, "table", t)[:, 6])
    assert turned == pytest.approx(np.radians(abs(angle)), abs=2e-3)


def test_places_on_a_table_that_stands_between_meetings(tmp_path: Path) -> None:
    """The robot works where the table was turned to, turns with it, draws back, and works again
    where the table has been turned to meanwhile: its axis jumps under the robot."""
    a, b = (-40.0, 30.0, 60.0), (60.0, 0.0, 60.0)
    one = [ABOVE, weld(*a, kind="J"), weld(*b), ON, weld(*a, 10), OFF, weld(*b), MET, ABOVE, MET]
    one += [weld(*b, kind="J"), weld(*a), ABOVE]
    table = [turn(30), ON, turn(-50, 10), OFF, MET, turn(80), MET]
    made = flyby.station(write_station(tmp_path, {"one": one}, table))
    robot = made.station.members["one"].cell.robot
    assert [axis.name for axis in robot.external_axes] == ["STN1", "STN1 (2)"]
    for move, (start, end) in ((2, (a, b)), (3, (b, a)), (4, (a, b)), (7, (b, a))):
        t = block(made, "one", move, move)
        assert off_line(on_the_table(made, "one", t), start, end).max() < 0.1, move


@pytest.mark.parametrize(("x", "clear"), [(-60.0, True), (-140.0, False)])
def test_what_stands_on_the_table_is_met_or_proven_clear(
    tmp_path: Path, x: float, clear: bool
) -> None:
    """A post on the table turns with it: the torch that drives into it does so at any angle, and
    samples of both programs on the clock find as much."""
    a = (60.0, 0.0, 30.0)
    one = [ABOVE, weld(*a, kind="J"), ON, weld(x, 0.0, 30.0, 10), OFF, ABOVE]
    file = write_station(tmp_path, {"one": one}, [turn(0), ON, turn(70, 10), OFF], ALLOWED)
    made = flyby.station(file)
    (pair,) = made.clearances
    assert pair.in_time.proven == clear and made.clear == clear
    t = block(made, "one", 2, 2) if clear else np.linspace(0.0, made.duration, 400)
    least = sampled(made, t)
    assert (least >= 0.005 - 2e-5) == clear
    assert pair.least == pytest.approx(least, abs=1e-3) or not clear
    if not clear:
        (said, *_) = made.findings()
        for word in ("one's torch", "table's post", "one.mod:", "table.mod:"):
            assert word in said


def test_two_robots_and_a_table_keep_one_share_of_their_moves(tmp_path: Path) -> None:
    """Each takes what the slowest takes, and both torches are on their lines at every instant."""
    lines = {
        "one": ((-40.0, 60.0, 60.0), (40.0, 60.0, 60.0), "v50"),
        "two": ((-40.0, -60.0, 60.0), (40.0, -60.0, 60.0), "v200"),
    }
    programs = {
        name: [ABOVE, weld(*a, kind="J"), ON, weld(*b, 10, speed=speed), OFF, ABOVE]
        for name, (a, b, speed) in lines.items()
    }
    made = flyby.station(write_station(tmp_path, programs, [turn(0), ON, turn(15, 10), OFF]))
    t = block(made, "one", 2, 2)
    assert block(made, "two", 2, 2)[[0, -1]] == pytest.approx(t[[0, -1]], abs=1e-3)
    shares = []
    for name, (a, b, _) in lines.items():
        points = on_the_table(made, name, t)
        assert off_line(points, a, b).max() < 0.1
        shares.append((1e3 * points[:, 0] - a[0]) / (b[0] - a[0]))
    shares.append(joints_at(made, "table", t)[:, 6] / np.radians(15.0))
    assert np.ptp(shares, axis=0).max() < 0.01


def test_limits_hold_along_the_motion_of_both(tmp_path: Path) -> None:
    """A robot at the rim of a table that turns as fast as it can: its joints have to keep up."""
    a = (-120.0, 0.0, 60.0)
    one = [ABOVE, weld(*a, kind="J"), ON, weld(-120.0, 1.0, 60.0, 10, speed="v1000"), OFF]
    file = write_station(tmp_path, {"one": one}, [turn(-60), ON, turn(60, 10, speed="v5000"), OFF])
    made = flyby.station(file, no_proof=True)
    t = np.linspace(0.0, made.duration, 20_000)
    for name, member in made.station.members.items():
        rates = np.abs(np.gradient(joints_at(made, name, t), t, axis=0)).max(axis=0)
        assert (rates <= 1.001 * member.cell.robot.limits.velocity).all()


@pytest.mark.parametrize(
    ("table", "words"),
    [
        ([turn(0), turn(40)], ("one's move 2", "one.mod:", "table's move 2", "WaitSyncTask")),
        ([turn(0), ON, turn(40, 10), OFF, MET], ("one.mod:", "table.mod:", "other meetings")),
    ],
)
def test_a_table_that_turns_nobody_knows_when_is_refused(
    tmp_path: Path, table: Sequence[str], words: Sequence[str]
) -> None:
    one = [ABOVE, weld(0.0, 0.0, 60.0, kind="J"), MET, ON, weld(10.0, 0.0, 60.0, 10), OFF]
    one = one if ON in table else one[:2]
    with pytest.raises(FlybyError) as caught:
        flyby.station(write_station(tmp_path, {"one": one}, table))
    for word in words:
        assert word in str(caught.value), str(caught.value)


def test_a_unit_that_several_cells_have_is_refused(tmp_path: Path) -> None:
    one = [ABOVE, weld(0.0, 0.0, 60.0, kind="J")]
    file = write_station(tmp_path, {"one": one, "two": [ABOVE]}, [turn(0)])
    cell = tmp_path / "two.toml"
    axis = (tmp_path / "table.toml").read_text().partition("[[obstacle]]")[0].partition("\n")[2]
    cell.write_text(cell.read_text() + axis)
    with pytest.raises(FlybyError, match="two and table have an axis of that name"):
        flyby.station(file)


@settings(
    max_examples=6, deadline=None, suppress_health_check=[HealthCheck.function_scoped_fixture]
)
@given(
    places=st.lists(
        st.tuples(st.floats(-170.0, -80.0), st.floats(-60.0, 60.0), st.floats(2.0, 60.0)),
        min_size=3,
        max_size=3,
    ),
    turned=st.floats(10.0, 100.0),
    zone=st.sampled_from(["fine", "z10"]),
)
@example(
    places=[(-100.0, 50.0, 10.0), (-150.0, 20.0, 10.0), (-150.0, 0.0, 30.0)],
    turned=60.0,
    zone="fine",
)
def test_what_is_proven_on_the_table_no_sampling_refutes(
    tmp_path: Path, places: list[tuple[float, float, float]], turned: float, zone: str
) -> None:
    """Samples of both programs by their own clocks, of the whole run; and what they keep twice the
    clearance of is proven."""
    a, mid, b = places
    one = [ABOVE, MET, weld(*a, kind="J"), ON, weld(*mid, 10, zone=zone), weld(*b, 20), OFF, ABOVE]
    table = [turn(5), turn(0), MET, ON, turn(turned / 2, 10, zone=zone), turn(turned, 20), OFF]
    try:
        made = flyby.station(write_station(tmp_path, {"one": one}, table, ALLOWED))
    except FlybyError as error:
        assert "reach" in str(error) or "limit" in str(error) or "nearer" in str(error)
        return
    (pair,) = made.clearances
    least = sampled(made, np.linspace(0.0, made.duration, 1500))
    if pair.in_time.proven:
        assert least >= 0.005 - 2e-5
    else:
        assert least < 0.01
