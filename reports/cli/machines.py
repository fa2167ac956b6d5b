"""`strutwork machines`: the catalogue."""

from __future__ import annotations

from machines.catalogue import CATALOGUE
from reports.cli.output import console, print_json, table


def run(json: bool) -> None:
    """Print the machines of the catalogue."""
    if json:
        entries = [
            {
                "name": entry.name,
                "title": entry.title,
                "topology": entry.topology,
                "paper": entry.paper.citation,
            }
            for entry in CATALOGUE.values()
        ]
        print_json({"machines": entries})
        return
    out = console()
    rows = [(e.name, e.title, e.topology, e.paper.key) for e in CATALOGUE.values()]
    columns = ["name", "machine", "joints of a leg", "paper"]
    out.print(table("Machines of the literature", columns, rows, names=4))
    for key, citation in {e.paper.key: e.paper.citation for e in CATALOGUE.values()}.items():
        out.print(f"{key}: {citation}", markup=False)
