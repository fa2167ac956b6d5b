"""Reading a model file: from a path to a structure in one configuration."""

from __future__ import annotations

import stat
import tomllib
from pathlib import Path
from typing import Any

from pydantic import ValidationError

from strutwork.errors import ModelError
from strutwork.machines.model import Model
from strutwork.machines.model_builder import build_model
from strutwork.machines.model_errors import model_error
from strutwork.machines.model_schema import RARE, ModelTable
from strutwork.names import meant
from strutwork.stages import stage

#: Model files beside one that is missing, among which the nearest name is looked for.
FILES_BESIDE = 1000
#: A larger file is no description of a structure that a person wrote, bytes.
MAX_BYTES = 10_000_000


def read_model(path: str | Path) -> Model:
    """Read a model file.

    Parameters
    ----------
    path : str or Path
        A TOML file in UTF-8, 10 MB at most; its tables are those of docs/model-file.md.

    Returns
    -------
    Model
        The structure, its placement (one pose, no batch axes) and its load cases.

    Raises
    ------
    ModelError
        The file cannot be read, or its content is wrong; names the field or the part.
    UnitError
        A quantity of another dimension than its field.

    Warns
    -----
    ModelWarning
        poissons_ratio and shear_modulus of a material that contradict one another.
    """
    return parse_model(file_text(Path(path)), str(path), Path(path).parent)


def read_tables(path: str | Path) -> ModelTable:
    """Read the tables of a model file, checked one by one; nothing is built from them.

    Parameters
    ----------
    path : str or Path
        As `read_model`.

    Raises
    ------
    ModelError, UnitError
        As `read_model`, but for what depends on several tables.
    """
    return parse_tables(file_text(Path(path)), str(path))


def parse_model(text: str, source: str = "model", folder: Path | None = None) -> Model:
    """Read a model from the text of a model file.

    Parameters
    ----------
    text : str
    source : str
        Named in messages.
    folder : Path, optional
        Where the names of solids' files begin; by default the working directory.
    """
    tables = parse_tables(text, source)
    with stage(f"builds the model of {source}"):
        return build_model(tables, Path() if folder is None else folder)


def parse_tables(text: str, source: str = "model") -> ModelTable:
    """The tables in the text of a model file, checked one by one.

    Parameters
    ----------
    text : str
    source : str
        Named in messages.

    Raises
    ------
    ModelError, UnitError
        As `read_tables`.
    """
    return checked_tables(toml_of(text, source), source)


def checked_tables(data: dict[str, Any], source: str = "model") -> ModelTable:
    """Tables as TOML holds them, checked one by one.

    Parameters
    ----------
    data : dict
        Quantities as numbers in SI or texts with a unit.
    source : str
        Named in messages.

    Raises
    ------
    ModelError, UnitError
        As `read_tables`.
    """
    schema = ModelTable if RARE.isdisjoint(data) else _complete()
    try:
        return schema.model_validate(data)
    except ValidationError as error:
        raise model_error(error, data, source, schema) from None


def _complete() -> type[ModelTable]:
    # a tenth of the time of a small command, which most files spare
    from strutwork.machines import model_complete_schema  # noqa: PLC0415

    return model_complete_schema.ModelTable


def toml_of(text: str, source: str, page: str = "docs/model-file.md") -> dict[str, Any]:
    """The content of a TOML file.

    Parameters
    ----------
    text : str
    source : str
        Named in messages.
    page : str
        Where the file is described.

    Raises
    ------
    ModelError
        It is no TOML.
    """
    try:
        return tomllib.loads(text)
    except RecursionError:
        raise ModelError(source, "is nested too deeply.", "Write plain tables.") from None
    # tomllib reports an integer of thousands of digits as a plain ValueError
    except ValueError as error:
        if text.lstrip().startswith("<"):
            raise ModelError(
                source,
                "is XML, not TOML.",
                f"If it is a robot file, write a model file of it: strutwork convert {source} "
                "model.toml",
            ) from None
        raise ModelError(
            source, f"is not TOML: {error}.", f"Correct the line, or see {page}."
        ) from None


def file_text(path: Path, what: str = "model file") -> str:
    """The text of a small file in UTF-8.

    Parameters
    ----------
    path : Path
    what : str
        What it should be, for messages.

    Raises
    ------
    ModelError
        It is missing, no file, too large, not to be read, or not UTF-8.
    """
    try:
        status = path.stat()
        if not stat.S_ISREG(status.st_mode):
            kind = "a directory" if stat.S_ISDIR(status.st_mode) else "not an ordinary file"
            raise ModelError(str(path), f"is {kind}.", f"Name a {what}.")
        if status.st_size > MAX_BYTES:
            raise ModelError(
                str(path),
                f"has {status.st_size / 1e6:.0f} MB, more than the {MAX_BYTES / 1e6:.0f} MB a "
                f"{what} may have.",
                f"Check that it is a {what}.",
            )
        content = path.read_bytes()
    except FileNotFoundError:
        beside = [p.name for p in path.parent.glob("*.toml")] if path.parent.is_dir() else []
        question = meant(path.name, beside[:FILES_BESIDE])
        raise ModelError(str(path), "does not exist.", f"{question}Check the path.") from None
    except (OSError, ValueError) as error:
        reason = error.strerror if isinstance(error, OSError) else str(error)
        raise ModelError(str(path), f"cannot be read ({reason}).", "Check the path.") from None
    try:
        # some editors put a byte-order mark first, which TOML does not know
        return content.decode("utf-8-sig")
    except UnicodeDecodeError as error:
        raise ModelError(
            str(path),
            f"is not UTF-8: byte {error.start} is 0x{content[error.start]:02x}.",
            "Save it as UTF-8 text.",
        ) from None
