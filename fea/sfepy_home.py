"""SfePy makes a folder in the user's home when it is imported, and fails where it cannot."""

from __future__ import annotations

import importlib
import os
import sys
import tempfile


def import_sfepy() -> None:
    """Import SfePy where the user has no home, or one that cannot be written.

    Its folder `~/.sfepy` is for its own programs; we use nothing in it. Where it is missing, a
    temporary home stands in during the import, so that none is made for the user either.

    Raises
    ------
    OSError
        There is no folder for temporary files either.
    """
    # as SfePy asks; Path.expanduser raises where there is no home
    folder = os.path.expanduser("~/.sfepy")  # noqa: PTH111
    if "sfepy" in sys.modules or os.access(folder, os.F_OK):
        return
    before = os.environ.get("HOME")
    with tempfile.TemporaryDirectory(prefix="strutwork-sfepy-") as home:
        os.environ["HOME"] = home
        try:
            importlib.import_module("sfepy")
        finally:
            if before is None:
                del os.environ["HOME"]
            else:
                os.environ["HOME"] = before
