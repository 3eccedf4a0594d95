"""Faults of robots, labels and motion models."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

from ...core.robot.joint import Joint
from ...core.robot.model import Robot
from ...core.spatial.pose import Pose
from ...core.vendor import Vendor
from ..checks.subject import Subject
from .mutant import Mutant, has
from .wrapping import Plant

SHEETS = ("test_golden_robots_are_those_of_their_data_sheets",)
STANDS = ("test_golden_moves_stand_where_their_author_says",)


def _robots(change: Callable[[Robot], Robot]) -> Plant:
    def plant(vendor: Vendor) -> Vendor:
        def loader(load: Callable[[], Robot]) -> Callable[[], Robot]:
            return lambda: change(load())

        return replace(vendor, robots={n: loader(load) for n, load in vendor.robots.items()})

    return plant


def _joint(index: int, change: Callable[[Joint], Joint]) -> Plant:
    def changed(robot: Robot) -> Robot:
        joints = list(robot.joints)
        joints[index] = change(joints[index])
        return replace(robot, joints=tuple(joints))

    return _robots(changed)


def _longer(joint: Joint) -> Joint:
    x, y, z = joint.placement.position
    return replace(joint, placement=replace(joint.placement, position=(x + 0.01, y, z)))


def _reversed(joint: Joint) -> Joint:
    x, y, z = joint.axis
    return replace(joint, axis=(-x, -y, -z))


def _unturned_flange(robot: Robot) -> Robot:
    turned = Pose((0.0, 0.0, 0.0), (0.0, 1.0, 0.0, 0.0))
    return replace(robot, flange=robot.flange @ turned)


def _mirrored_label(vendor: Vendor) -> Vendor:
    label = vendor.label
    return replace(vendor, label=lambda robot, q: label(robot, -q))


def _without_provenance(vendor: Vendor) -> Vendor:
    model = vendor.motion()
    kept = {key: one for key, one in model.provenance.items() if key != "period_s"}
    return replace(vendor, motion=lambda: replace(model, provenance=kept))


def _has_sheets(suite: Subject) -> bool:
    return bool(suite.golden_robots)


def _has_wrists(suite: Subject) -> bool:
    arms = [suite.vendor.robot(one.name) for one in suite.golden_robots]
    return bool(arms) and all(arm.arm_size >= 6 for arm in arms)


MUTANTS = (
    Mutant(
        "joints faster than they are",
        _joint(0, lambda j: replace(j, velocity=1.1 * j.velocity)),
        SHEETS,
        _has_sheets,
    ),
    Mutant(
        "ranges of joints wider",
        _joint(1, lambda j: replace(j, upper=j.upper + 0.1)),
        SHEETS,
        _has_sheets,
    ),
    Mutant("an arm 10 mm longer", _joint(2, _longer), SHEETS, _has_sheets),
    Mutant("a joint counts the other way", _joint(1, _reversed), SHEETS, _has_sheets),
    Mutant("a joint of the wrist counts the other way", _joint(3, _reversed), SHEETS, _has_wrists),
    Mutant("the last joint counts the other way", _joint(5, _reversed), SHEETS, _has_wrists),
    Mutant("a flange turned by half a turn", _robots(_unturned_flange), SHEETS, _has_sheets),
    Mutant("labels of another posture", _mirrored_label, STANDS, has("configuration")),
    Mutant(
        "provenance of a figure missing",
        _without_provenance,
        ("test_every_figure_has_a_provenance",),
    ),
)
