"""Writing a report: from its target to a folder with the page and its data."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from datetime import datetime
from pathlib import Path

from strutwork import __version__
from strutwork.errors import ModelError
from strutwork.machines.described_process import DescribedProcess
from strutwork.machines.model import Model
from strutwork.names import meant
from strutwork.reports.answering import Kept, answering, store_at
from strutwork.reports.archive import ARCHIVE, carried, write_archive
from strutwork.reports.content import Chapter, Links, Page
from strutwork.reports.data_files import DataFile
from strutwork.reports.document_page import DocumentPage
from strutwork.reports.page import render
from strutwork.reports.pdf import PDF, print_page, require_browser
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
        The files beside it, and the one that holds them all.
    pdf : Path or None
        The page as printed, where that was asked for.
    """

    report: Path
    data: tuple[Path, ...]
    pdf: Path | None = None

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
    *,
    pdf: bool = False,
    fresh: bool = False,
    errors: Path | None = None,
    process: DescribedProcess | None = None,
) -> WrittenReport:
    """Compute and write a report.

    Parameters
    ----------
    target : str
        A machine of the catalogue, or a model of it that has a report of its own, the key of a
        paper that has a page of its own, or the path of a model file.
    folder : Path
        Made when missing. An earlier report on the same target in it is replaced, all of it;
        other files stay.
    progress : callable, optional
        Given the name of a part of the work, returns what is told how far it is.
    put : callable, optional
        Puts the machine at another pose than home. What compares it with a document, at that
        document's own poses, is left out then.
    pdf : bool
        Whether the page is printed as well, by a browser of the system.
    fresh : bool
        Whether everything is computed anew. What an earlier report of the same machine, by the
        same code, has computed is reused else.
    errors : Path, optional
        An errors file, by which the chapter on accuracy has the error sheet.
    process : DescribedProcess, optional
        The cut whose stability is reported, in place of the machine's own.

    Returns
    -------
    WrittenReport

    Raises
    ------
    ModelError
        No such machine or file, a wrong model; nothing to print with.
    OutputError
        A folder that cannot be written, or that holds files of the same name and no manifest.
    StrutworkError
        A model that cannot be solved. Whatever is raised, an earlier report stays as it is.
    """
    folder = Path(folder)
    # before minutes of work, and not after them
    require_ours(folder, (PAGE,), about_of(target))
    if pdf:
        require_browser()
    return write_page(
        compose(target, progress, put, fresh=fresh, errors=errors, process=process),
        folder,
        about_of(target),
        pdf=pdf,
    )


def about_of(target: str) -> str:
    """What a report on a target is on: the name of the machine or paper, or of the file."""
    return Path(target).name


def write_page(
    composed: Composed, folder: Path, about: str = "", *, pdf: bool = False
) -> WrittenReport:
    """Write a report that is composed, all of it or nothing.

    Its files stand beside the page, once more together in one archive, and in the page itself as
    far as it carries them.

    Parameters
    ----------
    composed : Composed
    folder : Path
    about : str
        What it is on: it replaces no report on anything else.
    pdf : bool
        Whether the page is printed as well.

    Raises
    ------
    OutputError
        A folder that cannot be written, that holds files of the same name and no manifest, or a
        report on something else.
    """
    names = [file.name for file in composed.files]
    page = with_archive(composed.page) if names else composed.page

    def together(path: Path) -> None:
        write_archive(path, [path.with_name(name) for name in names])

    def written(path: Path) -> None:
        beside = carried(path.with_name(ARCHIVE)) if names else None
        path.write_text(render(page, beside), encoding="utf-8")

    # in this order: each is made from those before
    writers: dict[str, Callable[[Path], object]] = {f.name: f.write for f in composed.files}
    if names:
        writers[ARCHIVE] = together
    writers[PAGE] = written
    if pdf:
        writers[PDF] = lambda path: print_page(path.with_name(PAGE), path)
    write_set(folder, writers, about)
    beside = tuple(folder / name for name in writers if name not in {PAGE, PDF})
    return WrittenReport(folder / PAGE, beside, folder / PDF if pdf else None)


def with_archive(page: Page) -> Page:
    """A page whose list of files, in its last chapter, ends with all of them in one."""
    *before, closing = page.chapters
    what = "all of them in one file; this page contains them too and can be passed on alone"
    blocks = tuple(
        Links((*block.items, (ARCHIVE, what))) if isinstance(block, Links) else block
        for block in closing.blocks
    )
    return replace(page, chapters=(*before, replace(closing, blocks=blocks)))


def page_of(title: str, subtitle: str, chapters: tuple[Chapter, ...]) -> Page:
    """A page with the footer that all have."""
    # the date of whoever asked, in ISO 8601
    made = datetime.now().astimezone().date().isoformat()
    footer = f"Made by Strutwork {__version__} on {made}. This page needs no network."
    return Page(title, subtitle, chapters, footer, made)


def compose(
    target: str,
    progress: Teller | None = None,
    put: Callable[[Model], Model] | None = None,
    *,
    fresh: bool = False,
    errors: Path | None = None,
    process: DescribedProcess | None = None,
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
        if put is not None or errors is not None:
            raise ModelError(target, "is a comparison and has no pose.", "Name a machine.")
        if process is not None:
            raise ModelError(target, "is a comparison and has no process.", "Name a machine.")
        own = DocumentPage(pages[target])
        kept = Kept(store_at(own.key, fresh=fresh))
        title, subtitle, chapters = own.of(kept, progress)
    elif is_machine(target):
        title, subtitle, chapters, subject = _machine(
            target, progress, put, fresh=fresh, errors=errors, process=process
        )
    elif Path(target).suffix == ".toml" or Path(target).exists():
        from strutwork.reports.model_report import model_report

        title, subtitle, chapters, subject = model_report(
            Path(target), progress, put, fresh=fresh, errors=errors, process=process
        )
    else:
        raise ModelError(
            f"report {target}",
            "is neither a machine of the catalogue nor a model file.",
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


def _machine(
    name: str,
    progress: Teller | None,
    put: Callable[[Model], Model] | None,
    *,
    fresh: bool,
    errors: Path | None,
    process: DescribedProcess | None,
) -> tuple[str, str, tuple[Chapter, ...], Subject]:
    """What every machine has, then what its document adds: of one name, the document's.

    A model beside the machine's own has what every machine has, where the document has no more.
    """
    from strutwork.machines.load import load
    from strutwork.machines.naming import named_machine
    from strutwork.machines.process_file import known_errors
    from strutwork.reports.composed import chapters_beside, report_of

    model, found = load(name), named_machine(name)
    model = model if process is None else replace(model, process=process)
    own_errors = found.entry.errors if errors is None else ""
    about = Subject(
        model if put is None else put(model),
        name,
        name,
        progress,
        errors=known_errors(own_errors) if own_errors else errors,
    )
    if put is not None or not found.report:
        subtitle = found.entry.topology
        if put is None:
            subtitle += f" · the published values are in the report of {found.entry.name}"
        with answering(about, fresh=fresh) as subject:
            return subject.title, subtitle, report_of(subject), subject
    asked = name if found.variant.report else found.entry.name
    own = DocumentPage(found.report, (asked,))
    with answering(about, {own.name: own.write}, fresh=fresh) as subject:
        title, subtitle, written = own.of(subject.source, progress)
        return title, subtitle, chapters_beside(written, subject), subject
