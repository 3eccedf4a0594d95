"""Figures of a motion model by the keys of its file.

``blend.tcp.beta[0]``, ``time.settling_s``, ``limit.joint_acceleration_scale[3:]``,
``elasticity.carried[0].lead_s2_per_m2[1]``: a part of a key is the field's name, maybe followed by
its unit; tables that only group the file (``time``, ``limit``) name no field. What a model gains in
figures is found without further code as long as it keeps to that. A range (``[3:]``, ``[*]``) is
one figure for several entries.
"""

from __future__ import annotations

import dataclasses
import re
from collections.abc import Collection, Sequence
from typing import TYPE_CHECKING, Any

from ...core.errors import InputError
from ...core.motion.model.motion_model import MotionModel

if TYPE_CHECKING:
    from _typeshed import DataclassInstance

Step = str | slice
"""A field's name in the file, or which entries of a list."""

_PART = re.compile(r"([A-Za-z]\w*)((?:\[[^\]]*\])*)")
_INDEX = re.compile(r"\[(?:(\*)|(\d+)|(\d*):(\d*))\]")


def steps_of(key: str) -> tuple[Step, ...]:
    """The parts of a key.

    Raises:
        InputError: it is no key.
    """
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


def figure_of(key: str, figures: Collection[str]) -> str | None:
    """Which of some figures of the file a key belongs to; None if none of them."""
    name = ""
    for step in steps_of(key):
        if isinstance(step, slice):
            break
        name = f"{name}.{step}" if name else step
        if name in figures:
            return name
    return None


def value_of(model: MotionModel, key: str) -> float | None:
    """What a model has at a key; the mean where entries differ; None where it states nothing.

    Raises:
        InputError: there is no such key, or no number at it.
    """
    found = _numbers(model, steps_of(key), key)
    return None if not found else sum(found) / len(found)


def nothing(key: str) -> float:
    """What an entry of a list stands for that is not stated: of lists that scale something, one."""
    return 1.0 if "_scale" in key else 0.0


def with_value(model: MotionModel, key: str, value: float) -> MotionModel:
    """The model with another value at a key; a list of numbers grows to an index beyond its end,
    by what stands for nothing.

    Raises:
        InputError: there is no such key, or the model refuses the value.
    """
    made = _updated(model, steps_of(key), value, key)
    assert isinstance(made, MotionModel)
    return made


def field_of(owner: DataclassInstance, name: str) -> str | None:
    """The field of a dataclass that a name in the file stands for; None if it only groups."""
    names = [field.name for field in dataclasses.fields(owner)]
    fits = [own for own in names if name == own or name.startswith(f"{own}_")]
    return max(fits, key=len, default=None)


def _slice(index: re.Match[str]) -> slice:
    everything, one, begin, end = index.groups()
    if everything:
        return slice(None)
    if one is not None:
        return slice(int(one), int(one) + 1)
    return slice(int(begin) if begin else None, int(end) if end else None)


def _numbers(owner: Any, steps: Sequence[Step], key: str) -> list[float]:
    if not steps:
        if owner is None:
            return []
        if isinstance(owner, bool) or not isinstance(owner, int | float):
            raise InputError(f"{key!r}: no number, or not a single one, stands there")
        return [float(owner)]
    step, rest = steps[0], steps[1:]
    if isinstance(step, slice):
        return [n for entry in _entries(owner, key)[step] for n in _numbers(entry, rest, key)]
    inner, rest = _enter(owner, step, rest, key)
    return _numbers(owner if inner is None else getattr(owner, inner), rest, key)


def _updated(owner: Any, steps: Sequence[Step], value: float, key: str) -> Any:
    if not steps:
        if isinstance(owner, tuple | str | bool) or dataclasses.is_dataclass(owner):
            raise InputError(f"{key!r}: no number, or not a single one, stands there")
        return value
    step, rest = steps[0], steps[1:]
    if isinstance(step, slice):
        entries = list(_entries(owner, key))
        if not rest and step.stop is not None and step.stop == (step.start or 0) + 1:
            entries += [nothing(key)] * (step.stop - len(entries))
        chosen = range(len(entries))[step]
        if not chosen:
            raise InputError(f"{key!r}: the motion model has {len(entries)} entries there")
        for k in chosen:
            entries[k] = _updated(entries[k], rest, value, key)
        return tuple(entries)
    inner, rest = _enter(owner, step, rest, key)
    if inner is None:
        return _updated(owner, rest, value, key)
    made = _updated(getattr(owner, inner), rest, value, key)
    return dataclasses.replace(owner, **{inner: made})


def _entries(owner: Any, key: str) -> tuple[Any, ...]:
    if not isinstance(owner, tuple):
        raise InputError(f"{key!r}: no list stands there")
    return owner


def _enter(
    owner: Any, step: str, rest: Sequence[Step], key: str
) -> tuple[str | None, Sequence[Step]]:
    """The field that a step leads to, and the steps behind it; no field where it only groups."""
    if not dataclasses.is_dataclass(owner) or isinstance(owner, type):
        raise InputError(f"{key!r}: nothing is called {step!r} there")
    field = field_of(owner, step)
    if field is not None:
        return field, rest
    if isinstance(owner, MotionModel) and rest and isinstance(rest[0], str):
        return None, rest
    known = ", ".join(one.name for one in dataclasses.fields(owner))
    raise InputError(f"{key!r}: nothing is called {step!r} there; there are {known}")
