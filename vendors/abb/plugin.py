"""ABB: IRB arms."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

from ...core.hookspec import VendorRegister, hookimpl
from ...core.vendor import Vendor, lazy_motion, lazy_robots, motion_layers
from .dialect import RAPID
from .language import SUFFIXES, Rapid

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

    from ...core.program.target import Configuration
    from ...core.robot.model import Robot

DATA = Path(__file__).parent / "data"


def _label(robot: Robot, q: NDArray[np.float64]) -> Configuration | None:
    from .motion.configuration import label

    return label(robot, q)


@hookimpl
def flyby_register_vendors(register: VendorRegister) -> None:
    """Hand over ABB."""
    rapid = Rapid()
    register.add(
        Vendor(
            name="abb",
            robots=lazy_robots(DATA.glob("robots/*.toml")),
            motion=lazy_motion(DATA / "motion.toml"),
            robot_motion=motion_layers(DATA.glob("motion/*.toml")),
            label=_label,
            reader=rapid,
            writer=rapid,
            patcher=rapid,
            recorder=rapid,
            suffixes=SUFFIXES,
            speaks=RAPID,
        )
    )
