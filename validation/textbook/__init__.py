"""Three textbook problems, the SQP solver's first users.

They are those of chapters 2 and 3 of D. Gleeson, "Trajectory Optimization including Robot
Controller Emulation" (thesis, Chalmers 2025).

- `cubic`: two variables, two cubic constraints; also as a log barrier.
- `double_integrator`: minimum time from (4, 1) to rest, in two discretisations, and exactly.
- `point_mass`: minimum time among circles, with constraints at samples only, and in two
  formulations that cannot jump.
"""

from .arcs import Arcs
from .cubic import CUBIC_OPTIMUM, CUBIC_START, barrier_path, cubic
from .double_integrator import DoubleIntegrator, Exact, Scheme, minimum_time
from .freedom import Answer, Freedom, prove_free
from .point_mass import Avoidance, PointMass
from .scenes import GARDEN, MAZE, WALL, Scene

__all__ = [
    "CUBIC_OPTIMUM",
    "CUBIC_START",
    "GARDEN",
    "MAZE",
    "WALL",
    "Answer",
    "Arcs",
    "Avoidance",
    "DoubleIntegrator",
    "Exact",
    "Freedom",
    "PointMass",
    "Scene",
    "Scheme",
    "barrier_path",
    "cubic",
    "minimum_time",
    "prove_free",
]
