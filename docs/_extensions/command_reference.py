"""The page of the command line: every command with its options, as the program itself has them."""

from __future__ import annotations

import re
from enum import Enum
from typing import Any

import typer
from docutils import nodes
from sphinx.application import Sphinx
from sphinx.util.docutils import SphinxDirective

from strutwork.reports.cli.app import app as program

#: An option, a placeholder or a value in a help text, which is shown as code.
CODE = re.compile(
    r"(?<![\w`=:])(--[a-z][\w-]*(?: [\w.:]+=[^\s;]*[^\s;.,:])?"
    r"|[A-Z]{3,}(?::[A-Z]+)*(?:_[A-Z]+)*)(?!\w)"
)
#: Upper-case words that are no placeholders.
WORDS = {"CSV", "JSON", "NPZ", "MAC", "STL", "PLY", "UFF", "HTML", "SVG", "PDF", "TOML", "STEP"}


def prose(text: str) -> str:
    """A help text as reStructuredText."""
    plain = re.sub(r"([\\*`|_])", r"\\\1", " ".join(text.split()))

    def marked(word: re.Match[str]) -> str:
        bare = word[0].replace("\\", "")
        return bare if bare in WORDS else f"``{bare}``"

    return CODE.sub(marked, plain)


def value_of(option: Any) -> str:
    """What an option takes, as its signature shows it; nothing for a switch."""
    if getattr(option, "is_flag", False):
        return ""
    kind = getattr(getattr(option, "type_descriptor", None), "annotation", None)
    if isinstance(kind, type) and issubclass(kind, Enum):
        return " " + "|".join(str(one.value) for one in kind)
    if option.metavar:
        return f" {option.metavar}"
    return {int: " N", float: " NUMBER"}.get(kind, " TEXT")  # type: ignore[call-overload]


def remarks(option: Any) -> list[str]:
    """Bounds and default of an option, each a sentence."""
    found = []
    if option.required:
        found.append("Required.")
    low, high = getattr(option, "min", None), getattr(option, "max", None)
    if low is not None and high is not None:
        found.append(f"From {low} to {high}.")
    elif low is not None:
        found.append(f"At least {low}.")
    default = option.default
    if default not in {None, False, ()} and not callable(default) and option.show_default:
        default = default.value if isinstance(default, Enum) else default
        found.append(f"Default: ``{default}``.")
    return found


def entry(name: str, command: Any) -> list[str]:
    """The section of one command."""
    title = f"strutwork {name}"
    arguments = [p for p in command.params if not p.opts[0].startswith("-")]
    options = [p for p in command.params if p.opts[0].startswith("-")]
    used = " ".join(
        (p.metavar or p.name.upper()) if p.required else f"[{p.metavar or p.name.upper()}]"
        for p in arguments
    )
    needed = " ".join(f"{p.opts[0]}{value_of(p)}" for p in options if p.required)
    usage = " ".join(word for word in (title, used, needed, "[OPTIONS]") if word)
    lines = ["", title, "-" * len(title), ""]
    for paragraph in (command.help or "").split("\n\n"):
        lines += [prose(paragraph), ""]
    lines += [".. code-block:: text", "", f"   {usage}", "", f".. program:: {title}", ""]
    for one in arguments:
        label = one.metavar or one.name.upper()
        lines += [f".. option:: {label}", "", f"   {prose(one.help or '')}", ""]
    for one in options:
        names = ", ".join(f"{opt}{value_of(one)}" for opt in one.opts)
        text = " ".join([prose(one.help or ""), *remarks(one)])
        lines += [f".. option:: {names}", "", f"   {text}", ""]
    return lines


def reference() -> list[str]:
    """ReStructuredText of all commands, in alphabetical order."""
    group: Any = typer.main.get_command(program)
    lines = [".. program:: strutwork", ""]
    for name, command in sorted(group.commands.items()):
        if not command.hidden:
            lines += entry(name, command)
    return lines


class CommandReference(SphinxDirective):
    """`command-reference`: the sections of all commands."""

    def run(self) -> list[nodes.Node]:
        """Parse them."""
        return self.parse_text_to_nodes("\n".join(reference()), allow_section_headings=True)


def setup(app: Sphinx) -> dict[str, Any]:
    """Register the directive."""
    app.add_directive("command-reference", CommandReference)
    return {"version": "1", "parallel_read_safe": True, "parallel_write_safe": True}
