"""How a RAPID module is written."""

from __future__ import annotations

from dataclasses import dataclass
from enum import StrEnum

from ....core.errors import InputError
from ....core.source.write.options import OpaqueStyle, StructureStyle
from ..values.records import AXIS_KINDS, EXTERNAL_AXES


class ZoneStyle(StrEnum):
    """Which zonedata a module uses."""

    OWN = "own"
    """The program's zones as they are, declared where no predefined one is equal."""
    PREDEFINED = "predefined"
    """The largest predefined zone whose TCP radius is not above the program's; ``fine`` below
    ``z0``. The zones of reorientation and external axes are then the predefined one's, be they
    larger or smaller: plan what was written, not what was asked for."""


@dataclass(frozen=True, slots=True)
class RapidOptions:
    """How a module is written.

    Args:
        external_axes: ``"linear"`` or ``"rotating"`` for eax_a, eax_b, …, as for the reader.

    Raises:
        InputError: another kind of axis, or more than six.
    """

    zones: ZoneStyle = ZoneStyle.OWN
    opaque: OpaqueStyle = OpaqueStyle.KEEP
    structure: StructureStyle = StructureStyle.FLAT
    external_axes: tuple[str, ...] = ()

    def __post_init__(self) -> None:
        if len(self.external_axes) > EXTERNAL_AXES:
            raise InputError(f"RAPID has six external axes, not {len(self.external_axes)}")
        for kind in self.external_axes:
            if kind not in AXIS_KINDS:
                raise InputError(f"an external axis is 'linear' or 'rotating', not {kind!r}")
