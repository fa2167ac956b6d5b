"""What was nearly typed right is offered."""

from __future__ import annotations

from pathlib import Path

import pytest

import strutwork as sw
from strutwork.errors import ModelError
from tests.cli.conftest import Program


@pytest.mark.parametrize(
    ("command", "typed", "meant"),
    [
        ("check", "mit-ss2", "mit-ss1"),
        ("report", "kim-2011", "kim-2001"),
        ("report", "linear_delta", "linear-delta"),
    ],
)
def test_a_machine_or_a_document(command: str, typed: str, meant: str, strutwork: Program) -> None:
    run = strutwork(command, typed)
    assert (run.status, run.out) == (1, "")
    assert f'Did you mean "{meant}"? Machines: ' in run.err


def test_a_file(tmp_path: Path) -> None:
    (tmp_path / "my gantry.toml").write_text("", encoding="utf-8")
    with pytest.raises(ModelError, match=r'Did you mean "my gantry\.toml"\? Check the path'):
        sw.load(tmp_path / "my_gantry.toml")
    with pytest.raises(ModelError, match=r"does not exist\.\nCheck the path"):
        sw.load(tmp_path / "other.toml")


def test_what_is_like_nothing_is_not_guessed() -> None:
    with pytest.raises(ModelError, match=r"no model file\.\nMachines: "):
        sw.load("lathe")
