"""Messages for what is wrong in a model file."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, get_args

from pydantic import BaseModel, ValidationError

from strutwork.errors import ModelError, UnitError
from strutwork.machines.model_schema import ModelTable
from strutwork.names import meant
from strutwork.units import shown

if TYPE_CHECKING:
    from pydantic_core import ErrorDetails

_LISTED = 10


def model_error(
    error: ValidationError,
    data: dict[str, Any],
    source: str,
    schema: type[BaseModel] = ModelTable,
    page: str = "docs/model-file.md",
) -> ModelError:
    """Turn what pydantic found into one error that names the fields.

    Parameters
    ----------
    error : ValidationError
    data : dict
        The content that was validated; gives the names of list entries.
    source : str
        The file, named when there are several problems.
    schema : type of BaseModel
        What the content was validated by.
    page : str
        Where its keys are described.

    Returns
    -------
    ModelError
        A UnitError when only quantities are wrong.
    """
    found = [
        _problem(details, data, schema, page)
        for details in error.errors(include_url=False, include_input=True)
    ]
    if len(found) == 1:
        kind, field, problem, remedy = found[0]
        return kind(field, problem, remedy)
    lines = [f"  {field}: {problem} {remedy}" for _, field, problem, remedy in found[:_LISTED]]
    if len(found) > _LISTED:
        lines.append(f"  and {len(found) - _LISTED} more")
    kind = UnitError if all(item[0] is UnitError for item in found) else ModelError
    return kind(source, f"has {len(found)} problems:\n" + "\n".join(lines))


def _problem(
    details: ErrorDetails, data: dict[str, Any], schema: type[BaseModel], page: str
) -> tuple[type[ModelError], str, str, str]:
    kind, context, found = details["type"], details.get("ctx", {}), details["input"]
    loc = tuple(details["loc"])
    field = _path(loc, data)
    problem, remedy = f"{shown(found)} is wrong.", f"{details['msg']}."
    match kind:
        case "unit" | "range":
            problem, remedy = context["problem"], context["remedy"]
        case "missing":
            problem, remedy = "is missing.", "Add it."
            if len(loc) == 1 and _is_array_of_tables(str(loc[0]), schema):
                remedy = f"Add a table [[{loc[0]}]]."
        case "extra_forbidden":
            problem, remedy = "is not a known key.", _nearest(loc, schema, page)
        case "tuple_type" | "list_type":
            problem = f"is {shown(found)} where a list is expected."
            remedy = "Write it in brackets [ ]."
            if len(loc) == 1 and _is_array_of_tables(str(loc[0]), schema):
                remedy = f"Write [[{loc[0]}]] with two brackets."
        case "dict_type" | "model_type" | "model_attributes_type":
            problem = f"is {shown(found)} where a table is expected."
            remedy = "Write key = value within it."
            if len(loc) == 1:
                remedy = f"Write [{loc[0]}] with one bracket."
        case "too_long" | "too_short":
            problem, remedy = f"{details['msg']}.", "Give as many entries as expected."
        case "literal_error" | "union_tag_invalid":
            choices = context.get("expected") or context.get("expected_tags")
            wrong = found if kind == "literal_error" else context["tag"]
            field += "" if kind == "literal_error" else _tag(context)
            problem, remedy = f"{shown(wrong)} is not known.", f"Choose one of: {choices}."
        case "union_tag_not_found":
            field, problem = f"{field}{_tag(context)}", "is missing."
            remedy = "Name the shape of the section."
            if loc[0] == "flexures":
                remedy = "Name the shape of the flexure."
            if loc[0] == "bearings":
                remedy = "Name the type of the bearing, or stiffness."
    return (UnitError if kind == "unit" else ModelError), field, problem, remedy


def _path(loc: tuple[int | str, ...], data: dict[str, Any]) -> str:
    """Dotted path of a field; entries of lists go by their name where they have one."""
    path = ""
    at: Any = data
    for step in loc:
        if isinstance(step, int):
            at = at[step] if isinstance(at, list) and step < len(at) else None
            name = at.get("name") if isinstance(at, dict) else None
            path += f".{name}" if isinstance(name, str) and name else f"[{step}]"
            continue
        # pydantic puts the word [key] and the shape of a section into its path
        is_shape = (
            isinstance(at, dict) and step in (at.get("shape"), at.get("type")) and step not in at
        )
        if step == "[key]" or is_shape:
            continue
        path += f".{step}" if path else step
        at = at.get(step) if isinstance(at, dict) else None
    return path


def _tag(context: dict[str, Any]) -> str:
    """The key that tells tables of one kind apart, as the end of a path."""
    return "." + str(context["discriminator"]).strip("'")


def _is_array_of_tables(key: str, schema: type[BaseModel]) -> bool:
    return get_args(schema.model_fields[key].annotation)[-1:] == (Ellipsis,)


def _nearest(loc: tuple[int | str, ...], schema: type[BaseModel], page: str) -> str:
    """Remedy for an unknown key: the nearest key that its table knows."""
    top = schema.model_fields
    known = list(top) if len(loc) == 1 else sorted(_keys(top[str(loc[0])].annotation))
    question = meant(str(loc[-1]), known).rstrip()
    return question or f"Remove it, or check its spelling in {page}."


def _keys(annotation: Any) -> set[str]:
    """Keys of every table within a type."""
    if isinstance(annotation, type) and issubclass(annotation, BaseModel):
        fields = annotation.model_fields
        found = {field.alias or name for name, field in fields.items()}
        return found.union(*(_keys(field.annotation) for field in fields.values()))
    return set().union(*(_keys(part) for part in get_args(annotation)))
