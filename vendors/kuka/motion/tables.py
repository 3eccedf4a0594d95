"""Bases on tables: ``EK(root, type, offset)``, and what ``$CONFIG.DAT`` links to one."""

from __future__ import annotations

from dataclasses import dataclass

from ....core.errors import Span
from ....core.robot.joint import ExternalRole
from ....core.robot.model import Robot
from ....core.source.execution.transcript import Notes
from ..values.operators import chained
from ..values.values import Struct, Value


@dataclass(frozen=True, slots=True)
class Tables:
    """The tables of the robot.

    Args:
        robot: None if none is named.
    """

    robot: Robot | None
    notes: Notes

    def base_on(self, root: Struct | None, offset: Struct, said: str, span: Span) -> Value:
        """A base on the robot's table; of a robot that has none, or several, it stands still.

        Args:
            root: of the table in the world; None if it is not known.
            offset: the base on the table.
            said: what couples it, for notes.
        """
        robot = self.robot
        axes = () if robot is None else robot.external_axes
        carriers = {axis.carried_by for axis in axes}
        tables = [
            axis.name
            for axis in axes
            if axis.role is ExternalRole.TABLE and axis.name not in carriers
        ]
        made = offset.copy()
        if len(tables) != 1:
            have = "no robot is named" if robot is None else f"the robot has {len(tables)} tables"
            self.notes.once(
                "EK",
                f"{said} couples the base to an external kinematic system, but {have}: the "
                f"base is taken to stand still at {'the world' if root is None else 'its root'}; "
                "describe the one table that is meant in a cell file, [external_axis.…], and name "
                "that",
                span,
            )
            return made if root is None else chained(root, made)
        made.moved_by = tables[0]
        self.notes.once(
            "EK", f"{said}: the base is on {tables[0]}, at its place in the robot's cell", span
        )
        return made
