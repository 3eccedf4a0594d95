"""URScript as the core asks for it: reads and writes for a robot. Late imports: they take time."""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from ...core.language import Sources
    from ...core.program.program import Program
    from ...core.recording import Recording
    from ...core.robot.model import Robot
    from ...core.source.reading import Files, ReadOptions

SUFFIXES = (".script", ".urp", ".urpx", ".urscript", ".txt")

_BEGINS = re.compile(r"^[ \t]*(?:def\s+\w+\s*\([^)\n]*\)\s*:|(?:move[jlcp]|servoj)\s*\()", re.M)


class UrScript:
    """Reader, writer, patcher and recorder."""

    def read(self, text: str, file: str, options: ReadOptions) -> Program:
        """See `flyby.core.language.Reader.read`."""
        from .run.reader import read

        return read(text, file, options)

    def read_file(self, path: Path, options: ReadOptions) -> Program:
        """See `flyby.core.language.Reader.read_file`."""
        from .run.reader import read_file

        return read_file(path, options)

    def recognises(self, text: str) -> bool:
        """See `flyby.core.language.Recogniser`."""
        return _BEGINS.search(text) is not None or "<URProgram" in text

    def write(self, program: Program, robot: Robot, options: Mapping[str, str]) -> Sources:
        """See `flyby.core.language.Writer.write`."""
        from .write.writer import write

        return write(program, robot, options)

    def patch(self, program: Program, robot: Robot, options: Mapping[str, str]) -> Files:
        """See `flyby.core.language.Patcher.patch`."""
        from .patch.patcher import patch

        return patch(program, robot, options)

    def record(self, recording: Recording, robot: Robot, period: float) -> Sources:
        """See `flyby.core.language.Recorder.record`."""
        from .record import record

        return record(recording, robot, period)

    def steps(self, recording: Recording, period: float) -> Sequence[str]:
        """See `flyby.core.language.Recorder.steps`."""
        from .record import steps

        return steps(recording, period)

    def usual_period(self, robot: Robot) -> float:
        """See `flyby.core.language.Recorder.usual_period`."""
        from .record import USUAL_PERIOD

        return USUAL_PERIOD
