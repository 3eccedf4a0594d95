"""What flyby gets of FANUC."""

from __future__ import annotations

from pathlib import Path

from flyby.core.hookspec import VendorRegister, hookimpl
from flyby.core.plugins.speaking import speaking
from flyby.core.vendor import Vendor

from .language import Language
from .words import LETTERS

DATA = Path(__file__).parent / "data"


def fanuc() -> Vendor:
    """The vendor."""
    return speaking(
        Language(),
        "fanuc",
        DATA,
        label=LETTERS.label,
        companions={
            ".va": "the controller's variables: name the program (.ls) beside them",
            ".tp": "a program in binary form: save it as text (.ls)",
        },
    )


@hookimpl
def flyby_register_vendors(register: VendorRegister) -> None:
    """Hand over FANUC."""
    register.add(fanuc(), api=1)
