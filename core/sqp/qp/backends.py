"""The back ends by name.

Clarabel is the default: see docs/reference/sqp.md for the measurements behind it.
"""

from __future__ import annotations

from collections.abc import Mapping
from enum import StrEnum

from ..problem.errors import NlpError
from .problem import Backend


class BackendKind(StrEnum):
    """A QP back end."""

    CLARABEL = "clarabel"
    OSQP = "osqp"
    PIQP = "piqp"
    """Needs the optional package ``piqp``."""
    INTERIOR_POINT = "interior_point"
    """Our own."""
    DENSE_INTERIOR_POINT = "dense_interior_point"
    """Our own for full matrices: Gauss–Newton's of many residuals."""


_FALLBACK = {
    BackendKind.INTERIOR_POINT: BackendKind.CLARABEL,
    BackendKind.DENSE_INTERIOR_POINT: BackendKind.CLARABEL,
    BackendKind.CLARABEL: BackendKind.OSQP,
    BackendKind.OSQP: BackendKind.CLARABEL,
    BackendKind.PIQP: BackendKind.CLARABEL,
}


def make_backends(
    kind: BackendKind | str, fallback: bool, known: Mapping[str, Backend] | None = None
) -> tuple[Backend, ...]:
    """The back end, and the one that takes over where it fails.

    Args:
        known: back ends by name that need not be made.

    Raises:
        NlpError: there is no such back end.
    """
    try:
        first = BackendKind(kind)
    except ValueError:
        raise NlpError(f"qp: one of {', '.join(BackendKind)}, not {kind!r}") from None
    kinds = (first, _FALLBACK[first]) if fallback else (first,)
    known = known or {}
    return tuple(known.get(k) or _make(k) for k in kinds)


def _make(kind: BackendKind) -> Backend:
    if kind is BackendKind.INTERIOR_POINT:
        from .interior_point import InteriorPointBackend

        return InteriorPointBackend()
    if kind is BackendKind.DENSE_INTERIOR_POINT:
        from .dense_interior_point import DenseInteriorPointBackend

        return DenseInteriorPointBackend()
    if kind is BackendKind.CLARABEL:
        from .clarabel_backend import ClarabelBackend

        return ClarabelBackend()
    if kind is BackendKind.OSQP:
        from .osqp_backend import OsqpBackend

        return OsqpBackend()
    from .piqp_backend import PiqpBackend

    return PiqpBackend()
