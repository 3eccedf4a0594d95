"""Expressions of RAPID → values, and the data of a program."""
