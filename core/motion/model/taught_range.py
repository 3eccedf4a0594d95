"""Which motions a fit was taught by: beyond them its figures are extrapolated.

    [fits.cell-3.range]
    moves = ["MoveJ", "MoveL"]
    stops = true
    speed_mps = [0.05, 1.49]
    zone_m = [0.001, 0.2]
    leg_m = 0.084
    joints_rad = [[-0.9, -0.1, -0.2, -0.5, 0.1, -1.2], [0.7, 0.9, 0.6, 0.8, 1.3, 1.1]]
    payload_kg = [0.0, 12.0]

Of what stands there not nothing is known, and nothing is said.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from typing import Any

from ...errors import InputError, UnknownNameError

Span = tuple[float, float]
"""Least and greatest."""
KINDS = ("MoveC", "MoveJ", "MoveL")
_SPANS = {"speed_mps": "speed", "zone_m": "zone", "payload_kg": "payload"}
_KEYS = ("moves", "stops", "speed_mps", "zone_m", "leg_m", "joints_rad", "payload_kg")


@dataclass(frozen=True)
class TaughtRange:
    """What runs covered; None, or nothing, of what they do not tell.

    Args:
        moves: the kinds of moves.
        stops: whether the robot stopped on the way.
        speed: m/s of the TCP, from the lowest programmed to the highest reached.
        zone: m, radii of the zones that were driven through.
        leg: m, the shortest way of the TCP from waypoint to waypoint.
        lower, upper: (N,) rad or m, the axes' least and greatest values.
        payload: kg, tools included.

    Raises:
        InputError: a span ends before it begins, or is no span of numbers.
    """

    moves: tuple[str, ...] = ()
    stops: bool = False
    speed: Span | None = None
    zone: Span | None = None
    leg: float | None = None
    lower: tuple[float, ...] = ()
    upper: tuple[float, ...] = ()
    payload: Span | None = None

    def __post_init__(self) -> None:
        for kind in self.moves:
            if kind not in KINDS:
                raise UnknownNameError("kind of moves", kind, KINDS)
        for key, name in _SPANS.items():
            span = getattr(self, name)
            if span is not None and not 0.0 <= span[0] <= span[1] < math.inf:
                raise InputError(f"{key}: {list(span)} are no least and greatest value")
        if self.leg is not None and not 0.0 < self.leg < math.inf:
            raise InputError(f"leg_m: must be finite and above zero, not {self.leg}")
        ends = list(zip(self.lower, self.upper, strict=False))
        finite = all(map(math.isfinite, (*self.lower, *self.upper)))
        if len(self.lower) != len(self.upper) or not finite or any(a > b for a, b in ends):
            raise InputError("joints_rad: a list of the axes' least values and one of the greatest")


def merged(ranges: Iterable[TaughtRange]) -> TaughtRange:
    """What several cover together."""
    known = list(ranges)

    def span(name: str) -> Span | None:
        spans = [one for taught in known if (one := getattr(taught, name)) is not None]
        return (min(a for a, _ in spans), max(b for _, b in spans)) if spans else None

    def ends(name: str, choose: Any) -> tuple[float, ...]:
        of_all = [one for taught in known if (one := getattr(taught, name))]
        return tuple(map(choose, zip(*of_all, strict=False)))

    legs = [taught.leg for taught in known if taught.leg is not None]
    return TaughtRange(
        tuple(kind for kind in KINDS if any(kind in taught.moves for taught in known)),
        any(taught.stops for taught in known),
        span("speed"),
        span("zone"),
        min(legs, default=None),
        ends("lower", min),
        ends("upper", max),
        span("payload"),
    )


def read_range(entry: Any) -> TaughtRange:
    """The range that a file states.

    Args:
        entry: its table.

    Raises:
        InputError: a key is unknown or has a wrong value; the message names it.
    """
    if not isinstance(entry, Mapping):
        raise InputError(f"a table is expected, not {entry!r}")
    for key in entry:
        if key not in _KEYS:
            raise UnknownNameError("key of a range", key, _KEYS)
    moves, stops = entry.get("moves", []), entry.get("stops", False)
    if not isinstance(moves, list) or not all(isinstance(one, str) for one in moves):
        raise InputError(f"moves: a list of {', '.join(KINDS)} is expected, not {moves!r}")
    if not isinstance(stops, bool):
        raise InputError(f"stops: true or false is expected, not {stops!r}")
    spans = {
        name: _numbers(key, entry[key], 2) if key in entry else None for key, name in _SPANS.items()
    }
    joints = entry.get("joints_rad", [[], []])
    if not isinstance(joints, list) or len(joints) != 2:
        raise InputError("joints_rad: a list of the axes' least values and one of the greatest")
    lower, upper = (_numbers("joints_rad", one) for one in joints)
    leg = _numbers("leg_m", [entry["leg_m"]], 1)[0] if "leg_m" in entry else None
    return TaughtRange(tuple(moves), stops, leg=leg, lower=lower, upper=upper, **spans)  # type: ignore[arg-type]


def _numbers(key: str, values: Any, count: int | None = None) -> tuple[float, ...]:
    good = isinstance(values, list) and all(
        isinstance(one, int | float) and not isinstance(one, bool) for one in values
    )
    if not good or (count is not None and len(values) != count):
        many = (
            "numbers are" if count is None else "a number is" if count == 1 else "two numbers are"
        )
        raise InputError(f"{key}: {many} expected, not {values!r}")
    return tuple(map(float, values))


def range_entries(taught: TaughtRange) -> dict[str, Any]:
    """As a file states it, numbers to four digits, rounded outward."""
    spans = {key: getattr(taught, name) for key, name in _SPANS.items()}
    joints = [[_down(v) for v in taught.lower], [_up(v) for v in taught.upper]]
    found: dict[str, Any] = {"moves": list(taught.moves), "stops": taught.stops}
    found |= {
        key: [_down(span[0]), _up(span[1])] for key, span in spans.items() if span is not None
    }
    found |= {} if taught.leg is None else {"leg_m": _down(taught.leg)}
    return found | ({"joints_rad": joints} if taught.lower else {})


def _down(value: float) -> float:
    """To four digits, no greater than it was."""
    size = math.floor(math.log10(abs(value))) if abs(value) > 1e-9 else -9
    step = 10.0 ** min(size - 3, -4) if size < 1 else 10.0 ** (size - 3)
    return round(math.floor(round(value / step, 3)) * step, 15) + 0.0


def _up(value: float) -> float:
    """To four digits, no less than it was."""
    return 0.0 - _down(-value)


def shown(taught: TaughtRange) -> str:
    """In words, for people at the robot: mm, mm/s and degrees."""
    found = []
    if taught.moves:
        found.append(_listed([_WORDS[kind] for kind in taught.moves]))
    if taught.speed is not None:
        found.append(f"{_span(taught.speed, 1e3)} mm/s")
    if taught.zone is not None:
        found.append(f"zones of {_span(taught.zone, 1e3)} mm")
    if taught.stops:
        found.append("stops on the way")
    if taught.leg is not None:
        found.append(f"legs from {1e3 * taught.leg:.3g} mm")
    if taught.payload is not None:
        found.append(f"{_span(taught.payload, 1.0)} kg")
    if taught.lower:
        ends = zip(taught.lower, taught.upper, strict=True)
        axes = (f"{math.degrees(a):.0f} to {math.degrees(b):.0f}" for a, b in ends)
        found.append(f"axes at {', '.join(axes)}°")
    return "; ".join(found)


_WORDS = {"MoveC": "arcs", "MoveJ": "joint moves", "MoveL": "lines"}


def _listed(words: list[str]) -> str:
    return " and ".join([", ".join(words[:-1]), words[-1]] if len(words) > 1 else words)


def _span(span: Span, scale: float) -> str:
    return f"{scale * span[0]:.3g} to {scale * span[1]:.4g}"


SPEED_SLACK, ZONE_SLACK, LEG_SLACK, PAYLOAD_SLACK = 0.02, 0.02, 0.05, 0.02
"""Shares by which a program may pass what was taught and count as within it."""
ANGLE_SLACK = math.radians(5)
"""rad (or m of a linear axis), likewise."""


def beyond(taught: TaughtRange, driven: TaughtRange) -> tuple[str, ...]:
    """What of a program's range was not taught, in words.

    The first axis counts for nothing: turned about it, an upright arm is driven alike; nor does
    the last, which turns the tool alone.
    """
    found = [
        f"{_WORDS[kind]}" for kind in driven.moves if taught.moves and kind not in taught.moves
    ]
    if driven.stops and taught.moves and not taught.stops:
        found.append("stops on the way")
    for name, what, scale, unit, slack in (
        ("speed", "", 1e3, "mm/s", SPEED_SLACK),
        ("zone", "zones of ", 1e3, "mm", ZONE_SLACK),
        ("payload", "", 1.0, "kg", PAYLOAD_SLACK),
    ):
        known, now = getattr(taught, name), getattr(driven, name)
        if known is None or now is None:
            continue
        ends = [
            *([now[0]] if now[0] < (1.0 - slack) * known[0] else []),
            *([now[1]] if now[1] > (1.0 + slack) * known[1] else []),
        ]
        if ends:
            told = " and ".join(f"{scale * end:.4g}" for end in dict.fromkeys(ends))
            found.append(f"{what}{told} {unit} ({_span(known, scale)})")
    least = taught.leg or 0.0
    if driven.leg is not None and driven.leg < (1.0 - LEG_SLACK) * least:
        found.append(f"legs of {1e3 * driven.leg:.3g} mm ({1e3 * least:.3g} and more)")
    axes = list(zip(taught.lower, taught.upper, driven.lower, driven.upper, strict=False))
    for number, (lower, upper, first, last) in enumerate(axes[1:-1], 2):
        ends = [
            *([first] if first < lower - ANGLE_SLACK else []),
            *([last] if last > upper + ANGLE_SLACK else []),
        ]
        if ends:
            told = " and ".join(f"{round(math.degrees(end))}" for end in ends)
            span = f"{math.degrees(lower):.0f} to {math.degrees(upper):.0f}"
            found.append(f"axis {number} at {told}° ({span})")
    return tuple(found)
