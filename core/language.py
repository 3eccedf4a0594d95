"""What a vendor's language supplies: reader, writer, patcher, recorder."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Protocol, runtime_checkable

if TYPE_CHECKING:
    from .backup.backup import Backup
    from .program.program import Program
    from .program.question import Answer
    from .recording import Recording
    from .robot.model import Robot
    from .source.reading import Files, ReadOptions
    from .spatial.pose import Pose

Sources = Mapping[str, str]
"""Texts of a program's source files by file name."""


@runtime_checkable
class Reader(Protocol):
    """Reads the vendor's source; errors are `SourceError` with file, line and column."""

    def read(self, text: str, file: str, options: ReadOptions) -> Program:
        """The program that a routine of ``text`` drives; no file is opened.

        Args:
            text: the source.
            file: its name, for messages.
            options: entry, robot, answers, limits.
        """
        ...

    def read_file(self, path: Path, options: ReadOptions) -> Program:
        """The same of a file, and of the files that belong to it (`ReadOptions.others`)."""
        ...


@runtime_checkable
class Recogniser(Protocol):
    """A reader that tells its language's texts from those of others, whose files end alike."""

    def recognises(self, text: str) -> bool:
        """Whether the beginning of a file is of its language."""
        ...


@runtime_checkable
class Writer(Protocol):
    """Writes the vendor's source."""

    def write(self, program: Program, robot: Robot, options: Mapping[str, str]) -> Sources:
        """Source files that the robot's controller would load, by file name.

        Args:
            program: what to say.
            robot: for its external axes.
            options: of the language, by name; unknown ones are refused.

        Raises:
            FlybyError: the language cannot say what the program holds.
        """
        ...


@runtime_checkable
class Patcher(Protocol):
    """Changes targets, zones and speeds in the user's own files and no other byte."""

    def patch(self, program: Program, robot: Robot, options: Mapping[str, str]) -> Files:
        """The files that ``program`` was read from, with the numbers that it has now.

        Args:
            program: read from files (`Program.reading`), then changed.
            robot: whose it is.
            options: of the patcher, by name; unknown ones are refused.

        Returns:
            The files that changed, by the name they were read by.

        Raises:
            FlybyError: a change has no place in the text, or reading the patched text does not
                give the changed program.
        """
        ...


@runtime_checkable
class Recorder(Protocol):
    """Writes source that drives a program and logs itself."""

    def record(self, recording: Recording, robot: Robot, period: float) -> Sources:
        """Source files by file name; joint values are logged every ``period`` s.

        Runs follow each other from one start, each into its own log, up to one that the robot is
        jogged to; the next start goes on there.
        """
        ...

    def usual_period(self, robot: Robot) -> float:
        """s between samples where nobody says: short, and of controllers without options."""
        ...

    def steps(self, recording: Recording, period: float) -> Sequence[str]:
        """What is done at the controller, a sentence or two each, in their order."""
        ...


@runtime_checkable
class FrameAnswers(Protocol):
    """Says poses as users answer frames and tools."""

    def frame_answer(self, example: Answer, pose: Pose) -> Answer | None:
        """An answer that says a pose.

        Args:
            example: of the question, of which all but the pose stays.
            pose: of a frame, or the TCP of a tool.

        Returns:
            None where the example is no frame and no tool.
        """
        ...


class Language(Reader, Writer, Patcher, Recorder, Protocol):
    """All four."""


@runtime_checkable
class BackupOpener(Protocol):
    """Opens backups of the vendor's controllers."""

    def root_in(self, names: Sequence[str]) -> str | None:
        """Where a backup begins among files, by what marks it.

        Args:
            names: of all files, below what the user named, with ``/`` between folders.

        Returns:
            The folder, ``""`` for the outermost one; None if the vendor has no backup there.
        """
        ...

    def programs_in(self, names: Sequence[str]) -> str | None:
        """Where programs begin that no backup marks, but that stand for one by themselves.

        Args:
            names: as `root_in` takes them.

        Returns:
            The folder; None where the vendor's programs do not.
        """
        ...

    def unreadable_in(self, names: Sequence[str]) -> str | None:
        """Why files that are of this vendor's controllers cannot be read; None where none are.

        Args:
            names: as `root_in` takes them, with that of what the user named before them.
        """
        ...

    def open(self, source: Path, root: Path, find_robot: Callable[[str], Robot]) -> Backup:
        """The backup in a folder.

        Args:
            source: what the user named.
            root: the folder that `root_in` or `programs_in` told, on disk.
            find_robot: an arm by a name as people or controllers write it; raises `InputError`
                where there is none, or several may be meant.

        Raises:
            InputError: nothing of it can be read. What single files lack is noted instead.
        """
        ...
