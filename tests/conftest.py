"""How tests run: Hypothesis without deadlines, since the first example compiles, and on CI always
with the same examples, so that a red run says something about the change; one worker a core (see
`pyproject.toml`), beside which threads of BLAS would only be in each other's way."""

from __future__ import annotations

import os

from hypothesis import settings

os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")  # numpy, not yet imported, reads it once

settings.register_profile("here", deadline=None)
settings.register_profile("ci", deadline=None, derandomize=True)
settings.load_profile("ci" if os.environ.get("CI") else "here")
