"""The run ahead of the motion, which some statements and values stop, and with it the robot."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(slots=True)
class AdvanceRun:
    """What is known of it at a statement.

    Args:
        stopped: something was read that stops it, since somebody last set this to False.
        passed: a ``CONTINUE`` stands before the statement, which lets the robot pass.
    """

    stopped: bool = False
    passed: bool = False
