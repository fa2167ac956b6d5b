"""Every extra that a message or a page advises exists."""

from __future__ import annotations

import re
import tomllib
from pathlib import Path

ROOT = Path(__file__).parents[2]


def test_extras_that_are_advised_exist() -> None:
    project = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))["project"]
    known = set(project["optional-dependencies"])
    rooms = [p for p in ROOT.iterdir() if p.is_dir() and (p / "__init__.py").exists()]
    files = [f for room in rooms for f in room.rglob("*.py")]
    files += [*ROOT.glob("*.md"), *(ROOT / "docs").rglob("*.md")]
    advised: dict[str, str] = {}
    for file in files:
        for extras in re.findall(r"strutwork\[([a-z, ]+)\]", file.read_text(encoding="utf-8")):
            advised |= {extra.strip(): file.name for extra in extras.split(",")}
    assert {"cad", "accel"} <= set(advised)
    assert set(advised) <= known, {e: f for e, f in advised.items() if e not in known}
