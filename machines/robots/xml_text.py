"""XML of robot files as data: parsed by defusedxml, bounded, nothing else opened."""

from __future__ import annotations

from collections.abc import Iterator
from math import isfinite
from pathlib import Path
from typing import TYPE_CHECKING, Any
from xml.etree.ElementTree import Element, ParseError

import numpy as np
from numpy.typing import NDArray

from strutwork.errors import ModelError
from strutwork.machines.model_file import file_text

if TYPE_CHECKING:
    from collections.abc import Sequence

Array = NDArray[Any]

#: Elements at most, and how deeply they may be nested.
MAX_ELEMENTS, MAX_DEPTH = 200_000, 200
#: Numbers beyond are no quantities, and below they are zero, any unit.
LARGEST, LEAST = 1e30, 1e-60
#: Numbers beyond this are none in SI that a machine has; formats write them for "no limit".
ENDLESS = 1e9


def parse_file(path: str | Path, what: str) -> Element:
    """The root of an XML file in UTF-8 of at most 10 MB.

    Parameters
    ----------
    path : str or Path
    what : str
        What it should be, for messages.

    Raises
    ------
    ModelError
        As `file_text` and `parse`.
    """
    return parse(file_text(Path(path), what), str(path))


def parse(text: str, source: str) -> Element:
    """The root of an XML text.

    Parameters
    ----------
    text : str
    source : str
        Named in messages.

    Raises
    ------
    ModelError
        It is no XML, declares a document type or entities, or is too large.
    """
    # imported late: only a robot file waits for it
    from defusedxml.common import DefusedXmlException
    from defusedxml.ElementTree import fromstring

    if text.count("<") > 2 * MAX_ELEMENTS:
        raise ModelError(
            source,
            f"has more than {MAX_ELEMENTS} elements.",
            "Give the robot alone, without a scene around it.",
        )
    try:
        root: Element = fromstring(text, forbid_dtd=True)
    except DefusedXmlException:
        raise ModelError(
            source,
            "declares a document type or entities, which could read other files or expand "
            "without end.",
            "Remove <!DOCTYPE …> and write out what its entities stand for.",
        ) from None
    except (ParseError, ValueError) as error:
        raise ModelError(
            source, f"is not XML: {error}.", "Correct the line; save it as UTF-8 text."
        ) from None
    _require_shallow(root, source)
    return root


def _require_shallow(root: Element, source: str) -> None:
    level, depth = [root], 0
    while level:
        depth += 1
        if depth > MAX_DEPTH:
            raise ModelError(
                source,
                f"has elements nested more than {MAX_DEPTH} deep.",
                "A chain of so many bodies is no machine: split it.",
            )
        level = [child for element in level for child in element]


def plain(tag: object) -> str:
    """The name of an element without its namespace; empty for comments.

    Parameters
    ----------
    tag : object
        As ElementTree has it.
    """
    return tag.rpartition("}")[2] if isinstance(tag, str) else ""


def children(element: Element, *tags: str) -> Iterator[Element]:
    """Its child elements of some names, in order.

    Parameters
    ----------
    element : Element
    *tags : str
    """
    return (child for child in element if child.tag in tags)


def label(element: Element) -> str:
    """Kind and name of an element, for messages.

    Parameters
    ----------
    element : Element
    """
    return f"{plain(element.tag)} {element.get('name', '')}".rstrip()


def name_of(element: Element, kinds: str = "") -> str:
    """The name of an element.

    Parameters
    ----------
    element : Element
    kinds : str
        What it is, for messages; by default its tag.

    Raises
    ------
    ModelError
        None, an empty one, or one longer than 100 characters.
    """
    name = (element.get("name") or "").strip()
    kind = kinds or plain(element.tag)
    if not name:
        raise ModelError(kind, "has no name.", f'Give every {kind} a name="…".')
    if len(name) > 100:
        raise ModelError(
            f"{kind} {name[:40]}…", f"has a name of {len(name)} characters.", "Use at most 100."
        )
    return name


def required(element: Element, attribute: str, part: str = "") -> str:
    """An attribute that must be there.

    Parameters
    ----------
    element : Element
    attribute : str
    part : str
        Named in the error; by default the element.

    Raises
    ------
    ModelError
        It is missing or empty.
    """
    value = (element.get(attribute) or "").strip()
    if not value:
        raise ModelError(
            part or label(element),
            f"has no {attribute} in <{plain(element.tag)}>.",
            f'Give <{plain(element.tag)} {attribute}="…">.',
        )
    return value


def number(text: str, part: str, what: str) -> float:
    """A finite number of at most 1e30; below 1e-60 it is zero, as in model files.

    Parameters
    ----------
    text : str
    part, what : str
        Named in the error.

    Raises
    ------
    ModelError
        It is no number, not finite, or too large.
    """
    try:
        value = float(text)
    except ValueError:
        value = float("nan")
    if not isfinite(value) or abs(value) > LARGEST:
        raise ModelError(part, f"has the {what} {text.strip()[:40]!r}.", "Give a finite number.")
    return value if abs(value) >= LEAST else 0.0


def numbers(text: str, count: int, part: str, what: str) -> Array:
    """Finite numbers with blanks between, (count,).

    Parameters
    ----------
    text : str
    count : int
    part, what : str
        Named in the error.

    Raises
    ------
    ModelError
        Another count, or a number that is not finite.
    """
    words = text.split()
    if len(words) != count:
        raise ModelError(
            part, f"has {len(words)} numbers in {what} instead of {count}.", "Correct them."
        )
    return np.array([number(word, part, what) for word in words])


def attribute_numbers(
    element: Element | None, attribute: str, default: Sequence[float], part: str
) -> Array:
    """Numbers of an attribute, or the default without it, (n,).

    Parameters
    ----------
    element : Element or None
    attribute : str
    default : sequence of float
        Any unit; its length is the count.
    part : str
        Named in an error.

    Raises
    ------
    ModelError
        As `numbers`.
    """
    text = None if element is None else element.get(attribute)
    if text is None:
        return np.array(default, dtype=float)
    return numbers(text, len(default), part, attribute)


def attribute_number(element: Element | None, attribute: str, part: str) -> float | None:
    """A number of an attribute, None without it.

    Parameters
    ----------
    element : Element or None
    attribute : str
    part : str
        Named in an error.

    Raises
    ------
    ModelError
        As `number`.
    """
    text = None if element is None else element.get(attribute)
    return None if text is None else number(text, part, attribute)


def limit_pair(low: float, high: float) -> tuple[float, float] | None:
    """A range, or None where it is none: endless, or nothing between its ends.

    Parameters
    ----------
    low, high : float
        m or rad.
    """
    return None if not low < high or (low <= -ENDLESS and high >= ENDLESS) else (low, high)


def bounded(value: float | None) -> float | None:
    """A greatest effort or speed, None where it is zero, negative or endless.

    Parameters
    ----------
    value : float or None
        Any unit.
    """
    return None if value is None or not 0.0 < value < ENDLESS else value
