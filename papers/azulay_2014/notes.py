"""What was chosen for the numbers of the Azulay comparison, with which prints in view."""

from __future__ import annotations

from collections.abc import Mapping
from types import MappingProxyType

from strutwork.papers.published_rows import Status
from strutwork.papers.published_table import PublishedValue

_PROPOSED = "proposed-3pprs"

#: What was fitted to Table 4 for each machine.
_FITTED: Mapping[str, str] = MappingProxyType(
    {
        _PROPOSED: "the height of the workpiece's pole",
        "eclipse-3pprs": "the length of the column",
        "alizade-3prps": "the height of the pole and the length of the strut",
        "glozman-3prrs": "the height of the pole and the direction of the second drive's spring",
    }
)

_MODEL: Mapping[str, str] = MappingProxyType(
    {
        "spherical": "true spherical joints",
        "apparent": "links clamped in the platform and carriages that slide without turning, "
        "chosen because it comes closest to the tables",
    }
)

#: Every mean has a dimension or a model behind it that was chosen by these tables, however near or
#: far its number came: none is a prediction.
STATUS: Status = "calibrated"
#: To a variance nothing was fitted; together they do not come out, with either joint model, and
#: the one or the other that comes near is no prediction.
VARIANCE_STATUS: Status = "not reproducible"


def status_of(entry: PublishedValue) -> Status:
    """Status of a row of Table 2 or 4: it depends on what was chosen, not on how near it came."""
    return VARIANCE_STATUS if entry.quantity.endswith("variance") else STATUS


def note_of(entry: PublishedValue, model: str) -> str:
    """What a reader should know about a row: the model, what was fitted, doubts about the print."""
    machine = entry.row.split()[0]
    notes = [_MODEL[model]]
    if _other_length(entry.row):
        notes.append(
            "pole height fitted at 216 mm and carried over; the check points and the drives were "
            "chosen to match this table"
        )
    else:
        notes.append(f"fitted to the means of Table 4: {_FITTED[machine]}")
    if entry.quantity.endswith("variance"):
        notes.append(
            "nothing was fitted to a variance: it follows from what was fitted to the means, and "
            "the variances together are not reproduced"
        )
    if machine == _PROPOSED and not _other_length(entry.row) and entry.quantity == "Kzz mean":
        notes.append(
            "Tables 2 and 4 print 5.43 and 5.690 for this machine: nothing can meet both better "
            "than 2.4 %"
        )
    if (machine, model, entry.quantity) == ("glozman-3prrs", "spherical", "Kzz mean"):
        notes.append("the pole was fitted to this machine's rank among the four by Kzz")
    if entry.note:
        notes.append(entry.note)
    return "; ".join(notes)


def _other_length(row: str) -> bool:
    return "L=" in row and "L=216" not in row
