"""Papers stand apart: no floor below names one of them, or a machine of theirs."""

from __future__ import annotations

import ast
import io
import re
import tokenize
from pathlib import Path

import pytest

from strutwork.errors import ModelError
from strutwork.machines import CATALOGUE
from strutwork.machines.paper_reference import resolve
from tests.unit.test_package import PACKAGE, ROOMS, ROOT

#: Where machines and papers have their names.
NAMING = {"machines", "papers"}

#: Of machines and authors, as they stand in a name or a text; `strutwork new` lists kinds of
#: machines, one of which is called as its member here.
NAMES = re.compile(
    r"eclipse|mit[-_ ]?ss|hexel|hexapod|pprs|prps|prrs|alizade|glozman|azulay|biglide|chablat"
    r"|corbel|linear[-_ ]?delta(?!, gantry)|gough|serial[-_ ]five|moving[-_ ]bridge"
    r"|(?<![a-z])(?:son|kim|mit|proposed|prototype)(?![a-z])"
)


def plain(text: str) -> str:
    """In small letters, the words of a class's name apart."""
    return re.sub(r"(?<=[a-z0-9])(?=[A-Z])", "_", text).lower()


def docstrings(source: str) -> set[int]:
    """Lines on which a docstring begins."""
    found = set()
    for node in ast.walk(ast.parse(source)):
        if isinstance(node, ast.Module | ast.ClassDef | ast.FunctionDef | ast.AsyncFunctionDef):
            first = node.body[0] if node.body else None
            if isinstance(first, ast.Expr) and isinstance(first.value, ast.Constant):
                found.add(first.lineno)
    return found


def named(source: str) -> list[str]:
    """Identifiers and texts that name a machine or a paper; comments and docstrings may cite."""
    cited = docstrings(source)
    return [
        f"line {token.start[0]}: {token.string}"
        for token in tokenize.generate_tokens(io.StringIO(source).readline)
        if token.type != tokenize.COMMENT
        and not (token.type == tokenize.STRING and token.start[0] in cited)
        and NAMES.search(plain(token.string))
    ]


@pytest.mark.parametrize("room", [room for room in ROOMS if room not in NAMING])
def test_no_code_below_names_a_machine_or_a_paper(room: str) -> None:
    files = sorted((ROOT / room).rglob("*.py"))
    assert files
    places = {p.relative_to(ROOT) for p in files}
    assert {p for p in places if NAMES.search(plain(str(p)))} == set()
    texts = {p: named((ROOT / p).read_text(encoding="utf-8")) for p in places}
    assert {p: found for p, found in texts.items() if found} == {}


def test_every_name_of_the_catalogue_would_be_found() -> None:
    names = [*CATALOGUE, *(type(e.factory()).__name__ for e in CATALOGUE.values())]
    names += [key for e in CATALOGUE.values() for key in (e.paper.key, plain(e.paper.key))]
    names += [p.name for p in (ROOT / "papers").iterdir() if p.is_dir() and p.name[0] != "_"]
    assert [name for name in names if not NAMES.search(plain(name))] == []


@pytest.mark.parametrize(
    "source", ["class SonStudy: ...", "x = 'mit-ss1'", "from a import hexapod_view", "f'a {Kim}'"]
)
def test_a_name_in_code_is_found(source: str) -> None:
    assert named(source)


@pytest.mark.parametrize(
    "source",
    ['"""Son 2002, eq. 3."""', "x = 1  # Azulay et al. 2014", "reason = 'limit, json'", "commit()"],
)
def test_a_citation_is_no_name(source: str) -> None:
    assert named(source) == []


def references() -> list[str]:
    entries = CATALOGUE.values()
    found = {r for e in entries for r in (e.report, e.tolerances, e.scale, e.paper.page) if r}
    return sorted(found)


@pytest.mark.parametrize("reference", references())
def test_what_an_entry_names_is_there(reference: str) -> None:
    assert callable(resolve(reference))


@pytest.mark.parametrize(
    ("reference", "said"),
    [
        ("strutwork.papers.son_2002", "does not name a part"),
        ("strutwork.papers.son_2002.size:", "does not name a part"),
        ("os:system", "does not name a part"),
        ("strutwork.reports.build:write_report", "does not name a part"),
        ("strutwork.papers.nobody_1999.page:chapters", "leads nowhere"),
        ("strutwork.papers.son_2002.size:chapters", "leads nowhere"),
    ],
)
def test_a_reference_leads_into_papers_or_nowhere(reference: str, said: str) -> None:
    with pytest.raises(ModelError, match=said):
        resolve(reference)


def test_a_document_has_one_folder() -> None:
    folders = {p.parent for p in (PACKAGE / "papers").resolve().rglob("*.py")}
    documents = {p.relative_to(ROOT / "papers").parts[0] for p in folders if p.name != "papers"}
    assert documents == {e.paper.key.replace("-", "_") for e in CATALOGUE.values()}


def test_documents_know_nothing_of_each_other() -> None:
    for document in {e.paper.key.replace("-", "_") for e in CATALOGUE.values()}:
        files: list[Path] = sorted((ROOT / "papers" / document).rglob("*.py"))
        text = "\n".join(p.read_text(encoding="utf-8") for p in files)
        others = set(re.findall(r"strutwork\.papers\.(\w+_\d{4})", text)) - {document}
        assert others == set(), document
