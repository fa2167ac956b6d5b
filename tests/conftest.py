"""Settings of the whole test suite."""

from __future__ import annotations

import os

from hypothesis import settings

# the same examples at every run in CI; elsewhere new ones, which find more
settings.register_profile("ci", deadline=None, derandomize=True, print_blob=True)
settings.register_profile("local", deadline=None)
settings.load_profile("ci" if os.environ.get("CI") else "local")
