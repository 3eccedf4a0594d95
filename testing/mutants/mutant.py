"""One planted fault, and who must find it."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

from ...core.vendor import Vendor
from ..checks.subject import Subject
from .biting import BITING


def _anywhere(_: Subject) -> bool:
    return True


@dataclass(frozen=True)
class Mutant:
    """A fault that an author may have made.

    Args:
        name: what is wrong.
        plant: the vendor with the fault.
        found_by: names of the checks that must each find it.
        needs: whether a suite's language has what the fault is about.
    """

    name: str
    plant: Callable[[Vendor], Vendor]
    found_by: tuple[str, ...]
    needs: Callable[[Subject], bool] = _anywhere

    @property
    def bites(self) -> str:
        """What an author writes down so that it shows."""
        return BITING.get(self.name, "a golden text that reads otherwise with it")

    def __str__(self) -> str:
        return self.name.replace(" ", "_")


def has(word: str) -> Callable[[Subject], bool]:
    """Whether a language has a word, of `flyby.testing.golden.LANGUAGE`, by its golden texts."""
    return lambda suite: word not in suite.golden_none


def speaks(suite: Subject) -> bool:
    """Whether a vendor has a dialect."""
    return suite.vendor.speaks is not None


def sets_outputs(suite: Subject) -> bool:
    """Whether its language sets outputs on the way of moves."""
    spoken = suite.vendor.speaks
    return spoken is not None and spoken.outputs is not None


def knows_signals(suite: Subject) -> bool:
    """Whether it says how signals are set."""
    return suite.signals is not None


def names_targets(suite: Subject) -> bool:
    """Whether its texts are searched, and its reader gives targets the names of their data."""
    if not is_searched(suite):
        return False
    programs = map(suite.read_golden, suite.golden_texts)
    return any(move.target.name for program in programs for move in program.moves)


def is_searched(suite: Subject) -> bool:
    """Whether its texts are searched."""
    return suite.vendor.speaks is not None and suite.vendor.speaks.wording is not None
