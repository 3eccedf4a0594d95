"""Expressions of URScript → values, and the data of a program."""
