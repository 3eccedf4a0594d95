"""The vendor that a language and a folder of data make."""

from __future__ import annotations

from pathlib import Path
from typing import Any

from ..language import Recorder
from ..vendor import Vendor, lazy_motion, lazy_robots


def speaking(language: Any, name: str, data: Path, **others: Any) -> Vendor:
    """The vendor of a language that reads, writes and patches, and maybe records.

    Args:
        language: with its ``suffix`` and ``dialect`` (`core.source.lines.language`).
        name: of the vendor.
        data: folder of ``motion.toml`` and ``robots/*.toml``.
        others: see `Vendor`; without ``label`` there are none.
    """
    parts = {
        "robots": lazy_robots(data.glob("robots/*.toml")),
        "motion": lazy_motion(data / "motion.toml"),
        "label": lambda robot, q: None,
        "recorder": language if isinstance(language, Recorder) else None,
        "suffixes": (language.suffix,),
        "speaks": language.dialect,
    }
    own = dict.fromkeys(("reader", "writer", "patcher"), language)
    return Vendor(name, **{**parts, **own, **others})
