"""Settings of the whole test suite."""

from __future__ import annotations

import gc
import os

from hypothesis import settings

# reading the tests makes some 600 000 objects that stay: looking for garbage among them again and
# again takes a quarter of the time
gc.disable()


def pytest_collection_finish() -> None:
    """What was read is garbage of no test, and is left out of each search for garbage."""
    gc.freeze()
    gc.enable()


# the same examples at every run in CI; elsewhere new ones, which find more
settings.register_profile("ci", deadline=None, derandomize=True, print_blob=True, max_examples=50)
settings.register_profile("local", deadline=None, max_examples=50)
# what the nightly run asks for
settings.register_profile("thorough", deadline=None, print_blob=True)
settings.load_profile(
    os.environ.get("STRUTWORK_EXAMPLES") or ("ci" if os.environ.get("CI") else "local")
)
