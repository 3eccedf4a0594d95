"""Nonlinear programs: `NLP`, `solve`, and what goes with them."""

from .derivatives import DerivativeCheck, check_derivatives
from .methods import SolverMethod
from .multistart import MultiStart, scattered_starts, solve_from
from .problem.errors import NlpError
from .problem.hessians import HessianKind
from .problem.nlp import NLP
from .qp.backends import BackendKind
from .result import Iteration, Result, Status
from .sensitivities import Sensitivities, sensitivities
from .solver import solve

__all__ = [
    "NLP",
    "BackendKind",
    "DerivativeCheck",
    "HessianKind",
    "Iteration",
    "MultiStart",
    "NlpError",
    "Result",
    "Sensitivities",
    "SolverMethod",
    "Status",
    "check_derivatives",
    "scattered_starts",
    "sensitivities",
    "solve",
    "solve_from",
]
