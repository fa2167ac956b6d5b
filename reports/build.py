"""Writing a report: from its target to a folder with the page and its data."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import partial
from pathlib import Path

from strutwork import __version__
from strutwork.errors import ModelError
from strutwork.reports.content import Chapter, Page
from strutwork.reports.data_files import DataFile
from strutwork.reports.machine_study import Teller
from strutwork.reports.page import render
from strutwork.reports.report_folder import PAGE, require_ours, write_set

#: The comparison of the four machines of the paper.
COMPARISON = "azulay-2014"

#: A planar machine: its report is about the forces that its assembly locks in.
PLANAR = "mit-ss1"

#: A hexapod beside that machine.
HEXAPOD = "hexel-hexapod"

#: A machine of which nothing is printed to stand beside.
PROTOTYPE = "prototype-3ppprs"


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


def write_report(target: str, folder: Path, progress: Teller | None = None) -> WrittenReport:
    """Compute and write a report.

    Parameters
    ----------
    target : str
        A machine of the catalogue, "azulay-2014" for the comparison of its four machines, or
        the path of a model file.
    folder : Path
        Made when missing. An earlier report in it is replaced, all of it; other files stay.
    progress : callable, optional
        Given the name of a part of the work, returns what is told how far it is.

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
    page, files = _contents(target, progress)
    text = render(page)
    write_set(
        folder,
        {
            **{file.name: file.write for file in files},
            PAGE: lambda path: path.write_text(text, encoding="utf-8"),
        },
    )
    return WrittenReport(folder / PAGE, tuple(folder / file.name for file in files))


def _contents(target: str, progress: Teller | None) -> tuple[Page, tuple[DataFile, ...]]:
    from strutwork.machines.catalogue import CATALOGUE
    from strutwork.machines.variants import MARK, is_machine

    make: Callable[[], tuple[str, str, tuple[Chapter, ...]]]
    if target == COMPARISON:
        from strutwork.reports.comparison_report import comparison_chapters

        make = partial(comparison_chapters, progress)
    elif target == PROTOTYPE:
        from strutwork.reports.prototype_report import prototype_chapters

        make = partial(prototype_chapters, progress)
    elif target == PLANAR:
        from strutwork.reports.mit_ss1_report import mit_ss1_chapters

        make = partial(mit_ss1_chapters, progress)
    elif target == HEXAPOD:
        from strutwork.reports.hexapod_report import hexapod_chapters

        make = partial(hexapod_chapters, progress)
    elif is_machine(target) and MARK in target:
        raise ModelError(
            f"report {target}",
            "names one model, and a machine's report shows all of them beside each other.",
            f"Leave the variant out: {target.partition(MARK)[0]}.",
        )
    elif target in CATALOGUE:
        from strutwork.reports.machine_report import machine_chapters

        make = partial(machine_chapters, target, progress)
    elif Path(target).suffix == ".toml" or Path(target).exists():
        from strutwork.reports.model_report import model_chapters

        make = partial(model_chapters, Path(target), progress)
    else:
        raise ModelError(
            f"report {target}",
            "is no machine of the catalogue and no model file.",
            f"Machines: {', '.join(CATALOGUE)}; comparison: {COMPARISON}; or the path of a TOML "
            "file.",
        )
    title, subtitle, chapters = make()
    footer = f"Made by Strutwork {__version__}. This page needs no network."
    files = tuple(f for chapter in chapters for f in chapter.files)
    return Page(title, subtitle, chapters, footer), files
