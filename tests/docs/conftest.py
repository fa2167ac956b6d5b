"""The site of the documentation, built once for all processes of a test run, and a browser."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import pytest

from tests.docs.building import built_site
from tests.reports.browser import Browser, chromium
from tests.sharing import folder_of


@pytest.fixture(scope="session")
def site(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Folder of the built site."""
    folder, status, said = built_site(folder_of(tmp_path_factory.getbasetemp()))
    assert (status, said) == (0, ""), said
    return folder


@pytest.fixture(scope="session")
def browser() -> Iterator[Browser]:
    with chromium() as opened:
        yield opened
