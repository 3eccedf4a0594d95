"""Universal Robots: CB3 and e-Series arms."""

from __future__ import annotations

from pathlib import Path

from ...core.hookspec import VendorRegister, hookimpl
from ..packaged import vendor_of
from .dialect import URSCRIPT
from .language import SUFFIXES, UrScript


@hookimpl
def flyby_register_vendors(register: VendorRegister) -> None:
    """Hand over Universal Robots."""
    folder = Path(__file__).parent
    register.add(vendor_of(__package__, folder, UrScript(), suffixes=SUFFIXES, speaks=URSCRIPT))
