"""IPOPT through casadi's `nlpsol`, on casadi's own functions."""

from __future__ import annotations

from typing import Any

import casadi as ca
import numpy as np
from ipopt import QUIET, IpoptResult, Options

from flyby.core.arrays import FloatArray
from flyby.core.sqp import NLP


class CasadiIpopt:
    """One problem, for solutions from any start.

    Args:
        nlp: gives the bounds.
        expressions: x, f and g.
        tolerance: of the residuals.
        options: more of IPOPT's.
    """

    def __init__(
        self,
        nlp: NLP,
        expressions: dict[str, Any],
        tolerance: float,
        options: Options | None = None,
    ) -> None:
        chosen = {**QUIET, "tol": tolerance, "constr_viol_tol": tolerance, **(options or {})}
        settings: dict[str, Any] = {f"ipopt.{name}": value for name, value in chosen.items()}
        self._solver = ca.nlpsol("peer", "ipopt", expressions, {**settings, "print_time": False})
        x_lower, x_upper, c_lower, c_upper = nlp.bounds
        self._bounds = {"lbx": x_lower, "ubx": x_upper, "lbg": c_lower, "ubg": c_upper}

    def solve(self, x0: FloatArray, warm: IpoptResult | None = None) -> IpoptResult:
        """From x0 (n,), with the multipliers of another result if warm."""
        start: dict[str, Any] = {"x0": x0}
        if warm is not None:
            start |= {"lam_g0": warm.multipliers, "lam_x0": warm.upper - warm.lower}
        found = self._solver(**start, **self._bounds)
        stats = self._solver.stats()
        bounds = np.array(found["lam_x"]).ravel()
        return IpoptResult(
            np.array(found["x"]).ravel(),
            float(found["f"]),
            np.array(found["lam_g"]).ravel(),
            np.maximum(-bounds, 0.0),
            np.maximum(bounds, 0.0),
            int(stats["iter_count"]),
            bool(stats["success"]),
        )
