"""Readers of logs and exporters of runs, as plugins hand them over."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from ..motion.emulator.run import Run
    from ..robot.model import Robot


@dataclass(frozen=True, slots=True)
class LogForm:
    """A form of logs that flyby does not know by itself.

    Args:
        name: in lower case, for messages and ``flyby vendors``.
        summary: whose logs these are, in one line.
        recognises: whether a file is one; it looks at no more of it than that takes. It is asked
            before flyby's own forms are, so it must not take what is another's.
        read: the samples of a file: times (T,) s, increasing, and joints (T, N) in rad and m, the
            arm's first (`flyby.identification.logs.samples.LogSamples`). What is wrong in the file
            it says by `InputError`, with the line.
    """

    name: str
    summary: str
    recognises: Callable[[Path], bool]
    read: Callable[[Path, Robot], Any]


@dataclass(frozen=True, slots=True)
class Exporter:
    """What writes a driven program for other software.

    Args:
        name: in lower case.
        summary: what for, in one line.
        suffixes: of its files, with the dot, in lower case; a file is its by its suffix.
        export: the bytes of the file of a run.
    """

    name: str
    summary: str
    suffixes: tuple[str, ...]
    export: Callable[[Run], bytes]
