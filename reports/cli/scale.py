"""`strutwork scale`: how forces, stiffness and frequencies change with the size of a machine."""

from __future__ import annotations

from strutwork.errors import ModelError
from strutwork.machines.catalogue import CATALOGUE
from strutwork.machines.paper_reference import resolve


def run(
    machine: str,
    band: tuple[float, float],
    count: int,
    ratio: float,
    tilt: str,
    out: str | None,
    *,
    granite: bool,
    json: bool,
) -> None:
    """Compute the forces over the length and what the machine's size changes, and print them."""
    studied = {name: entry.scale for name, entry in CATALOGUE.items() if entry.scale}
    if machine not in studied:
        raise ModelError(
            f"scale of {machine}",
            "is not known: no study of its size exists.",
            "Machines: " + ", ".join(studied) + ".",
        )
    resolve(studied[machine])(machine, band, count, ratio, tilt, out, granite=granite, json=json)
