"""What the docstring of a public function says of its arguments: names, shapes and units.

Of what it returns, the shape: in the first lines or under Returns.

`python -m tests.docstring_rule kinematics meshes/mesh.py` prints what is missing.
"""

from __future__ import annotations

import ast
import re
import sys
from collections.abc import Iterator
from inspect import cleandoc
from pathlib import Path

from numpydoc.docscrape import NumpyDocString

ROOT = Path(__file__).parents[1]

#: Held to the rule. Of `strutwork` only the modules of the ground floor: the rest are links.
PACKAGES = (
    "strutwork",
    "contact",
    "kinematics",
    "meshes",
    "msa",
    "fea",
    "overconstraint",
    "flexures",
    "machines",
    "cutting",
    "studies",
)

#: Names that hold arrays, as annotations write them, and those of them that hold floats.
ARRAY = re.compile(r"\b(Array|ArrayLike|NDArray|Floats|Ints|Indices|Mask|Masks|csc_array)\b")
FLOATS = re.compile(
    r"\bfloat\b|\b(Array|ArrayLike|Floats|csc_array)\b|\bNDArray\[(Any|np\.float\w*|np\.complex\w*)\]"
)

#: (3,), (..., 6, 6), (n + 1,), (p, 2 k), (...); no remark in brackets, as (Stroud 1971, page 3).
_NAME = r"[A-Za-z]\w*"
_TERM = rf"(?:\d+ ?[A-Za-z]\w?|[A-Za-z] [A-Za-z]|{_NAME}|\d+(?: or \d+)?)"
_SIDE = (
    rf"(?:\.\.\.|…|\*{_NAME}|{_TERM}(?: ?[·*+−/^-] ?(?:{_TERM}|\({_TERM} ?[+−-] ?{_TERM}\))){{0,2}}"
    rf"|\d* ?\({_TERM} [+−-] {_TERM}\))"
)
SHAPE = re.compile(
    rf"(?<!/)\((?:\.\.\.|…|\w{{1,4}}|{_SIDE},|{_SIDE}(?:, ?{_SIDE})+,?|)\)"
    r"|any shape|same shape|shapes? of (?:the|`)"
)

_SYMBOL = (
    r"(?:mm|µm|nm|km|m|kN|mN|µN|N|mrad|µrad|rad|rpm|deg|°|kHz|Hz|kg|ms|s|kPa|MPa|GPa|Pa|J|kJ|W|K|°C|%|1)"
    r"(?:[²³⁴⁵⁶]|⁻[¹²³])?"
)
_PRODUCT = rf"(?:{_SYMBOL}|√{_SYMBOL})(?:·{_SYMBOL})*"
UNIT = re.compile(
    rf"(?<![\w`·/.])(?!1(?![/]))(?:{_PRODUCT})(?:/(?:{_PRODUCT}|\({_PRODUCT}\)))*(?![\w`·/²³])"
    r"|(?i:dimensionless|relative|shares?\b|fractions?\b|ratios?\b|orthonormal|rotation matri"
    r"|\bunits\b|unit vectors?|\b(?:no|any|same|its|their|own|one|whose) unit\b|\bunit of the\b"
    r"|\bbool|\bint\b|\bof str\b|\bindices\b|\bbytes\b)"
)

Function = ast.FunctionDef | ast.AsyncFunctionDef


def modules(package: str) -> list[Path]:
    """Public modules of a package: no part of their path begins with an underscore."""
    folder = ROOT / package
    files = folder.glob("*.py") if package == "strutwork" else folder.rglob("*.py")
    return sorted(
        f
        for f in files
        if not any(
            part.startswith("_") and part != "__init__.py" for part in f.relative_to(folder).parts
        )
    )


def exported(package: str) -> set[str]:
    """Names in the `__all__` of a package."""
    for node in ast.parse((ROOT / package / "__init__.py").read_text("utf-8")).body:
        if isinstance(node, ast.Assign) and ast.unparse(node.targets[0]) == "__all__":
            return set(ast.literal_eval(node.value))
    return set()


def arguments(function: Function) -> list[tuple[str, str]]:
    """Names, with the stars that a docstring gives them, and annotations."""
    given = function.args
    plain = [*given.posonlyargs, *given.args]
    starred = [("*", given.vararg)] if given.vararg else []
    doubled = [("**", given.kwarg)] if given.kwarg else []
    listed = [("", a) for a in plain] + starred + [("", a) for a in given.kwonlyargs] + doubled
    return [
        (stars + a.arg, ast.unparse(a.annotation) if a.annotation else "")
        for stars, a in listed
        if a.arg not in {"self", "cls"}
    ]


def fields(kind: ast.ClassDef) -> list[tuple[str, str]]:
    """Public fields of a dataclass that its constructor takes, and their annotations."""
    return [
        (node.target.id, ast.unparse(node.annotation))
        for node in kind.body
        if isinstance(node, ast.AnnAssign)
        and isinstance(node.target, ast.Name)
        and not node.target.id.startswith("_")
        and "ClassVar" not in ast.unparse(node.annotation)
        and not (node.value is not None and "init=False" in ast.unparse(node.value))
    ]


