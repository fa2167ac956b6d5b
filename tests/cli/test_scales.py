"""Sizes and bands out of proportion end in one message, and never in NumPy's words."""

from __future__ import annotations

import re
import warnings
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
from scipy import special

from strutwork.reports.cli import check
from strutwork.reports.cli.ending import OUT_OF_RANGE
from tests.cli.conftest import Program
from tests.model_files import SAMPLE, Content, put, sample

FAR: dict[str, Content] = {
    "one node": sample(put("nodes.C", [1e300, 0.0, 0.0])),
    "all nodes": sample(put("nodes", {n: [1e300] * 3 for n in SAMPLE["nodes"]})),
    "a node in a unit of its own": sample(put("nodes.C", ["1e300 km", 0, 0])),
}
COMMANDS = ("check", "solve", "modes", "frf", "tolerance", "report")


@pytest.mark.parametrize("command", COMMANDS)
@pytest.mark.parametrize("content", FAR.values(), ids=FAR)
def test_nodes_farther_than_any_machine(
    strutwork: Program, write: Callable[[Content], Path], command: str, content: Content
) -> None:
    port = ("--input", "C:x") if command == "frf" else ()
    run = strutwork(command, write(content), *port)
    assert (run.status, run.out) == (1, "")
    assert run.err.startswith("Error: ")
    assert "nodes." in run.err
    assert "the largest that is accepted" in run.err
    assert "Warning" not in run.err


FORK = """
[materials.s]
youngs_modulus = 205e9
poissons_ratio = 0.29
density = 7850
[sections.t]
shape = "tube"
outer_diameter = 0.05
inner_diameter = 0.04
[nodes]
G = [0, 0, 0]
A = [0, 0, 0]
B = [0, 0, {off}]
T = [0.1, 0.2, 0.5]
[[beams]]
name = "b"
from = "B"
to = "T"
material = "s"
section = "t"
[[joints]]
name = "j1"
type = "bushing"
between = ["G", "A"]
stiffness = {{ x = 1e8, y = 1e8, z = 1e8, rx = 1e5, ry = 1e5, rz = 1e5 }}
damping = {{ x = 100, y = 100, z = 100, rx = 1e-3, ry = 1e-3, rz = 1e-3 }}
[[joints]]
name = "j2"
type = "bushing"
between = ["A", "B"]
stiffness = {{ x = 1e9, y = 1e9, z = 1e9, rx = 1e6, ry = 1e6, rz = 1e6 }}
[[supports]]
node = "G"
fixed = "all"
[tool]
tcp = "T"
"""


@pytest.mark.parametrize("off", ["1e-30", "-3e-16", "1e-12"])
def test_a_node_hardly_off_its_joint_changes_nothing(
    strutwork: Program, tmp_path: Path, off: str
) -> None:
    path = tmp_path / "fork.toml"
    found = []
    for place in ("0", off):
        path.write_text(FORK.format(off=place), encoding="utf-8")
        assert strutwork("check", path, "--json").result["mobility"] == 0
        found.append(strutwork("modes", path, "-n", "4", "--json").result["frequencies"])
    # an arm of a picometre beside half a metre
    assert found[1] == pytest.approx(found[0], rel=1e-9)


@pytest.mark.parametrize(("low", "high"), [("0", "1e300"), ("1e299", "1e300"), ("1", "1.1e9")])
@pytest.mark.parametrize("machine", ["mit-ss1", None])
def test_band_where_nothing_vibrates(
    strutwork: Program,
    write: Callable[[Content], Path],
    machine: str | None,
    low: str,
    high: str,
) -> None:
    file = machine or write(SAMPLE)
    run = strutwork("frf", file, "--input", "TCP:x", "--from", low, "--to", high)
    assert (run.status, run.out) == (1, "")
    assert "frequency band: goes up to" in run.err
    assert "1e+09 Hz or below" in run.err


@pytest.mark.parametrize(
    ("option", "value", "part"),
    [
        ("--to", "1e300", "lengths of the struts"),
        ("--to", "inf", "lengths of the struts"),
        ("--from", "1e-300", "lengths of the struts"),
        ("--from", "nan", "lengths of the struts"),
        ("--width-ratio", "1e300", "--width-ratio"),
        ("--width-ratio", "1e-300", "--width-ratio"),
        ("--width-ratio", "nan", "--width-ratio"),
        ("--tilt", "1e300", "--tilt"),
    ],
)
def test_struts_out_of_proportion(strutwork: Program, option: str, value: str, part: str) -> None:
    run = strutwork("scale", "mit-ss1", option, value)
    assert (run.status, run.out) == (1, "")
    assert run.err.startswith(f"Error: {part}: ")
    assert run.err.count("\n") == 2
    assert "Warning" not in run.err


def test_more_modes_than_memory_holds(strutwork: Program, write: Callable[[Content], Path]) -> None:
    file = write(SAMPLE)
    many = strutwork("modes", file, "-n", str(10**21), "--json")
    assert many.result == strutwork("modes", file, "-n", "100", "--json").result
    assert "but only" in many.err


@pytest.mark.parametrize(
    "fails",
    [
        lambda: np.float64(1e300) * np.float64(1e300),
        lambda: np.float64(0.0) / np.float64(0.0),
        lambda: np.ones(2) / np.zeros(2),
        lambda: 1e300**2,
    ],
    ids=["overflow", "invalid value", "division by zero", "overflow of a Python float"],
)
def test_overflow_that_no_check_foresaw_is_withheld(
    strutwork: Program,
    write: Callable[[Content], Path],
    monkeypatch: pytest.MonkeyPatch,
    fails: Callable[[], object],
) -> None:
    monkeypatch.setattr(check, "run", lambda *_: fails())
    run = strutwork("check", write(SAMPLE))
    assert (run.status, run.out) == (1, "")
    assert run.err.startswith("Error: numbers: exceed the range of double precision")
    assert "out of proportion" in run.err


def test_numbers_out_of_range_within_a_library_withhold_nothing(
    strutwork: Program, write: Callable[[Content], Path], monkeypatch: pytest.MonkeyPatch
) -> None:
    # SciPy subtracts infinities on its way
    monkeypatch.setattr(check, "run", lambda *_: softmax_of_infinity())
    run = strutwork("check", write(SAMPLE))
    assert (run.status, run.err) == (0, "")


def softmax_of_infinity() -> None:
    with warnings.catch_warnings(record=True) as said:
        warnings.simplefilter("always")
        special.softmax([np.inf, 0.0])
    assert re.match(OUT_OF_RANGE, str(said[0].message))
    special.softmax([np.inf, 0.0])


def test_other_warnings_are_shown_and_end_nothing(
    strutwork: Program, write: Callable[[Content], Path], monkeypatch: pytest.MonkeyPatch
) -> None:
    def warn(*_: object) -> None:
        warnings.warn("the grid is coarse", UserWarning, stacklevel=1)

    monkeypatch.setattr(check, "run", warn)
    # the tests turn warnings into errors, which the program does not
    with warnings.catch_warnings():
        warnings.simplefilter("default")
        run = strutwork("check", write(SAMPLE))
    assert (run.status, run.err) == (0, "Warning: the grid is coarse\n")
