"""Reports of the models of one machine, by the name of each."""

from __future__ import annotations

import pytest

from strutwork.errors import ModelError
from strutwork.machines.catalogue import CATALOGUE
from strutwork.machines.load import load
from strutwork.machines.naming import MARK, named_machine, variants
from strutwork.reports.build import Composed, compose

#: Table 5 of Azulay et al. 2014 has no prototype: these two are named, and refused when made.
REFUSED = ("prototype-3ppprs:calibrated", "prototype-3ppprs:blind")

SEVERAL = [name for name in CATALOGUE if len(variants(name)) > 1]
NAMES = [n for m in SEVERAL for v in variants(m) if (n := f"{m}{MARK}{v}") not in REFUSED]


def keys(composed: Composed) -> list[str]:
    return [chapter.key for chapter in composed.page.chapters]


@pytest.mark.parametrize("name", NAMES)
def test_whose_chapters_stand_in_the_report(name: str) -> None:
    """The document's with its machine's first model, and where it has some for another."""
    found = named_machine(name)
    first = name == f"{found.entry.name}{MARK}{next(iter(variants(found.entry.name)))}"
    assert found.report == found.variant.report or first
    assert bool(found.report) == (first or bool(found.variant.report))
    assert named_machine(found.entry.name).report == found.entry.report


def test_a_model_beside_the_machine_s_own() -> None:
    composed = compose("serial-five-axis:ab")
    assert composed.subject is not None
    assert composed.subject.model.structure.linkage == load("serial-five-axis:ab").structure.linkage
    assert "ab" in composed.page.title
    assert "in the report of serial-five-axis" in composed.page.subtitle
    found = keys(composed)
    assert {"summary", "singularities", "reversals", "workspace-stiffness"} <= set(found)
    # what the thesis says of all heads is said once, in the report of the machine
    assert not {"flat-surface", "heads"} & set(found)
    assert found[-1] == "files"


def test_the_first_model_by_its_name_is_the_machine() -> None:
    whole, first = compose("biglide"), compose("biglide:plane")
    assert keys(whole) == keys(first)
    assert (whole.page.title, whole.page.subtitle) == (first.page.title, first.page.subtitle)
    assert {f.name for f in whole.files} == {f.name for f in first.files}


def test_a_model_that_does_not_exist_is_refused() -> None:
    with pytest.raises(ModelError, match="Variants: biglide:plane, biglide:third-leg"):
        compose("biglide:fourth-leg")


@pytest.mark.parametrize("name", REFUSED)
def test_a_model_that_cannot_be_made_says_why(name: str) -> None:
    with pytest.raises(ModelError, match="Table 5"):
        compose(name)
