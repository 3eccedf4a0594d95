"""RAPID's patcher and recorder as the core asks for them. Imports are late: they take time."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from ...core.program.program import Program
    from ...core.robot.model import Robot
    from ...core.source.reading import Files
    from ...core.vendor import Sources


class RapidPatcher:
    """Takes the options ``shared`` and ``derived`` (`PatchOptions`)."""

    def patch(self, program: Program, robot: Robot, options: Mapping[str, str]) -> Files:
        """See `flyby.core.vendor.Patcher.patch`."""
        from ...core.source.patch.edits import reading_of
        from ...core.source.write.options import PatchOptions
        from .motion.targets import axis_kinds
        from .patch.patcher import patch

        # The files are read again as they were read, be it without a robot.
        kinds = axis_kinds(reading_of(program).options.robot)
        return patch(program, PatchOptions.of(options, "RAPID patcher"), kinds or ())


class RapidRecorder:
    """Takes no options."""

    def record(self, program: Program, robot: Robot, period: float) -> Sources:
        """See `flyby.core.vendor.Recorder.record`."""
        from .motion.targets import axis_kinds
        from .record import record
        from .write.options import RapidOptions

        return record(program, RapidOptions(external_axes=axis_kinds(robot) or ()), period)
