"""Names in a station file: of signals that programs set and ask for, and of things that touch."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING

from ...core.errors import InputError, UnknownNameError

if TYPE_CHECKING:
    from ...core.station.actions import Action
    from ...core.station.station import StationRobot
    from ...core.station.station_file import StationFile

Members = Mapping[str, "StationRobot"]
Actions = Mapping[str, tuple["Action", ...]]


def check_names(file: StationFile, members: Members, actions: Actions) -> None:
    """Every name of a station file is one of its robots' and programs'.

    Links lead from outputs that are set to inputs that are waited for or looked at by logic, and to
    no output; logic looks at what something sets; what is ``given`` is looked at by someone, what
    is on at the beginning is known to someone; things that may touch are links, tools and
    obstacles.

    Args:
        file: the station file.
        members: its robots.
        actions: of their programs.

    Raises:
        InputError: a name is not known; the message has the nearest ones.
    """
    known = _Signals.of(file, actions)
    for wire in file.wires:
        if not known.sent(wire.source):
            _refuse(file, "links", "output that a program sets", wire.source, known.set)
        if not known.looked_at(wire.target):
            _refuse(file, "links", "input that a program waits for", wire.target, known.asked)
        if _key(wire.target) in known.set:
            raise InputError(
                f"{file.file}: links: {wire.target} is an output that its own robot sets: a link "
                "leads to an input"
            )
    sent = known.set | known.wired | known.gates
    on = {_key(name) for name in (*file.given, *file.initial)}
    led = set(known.set) | set(known.gates) | on
    for _ in file.wires:
        led |= {_key(wire.target) for wire in file.wires if _key(wire.source) in led}
    for wire in file.wires:
        if _key(wire.source) not in led:
            raise InputError(
                f"{file.file}: links: {wire.source}: links lead to it in a ring, and no output does"
            )
    for name, gate in file.gates.items():
        for one in (*gate.inputs, *gate.resets):
            if _key(one.name) not in led and not _said(one.name, members):
                error = UnknownNameError("signal that something sets", one.name, sent.values())
                why = "what nobody of the station sets stands in [given]"
                raise InputError(f"{file.file}: logic.{name}: {error} ({why})")
    for name in sorted(file.initial):
        if _key(name) not in {*sent, *known.asked, *known.used} and not _said(name, members):
            names = {**known.set, **known.asked, **known.gates}
            _refuse(file, "initial", "signal", name, names)
    for name in file.given:
        if not known.looked_at(name) and _key(name) not in sent and not _said(name, members):
            names = {**known.asked, **known.used}
            _refuse(file, "given", "input that someone looks at", name, names)
    if file.allowed:
        _check_things(file, members)


def _check_things(file: StationFile, members: Members) -> None:
    things = {f"{name}.{thing}" for name, one in members.items() for thing in _things(one)}
    for name in (name for pair in file.allowed for name in pair):
        if name not in things:
            _refuse(file, "allow.pairs", "thing", name, {thing: thing for thing in things})


def _refuse(file: StationFile, where: str, kind: str, name: str, known: Mapping[str, str]) -> None:
    raise InputError(f"{file.file}: {where}: {UnknownNameError(kind, name, known.values())}")


def _key(name: str) -> str:
    from ...core.station.station import signal_key

    return signal_key(name)


@dataclass(frozen=True)
class _Signals:
    """Signals by their keys, as they are written.

    Args:
        set: outputs that programs and zones set.
        asked: inputs that programs wait for.
        used: what logic looks at.
        wired: where links lead.
        gates: what logic makes.
    """

    set: dict[str, str]
    asked: dict[str, str]
    used: dict[str, str]
    wired: dict[str, str]
    gates: dict[str, str]

    @classmethod
    def of(cls, file: StationFile, actions: Actions) -> _Signals:
        from ...core.station.plc import PLC

        inputs = [one for gate in file.gates.values() for one in (*gate.inputs, *gate.resets)]
        zones = [f"{zone.robot}.{zone.signal}" for zone in file.zones]
        kinds = (
            [*_set_by(actions), *zones],
            _asked_by(actions),
            [one.name for one in inputs],
            [wire.target for wire in file.wires],
            [f"{PLC}.{name}" for name in file.gates],
        )
        return cls(*({_key(name): name for name in names} for names in kinds))

    def sent(self, name: str) -> bool:
        """Whether something sets it, or may."""
        return _key(name) in self.set | self.wired | self.gates

    def looked_at(self, name: str) -> bool:
        """Whether something waits for it or depends on it."""
        return _key(name) in self.asked | self.used


def _set_by(actions: Actions) -> Iterator[str]:
    from ...core.program.signal import SetSignal

    for name, doings in actions.items():
        for action in doings:
            if isinstance(action.does, SetSignal):
                yield f"{name}.{action.does.name}"


def _asked_by(actions: Actions) -> Iterator[str]:
    from ...core.program.signal import WaitSignal, levels

    for name, doings in actions.items():
        for action in doings:
            if isinstance(action.does, WaitSignal):
                for level in levels(action.does.condition):
                    yield f"{name}.{level.name}"


def _said(name: str, members: Members) -> bool:
    """Whether a robot's program names a signal in a statement that nobody understands."""
    from ...core.program.move import Opaque

    robot, _, signal = name.partition(".")
    bare = _key(signal)
    return any(
        bare in _key(statement.text)
        for own, member in members.items()
        if own.casefold() == robot.strip().casefold()
        for statement in member.program.statements
        if isinstance(statement, Opaque)
    )


def _things(member: StationRobot) -> set[str]:
    """Links, tools, obstacles and parts of a robot, as pairs that may touch call them."""
    from ...core.collision.scene.bodies import bodies_of

    tools = dict.fromkeys(move.tool for move in member.program.moves)
    found = {body.part for tool in tools for body in bodies_of(member.cell, tool).bodies}
    return found | set(member.cell.tool_geometries) | {part.name for part in member.cell.parts}
