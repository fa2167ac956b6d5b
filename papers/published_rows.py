"""Published numbers beside computed ones, row by row."""

from __future__ import annotations

from dataclasses import asdict, dataclass, fields
from typing import Any, Literal

from strutwork.errors import ModelError

Status = Literal["predicted", "calibrated", "not reproducible"]

#: A difference below this counts as close, below the next as fair, %.
CLOSE, FAIR = 5.0, 15.0


@dataclass(frozen=True)
class PublishedRow:
    """One published number and ours.

    Parameters
    ----------
    row : str
        What it belongs to.
    quantity : str
    unit : str
        Of both numbers.
    published, computed : float
    status : "predicted", "calibrated" or "not reproducible"
    note : str
    """

    row: str
    quantity: str
    unit: str
    published: float
    computed: float
    status: Status
    note: str = ""

    @property
    def difference_percent(self) -> float:
        """(computed − published) / published, %."""
        if self.published == 0:
            raise ModelError(
                f"{self.row}, {self.quantity}",
                "the published number is zero.",
                "A difference in percent has no meaning here.",
            )
        return 100.0 * (self.computed - self.published) / self.published

    def to_dict(self) -> dict[str, Any]:
        """The columns of the file, in its order."""
        content = asdict(self)
        return {name: content.get(name, self.difference_percent) for name in COLUMNS}


#: Columns of a file of published numbers.
COLUMNS = (
    *(f.name for f in fields(PublishedRow) if f.name not in ("status", "note")),
    "difference_percent",
    "status",
    "note",
)


def file_name(table: str) -> str:
    """Name of a table's file: `published-azulay-2014-table-4.csv`."""
    return f"published-{table}.csv"
