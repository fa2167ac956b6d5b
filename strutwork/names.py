"""Names as they may be shown: nothing in them acts on a terminal or turns a line around."""

from __future__ import annotations

import re
import unicodedata
from collections.abc import Iterable, Sequence
from difflib import get_close_matches

#: Joiners without which words of some scripts and some signs fall apart; they turn nothing.
_JOINERS = "\u200c\u200d"

#: Controls, formats (bidirectional ones among them), halves of pairs, and ends of lines.
_HIDDEN = frozenset({"Cc", "Cf", "Cs", "Zl", "Zp"})

_SHORT = {"\n": "\\n", "\r": "\\r", "\t": "\\t"}


def is_hidden(character: str) -> bool:
    r"""Whether a character shows nothing and may act on what shows the others.

    Parameters
    ----------
    character : str
        A single one.

    Examples
    --------
    >>> is_hidden("\x1b"), is_hidden("\u202e"), is_hidden("ö")
    (True, True, False)
    """
    return unicodedata.category(character) in _HIDDEN and character not in _JOINERS


def visible(text: str, *, lines: bool = False) -> str:
    r"""The text with its hidden characters written out, as in a Python string.

    Parameters
    ----------
    text : str
        Bytes of a file name that are no UTF-8 (`surrogateescape`) come out as `\xff`.
    lines : bool
        Whether ends of lines stay, as in a message of several lines.

    Returns
    -------
    str
        Encodes as UTF-8.

    >>> print(visible("\x1b[2Jtip\n"))
    \x1b[2Jtip\n
    """
    # most texts hold nothing hidden
    if text.isprintable():
        return text
    return "".join(_written(c) if is_hidden(c) and not (lines and c == "\n") else c for c in text)


def _written(character: str) -> str:
    code = ord(character)
    if character in _SHORT:
        return _SHORT[character]
    # what stands for a byte that is no UTF-8 shows the byte
    if 0xDC80 <= code <= 0xDCFF:
        code -= 0xDC00
    if code < 0x100:
        return f"\\x{code:02x}"
    return f"\\u{code:04x}" if code < 0x10000 else f"\\U{code:08x}"


def matches(name: str, pattern: str) -> bool:
    """Whether a name is what a text with stars names; other characters stand for themselves.

    Parameters
    ----------
    name, pattern : str

    Examples
    --------
    >>> matches("joints.ball1.stiffness.z", "joints.ball*.stiffness.z")
    True
    """
    # brackets and dots stand for themselves, as they do not in globs
    return bool(re.fullmatch(".*".join(map(re.escape, pattern.split("*"))), name))


def meant(name: str, known: Iterable[str]) -> str:
    """A question after the nearest of some names, with a space behind; empty where none is near.

    Parameters
    ----------
    name : str
        What was asked for and is not known.
    known : iterable of str
        The names there are.

    Examples
    --------
    >>> meant("mit-ss2", ["mit-ss1", "biglide"])
    'Did you mean "mit-ss1"? '
    >>> meant("other", ["mit-ss1", "biglide"])
    ''
    """
    near = get_close_matches(name, list(known), n=1, cutoff=0.66)
    return f'Did you mean "{visible(near[0])}"? ' if near else ""


def choices(what: str, name: str, known: Iterable[str], most: int = 12) -> str:
    """What a name that is not known could have been: the nearest, and what there is.

    Parameters
    ----------
    what : str
        Kind of the names, as a heading: "Joints".
    name : str
        As it was written.
    known : iterable of str
        The names there are.
    most : int
        So many are listed.

    Examples
    --------
    >>> choices("Nodes", "TPC", ["TCP", "base"])
    'Did you mean "TCP"? Nodes: TCP, base.'
    """
    words = list(known)
    some = ", ".join(visible(word) for word in words[:most]) + (" …" if len(words) > most else ".")
    return f"{'' if name in words else meant(name, words)}{what}: {some}"


def listed(words: Sequence[str], mark: str = ",") -> str:
    """Words as a sentence lists them.

    Parameters
    ----------
    words : sequence of str
        In the order in which they shall stand; none makes an empty text.
    mark : str
        What stands after each word but the last two.

    Examples
    --------
    >>> listed(["x", "y", "z"]), listed(["x"]), listed([])
    ('x, y and z', 'x', '')
    """
    if len(words) < 2:
        return "".join(words)
    return f"{mark} ".join(words[:-1]) + f" and {words[-1]}"
