"""How a KRL program is written."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

from ....core.source.write.options import OpaqueStyle, check_names, choice


@dataclass(frozen=True, slots=True)
class KrlOptions:
    """How a program is written.

    Args:
        opaque: see `core.source.options.OpaqueStyle`.
    """

    opaque: OpaqueStyle = OpaqueStyle.KEEP

    @classmethod
    def of(cls, options: Mapping[str, str]) -> KrlOptions:
        """From options by name.

        Raises:
            InputError: an unknown option, or a value that it does not take.
        """
        check_names(options, ("opaque",), "KRL writer")
        return cls(choice(options, "opaque", OpaqueStyle.KEEP))
