"""Stations: several robots in one cell, and where a robot stands."""
