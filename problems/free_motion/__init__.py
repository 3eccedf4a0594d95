"""Motions of the free robot: optimal control, the timing of a given path, first paths."""
