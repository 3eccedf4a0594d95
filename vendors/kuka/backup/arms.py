"""The robot of an archive: as its machine data have it, or by its name alone."""

from __future__ import annotations

import re
from collections.abc import Callable, Mapping
from dataclasses import dataclass

from ....core.backup.backup import BackupRobot
from ....core.backup.contents import BackupNotes
from ....core.errors import InputError
from ....core.robot.model import Robot
from ..data_list import DataList
from ..machine_data.described import described, rated_load
from ..machine_data.external_axes import tables_of
from ..machine_data.named_arms import name_alone, named
from .contents import Contents
from .declared import ROBOT, Machine
from .marks import MACHINE, MODEL

FindRobot = Callable[[str], Robot]
_ELSEWHERE = f"add KRC/R1/Mada/{MACHINE} of the controller"
"""What to do where the part of the archive that describes the robot is not there."""
_SIGN = re.compile(r"[^0-9A-Z]+")


@dataclass(frozen=True, slots=True)
class Lists:
    """The data lists that say which arm it is; None of those that are not there."""

    machine: DataList | None
    model: DataList | None


def lists_of(contents: Contents) -> Lists:
    """Those of an archive: of R1 and of STEU together, where R1 counts."""
    layout = contents.layout
    names: list[str | None] = [
        contents.find(layout.robot, "Mada", MACHINE),
        contents.find(layout.controller, "Mada", MACHINE),
    ]
    if not any(names):
        names = [next(iter(_outside_copies(contents, MACHINE)), None)]
    machine: DataList | None = None
    for name in names:
        found = contents.data(name)
        if found is not None and found.data:
            machine = found if machine is None else machine.over(found)
    model = contents.find(layout.robot, "Mada", MODEL) or next(
        iter(_outside_copies(contents, MODEL)), None
    )
    return Lists(machine, contents.data(model))


def robots_of(
    contents: Contents, lists: Lists, machines: Mapping[int, Machine], called: str, find: FindRobot
) -> tuple[BackupRobot, ...]:
    """The robot of an archive, whether anything says which one it is or not.

    Args:
        machines: of ``$config.dat``.
        called: the controller's name of it.
        find: an arm by its name.
    """
    notes = contents.notes
    own = next((one.name for one in machines.values() if one.kind == ROBOT), "")
    trafo = lists.machine.text("$TRAFONAME") if lists.machine else ""
    model = _agreeing_model(lists, trafo, notes)
    names = [
        one
        for one in (trafo, model.text("$MODEL_NAME") if model else "", own)
        if any(sign.isdigit() for sign in one)
    ]
    written = next(iter(names), "").lstrip("#")
    unit = called or "R1"
    if lists.machine is None:
        return (_by_name(unit, written, names, find),)
    if not lists.machine.has("$AXIS_DIR", 1) and not lists.machine.has("$LENGTH_A"):
        return (_by_name(unit, written, names, find),)  # what is there is not the robot's part
    roots = {one.kind: one.root for one in machines.values() if one.kind != ROBOT}
    try:
        robot = described(lists.machine, model, names, roots, find)
    except InputError as error:
        told = str(error).replace(f"{contents.root}/", "")
        return (_without_data(unit, written, names, told, find),)
    return (BackupRobot(unit, written, robot, robot.doubts),)


def tables_in(lists: Lists) -> dict[str, str]:
    """The axis of each table, by the table's type."""
    try:
        return tables_of(lists.machine) if lists.machine else {}
    except InputError:
        return {}


def _by_name(unit: str, written: str, names: list[str], find: FindRobot) -> BackupRobot:
    """A robot of which only the name is known, or not even that."""
    if not names:
        return BackupRobot(unit, "", None, (f"nothing says which robot it is: {_ELSEWHERE}",))
    try:
        robot = name_alone(names, find)
    except InputError as error:
        return BackupRobot(unit, written, None, (str(error),))
    if robot is None:
        lack = f"no listed arm is called {written}, or several are; {_ELSEWHERE}"
        return BackupRobot(unit, written, None, (lack,))
    lack = (
        f"no {MACHINE} can be read: lengths, limits and place are those of its type; {_ELSEWHERE}"
    )
    return BackupRobot(unit, written, robot, (lack,))


def _without_data(
    unit: str, written: str, names: list[str], reason: str, find: FindRobot
) -> BackupRobot:
    """A robot whose machine data cannot be used: an arm that is not modelled, or a damaged file."""
    if "cannot be driven" in reason:
        return BackupRobot(unit, written, None, (reason,))
    found = _by_name(unit, written, names, find) if names else None
    if found is None or found.robot is None:
        return BackupRobot(unit, written, None, (reason, *(found.lacks[:1] if found else ())))
    lack = f"{reason}: lengths, limits and place are those of its type"
    return BackupRobot(unit, written, found.robot, (lack,))


def _agreeing_model(lists: Lists, trafo: str, notes: BackupNotes) -> DataList | None:
    """``$robcor.dat``, unless it is another arm's."""
    model = lists.model
    if model is None or lists.machine is None:
        return model
    other = model.text("$MODEL_NAME")
    if not other or not trafo or _same(trafo, other):
        return model
    line = model.data["$MODEL_NAME", 0].line
    left = ", its rated load is left out" if rated_load(lists.machine, model) else ""
    notes.add(
        f"$MODEL_NAME says {other.lstrip('#')}, $TRAFONAME of {MACHINE} {trafo.lstrip('#')}: this "
        f"file is another arm's{left}",
        model.name,
        line,
    )
    return None


def _same(one: str, other: str) -> bool:
    a, b = (_SIGN.sub("", name.upper()) for name in (one, other))
    if a.startswith(b) or b.startswith(a):
        return True
    first = [next(named([name]), []) for name in (one, other)]
    return bool({arm.name for arm in first[0]} & {arm.name for arm in first[1]})


def _outside_copies(contents: Contents, name: str) -> list[str]:
    copies = tuple(f"{copy}/" for copy in contents.layout.copies)
    return [one for one in contents.called(name) if not one.startswith(copies or ("//",))]
