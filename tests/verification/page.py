"""docs/validation.md: every case from outside with its source, tolerance and computed value.

``python -m tests.verification.page`` runs all tests of this folder, notes each comparison that they
make, and writes the page; with names of its folders it renews their sections alone. A reason is the
comment before the comparison, or before the tolerance where that has a name, else what the test's
docstring says.
"""

from __future__ import annotations

import re
import sys

import pytest

from strutwork.files import write_text
from tests.verification.recorder import Recorder, Row
from tests.verification.sources import FOLDER, ROOT, Case, cases

PAGE = ROOT / "docs" / "validation.md"
HEAD = """# Validation

Every case from outside this project that the tests hold: the source, what it gives, what Strutwork
computes, and the tolerance with its reason. Of a list of numbers the row shows the one that takes
most of its tolerance, and how many there are. The page is written by
`python -m tests.verification.page`, which runs the tests and notes each comparison. What the
documents of the catalogue's machines print stands in
[published results](published-results.md).

"""
FURTHER = (
    "Further tests, which hold by a bound, by an exact answer, or whose numbers stand in the test:"
)
FOOT = """
<!-- site
```{toctree}
:hidden:

published-results
```
-->
"""


def number(value: float) -> str:
    """A number of five digits at most."""
    return f"{value:.5g}"


def cell(text: str) -> str:
    """Text that ends no cell of a table."""
    return " ".join(text.split()).replace("|", "\\|")


def said(test: str) -> str:
    """The name of a test as words."""
    return test.removeprefix("test_").replace("_", " ")


def table(rows: list[Row]) -> list[str]:
    """The comparisons of one case."""
    lines = [
        "| quantity | source | computed | tolerance | reason | test |",
        "| --- | ---: | ---: | ---: | --- | --- |",
    ]
    for row in rows:
        many = f" ({row.count} numbers)" if row.count > 1 else ""
        quantity = row.quantity.replace("`", "'")
        lines.append(
            f"| `{cell(quantity)}`{many} | {number(row.expected)} | {number(row.computed)} "
            f"| ± {row.tolerance:.2g} | {cell(row.reason)} | {said(row.test)} |"
        )
    return lines


def section(case: Case, rows: list[Row]) -> list[str]:
    """What the page says of one file of tests."""
    lines = [f"## {case.title}", ""]
    if case.source:
        lines += [f"Source: {case.source}", ""]
    if case.limits:
        lines += [f"Limits: {case.limits}", ""]
    lines += [f"Tests: `{case.path}`", ""]
    if rows:
        lines += [*table(rows), ""]
    compared = {row.test for row in rows}
    further = [test for test in case.tests if test not in compared]
    if further:
        lines += [FURTHER, ""]
        lines += [*(f"- {said(test)}" for test in further), ""]
    return lines


def page(recorder: Recorder, run: set[str], old: str = "") -> str:
    """The page in Markdown.

    Parameters
    ----------
    recorder : Recorder
    run : set of str
        Paths of the files whose tests have run.
    old : str
        The page as it was, whose other sections stay.
    """
    headed = re.compile(r"^## .*?(?=^## |^<!-- site)", re.MULTILINE | re.DOTALL)
    parts = [(re.search(r"^Tests: `(.*)`$", s, re.MULTILINE), s) for s in headed.findall(old)]
    kept = {where[1]: text for where, text in parts if where}
    lines = []
    for case in cases():
        if case.path in run or case.path not in kept:
            lines += section(case, recorder.rows(case.path))
        else:
            text = kept[case.path].partition("\n")[2].rstrip()
            lines += [f"## {case.title}", text, ""]
    return HEAD + "\n".join(lines).rstrip() + "\n" + FOOT


def main() -> int:
    """Run the tests and write the page.

    Returns
    -------
    int
        Exit status: that of the tests; the page is written where they passed.
    """
    recorder = Recorder()
    folders = [FOLDER / name for name in sys.argv[1:]] or [FOLDER]
    status = int(pytest.main([*map(str, folders), "-q", "-p", "no:xdist"], [recorder]))
    if status == 0:
        run = {c.path for c in cases() if any(f in (ROOT / c.path).parents for f in folders)}
        old = PAGE.read_text(encoding="utf-8") if PAGE.exists() else ""
        write_text(PAGE, page(recorder, run, old))
        sys.stdout.write(f"Written: {PAGE.relative_to(ROOT)}\n")
    return status


if __name__ == "__main__":
    sys.exit(main())
