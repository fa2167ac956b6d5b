"""What a computed number of the Azulay comparison is worth: predicted, calibrated or neither."""

from __future__ import annotations

from collections.abc import Mapping
from types import MappingProxyType

from machines import PublishedValue
from studies.published_table import Status

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

#: A variance is met when it is within this factor of the printed one.
VARIANCE_FACTOR = 2.0


def status_of(entry: PublishedValue, model: str, computed: float) -> Status:
    """Status of a computed number.

    A variance that this model does not meet within `VARIANCE_FACTOR` is not reproducible by it.
    The rest of the apparent model is calibrated, as the model itself was chosen by its fit. With
    spherical joints the machines of Table 4 have a dimension that was fitted to that table; the
    proposed machine's other link lengths have nothing fitted to their own rows.
    """
    if _out_of_reach(entry, computed):
        return "not reproducible"
    return "predicted" if model == "spherical" and _other_length(entry.row) else "calibrated"


def note_of(entry: PublishedValue, model: str, computed: float) -> str:
    """What a reader should know about a row: the model, what was fitted, doubts about the print."""
    machine = entry.row.split()[0]
    notes = [_MODEL[model]]
    if _out_of_reach(entry, computed):
        notes.append("this joint model does not meet the variance within a factor of two")
    elif _other_length(entry.row):
        notes.append("pole height carried over from 216 mm")
    else:
        notes.append(f"fitted to the means of Table 4: {_FITTED[machine]}")
    if machine == _PROPOSED and not _other_length(entry.row) and entry.quantity == "Kzz mean":
        notes.append(
            "Tables 2 and 4 print 5.43 and 5.690 for this machine: nothing can meet both better "
            "than 2.4 %"
        )
    if (machine, model, entry.quantity) == ("glozman-3prrs", "spherical", "Kzz mean"):
        notes.append("the pole was fitted to this machine's place among the four by Kzz")
    if entry.note:
        notes.append(entry.note)
    return "; ".join(notes)


def _out_of_reach(entry: PublishedValue, computed: float) -> bool:
    if not entry.quantity.endswith("variance"):
        return False
    return not 1 / VARIANCE_FACTOR <= computed / entry.value <= VARIANCE_FACTOR


def _other_length(row: str) -> bool:
    return "L=" in row and "L=216" not in row
