"""Golden texts: what programs say, by their author's knowledge and not by the plugin's.

A round trip cannot tell mm/s from m/s: a writer and a reader that are wrong alike agree. So an
author writes down, in a TOML file, texts as controllers run them beside what they mean::

    none = ["load"]                        # what the language has no words for

    [[robots]]                             # numbers of the data sheet
    name = "arm-1"
    lower_deg = [-170, -90, -120, -180, -120, -350]
    upper_deg = [170, 120, 120, 180, 120, 350]
    velocity_deg_s = [200, 200, 260, 360, 360, 450]
    poses = [{ joints_deg = [30, -20, 15, 40, -35, 60], position_mm = […], quaternion = […] }]

    [[texts]]
    about = "a joint move, and a line beside an output"
    robot = "arm-1"                      # that drives it
    files."main.acme" = '''…'''            # the one that is read comes first

    [[texts.statements]]
    kind = "MoveL"
    position_mm = [250, 60, 40]
    quaternion = [0, 0, 1, 0]
    stands_deg = [30, -20, 15, 40, -35, 60]
    speed = { tcp_mm_s = 250 }
    zone = { kind = "Radius", tcp_mm = 8 }
    events = [{ sets = "do3", to = true, distance_mm = 15 }]

What must not be read, since the plugin would take it for something else, stands in ``[[refused]]``:
``about``, ``files``, ``says``, a part of the message, and ``robot`` and ``answers`` as of a text.

A text with ``recorded = { period_ms = 24, lines = ["RUN LOGGER", "…"] }`` says by which lines, in
their order, its recording begins to log, how often, and how it ends.

Keys end in their unit. Tools, frames and loads may be stated once, ``tools.gun = { … }``, and named
in statements, ``tool = "gun"``. Numbers that are not stated are not compared, but for what counts
when it is there: a move without ``zone`` is a stop, and has no tool, frame, load or events unless
they are stated. ``not_driven = ["target"]`` says that the text uses this part's numbers elsewhere,
in code that is not driven. `TERMS` lists what statements are compared by.
"""

from __future__ import annotations

import math
import tomllib
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field, fields, replace
from pathlib import Path
from typing import Any

from ..core.dialect import SignalWords
from ..core.errors import InputError
from ..core.program.event import Event
from ..core.program.move import MoveC, Opaque, Statement, Wait
from ..core.program.question import Answer
from ..core.program.signal import Level, SetSignal, SignalAction, WaitSignal
from ..core.program.target import JointTarget, Target
from ..core.program.zone import zone_word
from ..core.spatial.pose import Pose

UNITS = {
    "mm": 1e-3,
    "m": 1.0,
    "deg": math.pi / 180,
    "rad": 1.0,
    "mm_s": 1e-3,
    "m_s": 1.0,
    "deg_s": math.pi / 180,
    "rad_s": 1.0,
    "m_s2": 1.0,
    "mm_s2": 1e-3,
    "deg_s2": math.pi / 180,
    "rad_s2": 1.0,
    "percent": 1e-2,
    "s": 1.0,
    "ms": 1e-3,
    "kg": 1.0,
}
"""Endings of keys, and what they are in SI."""
_LONGEST_FIRST = sorted(UNITS, key=len, reverse=True)
NEAR = 1e-6
"""Share, and m, rad, s, by which a stated number may be off: authors round to six places."""
NEAR_TURN = 1e-5
"""Of quaternions: texts state angles and quaternions with five places and more."""
_NAMED = {"tool": "tools", "frame": "frames", "load": "loads"}
"""What may be stated once, and the table that it stands in."""
_SHARED = ", ".join(_NAMED.values())
_OF_TEXTS = frozenset({"about", "files", "robot", "answers"})
"""Keys of all texts."""
_BESIDE = ("kind", "stands", "not_driven")
"""Terms of a statement that are no numbers of its own."""


@dataclass(frozen=True)
class GoldenText:
    """A text and what it says.

    Args:
        about: what it is about.
        files: texts by file name; the first one is read.
        statements: by term, in SI units; see the module.
        robot: that drives it; None where the text is only read.
        entry: the routine that is driven; None for the usual one.
        recorded: s between samples of its recording, and lines that this has; None if it is not
            recorded.
        answers: to what the text asks of the world, by the names of inputs and data.
        says: a part of the message with which it is refused.
    """

    about: str
    files: Mapping[str, str]
    statements: tuple[Mapping[str, Any], ...]
    robot: str | None = None
    entry: str | None = None
    recorded: tuple[float, tuple[str, ...]] | None = None
    answers: Mapping[str, Answer] = field(default_factory=dict)
    says: str = ""


