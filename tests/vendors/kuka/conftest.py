"""Reading KRL in a line."""

from __future__ import annotations

from collections.abc import Callable

import pytest

from flyby.core.program.program import Program
from flyby.core.source.execution.answers import Answers
from flyby.core.source.reading import ReadOptions, read_with
from flyby.core.source.text.files import SourceFile
from flyby.vendors.kuka.run.reader import read_sources

ReadKrl = Callable[..., Program]


@pytest.fixture(scope="session")
def krl() -> ReadKrl:
    """``krl(body, data, …)``: the program of a ``DEF demo`` with this body and ``demo.dat``.

    ``files`` are further files by name, ``src`` a whole file instead of a body.
    """

    def read(
        body: str = "",
        data: str = "",
        *,
        src: str | None = None,
        files: dict[str, str] | None = None,
        robot: object = None,
        answers: Answers | None = None,
        entry: str | None = None,
        **limits: object,
    ) -> Program:
        main = src if src is not None else f"DEF demo( )\n{body}\nEND\n"
        texts = {"demo.src": main, **(files or {})}
        if data:
            texts["demo.dat"] = f"DEFDAT demo\n{data}\nENDDAT\n"
        sources = {name: SourceFile(name, text) for name, text in texts.items()}
        options = ReadOptions(entry, robot, answers or Answers(), **limits)  # type: ignore[arg-type]
        return read_with(sources, "demo.src", options, read_sources)

    return read
