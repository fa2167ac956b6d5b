"""One page of documentation with every result that the documents print, beside the computed one.

``python -m strutwork.papers.results_page OUT docs/published-results.md`` reads the files of
statements that ``strutwork report --all -o OUT`` has written.
"""

from __future__ import annotations

import argparse
from collections import Counter
from collections.abc import Iterable, Mapping, Sequence
from pathlib import Path

from strutwork.errors import ModelError
from strutwork.files import write_text
from strutwork.papers.statements import STATUSES, Statement, read_statements, shown

HEAD = """# Published results

Every result that the five documents print, beside the computed one, with its status, the reason,
and the test that holds it. *Predicted* means that no choice was made to match the published
value; *calibrated*, that one was; *not reproducible*, that the document does not state enough, or
that it errs, as the reason states.
The page is written from the reports' files:

    strutwork report --all -o out/all
    python -m strutwork.papers.results_page out/all docs/published-results.md
"""


def files(folder: Path) -> dict[str, Path]:
    """Files of statements below a folder of reports, by the key of their document.

    Raises
    ------
    ModelError
        There is none.
    """
    found = sorted(folder.rglob("published-*-statements.csv"))
    if not found:
        raise ModelError(
            str(folder),
            "has no file published-*-statements.csv.",
            "Write the documents' reports there first: strutwork report --all.",
        )
    return {f.name.removeprefix("published-").removesuffix("-statements.csv"): f for f in found}


def page(documents: Mapping[str, Path]) -> str:
    """The page in Markdown.

    Parameters
    ----------
    documents : mapping of str to Path
        File of statements of each document, as `strutwork.papers.statements.statements_file`
        makes it.
    """
    said = {key: read_statements(path) for key, path in documents.items()}
    rows = []
    for key, of in said.items():
        counts = Counter(s.status for s in of)
        rows.append([f"[{key}](#{key})", f"{len(of)}", *(f"{counts[k]}" for k in STATUSES)])
    text = HEAD + "\n" + _table(["document", "results", *STATUSES], rows)
    return text + "".join(f"\n## {key}\n\n{_statements(of)}" for key, of in said.items())


def _statements(said: Sequence[Statement]) -> str:
    reasons = list(dict.fromkeys(s.reason for s in said if s.reason))
    tests = list(dict.fromkeys(s.test for s in said))
    rows = [
        [
            s.place,
            s.what,
            shown(s.published, s.unit),
            shown(s.computed, s.unit),
            s.difference,
            s.status,
            f"{reasons.index(s.reason) + 1}" if s.reason else "",
            f"T{tests.index(s.test) + 1}",
        ]
        for s in said
    ]
    columns = ["place", "what", "published", "computed", "difference", "status", "reason", "test"]
    why = "".join(f"{n}. {reason}\n" for n, reason in enumerate(reasons, 1))
    held = "".join(f"- T{n}: `{test}`\n" for n, test in enumerate(tests, 1))
    return f"{_table(columns, rows)}\nReasons:\n\n{why}\nTests:\n\n{held}"


def _table(columns: Sequence[str], rows: Iterable[Sequence[str]]) -> str:
    def line(cells: Sequence[str]) -> str:
        return "| " + " | ".join(c.replace("|", "\\|").replace("\n", " ") for c in cells) + " |\n"

    return line(columns) + line(["---"] * len(columns)) + "".join(line(r) for r in rows)


def main(arguments: Sequence[str] | None = None) -> None:
    """Write the page."""
    parser = argparse.ArgumentParser(description="Write the page of all published results.")
    parser.add_argument("reports", type=Path, help="folder that report --all has written")
    parser.add_argument("page", type=Path)
    given = parser.parse_args(arguments)
    write_text(given.page, page(files(given.reports)))


if __name__ == "__main__":
    main()
