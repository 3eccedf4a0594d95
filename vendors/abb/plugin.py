"""ABB: IRB arms."""

from __future__ import annotations

from pathlib import Path

from ...core.hookspec import VendorRegister, hookimpl
from ..packaged import vendor_of
from .dialect import RAPID
from .language import SUFFIXES, Rapid

_SCARAS = ("irb910sc-3-045", "irb910sc-3-055", "irb910sc-3-065", "irb920t-6-055", "irb920t-6-065")
_SLIDES = "jointtargets with an axis in mm are read, but not written yet"


@hookimpl
def flyby_register_vendors(register: VendorRegister) -> None:
    """Hand over ABB."""
    folder = Path(__file__).parent
    register.add(
        vendor_of(
            __package__,
            folder,
            Rapid(),
            suffixes=SUFFIXES,
            speaks=RAPID,
            emulation_only=dict.fromkeys(_SCARAS, _SLIDES),
        )
    )
