"""Numbers and text on the page."""

from __future__ import annotations

import doctest
import json

import numpy as np
import pytest

import strutwork.reports.chapters.model_loads
import strutwork.reports.numbers
import strutwork.reports.page
from strutwork.reports.content import Chapter, Column, Figure, Page, Table, Text
from strutwork.reports.figures.charts import Bars, grouped
from strutwork.reports.figures.curves import heat
from strutwork.reports.numbers import clean, fixed, percent, share, significant
from strutwork.reports.page import embedded, render


@pytest.mark.parametrize(
    "module",
    [strutwork.reports.numbers, strutwork.reports.chapters.model_loads, strutwork.reports.page],
)
def test_examples_in_docstrings_hold(module: object) -> None:
    results = doctest.testmod(module)  # type: ignore[arg-type]
    assert results.attempted > 0
    assert results.failed == 0


def test_what_rounds_to_zero_has_no_sign() -> None:
    assert (share(-1e-5), share(-2e-3), fixed(-0.004, 2)) == ("0.0 %", "−0.2 %", "0.00")


def test_columns_of_words_have_their_width() -> None:
    columns = (Column("place", "", False, width="narrow"), Column("what", "", False, width="wide"))
    html = render(
        Page("t", "", (Chapter("c", "C", (Table("s", columns, [["Table 1", "words"]]),)),), "")
    )
    assert '<th scope="row" class="short narrow">Table 1</th>' in html
    assert '<td class="short wide" data-label="what">words</td>' in html


def test_bars_of_very_different_length_stand_on_a_logarithmic_axis() -> None:
    near = grouped(["a", "b"], [Bars("one", [1.0, 40.0], "#000")], "factor")["layout"]["yaxis"]
    far = grouped(["a", "b"], [Bars("one", [1.0, 1e4], "#000")], "factor")["layout"]["yaxis"]
    assert "type" not in near
    assert near["range"][0] == 0
    assert far["type"] == "log"
    # room beyond both ends, 1 and 10 000
    assert far["range"][0] < 0
    assert far["range"][1] > 4


def test_a_long_title_beside_a_colour_bar_has_two_lines() -> None:
    titles = ("x (mm)", "y (mm)", "displacement along x at worst (µm)")
    spec = heat([0.0, 1.0], [0.0, 1.0], np.zeros((2, 2)), titles)
    title = spec["data"][0]["colorbar"]["title"]["text"]
    assert title == "displacement along x at<br>worst (µm)"


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
