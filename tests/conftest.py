"""Settings of the whole test suite."""

from __future__ import annotations

import gc
import os
from collections.abc import Generator

import pytest
from hypothesis import settings


@pytest.hookimpl(wrapper=True, tryfirst=True)
def pytest_collection() -> Generator[None, object, object]:
    """Look for no garbage while tests are read, nor among what was read while they run.

    It is some 600 000 objects that stay; the searches among them took a quarter of the time.
    """
    gc.disable()
    try:
        return (yield)
    finally:
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
