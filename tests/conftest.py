"""Settings of the whole test suite."""

from __future__ import annotations

import os

from hypothesis import settings

# the same examples at every run in CI; elsewhere new ones, which find more
settings.register_profile("ci", deadline=None, derandomize=True, print_blob=True, max_examples=50)
settings.register_profile("local", deadline=None, max_examples=50)
# what the nightly run asks for
settings.register_profile("thorough", deadline=None, print_blob=True)
settings.load_profile(
    os.environ.get("STRUTWORK_EXAMPLES") or ("ci" if os.environ.get("CI") else "local")
)
