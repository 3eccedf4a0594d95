"""The list of planted faults; that each is found, every vendor's suite tests by itself."""

from __future__ import annotations

import pytest

from flyby.testing.conformance import VendorConformance
from flyby.testing.mutants import MUTANTS, Mutant
from flyby.testing.mutants.biting import BITING

from ..vendors.words import AbbWords, KukaWords, UrWords


class Abb(AbbWords, VendorConformance):
    """pytest collects it by no name of tests."""


class Kuka(KukaWords, VendorConformance):
    """Likewise."""


class Ur(UrWords, VendorConformance):
    """Likewise."""


SUITES = (Abb, Kuka, Ur)


def test_there_are_many_and_each_has_a_name() -> None:
    assert len({mutant.name for mutant in MUTANTS}) == len(MUTANTS) >= 60


@pytest.mark.parametrize("mutant", MUTANTS, ids=str)
def test_each_is_about_a_built_in_vendor_and_changes_it(mutant: Mutant) -> None:
    concerned = [suite() for suite in SUITES if mutant.needs(suite())]
    assert concerned, "no built-in vendor shows that this is found"
    for suite in concerned:
        assert mutant.found_by and all(hasattr(suite, check) for check in mutant.found_by)
        assert mutant.plant(suite.vendor) is not suite.vendor


def test_most_faults_concern_every_vendor() -> None:
    for suite in SUITES:
        assert sum(mutant.needs(suite()) for mutant in MUTANTS) >= 50, suite


def test_each_says_what_would_show_it() -> None:
    assert set(BITING) == {mutant.name for mutant in MUTANTS}


def test_a_fault_that_nobody_finds_is_reported() -> None:
    harmless = Mutant("waits in ms", lambda vendor: vendor, MUTANTS[0].found_by)
    with pytest.raises(AssertionError, match=r"\(waits in ms\).*\n.*what would: a wait for a time"):
        Ur().test_a_planted_fault_is_found(harmless)


def test_a_failure_says_what_was_stated_what_was_read_and_where_to_look() -> None:
    mutant = next(one for one in MUTANTS if one.name == "zones 100 times as large")
    suite = Abb()
    suite.__dict__["vendor"] = mutant.plant(suite.vendor)
    with pytest.raises(AssertionError) as caught:
        suite.test_golden_texts_mean_what_their_author_says()
    message = str(caught.value)
    for words in (
        "statement 1, MoveJ",
        "zone.tcp: 0.01 stated, 1 read",
        "tray.mod:18: MoveAbsJ home, v1000, z10, tool0;",
        "look at: kinds of zone, their unit",
    ):
        assert words in message
