"""What an inline form shows and remembers, kept in step with the statements in it.

The first line shows the motion (``PTP P1 CONT Vel=100 % PDAT1 …``) and, in older versions, lists
its parameters by number (``%P 1:PTP, 2:P1, 3:C_PTP, 5:100, 7:PDAT1``); newer ones name them in a
comment of their own (``;Params … Kuka.BlendingEnabled=True; … Kuka.VelocityPtp=100; …``). Seen in
published programs of KSS 5 to 8.
"""

from __future__ import annotations

import re
from collections.abc import Iterator

from ....core.errors import Span
from .places import Form, Places

_VELOCITY = (
    re.compile(r"(?i)\bVel=[ \t]*(?P<value>[\d.]+)"),
    re.compile(r"(?i)%P[ \t](?=[^\r\n]*1:S?(?:PTP|LIN))[^\r\n]*?\b5:(?P<value>[\d.]+)"),
    re.compile(r"(?i)%P[ \t](?=[^\r\n]*1:S?CIRC)[^\r\n]*?\b6:(?P<value>[\d.]+)"),
    re.compile(r"(?i)\bKuka\.Velocity(?:Ptp|Path)=(?P<value>[\d.]+)"),
)
_LISTED = (
    re.compile(r"(?i)%P[ \t](?=[^\r\n]*1:S?(?:PTP|LIN))[^\r\n]*?\b3:(?P<value>[^,\r\n]*)"),
    re.compile(r"(?i)%P[ \t](?=[^\r\n]*1:S?CIRC)[^\r\n]*?\b4:(?P<value>[^,\r\n]*)"),
)
_BLENDING = re.compile(r"(?i)\bKuka\.BlendingEnabled=(?P<value>\w+)")
_SHOWN = re.compile(r"(?i)(?P<value>[ \t]+CONT)\b(?=[^;\r\n]*\bVel=)")
_BEFORE_VELOCITY = re.compile(r"(?i)(?P<value>[ \t]+)Vel=")

Change = tuple[Span, str]


def shown_velocity(places: Places, form: Form, text: str) -> Iterator[Change]:
    """The places that repeat the velocity of a form."""
    for pattern in _VELOCITY:
        yield from _replaced(places, form, pattern, text)


def shown_approximation(places: Places, form: Form, words: str) -> Iterator[Change]:
    """The places that say whether a form's point is passed.

    Args:
        words: of the approximation, as ``C_PTP``; empty for a stop.
    """
    if words:
        yield from _replaced(places, form, _BEFORE_VELOCITY, " CONT ")
    else:
        yield from _replaced(places, form, _SHOWN, "")
    for pattern in _LISTED:
        yield from _replaced(places, form, pattern, words)
    yield from _replaced(places, form, _BLENDING, str(bool(words)))


def words_of(places: Places, form: Form, motion: str) -> str:
    """What the teach pendant writes behind an approximated motion of a form.

    Args:
        motion: the motion's keyword.
    """
    text = places.text(form.span).lower()
    newer = "ilfprovider" in text or "%r 8." in text
    kind = motion.lower()
    if kind.startswith("s"):
        return "C_SPL"
    if kind == "ptp":
        return "C_DIS" if newer else "C_PTP"
    return "C_DIS C_DIS" if newer else "C_DIS"


def _replaced(places: Places, form: Form, pattern: re.Pattern[str], text: str) -> Iterator[Change]:
    found = pattern.search(places.text(form.span))
    if found is not None:
        start, end = found.span("value")
        offset = form.span.start
        yield places.span(form.span.file, offset + start, offset + end), text
