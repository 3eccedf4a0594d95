"""What a user may ask of zone maximisation."""

from __future__ import annotations

import math
from collections.abc import Collection, Mapping
from dataclasses import dataclass, field

from ....core.errors import InputError
from ....core.handling.handling import Handling
from ....core.program.target import JointTarget
from ....core.program.zone import Radius, VendorZone
from ..rounding import Rounding
from ..solve_round_verify import Beside
from .search import TOLERANCE
from .sizes import GRADED

_ROUNDING = Rounding()


@dataclass(frozen=True)
class ZoneTask:
    """How zones are made larger.

    Args:
        clearance: m that all bodies keep from each other; None for the cell's own.
        residual: m by which the real robot may deviate from the emulated one.
        freed: indices of moves that end in a stop and may be passed instead.
        pattern: proportions of the zones that freed stops get.
        kept: indices of moves whose zone stays as it is.
        process: outputs by the indices of the moves that are driven while they are on; the zones
            at both ends of these stay, too.
        apart: whether zones that the source states in one datum may become different ones.
        rounding: of the new zones, as the program's language writes them, or to a vendor's
            predefined ones.
        tolerance: share of the first failing size by which a zone may stay below it.
        start: where the robot stands; None for the program's own start.
        beside: what other robots say of a program; None where there are none.
        handling: of the cell's parts, at targets that stay; None for a cell without.

    Raises:
        InputError: a number is out of range.
    """

    clearance: float | None = None
    residual: float = 0.0
    freed: Collection[int] = ()
    pattern: Radius | VendorZone = GRADED
    kept: Collection[int] = ()
    process: Mapping[int, str] = field(default_factory=dict)
    apart: bool = False
    rounding: Rounding = _ROUNDING
    tolerance: float = TOLERANCE
    start: JointTarget | None = None
    beside: Beside | None = None
    handling: Handling | None = None

    def __post_init__(self) -> None:
        for name in ("clearance", "residual"):
            value = getattr(self, name)
            if value is not None and not 0.0 <= value < math.inf:
                raise InputError(f"the {name} must be zero or more metres, not {value:g}")
        if not 1e-4 <= self.tolerance <= 0.5:
            raise InputError(f"the tolerance lies between 0.0001 and 0.5, not {self.tolerance:g}")
