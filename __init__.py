"""Emulates how industrial robot controllers drive a program; see flyby.core, flyby.cli."""
