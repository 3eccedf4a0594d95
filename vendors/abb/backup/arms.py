"""Which arm a controller means by what it writes: ``ROB1_4600_2.55_40``, ``IRB 4600-40/2.55``."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass

from ....core.backup.contents import listed
from ....core.door import given
from ....core.errors import InputError, UnknownNameError
from ....core.registry import UnlistedRobotError
from ....core.robot.model import Robot
from ....core.robot.model_names import words_of

FindRobot = Callable[[str], Robot]

OWN = "abb/"
_TYPE = re.compile(
    r"ROB(?:\d+|_?[A-Z])?_(?P<model>\d+[A-Z]*)(?:_(?P<before>[A-Z]\w*?))?_(?P<reach>\d+(?:\.\d+)?)"
    r"_(?P<payload>\d+(?:\.\d+)?)(?:_(?P<after>\w+))?",
    re.IGNORECASE,
)
_OTHER = re.compile(r"ROB(?:\d+|_?[A-Z])?_(?P<rest>(?P<model>\d+).*)", re.IGNORECASE)
"""A type that has not all of these: ``ROB1_580_16``."""
_NUMBER = re.compile(r"\d+(?:\.\d+)?")
_LENGTH = re.compile(r"\d\.\d+")
_MODEL = re.compile(r"(?<![\w.])(\d+[A-Z]*)(?![\w.])", re.IGNORECASE)
"""The first word of a product's name with a number in it."""
_REVISION = re.compile(r"Type_?[A-Z]\d?", re.IGNORECASE)
"""A variant of the mechanics with the lengths of its type."""
_NEAR = 0.06
"""m by which a product's name may round the reach."""
_MAKES = ("IRB", "CRB")


@dataclass(frozen=True)
class FoundArm:
    """What was found of a type.

    Args:
        robot: None if the arm is not known.
        lack: why not, and what helps; ``""`` if it is.
    """

    robot: Robot | None
    lack: str = ""


def find_arm(written: str, options: Sequence[str], find_robot: FindRobot) -> FoundArm:
    """The arm of a type.

    Args:
        written: as ``use_robot_type`` has it; ``""`` if nothing says.
        options: arms among the controller's products.
        find_robot: see `BackupOpener.open`.
    """
    refused = ""
    for name in _names(written, options):
        try:
            robot = _found(name, find_robot)
        except UnknownNameError:
            continue
        except InputError as error:  # it is known and cannot be driven, or several are meant
            refused = refused or str(error)
            continue
        if robot.name.startswith(OWN):
            return FoundArm(robot)
    said = written or listed(options)
    if not said:
        return FoundArm(
            None, f"the backup does not say which arm it is: name one, {given('robot', 'NAME')}"
        )
    if refused:
        return FoundArm(None, f"{said}: {refused}")
    near = _near(said, find_robot)
    return FoundArm(
        None,
        f"no arm {said} is known{near and f'; near it are {near}'}: "
        f"name one that will do, {given('robot', 'NAME')}",
    )


def _found(name: str, find_robot: FindRobot) -> Robot:
    """The arm of a name; of a name that rounds the reach otherwise, the only one that it may mean.

    Raises:
        InputError: there is none, or several.
    """
    try:
        return find_robot(name)
    except UnlistedRobotError as error:
        alike = [arm for arm in error.near if _rounded(words_of(name), words_of(arm.model))]
        if len(alike) != 1:
            raise
        return find_robot(alike[0].name)


def _rounded(asked: Sequence[str], listed_words: Sequence[str]) -> bool:
    """Whether two names differ by the rounding of one reach (1.93 m and 1.9 m)."""
    if len(asked) != len(listed_words):
        return False
    apart = [(a, b) for a, b in zip(asked, listed_words, strict=True) if a != b]
    return len(apart) == 1 and all(
        _LENGTH.fullmatch(a) and _LENGTH.fullmatch(b) and abs(float(a) - float(b)) < _NEAR
        for a, b in apart
    )


def _near(said: str, find_robot: FindRobot) -> str:
    """Arms of the same model, with what tells them apart."""
    found = _TYPE.fullmatch(said) or _OTHER.match(said)
    model = _NUMBER.search(found["model"] if found is not None else said)
    if model is None:
        return ""
    for make in _MAKES:
        try:
            return find_robot(f"{make} {model[0]}").name
        except UnknownNameError:
            continue
        except InputError as error:
            return str(error).partition("which? ")[2]
    return ""


def agreeing(written: str, options: Iterable[str]) -> list[str]:
    """The products that are of the same model, reach and payload as a type."""
    found = _TYPE.fullmatch(written)
    if found is None:
        return []
    model = _NUMBER.match(found["model"])
    assert model is not None
    wanted = [float(found["reach"]), float(found["payload"])]
    return [option for option in options if _agrees(option, model[0], wanted)]


def _agrees(option: str, model: str, wanted: Sequence[float]) -> bool:
    first, *others = [*_NUMBER.findall(option), ""]
    rest = [float(number) for number in others if number]
    return first == model and all(
        any(abs(number - one) < _NEAR for number in rest) for one in wanted
    )


def _names(written: str, options: Sequence[str]) -> list[str]:
    """Under which names to look, the surest first."""
    found = _TYPE.fullmatch(written)
    if found is None:
        return _names_of_others(written, options)
    fitting = agreeing(written, options)
    said = [option[:3].upper() for option in fitting]
    names = []
    variant = " ".join(filter(None, (found["before"], found["after"])))
    plain = f"{found['model']}-{found['payload']}/{found['reach']}"
    for make in sorted(_MAKES, key=lambda make: make not in said):
        names.append(f"{make} {plain} {variant}".rstrip())
        if variant and _REVISION.fullmatch(variant):
            names.append(f"{make} {plain}")
    sure = _faster(found["model"], fitting) if not variant else []
    return list(dict.fromkeys([*sure, written, names[0], *fitting, *names[1:]]))


def _faster(model: str, fitting: Sequence[str]) -> Sequence[str]:
    """Products of a variant that its type does not tell: the controller of an ``IRB 120T`` writes
    ``ROB1_120_0.58_3``, as that of an ``IRB 120``, of the same lengths; its axes are faster."""
    models = {one[1].upper() for option in fitting if (one := _MODEL.search(option))}
    varied = re.compile(rf"{re.escape(model)}[A-Z]+", re.IGNORECASE)
    return fitting if len(models) == 1 and varied.fullmatch(next(iter(models))) else []


def _names_of_others(written: str, options: Sequence[str]) -> list[str]:
    """Under which names to look for a type of another form, or of none.

    A product of another model is another robot's, or the controller's former one.
    """
    other = _OTHER.match(written)
    if other is None:
        return list(dict.fromkeys([*([written] if written else []), *options]))
    fitting = [option for option in options if other["model"] in _NUMBER.findall(option)[:1]]
    return [written, *fitting, *(f"{make} {other['rest']}" for make in _MAKES)]
