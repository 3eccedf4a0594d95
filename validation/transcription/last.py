"""Solvers ask for values, slopes and curvatures at one place after the other."""

from __future__ import annotations

from collections.abc import Callable
from typing import Generic, TypeVar

from ...core.arrays import FloatArray

Answer = TypeVar("Answer")


class Last(Generic[Answer]):
    """A function of an array that remembers its last answer.

    Args:
        function: whose answers nobody changes.
    """

    def __init__(self, function: Callable[[FloatArray], Answer]) -> None:
        self._function = function
        self._known: tuple[bytes, Answer] | None = None

    def __call__(self, x: FloatArray) -> Answer:
        """The function's value at x."""
        key = x.tobytes()
        if self._known is None or self._known[0] != key:
            self._known = key, self._function(x)
        return self._known[1]
