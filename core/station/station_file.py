"""The station file: TOML that names the robots' cells and programs, and joins their signals.

See ``docs/reference/station.md`` for its keys.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

from ..errors import InputError
from ..files.tables import LENGTH, TomlTable
from ..program.world_zone import WorldZone
from ..robot.pose_table import pose_at
from ..spatial.pose import IDENTITY, Pose
from .plc import PLC
from .station import (
    Gate,
    GateKind,
    HandOver,
    HeldTogether,
    Input,
    Wire,
    signal_key,
)

_DELAY = {"ms": 1e-3, "s": 1.0}
_LONGEST = 60.0
_CONFIGURATIONS = ("exact", "nearest")


@dataclass(frozen=True, slots=True)
class MemberFile:
    """What a station file says of one robot.

    Args:
        name: of the robot in its station.
        cell: its cell file; None where the program is a backup that says it all.
        program: file, folder or backup.
        entry, task, answers, start, configuration: as options of commands have them.
        begins: s after the station's start.
        world: where what its controller calls the world is in the station's.
    """

    name: str
    cell: Path | None
    program: Path
    entry: str | None
    task: str | None
    answers: Path | None
    start: str | None
    configuration: str | None
    begins: float
    world: Pose = IDENTITY


@dataclass(frozen=True)
class StationFile:
    """A station file, read; the names of its signals are not checked yet.

    Args:
        members: the robots.
        wires, gates, initial, given: what joins their signals; see `RobotStation`.
        clearance: m.
        allowed: pairs of ``robot.thing``.
        file: that it is.
        zones: spaces with outputs.
        hand_overs: parts that robots hand to each other.
        held_together: parts that two robots carry together.
    """

    members: tuple[MemberFile, ...]
    wires: tuple[Wire, ...]
    gates: Mapping[str, Gate]
    initial: frozenset[str]
    given: Mapping[str, bool]
    clearance: float
    allowed: tuple[tuple[str, str], ...]
    file: Path
    zones: tuple[WorldZone, ...] = ()
    hand_overs: tuple[HandOver, ...] = ()
    held_together: tuple[HeldTogether, ...] = ()


def read_station_file(path: str | Path) -> StationFile:
    """Read a station file.

    Raises:
        InputError: a file is missing or no TOML, or a key is missing, unknown or of a wrong kind;
            the message names file and key.
    """
    file = TomlTable.read(path)
    clearance = file.quantity("clearance", LENGTH, 0.0)
    if clearance < 0:
        raise file.error("clearance", "must be zero or more")
    members = tuple(_member(name, t) for name, t in file.named_tables("robot").items())
    if len(members) < 2:
        raise file.error("robot", "a station has two robots or more: [robot.left], [robot.right] …")
    for member in members:
        if member.name.casefold() == PLC or "." in member.name:
            raise file.error(f"robot.{member.name}", f"a robot cannot be called {member.name!r}")
    gates, outputs = _gates(file)
    wires = (*_links(file), *outputs)
    initial = frozenset(file.texts("initial") if file.has("initial") else ())
    given_table = file.table("given")
    given = {name: given_table.flag(name, False) for name in given_table.data}
    allow = file.table("allow")
    pairs = allow.value("pairs") if allow.has("pairs") else []
    allow.finish()
    if not isinstance(pairs, list) or not all(
        isinstance(pair, list) and len(pair) == 2 and all(isinstance(n, str) for n in pair)
        for pair in pairs
    ):
        raise allow.error("pairs", 'must be pairs of names, [["left.gun", "right.fixture"]]')
    zones = tuple(_zone(name, table) for name, table in file.named_tables("zone").items())
    hand_overs = tuple(
        _hand_over(table, {member.name.casefold(): member.name for member in members})
        for table in file.listed_tables("hand_over")
    )
    held_together = tuple(
        _held_together(table, {member.name.casefold(): member.name for member in members})
        for table in file.listed_tables("held_together")
    )
    file.finish()
    names = {member.name.casefold() for member in members} | {PLC}
    made = StationFile(
        members,
        wires,
        gates,
        initial,
        given,
        clearance,
        tuple((a, b) for a, b in pairs),
        Path(path),
        zones,
        hand_overs,
        held_together,
    )
    _check_robots(made, names)
    return made


def _member(name: str, table: TomlTable) -> MemberFile:
    folder = table.file.parent
    program = folder / table.text("program")
    if not program.exists():
        raise table.error("program", f"there is no file {program}")
    made = MemberFile(
        name,
        table.existing_file("cell") if table.has("cell") else None,
        program,
        table.text("entry") if table.has("entry") else None,
        table.text("task") if table.has("task") else None,
        table.existing_file("answers") if table.has("answers") else None,
        table.text("start") if table.has("start") else None,
        table.choice("configuration", _CONFIGURATIONS) if table.has("configuration") else None,
        table.quantity("begins", _DELAY, 0.0),
        pose_at(table, "world"),
    )
    if made.begins < 0:
        raise table.error("begins", "must be zero or more")
    table.finish()
    return made


def _links(file: TomlTable) -> tuple[Wire, ...]:
    """``[links]``: ``"left.doReady" = "right.diGo"``, a list, or a table with a delay."""
    table = file.table("links")
    found: list[Wire] = []
    for source in table.data:
        value = table.value(source)
        if isinstance(value, Mapping):
            link = table.table(source)
            targets = link.value("to")
            least, greatest = _delay(link)
            link.finish()
        else:
            targets, least, greatest = value, 0.0, 0.0
        found += _wires(table, source, source, targets, least, greatest)
    return tuple(found)


def _wires(
    table: TomlTable, key: str, source: str, targets: object, least: float, greatest: float
) -> list[Wire]:
    several = targets if isinstance(targets, list) else [targets]
    for target in several:
        if not isinstance(target, str):
            raise table.error(key, f"must name signals, not {target!r}")
    return [Wire(source, str(target), least, greatest) for target in several]


def _delay(table: TomlTable) -> tuple[float, float]:
    """``delay_ms``: a number, or the least and the greatest."""
    name = table.unit_key("delay", _DELAY)
    if name is None:
        return 0.0, 0.0
    if isinstance(table.value(name), list):
        least, greatest = table.quantities("delay", _DELAY, 2)
    else:
        least = greatest = table.quantity("delay", _DELAY)
    if not 0.0 <= least <= greatest <= _LONGEST:
        raise table.error(name, "is the least and the greatest, from zero to a minute")
    return least, greatest


def _gates(file: TomlTable) -> tuple[dict[str, Gate], tuple[Wire, ...]]:
    gates: dict[str, Gate] = {}
    wires: list[Wire] = []
    for name, table in file.named_tables("logic").items():
        gates[name] = _gate(table)
        if table.has("to"):
            least, greatest = _delay(table)
            wires += _wires(table, "to", f"{PLC}.{name}", table.value("to"), least, greatest)
        table.finish()
    return gates, tuple(wires)


def _gate(table: TomlTable) -> Gate:
    kinds = [kind for kind in GateKind if table.has(kind.value)]
    if len(kinds) != 1:
        known = ", ".join(kind.value for kind in GateKind)
        raise table.error("", f"needs one of {known}")
    kind = kinds[0]
    if kind in (GateKind.AND, GateKind.OR):
        return Gate(kind, _inputs(table, kind.value))
    inner = table.table(kind.value)
    match kind:
        case GateKind.LATCH:
            gate = Gate(kind, _inputs(inner, "set"), _inputs(inner, "reset"))
        case GateKind.COUNTER:
            resets = _inputs(inner, "reset") if inner.has("reset") else ()
            least = inner.number("at")
            if least < 1 or least != int(least):
                raise inner.error("at", "is a whole number from 1 on")
            gate = Gate(kind, _inputs(inner, "of"), resets, least=int(least))
        case _:
            gate = Gate(kind, _inputs(inner, "of"), delay=inner.quantity("after", _DELAY))
            if gate.delay < 0:
                raise inner.error("after", "must be zero or more")
    inner.finish()
    return gate


def _zone(name: str, table: TomlTable) -> WorldZone:
    """``[zone.NAME]``: ``signal = "left.doInside"`` with a box, a ball or ranges of axes."""
    robot, dot, signal = table.text("signal").partition(".")
    if not dot or not signal.strip():
        raise table.error("signal", "names an output of a robot: left.doInside")
    corners = table.quantities("box", LENGTH, 6) if table.unit_key("box", LENGTH) else None
    ball = table.quantities("ball", LENGTH, 4) if table.unit_key("ball", LENGTH) else None
    axes, linear = _ranges(table, "axes_deg"), _ranges(table, "axes_mm")
    cylinder = (
        table.quantities("cylinder", LENGTH, 5) if table.unit_key("cylinder", LENGTH) else None
    )
    if corners is None and ball is None and cylinder is None and not (axes or linear):
        raise table.error("", "needs box_mm, ball_mm, cylinder_mm, axes_deg or axes_mm")
    if corners is not None and any(corners[k] == corners[k + 3] for k in range(3)):
        raise table.error("box_mm", "is two corners with space between: [x, y, z, x, y, z]")
    if ball is not None and ball[3] <= 0.0:
        raise table.error("ball_mm", "is a centre and a radius above zero: [x, y, z, r]")
    if cylinder is not None and (cylinder[3] <= 0.0 or cylinder[4] == 0.0):
        raise table.error(
            "cylinder_mm",
            "is the centre of one end, a radius above zero and a height: [x, y, z, r, h]",
        )
    inside = table.flag("inside", True)
    table.finish()
    return WorldZone(
        name,
        robot.strip(),
        signal.strip(),
        inside,
        None if corners is None else (_point(corners[:3]), _point(corners[3:])),
        None if ball is None else (_point(ball[:3]), ball[3]),
        None if cylinder is None else (_point(cylinder[:3]), cylinder[3], cylinder[4]),
        tuple((k, math.radians(low), math.radians(high)) for k, low, high in axes),
        tuple((k, 1e-3 * low, 1e-3 * high) for k, low, high in linear),
    )


def _hand_over(table: TomlTable, robots: Mapping[str, str]) -> HandOver:
    """``[[hand_over]]``: ``part = "left.crate"``, ``to = "right.crate"``."""
    found: list[str] = []
    for key in ("part", "to"):
        robot, dot, part = table.text(key).partition(".")
        if not dot or not part.strip():
            raise table.error(key, "names a part of a robot's cell: left.crate")
        found += [robots.get(robot.strip().casefold(), robot.strip()), part.strip()]
    table.finish()
    if found[0] == found[2]:
        raise table.error("to", "is a part of another robot's cell")
    return HandOver(*found)


def _held_together(table: TomlTable, robots: Mapping[str, str]) -> HeldTogether:
    """``[[held_together]]``: ``part = "left.bar"``, ``by = "right"``."""
    robot, dot, part = table.text("part").partition(".")
    if not dot or not part.strip():
        raise table.error("part", "names a part of a robot's cell: left.bar")
    holder = robots.get(robot.strip().casefold(), robot.strip())
    other = table.choice("by", [name for name in robots.values() if name != holder])
    table.finish()
    return HeldTogether(holder, part.strip(), other)


def _ranges(table: TomlTable, key: str) -> list[tuple[int, float, float]]:
    """Axes by index with the range of each, in the file's unit."""
    given = table.value(key) if table.has(key) else []
    if not isinstance(given, list) or not all(map(_is_range, given)):
        raise table.error(key, "holds the number of an axis with its range: [[1, -30, 30]]")
    return [(int(number) - 1, low, high) for number, low, high in given]


