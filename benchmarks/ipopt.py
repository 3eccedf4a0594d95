"""IPOPT through its C interface, with the very callables of an `NLP`.

casadi's wheel ships the library; casadi itself hands it casadi's own functions only (or Python
callbacks at a high price a call), so that this is what lets two solvers be compared on the same
numpy callables.
"""

from __future__ import annotations

import ctypes
from ctypes import POINTER, c_bool, c_char_p, c_double, c_int, c_void_p
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import casadi
import numpy as np
from numpy.typing import NDArray
from scipy import sparse

from flyby.core.arrays import FloatArray
from flyby.core.sqp import NLP

Matrix = FloatArray | sparse.csc_array
Options = dict[str, str | float | int]

QUIET: Options = {"print_level": 0, "sb": "yes"}


def warm_options(mu: float) -> Options:
    """What makes IPOPT start near a solution, with its multipliers and a barrier parameter."""
    pushes = ("bound_push", "bound_frac", "slack_bound_push", "slack_bound_frac", "mult_bound_push")
    small = {f"warm_start_{name}": 1e-9 for name in pushes}
    return {"warm_start_init_point": "yes", "mu_init": mu, **small}


_NUMBERS = POINTER(c_double)
_PLACES = POINTER(c_int)
_VALUES = ctypes.CFUNCTYPE(c_bool, c_int, _NUMBERS, c_bool, _NUMBERS, c_void_p)
_VECTOR = ctypes.CFUNCTYPE(c_bool, c_int, _NUMBERS, c_bool, c_int, _NUMBERS, c_void_p)
_JACOBIAN = ctypes.CFUNCTYPE(
    c_bool, c_int, _NUMBERS, c_bool, c_int, c_int, _PLACES, _PLACES, _NUMBERS, c_void_p
)
_HESSIAN = ctypes.CFUNCTYPE(
    c_bool,
    *(c_int, _NUMBERS, c_bool, c_double, c_int, _NUMBERS, c_bool, c_int),
    *(_PLACES, _PLACES, _NUMBERS, c_void_p),
)
_INTERMEDIATE = ctypes.CFUNCTYPE(c_bool, c_int, c_int, *([c_double] * 8), c_int, c_void_p)


def _library() -> Any:
    (file,) = Path(casadi.__file__).parent.glob("libipopt.so.3")
    library = ctypes.CDLL(str(file))
    library.CreateIpoptProblem.restype = c_void_p
    library.CreateIpoptProblem.argtypes = [
        *(c_int, _NUMBERS, _NUMBERS, c_int, _NUMBERS, _NUMBERS, c_int, c_int, c_int),
        *(_VALUES, _VECTOR, _VALUES, _JACOBIAN, _HESSIAN),
    ]
    library.FreeIpoptProblem.argtypes = [c_void_p]
    library.AddIpoptStrOption.argtypes = [c_void_p, c_char_p, c_char_p]
    library.AddIpoptNumOption.argtypes = [c_void_p, c_char_p, c_double]
    library.AddIpoptIntOption.argtypes = [c_void_p, c_char_p, c_int]
    library.SetIntermediateCallback.argtypes = [c_void_p, _INTERMEDIATE]
    library.IpoptSolve.argtypes = [c_void_p, *([_NUMBERS] * 6), c_void_p]
    for name in ("Str", "Num", "Int"):
        getattr(library, f"AddIpopt{name}Option").restype = c_bool
    return library


@dataclass(frozen=True)
class IpoptResult:
    """What IPOPT came to.

    Args:
        x, objective: the end.
        multipliers: (m,) of the constraints.
        lower, upper: (n,) multipliers of the bounds, both ≥ 0.
        iterations: number of them.
        success: solved, or to the acceptable level.
    """

    x: FloatArray
    objective: float
    multipliers: FloatArray
    lower: FloatArray
    upper: FloatArray
    iterations: int
    success: bool


