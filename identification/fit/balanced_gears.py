"""Where to begin again with gears that hold a weight.

A gear with slack s leads by s (tanh((l + h) / s) − tanh(h / s)), where h is what it holds at rest:
what weight asks for less what a spring balances, both a hundred times as large as the slack. Where
|h| is well above s in all places, nothing changes with slack, weight or spring: a fit that came
there, as the masses still were wrong, stays there, with the slack at nought or at what all else
left it. The masses are found without these three. So the leads are fitted once more from there,
with the spring that balances the weight.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from ...core.arrays import FloatArray
from ...core.motion.command.elasticity import held_at_rest
from ...core.motion.model.figures import Stage
from .keys import figure_of
from .minimum import Minimum, Watch, minimise
from .parameters import ParameterSet
from .run_pool import RunPool
from .runs import PreparedRun

USED_UP = 3.0
"""Slacks that a gear holds at rest beyond which slack adds nothing: tanh is within 0.5 % of one."""
ANYWHERE = 0.1
"""Share of the samples that must show slack."""
SLACK, WEIGHT, SPRING = (f"elasticity.{name}" for name in ("slack_rad", "weight", "spring_rad"))


def begun_again(
    pool: RunPool, parameters: ParameterSet, end: Minimum, watch: Watch | None = None
) -> Minimum:
    """The better of a fit and one that begins again with its springs balanced.

    Args:
        pool: knows the runs.
        parameters: that were fitted, with their starts.
        end: of the fit.
        watch: called after each iteration; True ends the fit.

    Raises:
        InputError: a program cannot be driven.
    """
    start = balanced(parameters, end.values, pool.runs)
    if start is None:
        return end
    again = parameters.starting_at(start)
    earlier = [p.name for p in again.parameters if figure_of(p.keys[0]).stage < Stage.LEAD]
    leads = replace(again, base=again.model(start)).without(earlier)
    made = minimise(pool, leads, end.nuisances, watch)
    if made.last >= end.last:
        return replace(end, iterations=end.iterations + made.iterations)
    names = [p.name for p in leads.parameters]
    found = dict(zip(names, made.values, strict=True))
    values = [found.get(p.name, p.start) for p in again.parameters]
    last = minimise(pool, again.starting_at(np.array(values)), made.nuisances, watch)
    taken = end.iterations + made.iterations + last.iterations
    return replace(min(end, last, key=lambda one: one.last), iterations=taken)


def balanced(
    parameters: ParameterSet, values: FloatArray, runs: Sequence[PreparedRun]
) -> FloatArray | None:
    """Values (P,) with springs that balance the weight, and the slack that parameters start with;
    None where no spring is fitted beside the slack of a joint that has used it up.

    Args:
        parameters: with their starts, whose weights are taken.
        values: (P,), of all else.
        runs: where they are to be balanced.
    """
    place = {p.name: k for k, p in enumerate(parameters.parameters)}
    joints = [
        j
        for j in range(runs[0].robot.size)
        if f"{SPRING}[{j}]" in place and f"{SLACK}[{j}]" in place
    ]
    q = np.concatenate([run.q for run in runs])
    held = np.abs(held_at_rest(parameters.model(values).elasticity, runs[0].robot, q))
    least = np.quantile(held, ANYWHERE, axis=0)
    joints = [j for j in joints if least[j] >= USED_UP * values[place[f"{SLACK}[{j}]"]]]
    if not joints:
        return None
    made = values.copy()
    lower, upper = parameters.bounds
    for j in joints:
        slack, spring = place[f"{SLACK}[{j}]"], place[f"{SPRING}[{j}]"]
        if f"{WEIGHT}[{j}]" in place:
            weight = place[f"{WEIGHT}[{j}]"]
            made[weight] = parameters.start[weight]
        made[slack] = parameters.start[slack] or parameters.scale[slack]
        made[spring] = 0.0
        weighed = held_at_rest(parameters.model(made).elasticity, runs[0].robot, q)[:, j]
        lever = np.sin(q[:, j])
        made[spring] = -float(weighed @ lever) / max(float(lever @ lever), 1e-12)
    return np.clip(made, lower, upper)
