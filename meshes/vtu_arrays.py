"""Arrays of a .vtu file: text, base64, raw; plain or compressed; bounded before they are made."""

from __future__ import annotations

import base64
import binascii
import lzma
import re
import xml.etree.ElementTree as ET
import zlib
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from strutwork.errors import ModelError
from strutwork.meshes import limits

Array = NDArray[Any]
TYPES = {
    "Float32": "f4", "Float64": "f8", "Int8": "i1", "Int16": "i2", "Int32": "i4", "Int64": "i8",
    "UInt8": "u1", "UInt16": "u2", "UInt32": "u4", "UInt64": "u8",
}  # fmt: skip
COMPRESSORS = ("", "vtkZLibDataCompressor", "vtkLZMADataCompressor")
DAMAGED = "The file is cut short or damaged: export it again."
APPENDED = re.compile(rb"<AppendedData[^>]*>")


@dataclass
class VtuFile:
    """A file: its elements of XML, and what is appended to them.

    Parameters
    ----------
    path : Path
    root : Element
        Without the text of AppendedData.
    appended : bytes
        From the character after the underscore.
    is_raw : bool
        Whether these are bytes as they are; else base64.
    unpacked : int
        Bytes that arrays have taken so far.
    """

    path: Path
    root: ET.Element
    appended: bytes
    is_raw: bool
    unpacked: int = 0

    @property
    def order(self) -> str:
        """Byte order, as NumPy writes it."""
        return ">" if self.root.get("byte_order") == "BigEndian" else "<"

    @property
    def compressor(self) -> str:
        """Name of the compressor, empty for none."""
        return self.root.get("compressor", "")

    def error(self, problem: str, remedy: str = DAMAGED) -> ModelError:
        """An error about the file.

        Parameters
        ----------
        problem : str
            What is wrong.
        remedy : str
            What to do about it.
        """
        return ModelError(str(self.path), problem, remedy)

    def values(self, element: ET.Element, count: int | None = None) -> Array:
        """The numbers of a DataArray, (n,), as float64 or int64.

        Parameters
        ----------
        element : Element
        count : int or None
            How many there must be.

        Raises
        ------
        ModelError
            Another count, a type or format that is not known, data cut short, too many bytes.
        """
        name = element.get("Name", "without a name")
        type_ = element.get("type", "")
        if type_ not in TYPES:
            raise self.error(f"has an array {name!r} of type {type_!r}.")
        own = np.dtype(self.order + TYPES[type_])
        form = element.get("format", "ascii")
        if form == "ascii":
            text = "".join(element.itertext() if not len(element) else [element.text or ""])
            found = self._text(text, name)
        else:
            content = self._bytes(element, form, name)
            if len(content) % own.itemsize:
                raise self.error(f"has an array {name!r} of {len(content)} bytes of {type_}.")
            found = np.frombuffer(content, own)
        if count is not None and len(found) != count:
            raise self.error(f"counts {count} values in the array {name!r} and holds {len(found)}.")
        return found.astype(float if type_.startswith("F") else np.int64)

    def _text(self, text: str, name: str) -> Array:
        self._take(8 * (len(text) // 2))
        words = text.split()
        try:
            return np.array(words, dtype=float) if words else np.zeros(0)
        except ValueError:
            raise self.error(f"has an array {name!r} with a word that is not a number.") from None

    def _bytes(self, element: ET.Element, form: str, name: str) -> bytes:
        if form == "appended":
            try:
                start = int((element.get("offset") or "").strip())
            except ValueError:
                raise self.error(f"has an array {name!r} without an offset.") from None
            if not 0 <= start < max(len(self.appended), 1):
                raise self.error(f"ends before the array {name!r}, at {start} of its data.")
            source, raw = self.appended, self.is_raw
        elif form == "binary":
            source, raw, start = (element.text or "").encode("ascii", "replace").strip(), False, 0
        else:
            raise self.error(f"has an array {name!r} of format {form!r}.")
        word = np.dtype(self.order + TYPES.get(self.root.get("header_type", "UInt32"), "u4"))
        try:
            if not self.compressor:
                return self._plain(source, start, word, raw=raw)
            return self._compressed(source, start, word, raw=raw)
        except (ValueError, binascii.Error, zlib.error, lzma.LZMAError, IndexError) as error:
            raise self.error(f"has an array {name!r} that cannot be unpacked ({error}).") from None

    def _plain(self, source: bytes, start: int, word: np.dtype[Any], *, raw: bool) -> bytes:
        size = int(np.frombuffer(_piece(source, start, word.itemsize, raw=raw), word)[0])
        self._take(size)
        whole = _piece(source, start, word.itemsize + size, raw=raw)
        return whole[word.itemsize :]

    def _compressed(self, source: bytes, start: int, word: np.dtype[Any], *, raw: bool) -> bytes:
        """Blocks: their number, the size of each and of the last, their packed sizes, the data."""
        first = np.frombuffer(_piece(source, start, 3 * word.itemsize, raw=raw), word)
        count, size, last = (int(v) for v in first)
        if count > len(source) or count * word.itemsize > limits.LARGEST_FILE:
            raise ValueError(f"{count} blocks")
        if not count:
            return b""
        sizes = [size] * count
        sizes[-1] = last or size
        self._take(sum(sizes))
        head = (3 + count) * word.itemsize
        packed = np.frombuffer(_piece(source, start, head, raw=raw), word)[3:].astype(np.int64)
        if (packed < 0).any():
            raise ValueError("packed sizes")
        # the header and the data are two runs of base64
        at = start + (head if raw else 4 * -(-head // 3))
        data = _piece(source, at, int(packed.sum()), raw=raw)
        found, position = [], 0
        for wanted, length in zip(sizes, packed.tolist(), strict=True):
            found.append(_unpacked(data[position : position + length], wanted, self.compressor))
            position += length
        return b"".join(found)

    def _take(self, size: int) -> None:
        self.unpacked += size
        limits.check_content(self.path, self.unpacked)


def _piece(source: bytes, start: int, size: int, *, raw: bool) -> bytes:
    """Bytes from a place of the source on, decoded from base64 unless raw."""
    if raw:
        found = source[start : start + size]
    else:
        coded = source[start : start + 4 * -(-size // 3)]
        if re.search(rb"\s", coded):
            coded = b"".join(source[start:].split())[: 4 * -(-size // 3)]
        found = base64.b64decode(coded, validate=True)[:size]
    if len(found) < size:
        raise ValueError(f"{size} bytes wanted, {len(found)} there")
    return found


def _unpacked(data: bytes, size: int, compressor: str) -> bytes:
    """A block unpacked; never more than it says."""
    unpacker = zlib.decompressobj() if "ZLib" in compressor else lzma.LZMADecompressor()
    found = unpacker.decompress(data, size + 1)
    if len(found) != size:
        raise ValueError(f"a block of {size} bytes unpacks to others")
    return bytes(found)


def open_vtu(path: Path) -> VtuFile:
    """Read the XML of a file.

    Parameters
    ----------
    path : Path
        .vtu, of ordinary size.

    Raises
    ------
    ModelError
        No XML, another kind of file, a compressor that is not read.
    """
    content = limits.read_bytes(path)
    appended, is_raw = b"", False
    if match := APPENDED.search(content):
        end = content.rfind(b"</AppendedData>")
        body = content[match.end() : end if end > match.end() else len(content)]
        mark = body.find(b"_")
        appended = body[mark + 1 :] if mark >= 0 else b""
        is_raw = b"raw" in match[0]
        if not is_raw:
            appended = appended.strip()
        rest = content[end:] if end > match.end() else b""
        content = content[: match.end()] + rest
    if b"<!DOCTYPE" in content or b"<!ENTITY" in content:
        raise ModelError(
            str(path), "declares entities of XML, which are not read.", "Export the mesh again."
        )
    try:
        root = ET.fromstring(content)  # noqa: S314 - see above
    except (ET.ParseError, ValueError, LookupError) as error:
        raise ModelError(
            str(path),
            f"cannot be read as .vtu: {error}.",
            "The file is cut short or damaged, or of another format: export it again.",
        ) from None
    file = VtuFile(path, root, appended, is_raw)
    if root.tag != "VTKFile" or root.get("type") != "UnstructuredGrid":
        what = root.get("type") or root.tag
        raise file.error(
            f"is of type {what!r}, not UnstructuredGrid.",
            "Export the mesh as an unstructured grid.",
        )
    if file.compressor not in COMPRESSORS:
        short = file.compressor.removeprefix("vtk").removesuffix("DataCompressor")
        raise file.error(
            f"is compressed with {short}, which is not read.",
            "Export it with ZLib or without compression.",
        )
    return file
