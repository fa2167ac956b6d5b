"""Where results are kept for later runs, and the note where that cannot be."""

from __future__ import annotations

import os
import tempfile
import warnings
from pathlib import Path

from strutwork.errors import CacheWarning

_noted: set[str] = set()


def user_cache() -> Path | None:
    """`$XDG_CACHE_HOME/strutwork`, else `~/.cache/strutwork`; None where the user has no home.

    A relative `$XDG_CACHE_HOME` is ignored, as the XDG base directory specification asks.
    """
    base = Path(os.environ.get("XDG_CACHE_HOME", ""))
    if not base.is_absolute():
        try:
            base = Path.home() / ".cache"
        except RuntimeError:
            return None
    return base / "strutwork" if base.is_absolute() else None


def takes_files(folder: Path) -> bool:
    """Whether files can be made in a folder, which is made when missing.

    Parameters
    ----------
    folder : Path
        Made with its parents when missing, and left there.
    """
    try:
        folder.mkdir(parents=True, exist_ok=True)
        with tempfile.TemporaryFile(dir=folder):
            return True
    except OSError:
        return False


def note_once(subject: str, message: str) -> None:
    """Warn with a `CacheWarning`, the first time in this process that `subject` comes up.

    Parameters
    ----------
    subject : str
        What the note is about; the key of "once".
    message : str
        The text of the warning.
    """
    if subject not in _noted:
        _noted.add(subject)
        warnings.warn(message, CacheWarning, stacklevel=3)


def reason(error: Exception) -> str:
    """What an operating system's error says, without number and path.

    Parameters
    ----------
    error : Exception
        Of the system (`OSError.strerror`), or any other.
    """
    return getattr(error, "strerror", None) or str(error) or type(error).__name__
