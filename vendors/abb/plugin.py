"""ABB: IRB arms."""

from __future__ import annotations

from pathlib import Path

from ...core.hookspec import VendorRegister, hookimpl
from ...core.vendor import vendor_of
from .dialect import RAPID
from .language import SUFFIXES, Rapid


@hookimpl
def flyby_register_vendors(register: VendorRegister) -> None:
    """Hand over ABB."""
    folder = Path(__file__).parent
    register.add(vendor_of(__package__, folder, Rapid(), suffixes=SUFFIXES, speaks=RAPID))
