"""How many arguments a call takes, for messages."""

from __future__ import annotations

from collections.abc import Sequence


def wrong_count(wanted: int, given: int, names: Sequence[str] = ()) -> str:
    """``takes 1 argument (ToPoint), not 2``."""
    listed = f" ({', '.join(names)})" if names else ""
    return f"takes {wanted} argument{'' if wanted == 1 else 's'}{listed}, not {given}"
