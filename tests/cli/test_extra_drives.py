"""Machines that are named with their drives go through the commands."""

from __future__ import annotations

import json
import subprocess
import sys

import pytest


@pytest.mark.parametrize(
    ("command", "name"),
    [
        ("check", "eclipse-prototype:8"),
        ("solve", "eclipse-machine:7b"),
        ("modes", "eclipse-machine:6"),
    ],
)
def test_a_command_takes_them(command: str, name: str) -> None:
    done = subprocess.run(
        [sys.executable, "-m", "strutwork", command, name, "--json"],
        capture_output=True,
        text=True,
        check=False,
    )
    assert done.returncode == 0, done.stderr
    assert json.loads(done.stdout)
