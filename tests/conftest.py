"""How Hypothesis runs here: without deadlines, since the first example compiles; on CI always the
same examples, so that a red run says something about the change."""

from __future__ import annotations

import os

from hypothesis import settings

settings.register_profile("here", deadline=None)
settings.register_profile("ci", deadline=None, derandomize=True)
settings.load_profile("ci" if os.environ.get("CI") else "here")
