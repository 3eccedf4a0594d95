"""What flyby gets of Yaskawa."""

from __future__ import annotations

from pathlib import Path

from flyby.core.hookspec import VendorRegister, hookimpl
from flyby.core.vendor import Vendor, lazy_motion, lazy_robots

from .language import SPEAKS, Language

DATA = Path(__file__).parent / "data"


def vendor() -> Vendor:
    """The vendor."""
    language = Language()
    return Vendor(
        name="yaskawa",
        robots=lazy_robots(DATA.glob("robots/*.toml")),
        motion=lazy_motion(DATA / "motion.toml"),
        label=lambda robot, q: None,
        reader=language,
        writer=language,
        patcher=language,
        suffixes=(".jbi",),
        speaks=SPEAKS,
    )


@hookimpl
def flyby_register_vendors(register: VendorRegister) -> None:
    """Hand over Yaskawa."""
    register.add(vendor(), api=1)
