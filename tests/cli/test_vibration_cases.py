"""`strutwork modes` and `frf` on inputs that once failed or told rounding."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest

from tests.cli.conftest import Program
from tests.model_files import Content

CASES = Path(__file__).parents[1] / "cases"
Write = Callable[[Content], Path]


@pytest.mark.parametrize("count", [1, 3, 6, 7, 10, 60])
def test_fewer_modes_than_rigid_body_modes(strutwork: Program, count: int) -> None:
    run = strutwork("modes", CASES / "models/f5_modes_n3_traceback.toml", "-n", count, "--json")
    found = run.result
    assert found["rigid_body_modes"] == 6
    assert found["frequencies"][:6] == found["damping_ratios"][:6] == [0.0] * 6
    elastic = found["frequencies"][6:]
    # 24 displacements less 5 locked by the hinge and 6 rigid-body modes
    assert len(elastic) == min(count, 13) == len(found["damping_ratios"]) - 6
    assert elastic[0] == pytest.approx(40.09, abs=5e-3)
    assert found["damping_ratios"][6] == pytest.approx(0.1029, abs=1e-4)
    assert ("60 modes were requested, but only 13 exist" in run.err) == (count == 60)


def test_free_damped_bodies(strutwork: Program) -> None:
    found = strutwork("modes", CASES / "robustness/free_damped.toml", "-n", "3", "--json").result
    # two bodies of 1 kg on 1 MN/m: ω² = 2 k, ζ = 2c/(2ω)
    w = np.sqrt(2e6)
    assert found["frequencies"][6] == pytest.approx(w / (2 * np.pi), rel=1e-9)
    # what nothing damps has no ratio, not one of 1e-16
    assert found["damping_ratios"][6:] == [pytest.approx(50 / w, rel=1e-9), 0.0, 0.0]
    assert "idle_motions" not in found


def test_ports_that_symmetry_uncouples(strutwork: Program) -> None:
    beam = CASES / "models/rayleigh.toml"
    ports = ("--input", "B:y", "--output", "B:z", "--from", "1", "--to", "500")
    run = strutwork("frf", beam, *ports, "--lines", "20", "--json")
    found = run.result
    assert found["minimum_dynamic_stiffness"]["value"] is None
    assert found["minimum_dynamic_stiffness"]["frequency"] is None
    assert found["static_stiffness"] is None
    assert found["reason"].startswith("B:y and B:z: uncoupled")
    assert found["receptance"] == {"real": [0.0] * 20, "imag": [0.0] * 20}
    assert "uncoupled" in strutwork("frf", beam, *ports).out
    # a moment about z bends as a force along y does
    coupled = ("--input", "B:y", "--output", "B:rz", "--from", "1", "--to", "500")
    assert strutwork("frf", beam, *coupled, "--json").result["static_stiffness"] > 0


def test_band_that_covers(strutwork: Program) -> None:
    found = strutwork("frf", "examples/03_tripod.toml", "--input", "TCP:z", "--json").result
    assert found["frequencies"][-1] > 1000.0
    assert found["minimum_dynamic_stiffness"]["frequency"] == pytest.approx(876.4, abs=0.5)


def dashpot(**stiffness: float) -> Content:
    """2 kg on a dashpot of 50 N·s/m along x, on springs to ground in the named directions."""
    return {
        "nodes": {"G": [0, 0, 0], "A": [0, 0, 0]},
        "masses": [{"node": "A", "mass": 2.0, "inertia": [0.01, 0.01, 0.01]}],
        "joints": [
            {"name": "pot", "type": "bushing", "between": ["G", "A"], "damping": {"x": 50.0}}
        ],
        "springs": [{"name": "s", "node": "A", "stiffness": stiffness}],
        "supports": [{"node": "G", "fixed": "all"}],
        "loads": [{"node": "A", "force": [1, 0, 0]}],
        "tool": {"tcp": "A"},
    }


def test_a_bushing_of_dashpots_alone(strutwork: Program, write: Write) -> None:
    others = dict.fromkeys(("y", "z", "rx", "ry", "rz"), 1e4)
    path = write(dashpot(x=5e3, **others))
    found = strutwork("modes", path, "-n", "6", "--json").result
    # ζ = c / 2√(km) = 0.25
    assert found["frequencies"][0] == pytest.approx(50 / (2 * np.pi), rel=1e-9)
    assert found["damping_ratios"][0] == pytest.approx(0.25, rel=1e-9)
    least = strutwork("frf", path, "--input", "TCP:x", "--from", "1", "--to", "50", "--json").result
    wanted = 0.5 * np.sqrt(1 - 0.25**2) * 5e3
    assert least["minimum_dynamic_stiffness"]["value"] == pytest.approx(wanted, rel=1e-9)
    solved = strutwork("solve", path, "--json").result
    assert solved["cases"]["load"]["displacements"]["A"][0] == pytest.approx(1 / 5e3)
    # without the spring it creeps: no static answer, and a response all the same
    free = write(dashpot(**others))
    run = strutwork("solve", free, "--json")
    assert run.status == 1
    assert "pot in x" in run.err
    found = strutwork("frf", free, "--input", "TCP:x", "--from", "1", "--to", "50", "--json").result
    w = 2 * np.pi
    wanted = abs(-2 * w**2 + 50j * w)
    assert found["minimum_dynamic_stiffness"]["value"] == pytest.approx(wanted, rel=1e-9)
    assert found["static_stiffness"] == 0.0


def in_series(middle: float) -> Content:
    """2 kg on two dashpots in series along x, 50 and 150 N·s/m, `middle` kg between them."""
    others = dict.fromkeys(("y", "z", "rx", "ry", "rz"), 1e4)
    content = dashpot()
    content["nodes"]["M"] = [0, 0, 0]
    content["joints"] = [
        {
            "name": name,
            "type": "bushing",
            "between": between,
            "stiffness": others,
            "damping": {"x": factor},
        }
        for name, between, factor in (("one", ["G", "M"], 50.0), ("two", ["M", "A"], 150.0))
    ]
    content["springs"] = [{"name": "s", "node": "A", "stiffness": {"x": 5e3}}]
    if middle:
        inertia = [1e-6] * 3
        content["masses"].append({"node": "M", "mass": middle, "inertia": inertia})
    return content


def test_two_dashpots_with_a_massless_node_between(strutwork: Program, write: Write) -> None:
    """The node has no static place: named with both dashpots; as one, or with mass, it is right."""
    band = ("--input", "TCP:x", "--from", "1", "--to", "50", "--lines", "50", "--json")
    for command in (("modes",), ("frf", *band)):
        run = strutwork(command[0], write(in_series(0.0)), *(command[1:] or ("--json",)))
        assert (run.status, run.out) == (1, "")
        assert "has a free motion without mass" in run.err
        assert "one in x" in run.err
        assert "two in x" in run.err
        assert "two dashpots in series are one" in run.err
    found = strutwork("frf", write(in_series(1e-6)), *band).result
    w = 2 * np.pi * np.array(found["frequencies"])
    series = 1 / (1 / 50.0 + 1 / 150.0)
    wanted = 1 / (5e3 + 1j * w * series - 2.0 * w**2)
    given = np.array(found["receptance"]["real"]) + 1j * np.array(found["receptance"]["imag"])
    # a microgram-scale node between dashpots of 200 N·s/m shifts nothing at 50 Hz: ω m/c = 2e-6
    np.testing.assert_allclose(given, wanted, rtol=1e-5)


def test_a_bushing_of_nothing_is_an_error(strutwork: Program, write: Write) -> None:
    content = dashpot(x=1.0)
    content["joints"][0]["damping"] = {}
    run = strutwork("modes", write(content), "--json")
    assert run.status == 1
    assert "bushing without matrix or stiffness or damping" in run.err
