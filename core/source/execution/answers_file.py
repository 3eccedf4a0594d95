"""A file of answers to what a program asks, TOML::

    [values]                     # stays so; a name or a call as it stands in the program
    di_part = true
    "$IN[3]" = false
    "GInput(giJob)" = 2
    pVision = [[350, 20, 100], [0, 0, 1, 0], [0, 0, 0, 0], [9e9, 9e9, 9e9, 9e9, 9e9, 9e9]]

    [sequences]                  # one answer after the other; the last one stays
    "get_digital_in(1)" = [false, false, true]

    [branches]                   # at a line: the branch taken, 1 for the first, 0 for ELSE or none
    "main.mod:120" = 1

    [passes]                     # at a line: how often a loop runs
    "main.mod:200" = 3

    [calls]                      # routines whose text is not at hand and that move nothing
    rGripperOpen = "skip"

    [durations]                  # s that the robot stands at a call, a wait or an output
    rGripperOpen = 0.4
    di_PressDone = 6

    [streams]                    # joints over time (CSV) that a computer sends at a statement
    EGMRunJoint = "sent.csv"

    [signals]                    # what a signal is on another robot, for translations
    do_gripper = "$OUT[3]"

Streams are looked for from the folder of the file.
"""

from __future__ import annotations

from pathlib import Path

from ...errors import InputError, UnknownNameError
from ...files.reading import read_toml
from ...program.question import Answer
from .answers import TABLES, Answers, Fields, key, placed
from .streams import load_stream

_MOST_PASSES = 10_000
_LARGEST = 1e300
_LONGEST = 86_400.0
"""s of a pause: a day."""


def load_answers(path: str | Path) -> Answers:
    """The answers in a TOML file.

    Raises:
        InputError: the file cannot be read, or a table or value is of no known kind; the message
            names the file and the key.
    """
    data = read_toml(path)
    tables: dict[str, dict[str, object]] = {}
    for name, table in data.items():
        if name not in TABLES:
            raise UnknownNameError(f"table of {path}", name, TABLES)
        if not isinstance(table, dict):
            raise InputError(f"{path}: {name} is a table, [{name}]")
        tables[name] = table
    return Answers(
        {key(k): _answer(v, path, k) for k, v in tables.get("values", {}).items()},
        {key(k): _sequence(v, path, k) for k, v in tables.get("sequences", {}).items()},
        {placed(k): _count(v, path, k) for k, v in tables.get("branches", {}).items()},
        {placed(k): _count(v, path, k) for k, v in tables.get("passes", {}).items()},
        frozenset(_skipped(k, v, path) for k, v in tables.get("calls", {}).items()),
        {key(k): _seconds(v, path, k) for k, v in tables.get("durations", {}).items()},
        str(path),
        streams={
            key(k): load_stream(Path(path).parent / _text(v, path, k))
            for k, v in tables.get("streams", {}).items()
        },
        signals={k: _signals(v, path, k) for k, v in tables.get("signals", {}).items()},
    )


def _text(value: object, path: str | Path, name: str) -> str:
    if not isinstance(value, str) or not value.strip():
        raise InputError(f"{path}: {name} in [streams] is the name of a file, not {value!r}")
    return value


def _signals(value: object, path: str | Path, name: str) -> tuple[str, ...]:
    names = value if isinstance(value, list) else [value]
    if not names or not all(isinstance(one, str) and one.strip() for one in names):
        raise InputError(
            f"{path}: {name} in [signals] is the name of a signal on the other robot, in quotes, "
            f"or a list of them, not {value!r}"
        )
    return tuple(names)


def _answer(value: object, path: str | Path, name: str) -> Answer:
    if isinstance(value, bool | str):
        return value
    if isinstance(value, int | float) and abs(value) <= _LARGEST:
        return float(value)
    if isinstance(value, list):
        return tuple(_answer(item, path, name) for item in value)
    if isinstance(value, dict):
        return Fields((str(k), _answer(item, path, name)) for k, item in value.items())
    if isinstance(value, int | float):
        raise InputError(f"{path}: {name} is too large, or no number")
    raise InputError(
        f"{path}: {name} is true or false, a number, a text, a list or a table, not {value!r}"
    )


def _sequence(value: object, path: str | Path, name: str) -> tuple[Answer, ...]:
    if not isinstance(value, list) or not value:
        raise InputError(f"{path}: {name} in [sequences] is a list of answers, not {value!r}")
    return tuple(_answer(item, path, name) for item in value)


def _count(value: object, path: str | Path, name: str) -> int:
    if isinstance(value, bool) or not isinstance(value, int) or not 0 <= value <= _MOST_PASSES:
        raise InputError(
            f"{path}: {name} is a whole number from 0 to {_MOST_PASSES}, not {value!r}"
        )
    if ":" not in name:
        raise InputError(f"{path}: {name!r} is no place: write 'file:line'")
    return value


def _seconds(value: object, path: str | Path, name: str) -> float:
    number = isinstance(value, int | float) and not isinstance(value, bool)
    if not number or not 0 <= value <= _LONGEST:  # type: ignore[operator]
        raise InputError(
            f"{path}: {name} in [durations] is a time from 0 to {_LONGEST:g} s, not {value!r}"
        )
    return float(value)  # type: ignore[arg-type]


def _skipped(name: str, value: object, path: str | Path) -> str:
    if value != "skip":
        raise InputError(f'{path}: {name} in [calls] is "skip", not {value!r}')
    return key(name)
