"""Arms for a vendor that is installed."""

from __future__ import annotations

from pathlib import Path

from flyby.core.hookspec import RobotRegister, hookimpl
from flyby.core.vendor import lazy_robots

FILES = Path(__file__).parent / "robots_of_abb"


@hookimpl
def flyby_register_robots(register: RobotRegister) -> None:
    """Hand over the arms; each is called as its file."""
    register.add("abb", lazy_robots(FILES.glob("*.toml")), api=1)
