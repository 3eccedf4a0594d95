"""Whether what was read stops the advance run, and with it the robot."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(slots=True)
class AdvanceRun:
    """The run ahead of the motion.

    Args:
        stopped: something was read that stops it, since somebody last set this to False.
    """

    stopped: bool = False
