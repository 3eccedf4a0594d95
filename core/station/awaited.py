"""Which signals are waited for, and which actions of programs bear on what others do."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

from ..program.signal import Meet, SetSignal, WaitSignal, levels
from .actions import Action
from .plc import PLC
from .station import RobotStation, signal_key

Actions = Mapping[str, Sequence[Action]]


def awaited(station: RobotStation, actions: Actions) -> set[str]:
    """Keys of the signals that are waited for, and of those that lead to them.

    Args:
        station: with its wires and gates.
        actions: of each robot.
    """
    wanted = {
        signal_key(f"{name}.{level.name}")
        for name, doings in actions.items()
        for action in doings
        if isinstance(action.does, WaitSignal)
        for level in levels(action.does.condition)
    }
    gates = {signal_key(f"{PLC}.{name}"): gate for name, gate in station.gates.items()}
    wires = [(signal_key(wire.source), signal_key(wire.target)) for wire in station.wires]
    known = -1
    while len(wanted) > known:
        known = len(wanted)
        wanted |= {source for source, target in wires if target in wanted}
        for key, gate in gates.items():
            if key in wanted:
                wanted |= {signal_key(one.name) for one in (*gate.inputs, *gate.resets)}
    return wanted


def bearing(station: RobotStation, actions: Actions) -> dict[str, tuple[Action, ...]]:
    """The actions that bear on when something happens: the others change no order.

    Left out are outputs that nobody looks at, such as those of a welding gun, and waits for inputs
    that nobody of the station sets, which hold nobody up.

    Args:
        station: with its wires and gates.
        actions: of each robot.
    """
    wanted = awaited(station, actions)
    known = {signal_key(wire.target) for wire in station.wires}
    known |= {signal_key(name) for name in (*station.given, *station.initial)}
    known |= {
        signal_key(f"{name}.{action.does.name}")
        for name, doings in actions.items()
        for action in doings
        if isinstance(action.does, SetSignal)
    }

    def bears(name: str, action: Action) -> bool:
        match action.does:
            case SetSignal(output):
                return signal_key(f"{name}.{output}") in wanted
            case WaitSignal(condition):
                inputs = {signal_key(f"{name}.{level.name}") for level in levels(condition)}
                return not inputs.isdisjoint(known)
            case Meet():
                return True

    return {
        name: tuple(action for action in doings if bears(name, action))
        for name, doings in actions.items()
    }
