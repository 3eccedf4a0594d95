"""The Yaskawa distribution under ``examples`` passes its own tests without being installed."""

from __future__ import annotations

import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parent))
import uninstalled

globals().update(uninstalled.own_tests("yaskawa"))


def test_it_is_found_and_nothing_is_broken() -> None:
    registry = uninstalled.registry_of("yaskawa")
    assert registry.broken == ()
    assert registry.robot_names == ("yaskawa/gp25", "yaskawa/gp8")
