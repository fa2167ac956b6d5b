"""Every public function with arguments documents them, with shape and unit."""

from __future__ import annotations

import pytest

from tests.docstring_rule import PACKAGES, complaints, modules, of_file

FUNCTION = '''
def stretched(points: Array, factor: float, names: Sequence[str] = (), *rest: int) -> Array:
    """Points moved apart, (n, 3).

    Parameters
    ----------
    {}
    """
'''

COMPLETE = """points : (n, 3)
        m.
    factor : float
        No unit.
    names : sequence of str
        What they are called.
    *rest : int
        Nothing."""


@pytest.mark.parametrize("package", PACKAGES)
def test_a_package_documents_its_arguments(package: str) -> None:
    missing = [complaint for f in modules(package) for complaint in of_file(f)]
    assert not missing, "\n".join(missing)


def test_nothing_is_said_of_a_complete_docstring() -> None:
    assert not list(complaints(FUNCTION.format(COMPLETE), set()))


@pytest.mark.parametrize(
    ("old", "new", "said"),
    [
        ("points : (n, 3)", "points : array", "points has no shape."),
        ("points : (n, 3)", "points : (Stroud 1971, section 2)", "points has no shape."),
        ("m.", "Where they are.", "points has no unit."),
        ("No unit.", "How far.", "factor has no unit."),
        ("No unit.", "Its m counts per unit stretch.", ""),
        ("No unit.", "In m/(N·s).", ""),
        ("No unit.", "What `m` and (m,) and a_m are per unit of stretch.", "factor has no unit."),
        ("names : sequence of str", "name : str", "name is described, but no argument."),
        ("*rest : int", "rest : int", "*rest is not described."),
        ("m.\n    factor : float\n        No unit.", "m.", "factor is not described."),
        ("factor : float", "length, factor : float", "length is described, but no argument."),
        (
            "factor : float\n        No unit",
            "aim : float\n        No unit",
            "factor is not described",
        ),
    ],
)
def test_what_is_left_out_is_named(old: str, new: str, said: str) -> None:
    assert old in COMPLETE
    listed = list(complaints(FUNCTION.format(COMPLETE.replace(old, new)), set()))
    assert any(said in complaint for complaint in listed) if said else not listed


def test_a_function_without_a_section_is_named() -> None:
    source = 'def f(x: int) -> int:\n    """Twice."""\n'
    assert list(complaints(source, set())) == ["1: f: x is not described."]


def test_the_order_is_that_of_the_arguments() -> None:
    factor = "\n    factor : float\n        No unit."
    turned = factor.strip() + "\n    " + COMPLETE.replace(factor, "")
    (complaint,) = complaints(FUNCTION.format(turned), set())
    assert "another order" in complaint


CLASS = '''
@dataclass(frozen=True)
class Bar:
    """A bar.

    Parameters
    ----------
    length : float
        m.
    {}
    """

    length: float
    ends: Array
    _hidden: int = 0
    made: Array = field(init=False)
'''


def test_a_dataclass_describes_its_fields() -> None:
    assert not list(complaints(CLASS.format("ends : (2, 3)\n        m."), set()))
    (complaint,) = complaints(CLASS.format(""), set())
    assert "ends is not described" in complaint


@pytest.mark.parametrize(
    ("docstring", "missing"),
    [
        ("Places.", True),
        ("Places, (n, 3), m.", False),
        ("Places, of the same shape as those before.", False),
        ("Places.\n\n    Returns\n    -------\n    places : (n, 3)\n        m.\n    ", False),
        ("Places.\n\n    Returns\n    -------\n    Array\n        m.\n    ", True),
    ],
)
def test_arrays_that_are_returned_have_a_shape(docstring: str, missing: bool) -> None:
    source = f'def places() -> Array:\n    """{docstring}"""\n'
    listed = list(complaints(source, set()))
    assert listed == ["1: places: what it returns has no shape."] * missing


def test_an_exported_class_describes_what_it_is_made_of() -> None:
    source = "class Deck:\n    def __init__(self, path: Path) -> None: ...\n"
    assert not list(complaints(source, set()))
    (complaint,) = complaints(source, {"Deck"})
    assert "path is not described" in complaint


def test_private_names_and_overloads_are_left_alone() -> None:
    source = "def _f(x: int): ...\nclass _K:\n    def f(self, x): ...\n"
    assert not list(complaints(source + "@overload\ndef g(x: int): ...\n", set()))


def test_every_package_has_modules() -> None:
    assert all(len(modules(package)) > 5 for package in PACKAGES)
