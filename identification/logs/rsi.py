"""The XML that KUKA's robot sensor interface (RSI) sends, one frame after the other.

    <Rob Type="KUKA"><AIPos A1="0.0" … A6="0.0"/><EIPos E1="0.0" …/><IPOC>123456</IPOC></Rob>

``AIPos`` and ``EIPos`` are the measured axes in degrees and mm, ``IPOC`` is a time in ms.
"""

from __future__ import annotations

import math
import re

import numpy as np

from ...core.errors import InputError
from ...core.robot.model import Robot
from .formats import axis_scales
from .samples import LogSamples, in_order

END = "</Rob>"
_IPOC = re.compile(r"<IPOC>\s*(\d{1,18})\s*</IPOC>")
_TAGS = {name: re.compile(rf"<{name}\s([^<>]*)>") for name in ("AIPos", "EIPos")}
_VALUE = re.compile(r"""\b([AE]\d)\s*=\s*["']([^"']*)["']""")


def is_rsi(text: str) -> bool:
    """Whether a text holds frames of RSI."""
    return END in text and "<Rob" in text


def parse_rsi(text: str, file: str, robot: Robot) -> LogSamples:
    """The samples in the frames of a text; what stands between them is passed over.

    Raises:
        InputError: naming the line of a frame without time or axes.
    """
    wanted = [("AIPos", f"A{k}") for k in range(1, robot.arm_size + 1)]
    wanted += [("EIPos", f"E{k}") for k in range(1, len(robot.external_axes) + 1)]
    stamps, rows, lines = [], [], []
    line = 1
    # A last frame without an end was cut off.
    for chunk in text.split(END)[:-1]:
        begin = chunk.rfind("<Rob")
        where = line + chunk.count("\n", 0, max(begin, 0))
        line += chunk.count("\n")
        if begin < 0:
            raise InputError(f"{file}:{where}: {END} without a beginning")
        stamp, row = _frame(chunk[begin:], wanted, f"{file}:{where}")
        stamps.append(stamp)
        rows.append(row)
        lines.append(where)
    t = 1e-3 * np.array([stamp - stamps[0] for stamp in stamps], dtype=float)
    q = np.array(rows, dtype=float).reshape(len(rows), len(wanted)) * np.array(axis_scales(robot))
    return in_order(t, q, np.array(lines, dtype=np.int64), file)


def _frame(frame: str, wanted: list[tuple[str, str]], where: str) -> tuple[int, list[float]]:
    stamp = _IPOC.search(frame)
    if stamp is None:
        raise InputError(f"{where}: a frame without <IPOC>")
    values: dict[tuple[str, str], str] = {}
    for tag, pattern in _TAGS.items():
        found = pattern.search(frame)
        if found is not None:
            values.update({(tag, name): value for name, value in _VALUE.findall(found[1])})
    return int(stamp[1]), [_number(values, key, where) for key in wanted]


def _number(values: dict[tuple[str, str], str], key: tuple[str, str], where: str) -> float:
    tag, name = key
    if key not in values:
        raise InputError(f"{where}: a frame without {name} in <{tag}>: send {tag} in the RSI file")
    try:
        value = float(values[key])
    except ValueError:
        value = math.nan
    if not math.isfinite(value):
        raise InputError(f"{where}: {name} of <{tag}> is {values[key][:40]!r}, no finite number")
    return value
