"""Moves and motion settings of RAPID → the core's."""
