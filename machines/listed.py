"""The catalogue as a person looks at it."""

from __future__ import annotations

from strutwork.html import table
from strutwork.machines.catalogue import CATALOGUE, CatalogueEntry


class Listed(dict[str, CatalogueEntry]):
    """The catalogue, shown as a table."""

    def __repr__(self) -> str:
        width = max(map(len, self), default=0)
        return "\n".join(f"{name:<{width}}  {entry.title}" for name, entry in self.items())

    def _repr_html_(self) -> str:
        rows = [(e.name, e.title, e.topology, e.paper.key) for e in self.values()]
        return table("Machines", rows, ("name", "machine", "topology", "document"))


def listed() -> Listed:
    """Every machine of the catalogue by its name."""
    return Listed(CATALOGUE)
