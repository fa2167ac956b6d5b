"""A milling cut from a file of its own."""

from __future__ import annotations

from pathlib import Path

from pydantic import ValidationError

from strutwork.machines.described_process import DescribedProcess, process_of
from strutwork.machines.model_errors import model_error
from strutwork.machines.model_file import file_text, toml_of
from strutwork.machines.model_process_schema import ProcessTable

#: Processes of machines of the literature.
DATA = Path(__file__).with_name("data")


def read_process(path: str | Path) -> DescribedProcess:
    """Read a process from a file of its own, whose keys are those of the table [process].

    Parameters
    ----------
    path : str or Path
        A TOML file.

    Raises
    ------
    ModelError
        The file cannot be read, or as `process_of`.
    UnitError
        A quantity of another dimension than its field.
    """
    data = toml_of(file_text(Path(path), "process file"), str(path))
    try:
        table = ProcessTable.model_validate(data)
    except ValidationError as error:
        raise model_error(error, data, str(path), ProcessTable) from None
    found = process_of(table)
    assert found is not None  # noqa: S101 - there is a table
    return found


def known_errors(name: str) -> Path:
    """Where the errors file of a machine of the literature is.

    Parameters
    ----------
    name : str
        As its entry in the catalogue has it.
    """
    return DATA / f"{name}.toml"


def is_known(path: Path) -> bool:
    """Whether a file is one of the package's own, whose values are assumed.

    Parameters
    ----------
    path : Path
    """
    return path.parent == DATA


def known_process(name: str) -> DescribedProcess:
    """A process of the package by its name.

    Parameters
    ----------
    name : str
    """
    return read_process(DATA / f"{name}.toml")
