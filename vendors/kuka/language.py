"""KRL as the core asks for it: reads and writes for a robot. Imports are late: they take time."""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from ...core.language import Sources
    from ...core.program.program import Program
    from ...core.program.question import Answer
    from ...core.recording import Recording
    from ...core.robot.model import Robot
    from ...core.source.reading import Files, ReadOptions
    from ...core.spatial.pose import Pose

_BEGINS = re.compile(r"^[ \t]*(?:&\w+|(?:GLOBAL[ \t]+)?DEF(?:DAT|FCT)?[ \t]+\w)", re.M | re.I)


class Krl:
    """Reader, writer, patcher and recorder."""

    def read(self, text: str, file: str, options: ReadOptions) -> Program:
        """See `flyby.core.language.Reader.read`."""
        from ...core.source.reading import read_with
        from ...core.source.text.files import SourceFile, decode
        from .run.reader import read_sources

        decoded, codec = decode(text, file)
        files = {file: SourceFile(file, decoded, codec)}
        return read_with(files, file, options, read_sources)

    def read_file(self, path: Path, options: ReadOptions) -> Program:
        """See `flyby.core.language.Reader.read_file`."""
        from ...core.source.reading import read_with
        from .run.files import collect
        from .run.reader import read_sources

        files = collect(path, options.others, options.beside)
        return read_with(files, str(path), options, read_sources)

    def recognises(self, text: str) -> bool:
        """See `flyby.core.language.Recogniser`."""
        return _BEGINS.search(text) is not None

    def frame_answer(self, example: Answer, pose: Pose) -> Answer | None:
        """See `flyby.core.language.FrameAnswers`."""
        from .values.answers import frame_answer

        return frame_answer(example, pose)

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
        from .record import SHORTEST_PERIOD

        return SHORTEST_PERIOD
