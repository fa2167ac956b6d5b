"""Names of machines, and the published numbers beside them."""

from __future__ import annotations

import pytest

from strutwork.errors import ModelError
from strutwork.kinematics import Mechanism
from strutwork.machines import CATALOGUE, get
from strutwork.papers.azulay_2014.published import TABLE_2, TABLE_4, TABLES
from strutwork.papers.son_2002 import published as son


def test_every_entry_makes_its_machine() -> None:
    assert list(CATALOGUE) == [
        "proposed-3pprs",
        "eclipse-3pprs",
        "alizade-3prps",
        "glozman-3prrs",
        "prototype-3ppprs",
        "mit-ss1",
        "hexel-hexapod",
        "moving-bridge",
        "serial-five-axis",
        "eclipse-prototype",
        "eclipse-machine",
        "linear-delta",
        "gough-platform",
        "biglide",
    ]
    for name, entry in CATALOGUE.items():
        machine = entry.factory()
        assert get(name) is entry
        assert isinstance(machine, Mechanism)
        assert machine.place(machine.home()).reachable
        documents = {"mit-ss1": "son-2002", "hexel-hexapod": "son-2002"}
        documents |= {"moving-bridge": "son-2002", "serial-five-axis": "son-2002"}
        documents |= {"eclipse-prototype": "kim-2001", "eclipse-machine": "kim-2001"}
        documents |= {"linear-delta": "corbel-2008", "gough-platform": "corbel-2008"}
        documents |= {"biglide": "chablat-2003"}
        assert entry.paper.key == documents.get(name, "azulay-2014")


def test_the_factory_takes_other_dimensions() -> None:
    machine = get("proposed-3pprs").factory(link_length=0.236)
    placement = machine.place(machine.home())
    assert placement.values[1] == pytest.approx(0.018 + (0.236**2 - 0.126**2) ** 0.5)


def test_an_unknown_machine_is_answered_with_the_names() -> None:
    with pytest.raises(ModelError, match=r"machine hexapod(.|\n)*proposed-3pprs, eclipse-3pprs"):
        get("hexapod")


def test_tables_are_complete_and_their_values_are_unique() -> None:
    sizes = {key.rsplit("-", 1)[1]: len(table.values) for key, table in TABLES.items()}
    assert sizes == {"1": 9, "2": 18, "3": 35, "4": 24, "5": 12}
    for table in TABLES.values():
        names = [(value.row, value.quantity) for value in table]
        assert len(set(names)) == len(names)
        for row, _ in names:
            assert row.split(" L=")[0] in CATALOGUE


def test_the_thesis_has_its_numbers_once_each() -> None:
    sizes = {key.removeprefix("son-2002-"): len(table.values) for key, table in son.TABLES.items()}
    assert sizes == {
        "appendix-b": 11,
        "table-2": 36,
        "table-6": 15,
        "modes": 9,
        "mount-modes": 3,
        "section-6-2": 1,
        "manipulability": 14,
    }
    for table in son.TABLES.values():
        names = [(value.row, value.quantity) for value in table]
        assert len(set(names)) == len(names)
    # page 85: far and near joint of the third strut; page 102: at home along y
    assert son.TABLE_2.value(son.table_2_row("III", 5), "Fr") == 27.3
    assert son.TABLE_2.value(son.table_2_row("II", 6), "Fa") == 3.6
    assert son.TABLE_6.value(son.table_6_row(0, 0), "Ky") == 40.0


def test_numbers_are_found_by_row_and_quantity() -> None:
    # Table 4 and Table 2 as printed
    assert TABLE_4.value("eclipse-3pprs", "Kzz mean") == 7.360
    assert TABLE_2.value("proposed-3pprs L=196 mm", "Kzz variance") == 1.18
    with pytest.raises(ModelError, match=r'no "Kzz median" of "eclipse-3pprs"(.|\n)*Kzz mean'):
        TABLE_4.value("eclipse-3pprs", "Kzz median")
