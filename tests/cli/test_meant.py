"""What was nearly typed right is offered."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

import pytest

import strutwork as sw
from strutwork.errors import ModelError
from strutwork.names import choices
from tests.cli.conftest import Program

ROOT = Path(__file__).parents[2]


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
    with pytest.raises(ModelError, match=r"nor a model file\.\nMachines: "):
        sw.load("lathe")


@pytest.mark.parametrize(
    ("words", "offered"),
    [
        (
            ("frf", "examples/03_tripod.toml", "--input", "TPC:z"),
            'mean "TCP"? Nodes: TCP, ',
        ),
        (("chek", "mit-ss1"), "Did you mean 'check', "),
        (("check", "mit-ss1", "--jsn"), "--json"),
        (
            ("accuracy", "examples/03_tripod.toml", "--play", "drve1:z=5um"),
            'Did you mean "drive1"? Joints: ',
        ),
        (("solve", "examples/03_tripod.toml", "--joint", "drve1:z=5mm"), 'Did you mean "drive1"?'),
    ],
    ids=["node", "command", "option", "joint", "coordinate"],
)
def test_nodes_joints_commands_and_options(
    words: tuple[str, ...], offered: str, strutwork: Program, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(ROOT)
    run = strutwork(*words)
    assert run.status in {1, 2}
    assert offered in run.err


def test_a_name_that_is_there_is_not_asked_for() -> None:
    assert choices("Joints", "screw", ["screw", "screw2"]) == "Joints: screw, screw2."
    assert (
        choices("Nodes", "n", [f"node{i}" for i in range(9)], 3) == "Nodes: node0, node1, node2 …"
    )


COMPLETE = """
eval "$(_STRUTWORK_COMPLETE=source_bash strutwork)"
COMP_WORDS=(strutwork "$@") COMP_CWORD=$#
COMPREPLY=()
_strutwork_completion strutwork
printf '%s\\n' "${COMPREPLY[@]}"
"""


@pytest.mark.parametrize(
    ("words", "offered"),
    [
        (["che"], ["check"]),
        (["check", "glo"], ["glozman-3prrs"]),
        (["check", "examples/04"], ["examples/04_four_bar.toml"]),
        (["solve", "examples/machines/6-u"], ["examples/machines/6-ups.toml"]),
        (["check", "nowhere/a"], []),
        (["solve", "mit-ss1", "--verb"], ["--verbose"]),
    ],
    ids=" ".join,
)
def test_a_shell_completes_commands_machines_files_and_options(
    words: list[str], offered: list[str]
) -> None:
    program = Path(sys.executable).parent
    run = subprocess.run(
        ["/bin/bash", "-c", COMPLETE, "bash", *words],
        cwd=ROOT,
        env={**os.environ, "PATH": f"{program}{os.pathsep}{os.environ['PATH']}"},
        capture_output=True,
        text=True,
        check=True,
    )
    assert run.stdout.split() == offered
