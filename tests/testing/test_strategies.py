"""The strategies give what they promise."""

from __future__ import annotations

import numpy as np
from hypothesis import HealthCheck, find, given, settings
from hypothesis import strategies as st

from flyby.core.motion.configurations.finder import ConfigurationFinder
from flyby.core.program.move import MoveC, MoveJ, MoveL
from flyby.core.program.program import Program
from flyby.core.program.speed import Speed
from flyby.core.program.target import JointTarget, PoseTarget
from flyby.core.program.tool import Tool
from flyby.core.program.zone import FINE
from flyby.core.registry import find_robot, find_vendor
from flyby.core.spatial.pose import IDENTITY
from flyby.testing import strategies

ROBOT = find_robot("abb/irb1600-6-145")
CALM = settings(
    max_examples=40,
    deadline=None,
    suppress_health_check=[HealthCheck.too_slow, HealthCheck.filter_too_much],
)


@CALM
@given(st.floats(0.0, 0.4), st.data())
def test_configurations_keep_away_from_limits(margin: float, data: st.DataObject) -> None:
    q = data.draw(strategies.configurations(ROBOT, margin))
    limits = ROBOT.limits
    gap = margin * (limits.upper - limits.lower) - 1e-12
    assert q.shape == (6,)
    assert (q >= limits.lower + gap).all() and (q <= limits.upper - gap).all()


@CALM
@given(strategies.reachable_poses(ROBOT))
def test_reachable_poses_can_be_reached(pose: object) -> None:
    assert ROBOT.inverse(pose)  # type: ignore[arg-type]


@CALM
@given(strategies.programs(ROBOT, find_vendor("abb").label, max_moves=4))
def test_programs_begin_with_a_stop_and_reach_all_targets(program: object) -> None:
    moves = program.moves  # type: ignore[attr-defined]
    assert isinstance(moves[0], MoveJ) and moves[0].zone == FINE
    assert 2 <= len(moves) <= 5
    for move in moves:
        assert isinstance(move.target, PoseTarget) == isinstance(move, MoveL | MoveC)
        if isinstance(move.target, PoseTarget):
            assert move.target.configuration is not None
            assert ROBOT.inverse(move.target.pose)


def test_programs_hold_every_kind_of_move() -> None:
    for kind in (MoveJ, MoveL, MoveC):
        quiet = settings(max_examples=500, database=None, suppress_health_check=list(HealthCheck))
        find(
            strategies.programs(ROBOT),
            lambda program, kind=kind: isinstance(program.moves[-1], kind),
            settings=settings(quiet, phases=[p for p in quiet.phases if p.name != "shrink"]),
        )


@CALM
@given(strategies.radii())
def test_zones_turn_no_later_than_they_leave(zone: object) -> None:
    assert zone.reorientation >= zone.tcp > 0  # type: ignore[attr-defined]
    assert np.isfinite(zone.angle)  # type: ignore[attr-defined]


@CALM
@given(strategies.fly_by_zones(lambda _: strategies.zones())(MoveJ))
def test_fly_by_zones_never_stop(zone: object) -> None:
    assert zone != FINE


@CALM
@given(strategies.programs(ROBOT, kinds=[MoveJ], max_moves=3))
def test_programs_keep_to_the_kinds_asked_for(program: object) -> None:
    assert all(isinstance(move, MoveJ) for move in program.moves)  # type: ignore[attr-defined]


PARTS = strategies.Parts(
    zone=lambda kind: st.just(FINE) if kind is MoveJ else strategies.radii(),
    speed=lambda kind: st.just(Speed(0.1 if kind is MoveJ else 0.2)),
    aim=st.sampled_from([JointTarget, PoseTarget]),
    tool=strategies.tools() | st.just(Tool("stand", IDENTITY, robot_held=False)),
    work_object=strategies.work_objects(),
    load=st.none() | strategies.loads(),
    labelled=lambda kind: kind is not MoveL,
)


@CALM
@given(strategies.programs(ROBOT, find_vendor("abb").label, PARTS))
def test_programs_are_made_of_the_parts_asked_for(program: Program) -> None:
    for move in program.moves:
        joint = isinstance(move, MoveJ)
        assert move.speed == Speed(0.1 if joint else 0.2)
        assert (move.zone == FINE) == joint
        assert move.tool.robot_held != move.work_object.robot_held
        if isinstance(move.target, PoseTarget):
            assert (move.target.configuration is None) == isinstance(move, MoveL)


@CALM
@given(strategies.programs(ROBOT, find_vendor("abb").label, PARTS))
def test_one_name_is_one_tool(program: Program) -> None:
    for part in ("tool", "work_object"):
        values = {getattr(move, part) for move in program.moves}
        assert len({value.name for value in values}) == len(values)


@CALM
@given(strategies.programs(ROBOT, find_vendor("abb").label, PARTS, kinds=[MoveJ]))
def test_targets_in_frames_are_where_the_robot_goes(program: Program) -> None:
    """The inverse through tool and work object gives the configuration that was drawn."""
    finder = ConfigurationFinder(ROBOT, find_vendor("abb").label)
    q = finder.targets.rest()
    for index, move in enumerate(program.moves):
        if isinstance(move.target, JointTarget):
            q = finder.targets.joints(move.target, q)
            continue
        q = finder.choose(move, index, q)
        limits = ROBOT.limits
        assert (q > limits.lower).all() and (q < limits.upper).all()