class Ipopt:
    """One problem, for solutions from any start.

    Args:
        nlp: with Hessian.
        x: (n,) where the patterns are taken.
        options: of IPOPT.
    """

    def __init__(self, nlp: NLP, x: FloatArray, options: Options) -> None:
        self._nlp = nlp
        self._iterations = 0
        self._library = _library()
        self._J = _places(nlp.jacobian(x))
        rows, columns = _places(nlp.hessian(x, 1.0, np.ones(nlp.m)))
        self._low = np.flatnonzero(rows >= columns)
        self._H = rows[self._low], columns[self._low]
        self._keep = self._callbacks()
        bounds = [np.clip(b, -2e19, 2e19) for b in nlp.bounds]
        x_lower, x_upper, c_lower, c_upper = bounds
        self._problem = c_void_p(
            self._library.CreateIpoptProblem(
                *(nlp.n, _numbers(x_lower), _numbers(x_upper)),
                *(nlp.m, _numbers(c_lower), _numbers(c_upper)),
                *(len(self._J[0]), len(self._low), 0),
                *self._keep[:5],
            )
        )
        self._library.SetIntermediateCallback(self._problem, self._keep[5])
        for name, value in {**QUIET, **options}.items():
            self._set(name, value)

    def __del__(self) -> None:
        self._library.FreeIpoptProblem(self._problem)

    def solve(self, x0: FloatArray, warm: IpoptResult | None = None) -> IpoptResult:
        """From x0 (n,), with the multipliers of another result if warm."""
        n, m = self._nlp.n, self._nlp.m
        x, g, f = x0.copy(), np.zeros(m), np.zeros(1)
        y, lower, upper = np.zeros(m), np.zeros(n), np.zeros(n)
        if warm is not None:
            y, lower, upper = warm.multipliers.copy(), warm.lower.copy(), warm.upper.copy()
        self._iterations = 0
        arrays = (x, g, f, y, lower, upper)
        status = self._library.IpoptSolve(self._problem, *map(_numbers, arrays), None)
        return IpoptResult(x, float(f[0]), y, lower, upper, self._iterations, status in (0, 1))

    def _set(self, name: str, value: str | float | int) -> None:
        kinds = {str: "Str", float: "Num", int: "Int"}
        add = getattr(self._library, f"AddIpopt{kinds[type(value)]}Option")
        done = add(
            self._problem, name.encode(), value.encode() if isinstance(value, str) else value
        )
        if not done:
            raise ValueError(f"IPOPT refuses the option {name} = {value!r}")

    def _callbacks(self) -> tuple[Any, ...]:
        nlp = self._nlp
        n, m = nlp.n, nlp.m

        def objective(_n, x, _new, value, _data):  # type: ignore[no-untyped-def]
            value[0] = nlp.objective(_array(x, n))
            return True

        def gradient(_n, x, _new, value, _data):  # type: ignore[no-untyped-def]
            _array(value, n)[:] = nlp.gradient(_array(x, n))
            return True

        def constraints(_n, x, _new, _m, value, _data):  # type: ignore[no-untyped-def]
            if m:
                _array(value, m)[:] = nlp.constraints(_array(x, n))
            return True

        def jacobian(_n, x, _new, _m, count, rows, columns, value, _data):  # type: ignore[no-untyped-def]
            if not value:
                _array(rows, count)[:], _array(columns, count)[:] = self._J
            else:
                _array(value, count)[:] = _values(nlp.jacobian(_array(x, n)))
            return True

        def hessian(  # type: ignore[no-untyped-def]
            _n, x, _new, factor, _m, y, _new_y, count, rows, columns, value, _data
        ):
            if not value:
                _array(rows, count)[:], _array(columns, count)[:] = self._H
            else:
                y = _array(y, m) if m else np.zeros(0)
                _array(value, count)[:] = _values(nlp.hessian(_array(x, n), factor, y))[self._low]
            return True

        def intermediate(_mode, iteration, *_rest):  # type: ignore[no-untyped-def]
            self._iterations = iteration
            return True

        return (
            _VALUES(objective),
            _VECTOR(constraints),
            _VALUES(gradient),
            _JACOBIAN(jacobian),
            _HESSIAN(hessian),
            _INTERMEDIATE(intermediate),
        )


def _places(matrix: Matrix) -> tuple[NDArray[Any], NDArray[Any]]:
    """Rows and columns of `_values`."""
    if isinstance(matrix, np.ndarray):
        rows, columns = np.indices(matrix.shape)
        return rows.ravel(), columns.ravel()
    entries = sparse.coo_array(matrix)
    return entries.row, entries.col


def _values(matrix: Matrix) -> FloatArray:
    return matrix.ravel() if isinstance(matrix, np.ndarray) else matrix.data


def _numbers(array: FloatArray) -> Any:
    return array.ctypes.data_as(_NUMBERS)


def _array(pointer: Any, count: int) -> NDArray[Any]:
    return np.ctypeslib.as_array(pointer, (count,))
