"""The folder of logged runs, if there is one on this machine."""

from __future__ import annotations

import os
from pathlib import Path

import pytest


@pytest.fixture(scope="session")
def logs() -> Path:
    """The folder that FLYBY_LOGS names; the runs are their publishers', so none comes along."""
    folder = os.environ.get("FLYBY_LOGS")
    if folder is None:
        pytest.skip("no logged runs here: set FLYBY_LOGS to the folder that holds them")
    return Path(folder)


def runs(logs: Path, pattern: str) -> list[Path]:
    """The records of this pattern; there are some."""
    found = sorted(logs.glob(pattern))
    assert found, f"{logs} holds no {pattern}"
    return found
