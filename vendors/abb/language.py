"""RAPID as the core asks for it: reads and writes for a robot. Imports are late: they take time."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from ...core.program.program import Program
    from ...core.robot.model import Robot
    from ...core.source.reading import ReadOptions
    from ...core.vendor import Sources
    from .write.options import RapidOptions

SUFFIXES = (".mod", ".modx", ".prg", ".sys", ".sysx", ".pgf")


class Rapid:
    """Reader and writer. Writing takes the options ``zones`` and ``opaque`` (`RapidOptions`)."""

    def read(self, text: str, file: str, options: ReadOptions) -> Program:
        """See `flyby.core.vendor.Reader.read`."""
        from .run.reader import read

        return read(text, file, options)

    def read_file(self, path: Path, options: ReadOptions) -> Program:
        """See `flyby.core.vendor.Reader.read_file`."""
        from .run.reader import read_file

        return read_file(path, options)

    def write(self, program: Program, robot: Robot, options: Mapping[str, str]) -> Sources:
        """See `flyby.core.vendor.Writer.write`."""
        from .write.writer import RapidWriter

        return RapidWriter(_options(robot, options)).write(program)


def _options(robot: Robot, options: Mapping[str, str]) -> RapidOptions:
    from ...core.source.write.options import OpaqueStyle, check_names, choice
    from .motion.targets import axis_kinds
    from .write.options import RapidOptions, ZoneStyle

    check_names(options, ("zones", "opaque"), "RAPID writer")
    return RapidOptions(
        zones=choice(options, "zones", ZoneStyle.OWN),
        opaque=choice(options, "opaque", OpaqueStyle.KEEP),
        external_axes=axis_kinds(robot) or (),
    )
