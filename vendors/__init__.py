"""Vendors: robots, motion models and languages. Called, the package lists all that are installed:
``flyby.vendors()``.
"""

from __future__ import annotations

import sys
from types import ModuleType
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from ..core.vendor import Vendor


class _Vendors(ModuleType):
    def __call__(self) -> tuple[Vendor, ...]:
        """All vendors that are installed, by name."""
        from ..core.registry import vendors

        return vendors()


sys.modules[__name__].__class__ = _Vendors
