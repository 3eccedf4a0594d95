"""Improvements of a program that runs beside those of other robots."""