def decorated(node: Function | ast.ClassDef, *names: str) -> bool:
    """Whether a decorator has one of the names."""
    return any(
        re.search(rf"\b{name}\b", ast.unparse(d)) for d in node.decorator_list for name in names
    )


def made_of_fields(kind: ast.ClassDef) -> bool:
    """Whether a class is a dataclass or a named tuple."""
    return decorated(kind, "dataclass") or "NamedTuple" in map(ast.unparse, kind.bases)


def described(docstring: str, *sections: str) -> dict[str, str]:
    """What each argument's entry says, type and text, by name."""
    parsed = NumpyDocString(cleandoc(docstring))
    return {
        name.strip().replace("\\", ""): f"{entry.type}\n{' '.join(entry.desc)}"
        for section in sections
        for entry in parsed[section]
        for name in entry.name.split(",")
    }


def result_lacks_shape(function: Function, docstring: str) -> bool:
    """Whether a function returns arrays and does not say of which shape."""
    returned = ast.unparse(function.returns) if function.returns else ""
    returned = re.sub(r"Callable\[.*\]", "", returned)
    if not ARRAY.search(returned):
        return False
    parsed = NumpyDocString(cleandoc(docstring))
    said = [*parsed["Summary"], *parsed["Extended Summary"]]
    for section in ("Returns", "Yields"):
        said += [part for e in parsed[section] for part in (e.name, e.type, *e.desc)]
    return not SHAPE.search("\n".join(said))


def judge(
    wanted: list[tuple[str, str]], entries: dict[str, str], *, inherits: bool = False
) -> Iterator[str]:
    """What the entries of a section leave out of the arguments."""
    names = [name for name, _ in wanted]
    for name in entries:
        # fields of the class that this one extends stand elsewhere
        if name not in names and not inherits:
            yield f"{name} is described, but no argument."
    for name, annotation in wanted:
        if name not in entries:
            yield f"{name} is not described."
            continue
        text = entries[name]
        # what a function is given or returns is its own matter
        kind = re.sub(r"Callable\[.*\]", "", annotation)
        if ARRAY.search(kind) and not SHAPE.search(text):
            yield f"{name} has no shape."
        if FLOATS.search(kind) and not UNIT.search(SHAPE.sub(" ", text)):
            yield f"{name} has no unit."
    if set(names) == set(entries) and names != list(entries):
        yield f"described in another order than {', '.join(names)}."


def complaints(source: str, public: set[str]) -> Iterator[str]:
    """What a module's docstrings leave out.

    Dataclasses and named tuples describe their fields; other classes whose names are `public`,
    the exported ones, what they are made of.
    """
    for node in ast.parse(source).body:
        if isinstance(node, Function):
            yield from _of_function(node, "")
        elif isinstance(node, ast.ClassDef) and not node.name.startswith("_"):
            if node.name in public or made_of_fields(node):
                yield from _of_class(node)
            for inner in node.body:
                if isinstance(inner, Function):
                    yield from _of_function(inner, f"{node.name}.")


def _of_function(node: Function, prefix: str) -> Iterator[str]:
    if node.name.startswith("_") or decorated(node, "overload", "setter"):
        return
    docstring, wanted = ast.get_docstring(node) or "", arguments(node)
    place = f"{node.lineno}: {prefix}{node.name}"
    if result_lacks_shape(node, docstring):
        yield f"{place}: what it returns has no shape."
    if wanted:
        entries = described(docstring, "Parameters", "Other Parameters")
        for complaint in judge(wanted, entries):
            yield f"{place}: {complaint}"


def _of_class(node: ast.ClassDef) -> Iterator[str]:
    makers = [n for n in node.body if isinstance(n, Function) and n.name == "__init__"]
    if made_of_fields(node):
        wanted = fields(node)
    elif makers:
        wanted = arguments(makers[0])
    else:
        return
    names = {name for name, _ in wanted}
    docstring = ast.get_docstring(node) or ""
    entries = described(docstring, "Parameters", "Other Parameters")
    # what stands among the attributes may also be made afterwards
    also = {k: v for k, v in described(docstring, "Attributes").items() if k in names}
    complete = {name: (entries | also)[name] for name, _ in wanted if name in entries | also}
    for complaint in judge(wanted, complete | entries, inherits=bool(node.bases)):
        yield f"{node.lineno}: {node.name}: {complaint}"


def of_file(path: Path) -> list[str]:
    """Complaints about a file of one of the packages."""
    package = path.relative_to(ROOT).parts[0]
    listed = complaints(path.read_text("utf-8"), exported(package))
    return [f"{path.relative_to(ROOT)}:{complaint}" for complaint in listed]


def main() -> int:
    """Print the complaints about packages and files named on the command line."""
    listed: list[str] = []
    for name in sys.argv[1:] or PACKAGES:
        files = [ROOT / name] if name.endswith(".py") else modules(name)
        listed += [complaint for f in files for complaint in of_file(f)]
    sys.stdout.write("\n".join([*listed, f"{len(listed)} complaints\n"]))
    return 1 if listed else 0


if __name__ == "__main__":
    sys.exit(main())
