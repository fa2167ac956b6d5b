"""`strutwork correlate`: computed modes and responses against measured ones."""

from __future__ import annotations

from collections.abc import Sequence

from strutwork.errors import ModelError
from strutwork.fea.compare_files import compare_files
from strutwork.fea.comparison import Comparison
from strutwork.fea.uff_read import read_universal
from strutwork.reports.cli.output import console, print_json, table
from strutwork.reports.cli.progress import shown


def run(
    computed: str,
    measured: str,
    *,
    window: float,
    least: float,
    doublet: float,
    units: Sequence[str],
    json: bool,
) -> None:
    """Compare two universal files and print what they have in common, and what was left out."""
    given = dict(_unit(text) for text in units)
    files = read_universal(computed, given), read_universal(measured, given)
    with shown("responses") as started:
        found = compare_files(
            *files, window=window, least=least, doublet=doublet, progress=started("correlate")
        )
    if json:
        print_json(found.to_dict())
    else:
        _print(found)


def _unit(text: str) -> tuple[str, str]:
    label, mark, unit = text.partition("=")
    if not (mark and label.strip() and unit.strip()):
        raise ModelError(
            f"--unit {text}", "is not LABEL=UNIT.", 'Write it as in --unit "EU=mm/s^2".'
        )
    return label.strip(), unit.strip()


def _print(found: Comparison) -> None:
    out = console()
    if found.modes:
        spans = any(p.group > 1 for p in found.modes)
        rows = [
            (
                p.computed + 1,
                p.measured + 1,
                p.computed_frequency,
                p.measured_frequency,
                f"{p.difference_percent:+.2f}",
                _percent(p.computed_damping),
                _percent(p.measured_damping),
                f"{p.mac:.3f}",
                *([f"{p.group} modes" if p.group > 1 else ""] if spans else []),
            )
            for p in found.modes
        ]
        # every word fits its column at 80 characters: a table folds its headings anywhere
        columns = [
            "no.",
            "no. in test",
            "Hz",
            "Hz in test",
            "off, %",
            "ζ, %",
            "ζ in test, %",
            "MAC",
        ]
        out.print(table("Paired modes", columns + ["span of"] * spans, rows, names=0))
    for what, rest in (("computed", found.only_computed), ("measured", found.only_measured)):
        if rest:
            frequencies = ", ".join(f"{f:.4g}" for f in rest)
            out.print(f"Only {what}, Hz: {frequencies}", markup=False)
    if found.functions:
        lines = [
            (
                f.output,
                f"{f.input} {f.run}".rstrip(),
                f"{f.found.frac:.3f}",
                f"{f.found.scale:.4f}" + (" (end of search)" if f.found.at_limit else ""),
                f"{f.found.scaled_frac:.3f}",
            )
            for f in found.functions
        ]
        columns = ["output", "input", "FRAC", "best frequency scale", "FRAC at it"]
        out.print(table("Responses", columns, lines, names=2))
    for note in found.notes:
        out.print(f"Note: {note}.", markup=False)


def _percent(ratio: float | None) -> str:
    return "" if ratio is None else f"{100 * ratio:.3g}"