@dataclass(frozen=True)
class GoldenRobot:
    """Numbers of a robot's data sheet, in SI units: ``lower``, ``upper``, ``velocity`` of the
    joints, and ``poses`` of the flange in the base (``joints``, ``position``, ``quaternion``)."""

    name: str
    numbers: Mapping[str, Any]


@dataclass(frozen=True)
class Golden:
    """What an author knows.

    Args:
        texts: with what they say.
        robots: with numbers of their data sheets.
        refused: that are refused; ``says`` is a part of the message.
        none: what the language has no words for, of `LANGUAGE`.
    """

    texts: tuple[GoldenText, ...] = ()
    robots: tuple[GoldenRobot, ...] = ()
    refused: tuple[GoldenText, ...] = ()
    none: frozenset[str] = field(default_factory=frozenset)

    @classmethod
    def read(cls, path: str | Path) -> Golden:
        """The golden texts of a TOML file.

        Raises:
            InputError: it is no such file; the message names the key.
        """
        try:
            data = tomllib.loads(Path(path).read_text("utf-8"))
            return _golden(data)
        except (OSError, UnicodeDecodeError, tomllib.TOMLDecodeError, InputError) as error:
            raise InputError(f"{path}: {error}") from error


LANGUAGE = (
    *("MoveJ", "MoveL", "MoveC", "Wait", "Opaque", "joint target", "pose target", "tool"),
    *("frame", "load", "configuration", "comment", "computed target", "shared datum"),
    *("code that is not driven",),
)
"""What golden texts must have, unless the language has none of it."""


def _golden(data: Mapping[str, Any]) -> Golden:
    unknown = sorted(data.keys() - {"none", "robots", "texts", "refused", *_NAMED.values()})
    if unknown:
        known = f"none, robots, texts, refused, {_SHARED}"
        raise InputError(f"unknown key {unknown[0]!r}: there are {known}")
    none = frozenset(data.get("none", ()))
    if none - set(LANGUAGE):
        raise InputError(f"none: there is no {sorted(none - set(LANGUAGE))[0]!r} in {LANGUAGE}")
    return Golden(
        tuple(_text(one, data) for one in data.get("texts", ())),
        tuple(_robot(one) for one in data.get("robots", ())),
        tuple(_refused(one) for one in data.get("refused", ())),
        none,
    )


def _text(data: Mapping[str, Any], shared: Mapping[str, Any]) -> GoldenText:
    about = data.get("about", "")
    if not about or not data.get("files"):
        raise InputError("a text has 'about', 'files' by name, and 'statements'")
    _check_keys(data, {*_OF_TEXTS, "entry", "recorded", "statements"})
    rows = tuple(_in_si(_spelt_out(one, shared)) for one in data.get("statements", ()))
    for row in rows:
        known = TERMS[_kind(row)]
        for term in row:
            plain = ".".join(p for p in term.split(".") if not p.isdecimal())
            if plain not in known:
                raise InputError(
                    f"text {about!r}: a {row['kind']} has no {term!r}; it has {', '.join(known)}"
                )
    told = data.get("recorded")
    recorded = None
    if told is not None:
        own = _in_si(told)
        if set(own) != {"period", "lines"} or not own["lines"] or not data.get("robot"):
            raise InputError(
                f'text {about!r}: recorded = {{ period_ms = …, lines = ["…"] }}, and its robot'
            )
        recorded = own["period"], tuple(own["lines"])
    made = GoldenText(about, dict(data["files"]), rows, data.get("robot"), data.get("entry"))
    return replace(made, recorded=recorded, answers=_answers(data))


def _refused(data: Mapping[str, Any]) -> GoldenText:
    if not (data.get("about") and data.get("files") and data.get("says")):
        raise InputError("a refused text has 'about', 'files', and what its message 'says'")
    _check_keys(data, {*_OF_TEXTS, "says"})
    made = GoldenText(data["about"], dict(data["files"]), (), data.get("robot"))
    return replace(made, says=data["says"], answers=_answers(data))


def _check_keys(data: Mapping[str, Any], known: set[str]) -> None:
    unknown = sorted(data.keys() - known)
    if unknown and unknown[0] in _NAMED.values():
        raise InputError(f"text {data['about']!r}: {unknown[0]} stand before all texts")
    if unknown:
        raise InputError(
            f"text {data['about']!r}: unknown key {unknown[0]!r}: there are "
            f"{', '.join(sorted(known))}"
        )


