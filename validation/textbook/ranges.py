"""Ranges that the problems' arguments have in common."""

from __future__ import annotations

import math

from ...core.errors import InputError


def check_nodes(nodes: object, least: int) -> None:
    """Refuse what is no number of nodes.

    Raises:
        InputError: it is no whole number, or below ``least``.
    """
    if isinstance(nodes, bool) or not isinstance(nodes, int) or nodes < least:
        raise InputError(f"nodes is a whole number of at least {least}, not {nodes!r}")


def check_force(force: float) -> None:
    """Refuse what is no greatest force.

    Raises:
        InputError: it is not above zero and finite.
    """
    if not (math.isfinite(force) and force > 0):
        raise InputError(f"force is a number above zero, not {force!r}")
