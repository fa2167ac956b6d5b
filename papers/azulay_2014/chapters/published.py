"""Published tables beside our numbers."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace

from strutwork.papers.azulay_2014.comparison import Model
from strutwork.papers.azulay_2014.machine_study import MODEL_NAMES
from strutwork.papers.published_rows import PublishedRow, file_name
from strutwork.papers.published_table import PublishedTable
from strutwork.papers.tables import beside, numbers, rows_file, texts
from strutwork.reports.content import Block, Column, Points, Table, Text
from strutwork.reports.data_files import DataFile
from strutwork.reports.numbers import significant
from strutwork.reports.pivot import Entry, pivoted

Rows = Mapping[Model, tuple[PublishedRow, ...]]

READING = (
    "Stiffness along an axis is the blocked one, (C⁻¹)_ii: the tool moves along the axis while "
    "its other five directions are held. This is the meaning that agrees with the paper. All "
    "means are called calibrated, close or not: heights of the pole, lengths and the model of "
    "the drives were chosen to match the means of these tables. Nothing was fitted to the "
    "variances; as a set they are not reproduced and are called not reproducible. Nothing is "
    "rescaled."
)


def published_table(table: PublishedTable, rows: Rows) -> tuple[list[Block], DataFile]:
    """A published table beside both joint models, and its file.

    Parameters
    ----------
    table : PublishedTable
    rows : mapping of model to tuple of PublishedRow
        The same rows in the same order for every model.
    """
    file = file_name(table.key)
    notes = dict.fromkeys(
        f"{', '.join(sorted(about))}: {note}." for note, about in _notes(rows).items()
    )
    blocks: list[Block] = [
        _beside(f"{_label(table)} of the paper: {table.title}, blocked; {name}", rows[model], file)
        for model, name in MODEL_NAMES.items()
    ]
    if table.note:
        blocks.append(Text(table.note))
    blocks.append(Points(tuple(notes)))
    return blocks, published_file(table, rows)


def _beside(caption: str, rows: tuple[PublishedRow, ...], file: str) -> Table:
    """Published and computed of every machine side by side, a quantity a row."""
    return pivoted(
        caption,
        (*texts("quantity", "unit"), Column("status", "", False, width="narrow")),
        numbers("published", "computed"),
        [
            Entry(
                [row.quantity, _pretty(row.unit), row.status],
                row.row,
                [significant(row.published, 4), beside(row, significant(row.computed, 4))],
            )
            for row in rows
        ],
        file,
    )


def published_file(table: PublishedTable, rows: Rows) -> DataFile:
    """The rows of both models as CSV; the model stands in the row's name."""
    content = [
        replace(row, row=f"{row.row}, {name}")
        for model, name in MODEL_NAMES.items()
        for row in rows[model]
    ]
    what = f"{_label(table)} of the paper beside the computed values, both joint models"
    return rows_file(file_name(table.key), what, content)


def _label(table: PublishedTable) -> str:
    return "Table " + table.key.rsplit("-", 1)[-1]


def _pretty(unit: str) -> str:
    return unit.replace("N^2/um^2", "N²/µm²").replace("um", "µm")


def _notes(rows: Rows) -> dict[str, list[str]]:
    """Each remark once, with the rows it is about."""
    found: dict[str, list[str]] = {}
    for model in rows:
        for row in rows[model]:
            for part in row.note.split("; ")[1:]:
                about = row.row if "variance" not in part else f"{row.row} {row.quantity}"
                if about not in found.setdefault(part, []):
                    found[part].append(about)
    return found
