"""How a KRL program is written."""

from __future__ import annotations

from dataclasses import dataclass

from ....core.source.write.options import OpaqueStyle, StructureStyle


@dataclass(frozen=True, slots=True)
class KrlOptions:
    """How a program is written."""

    opaque: OpaqueStyle = OpaqueStyle.KEEP
    structure: StructureStyle = StructureStyle.FLAT
