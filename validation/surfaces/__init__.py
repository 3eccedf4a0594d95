"""Surfaces to be painted, made by formulas."""
