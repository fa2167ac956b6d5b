"""Where the modes of the MIT-SS-1 keep their strain energy."""

from __future__ import annotations

import re
from collections.abc import Mapping
from types import MappingProxyType

from strutwork.papers.son_2002.modes import NamedModes
from strutwork.papers.son_2002.whole_study import WholeStudy
from strutwork.papers.tables import numbers, texts
from strutwork.reports.content import Block, Column, Figure, Table
from strutwork.reports.figures.modes import energy_bars
from strutwork.reports.numbers import fixed

MODES_FILE = "modes.csv"

#: Where strain energy sits: how the names of parts begin.
PLACES: Mapping[str, str] = MappingProxyType(
    {
        "granite": r"element granite",
        "mounts": r"joint mount\d",
        "housing bearings": r"joint strut\d/housing",
        "block bearings": r"joint strut\d/block",
        "struts": r"beam strut",
        "drives": r"joint block\d/guide",
    }
)


def place_shares(found: NamedModes, name: str) -> dict[str, float]:
    """Strain energy of a mode by place, %; what is in none of `PLACES` under "rest"."""
    parts = found.modes.energy_parts
    shares = 100.0 * found.modes.energy_shares[found.index[name]]
    result = dict.fromkeys((*PLACES, "rest"), 0.0)
    for part, share in zip(parts, shares, strict=True):
        place = next((p for p, begins in PLACES.items() if re.match(begins, part)), "rest")
        result[place] += float(share)
    return result


def energy_blocks(study: WholeStudy) -> list[Block]:
    """A picture and a table of the strain energy of every mode that the page draws."""
    shown = sorted(
        study.shown.values(), key=lambda one: study.named[one[0]].frequencies[one[1]], reverse=True
    )
    names = [name for _, name in shown]
    found = [place_shares(study.named[which], name) for which, name in shown]
    kinds = [k for k in found[0] if max(f[k] for f in found) >= 0.05]
    return [
        Figure(
            "mode-energies",
            "Where each mode stores its strain energy, the highest mode at the top. The ball "
            "screw's is of the machine with elastic drives.",
            energy_bars(
                names, {k: [f[k] for f in found] for k in kinds}, "share of strain energy (%)"
            ),
            "Stacked bars of the strain energy of each mode by granite, mounts, bearings, struts.",
            MODES_FILE,
            520,
        ),
        _energy_table(study, kinds),
    ]


def _energy_table(study: WholeStudy, kinds: list[str]) -> Table:
    rows = []
    for which, name in sorted(
        study.shown.values(), key=lambda one: study.named[one[0]].frequencies[one[1]]
    ):
        found = study.named[which]
        shares = place_shares(found, name)
        rows.append(
            [
                name,
                fixed(found.frequencies[name], 1),
                f"{100 * found.shares[name]:.0f} %",
                *(f"{shares[k]:.0f} %" for k in kinds),
            ]
        )
    return Table(
        "Modes at home: share of the named pattern in the mode, and its strain energy",
        (
            *texts("mode"),
            *numbers("frequency", unit="Hz"),
            *numbers("of its pattern"),
            *(Column(k, "", True, "strain energy") for k in kinds),
        ),
        rows,
        MODES_FILE,
    )
