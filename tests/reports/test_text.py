"""Numbers and text on the page."""

from __future__ import annotations

import doctest
import json

import pytest

import strutwork.reports.chapters.model_loads
import strutwork.reports.numbers
from strutwork.reports.content import Chapter, Column, Figure, Page, Table, Text
from strutwork.reports.numbers import clean, percent, significant
from strutwork.reports.page import embedded, render


@pytest.mark.parametrize(
    "module", [strutwork.reports.numbers, strutwork.reports.chapters.model_loads]
)
def test_examples_in_docstrings_hold(module: object) -> None:
    results = doctest.testmod(module)  # type: ignore[arg-type]
    assert results.attempted > 0
    assert results.failed == 0


@pytest.mark.parametrize(
    ("value", "digits", "text"),
    [
        (5.1915, 3, "5.19"),
        (9.9996, 3, "10.0"),
        (0.0, 3, "0"),
        (-0.5, 2, "−0.50"),
        (1.02e7, 3, "1.02e7"),
        (5.69, 4, "5.690"),
        (float("inf"), 3, "infinite"),
    ],
)
def test_significant_digits(value: float, digits: int, text: str) -> None:
    assert significant(value, digits) == text


def test_signs_and_rounding_noise() -> None:
    assert percent(-8.777) == "−8.8 %"
    assert percent(20.5) == "+20.5 %"
    assert clean([1e-13, -3.0, 0.5]) == "0, −3.00, 0.500"


def test_data_in_a_script_element_cannot_end_it() -> None:
    value = {"name": "</script><!-- & \u2028"}
    text = str(embedded(value))
    assert not set("<>&\u2028") & set(text)
    assert json.loads(text) == value
    with pytest.raises(ValueError, match="not JSON compliant"):
        embedded([float("nan")])


def test_text_is_escaped_wherever_it_stands() -> None:
    bad = "<script>x</script>"
    spec = {"data": [{"name": bad}], "layout": {}}
    page = Page(
        bad,
        bad,
        (
            Chapter(
                "one",
                bad,
                (
                    Text(bad),
                    Table(bad, (Column(bad, bad, False),), ((bad,),), bad),
                    Figure("figure", bad, spec, bad, bad),
                ),
            ),
        ),
        bad,
    )
    assert bad not in render(page)
