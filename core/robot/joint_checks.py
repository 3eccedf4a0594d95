"""Whether what is said of an arm's joints fits together."""

from __future__ import annotations

from collections.abc import Sequence

from ..errors import InputError
from .joint import CoupledRange, Joint, JointKind
from .seven_axes.arm_angle import AXES


def check_joints(
    robot: str,
    joints: Sequence[Joint],
    order: Sequence[str],
    coupled: Sequence[CoupledRange],
    *,
    counts_arm_angle: bool,
) -> None:
    """Refuse joints that contradict each other; arguments as of `Robot`.

    Raises:
        InputError: another order, coupled range or follower than of these joints, or an arm angle
            of an arm that has none.
    """
    if order and sorted(order) != sorted(joint.name for joint in joints):
        raise InputError(f"robot {robot}: the order {', '.join(order)} is none of its joints")
    turning = [joint.name for joint in joints if joint.kind is JointKind.REVOLUTE]
    if counts_arm_angle and len(turning) != AXES:
        raise InputError(f"robot {robot}: arms of {AXES} turning axes have an arm angle")
    those = f"but the arm's turning joints are {', '.join(turning)}"
    summed = [name for one in coupled for name, _ in one.terms]
    if not set(summed) <= set(turning):
        raise InputError(f"robot {robot}: a range couples {', '.join(summed)}, {those}")
    for joint in joints:
        for follower in joint.followers:
            if follower.driver not in turning:
                raise InputError(
                    f"robot {robot}: behind joint {joint.name} a turn follows "
                    f"{follower.driver!r}, {those}"
                )
