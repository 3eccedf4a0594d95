"""Numbers of a motion model by the keys of ``--fit``.

``blend.tcp.beta[0]``, ``time.settling_s``, ``limit.joint_acceleration_scale[3:]``,
``elasticity.carried[0].lead_s2_per_m2[1]``: the key of a figure as files have it, and where it
holds several numbers, which of them. A range (``[3:]``, ``[*]``) is one number for several entries.
"""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import replace
from typing import Any

from ...core.errors import InputError, UnknownNameError
from ...core.motion.model.figures import Figure, FitRange, Member, Tables, with_figures
from ...core.motion.model.kinds import RealNumber, Row
from ...core.motion.model.motion_model import FIGURES, MotionModel

Step = str | slice
"""A figure's name in a table, or which entries of several."""

_PART = re.compile(r"([A-Za-z]\w*)((?:\[[^\]]*\])*)")
_INDEX = re.compile(r"\[(?:(\*)|(\d+)|(\d*):(\d*))\]")


def figure_of(key: str) -> Figure:
    """The figure that a key belongs to.

    Raises:
        InputError: it is no key, or of no figure.
    """
    return _found(key)[0]


def fit_of(key: str) -> FitRange:
    """How the number at a key is fitted.

    Raises:
        InputError: there is no such key, or what stands there is not fitted.
    """
    one: Figure | Member
    one, steps = _found(key)
    names = [step for step in steps if isinstance(step, str)]
    if names:
        one = _member(one, names[0], key)
    if one.fit is None:
        raise InputError(f"{key!r} is not fitted: {one.help}")
    return one.fit


def value_of(model: MotionModel, key: str) -> float | None:
    """What a model has at a key; the mean where entries differ; None where it states nothing.

    Raises:
        InputError: there is no such key, or no number at it.
    """
    one, steps = _found(key)
    found = _numbers(one, one.of(model), steps, key)
    return None if not found else sum(found) / len(found)


def nothing(key: str) -> float:
    """What an entry of a list stands for that is not stated."""
    kind = figure_of(key).kind
    return kind.neutral if isinstance(kind, Row) else 0.0


def with_value(model: MotionModel, key: str, value: float) -> MotionModel:
    """The model with another value at a key; a list of numbers grows to an index beyond its end,
    by what stands for nothing.

    Raises:
        InputError: there is no such key, or the model refuses the value.
    """
    one, steps = _found(key)
    return with_figures(model, {one: _updated(one, one.of(model), steps, value, key)})


def _found(key: str) -> tuple[Figure, tuple[Step, ...]]:
    """The figure of a key, and the steps from it to the number."""
    steps, name = _steps(key), ""
    for k, step in enumerate(steps):
        if isinstance(step, slice):
            break
        name = f"{name}.{step}" if name else step
        if name in FIGURES:
            return FIGURES[name], steps[k + 1 :]
    raise UnknownNameError("key of a motion model", name, FIGURES)


def _steps(key: str) -> tuple[Step, ...]:
    steps: list[Step] = []
    for part in key.split("."):
        found = _PART.fullmatch(part)
        if found is None:
            raise InputError(f"{key!r} is no key of a motion model, such as time.smoothing_s[0]")
        steps.append(found[1])
        rest = found[2]
        while rest:
            index = _INDEX.match(rest)
            if index is None:
                raise InputError(f"{key!r}: an index is [2], [1:3] or [*], not {rest}")
            steps.append(_slice(index))
            rest = rest[index.end() :]
    return tuple(steps)


def _slice(index: re.Match[str]) -> slice:
    everything, one, begin, end = index.groups()
    if everything:
        return slice(None)
    if one is not None:
        return slice(int(one), int(one) + 1)
    return slice(int(begin) if begin else None, int(end) if end else None)


def _member(one: Figure | Member, name: str, key: str) -> Member:
    members = one.kind.members if isinstance(one.kind, Tables) else ()
    found = {member.key: member for member in members}
    if name not in found:
        known = f"; there are {', '.join(found)}" if found else ""
        raise InputError(f"{key!r}: nothing is called {name!r} there{known}")
    return found[name]


def _numbers(
    one: Figure | Member, value: Any, steps: Sequence[Step], key: str, entry: bool = False
) -> list[float]:
    """What stands below a figure's value, or one of its entries."""
    if not steps:
        _check_number(one, entry, key)
        return [] if value is None else [float(value)]
    step, rest = steps[0], steps[1:]
    if isinstance(step, slice):
        chosen = _entries(value, entry, key)[step]
        return [n for part in chosen for n in _numbers(one, part, rest, key, True)]
    member = _member(one, step, key)
    if not entry:
        raise InputError(f"{key!r}: several stand there; name one, such as {one.key}[0]")
    return _numbers(member, getattr(value, member.name), rest, key)


def _updated(
    one: Figure | Member,
    value: Any,
    steps: Sequence[Step],
    number: float,
    key: str,
    entry: bool = False,
) -> Any:
    """A figure's value, or one of its entries, with another number below it."""
    if not steps:
        _check_number(one, entry, key)
        return number
    step, rest = steps[0], steps[1:]
    if isinstance(step, slice):
        entries = list(_entries(value, entry, key))
        kind = one.kind
        if isinstance(kind, Row) and step.stop is not None and step.stop == (step.start or 0) + 1:
            entries += [kind.neutral] * (step.stop - len(entries))
        chosen = range(len(entries))[step]
        if not chosen:
            raise InputError(f"{key!r}: the motion model has {len(entries)} entries there")
        for k in chosen:
            entries[k] = _updated(one, entries[k], rest, number, key, True)
        return tuple(entries)
    member = _member(one, step, key)
    if not entry:
        raise InputError(f"{key!r}: several stand there; name one, such as {one.key}[0]")
    made = _updated(member, getattr(value, member.name), rest, number, key)
    return replace(value, **{member.name: made})


def _check_number(one: Figure | Member, entry: bool, key: str) -> None:
    """Refuse what is no number: of a list only an entry is one."""
    if not isinstance(one.kind, Row if entry else RealNumber):
        raise InputError(f"{key!r}: no number, or not a single one, stands there")


def _entries(value: Any, entry: bool, key: str) -> tuple[Any, ...]:
    if entry or not isinstance(value, tuple):
        raise InputError(f"{key!r}: no list stands there")
    return value
