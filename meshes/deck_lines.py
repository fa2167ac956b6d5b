"""Lines of a text deck and of what it includes, in any encoding, with their place."""

from __future__ import annotations

import codecs
import io
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path, PurePosixPath, PureWindowsPath

from strutwork.errors import ModelError
from strutwork.meshes import limits

MOST_INCLUDES = 1000
LONGEST_LINE = 100_000
#: Byte-order marks, the longer before those that they begin with.
MARKS = (
    (codecs.BOM_UTF8, "utf-8-sig"),
    (codecs.BOM_UTF32_LE, "utf-32"),
    (codecs.BOM_UTF32_BE, "utf-32"),
    (codecs.BOM_UTF16_LE, "utf-16"),
    (codecs.BOM_UTF16_BE, "utf-16"),
)


@dataclass
class _Open:
    """A file being read."""

    path: Path
    name: str
    content: bytes
    lines: io.TextIOWrapper
    number: int = 0


class DeckLines:
    """The lines of a deck, one after another; `include` goes on with another file.

    What it includes lies in the folder of the deck or below it, and is an ordinary file.

    Parameters
    ----------
    path : Path
    """

    def __init__(self, path: Path) -> None:
        self.path = path
        self._folder = path.parent.resolve()
        self._left = limits.LARGEST_FILE
        self._included = 0
        self._stack: list[_Open] = []
        self._push(path, "")

    def __iter__(self) -> Iterator[str]:
        while self._stack:
            top = self._stack[-1]
            for line in top.lines:
                top.number += 1
                if len(line) > LONGEST_LINE:
                    raise self.error(f"has {len(line)} characters", "Export the mesh again.")
                yield line.rstrip("\r\n")
                if self._stack[-1] is not top:
                    break
            else:
                if len(self._stack) == 1:
                    return
                self._stack.pop()

    def peek(self) -> Iterator[str]:
        """The lines of the file being read, from its beginning, without going on in it."""
        return iter(_wrapped(self._stack[-1].content))

    @property
    def where(self) -> str:
        """The place of the last line: `line 12`, or `parts.inc, line 12`."""
        top = self._stack[-1]
        return f"{top.name}, line {top.number}" if top.name else f"line {top.number}"

    def error(self, problem: str, remedy: str, where: str = "") -> ModelError:
        """An error about the last line, or about the line `where`.

        Parameters
        ----------
        problem : str
            What is wrong, after the place and without a full stop.
        remedy : str
            What to do about it.
        where : str
            The line as `where` names it; empty for the last line.
        """
        return ModelError(str(self.path), f"{where or self.where} {problem}.", remedy)

    def include(self, name: str) -> None:
        """Go on with the file of that name.

        Parameters
        ----------
        name : str
            As the deck has it, from its folder.

        Raises
        ------
        ModelError
            A name that leads out of the folder of the deck, itself or by a link; a file that
            includes itself; one that is missing, no ordinary file, or too large.
        """
        path = self._inside(name)
        if any(path == open_.path.resolve() for open_ in self._stack):
            raise self.error(f"includes {name!r}, which is being read", "Include it once.")
        self._included += 1
        if self._included > MOST_INCLUDES:
            raise self.error(
                f"is include {self._included}; {MOST_INCLUDES} is the limit",
                "Write the deck as one file.",
            )
        place = self.where
        try:
            self._push(path, name)
        except ModelError as error:
            raise ModelError(
                str(self.path), f"{place} includes {name!r}: {error.problem}", error.remedy
            ) from None

    def _inside(self, name: str) -> Path:
        pure = (PurePosixPath(name), PureWindowsPath(name))
        remedy = "Put the file beside the deck or below it, and name it from there."
        if not name or any(p.is_absolute() or p.drive or ".." in p.parts for p in pure):
            raise self.error(
                f"includes {name!r}, which leads out of the folder of the deck", remedy
            )
        folders = dict.fromkeys((self._folder, self._stack[-1].path.parent.resolve()))
        forms = dict.fromkeys((name, name.replace("\\", "/")))
        for path in (folder / form for folder in folders for form in forms):
            try:
                found = path.resolve(strict=True)
            except (OSError, ValueError, RuntimeError):
                continue
            if not found.is_relative_to(self._folder):
                raise self.error(
                    f"includes {name!r}, a link that leads out of the folder of the deck", remedy
                )
            return found
        raise self.error(f"includes {name!r}; there is no such file", remedy)

    def _push(self, path: Path, name: str) -> None:
        content = limits.read_bytes(path, self._left)
        self._left -= len(content)
        self._stack.append(_Open(path, name, content, _wrapped(content)))


def _wrapped(content: bytes) -> io.TextIOWrapper:
    return io.TextIOWrapper(io.BytesIO(content), encoding(content), errors="replace")


def encoding(content: bytes) -> str:
    """Name of the encoding: by its mark, by zero bytes, UTF-8 where it is that, or Latin-1.

    Parameters
    ----------
    content : bytes
        Of the file, all of it.
    """
    for mark, name in MARKS:
        if content.startswith(mark):
            return name
    start = content[:400]
    if len(start) >= 4 and start[1::2].count(0) > len(start) // 4:
        return "utf-16-le"
    if len(start) >= 4 and start[0::2].count(0) > len(start) // 4:
        return "utf-16-be"
    decoder = codecs.getincrementaldecoder("utf-8")()
    try:
        for first in range(0, len(content), 1 << 20):
            decoder.decode(content[first : first + (1 << 20)])
        decoder.decode(b"", final=True)
    except UnicodeDecodeError:
        # Windows-1252 is Latin-1 with letters where Latin-1 has nothing to print
        return "cp1252"
    return "utf-8"