def _answers(data: Mapping[str, Any]) -> dict[str, Answer]:
    """Answers by name; upper and lower case are the same, as in files of answers."""
    told = data.get("answers", {})
    return {k.lower(): float(v) if type(v) is int else v for k, v in told.items()}


def _spelt_out(row: Mapping[str, Any], shared: Mapping[str, Any]) -> dict[str, Any]:
    """A statement with the tools, frames and loads that it names."""
    made = dict(row)
    for part, table in _NAMED.items():
        name = made.get(part)
        if isinstance(name, str):
            if name not in shared.get(table, {}):
                raise InputError(f"{part} {name!r} is not among {table}")
            made[part] = shared[table][name]
    return made


def _kind(row: Mapping[str, Any]) -> str:
    kind = row.get("kind")
    if kind not in TERMS:
        raise InputError(f"kind is one of {', '.join(TERMS)}, not {kind!r}")
    return str(kind)


def _robot(data: Mapping[str, Any]) -> GoldenRobot:
    numbers = dict(data)
    name = numbers.pop("name", "")
    poses = [_in_si(one) for one in numbers.pop("poses", ())]
    return GoldenRobot(name, {**_in_si(numbers), "poses": poses})


def _in_si(entry: Mapping[str, Any], prefix: str = "") -> dict[str, Any]:
    """The numbers of a table by their terms, without the units that keys end in."""
    found: dict[str, Any] = {}
    for key, value in entry.items():
        if isinstance(value, Mapping):
            found |= _in_si(value, f"{prefix}{key}.")
        elif isinstance(value, list) and value and isinstance(value[0], Mapping):
            for index, one in enumerate(value):
                found |= _in_si(one, f"{prefix}{key}.{index}.")
        else:
            unit = next((u for u in _LONGEST_FIRST if key.endswith(f"_{u}")), None)
            if unit is None:
                found[prefix + key] = value
            else:
                found[prefix + key.removesuffix(f"_{unit}")] = _scaled(value, UNITS[unit])
    return found


def _scaled(value: Any, factor: float) -> Any:
    return [one * factor for one in value] if isinstance(value, list) else value * factor


# ------------------------------------------------------------------ what statements say


def terms_of(statement: Statement, signals: SignalWords | None = None) -> dict[str, Any]:
    """What a statement says, by the terms of golden texts.

    Args:
        statement: as its reader made it.
        signals: by which statements on signals and events are understood; None for as text alone.
    """
    kind = {"kind": type(statement).__name__}
    if isinstance(statement, Wait):
        return {**kind, "duration": statement.duration}
    if isinstance(statement, Opaque):
        done = _action(signals.read(statement.text) if signals else None)
        return {**kind, "text": statement.text.strip(), "stops": statement.stops, **done}
    zone, load = statement.zone, statement.load
    found: dict[str, Any] = {**kind, **dict(_target(statement.target, ""))}
    if isinstance(statement, MoveC):
        found |= {**dict(_target(statement.via, "via.")), "arc": str(statement.orientation)}
    found |= {f"speed.{f.name}": getattr(statement.speed, f.name) for f in fields(statement.speed)}
    found |= {f"zone.{f.name}": getattr(zone, f.name) for f in fields(zone)}
    found["zone.kind"] = zone_word(zone)
    found |= dict(_frame(statement.tool.tcp, "tool."))
    found |= {
        "tool.robot_held": statement.tool.robot_held,
        "tool.mass": statement.tool.load.mass if statement.tool.load else 0.0,
    }
    found |= dict(_frame(statement.work_object.pose, "frame."))
    found["load.mass"] = load.mass if load else 0.0
    found["load.centre"] = load.centre if load else (0.0, 0.0, 0.0)
    for index, event in enumerate(statement.events):
        found |= {f"events.{index}.{k}": v for k, v in _event(event, signals).items()}
    return found


def _target(target: Target, prefix: str) -> Iterator[tuple[str, Any]]:
    yield f"{prefix}external", target.external
    if isinstance(target, JointTarget):
        yield f"{prefix}joints", target.joints
    else:
        yield from _frame(target.pose, prefix)
        label = target.configuration
        yield f"{prefix}configuration", None if label is None else str(label)


def _frame(pose: Pose, prefix: str) -> Iterator[tuple[str, Any]]:
    yield f"{prefix}position", pose.position
    yield f"{prefix}quaternion", pose.quaternion


