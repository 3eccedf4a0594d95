"""Writes that break off; as a script, ones that are killed at each of their steps in turn.

    python killed.py write|recover FOLDER

leaves a folder for each step, by its number; the last one's writer came to its end.
"""

from __future__ import annotations

import itertools
import os
import signal
import sys
from collections.abc import Callable
from pathlib import Path
from typing import Any

from flyby.core.files.recovery import recover
from flyby.core.files.writing import write_files

STEPS = (
    "open", "mkdir", "replace", "rename", "fsync", "unlink", "chmod", "chown", "stat", "lstat",
)  # fmt: skip
"""Functions of `os` in which a write can break off; `open` is that of folders."""
OLD = {"a/p.dat": b"old dat", "a/p.src": b"old src", "b/q.src": b"old q"}
NEW = {"a/p.dat": b"new dat", "a/p.src": b"new src", "b/q.src": b"new q", "c/d/r.src": b"new r"}


def lay(folder: Path) -> None:
    for name, data in OLD.items():
        (folder / name).parent.mkdir(exist_ok=True, parents=True)
        (folder / name).write_bytes(data)


def wanted(folder: Path) -> dict[Path, bytes]:
    return {folder / name: data for name, data in NEW.items()}


def breaking(step: int, how: Callable[[], None], done: Callable[[], bool] = lambda: False) -> Any:
    """Functions of `os` that break off at a step of all their calls."""
    count = itertools.count()

    def broken(function: Callable[..., Any]) -> Callable[..., Any]:
        def call(*args: Any, **kwargs: Any) -> Any:
            if not done() and next(count) == step:
                how()
            return function(*args, **kwargs)

        return call

    calls = {name: broken(getattr(os, name)) for name in STEPS}
    calls["fsync"] = broken(lambda descriptor: None)  # a killed process loses nothing written
    return calls, count


def die() -> None:
    os.kill(os.getpid(), signal.SIGKILL)


def in_a_child(change: dict[str, Any], work: Callable[[], object]) -> bool:
    """Whether a process that does ``work``, with functions of `os` changed, comes to its end."""
    child = os.fork()
    if child == 0:
        code = 1
        try:
            for name, function in change.items():
                setattr(os, name, function)
            work()
            code = 0
        finally:
            os._exit(code)
    status = os.waitpid(child, 0)[1]
    assert not os.WIFEXITED(status) or os.WEXITSTATUS(status) == 0, "it failed"
    return os.WIFEXITED(status)


def interrupt(folder: Path) -> None:
    """A set killed between its old files' going and its new ones' coming."""
    renames, rename = itertools.count(), os.rename

    def killing(*args: Any) -> None:
        if next(renames) == len(OLD) + 1:
            die()
        rename(*args)

    change = {"rename": killing, "fsync": lambda descriptor: None}
    in_a_child(change, lambda: write_files(wanted(folder), folder))


def main(what: str, root: Path) -> None:
    for step in itertools.count():
        folder = root / str(step)
        lay(folder)
        if what == "recover":
            interrupt(folder)
            ended = in_a_child(breaking(step, die)[0], lambda at=folder / "b": recover(at))
        else:
            ended = in_a_child(
                breaking(step, die)[0], lambda at=folder: write_files(wanted(at), at)
            )
        if ended:
            return


if __name__ == "__main__":
    main(sys.argv[1], Path(sys.argv[2]))
