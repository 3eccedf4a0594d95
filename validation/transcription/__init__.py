"""The papers' own transcription of zones and via points, as an independent check.

It poses what `improve.waypoints` solves through the emulator in another way: as
one sparse nonlinear program over path parameters, durations, via points, radii, lengths of legs
and positions of the TCP (D. Gleeson et al., "Towards Energy Optimization using Trajectory
Smoothing and Automatic Code Generation for Robotic Assembly", Procedia CIRP 44 (2016), equations
2 to 8). What was mended in the equations, and how the two compare, stands in
docs/measurements/transcription.md."""

from .guess import initial_guess
from .layout import Grid
from .motion import Check, Samples, carried_over, check, program, sampled
from .optimize import Answer, Optimum, Solver, optimize
from .task import Overlap, TranscriptionTask
from .transcription import Transcription

__all__ = [
    "Answer",
    "Check",
    "Grid",
    "Optimum",
    "Overlap",
    "Samples",
    "Solver",
    "Transcription",
    "TranscriptionTask",
    "carried_over",
    "check",
    "initial_guess",
    "optimize",
    "program",
    "sampled",
]
