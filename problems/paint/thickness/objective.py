"""The cost of a trajectory, its gradient, and the Gauss–Newton matrix in its place of curvature.

    J = ½ Σ_s p_s Σ_k A_k/A (100 (T_sk / T − 1))² + ½ r·r + costs of time and paint

with scenarios s of weight p_s (one, unless the coat has to stand errors), thickness T_sk at the
points k, target T, and the path's residuals r (see `optimize_path`). The Jacobian of the thickness
exists in pieces of some hundred points only (see `Deposition.normal_matrix`).
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from ....core.arrays import FloatArray
from ..coating.deposition import Deposition
from ..spray.trajectory import PaintTrajectory
from .options import PaintWeights
from .path_cost import path_cost
from .variables import ThicknessVariables

_REMEMBERED = 3
"""Points whose coats are kept: iterates are judged between the solver's own calls."""


@dataclass(frozen=True, eq=False)
class Scenario:
    """A deposition that may be the true one.

    Args:
        deposition: the surface under the gun as it may be.
        weight: of its squared error; all weights of a list sum to 1.
    """

    deposition: Deposition
    weight: float


class PaintObjective:
    """J over the variables.

    Args:
        scenarios: at least one; the first says what paint costs.
        target: wanted thickness, m.
        weights: of the path's costs.
        variables: what z stands for.
    """

    def __init__(
        self,
        scenarios: Sequence[Scenario],
        target: float,
        weights: PaintWeights,
        variables: ThicknessVariables,
    ) -> None:
        self._scenarios = scenarios
        self._target = target
        self._weights = weights
        self._variables = variables
        self._units = variables.units
        samples = scenarios[0].deposition.samples
        self._shares = samples.areas * (1e4 / (samples.area * target**2))
        nominal = scenarios[0].deposition.footprint
        self._paint = weights.paint * nominal.rate / (samples.area * target)
        self._path = path_cost(weights, variables.waypoints)
        self._seen: dict[bytes, tuple[PaintTrajectory, list[FloatArray]]] = {}

    def value(self, z: FloatArray) -> float:
        """J."""
        trajectory, errors = self._errors(z)
        uneven = sum(
            0.5 * scenario.weight * float(self._shares @ error**2)
            for scenario, error in zip(self._scenarios, errors, strict=True)
        )
        path = self._path.residuals(trajectory)
        costs = self._weights.time + self._paint * trajectory.flow
        return uneven + 0.5 * float(path @ path) + float(costs @ trajectory.duration)

    def gradient(self, z: FloatArray) -> FloatArray:
        """∇J (n,)."""
        trajectory, errors = self._errors(z)
        turns = self._variables.turns(z)
        position, nozzle, duration = self._path.slopes(trajectory)
        duration = duration + self._weights.time + self._paint * trajectory.flow
        for scenario, error in zip(self._scenarios, errors, strict=True):
            adjoint = scenario.weight * self._shares * error
            slopes = scenario.deposition.gradient(trajectory, adjoint)
            position = position + slopes.position
            nozzle = nozzle + slopes.nozzle
            duration = duration + slopes.duration
        angles = np.einsum("ijk,ik->ij", turns, nozzle)
        waypoints = np.concatenate((position, angles), axis=1).ravel()
        return np.asarray(np.concatenate((waypoints, duration)) * self._units)

    def curvature(self, z: FloatArray) -> FloatArray:
        """The Gauss–Newton matrix (n, n): positive semidefinite, without second derivatives of
        thickness and nozzle."""
        trajectory, turns = self._variables.trajectory(z), self._variables.turns(z)
        path = self._path.jacobian(trajectory, turns)
        found: FloatArray = (path.T @ path).toarray()
        for scenario in self._scenarios:
            weights = scenario.weight * self._shares
            found += scenario.deposition.normal_matrix(trajectory, turns, weights)
        found *= np.outer(self._units, self._units)
        return found

    # ------------------------------------------------------------------------------ parts

    def _errors(self, z: FloatArray) -> tuple[PaintTrajectory, list[FloatArray]]:
        """The trajectory, and each scenario's errors (V,) in m."""
        key = z.tobytes()
        found = self._seen.pop(key, None)
        if found is None:
            trajectory = self._variables.trajectory(z)
            found = (
                trajectory,
                [
                    scenario.deposition.thickness(trajectory) - self._target
                    for scenario in self._scenarios
                ],
            )
        while len(self._seen) >= _REMEMBERED:
            del self._seen[next(iter(self._seen))]
        self._seen[key] = found
        return found
