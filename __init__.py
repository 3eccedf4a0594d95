"""Emulates how industrial robot controllers drive a program; see flyby.core, flyby.cli."""

# By its full name: pytest imports this file by its place, where no package is around it.
from flyby.core import numba_import  # noqa: TID251

numba_import.install()
