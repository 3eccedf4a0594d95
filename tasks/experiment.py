"""Test motions that show how a controller drives, as programs that log themselves."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from enum import StrEnum
from typing import TYPE_CHECKING, Any, TypeVar

from ..core.door import given, spelt
from ..core.errors import OptionError
from .options import texts
from .options.entries import (
    ANGLE,
    COUNT,
    NOT_NEGATIVE,
    NUMBER,
    POSITIVE,
    TIME,
    number,
    value,
)
from .options.keywords import by_keywords
from .record import PERIODS
from .setup import CellOptions, setup_of

if TYPE_CHECKING:
    from ..core.cell.cell import Cell
    from ..core.program.tool import Tool
    from ..core.robot.model import Robot
    from ..identification.experiment.plan import Plan
    from .results.experiments import DesignedExperiment

Word = TypeVar("Word", bound=StrEnum)


@dataclass(frozen=True, kw_only=True)
class ExperimentOptions(CellOptions):
    """Which test motions are wanted."""

    tool: str | None = value(None, "Tool of the cell that is mounted; the flange if unset.")
    minutes: float = number(
        60.0,
        "Minutes at the robot; the most informative runs that fit are chosen.",
        NUMBER,
        POSITIVE,
    )
    overhead: float = number(
        20.0, "Seconds that a run takes beside its motion.", TIME, NOT_NEGATIVE
    )
    about: str | Sequence[str] | None = value(
        None,
        "Open questions of the motion model that runs shall settle, such as short-legs,turns; runs "
        "of all kinds if unset.",
    )
    postures: int | None = number(
        None, "How many postures to look for; 3, or 8 about postures, if unset.", COUNT
    )
    at: Sequence[str | Sequence[float]] = value(
        (),
        "A posture instead: axis values in degrees; may be given several times.",
        several=True,
        numbers="rad and m",
    )
    angles: str | Sequence[float] | None = value(
        None, "Changes of direction at corners, degrees: 30,90,150.", numbers="rad"
    )
    zones: str | Sequence[float] | None = value(
        None, "Radii of zones, mm; by the robot's reach if unset.", numbers="m"
    )
    speeds: str | Sequence[float] | None = value(None, "Speeds of the TCP, mm/s.", numbers="m/s")
    kinds: str | Sequence[str] | None = value(
        None, "Kinds of moves, such as lines,joints; all if unset."
    )
    margin: float = number(5.0, "What joints keep from limits, {unit}.", ANGLE)
    longest: float = number(30.0, "Seconds that one run may last, about.", TIME, POSITIVE)
    period: float | None = number(
        None, "Seconds between logged samples; what the controller takes if unset.", TIME, PERIODS
    )
    seed: int = number(1, "Another one gives another design.", COUNT)


def experiment_with(options: ExperimentOptions) -> DesignedExperiment:
    """Design test motions for a robot in its cell: programs that log themselves.

    Returns:
        The runs, the most informative first, with what each gains; `flyby.write` puts programs,
        records and a page of instructions into a folder.

    Raises:
        InputError: naming the option.
    """
    from ..identification.experiment.design import design
    from .results.experiments import DesignedExperiment

    setup = setup_of(options)
    cell, notes = setup.before_programs(no_floor=options.no_floor)
    plan = _plan(setup.robot, options, _tool(options.tool, cell))
    made = design(setup.vendor, cell, plan, bare=setup.cell is None, say=options.say)
    made = replace(made, notes=(*(note.message for note in notes), *made.notes))
    file = None if setup.cell is None else setup.cell.file
    return DesignedExperiment(made, cell, file, options.inputs())


experiment = by_keywords(experiment_with, ExperimentOptions)


def _tool(name: str | None, cell: Cell) -> Tool:
    from ..core.program.tool import FLANGE

    if name is None:
        return FLANGE
    if cell.file is None and name not in cell.tools:
        raise OptionError(
            f"{given('tool', name)}: tools are declared in a cell file; give {spelt('cell')}"
        )
    return cell.tool(name)


def _plan(robot: Robot, options: ExperimentOptions, tool: Tool) -> Plan:
    import numpy as np

    from ..identification.experiment.kinds import KINDS, Topic
    from ..identification.experiment.plan import Plan

    chosen: dict[str, Any] = {}
    if options.angles is not None:
        chosen["turns"] = texts.several(options.angles, spelt("angles"), math.pi / 180)
    if options.zones is not None:
        chosen["radii"] = texts.several(options.zones, spelt("zones"), 1e-3)
    if options.speeds is not None:
        chosen["speeds"] = texts.several(options.speeds, spelt("speeds"), 1e-3)
    if options.kinds is not None and options.about is not None:
        raise OptionError(
            f"{spelt('kinds')} and {spelt('about')}: a topic says which kinds of moves there are; "
            "leave one of them out"
        )
    if options.kinds is not None:
        chosen["kinds"] = _known("kinds", options.kinds, KINDS)
    if options.about is not None:
        chosen["about"] = _known("about", options.about, tuple(Topic))
    stands = [np.array(texts.configuration(one, spelt("at"), robot)) for one in options.at]
    return Plan(
        postures=stands or options.postures,
        tool=tool,
        minutes=options.minutes,
        overhead=options.overhead,
        margin=options.margin,
        longest=options.longest,
        period=options.period,
        seed=options.seed,
        **chosen,
    )


def _known(option: str, asked: str | Sequence[str], known: tuple[Word, ...]) -> tuple[Word, ...]:
    """Those of the known words that are asked for."""
    words = asked.replace(",", " ").split() if isinstance(asked, str) else list(asked)
    for word in words:
        if word not in list(known):
            raise OptionError(f"{spelt(option)} {word}: {', '.join(known)}")
    if not words:
        raise OptionError(f"{spelt(option)}: name at least one of {', '.join(known)}")
    return tuple(one for one in known if one in words)
