"""What the viewer makes of packed data, in Python."""

from __future__ import annotations

import base64
import json
import re
import zlib
from typing import Any

import numpy as np


def column(data: bytes, made: dict[str, Any]) -> np.ndarray[Any, Any]:
    n = made["n"]
    planes = [
        np.frombuffer(data, np.uint8, n, made["at"] + plane * n).astype(np.int64) << (8 * plane)
        for plane in range(made["w"])
    ]
    stored = sum(planes, np.zeros(n, dtype=np.int64))
    steps = np.where(stored % 2, -(stored + 1) // 2, stored // 2)
    for _ in range(made["d"]):
        steps = np.cumsum(steps)
    values = steps * made["s"] + made.get("o", 0.0)
    for first, stop in made.get("gaps", []):
        values[first:stop] = np.nan
    return np.asarray(values)


def columns(data: bytes, made: dict[str, Any]) -> np.ndarray[Any, Any]:
    if "columns" in made:
        return np.stack([column(data, one) for one in made["columns"]], axis=1)
    return column(data, made)


def content_of(page: bytes) -> tuple[dict[str, Any], bytes]:
    """The JSON of a page, and its arrays."""
    text = page.decode()
    told = re.search(r'<script type="application/json" id="page">(.*?)</script>', text, re.S)
    packed = re.search(r'<script type="text/plain" id="arrays">(.*?)</script>', text, re.S)
    assert told and packed
    return json.loads(told[1]), zlib.decompress(base64.b64decode(packed[1]))
