"""Stations of small robots that drive between a few places, written as files."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import Protocol

HOMES = ("[0,0,0,0,30,0]", "[20,0,0,0,30,0]", "[-20,0,0,0,30,0]")
UNUSED = "[9E9,9E9,9E9,9E9,9E9,9E9]"


class Write(Protocol):
    """Writes a station of robots in a row, every other one turned round."""

    def __call__(
        self,
        programs: dict[str, Sequence[str]],
        rest: str = "",
        gap: float = 9000.0,
        before: str = "",
    ) -> Path:
        """Programs by robot, in statements; the rest of the station file; mm between bases."""
        ...


def module(name: str, statements: Sequence[str]) -> str:
    """A RAPID module; ``go K`` in place of an instruction drives to the K-th home."""
    lines = [
        f"MoveAbsJ [{HOMES[int(s.split()[1])]},{UNUSED}], v1000, fine, tool0;"
        if s.startswith("go ")
        else f"{s};"
        for s in statements
    ]
    body = "\n    ".join(lines)
    return (
        f"MODULE {name}\n  VAR syncident s1;\n  VAR syncident s2;\n"
        '  PERS tasks all{2} := [["T1"],["T2"]];\n'
        f"  PROC main()\n    {body}\n  ENDPROC\nENDMODULE\n"
    )
