"""Spray painting: initial curve, deposition model, thickness optimisation, executable program."""
