"""Speeds and approximations that KRL sets once and motions then depend on without naming them.

What ``BAS(…)`` sets, and from what, is said in `krl.basis`, which carries it out.
"""

from __future__ import annotations

import re
from collections.abc import Iterator

from ...core.dialect import Unsaid

_MOTION = re.compile(
    r"^[ \t]*(?P<motion>(?P<kind>S?(?:PTP|LIN|CIRC))(?:_REL)?\b[^\r\n]*)",
    re.IGNORECASE | re.MULTILINE,
)
_BAS = re.compile(r"\bBAS[ \t]*\([ \t]*#(?P<command>\w+)[^\r\n]*", re.IGNORECASE)
_WITH = re.compile(r"\bWITH\b.*", re.IGNORECASE)

_JOINT = ("$VEL_AXIS", "$ACC_AXIS")
_PATH = ("$VEL", "$ACC")
_WORDS = {
    "C_PTP": "$APO.CPTP",
    "C_DIS": "$APO.CDIS",
    "C_SPL": "$APO",
    "C_ORI": "$APO.CORI",
    "C_VEL": "$APO.CVEL",
}

_JOINT_DATA: tuple[tuple[str, str | None, bool], ...] = (
    ("$ACC_AXIS", "PDAT_ACT.ACC", True),
    ("$APO.CPTP", "PDAT_ACT.APO_DIST", True),
    # Only with APO_MODE #CDIS.
    ("$APO.CDIS", "PDAT_ACT.APO_DIST", False),
)
_PATH_DATA: tuple[tuple[str, str | None, bool], ...] = (
    ("$ACC", "LDAT_ACT.ACC", True),
    ("$APO.CDIS", "LDAT_ACT.APO_DIST", True),
)
_COMMANDS: dict[str, tuple[tuple[str, str | None, bool], ...]] = {
    "initmov": tuple((name, None, True) for name in (*_JOINT, *_PATH, "$APO")),
    "vel_ptp": (("$VEL_AXIS", None, True),),
    "acc_ptp": (("$ACC_AXIS", None, True),),
    "vel_cp": (("$VEL.CP", None, True),),
    "acc_cp": (("$ACC", None, True),),
    "ptp_dat": (("$VEL_AXIS", "PDAT_ACT.VEL", True), *_JOINT_DATA),
    "ptp_params": (("$VEL_AXIS", None, True), *_JOINT_DATA),
    "cp_dat": (("$VEL.CP", "LDAT_ACT.VEL", True), *_PATH_DATA),
    "cp_params": (("$VEL.CP", None, True), *_PATH_DATA),
}
"""What a command sets, from which datum (None for its own operand), and whether in any case."""


def unsaid(text: str) -> Iterator[Unsaid]:
    """What motions depend on and ``BAS`` sets, in a text without comments and strings."""
    for found in _MOTION.finditer(text):
        own = _WITH.search(found["motion"])
        stated = "" if own is None else own[0].upper()
        joint = found["kind"].upper().endswith("PTP")
        words = [name for word, name in _WORDS.items() if _has(found["motion"], word)]
        for name in (*(_JOINT if joint else _PATH), *words):
            if not _has(stated, name):
                yield Unsaid(name, *found.span("motion"))
    for found in _BAS.finditer(text):
        for name, source, certain in _COMMANDS.get(found["command"].lower(), ()):
            yield Unsaid(name, *found.span(), True, source, certain)


def _has(text: str, word: str) -> bool:
    return re.search(rf"(?<![\w$]){re.escape(word)}(?![\w$])", text, re.IGNORECASE) is not None
