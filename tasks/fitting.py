"""What a program says by itself of the robot that it is for."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

from ..core.display import counted

if TYPE_CHECKING:
    from ..core.program.program import Program
    from ..core.robot.arm_list import Listed
    from ..core.robot.model import Robot
    from ..core.vendor import Vendor

_SHOWN = 5


def arms_that_fit(program: Program, vendor: Vendor, robot: Robot | None = None) -> str:
    """Which arms of the catalogue can take all places of a program, in a message.

    Args:
        program: read for no robot, or for one that cannot take them.
        vendor: whose language it is.
        robot: one that is named; None if none is.

    Returns:
        Empty where no place is known, no arm can, or the one that is named can as well.
    """
    from ..core.driving.fitting_arms import TakenPlaces
    from ..core.registry import all_listed

    places = TakenPlaces.of(program)
    if not places.count or (robot is not None and not places.missed_by(vendor, robot)):
        return ""
    arms = places.taken_by(vendor, all_listed(vendor))
    if not arms:
        return ""
    lead = "" if robot is None else f"{robot.name} cannot take them all, wherever it comes from; "
    return f"{lead}of the catalogue {said_to_fit(arms, places.count)}"


def said_to_fit(arms: Sequence[Listed], count: int) -> str:
    """Which arms can take so many places, the first by name."""
    names = ", ".join(arm.name for arm in arms[:_SHOWN])
    more = f" and {len(arms) - _SHOWN} more" if len(arms) > _SHOWN else ""
    return f"{names}{more} can take the {counted(count, 'place')} that the program says"
