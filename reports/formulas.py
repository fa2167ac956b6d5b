"""Formulas of the reports, typeset as MathML, which needs no script and no network."""

from __future__ import annotations

import re
from collections.abc import Callable
from functools import cache
from html import escape

from latex2mathml.converter import convert
from markupsafe import Markup

#: Formulas as chapters write them in plain text, each with its LaTeX.
FORMULAS = {
    "1/C_ii": r"1/C_{ii}",
    "(C⁻¹)_ii": r"(C^{-1})_{ii}",
    "1/|H|": r"1/|H|",
    "J⁻ᵀ K J⁻¹": r"J^{-\mathsf{T}} K J^{-1}",
    "K = Σ a aᵀ/c": r"K = \sum a\,a^{\mathsf{T}}/c",
    "c = 1/k_i + u_x²/k_tr + u_z²/k_screw": (
        r"c = \frac{1}{k_i} + \frac{u_x^2}{k_\mathrm{tr}} + \frac{u_z^2}{k_\mathrm{screw}}"
    ),
    "1/u_z²": r"1/u_z^2",
    "P₀ = max(Fr, ½ Fr + 1 Fa)": (
        r"P_0 = \max\left(F_\mathrm{r}, \tfrac{1}{2} F_\mathrm{r} + F_\mathrm{a}\right)"
    ),
    "d = √(Px² + Py²) + √(L² − Pz²)": r"d = \sqrt{P_x^2 + P_y^2} + \sqrt{L^2 - P_z^2}",
    "ΔR = √(2/3) L": r"\Delta R = \sqrt{2/3}\,L",
    "√(1/3)": r"\sqrt{1/3}",
    "σ = 1/√3": r"\sigma = 1/\sqrt{3}",
}

_KNOWN = re.compile("|".join(re.escape(escape(f)) for f in sorted(FORMULAS, key=lambda f: -len(f))))
_LATEX = {escape(plain): latex for plain, latex in FORMULAS.items()}


@cache
def mathml(latex: str) -> str:
    """MathML of a formula, within a line of text."""
    return str(convert(latex))


def typeset(
    prepare: Callable[[str], str], finish: Callable[[str], str] = str
) -> Callable[[str], Markup]:
    """A filter for the template: text escaped, its formulas typeset.

    Parameters
    ----------
    prepare : callable
        What is done to the text before it is escaped.
    finish : callable
        What is done to the escaped text; may add markup.
    """

    def filtered(text: str) -> Markup:
        safe = finish(escape(prepare(str(text))))
        shown = _KNOWN.sub(lambda found: mathml(_LATEX[found.group()]), safe)
        return Markup(shown)  # noqa: S704 - escaped above; the formulas are our own

    return filtered
