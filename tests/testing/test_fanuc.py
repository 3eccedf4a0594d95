"""The FANUC distribution under ``examples`` passes its own tests without being installed."""

from __future__ import annotations

import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parent))
import uninstalled

globals().update(uninstalled.own_tests("fanuc"))


def test_it_is_found_and_nothing_is_broken() -> None:
    registry = uninstalled.registry_of("fanuc")
    assert registry.broken == ()
    assert len(registry.robot_names) == 4
    assert registry.reader_of("x.LS").name == "fanuc"
