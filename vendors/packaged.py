"""The vendor that a package with the rooms of a language is."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from functools import cache
from importlib import import_module
from importlib.util import find_spec
from pathlib import Path
from typing import TYPE_CHECKING, Any, cast

from ..core.language import BackupOpener, Language
from ..core.robot.arm_list import ArmList
from ..core.vendor import Vendor, lazy_motion, lazy_robots, motion_layers

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

    from ..core.program.target import Configuration
    from ..core.robot.model import Robot


def vendor_of(
    package: str,
    folder: Path,
    language: Language,
    describes_robots: bool = False,
    **others: Any,
) -> Vendor:
    """The vendor that a package is, called as the package's folder.

    Args:
        package: its name; the function ``label`` of its module ``motion.configuration`` is the
            vendor's, and ``with_machine_data`` of ``machine_data``, where there is one, reads the
            files of its controllers; ``OPENER`` of ``backup.opener`` opens their backups.
        folder: where it is; robots, motion files and the list of arms stand in ``data``.
        language: reader, writer, patcher and recorder.
        describes_robots: ``robot_of`` of ``machine_data`` makes a robot of such a file alone, and
            ``stated_in`` says how its controller drives.
        others: see `Vendor`.
    """
    data = folder / "data"
    arms = ArmList(data / "arms.jsonl")

    @cache
    def labelling() -> Callable[[Robot, NDArray[np.float64]], Configuration | None]:
        module = import_module(".motion.configuration", package)  # takes time
        return cast("Callable[[Robot, NDArray[np.float64]], Configuration | None]", module.label)

    def label(robot: Robot, q: NDArray[np.float64]) -> Configuration | None:
        return labelling()(robot, q)

    def laid_on(robot: Robot, file: Path) -> Robot:
        reading = import_module(".machine_data", package)  # seldom needed
        return cast("Robot", reading.with_machine_data(robot, file))

    def described(file: Path) -> Robot:
        reading = import_module(".machine_data", package)  # seldom needed
        return cast("Robot", reading.robot_of(file))

    def stated(file: Path) -> Mapping[str, tuple[Any, str]]:
        reading = import_module(".machine_data", package)  # seldom needed
        return cast("Mapping[str, tuple[Any, str]]", reading.stated_in(file))

    def opener() -> BackupOpener:
        opening = import_module(".backup.opener", package)  # seldom needed
        return cast("BackupOpener", opening.OPENER)

    return Vendor(
        name=folder.name,
        robots={**arms.robots(), **lazy_robots(data.glob("robots/*.toml"))},
        listed=arms.listed,
        motion=lazy_motion(data / "motion.toml"),
        robot_motion=motion_layers(data.glob("motion/*.toml")),
        label=label,
        reader=language,
        writer=language,
        patcher=language,
        recorder=language,
        machine_data=laid_on if find_spec(f"{package}.machine_data") else None,
        described=described if describes_robots else None,
        stated=stated if describes_robots else None,
        backups=opener if (folder / "backup" / "opener.py").is_file() else None,
        **others,
    )
