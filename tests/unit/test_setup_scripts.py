"""The set-up asks before it installs anything on the system, and never uses sudo in silence.

apt-get, sudo and id are stand-ins that write down how they were called.
"""

from __future__ import annotations

import os
import pty
import subprocess
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]
SCRIPT = f'. "{ROOT}/scripts/environment.sh"; debian_install "The Thing" thing thing-dev; echo on'
DONE = ["apt-get update -qq", "apt-get install -y -qq --no-install-recommends thing thing-dev"]


class Setup:
    """A system of stand-ins: `user` runs the script, perhaps with sudo."""

    def __init__(self, folder: Path, *, root: bool, sudo: bool = True) -> None:
        self.log = folder / "log"
        self.log.touch()
        self.path = folder / "bin"
        self.path.mkdir()
        self._make("id", f"echo {0 if root else 1000}")
        self._make("apt-get", f'echo "apt-get $*" >>"{self.log}"')
        if sudo:
            self._make("sudo", f'echo sudo >>"{self.log}"; exec "$@"')
        # only these: an apt-get or a sudo of the system must not be found
        for tool in ("sh", "env"):
            (self.path / tool).symlink_to(f"/usr/bin/{tool}")

    def _make(self, name: str, body: str) -> None:
        tool = self.path / name
        tool.write_text(f"#!/bin/sh\n{body}\n")
        tool.chmod(0o755)

    def _start(self, stdin: int, stderr: int, allowed: str | None) -> subprocess.Popen[str]:
        env = {"PATH": str(self.path)}
        if allowed is not None:
            env["STRUTWORK_INSTALL"] = allowed
        return subprocess.Popen(
            ["/bin/sh", "-euc", SCRIPT],
            env=env,
            stdin=stdin,
            stdout=subprocess.PIPE,
            stderr=stderr,
            text=True,
        )

    def batch(self, allowed: str | None = None) -> tuple[int, str]:
        """Run with standard input from nowhere: status and messages."""
        child = self._start(subprocess.DEVNULL, subprocess.PIPE, allowed)
        out, err = child.communicate(timeout=60)
        assert (out == "on\n") == (child.returncode == 0)
        return child.returncode, err

    def terminal(self, answer: str) -> tuple[int, str]:
        """Run at a terminal where `answer` is typed: status and what the terminal showed."""
        ours, theirs = pty.openpty()
        os.write(ours, answer.encode())
        child = self._start(theirs, theirs, None)
        os.close(theirs)
        shown = b""
        while True:
            try:
                piece = os.read(ours, 4096)
            except OSError:  # Linux's word for the end of a terminal
                break
            if not piece:
                break
            shown += piece
        child.communicate(timeout=60)
        os.close(ours)
        return child.returncode, shown.decode()

    def calls(self) -> list[str]:
        return self.log.read_text().splitlines()


@pytest.mark.parametrize("root", [True, False])
@pytest.mark.parametrize(
    ("answer", "agreed"),
    [
        ("y\n", True),
        ("Yes\n", True),
        ("n\n", False),
        ("\n", False),
        ("why\n", False),
        ("\x04", False),
    ],
)
def test_at_a_terminal_it_asks(tmp_path: Path, root: bool, answer: str, agreed: bool) -> None:
    setup = Setup(tmp_path, root=root)
    status, shown = setup.terminal(answer)
    assert "The Thing is missing" in shown
    assert "packages: thing thing-dev" in shown
    assert ("with sudo? [y/N]" in shown) != root
    assert "[y/N]" in shown
    if agreed:
        assert status == 0
        assert [c for c in setup.calls() if c != "sudo"] == DONE
        assert setup.calls().count("sudo") == (0 if root else 2)
    else:
        assert status == 1
        assert setup.calls() == []
        assert "apt-get install -y thing thing-dev" in shown


def test_without_a_terminal_root_installs(tmp_path: Path) -> None:
    setup = Setup(tmp_path, root=True)
    status, messages = setup.batch()
    assert status == 0
    assert setup.calls() == DONE
    assert "Installing The Thing (Debian packages: thing thing-dev)" in messages


@pytest.mark.parametrize("allowed", [None, "", "no", "1"])
def test_without_a_terminal_sudo_is_not_used(tmp_path: Path, allowed: str | None) -> None:
    setup = Setup(tmp_path, root=False)
    status, messages = setup.batch(allowed)
    assert status == 1
    assert setup.calls() == []
    assert "apt-get update && apt-get install -y thing thing-dev" in messages
    assert "STRUTWORK_INSTALL=yes" in messages


def test_sudo_where_it_was_allowed(tmp_path: Path) -> None:
    setup = Setup(tmp_path, root=False)
    status, _ = setup.batch("yes")
    assert status == 0
    assert setup.calls() == ["sudo", DONE[0], "sudo", DONE[1]]


def test_nobody_to_install(tmp_path: Path) -> None:
    setup = Setup(tmp_path, root=False, sudo=False)
    status, messages = setup.batch("yes")
    assert status == 1
    assert setup.calls() == []
    assert "takes root rights" in messages


def test_what_a_build_runs_has_no_terminal() -> None:
    for name in ("run", "nightly"):
        assert "</dev/null" in (ROOT / ".ci" / name).read_text(encoding="utf-8")