def _action(action: SignalAction | None) -> dict[str, Any]:
    if isinstance(action, SetSignal):
        return {"sets": action.name, "to": action.value, "pulse": action.pulse}
    if isinstance(action, WaitSignal) and isinstance(action.condition, Level):
        return {"waits": action.condition.name, "on": action.condition.on}
    return {}


def _event(event: Event, signals: SignalWords | None) -> dict[str, Any]:
    done = _action(signals.read(signals.event(event.text)) if signals else None)
    text = {"text": event.text.strip(), "anchor": str(event.anchor)}
    return {**text, "distance": event.distance, "time": event.time, **done}


_SPEED = (
    *("tcp", "reorientation", "external_linear", "external_angular", "joint", "joint_fraction"),
    *("tcp_acceleration", "reorientation_acceleration", "joint_acceleration"),
    *("joint_acceleration_fraction", "acceleration_override", "jerk_fraction", "duration", "name"),
)
_ZONE = (
    *("kind", "tcp", "reorientation", "external", "angle", "external_linear"),
    *("size", "ratio"),
)
_MOVE = (
    *_BESIDE,
    *("joints", "external", "position", "quaternion", "configuration"),
    *(f"speed.{name}" for name in _SPEED),
    *(f"zone.{name}" for name in (*_ZONE, "external_angular", "fraction", "name")),
    *("tool.position", "tool.quaternion", "tool.mass", "tool.robot_held"),
    *("frame.position", "frame.quaternion", "load.mass", "load.centre", "events"),
    *(f"events.{name}" for name in ("text", "anchor", "distance", "time", "sets", "to", "pulse")),
)
TERMS: Mapping[str, tuple[str, ...]] = {
    "MoveJ": _MOVE,
    "MoveL": _MOVE,
    "MoveC": (*_MOVE, "via.position", "via.quaternion", "via.configuration", "arc"),
    "Wait": ("kind", "duration"),
    "Opaque": ("kind", "text", "stops", "sets", "to", "pulse", "waits", "on"),
}
"""What statements are compared by."""

_UNLESS_STATED: Mapping[str, Any] = {
    "zone.kind": "Fine",
    "tool.position": (0.0, 0.0, 0.0),
    "tool.quaternion": (1.0, 0.0, 0.0, 0.0),
    "tool.robot_held": True,
    "tool.mass": 0.0,
    "frame.position": (0.0, 0.0, 0.0),
    "frame.quaternion": (1.0, 0.0, 0.0, 0.0),
    "load.mass": 0.0,
}


def differences(
    stated: Mapping[str, Any], statement: Statement, signals: SignalWords | None
) -> list[str]:
    """What a statement says otherwise than stated, each for a message."""
    said = terms_of(statement, signals)
    wanted = {key: value for key, value in stated.items() if key not in _BESIDE[1:]}
    if "zone.kind" in said:
        wanted = {**_UNLESS_STATED, **wanted}
        events = {key.split(".")[1] for key in wanted if key.startswith("events.")}
        found = {key.split(".")[1] for key in said if key.startswith("events.")}
        if len(events) != len(found):
            return [f"events: {len(events)} stated, {len(found)} read"]
    wrong = []
    for term, value in wanted.items():
        other = said.get(term)
        if term != "events" and not _alike(term, value, other):
            wrong.append(f"{term}: {_shown(value)} stated, {_shown(other)} read")
    return wrong


def _alike(term: str, stated: Any, read: Any) -> bool:
    if term.endswith("quaternion"):
        return read is not None and any(
            _near(stated, [sign * part for part in read], NEAR_TURN) for sign in (1, -1)
        )
    return _near(stated, read, NEAR)


def _near(one: Any, other: Any, tolerance: float) -> bool:
    if isinstance(one, list | tuple) and isinstance(other, list | tuple):
        pairs = zip(one, other, strict=False)
        return len(one) == len(other) and all(_near(a, b, tolerance) for a, b in pairs)
    if isinstance(one, bool) or isinstance(other, bool):
        return bool(one == other)
    if isinstance(one, int | float) and isinstance(other, int | float):
        return math.isclose(one, other, rel_tol=tolerance, abs_tol=tolerance)
    return bool(one == other)


def _shown(value: Any) -> str:
    if isinstance(value, list | tuple):
        return f"[{', '.join(map(_shown, value))}]"
    return f"{value:.7g}" if isinstance(value, float) else repr(value)
