"""Expressions of KRL → values, and the data of a program."""
