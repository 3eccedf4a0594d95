"""KUKA: KR arms, and the LBR iiwa's kinematics."""

from __future__ import annotations

from pathlib import Path

from ...core.hookspec import VendorRegister, hookimpl
from ..packaged import vendor_of
from .dialect import KRL
from .language import Krl
from .run.suffixes import COMPANIONS, PROGRAMS

SUNRISE = "the LBR iiwa is programmed in Java (KUKA Sunrise), not in KRL"


@hookimpl
def flyby_register_vendors(register: VendorRegister) -> None:
    """Hand over KUKA."""
    register.add(
        vendor_of(
            __package__,
            Path(__file__).parent,
            Krl(),
            describes_robots=True,
            suffixes=PROGRAMS,
            speaks=KRL,
            companions=COMPANIONS,
            emulation_only={"iiwa7-r800": SUNRISE, "iiwa14-r820": SUNRISE},
        )
    )
