"""Small experiments of robots of all vendors, designed once."""

from __future__ import annotations

import math
from functools import cache

from flyby.core.cell.cell import Cell
from flyby.core.registry import find_robot, find_vendor
from flyby.identification.experiment.design import design
from flyby.identification.experiment.kinds import Kind
from flyby.identification.experiment.plan import Experiment, Plan

ROBOTS = ("abb/irb1200-5-090", "kuka/kr30-3", "ur/ur3", "ur/ur10e")
SMALL = Plan(
    turns=(math.radians(40), math.radians(120)),
    radii=(0.004, 0.012),
    speeds=(0.15,),
    kinds=(Kind.LINES, Kind.JOINTS, Kind.LINES_AND_ARCS, Kind.LINE_STOPS, Kind.SINGLE_AXES),
    postures=1,
    minutes=None,
)


@cache
def designed(name: str, plan: Plan = SMALL) -> Experiment:
    """The experiment of a robot that stands alone."""
    vendor = find_vendor(name.partition("/")[0])
    return design(vendor, Cell(find_robot(name), vendor.name), plan, bare=True)
