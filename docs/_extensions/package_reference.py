"""A page of reference per package: every name that it exports, from the docstrings."""

from __future__ import annotations

import inspect
import re
from importlib import import_module
from typing import Any, get_origin

from docutils import nodes
from sphinx.addnodes import pending_xref
from sphinx.application import Sphinx
from sphinx.environment import BuildEnvironment
from sphinx.ext.napoleon import NumpyDocstring
from sphinx.pycode import ModuleAnalyzer
from sphinx.util.docutils import SphinxDirective

#: Kinds of names, in the order of a page, and the directive that documents one.
KINDS = {
    "Functions": "autofunction",
    "Classes": "autoclass",
    "Errors and warnings": "autoexception",
    "Constants": "py:data",
}


def kind_of(value: object) -> str:
    """Under which heading a name stands."""
    if inspect.isclass(value):
        return "Errors and warnings" if issubclass(value, BaseException) else "Classes"
    # a union of types, as an alias, can be called but is no function
    return "Functions" if callable(value) and get_origin(value) is None else "Constants"


def constant(package: str, name: str) -> list[str]:
    """The entry of a constant, from the comment before it in the file that defines it."""
    text = inspect.getsource(import_module(package))
    come = re.search(rf"^from ([\w.]+) import (?:[^()\n]*|\([^)]*)\b{name}\b", text, re.MULTILINE)
    home = come[1] if come else package
    comments = ModuleAnalyzer.for_module(home).find_attr_docs()
    said = comments.get(("", name), [])
    return ["", f".. py:data:: {name}", "", *(f"   {line}" for line in said)]


def reference(package: str, further: tuple[str, ...] = ()) -> list[str]:
    """ReStructuredText of a package's page.

    Parameters
    ----------
    package : str
    further : tuple of str
        Names below the package that belong on the page although it does not export them.
    """
    module = import_module(package)
    names: dict[str, list[str]] = {kind: [] for kind in KINDS}
    for name in module.__all__:
        if name != "__version__":
            names[kind_of(getattr(module, name))].append(name)
    for name in further:
        where, _, short = name.rpartition(".")
        names[kind_of(getattr(import_module(f"{package}.{where}"), short))].append(name)
    lines = [f".. py:module:: {package}", "", *inspect.cleandoc(module.__doc__ or "").splitlines()]
    for kind, found in names.items():
        if not found:
            continue
        lines += ["", kind, "-" * len(kind), ""]
        if kind != "Constants":
            lines += [".. autosummary::", "   :nosignatures:", ""]
            lines += [f"   {name}" for name in found]
        for name in found:
            if kind == "Constants":
                lines += constant(package, name)
                continue
            lines += ["", f".. {KINDS[kind]}:: {package}.{name}"]
            if kind == "Classes":
                lines += ["   :members:"]
    return [*lines, ""]


class PackageReference(SphinxDirective):
    """`package-reference` with the name of a package, and of further classes below it."""

    required_arguments = 1
    has_content = True

    def run(self) -> list[nodes.Node]:
        """Parse the page."""
        package = self.arguments[0]
        text = reference(package, tuple(line.strip() for line in self.content if line.strip()))
        for file in {getattr(import_module(package), "__file__", None)} - {None}:
            self.env.note_dependency(str(file))
        # written in reStructuredText, whatever the page is written in
        return self.parse_text_to_nodes("\n".join(text), allow_section_headings=True)


def as_text(
    app: Sphinx, what: str, name: str, value: object, options: Any, lines: list[str]
) -> None:
    """Keep what a docstring says from being read as something else."""
    # the bars of an absolute value are no substitution; every second part stands between backticks
    parts = "\n".join(lines).split("`")
    parts[::2] = [part.replace("|", "\\|") for part in parts[::2]]
    lines[:] = "`".join(parts).splitlines()
    if what in {"property", "attribute"}:
        # napoleon takes the words before a colon for a type and knows no sections here: it gets
        # the text as that of a method, and then, after an empty comment, as it is
        method = NumpyDocstring(lines, app.config, app, "method", name, value, options)
        lines[:] = ["..", "", *method.lines()]


def as_code(
    _app: Sphinx, _env: BuildEnvironment, node: pending_xref, content: nodes.Element
) -> nodes.Element | None:
    """A name between backticks that is no entry of the site stays what it is: code."""
    if node.get("reftype") == "obj" and node.get("refdomain") == "py":
        return content
    return None


def setup(app: Sphinx) -> dict[str, Any]:
    """Register the directive."""
    app.add_directive("package-reference", PackageReference)
    # before napoleon, which has 500
    app.connect("autodoc-process-docstring", as_text, priority=400)
    app.connect("missing-reference", as_code)
    return {"version": "1", "parallel_read_safe": True, "parallel_write_safe": True}
