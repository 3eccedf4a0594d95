"""What is fitted: figures of a motion model, as a vector of about one."""

from __future__ import annotations

import math
import re
from collections.abc import Iterable, Sequence
from dataclasses import dataclass, replace
from typing import NamedTuple

import numpy as np

from ...core.arrays import FloatArray
from ...core.errors import InputError
from ...core.motion.model.figures import Stage
from ...core.motion.model.motion_model import MotionModel
from ...core.robot.model import Robot
from .keys import figure_of, fit_of, nothing, value_of, with_value


@dataclass(frozen=True)
class FittedParameter:
    """One number that is fitted.

    Args:
        keys: where it stands in a motion model; several have the same value.
        start: where the fit begins.
        lower, upper: what it may be.
        scale: how far it may well be from its start; the variable is (value − start) / scale.
        known: standard deviation that its value before the fit is known with, as one robot's.
    """

    keys: tuple[str, ...]
    start: float
    lower: float
    upper: float
    scale: float
    known: float = math.inf

    def __post_init__(self) -> None:
        if not self.keys:
            raise InputError("a parameter needs a key")
        if not (math.isfinite(self.start) and self.lower <= self.start <= self.upper):
            raise InputError(
                f"{self.name}: the start {self.start:g} lies outside of {self.lower:g} to "
                f"{self.upper:g}"
            )
        if not 0 < self.scale < math.inf:
            raise InputError(f"{self.name}: the scale must be above zero, not {self.scale:g}")

    @property
    def name(self) -> str:
        """All its keys."""
        return " + ".join(self.keys)


DEVIATIONS = 1.96
"""From the middle of an interval of 95 % to its end."""
ALIKE = 0.05
"""Share of a parameter's scale by which robots of a type differ though it is known exactly."""
_SHARE = 0.5
"""Scale of what has no usual one, as a share of its start."""


def parameter(model: MotionModel, text: str) -> FittedParameter:
    """The parameter that a text names.

    Args:
        model: gives the start where the text does not.
        text: ``key``; ``key + key`` for several with one value; then maybe ``= start``, and maybe
            ``in lower .. upper``.

    Raises:
        InputError: there is no such key, what stands there is not fitted, or the model has no
            value there and the text names none.
    """
    read = _read(text)
    keys, usual = read.keys, fit_of(read.keys[0])
    start = _first(model, keys[0]) if read.start is None else read.start
    for key in keys:
        with_value(model, key, start)
    lower, upper = min(usual.lower, start), max(usual.upper, start)
    scale = usual.scale or _SHARE * abs(start) or _SHARE
    lower, upper = read.bounds or (lower, upper)
    return FittedParameter(keys, start, lower, upper, scale, _known(model, keys, scale))


class _Read(NamedTuple):
    """What a text says of a parameter."""

    keys: tuple[str, ...]
    start: float | None
    bounds: tuple[float, float] | None


def check_text(text: str) -> None:
    """Whether a text names figures that are fitted, whatever the model.

    Raises:
        InputError: it does not.
    """
    _read(text)


def _read(text: str) -> _Read:
    found = _TEXT.fullmatch(text)
    if found is None:
        raise InputError(f"{text!r} names no parameter: 'key', 'key = start in lower .. upper'")
    keys = tuple(key.strip() for key in found["keys"].split("+"))
    for key in keys:
        fit_of(key)
    start = None if found["start"] is None else _number(found["start"], text)
    if found["lower"] is None:
        return _Read(keys, start, None)
    return _Read(keys, start, (_number(found["lower"], text), _number(found["upper"], text)))


def _known(model: MotionModel, keys: tuple[str, ...], scale: float) -> float:
    """How well a parameter is known: as its interval says, if it was fitted before, and no better
    than robots of a type are alike."""
    name = " + ".join(keys)
    for origin in model.provenance.values():
        for text, (lower, upper) in zip(origin.fitted, origin.interval, strict=False):
            if text.partition(" in ")[0].partition("=")[0].strip() == name:
                return math.hypot(0.5 * (upper - lower) / DEVIATIONS, ALIKE * scale)
    return scale


_TEXT = re.compile(
    r"(?P<keys>[^=]+?)\s*(=\s*(?P<start>\S+)\s*)?(\bin\s+(?P<lower>\S+)\s*\.\.\s*(?P<upper>\S+)\s*)?"
)


def _first(model: MotionModel, key: str) -> float:
    found = value_of(model, key)
    if found is None:
        raise InputError(f"{key}: the motion model states nothing there; name a start: {key} = …")
    return found


def _number(text: str, whole: str) -> float:
    try:
        return float(text)
    except ValueError:
        raise InputError(f"{whole!r}: {text!r} is no number") from None


def fitted_before(model: MotionModel) -> list[str]:
    """What the model's figures were fitted by, as their provenance says."""
    texts: dict[str, None] = {}
    for origin in model.provenance.values():
        texts.update(dict.fromkeys(origin.fitted))
    return list(texts)


