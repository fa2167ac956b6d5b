"""The singular ring in maps and tables of the machines on a circular guide."""

from __future__ import annotations

import numpy as np
import pytest

from strutwork.machines import Proposed3PPRS
from strutwork.papers.azulay_2014.chapters.barrier import BARRIER, regions_chapter
from strutwork.papers.azulay_2014.filters import AS_IN_AZULAY
from strutwork.papers.azulay_2014.regions import barred
from strutwork.reports.content import Table, Text
from strutwork.reports.figures.maps import hemisphere_map
from strutwork.studies.check_points import hemisphere
from strutwork.studies.stiffness_map import stiffness_map


def test_map_draws_two_circles_where_they_are_given() -> None:
    points = np.array([[x, y, 0.0] for x in (-1e-3, 0, 1e-3) for y in (-1e-3, 0, 1e-3)])
    values, hover = np.arange(9.0), [""] * 9
    plain = hemisphere_map(points, values, "K", hover)["data"]
    ringed = hemisphere_map(points, values, "K", hover, ring=(0.4e-3, 0.7e-3))["data"]
    drawn = [t for t in ringed if t.get("name") == "singular ring"]
    assert len(ringed) == len(plain) + 4 == len(plain) + len(drawn)
    radii = sorted({round(float(np.hypot(t["x"], t["y"]).max()), 5) for t in drawn})
    assert radii == pytest.approx([0.4, 0.7])
    assert sum(t["showlegend"] for t in drawn) == 1


def test_regions_add_up() -> None:
    machine = Proposed3PPRS()
    found = barred(machine, stiffness_map(machine, hemisphere(machine), filters=AS_IN_AZULAY))
    chapter = regions_chapter({"one": found}, "model")
    assert any(isinstance(b, Text) and BARRIER in b.text for b in chapter.blocks)
    *regions, ranges = [b for b in chapter.blocks if isinstance(b, Table)]
    for table in regions:
        points = [int(str(row[2])) for row in table.rows]
        # all points, the pole's side and what lies beyond; the axes stand side by side
        assert points[0] == points[1] + points[2] == 317
        assert [name for name, _ in table.groups if name] == ["Kxx", "Kyy", "Kzz"]
    assert [str(row[1]) for row in ranges.rows] == [
        "revolute joints only",
        "the machine's own, all",
    ]
