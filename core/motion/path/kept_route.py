"""The route of a program that differs little from one whose route is known.

Who moves waypoints and zones in search of better ones asks for it again and again.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from ...program.move import MoveC, MoveJ, MoveL
from ...program.program import Program
from ...program.target import JointTarget
from ...program.zone import Fine
from ...robot.kinematics.chain_kernels import fill_poses
from ..geometry.segments import JOINT_SEGMENT, Ends
from .path import Route
from .route_legs import NOWHERE


def with_other_numbers(before: Program, route: Route, program: Program) -> Route | None:
    """The route of a program that differs from another one in joint values and zones alone.

    Args:
        before, route: the other program and its route.
        program: the program.

    Returns:
        None where more has changed, or may have.
    """
    statements = len(before.statements) == len(program.statements)
    if not statements or before.start is not program.start or route.notes or route.left_out:
        return None
    if len(route.moves) != len(before.moves):
        return None
    kind, zones, changed = route.ends.kind.tolist(), list(route.zones), []
    k = -1
    for old, new in zip(before.statements, program.statements, strict=True):
        k += isinstance(old, MoveJ | MoveL | MoveC)
        if old is new:
            continue
        if not (isinstance(old, MoveJ) and isinstance(new, MoveJ) and _alike(old, new)):
            return None
        if kind[k] != JOINT_SEGMENT or kind[min(k + 1, len(kind) - 1)] != JOINT_SEGMENT:
            return None
        target, external = new.target, route.robot.size - route.robot.arm_size
        if not isinstance(target, JointTarget) or len(target.external) != external:
            return None
        if new.zone is not old.zone and k < len(zones):
            # At a stop something else may make it one.
            if zones[k] is not old.zone or isinstance(old.zone, Fine):
                return None
            zones[k] = new.zone
        changed.append((k, target))
    ends = _moved(route, changed)
    return None if ends is None else replace(route, ends=ends, zones=tuple(zones))


def _alike(old: MoveJ, new: MoveJ) -> bool:
    """Whether both are joint moves to as many joint values, and differ in nothing but these and
    their zones."""
    one, two = old.target, new.target
    if not (isinstance(one, JointTarget) and isinstance(two, JointTarget)):
        return False
    if len(one.joints) != len(two.joints) or len(one.external) != len(two.external):
        return False
    same = old.tool is new.tool and old.work_object is new.work_object and old.speed is new.speed
    return same and not (new.open or new.unsettled)


def _moved(route: Route, changed: Sequence[tuple[int, JointTarget]]) -> Ends | None:
    """The ends with other joint values where segments end; None where one goes nowhere then."""
    ends, count = route.ends, len(route.moves)
    q, prescribed = ends.q.copy(), ends.prescribed.copy()
    position, rotation = ends.position.copy(), ends.rotation.copy()
    chains = route.chains
    for k, target in changed:
        here, after = (k, slice(1, 2)), (k + 1, slice(0, 1))
        q[here] = (*target.joints, *target.external)
        prescribed[here] = q[k, 1, route.prescribed]
        fill_poses(chains[k], q[here], rotation[here], position[here])
        if k + 1 < count:
            q[after], prescribed[after] = q[here], prescribed[here]
            if chains[k + 1] is chains[k]:
                rotation[after], position[after] = rotation[here], position[here]
            else:
                fill_poses(chains[k + 1], q[after], rotation[after], position[after])
    moved = [k for k, _ in changed]
    near = [k for k in {*moved, *(k + 1 for k in moved)} if k < count]
    if (np.linalg.norm(q[near, 1] - q[near, 0], axis=1) <= NOWHERE).any():
        return None
    return replace(ends, q=q, prescribed=prescribed, position=position, rotation=rotation)
