"""The data of a report as one zip file, and as much of it as the page itself carries."""

from __future__ import annotations

import base64
import zipfile
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path

#: Name of the file beside the page that holds all others.
ARCHIVE = "data.zip"

#: How much compressed data a page carries, bytes. Plotly alone takes 4.5 MB of each page.
CARRIED = 8_000_000

#: A time that is the same for every file: equal data make equal archives.
_EPOCH = (1980, 1, 1, 0, 0, 0)

#: Of a local header in a zip file before name and extra field, bytes (APPNOTE 6.3, 4.3.7).
_HEADER = 30


@dataclass(frozen=True)
class Carried:
    """The data that a page carries, so that it may be mailed alone.

    Parameters
    ----------
    names : mapping of str to (int, int)
        Start and length in `content` of each file's raw deflate stream. The archive itself is
        among them, uncompressed, as (0, length), where it is carried complete.
    content : str
        Bytes of a zip file, in base 64.
    left : frozenset of str
        Files that only stand beside the page.
    """

    names: Mapping[str, tuple[int, int]] = field(default_factory=dict)
    content: str = field(default="", repr=False)
    left: frozenset[str] = frozenset()


def write_archive(path: Path, files: Iterable[Path]) -> Path:
    """Write files into a zip file; equal files make an equal one.

    Parameters
    ----------
    path : Path
    files : iterable of Path
        Of different names, under which they stand in the zip file.

    Raises
    ------
    OSError
        A file that cannot be read or written.
    """
    with zipfile.ZipFile(path, "w", zipfile.ZIP_DEFLATED) as archive:
        for file in sorted(files, key=lambda one: one.name):
            entry = zipfile.ZipInfo(file.name, _EPOCH)
            entry.compress_type = zipfile.ZIP_DEFLATED
            # rights of an ordinary file, on any system
            entry.create_system, entry.external_attr = 3, 0o100644 << 16
            archive.writestr(entry, file.read_bytes())
    return path


def carried(archive: Path, limit: int = CARRIED) -> Carried:
    """What of an archive a page carries: everything, or its smallest files up to a limit.

    Parameters
    ----------
    archive : Path
        Written by `write_archive`.
    limit : int
        Bytes.

    Raises
    ------
    OSError
        The archive cannot be read.
    """
    content = archive.read_bytes()
    with zipfile.ZipFile(archive) as found:
        entries = found.infolist()
    if len(content) <= limit:
        names = {e.filename: (_start(content, e), e.compress_size) for e in entries}
        return Carried(names | {ARCHIVE: (0, len(content))}, _text(content))
    parts, names, used = [], {}, 0
    for entry in sorted(entries, key=lambda e: (e.compress_size, e.filename)):
        if used + entry.compress_size > limit:
            break
        start = _start(content, entry)
        parts.append(content[start : start + entry.compress_size])
        names[entry.filename] = (used, entry.compress_size)
        used += entry.compress_size
    left = frozenset({ARCHIVE, *(e.filename for e in entries)} - names.keys())
    return Carried(names, _text(b"".join(parts)), left)


def _start(content: bytes, entry: zipfile.ZipInfo) -> int:
    """Where the compressed bytes of an entry begin."""
    lengths: Sequence[int] = [
        int.from_bytes(content[entry.header_offset + k : entry.header_offset + k + 2], "little")
        for k in (26, 28)
    ]
    return entry.header_offset + _HEADER + sum(lengths)


def _text(content: bytes) -> str:
    return base64.b64encode(content).decode("ascii")
