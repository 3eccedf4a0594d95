"""KUKA: KR arms, and the LBR iiwa's kinematics."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

from ...core.hookspec import VendorRegister, hookimpl
from ...core.vendor import Vendor, lazy_motion, lazy_robots, motion_layers
from .dialect import KRL
from .language import Krl
from .run.suffixes import COMPANIONS, PROGRAMS

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

    from ...core.program.target import Configuration
    from ...core.robot.model import Robot

DATA = Path(__file__).parent / "data"
SUNRISE = "the LBR iiwa is programmed in Java (KUKA Sunrise), not in KRL"


def _label(robot: Robot, q: NDArray[np.float64]) -> Configuration | None:
    from .motion.configuration import label

    return label(robot, q)


@hookimpl
def flyby_register_vendors(register: VendorRegister) -> None:
    """Hand over KUKA."""
    krl = Krl()
    register.add(
        Vendor(
            name="kuka",
            robots=lazy_robots(DATA.glob("robots/*.toml")),
            motion=lazy_motion(DATA / "motion.toml"),
            robot_motion=motion_layers(DATA.glob("motion/*.toml")),
            label=_label,
            reader=krl,
            writer=krl,
            patcher=krl,
            recorder=krl,
            suffixes=PROGRAMS,
            companions=COMPANIONS,
            speaks=KRL,
            emulation_only={"iiwa7-r800": SUNRISE, "iiwa14-r820": SUNRISE},
        )
    )
