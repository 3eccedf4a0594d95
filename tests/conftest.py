"""How tests run.

Hypothesis tries the same examples on every machine and in every run, so that a red run says
something about the change: seeds follow from the tests, nothing is remembered from one run to the
next, no clock counts (deadlines, slow examples: the first one compiles). Beside seeds, Hypothesis
draws numbers that it finds in the modules that happen to be imported, and with several workers that
is chance; so it does not do that here. `pytest --hypothesis-profile=explore` has fresh seeds, more
numbers and a memory of what failed.

One worker a core (see `pyproject.toml`), beside which threads of BLAS would only be in each other's
way. Python looks for garbage as seldom as the command line has it: thousands of collected tests are
none, and to walk through them is a tenth of a run.
"""

from __future__ import annotations

import gc
import os

import pytest
from hypothesis import HealthCheck, settings
from hypothesis.database import DirectoryBasedExampleDatabase
from hypothesis.internal.conjecture import providers

gc.set_threshold(100_000, 20, 20)
os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")  # numpy, not yet imported, reads it once

ORDINARY, EXPLORE = "ordinary", "explore"

settings.register_profile(
    ORDINARY,
    deadline=None,
    derandomize=True,
    database=None,
    suppress_health_check=[HealthCheck.too_slow],
)
# Said outright: where the environment sets CI, Hypothesis's own profile has no fresh seeds either.
settings.register_profile(
    EXPLORE,
    deadline=None,
    derandomize=False,
    database=DirectoryBasedExampleDatabase(".hypothesis/examples"),
    suppress_health_check=[HealthCheck.too_slow],
)
settings.load_profile(ORDINARY)


def pytest_configure(config: pytest.Config) -> None:
    if config.getoption("--hypothesis-profile") != EXPLORE:
        none = providers.Constants()
        providers._get_local_constants = lambda: none  # type: ignore[attr-defined]
