"""What counts as energy: squared torque over time, or what the user's motors take."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

from ..core.errors import InputError
from .options.entries import TaskOptions, value

if TYPE_CHECKING:
    from ..core.motion.model.consumption import Consumption
    from ..core.robot.model import Robot


@dataclass(frozen=True, kw_only=True)
class MotorOptions(TaskOptions):
    """Of what is done for its energy."""

    motors: str | Path | Consumption | None = value(
        None,
        "Motor figures (TOML): energy is then what the mains give, in J; otherwise it is squared "
        "torque over time.",
        kind=Path,
    )

    def consumption(self, robot: Robot) -> Consumption:
        """What counts as the energy of a robot.

        Raises:
            InputError: the file is unusable, or of a robot with other axes.
        """
        from ..core.motion.model.consumption import SQUARED_TORQUE
        from ..core.motion.model.motors_file import load_motors

        if self.motors is None:
            return SQUARED_TORQUE
        if not isinstance(self.motors, str | Path):
            return self.motors
        made = load_motors(Path(self.motors))
        if len(made.copper) > robot.size:
            raise InputError(
                f"{self.spelt('motors')} {self.motors}: {robot.name} has {robot.size} axes, "
                f"copper_w_per_nm2 has {len(made.copper)} numbers"
            )
        return made
