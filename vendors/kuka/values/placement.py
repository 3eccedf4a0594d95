"""Where poses are meant: tool, work object and payload of a move."""

from __future__ import annotations

from dataclasses import dataclass

from ....core.program.tool import Load, Tool, WorkObject


@dataclass(frozen=True, slots=True)
class Placement:
    """Tool, work object and payload of a move."""

    tool: Tool
    work_object: WorkObject
    load: Load | None
