"""The FANUC distribution under ``examples`` passes its own tests without being installed."""

from __future__ import annotations

import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parent))
import uninstalled

FANUC = uninstalled.vendor_of("fanuc", "fanuc")
_CONFORMANCE = uninstalled.tests_of("fanuc", "test_conformance")


class TestFanucConformance(_CONFORMANCE.TestFanuc):  # type: ignore[misc]
    vendor = FANUC
