"""What flyby gets of Yaskawa."""

from __future__ import annotations

from pathlib import Path

from flyby.core.hookspec import VendorRegister, hookimpl
from flyby.core.plugins.speaking import speaking
from flyby.core.vendor import Vendor

from .language import Language

DATA = Path(__file__).parent / "data"


def vendor() -> Vendor:
    """The vendor."""
    return speaking(Language(), "yaskawa", DATA)


@hookimpl
def flyby_register_vendors(register: VendorRegister) -> None:
    """Hand over Yaskawa."""
    register.add(vendor(), api=1)
