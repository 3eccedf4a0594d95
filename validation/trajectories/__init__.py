"""Trajectory problems with known optima, stated as formulas."""
