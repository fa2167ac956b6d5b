"""Tolerances of assemblies that can move: spins that no misfit drives, mechanisms, rounding."""

from __future__ import annotations

import json
import re
from typing import Any

import pytest

from tests.cli.conftest import Program
from tests.cli.test_tolerance import DELTA, QUICK, ROOT, K, Write, by_name, plate

CASES = ROOT / "tests" / "cases"


def test_a_free_motion_that_no_misfit_drives_is_no_fault(strutwork: Program, write: Write) -> None:
    """A plate that slides on its four legs is pressed as hard as one that is held."""
    content = plate()
    for joint in content["joints"]:
        joint["stiffness"] = {"z": K}
    found = by_name(strutwork("tolerance", write(content), *QUICK).result)
    assert found["leg0 axial force"]["worst"] == pytest.approx(K * DELTA, rel=1e-9)
    assert found["tool displacement in z"]["worst"] == pytest.approx(DELTA, rel=1e-9)


def test_a_mechanism_names_what_moves(strutwork: Program, write: Write) -> None:
    """Legs that lean shift and tilt the plate, which then moves freely about a distant axis."""
    content = plate()
    for joint, lean in zip(content["joints"], (0.2, 0.2, -0.2, -0.2), strict=True):
        joint["stiffness"] = {"z": K}
        joint["axis"] = [0, lean, 1]
    run = strutwork("tolerance", write(content), *QUICK)
    assert (run.status, run.out) == (1, "")
    assert "mechanism" in run.err
    assert "leg0 in x" in run.err


def test_rounding_is_no_force(strutwork: Program) -> None:
    """Forces that cancel are zero, and zero has no parts."""
    path = str(CASES / "tol" / "flat4.toml")
    found = by_name(strutwork("tolerance", path, *QUICK).result)
    radial = found["b0 radial force"]
    assert (radial["worst"], radial["shares"], radial["contributor"]) == (0.0, None, None)
    shown = strutwork("tolerance", path, "--samples", "0").out
    assert re.search(r"b0 .*radial force .* 0 .* - ", shown)
    assert "e-1" not in shown


@pytest.mark.parametrize(
    "case",
    [c for c in json.loads((CASES / "expected.json").read_text()) if c["what"] == "tol"],
    ids=lambda c: str(c["id"]),
)
def test_forces_of_assemblies_that_can_spin(strutwork: Program, case: dict[str, Any]) -> None:
    found = by_name(strutwork("tolerance", str(CASES / case["file"]), *QUICK).result)
    # the values are given to a hundredth of a newton or a tenth
    worst = {name: found[name]["worst"] for name in case["right"]}
    assert worst == pytest.approx(case["right"], rel=1e-4)
