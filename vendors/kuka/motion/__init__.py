"""Moves and motion settings of KRL → the core's."""
