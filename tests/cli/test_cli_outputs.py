"""Outputs of all commands are refused before any file is read, let alone any work begun."""

from __future__ import annotations

import os
from collections.abc import Callable, Iterator
from pathlib import Path

import pytest
from typer.main import get_command
from typer.testing import Result

from flyby.cli.main import app
from flyby.tasks.files import outputs

Flyby = Callable[..., Result]
SUFFIXES = {
    **{"--csv": ".csv", "--npz": ".npz", "--plot": ".png", "--report": ".html"},
    **{"--write": ".mod", "--out": ""},
}
FILES = {("ask", "--out"): ".toml", ("identify", "--out"): ".toml"}
"""Outputs that are files where the option is a folder elsewhere."""
GIVEN = {
    "translate": ["--robot", "ur/ur5e"],
    "experiment": ["--robot", "ur/ur5e"],
    "cspace": ["--axes", "2,3"],
    "free": ["--start", "0,0,0,0,0,0", "--goal", "0,0,0,0,0,1"],
    "paint": ["--footprint", "nothing.toml", "--target", "50um"],
}
"""What else must be given."""


def cases() -> Iterator[tuple[str, str]]:
    for name, command in get_command(app).commands.items():  # type: ignore[attr-defined]
        for parameter in command.params:
            if parameter.opts[0] in SUFFIXES:
                yield name, parameter.opts[0]


@pytest.mark.parametrize(("command", "option"), [*cases()])
def test_a_place_that_takes_no_files_is_refused_first(
    flyby: Flyby, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, command: str, option: str
) -> None:
    def read_only(folder: Path) -> None:
        raise OSError(30, os.strerror(30))

    monkeypatch.setattr(outputs, "_try", read_only)
    suffix = FILES.get((command, option), SUFFIXES[option])
    target = tmp_path / f"result{suffix}"
    known = get_command(app).commands[command]  # type: ignore[attr-defined]
    arguments = [p for p in known.params if p.param_type_name == "argument"]
    words = ["nothing.mod", *GIVEN.get(command, ())] if arguments else GIVEN.get(command, [])
    if command == "diff":
        words = ["nothing.mod", "less.mod"]
    required = [p.opts[0] for p in known.params if p.required and p.opts[0] in SUFFIXES]
    others = [word for o in required if o != option for word in (o, f"{tmp_path}/x{SUFFIXES[o]}")]
    result = flyby(command, *words, *others, option, target)
    assert result.exit_code in (1, 2), result.output
    said = " ".join(result.stderr.split())
    assert "cannot be written: Read-only file system" in said, said
    assert "nothing.mod" not in said


def test_nothing_is_left_where_a_place_was_tried(tmp_path: Path) -> None:
    outputs.check_folder("--out", tmp_path / "a" / "b")
    outputs.check_outputs({"--csv": tmp_path / "a.csv"}, [], replace_existing=False)
    assert not list(tmp_path.iterdir())


@pytest.mark.skipif(not Path("/proc/self").exists(), reason="a folder that takes no files")
def test_a_real_folder_that_takes_no_files_is_refused(flyby: Flyby) -> None:
    result = flyby("optimize", "nothing.mod", "--out", "/proc/flyby/x")
    assert result.exit_code == 1 and "--out /proc/flyby/x: cannot be written" in result.stderr
