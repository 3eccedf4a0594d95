"""What a problem may be refused for, and what its callables may fail at."""

from __future__ import annotations

from ...errors import InputError


class NlpError(InputError, ValueError):
    """A problem that is not well posed; the message names the argument or the callable."""


class CallableError(ArithmeticError):
    """A callable has no finite value at a point; the message names it."""