def usual_parameters(model: MotionModel, robot: Robot) -> list[str]:
    """What is fitted where nobody says what: what the model's figures were fitted by before, or, of
    a model that never was, how corners bulge, how long commands are averaged, and the scale of each
    joint's acceleration."""
    before = fitted_before(model)
    if before:
        return before
    scales = [f"limit.joint_acceleration_scale[{k}] = 1" for k in range(robot.arm_size)]
    averages = ["time.smoothing_s[*]" if model.smoothing else "time.smoothing_s[0] = 0.02"]
    if model.joint_smoothing:
        averages.append("time.joint_smoothing_s[*]")
    return ["blend.tcp.beta[0] = 0", *averages, *scales]


class SteppedModel(NamedTuple):
    """A parameter a step aside.

    Args:
        model: with it there.
        length: of the step.
        stage: the first of an emulation that it changes.
    """

    model: MotionModel
    length: float
    stage: Stage


@dataclass(frozen=True, eq=False)
class SteppedModels:
    """Motion models that tell how residuals change with parameters.

    Args:
        model: where derivatives are taken.
        steps: of each parameter.
    """

    model: MotionModel
    steps: tuple[SteppedModel, ...]


@dataclass(frozen=True)
class ParameterSet:
    """Several parameters on top of a motion model.

    Args:
        base: what is not fitted.
        parameters: what is.
        hold: what it costs to leave what was `before`, in mean loss of the runs: so many times the
            robust loss of the departure in standard deviations that it is `known` with; zero where
            runs alone count.
    """

    base: MotionModel
    parameters: tuple[FittedParameter, ...]
    hold: float = 0.0

    @classmethod
    def named(cls, base: MotionModel, texts: Iterable[str]) -> ParameterSet:
        """See `parameter`; one text after the other, each on top of those before.

        Raises:
            InputError: as `parameter` does, or a key occurs twice.
        """
        model = base
        made: list[FittedParameter] = []
        for text in texts:
            one = parameter(model, text)
            taken = {key for other in made for key in other.keys}
            twice = taken.intersection(one.keys)
            if twice:
                raise InputError(f"{min(twice)} is to be fitted twice")
            for key in one.keys:
                model = with_value(model, key, one.start)
            made.append(one)
        return cls(base, tuple(made))

    @property
    def size(self) -> int:
        """How many there are."""
        return len(self.parameters)

    @property
    def scale(self) -> FloatArray:
        """(P,)."""
        return np.array([p.scale for p in self.parameters])

    @property
    def start(self) -> FloatArray:
        """(P,), values."""
        return np.array([p.start for p in self.parameters])

    @property
    def before(self) -> FloatArray:
        """(P,), what the base has, as far as that may be fitted; the starts where it has nothing
        that a list would grow by."""
        stated = []
        for one in self.parameters:
            value = value_of(self.base, one.keys[0])
            if value is None:
                value = nothing(one.keys[0]) if one.keys[0].endswith("]") else one.start
            stated.append(min(max(value, one.lower), one.upper))
        return np.array(stated)

    @property
    def bounds(self) -> tuple[FloatArray, FloatArray]:
        """(P,) each, of values."""
        lower = np.array([p.lower for p in self.parameters])
        return lower, np.array([p.upper for p in self.parameters])

    def model(self, values: Sequence[float] | FloatArray) -> MotionModel:
        """The motion model with values (P,).

        Raises:
            InputError: the model refuses them.
        """
        model = self.base
        for one, value in zip(self.parameters, values, strict=True):
            for key in one.keys:
                model = with_value(model, key, float(value))
        return model

    def stepped(self, values: FloatArray, share: float) -> SteppedModels:
        """The motion model with values (P,), and with each of them a step aside, to the side where
        the bounds leave room.

        Args:
            values: (P,).
            share: of a parameter's scale that is stepped by.

        Raises:
            InputError: the model refuses them.
        """
        model, made = self.model(values), []
        for one, value in zip(self.parameters, values, strict=True):
            step = share * one.scale
            if one.upper - value < step < value - one.lower:
                step = -step
            moved = model
            for key in one.keys:
                moved = with_value(moved, key, float(value + step))
            stage = min(figure_of(key).stage for key in one.keys)
            made.append(SteppedModel(moved, step, stage))
        return SteppedModels(model, tuple(made))

    def starting_at(self, values: FloatArray) -> ParameterSet:
        """The same with other starts (P,)."""
        made = (
            replace(p, start=float(v), lower=min(p.lower, float(v)), upper=max(p.upper, float(v)))
            for p, v in zip(self.parameters, values, strict=True)
        )
        return replace(self, parameters=tuple(made))

    def departures(self, values: FloatArray) -> tuple[FloatArray, FloatArray]:
        """(P,) each: how far values are from what was `before`, in the standard deviations that
        it is known with, and by how much that grows with the value."""
        slope = 1.0 / np.array([p.known for p in self.parameters])
        return slope * (values - self.before), slope

    def without(self, names: Iterable[str]) -> ParameterSet:
        """The same without some parameters, which stay as the base has them."""
        gone = set(names)
        return replace(self, parameters=tuple(p for p in self.parameters if p.name not in gone))
