"""What an answer to a datum of a type looks like."""

from __future__ import annotations

from ....core.program.question import Answer
from ....core.source.execution.answers import Fields

_FRAME = dict.fromkeys("XYZABC", 0.0)
_AXES: dict[str, Answer] = {"A1": 0.0, "A2": -90.0, "A3": 90.0, "A4": 0.0, "A5": 0.0, "A6": 0.0}
_FDAT: dict[str, Answer] = {"TOOL_NO": 1.0, "BASE_NO": 0.0, "IPO_FRAME": "#BASE"}
_PDAT: dict[str, Answer] = {"VEL": 100.0, "ACC": 100.0, "APO_DIST": 100.0}
_STATUS: dict[str, Answer] = {"MSG_NO": 0.0, "READ": 1.0, "BUFF": 0.0, "CONNECTED": True}
EXPECTED: dict[str, tuple[str, Answer]] = {
    "bool": ("true or false", False),
    "int": ("whole number", 0.0),
    "real": ("number", 0.0),
    "char": ("text", ""),
    **dict.fromkeys(("frame", "pos", "e6pos"), ("position", Fields(_FRAME.items()))),
    **dict.fromkeys(("axis", "e6axis"), ("axis values", Fields(_AXES.items()))),
    "index": ("whole number, from 1", 1.0),
    "target": ("position, or axis values A1 to A6", Fields(_FRAME.items())),
    "fdat": ("tool and base of a motion (FDAT)", Fields(_FDAT.items())),
    "pdat": ("%, and mm or % of approximation (PDAT)", Fields(_PDAT.items())),
    "ldat": ("m/s, %, and mm of approximation (LDAT)", Fields({**_PDAT, "VEL": 2.0}.items())),
    "load": ("kg at the flange (LOAD)", Fields({"M": 1.0}.items())),
    "eki_status": ("what EthernetKRL says of a call (EKI_STATUS)", Fields(_STATUS.items())),
    "ipo_m_t": ("#BASE or #TCP", "#BASE"),
}
"""Types of KRL as an answer's, in words and by an example."""
AXIS_NAMES = tuple(_AXES)
"""Of the arm."""
