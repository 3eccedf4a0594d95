"""What a program has set its outputs, flags and registers to."""

from __future__ import annotations

from collections.abc import Iterable


class Outputs:
    """Outputs by name, as far as it is certain what they hold.

    An output keeps what the program sets it to. What it holds is not known before that, nor after a
    write whose value or moment is not certain (a pulse, a delay, an event on the way), nor
    where something beside the program's course may write it (an interrupt, a thread).

    Attributes:
        asked: outputs of which the value was read, one entry each time.
    """

    def __init__(self) -> None:
        self._values: dict[str, bool | float] = {}
        self._shared: set[str] = set()
        self._all_shared = False
        self.asked: list[str] = []

    def write(self, name: str, value: bool | float | None) -> None:
        """The program writes an output; None for a value or moment that is not certain."""
        if value is None or self._all_shared or name in self._shared:
            self.forget([name])
        else:
            self._values[name] = value

    def share(self, names: Iterable[str] | None) -> None:
        """From now on something else may write outputs whenever it likes; None for any of them."""
        if names is None:
            self._all_shared = True
        else:
            names = set(names)
            self._shared |= names
        self.forget(names)

    def release(self, names: Iterable[str]) -> None:
        """What wrote outputs whenever it liked has ended."""
        self._shared -= set(names)

    def forget(self, names: Iterable[str] | None = None) -> None:
        """Something else may have written outputs; None for any of them."""
        for name in list(self._values if names is None else names):
            self._values.pop(name, None)

    def held(self) -> dict[str, bool | float]:
        """What is known, by name."""
        return dict(self._values)

    def value(self, name: str) -> bool | float | None:
        """What an output holds; None if that is not known."""
        found = self._values.get(name)
        if found is not None:
            self.asked.append(name)
        return found

    def mark(self) -> int:
        """Now, for `asked_since`."""
        return len(self.asked)

    def asked_since(self, mark: int) -> frozenset[str]:
        """The outputs of which the value was read since then."""
        return frozenset(self.asked[mark:])