def _is_range(given: object) -> bool:
    if not isinstance(given, list) or len(given) != 3:
        return False
    numbers = all(isinstance(v, int | float) and not isinstance(v, bool) for v in given)
    return numbers and given[0] == int(given[0]) >= 1 and given[1] < given[2]


def _point(given: Sequence[float]) -> tuple[float, float, float]:
    x, y, z = given
    return x, y, z


def _inputs(table: TomlTable, key: str) -> tuple[Input, ...]:
    value = table.value(key)
    texts = value if isinstance(value, list) else [value]
    if not texts or not all(isinstance(text, str) and text.strip() for text in texts):
        raise table.error(key, 'names signals: "left.doReady", "not right.doInside"')
    return tuple(map(Input.read, texts))


def _check_robots(made: StationFile, names: set[str]) -> None:
    """Every signal is one of a robot of the station, or of the PLC."""
    told = [(f"links: {wire.source}", wire.source) for wire in made.wires]
    told += [(f"links: {wire.target}", wire.target) for wire in made.wires]
    told += [
        (f"logic.{name}", one.name)
        for name, gate in made.gates.items()
        for one in (*gate.inputs, *gate.resets)
    ]
    told += [(f"zone.{zone.name}", f"{zone.robot}.{zone.signal}") for zone in made.zones]
    told += [("initial", name) for name in made.initial]
    told += [("given", name) for name in made.given]
    told += [("allow.pairs", name) for pair in made.allowed for name in pair]
    told += [
        ("hand_over", f"{robot}.{part}")
        for each in made.hand_overs
        for robot, part in ((each.giver, each.given), (each.taker, each.taken))
    ]
    told += [("held_together", f"{each.holder}.{each.part}") for each in made.held_together]
    gates = {signal_key(f"{PLC}.{name}") for name in made.gates}
    for where, name in told:
        robot, dot, rest = name.partition(".")
        known = ", ".join([member.name for member in made.members])
        if not dot or not rest or robot.strip().casefold() not in names:
            raise InputError(
                f"{made.file}: {where}: {name!r} is of no robot of the station; write "
                f"ROBOT.SIGNAL, with one of {known}, or plc.NAME for what [logic.NAME] makes"
            )
        if robot.strip().casefold() == PLC and signal_key(name) not in gates:
            raise InputError(f"{made.file}: {where}: there is no [logic.{rest}]")
