"""The arms that a vendor lists: one file with a line each, in JSON.

    {"name": "abb/irb4600-20-250", "model": "IRB 4600-20/2.50", "axes": 6, "payload_kg": 20,
     "reach_m": 2.5, "aliases": […], "check": {…}, "robot": {…}}

``robot`` has the keys of a catalogue file (`catalogue`); an arm that has a file of its own is
listed without it. ``check`` says where the flange is at some joint values, for tests. An arm that
cannot be modelled has ``refused``, the reason, in its place.
"""

from __future__ import annotations

import json
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from functools import cache, cached_property
from pathlib import Path
from typing import TYPE_CHECKING, Any

from ..files.reading import read_text
from ..files.tables import TomlTable

if TYPE_CHECKING:
    from .model import Robot


_LARGEST = 1 << 24
"""Bytes."""
_ROBOT = '"robot": {'


@dataclass(frozen=True, slots=True)
class Listed:
    """What a list says of an arm beside the arm itself.

    Args:
        name: ``vendor/model``, as it is known here.
        model: as its maker writes it.
        axes: how many; None for two-armed robots.
        payload: kg; None if not stated.
        reach: m, of the wrist; None if not stated.
        aliases: how controllers write it into their own files.
        refused: why it cannot be driven; None if it can.
    """

    name: str
    model: str
    axes: int | None = None
    payload: float | None = None
    reach: float | None = None
    aliases: tuple[str, ...] = ()
    refused: str | None = None


class ArmList:
    """A list of arms. A line is parsed when its arm is asked for.

    Args:
        file: with a line for each arm; none is a list of none.
    """

    def __init__(self, file: Path) -> None:
        self._file = file
        lines = read_text(file, _LARGEST).splitlines() if file.is_file() else []
        self._lines = {line.split('"', 4)[3].partition("/")[2]: line for line in lines}

    def listed(self) -> dict[str, Listed]:
        """All arms, by their name without the vendor's."""
        return dict(self._listed)

    @cached_property
    def _listed(self) -> dict[str, Listed]:
        return {name: _listed(json.loads(line)) for name, line in self._lines.items()}

    def robots(self) -> dict[str, Callable[[], Robot]]:
        """What loads each arm that stands in the list itself."""
        return {name: self._loader(name) for name, line in self._lines.items() if _ROBOT in line}

    def _loader(self, name: str) -> Callable[[], Robot]:
        @cache
        def load() -> Robot:
            from .catalogue import robot_of

            return robot_of(TomlTable(json.loads(self._lines[name])["robot"], self._file, name))

        return load


def _listed(row: Mapping[str, Any]) -> Listed:
    return Listed(
        row["name"],
        row["model"],
        row.get("axes"),
        row.get("payload_kg"),
        row.get("reach_m"),
        tuple(row.get("aliases", ())),
        row.get("refused"),
    )
