"""Formulas are MathML on the page, and text that looks like markup stays text."""

from __future__ import annotations

from strutwork.reports.build import page_of
from strutwork.reports.content import Chapter, Column, Note, Table, Text
from strutwork.reports.formulas import FORMULAS, mathml, typeset
from strutwork.reports.page import render


def test_every_formula_is_mathml() -> None:
    for plain, latex in FORMULAS.items():
        found = mathml(latex)
        assert found.startswith("<math"), plain
        # a command that the library does not know would stand there as text
        assert "\\" not in found, plain


def test_a_page_typesets_formulas_in_text_and_tables() -> None:
    columns = (Column("axis", "", False), Column("1/C_ii, other directions follow"))
    blocks = (
        Text("The least 1/|H| of <b>it</b>."),
        Note("(C⁻¹)_ii is named in words."),
        Table("Stiffness 1/C_ii", columns, [["x", "4"]]),
    )
    text = render(page_of("test", "", (Chapter("one", "One", blocks),)))
    body = text[text.index("<main") : text.index("</main>")]
    assert body.count("<math") == 4
    assert "1/|H|" not in body
    assert "&lt;b&gt;it&lt;/b&gt;" in body
    # a label cannot hold markup, and says it in plain text
    assert 'aria-label="Stiffness 1/C_ii"' in body


def test_text_between_formulas_is_escaped() -> None:
    said = typeset(str)("<script>1/C_ii</script>")
    assert said.startswith("&lt;script&gt;<math")
    assert said.endswith("&lt;/script&gt;")
