"""Every result that the paper prints stands on its page with a status and a test that exists.

@article{azulay2014comparative,
  author  = {Azulay, Hay and Mahmoodi, Masih and Zhao, Ray and Mills, James K.
             and Benhabib, Beno},
  title   = {Comparative analysis of a new {3xPPRS} parallel kinematic mechanism},
  journal = {Robotics and Computer-Integrated Manufacturing},
  volume  = {30},
  year    = {2014}
}
"""

from __future__ import annotations

import re
from pathlib import Path

import pytest

from strutwork.papers.azulay_2014.comparison import machines, variant
from strutwork.papers.azulay_2014.machine_study import Comparison
from strutwork.papers.azulay_2014.published import TABLE_1, TABLE_2, TABLE_3, TABLE_4, TABLE_5
from strutwork.papers.azulay_2014.regions import SIDES
from strutwork.papers.azulay_2014.statements import CRITICAL, significance, statements
from strutwork.papers.azulay_2014.tilts import tilts
from strutwork.papers.statements import Statement
from tests.sharing import folder_of, once

ROOT = Path(__file__).parents[3]

#: Check points within a machine's own joint ranges; regressions, heights and neutral directions
#: are ours.
KEPT = {
    "proposed-3pprs": 317,
    "eclipse-3pprs": 293,
    "alizade-3prps": 45,
    "glozman-3prrs": 285,
}


@pytest.fixture(scope="module")
def said(study: Comparison, tmp_path_factory: pytest.TempPathFactory) -> tuple[Statement, ...]:
    folder = folder_of(tmp_path_factory.getbasetemp())
    return once("azulay-statements", folder, lambda: statements(study))


def test_every_result_is_there(said: tuple[Statement, ...]) -> None:
    # both joint models, both sets of masses
    assert sum(s.place == "Table 2" for s in said) == 2 * len(TABLE_2.values)
    assert sum(s.place == "Table 4" for s in said) == 2 * len(TABLE_4.values)
    assert sum(s.place == "Table 5" for s in said) == 2 * len(TABLE_5.values)
    assert sum(s.place == "Table 1" for s in said) == len(TABLE_1.values)
    # its last line, the tilt angle, stands with section 3.1
    assert sum(s.place == "Table 3" for s in said) == len(TABLE_3.values) - 4
    assert {"Fig. 3", "Fig. 4", "Fig. 8", "Fig. 10", "Fig. 12"} <= {s.place for s in said}


def test_every_test_that_is_named_exists(said: tuple[Statement, ...]) -> None:
    for name in {s.test for s in said}:
        path, _, function = name.partition("::")
        assert re.search(rf"^def {function}\(", (ROOT / path).read_text(), re.MULTILINE), name


def test_nothing_chosen_by_a_table_is_called_predicted(said: tuple[Statement, ...]) -> None:
    predicted = [s for s in said if s.status == "predicted"]
    # exact laws, and what follows from the printed table itself
    assert {s.place for s in predicted} == {"section 4.1", "eqs 14 to 18", "eq. 27"}
    assert all("printed table" in str(s.computed) for s in predicted if s.place == "section 4.1")
    assert all(s.reason for s in said)


def test_inputs_are_those_of_the_print(said: tuple[Statement, ...]) -> None:
    """To rounding: they are taken over."""
    inputs = [s for s in said if s.place in ("Table 1", "Table 3", "section 3.3.1")]
    assert len(inputs) == len(TABLE_1.values) + len(TABLE_3.values) - 4 + 2
    for s in inputs:
        assert s.computed == pytest.approx(s.published, rel=1e-12, abs=1e-9), s.what


def test_significance() -> None:
    # from Table 4 by hand: (5.691 - 4.450) / sqrt((0.349 + 0.237) / 317) = 28.86
    assert significance("x", "eclipse-3pprs") == pytest.approx(28.86, abs=0.01)
    no = {(a, m) for a in "xyz" for m in machines()[1:] if significance(a, m) <= CRITICAL}
    # "better stiffness properties than the reference PKMs" does not hold along z
    assert no == {("z", "eclipse-3pprs")}


@pytest.mark.parametrize("name", machines())
def test_tilts_are_nested(name: str) -> None:
    found = tilts(variant(name, "spherical"))
    assert 0 < found.before_the_ring <= found.connected <= found.reached


@pytest.mark.parametrize("name", machines())
def test_points_within_own_ranges(study: Comparison, name: str) -> None:
    parted = study.barred[name, "spherical"]
    assert parted.kept(True) == KEPT[name] <= parted.kept(False)
    for own in (True, False):
        assert parted.kept(own, "pole") + parted.kept(own, "beyond") == parted.kept(own)
    assert set(SIDES) == {"all", "pole", "beyond"}
