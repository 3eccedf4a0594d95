"""RAPID as the core asks for it: reads and writes for a robot. Imports are late: they take time."""

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

SUFFIXES = (".mod", ".modx", ".prg", ".sys", ".sysx", ".pgf")

_BEGINS = re.compile(
    r"^[ \t]*(?:%%%|MODULE\s|(?:LOCAL\s+|TASK\s+)?(?:PROC|FUNC|TRAP|PERS|CONST|VAR)\s+\w"
    r"|Move(?:J|L|C|AbsJ)\s[^;\n]*;)",
    re.M | re.I,
)


class Rapid:
    """Reader, writer, patcher and recorder.

    Writing takes the options ``zones`` and ``opaque`` (`RapidOptions`), patching ``shared`` and
    ``derived`` (`PatcherOptions`), recording none.
    """

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
        return _BEGINS.search(text) is not None

    def frame_answer(self, example: Answer, pose: Pose) -> Answer | None:
        """See `flyby.core.language.FrameAnswers`."""
        from .values.answers import frame_answer

        return frame_answer(example, pose)

    def write(self, program: Program, robot: Robot, options: Mapping[str, str]) -> Sources:
        """See `flyby.core.language.Writer.write`."""
        from ...core.source.write.options import chosen
        from .motion.external_axes import axis_kinds
        from .write.options import RapidOptions
        from .write.writer import SUFFIX, module_name, write

        axes = axis_kinds(robot) or ()
        how = chosen(RapidOptions, options, "RAPID writer", external_axes=axes)
        return {module_name(program) + SUFFIX: write(program, how)}

    def patch(self, program: Program, robot: Robot, options: Mapping[str, str]) -> Files:
        """See `flyby.core.language.Patcher.patch`."""
        from ...core.source.patch.edits import reading_of
        from ...core.source.write.options import PatcherOptions
        from .motion.external_axes import axis_kinds
        from .patch.patcher import patch

        # The files are read again as they were read, be it without a robot.
        kinds = axis_kinds(reading_of(program).options.robot)
        return patch(program, PatcherOptions.of(options, "RAPID patcher"), kinds or ())

    def record(self, recording: Recording, robot: Robot, period: float) -> Sources:
        """See `flyby.core.language.Recorder.record`."""
        from .motion.external_axes import axis_kinds
        from .record import record
        from .write.options import RapidOptions

        return record(recording, RapidOptions(external_axes=axis_kinds(robot) or ()), period)

    def steps(self, recording: Recording, period: float) -> Sequence[str]:
        """See `flyby.core.language.Recorder.steps`."""
        from .record import steps

        return steps(recording, period)

    def usual_period(self, robot: Robot) -> float:
        """See `flyby.core.language.Recorder.usual_period`."""
        from .record import USUAL_PERIOD

        return USUAL_PERIOD
