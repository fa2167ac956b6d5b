"""Standard output and error that show every character, whatever their encoding."""

from __future__ import annotations

import codecs
import io
import sys

from strutwork.names import visible

#: ASCII for the signs that our tables and messages use; what is not here is written as an escape.
ASCII = {
    "µ": "u",
    "μ": "u",
    "·": "*",
    "×": "x",
    "²": "^2",
    "³": "^3",
    "⁻": "^-",
    "¹": "1",
    "°": "deg",
    "→": "->",
    "−": "-",
    "–": "-",
    "—": "-",
    "‑": "-",  # noqa: RUF001
    "±": "+/-",
    "≤": "<=",
    "≥": ">=",
    "≈": "~",
    "√": "sqrt",
    "∞": "inf",
    "…": "...",
    "“": '"',
    "”": '"',
    "‘": "'",  # noqa: RUF001
    "’": "'",  # noqa: RUF001
    "′": "'",
    "•": "*",
    "α": "alpha",
    "β": "beta",
    "ζ": "zeta",
    "η": "eta",
    "λ": "lambda",
    "σ": "sigma",
    "φ": "phi",
    "ω": "omega",
    "\N{NO-BREAK SPACE}": " ",
    "\N{NARROW NO-BREAK SPACE}": " ",
    "\N{THIN SPACE}": " ",
}

HANDLER = "strutwork.ascii"


def show_every_character() -> None:
    r"""Let standard output and error write what their encoding lacks in ASCII.

    Signs of units have a short form (`ASCII`), other characters Python's escapes, as in
    `\u6771`; nothing raises for an encoding.
    """
    codecs.register_error(HANDLER, _in_ascii)
    for stream in (sys.stdout, sys.stderr):
        # a program that calls us may have put something else there
        if isinstance(stream, io.TextIOWrapper):
            stream.reconfigure(errors=HANDLER)


def _in_ascii(error: UnicodeError) -> tuple[str, int]:
    if not isinstance(error, UnicodeEncodeError):
        raise error
    lacking = error.object[error.start : error.end]
    return "".join(ASCII.get(c) or _escaped(c) for c in lacking), error.end


def _escaped(character: str) -> str:
    shown = visible(character)
    return shown if shown.isascii() else character.encode("ascii", "backslashreplace").decode()
