"""Both states of a file as git hands them to an external diff: each without the files beside it."""

from __future__ import annotations

import shutil
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from tempfile import TemporaryDirectory

_MOST, _LARGEST = 500, 5_000_000
"""Files beside it, and bytes of one, that are looked at."""


@contextmanager
def beside_others(name: str | Path, old: str | Path, new: str | Path) -> Iterator[list[Path]]:
    """Both states, each in a folder of its own with what lies beside the file now.

    Git has one state, or both, in a temporary folder alone: a ``.src`` without its ``.dat``, a
    ``.urp`` without its installation, a module without the others.

    Args:
        name: of the file in its working tree.
        old, new: its states.
    """
    place = Path(name)
    others = [one for one in _files(place.parent) if one.name != place.name]
    with TemporaryDirectory(prefix="flyby-") as folder:
        made = []
        for side, state in (("before", old), ("after", new)):
            own = Path(folder) / side
            own.mkdir()
            for one in others:
                shutil.copyfile(one, own / one.name)
            shutil.copyfile(state, own / place.name)
            made.append(own / place.name)
        yield made


def _files(folder: Path) -> list[Path]:
    if not folder.is_dir():
        return []
    found = (one for one in sorted(folder.iterdir()) if one.is_file() and not one.is_symlink())
    return [one for one in found if one.stat().st_size <= _LARGEST][:_MOST]
