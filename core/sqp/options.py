"""Options of `solve`, checked once."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from ..arrays import FloatArray
from .problem.arrays import numbers, scalar, whole_number
from .problem.errors import NlpError
from .problem.nlp import NLP
from .result import Iteration, Result

Callback = Callable[[Iteration], bool | None]
StepBox = Callable[[int, FloatArray], tuple[ArrayLike, ArrayLike]]


@dataclass(frozen=True, slots=True)
class Options:
    """See `solve`.

    Raises:
        NlpError: one is wrong; the message names it.
    """

    tolerance: float
    max_iterations: int
    callback: Callback | None
    step_box: StepBox | None
    warm_start: Result | None

    def __post_init__(self) -> None:
        tolerance = scalar("tolerance", self.tolerance)
        if not (np.isfinite(tolerance) and tolerance > 0):
            raise NlpError(f"tolerance is a number above zero, not {self.tolerance!r}")
        whole_number("max_iterations", self.max_iterations, 0)
        for name in ("callback", "step_box"):
            value = getattr(self, name)
            if value is not None and not callable(value):
                raise NlpError(f"{name} is a callable, not {value!r}")
        if self.warm_start is not None and not isinstance(self.warm_start, Result):
            raise NlpError(f"warm_start is a Result, not {self.warm_start!r}")


def start_point(name: str, nlp: NLP, value: object) -> FloatArray:
    """``value`` as a point (n,) to begin from.

    Raises:
        NlpError: it has another shape, or is not finite.
    """
    x = numbers(name, value)
    if x.shape != (nlp.n,):
        raise NlpError(f"{name} has shape {x.shape}, expected ({nlp.n},)")
    if not np.isfinite(x).all():
        raise NlpError(f"{name}[{int(np.flatnonzero(~np.isfinite(x))[0])}] is not finite")
    return x


def box_limits(step_box: StepBox, number: int, x: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Lower and upper limits (n,) of the step from x (n,) in an iteration, as the user's box says.

    Raises:
        NlpError: they are no pair of numbers or arrays (n,), or do not enclose zero.
    """
    wanted = step_box(number, x.copy())
    try:
        low, high = wanted
    except (TypeError, ValueError):
        raise NlpError(f"step_box gave {wanted!r}, expected lower and upper limits") from None
    limits = []
    for value in (low, high):
        array = numbers("step_box", value)
        if array.shape not in ((), x.shape):
            raise NlpError(f"step_box gave shape {array.shape}, expected a number or {x.shape}")
        limits.append(np.broadcast_to(array, x.shape))
    if not ((limits[0] <= 0).all() and (limits[1] >= 0).all()):
        raise NlpError("step_box: limits of a step enclose zero")
    return limits[0], limits[1]
