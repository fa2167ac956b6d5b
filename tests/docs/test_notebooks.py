"""The notebooks are those of the tutorials, and run in a kernel.

What their cells do is followed in the quick run as well, without a kernel: test_tutorials.py.
"""

from __future__ import annotations

import os
import sys
from pathlib import Path

import nbformat
import pytest
from nbclient import NotebookClient

from tests.docs.markdown import ROOT
from tests.docs.notebooks import NOTEBOOKS, notebook
from tests.docs.tutorial import TUTORIALS


def test_every_notebook_belongs_to_a_tutorial() -> None:
    assert {p.stem for p in NOTEBOOKS.glob("*.ipynb")} == {page.stem for page in TUTORIALS}


@pytest.mark.parametrize("page", TUTORIALS, ids=lambda page: page.stem)
def test_a_notebook_is_made_of_its_tutorial(page: Path) -> None:
    text = (NOTEBOOKS / f"{page.stem}.ipynb").read_text(encoding="utf-8")
    assert text == notebook(page), "python -m tests.docs.notebooks writes it anew"


@pytest.mark.slow
@pytest.mark.parametrize("page", TUTORIALS, ids=lambda page: page.stem)
def test_a_notebook_runs_in_a_kernel(
    page: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    beside = Path(sys.executable).parent
    monkeypatch.setenv("PATH", f"{beside}{os.pathsep}{os.environ['PATH']}")
    # as the tests are run: from the checkout, where the package may not be installed
    found = os.pathsep.join([str(ROOT), os.environ.get("PYTHONPATH", "")]).rstrip(os.pathsep)
    monkeypatch.setenv("PYTHONPATH", found)
    made = nbformat.read(NOTEBOOKS / f"{page.stem}.ipynb", as_version=4)
    client = NotebookClient(made, timeout=600, resources={"metadata": {"path": str(tmp_path)}})
    client.execute()
    shown = [o["data"] for c in made.cells for o in c.get("outputs", []) if "data" in o]
    drawings = [data for data in shown if "application/vnd.plotly.v1+json" in data]
    assert drawings, "no drawing"
    # an exported page has them as well
    assert all("text/html" in data for data in drawings)
    assert any("<table" in data.get("text/html", "") for data in shown)
