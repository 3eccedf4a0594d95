"""The planner: RRT-Connect and path shortening of the Open Motion Planning Library.

OMPL (ompl.kavrakilab.org, BSD licence) plans in a space whose coordinates are joint values over
joint speeds, so that lengths are roughly times. It is an optional extra.
"""

from __future__ import annotations

import time
from collections.abc import Callable, Iterator, Sequence
from itertools import pairwise
from typing import Any

import numpy as np

from ....core.arrays import FloatArray
from ....core.errors import InputError
from ....core.robot.joint import Joint
from .free_space import FreeSpace

STEP = 0.5
"""s at full speed: the longest motion by which a tree grows."""
ROUNDS, ATTEMPTS = 5, 40
"""How often a path is shortened, and by how many attempts."""
_NO_WAY = 1e-12


def quickest_path(
    joints: Sequence[Joint],
    space: FreeSpace,
    starts: Sequence[FloatArray],
    goals: Sequence[FloatArray],
    seed: int,
    tries: int,
    time_limit: float,
) -> list[FloatArray] | None:
    """The quickest of several planned and shortened paths; None if none was found in time.

    Args:
        joints: of the arm.
        space: where it may go.
        starts, goals: free configurations (n,); the path joins any of them.
        seed: the same seed gives the same path, if time does not run out.
        tries: how many paths are planned.
        time_limit: s; after it no further path is planned.

    Raises:
        InputError: OMPL is not installed.
    """
    end = time.monotonic() + time_limit
    found: list[list[FloatArray]] = []
    for k in range(tries):
        found += _plan(joints, space, starts, goals, seed + k, end)
    return min(found, key=lambda path: _duration(path, joints), default=None)


def _duration(path: Sequence[FloatArray], joints: Sequence[Joint]) -> float:
    """s that a path takes with a stop at each of its points."""
    velocity = np.array([joint.velocity for joint in joints])
    acceleration = np.array([joint.acceleration for joint in joints])
    total = 0.0
    for a, b in pairwise(path):
        way = np.maximum(np.abs(b - a), _NO_WAY)
        speed, rate = (velocity / way).min(), (acceleration / way).min()
        total += 2.0 / rate**0.5 if rate < speed**2 else 1.0 / speed + speed / rate
    return float(total)


def _ompl() -> Any:
    try:
        import ompl.base
        import ompl.geometric
        import ompl.util
    except ImportError as error:
        raise InputError(
            "planning needs OMPL, which is not installed: pip install 'flyby[planning]'"
        ) from error
    ompl.util.setLogLevel(ompl.util.LOG_NONE)
    return ompl


def _plan(
    joints: Sequence[Joint],
    space: FreeSpace,
    starts: Sequence[FloatArray],
    goals: Sequence[FloatArray],
    seed: int,
    end: float,
) -> list[list[FloatArray]]:
    """A path by RRT-Connect (Kuffner and LaValle, ICRA 2000), less and less of it; none if late."""
    ompl = _ompl()
    # All generators made from here on get their seeds from this one; zero would mean any.
    ompl.util.RNG.setSeed(seed + 1)
    speed = np.array([joint.velocity for joint in joints])
    states = _state_space(ompl, joints)

    def values(state: Any) -> FloatArray:
        return np.asarray([state[k] for k in range(len(joints))] * speed)

    information = _information(ompl, states, space, values)
    problem = ompl.base.ProblemDefinition(information)
    for q in starts:
        problem.addStartState(_state(states, q / speed))
    goal = ompl.base.GoalStates(information)
    for q in goals:
        goal.addState(_state(states, q / speed))
    problem.setGoal(goal)
    planner = ompl.geometric.RRTConnect(information)
    planner.setRange(STEP)
    planner.setProblemDefinition(problem)
    planner.setup()
    stop = ompl.base.PlannerTerminationCondition(lambda: time.monotonic() > end)
    planner.solve(stop)
    if not problem.hasExactSolution():
        return []
    path = problem.getSolutionPath()
    stages = _shortened(ompl.geometric.PathSimplifier(information), path, stop)
    return [[values(state) for state in stage.getStates()] for stage in stages]


def _state_space(ompl: Any, joints: Sequence[Joint]) -> Any:
    """Joint values over joint speeds, within the joints' limits."""
    bounds = ompl.base.RealVectorBounds(len(joints))
    for k, joint in enumerate(joints):
        bounds.setLow(k, joint.lower / joint.velocity)
        bounds.setHigh(k, joint.upper / joint.velocity)
    states = ompl.base.RealVectorStateSpace(len(joints))
    states.setBounds(bounds)
    return states


def _state(states: Any, values: FloatArray) -> Any:
    state = states.allocState()
    for k, value in enumerate(values):
        state[k] = float(value)
    return state


def _information(
    ompl: Any, states: Any, space: FreeSpace, values: Callable[[Any], FloatArray]
) -> Any:
    """OMPL's view of the free space: single states and straight motions."""
    information = ompl.base.SpaceInformation(states)

    class StraightMotions(ompl.base.MotionValidator):  # type: ignore[misc]
        def checkMotion(self, first: Any, last: Any) -> bool:
            return space.joins(values(first), values(last))

    validator = StraightMotions(information)
    information.setStateValidityChecker(lambda state: space.keeps(values(state)))
    information.setMotionValidator(validator)
    information.setup()
    return information


def _shortened(simplifier: Any, path: Any, stop: Callable[[], bool]) -> Iterator[Any]:
    """The same path again and again: as found, with points left out, with corners cut.

    The number of attempts is fixed, so that the outcome can be repeated.
    """
    yield path
    for _ in range(ROUNDS):
        if stop():
            return
        simplifier.reduceVertices(path, ATTEMPTS, ATTEMPTS)
        simplifier.collapseCloseVertices(path, ATTEMPTS, ATTEMPTS)
        yield path
        simplifier.partialShortcutPath(path, ATTEMPTS, ATTEMPTS)
