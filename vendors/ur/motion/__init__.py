"""Moves and motion settings of URScript → the core's."""
