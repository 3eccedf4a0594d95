"""The conformance suite: what every vendor plugin must fulfil.

An author subclasses it; pytest finds the inherited tests::

    from flyby.testing.conformance import VendorConformance

    class TestAcme(VendorConformance):
        name = "acme"

Each part of the suite is a class of its own in `flyby.testing.checks`.
"""

from __future__ import annotations

from .checks.catalogue import CatalogueChecks
from .checks.emulation import EmulationChecks
from .checks.golden import GoldenChecks
from .checks.hostility import HostilityChecks
from .checks.language import LanguageChecks
from .checks.lines import LineChecks
from .checks.motion_model import MotionModelChecks
from .checks.patching import PatchingChecks
from .checks.planted import PlantedFaults
from .checks.recording import RecordingChecks
from .checks.sources import SourceChecks
from .checks.translation import TranslationChecks
from .checks.words import WordsChecks


class VendorConformance(
    CatalogueChecks,
    MotionModelChecks,
    GoldenChecks,
    LineChecks,
    WordsChecks,
    LanguageChecks,
    HostilityChecks,
    SourceChecks,
    PatchingChecks,
    RecordingChecks,
    EmulationChecks,
    TranslationChecks,
    PlantedFaults,
):
    """All checks; ``name`` is the vendor's."""
