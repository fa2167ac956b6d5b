"""What several tests read, made before the run on both cores beside the checks.

`python -m tests.beforehand compiled` writes the reports whose computation compiles most functions:
both workers run these, and each alone would compile all of them.
`python -m tests.beforehand others` makes what needs few of them.
"""

from __future__ import annotations

import os
import sys
from collections.abc import Callable
from pathlib import Path
from typing import Any
from unittest.mock import patch

from strutwork.papers.azulay_2014 import comparison_page
from tests.docs.building import built_site
from tests.reports.shared import shared_report
from tests.sharing import FOLDER, once


def _kept(name: str, folder: Path, make: Callable[..., Any]) -> Callable[..., Any]:
    """As `make`, and what it made first is there for the tests."""

    def kept(*arguments: Any) -> Any:
        made = make(*arguments)
        once(name, folder, lambda: made)
        return made

    return kept


def compiled(folder: Path) -> None:
    """The reports on a paper and on a machine."""
    studied = _kept("azulay-comparison", folder, comparison_page.study_comparison)
    stated = _kept("azulay-statements", folder, comparison_page.statements)
    with (
        patch.object(comparison_page, "study_comparison", studied),
        patch.object(comparison_page, "statements", stated),
    ):
        shared_report("comparison", "azulay-2014", folder)
    shared_report("planar", "mit-ss1", folder)


def others(folder: Path) -> None:
    """The site, and the report on the machine that most pages are tested with."""
    built_site(folder)
    shared_report("machine", "proposed-3pprs", folder)


if __name__ == "__main__":
    {"compiled": compiled, "others": others}[sys.argv[1]](Path(os.environ[FOLDER]))
