"""A plugin of pytest that notes what verification tests compare, and with which tolerance."""

from __future__ import annotations

import ast
import sys
from collections.abc import Iterator
from dataclasses import dataclass, replace
from functools import lru_cache
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from tests.verification.sources import FOLDER, ROOT


@dataclass(frozen=True)
class Row:
    """One comparison: of a list, the number that takes most of its tolerance."""

    test: str
    quantity: str
    expected: float
    computed: float
    tolerance: float
    reason: str
    count: int

    @property
    def share(self) -> float:
        """How much of the tolerance is taken."""
        return abs(self.computed - self.expected) / self.tolerance if self.tolerance else 0.0


class Recorder:
    """Notes comparisons by `pytest.approx` and `numpy.testing.assert_allclose`."""

    def __init__(self) -> None:
        self._found: dict[tuple[str, str, int], Row] = {}
        self._test = ""

    def rows(self, path: str) -> list[Row]:
        """Comparisons of a file, in the order of its lines."""
        keys = sorted((k for k in self._found if k[0] == path), key=lambda k: k[2])
        return [self._found[k] for k in keys]

    @pytest.hookimpl(wrapper=True)
    def pytest_runtest_call(self, item: pytest.Item) -> Iterator[None]:
        """Listen while a test runs."""
        self._test = item.name.partition("[")[0]
        scalar = type(pytest.approx(1.0))
        plain, close = scalar.__eq__, np.testing.assert_allclose

        def equal(approx: Any, actual: object) -> bool:
            if isinstance(actual, int | float | np.number):
                self._note([actual], [approx.expected], [approx.tolerance])
            return bool(plain(approx, actual))

        def allclose(actual: Any, desired: Any, *args: Any, **options: Any) -> None:
            close(actual, desired, *args, **options)
            relative = args[0] if args else options.get("rtol", 1e-7)
            a, d = np.broadcast_arrays(np.asarray(actual), np.asarray(desired))
            if a.size and np.isrealobj(a) and np.isrealobj(d):
                tolerance = options.get("atol", 0.0) + relative * np.abs(d.astype(float))
                self._note(a.ravel(), d.ravel(), np.broadcast_to(tolerance, a.shape).ravel())

        # what tests call: their modules reach both by attribute
        scalar.__eq__ = equal  # type: ignore[method-assign]
        np.testing.assert_allclose = allclose
        try:
            return (yield)
        finally:
            scalar.__eq__ = plain  # type: ignore[method-assign]
            np.testing.assert_allclose = close

    def _note(self, computed: Any, expected: Any, tolerance: Any) -> None:
        frame: Any = sys._getframe(2)
        while frame is not None and not _is_case(frame.f_code.co_filename):
            frame = frame.f_back
        if frame is None:
            return
        path = Path(frame.f_code.co_filename).relative_to(ROOT).as_posix()
        key = (path, self._test, frame.f_lineno)
        numbers = [
            (float(c), float(e), float(t))
            for c, e, t in zip(computed, expected, tolerance, strict=True)
            if np.isfinite([float(c), float(e)]).all()
        ]
        old = self._found.get(key)
        for c, e, t in numbers:
            quantity, reason = described(path, frame.f_lineno, self._test)
            new = Row(self._test, quantity, e, c, t, reason, 1 + (old.count if old else 0))
            if old is not None and old.share >= new.share:
                new = replace(old, count=new.count)
            old = self._found[key] = new


def _is_case(name: str) -> bool:
    return name.startswith(str(FOLDER)) and Path(name).name.startswith("test_")


@lru_cache
def described(path: str, line: int, test: str) -> tuple[str, str]:
    """What is compared at a line, as the test writes it, and why with this tolerance."""
    text = (ROOT / path).read_text(encoding="utf-8")
    lines, tree = text.splitlines(), ast.parse(text)
    around = [
        node
        for node in ast.walk(tree)
        if isinstance(node, ast.Assert | ast.Expr | ast.Return | ast.Assign)
        and node.lineno <= line <= (node.end_lineno or node.lineno)
    ]
    if not around:
        return "", ""
    node = max(around, key=lambda n: n.lineno)
    named = {n.id for n in ast.walk(node) if isinstance(n, ast.Name) and n.id.isupper()}
    reason = _comment(lines, node.lineno, node.end_lineno or node.lineno)
    constants = [
        n for n in tree.body if isinstance(n, ast.Assign) and isinstance(n.targets[0], ast.Name)
    ]
    for constant in constants:
        tolerances = {n.id for k in _keywords(node) for n in ast.walk(k) if isinstance(n, ast.Name)}
        if not reason and constant.targets[0].id in named & tolerances:  # type: ignore[attr-defined]
            reason = _comment(lines, constant.lineno, constant.end_lineno or constant.lineno)
    if not reason:
        own = next(n for n in tree.body if isinstance(n, ast.FunctionDef) and n.name == test)
        reason = (ast.get_docstring(own) or "").partition("\n\n")[0]
        # else what stands beside the cases of the test
        begin = min([own.lineno, *(d.lineno for d in own.decorator_list)])
        for number in range(begin, own.lineno) if not reason else ():
            if lines[number - 1].strip().startswith("#"):
                reason = lines[number - 1].strip().lstrip("# ")
                break
    return _compared(node, text), reason


def _keywords(node: ast.AST) -> list[ast.expr]:
    calls = [n for n in ast.walk(node) if isinstance(n, ast.Call)]
    return [
        k.value for call in calls for k in call.keywords if k.arg in {"rtol", "atol", "rel", "abs"}
    ]


def _compared(node: ast.stmt, text: str) -> str:
    value: ast.expr | None = None
    if isinstance(node, ast.Assert) and isinstance(node.test, ast.Compare):
        value = node.test.left
    elif isinstance(node, ast.Expr) and isinstance(node.value, ast.Call) and node.value.args:
        value = node.value.args[0]
    found = " ".join((ast.get_source_segment(text, value or node) or "").split())
    return found if len(found) <= 70 else found[:67] + "..."


def _comment(lines: list[str], first: int, last: int) -> str:
    """The comment lines above a statement, or the remark at its end."""
    found: list[str] = []
    at = first - 2
    while at >= 0 and lines[at].strip().startswith("#"):
        found.insert(0, lines[at].strip().lstrip("#: "))
        at -= 1
    if not found:
        _, mark, remark = lines[last - 1].partition("  # ")
        if mark and not remark.startswith(("noqa", "type:", "fmt:")):
            found.append(remark)
    return " ".join(found)
