"""Writing a report: from its target to a folder with the page and its data."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

from strutwork import __version__
from strutwork.errors import ModelError
from strutwork.machines.model import Model
from strutwork.names import meant
from strutwork.reports.content import Chapter, Page
from strutwork.reports.data_files import DataFile
from strutwork.reports.page import render
from strutwork.reports.report_folder import PAGE, require_ours, write_set
from strutwork.reports.subject import Subject, Teller


@dataclass(frozen=True)
class WrittenReport:
    """Where a report lies.

    Parameters
    ----------
    report : Path
        The page.
    data : tuple of Path
        The files beside it.
    """

    report: Path
    data: tuple[Path, ...]

    def __repr__(self) -> str:
        return f"<WrittenReport: {self.report} and {len(self.data)} data files>"


@dataclass(frozen=True)
class Composed:
    """A report before it is written.

    Parameters
    ----------
    page : Page
    files : tuple of DataFile
    subject : Subject or None
        The machine with what was found of it; None of a comparison.
    """

    page: Page
    files: tuple[DataFile, ...]
    subject: Subject | None = None

    def __repr__(self) -> str:
        return f"<Composed: {self.page.title}, {len(self.page.chapters)} chapters>"


def write_report(
    target: str,
    folder: Path,
    progress: Teller | None = None,
    put: Callable[[Model], Model] | None = None,
) -> WrittenReport:
    """Compute and write a report.

    Parameters
    ----------
    target : str
        A machine of the catalogue, or a model of it that has a report of its own, the key of a
        paper that has a page of its own, or the path of a model file.
    folder : Path
        Made when missing. An earlier report in it is replaced, all of it; other files stay.
    progress : callable, optional
        Given the name of a part of the work, returns what is told how far it is.
    put : callable, optional
        Puts the machine at another pose than home. What compares it with a document, at that
        document's own poses, is left out then.

    Returns
    -------
    WrittenReport

    Raises
    ------
    ModelError
        No such machine or file, a wrong model.
    OutputError
        A folder that cannot be written, or that holds files of the same name and no manifest.
    StrutworkError
        A model that cannot be solved. Whatever is raised, an earlier report stays as it is.
    """
    folder = Path(folder)
    # before minutes of work, and not after them
    require_ours(folder, (PAGE,))
    return write_page(compose(target, progress, put), folder)


def write_page(composed: Composed, folder: Path) -> WrittenReport:
    """Write a report that is composed, all of it or nothing.

    Raises
    ------
    OutputError
        A folder that cannot be written, or that holds files of the same name and no manifest.
    """
    text = render(composed.page)
    write_set(
        folder,
        {
            **{file.name: file.write for file in composed.files},
            PAGE: lambda path: path.write_text(text, encoding="utf-8"),
        },
    )
    return WrittenReport(folder / PAGE, tuple(folder / file.name for file in composed.files))


def page_of(title: str, subtitle: str, chapters: tuple[Chapter, ...]) -> Page:
    """A page with the footer that all have."""
    footer = f"Made by Strutwork {__version__}. This page needs no network."
    return Page(title, subtitle, chapters, footer)


def compose(
    target: str,
    progress: Teller | None = None,
    put: Callable[[Model], Model] | None = None,
) -> Composed:
    """Find everything that a report says.

    Parameters are those of `write_report`.

    Raises
    ------
    ModelError
        No such machine or file, a wrong model.
    StrutworkError
        A model that cannot be solved.
    """
    from strutwork.machines.catalogue import CATALOGUE
    from strutwork.machines.naming import is_machine

    pages = paper_pages()
    subject: Subject | None = None
    if target in pages:
        if put is not None:
            raise ModelError(
                target, "is a comparison, which has no pose of its own.", "Name a machine."
            )
        title, subtitle, chapters = _paper(pages[target], progress)
    elif is_machine(target):
        title, subtitle, chapters, subject = _machine(target, progress, put)
    elif Path(target).suffix == ".toml" or Path(target).exists():
        from strutwork.reports.model_report import model_report

        title, subtitle, chapters, subject = model_report(Path(target), progress, put)
    else:
        raise ModelError(
            f"report {target}",
            "is no machine of the catalogue and no model file.",
            meant(target, [*CATALOGUE, *pages])
            + f"Machines: {', '.join(CATALOGUE)}; comparison: {', '.join(pages)}; or the path of a "
            "TOML file.",
        )
    files = tuple(f for chapter in chapters for f in chapter.files)
    return Composed(page_of(title, subtitle, chapters), files, subject)


def paper_pages() -> dict[str, str]:
    """Documents that have a page of their own: what writes it, by their keys."""
    from strutwork.machines.catalogue import CATALOGUE

    return {e.paper.key: e.paper.page for e in CATALOGUE.values() if e.paper.page}


def _paper(page: str, progress: Teller | None) -> tuple[str, str, tuple[Chapter, ...]]:
    from strutwork.machines.paper_reference import resolve

    title, subtitle, chapters = resolve(page)(progress)
    return title, subtitle, chapters


def _machine(
    name: str, progress: Teller | None, put: Callable[[Model], Model] | None
) -> tuple[str, str, tuple[Chapter, ...], Subject]:
    """What every machine has, then what its document adds: of one name, the document's.

    A model beside the machine's own has what every machine has, where the document has no more.
    """
    from strutwork.machines.load import load
    from strutwork.machines.naming import named_machine
    from strutwork.machines.paper_reference import resolve
    from strutwork.reports.composed import chapters_beside, report_of

    model, found = load(name), named_machine(name)
    subject = Subject(model if put is None else put(model), name, name, progress)
    if put is not None:
        return subject.title, found.entry.topology, report_of(subject), subject
    if not found.report:
        beside = f"what is printed stands in the report of {found.entry.name}"
        return subject.title, f"{found.entry.topology} · {beside}", report_of(subject), subject
    asked = name if found.variant.report else found.entry.name
    title, subtitle, own = resolve(found.report)(asked, progress)
    return title, subtitle, chapters_beside(own, subject), subject
