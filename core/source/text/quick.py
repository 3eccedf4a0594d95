"""Values that reading makes by the ten thousand.

To the type checker `quick` is `dataclasses.dataclass`. At run time nothing keeps a value from being
changed: Python sets each field of a frozen one by a call, which takes a fifth of the time in which
a long program is read.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from dataclasses import dataclass as quick
else:
    from dataclasses import dataclass

    def quick(*, frozen, slots=False, eq=True):
        """A decorator for classes of values that are ``frozen``, and hashed by what they hold."""
        assert frozen
        return dataclass(slots=slots, eq=eq, unsafe_hash=eq)


__all__ = ["quick"]
