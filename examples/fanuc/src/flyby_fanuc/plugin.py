"""What flyby gets of FANUC."""

from __future__ import annotations

from pathlib import Path

from flyby.core.hookspec import VendorRegister, hookimpl
from flyby.core.vendor import Vendor, lazy_motion, lazy_robots

from .dialect import TP
from .language import Language
from .words import LETTERS

DATA = Path(__file__).parent / "data"


def fanuc() -> Vendor:
    """The vendor."""
    language = Language()
    return Vendor(
        name="fanuc",
        robots=lazy_robots(DATA.glob("robots/*.toml")),
        motion=lazy_motion(DATA / "motion.toml"),
        label=LETTERS.label,
        reader=language,
        writer=language,
        patcher=language,
        recorder=language,
        suffixes=(".ls",),
        companions={
            ".va": "the controller's variables: name the program (.ls) beside them",
            ".tp": "a program in binary form: save it as text (.ls)",
        },
        speaks=TP,
    )


@hookimpl
def flyby_register_vendors(register: VendorRegister) -> None:
    """Hand over FANUC."""
    register.add(fanuc(), api=1)
