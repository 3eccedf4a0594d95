"""The calls that change what holds for the moves behind them."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from typing import TYPE_CHECKING

from ....core.errors import InputError, SourceError
from ..syntax.tree import Call
from ..values.arguments import bind
from ..values.instructions import Kept
from ..values.located import NOTHING, Located
from ..values.poses import pose_of
from ..values.scope import Scope
from ..values.values import Value, ValueFault, find_unknown
from .settings import DEFAULT_NAME, Settings, centre_of, inertia_of, mass_of

if TYPE_CHECKING:
    from ..run.interpreter import Interpreter

Change = Callable[[Settings, dict[str, Value]], Settings]


def _set_tcp(settings: Settings, values: dict[str, Value]) -> Settings:
    name = values.get("tcp_name")
    return replace(
        settings,
        tcp=pose_of(values["pose"], "the TCP"),
        name=name if isinstance(name, str) and name else DEFAULT_NAME,
        stated=True,
        unknown=None,
    )


def _set_payload(settings: Settings, values: dict[str, Value]) -> Settings:
    """Without a centre of gravity the TCP is it; the payload has no inertia of its own."""
    centre = centre_of(values["cog"]) if "cog" in values else None
    return replace(settings, mass=mass_of(values["m"]), centre=centre, inertia=(0.0,) * 6)


def _set_target_payload(settings: Settings, values: dict[str, Value]) -> Settings:
    inertia = inertia_of(values["inertia"]) if "inertia" in values else (0.0,) * 6
    return replace(_set_payload(settings, values), inertia=inertia)


def _set_payload_mass(settings: Settings, values: dict[str, Value]) -> Settings:
    return replace(settings, mass=mass_of(values["m"]))


def _set_payload_cog(settings: Settings, values: dict[str, Value]) -> Settings:
    return replace(settings, centre=centre_of(values["CoG"]))


_CALLS: dict[str, tuple[Change, tuple[str, ...], int]] = {
    "set_tcp": (_set_tcp, ("pose", "tcp_name"), 1),
    "set_payload": (_set_payload, ("m", "cog"), 1),
    "set_target_payload": (
        _set_target_payload,
        ("m", "cog", "inertia", "transition_time"),
        2,
    ),
    "set_payload_mass": (_set_payload_mass, ("m",), 1),
    "set_payload_cog": (_set_payload_cog, ("CoG", "transition_time"), 1),
}


_UNKNOWN_PAYLOAD = Kept("set a payload that is not known, where the one before stays in force")


def _change(run: Interpreter, call: Call, scope: Scope) -> Located:
    change, parameters, required = _CALLS[call.name]
    given = bind(call, parameters, required, run.texts)
    values = {name: run.evaluator.evaluate(a.value, scope) for name, a in given.items()}
    span = run.texts.span(call.start, call.end)
    unknown = find_unknown(tuple(values.values()))
    if unknown is not None and call.name == "set_tcp":
        run.settings = replace(run.settings, stated=True, unknown=unknown)
        return NOTHING
    if unknown is not None:
        run.calls.keep_call(call, _UNKNOWN_PAYLOAD, call.name)
        return NOTHING
    try:
        run.settings = change(run.settings, values)
        _ = run.settings.tool
    except (ValueFault, InputError) as error:
        raise SourceError(f"{call.name}: {error}", span) from None
    return NOTHING


SETTINGS = dict.fromkeys(_CALLS, _change)
