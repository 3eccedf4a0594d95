"""What stands in a move instruction: targets, speeds, zones, tools, work objects, loads.

Each function gives the name of a predefined datum, or a `NewDatum` that the module will declare.
What RAPID cannot say is an `InputError`; the writer adds which move it was.
"""

from __future__ import annotations

import math

from ....core.errors import InputError
from ....core.program.speed import Speed
from ....core.program.target import Configuration, JointTarget, PoseTarget
from ....core.program.tool import FLANGE, WORLD, Load, Tool, WorkObject
from ....core.program.zone import Fine, Radius, Zone, zone_word
from ....core.source.write.declarations import NewDatum
from ..motion.configuration import AbbConfiguration
from ..values.predefined import NAMES, SPEEDS, ZONES
from ..values.records import (
    ARM_AXES,
    EXTERNAL_AXES,
    MM,
    UNUSED_AXIS,
    Record,
    arm_axes,
    extax_values,
    load_record,
    pose_record,
    speed_record,
    tool_record,
    work_object_record,
    zone_record,
)
from .declarations import Declarations, sized
from .formatting import literal
from .options import RapidOptions, ZoneStyle

Operand = str | NewDatum

UNSTATED_CONFIGURATION: Record = (0.0, 0.0, 0.0, 0.0)

_SPEED_NAMES = {literal(record): name for name, record in SPEEDS.items()}
_ZONE_NAMES = {literal(record): name for name, record in ZONES.items()}


class Operands:
    """The operands of one module's instructions."""

    def __init__(self, options: RapidOptions) -> None:
        self._options = options
        self.declarations = Declarations()

    def robtarget(self, target: PoseTarget) -> Operand:
        """``[trans, rot, robconf, extax]`` (robtarget)."""
        record = (
            *pose_record(target.pose),
            _configuration(target.configuration),
            self._extax(target),
        )
        return self.declarations.add("robtarget", record, target.name)

    def jointtarget(self, target: JointTarget) -> Operand:
        """``[robax, extax]`` (jointtarget)."""
        axes = arm_axes(self._options.external_axes)
        if len(target.joints) != axes:
            raise InputError(
                f"a jointtarget has {axes} arm axes, but the target has {len(target.joints)}"
            )
        record = (tuple(map(math.degrees, target.joints[:ARM_AXES])), self._extax(target))
        return self.declarations.add("jointtarget", record, target.name)

    def speed(self, speed: Speed) -> Operand:
        """A speeddata: a name from the source, else a predefined one, else one of its own."""
        refuse_speed(speed)
        record = speed_record(speed)
        # A duration overrules the speed, which the reader then takes for a literal at the move.
        name = None if speed.duration is not None else _own_name(speed.name)
        if name is None and literal(record) in _SPEED_NAMES:
            return _SPEED_NAMES[literal(record)]
        return self.declarations.add("speeddata", record, name, sized("v", record[0]))

    def zone(self, zone: Zone) -> Operand:
        """A zonedata: as for speeds, or the predefined one that fits in."""
        if not isinstance(zone, Fine | Radius):
            raise InputError(
                f"RAPID has no zone by {zone_word(zone)}: give it a radius (TCP distance)"
            )
        if self._options.zones is ZoneStyle.PREDEFINED:
            return predefined_within(zone)
        record = zone_record(zone)
        name = _own_name(zone.name) if isinstance(zone, Radius) else None
        if name is None and literal(record) in _ZONE_NAMES:
            return _ZONE_NAMES[literal(record)]
        return self.declarations.add("zonedata", record, name, sized("z", record[1]))

    def tool(self, tool: Tool) -> Operand:
        """A tooldata; ``tool0`` for the bare flange."""
        if tool == FLANGE:
            return FLANGE.name
        return self.declarations.add("tooldata", tool_record(tool), tool.name, "tool")

    def work_object(self, work_object: WorkObject) -> Operand:
        """A wobjdata; ``wobj0`` for the world."""
        if work_object == WORLD:
            return WORLD.name
        record = work_object_record(work_object)
        return self.declarations.add("wobjdata", record, work_object.name, "wobj")

    def load(self, load: Load | None) -> Operand:
        """A loaddata; ``load0`` for nothing."""
        if load is None:
            return "load0"
        return self.declarations.add("loaddata", load_record(load), load.name, "load1")

    def _extax(self, target: PoseTarget | JointTarget) -> Record:
        """``extax``: mm or degrees, ``9E9`` for axes that are not positioned."""
        kinds = self._options.external_axes
        values = extax_values(target, kinds)
        if len(values) > len(kinds):
            raise InputError(
                f"the target has {len(values)} external axes, of which the writer knows "
                f"{len(kinds)}: tell it the robot's axes (external_axes=('linear',) or "
                "('rotating',))"
            )
        used = [
            UNUSED_AXIS
            if value is None
            else (value / MM if kind == "linear" else math.degrees(value))
            for value, kind in zip(values, kinds, strict=False)
        ]
        return (*used, *[UNUSED_AXIS] * (EXTERNAL_AXES - len(used)))


def predefined_within(zone: Fine | Radius) -> str:
    """The largest predefined zone whose TCP radius is not above that of ``zone``."""
    # The shortest decimal is what both sides are written as; compare what the text will say.
    limit = 0.0 if isinstance(zone, Fine) else zone.tcp / MM * (1 + 1e-7)
    fitting = {name: record[1] for name, record in ZONES.items() if record[1] <= limit}
    return max(fitting, key=fitting.__getitem__)


def _own_name(name: str | None) -> str | None:
    """A name that is not the controller's own."""
    return None if name is None or name.casefold() in NAMES else name


def _configuration(configuration: Configuration | None) -> Record:
    """``robconf`` (confdata)."""
    if configuration is None:
        return UNSTATED_CONFIGURATION
    if not isinstance(configuration, AbbConfiguration):
        raise InputError(
            f"{configuration} is no confdata: label the target's solution for this robot, or take "
            "the configuration away"
        )
    return configuration.record


_NOT_IN_RAPID = {
    "joint": "a joint speed in rad/s",
    "joint_acceleration": "a joint acceleration in rad/s²",
    "reorientation_acceleration": "a limit on the acceleration of reorientation",
}


def refuse_speed(speed: Speed) -> None:
    """Refuse what no speeddata and no setting says.

    Raises:
        InputError: naming the field.
    """
    for field, what in _NOT_IN_RAPID.items():
        if getattr(speed, field) is not None:
            raise InputError(f"RAPID has no words for {what} (Speed.{field}): take it away")
    if speed.joint_fraction != 1.0:
        raise InputError(
            f"RAPID cannot hold the joints to {speed.joint_fraction:.0%} of their speed (VelSet "
            "scales the programmed speed, not the joints'): give the move a TCP speed or a duration"
        )
