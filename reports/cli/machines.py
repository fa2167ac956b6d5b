"""`strutwork machines`: the catalogue."""

from __future__ import annotations

from strutwork.machines import variants
from strutwork.machines.catalogue import CATALOGUE
from strutwork.reports.cli.output import console, print_json, table


def run(json: bool) -> None:
    """Print the machines of the catalogue."""
    if json:
        entries = [
            {
                "name": entry.name,
                "title": entry.title,
                "topology": entry.topology,
                "paper": entry.paper.citation,
                "variants": {v.name: v.description for v in variants(entry.name).values()},
            }
            for entry in CATALOGUE.values()
        ]
        print_json({"machines": entries})
        return
    out = console()
    rows = [(e.name, e.title, e.topology, e.paper.key) for e in CATALOGUE.values()]
    columns = ["name", "machine", "joints of a leg", "paper"]
    out.print(table("Machines of the literature", columns, rows, names=4))
    models = [
        (f"{name}:{v.name}", v.description)
        for name in CATALOGUE
        for v in variants(name).values()
        if len(variants(name)) > 1
    ]
    out.print(
        table("Their models; the name alone means the first", ["name", "model"], models, names=2)
    )
    for key, citation in {e.paper.key: e.paper.citation for e in CATALOGUE.values()}.items():
        out.print(f"{key}: {citation}", markup=False)
