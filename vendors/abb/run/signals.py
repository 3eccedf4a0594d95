r"""Instructions on signals.

"RAPID Reference Manual", instructions Set, Reset, SetDO, SetAO, SetGO, PulseDO, InvertDO, AliasIO,
WaitDO, WZDOSet, IODisable.
"""

from __future__ import annotations

from ....core.source.text.lexer import words
from ..syntax.tree import Invoke, Name, Text
from ..values.arguments import bind
from ..values.outputs import WRITING, held, write
from ..values.scope import Scope
from ..values.types import Unknown, Value
from .handlers import Keeping, KeepingHandler

_VALUES = {"set": 1.0, "reset": 0.0}


def _write(run: Keeping, invoke: Invoke, scope: Scope) -> None:
    """``Set do1``, ``SetDO [\\SDelay] [\\Sync] do1, 1``, ``SetGO [\\SDelay] go1, 5``, …"""
    given = [a.value for a in invoke.arguments if a.option is None and a.value is not None]
    options = {a.option for a in invoke.arguments}
    value: Value | None = _VALUES.get(invoke.name)
    if invoke.name == "invertdo" and given:
        before = held(run.evaluator, given[0], scope)
        value = None if before is None else 1.0 - before
    elif invoke.name in ("setdo", "setao", "setgo") and len(given) > 1:
        value = run.evaluator.evaluate(given[1], scope)
        if invoke.name == "setdo" and isinstance(value, float):
            value = float(value != 0)  # a number other than zero is taken as 1
    run.keep(invoke, scope)
    certain = isinstance(value, float) and "sdelay" not in options
    if given:
        write(run.evaluator, given[0], value if certain else None, scope)


def _supervised(run: Keeping, invoke: Invoke, scope: Scope) -> None:
    """``WZDOSet [\\Temp] | [\\Stat] WorldZone, \\Inside | \\Before, Signal, SetValue``"""
    run.keep(invoke, scope)
    given = [a.value for a in invoke.arguments if a.option is None and a.value is not None]
    names = {run.evaluator.signal(e, scope) for e in given if isinstance(e, Name)}
    run.evaluator.outputs.share(name for name in names if name is not None)


def _waited(run: Keeping, invoke: Invoke, scope: Scope) -> None:
    """``WaitDO do1, 1``, ``WaitGO go1, 5``: it is so afterwards, or in the range that is given."""
    run.keep(invoke, scope)
    given = [a.value for a in invoke.arguments if a.option is None and a.value is not None]
    if len(given) != 2:
        return
    value = run.evaluator.evaluate(given[1], scope)
    ranges = {"lt", "gt", "noteq", "maxtime", "timeflag"} & {a.option for a in invoke.arguments}
    before = held(run.evaluator, given[0], scope)
    if before is not None and before != value:
        certain = isinstance(value, float) and not ranges
        write(run.evaluator, given[0], value if certain else None, scope)


def _alias(run: Keeping, invoke: Invoke, scope: Scope) -> None:
    """``AliasIO do1, alias``: one signal under two names."""
    run.keep(invoke, scope)
    original, alias = bind(invoke, ("FromSignal", "ToSignal"), ()).required
    key = None
    if isinstance(original, Text):
        key = original.value.lower()
    elif isinstance(original, Name):
        key = run.evaluator.signal(original, scope)
    cell = scope.find(alias.name) if isinstance(alias, Name) else None
    if isinstance(alias, Name) and cell is not None and not cell.constant and key is not None:
        run.evaluator.assign(alias, Unknown(f"'{alias.text}'", alias.span, key), scope)
    else:
        run.evaluator.outputs.forget()


def _unsettle(run: Keeping, invoke: Invoke, scope: Scope) -> None:
    """A unit is switched off, or names are given back: any output may hold something else."""
    run.keep(invoke, scope)
    run.evaluator.outputs.forget()


SIGNALS: dict[str, KeepingHandler] = {
    **dict.fromkeys(WRITING - {"wzdoset"}, _write),
    "wzdoset": _supervised,
    **dict.fromkeys(words("waitdo waitao waitgo"), _waited),
    "aliasio": _alias,
    **dict.fromkeys(words("aliasioreset iodisable cleariobuff clearioboff"), _unsettle),
}
