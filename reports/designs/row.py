"""One quantity of two machines: both values, their difference, and which of them is better."""

from __future__ import annotations

from dataclasses import dataclass
from math import isfinite, isinf
from typing import Any, Literal

from strutwork.reports.numbers import percent, significant

#: What is better: more of a quantity, less of it, or neither.
Better = Literal["more", "less", ""]

Verdict = Literal["A better", "B better", "differs", "alike", "equal", "not compared"]

#: Numbers that differ by this share are equal: it is rounding.
ROUNDING = 1e-9

#: From SI to what a reader sees: factor and unit.
SHOWN = {
    "N/m": (1e-6, "N/µm"),
    "N*m/rad": (1e-3, "kN·m/rad"),
    "N": (1.0, "N"),
    "N*m": (1.0, "N·m"),
    "m": (1e6, "µm"),
    "1": (1.0, ""),
    "%": (1.0, "%"),
}


@dataclass(frozen=True)
class Quantity:
    """What both machines are asked.

    Parameters
    ----------
    key : str
        Unique, for programs: "stiffness_free_x".
    question : str
        Key of the question that it belongs to.
    name : str
        In words.
    unit : str
        SI; "1" for numbers without one, empty for words.
    better : "more", "less" or ""
    """

    key: str
    question: str
    name: str
    unit: str
    better: Better = ""


@dataclass(frozen=True)
class Value:
    """What one machine answers.

    Parameters
    ----------
    number : float or None
        In the SI unit of its quantity, may be infinite; None where it is in words or missing.
    at : str
        Where: a pose, a joint, a frequency.
    why : str
        Why it is missing; empty where it is not.
    words : str
        An answer that is no number.
    """

    number: float | None = None
    at: str = ""
    why: str = ""
    words: str = ""

    @property
    def known(self) -> bool:
        """Whether there is an answer."""
        return not self.why

    def shown(self, unit: str, digits: int = 4) -> str:
        """The answer as a reader wants it, without its unit.

        Parameters
        ----------
        unit : str
            SI.
        digits : int
            Significant ones.
        """
        if self.number is None:
            return self.words or "–"
        if unit == "1" and isfinite(self.number):
            return f"{self.number:.0f}"
        return significant(SHOWN.get(unit, (1.0, unit))[0] * self.number, digits)


@dataclass(frozen=True)
class Row:
    """A quantity of two machines.

    Parameters
    ----------
    quantity : Quantity
    a, b : Value
    threshold : float
        Difference from which the two are marked, percent.
    """

    quantity: Quantity
    a: Value
    b: Value
    threshold: float

    def __repr__(self) -> str:
        unit = self.shown_unit
        a, b = (f"{v.shown(self.quantity.unit)} {unit}".rstrip() for v in (self.a, self.b))
        return f"<Row {self.quantity.name}: {a}, {b}, {self.verdict}>"

    @property
    def shown_unit(self) -> str:
        """Unit in which `Value.shown` writes its numbers."""
        return SHOWN.get(self.quantity.unit, (1.0, self.quantity.unit))[1]

    @property
    def compared(self) -> bool:
        """Whether both have an answer."""
        return self.a.known and self.b.known

    @property
    def difference(self) -> float | None:
        """(B - A) / |A| in percent; None where it has no size."""
        a, b = self.a.number, self.b.number
        if not self.compared or a is None or b is None or not (isfinite(a) and isfinite(b)):
            return None
        if a == 0.0:
            return 0.0 if b == 0.0 else None
        return 100.0 * (b - a) / abs(a)

    @property
    def equal(self) -> bool:
        """Whether the two answers are the same but for rounding."""
        a, b = self.a.number, self.b.number
        if a is None or b is None:
            return a is b and self.a.words == self.b.words
        if isinf(a) or isinf(b):
            return a == b
        return abs(b - a) <= ROUNDING * max(abs(a), abs(b))

    @property
    def marked(self) -> bool:
        """Whether they differ by more than the threshold."""
        if not self.compared or self.equal:
            return False
        found = self.difference
        return found is None or abs(found) > self.threshold

    @property
    def verdict(self) -> Verdict:
        """What to say of it, in words."""
        if not self.compared:
            return "not compared"
        if not self.marked:
            return "equal" if self.equal else "alike"
        a, b, better = self.a.number, self.b.number, self.quantity.better
        if a is None or b is None or not better:
            return "differs"
        return "B better" if (b > a) == (better == "more") else "A better"

    @property
    def shown_difference(self) -> str:
        """The difference as a reader wants it."""
        if not self.compared or self.a.number is None:
            return "–"
        found = self.difference
        if found is None:
            return "equal" if self.equal else "no ratio"
        return percent(found, 0 if abs(found) >= 1000.0 else 1)

    def to_dict(self) -> dict[str, Any]:
        """Plain values in SI; an infinite number is None, and its words say so."""
        return {
            "key": self.quantity.key,
            "quantity": self.quantity.name,
            "unit": self.quantity.unit,
            "a": _plain(self.a),
            "b": _plain(self.b),
            "difference_percent": self.difference,
            "better": self.quantity.better or None,
            "marked": self.marked,
            "verdict": self.verdict,
        }


def _plain(value: Value) -> dict[str, Any]:
    number = value.number
    infinite = number is not None and isinf(number)
    return {
        "value": None if infinite else number,
        "words": "infinite" if infinite else value.words,
        "at": value.at,
        "reason": value.why,
    }
