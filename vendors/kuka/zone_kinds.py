"""Kinds of zone that KRL alone has."""

from __future__ import annotations

from ...core.program.zone import ZoneKind

C_VEL = ZoneKind("C_VEL")
"""Approximation begins when braking has come down to a share of the speed (``$APO.CVEL``)."""
