"""`strutwork new`: a commented model file to start from."""

from __future__ import annotations

from pathlib import Path

from strutwork.errors import ModelError
from strutwork.files import write_text
from strutwork.machines.model_templates import template
from strutwork.machines.schema_file import DIRECTIVE, put_beside
from strutwork.names import visible
from strutwork.reports.cli.output import console, print_json


def run(name: str, like: str, *, json: bool) -> None:
    """Write NAME.toml with its schema beside it, and say what to do with it."""
    path = Path(name if name.endswith(".toml") else f"{name}.toml")
    text = template(like, path.stem)
    if path.exists():
        raise ModelError(str(path), "exists.", "Give another name, or move the file away.")
    write_text(path, f"{DIRECTIVE}\n{text}")
    schema = put_beside(path)
    if json:
        print_json({"data": [str(file) for file in (path, schema) if file is not None]})
        return
    out = console()
    out.print(f"Written: {visible(str(path))}", markup=False, soft_wrap=True)
    if schema is not None:
        line = f"Written: {visible(str(schema))}, with which an editor completes the file"
        out.print(line, markup=False, soft_wrap=True)
    for what, command in (
        ("check it", "check"),
        ("move it", "move"),
        ("full report", "report"),
    ):
        line = f"  strutwork {command} {visible(str(path))}"
        out.print(f"{line:40} {what}", markup=False, soft_wrap=True)
