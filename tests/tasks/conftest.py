"""Small programs to give to tasks."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import pytest

UNUSED = "[9E9,9E9,9E9,9E9,9E9,9E9]"
MODULE = """MODULE Small
  CONST jointtarget home := [[0,0,0,0,90,0],{unused}];
  CONST robtarget p1 := [[1300,100,900],[0,0,1,0],[0,0,0,0],{unused}];
  PROC main()
    MoveJ p1, v1000, fine, tool0;
{moves}
  ENDPROC
ENDMODULE
"""


@pytest.fixture
def small(tmp_path: Path) -> Callable[..., Path]:
    """Writes a RAPID program that begins at p1 and goes on with the lines given."""

    def write(*moves: str) -> Path:
        path = tmp_path / "small.mod"
        text = "\n".join(f"    {move};" for move in moves)
        path.write_text(MODULE.format(unused=UNUSED, moves=text), "ascii")
        return path

    return write
