"""Which listed arm machine data are of: by what the controller calls it, and by its lengths."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterable, Iterator, Sequence
from functools import cache
from itertools import takewhile
from pathlib import Path

import numpy as np

from ....core.errors import InputError
from ....core.robot.arm_list import ArmList, Listed
from ....core.robot.model import Robot
from ....core.robot.model_names import matching, meant
from ....core.spatial.pose import IDENTITY

FindRobot = Callable[[str], Robot]
_LIST = Path(__file__).parent.parent / "data" / "arms.jsonl"
_SHORTEST = 2
"""Characters of a name with a number in it."""
_MOUNTING = re.compile(r"\b(c[245]\w*|sr|flr|clg|wll|wall|floor|ceiling|zh\d*)\b")
_PAYLOAD = re.compile(r"kr[\s_-]*(\d+(?:\.\d+)?)(?:[\s_-]*L(\d+(?:\.\d+)?))?", re.IGNORECASE)
APART = 1e-3
"""m by which the flange of the same type may be apart, as published lengths are rounded."""


def named(names: Iterable[str]) -> Iterator[list[Listed]]:
    """The listed arms that names may mean, all words of a name first, then without the last ones.

    Controllers add how the arm is mounted and which controller it is: ``#KR6R900 C4SR FLR 230``.
    """
    for name in names:
        words = name.replace("#", " ").split()
        for count in range(len(words), 0, -1):
            asked = " ".join(words[:count])
            if len(asked) < _SHORTEST or not any(sign.isdigit() for sign in asked):
                break
            found = matching(asked, _arms())
            if found:
                yield found


def listed_arm(
    robot: Robot, names: Sequence[str], payload: float | None, find_robot: FindRobot
) -> tuple[Robot | None, tuple[str, ...]]:
    """The listed arm of these names whose flange is where a robot's is.

    Args:
        robot: as a file describes it.
        names: that its controller has for it.
        payload: kg, if stated.
        find_robot: loads a listed arm.

    Returns:
        The arm, or None; and what speaks against it.
    """
    nearest: tuple[float, str] | None = None
    for arms in named(names):
        drivable = [arm for arm in arms if arm.refused is None]
        loaded = [(arm, find_robot(arm.name)) for arm in drivable]
        off = [(apart(robot, known), arm.model) for arm, known in loaded]
        fitting = [one for one, (far, _) in zip(loaded, off, strict=True) if far <= APART]
        if fitting:
            alike = [one for one in fitting if one[0].payload == payload] or fitting
            chosen = alike[0][1]
            others = ", ".join(arm.name for arm, one in alike[1:] if one.links != chosen.links)
            doubt = (f"its name and its lengths are those of {others} as well",) if others else ()
            return chosen, doubt
        nearest = nearest or min(off, default=None)
    if nearest is None:
        return None, ()
    far, model = nearest
    return None, (
        f"its name says {model}, whose flange is up to {1e3 * far:.0f} mm elsewhere: the lengths "
        "of the file are taken, and nothing of that arm",
    )


def name_alone(names: Sequence[str], find_robot: FindRobot) -> Robot | None:
    """The one listed arm that names mean, of which nothing else is known; None if several may be.

    Only how the arm is mounted may be left out of a name: an ``EXTRA`` is another arm.

    Raises:
        InputError: it cannot be driven; with the reason.
    """
    for name in names:
        words = name.replace("#", " ").split()
        of_arm = takewhile(lambda word: not _MOUNTING.fullmatch(word.lower()), words)
        asked = " ".join(of_arm)
        arms = matching(asked, _arms())
        if not arms:
            continue
        if len(arms) > 1 or not meant(asked, arms[0]):
            return None
        if arms[0].refused is not None:
            raise InputError(f"{arms[0].model} cannot be driven: {arms[0].refused}")
        return find_robot(arms[0].name)
    return None


def apart(one: Robot, other: Robot) -> float:
    """m by which the flanges of two arms are apart at most, at some configurations."""
    if one.arm_size != other.arm_size:
        return float("inf")
    q = np.random.default_rng(0).uniform(-1.0, 1.0, (20, one.arm_size))
    at = [robot.with_external_axes(()).with_base(IDENTITY).forward(q)[1] for robot in (one, other)]
    return float(np.linalg.norm(at[0] - at[1], axis=1).max())


def payload_of_name(names: Iterable[str]) -> float | None:
    """kg that a model's name states: KR 210 carries 210 kg, its longer KR 210 L180 180 kg."""
    for name in names:
        found = _PAYLOAD.search(name)
        if found is not None and 0.0 < (mass := float(found[2] or found[1])) < 5000.0:
            return mass
    return None


def called(names: Iterable[str]) -> str:
    """A name for an arm that is not listed, as the catalogue spells them: ``kuka/kr6r900``."""
    for name in names:
        words = _MOUNTING.sub(" ", name.lower().replace("#", " "))
        spelt = re.sub(r"[^a-z0-9.]+", "-", words).strip("-.")[:40].strip("-.")
        if any(sign.isdigit() for sign in spelt):
            return f"kuka/{spelt}"
    return "kuka/robot"


@cache
def _arms() -> tuple[Listed, ...]:
    return tuple(ArmList(_LIST).listed().values())
