from __future__ import annotations

import ast
from pathlib import Path

import pytest
from rich.text import Text

from strutwork import __version__
from strutwork.machines.catalogue import CATALOGUE
from tests.cli.conftest import Program


@pytest.mark.parametrize(
    "arguments",
    [
        ["nonsense"],
        ["check"],
        ["check", "a.toml", "b.toml"],
        ["check", "a.toml", "--jsn"],
        ["--nonsense"],
    ],
)
def test_wrong_usage_has_status_2(arguments: list[str], strutwork: Program) -> None:
    run = strutwork(*arguments)
    assert (run.status, run.out) == (2, "")
    assert "Usage" in run.err


def test_help_lists_the_commands(strutwork: Program) -> None:
    run = strutwork("--help")
    assert (run.status, run.err) == (0, "")
    for command in ("machines", "check", "solve", "map", "report"):
        assert command in run.out


@pytest.mark.parametrize("command", ["machines", "check", "solve", "map", "report"])
def test_help_of_a_command(command: str, strutwork: Program) -> None:
    run = strutwork(command, "--help")
    assert (run.status, run.err) == (0, "")
    assert "--json" in run.out


def test_help_shows_names_of_tables() -> None:
    """A name in brackets is an instruction to the library that prints help, unless escaped."""
    folder = Path(__file__).parents[2] / "reports" / "cli"
    helps = [
        keyword.value.value
        for path in sorted(folder.glob("*.py"))
        for node in ast.walk(ast.parse(path.read_text(encoding="utf-8")))
        if isinstance(node, ast.Call)
        for keyword in node.keywords
        if keyword.arg == "help" and isinstance(keyword.value, ast.Constant)
    ]
    assert len(helps) > 100
    escaped = [text for text in helps if r"\[" in text]
    assert len(escaped) >= 5
    lost = [t for t in helps if Text.from_markup(t).plain != t.replace(r"\[", "[")]
    assert lost == []


def test_version(strutwork: Program) -> None:
    run = strutwork("--version")
    assert (run.status, run.out) == (0, f"strutwork {__version__}\n")


def test_machines(strutwork: Program) -> None:
    listed = strutwork("machines", "--json").result["machines"]
    assert [entry["name"] for entry in listed] == list(CATALOGUE)
    assert all(set(entry) == {"name", "title", "topology", "paper", "variants"} for entry in listed)
    run = strutwork("machines")
    assert run.status == 0
    for entry in listed:
        assert entry["name"] in run.out
    assert "Azulay" in run.out


def test_narrow_tables_keep_every_digit(
    strutwork: Program, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("COLUMNS", "50")
    example = Path(__file__).parents[2] / "examples" / "01_cantilever.toml"
    run = strutwork("solve", example)
    assert run.status == 0
    assert "…" not in run.out
