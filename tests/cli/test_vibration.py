"""`strutwork modes` and `frf`."""

from __future__ import annotations

import csv
import tomllib
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest

from strutwork.fea.uff_read import read_universal
from strutwork.machines.catalogue import CATALOGUE
from tests.cli.conftest import Program
from tests.model_files import EXAMPLES, SAMPLE, Content, Edit, drop, put, sample

ROOT = Path(__file__).parents[2]
EXAMPLE = {path.stem: path for path in EXAMPLES}
Write = Callable[[Content], Path]

BAND = ("--from", "1", "--to", "500")
TIP = ("--input", "TCP:z", "--output", "TCP:z")


def oscillator(*edits: Edit) -> Content:
    """A mass of 2.5 kg on a slider of 400 kN/m along x."""
    content: Content = {
        "nodes": {"ground": [0, 0, 0], "TCP": [0, 0, 0]},
        "masses": [{"node": "TCP", "mass": 2.5}],
        "joints": [
            {
                "name": "slider",
                "type": "prismatic",
                "axis": [1, 0, 0],
                "between": ["ground", "TCP"],
                "stiffness": {"z": "400 N/mm"},
            }
        ],
        "supports": [{"node": "ground", "fixed": "all"}],
        "tool": {"tcp": "TCP"},
        "damping": {"modal_ratio": 0.02},
    }
    for edit in edits:
        edit(content)
    return content


def test_modes_of_the_sample(strutwork: Program, write: Write) -> None:
    found = strutwork("modes", write(SAMPLE), "-n", "5", "--json").result
    assert set(found) == {
        "frequencies",
        "rigid_body_modes",
        "shapes",
        "effective_mass",
        "damping_ratios",
    }
    assert found["rigid_body_modes"] == 0
    assert found["frequencies"] == sorted(found["frequencies"])
    assert len(found["frequencies"]) == len(found["shapes"]) == 5
    for shape in found["shapes"]:
        assert list(shape) == ["A", "B", "C", "D", "TCP", "F", "G"]
        assert {len(motion) for motion in shape.values()} == {6}
        assert shape["A"] == [0.0] * 6
    assert np.shape(found["effective_mass"]) == (5, 6)
    # the dashpot of the hinge adds to the ratio of every mode
    assert all(ratio > 0.01 for ratio in found["damping_ratios"])


@pytest.mark.parametrize(
    ("damping", "ratio"),
    [
        ({"modal_ratio": 0.02}, 0.02),
        ({"loss_factor": 0.06}, 0.03),
        # α/2ω + βω/2 with ω = 400 rad/s
        ({"rayleigh": {"alpha": 8.0, "beta": 1e-4}}, 8.0 / 800 + 0.02),
    ],
)
def test_damping_of_the_file(
    strutwork: Program, write: Write, damping: Content, ratio: float
) -> None:
    found = strutwork("modes", write(oscillator(put("damping", damping))), "--json").result
    assert found["frequencies"] == pytest.approx([400 / (2 * np.pi)], rel=1e-12)
    assert found["damping_ratios"] == pytest.approx([ratio], rel=1e-9)
    assert found["effective_mass"][0][0] == pytest.approx(2.5, rel=1e-12)
    # mass-normalised
    assert abs(found["shapes"][0]["TCP"][0]) == pytest.approx(2.5**-0.5, rel=1e-12)


def test_dashpots_add_to_the_damping_of_the_file(strutwork: Program, write: Write) -> None:
    # c / (2 √(k m)) = 40 / 2000
    content = oscillator(put("joints.0.damping", {"z": "40 N*s/m"}))
    found = strutwork("modes", write(content), "--json").result
    assert found["damping_ratios"] == pytest.approx([0.02 + 0.02], rel=1e-9)
    bare = strutwork("modes", write(oscillator(drop("damping"))), "--json").result
    assert bare["damping_ratios"] == [None]


@pytest.mark.filterwarnings("default::strutwork.machines.model.ModelWarning")
def test_materials_damp_where_the_file_names_no_damping(strutwork: Program, write: Write) -> None:
    lossy = put("materials.steel.loss_factor", 0.004)
    one = {"nodes": {"A": [0, 0, 0], "TCP": [0.3, 0, 0]}, "supports": SAMPLE["supports"][:1]}
    beam = {**SAMPLE, **one, "beams": [{**SAMPLE["beams"][0], "to": "TCP"}]}
    for gone in ("joints", "bodies", "masses", "springs", "loads", "line_loads", "damping"):
        beam.pop(gone)
    beam = {k: v for k, v in beam.items() if k not in ("settlements", "misfits", "gravity")}
    lossy(beam := {**beam, "materials": {"steel": dict(SAMPLE["materials"]["steel"])}})
    found = strutwork("modes", write(beam), "-n", "3", "--json").result
    # one material alone: ζ = sin(atan(η)/2) of the pole, η/2 to η³
    wanted = np.sin(np.arctan(0.004) / 2)
    assert found["damping_ratios"] == pytest.approx([wanted] * 3, rel=1e-9)
    named = {**beam, "damping": {"modal_ratio": 0.01}}
    run = strutwork("modes", write(named), "-n", "3", "--json")
    assert run.result["damping_ratios"] == pytest.approx([0.01] * 3)
    assert "Warning: material steel: the loss factor is not used" in run.err
    assert run.err.count("Warning") == 1


def test_more_modes_than_there_are(strutwork: Program, write: Write) -> None:
    run = strutwork("modes", write(oscillator()), "-n", "7", "--json")
    assert len(run.result["frequencies"]) == 1
    assert "7 modes were requested, but only 1 exist" in run.err


def test_rigid_body_modes_come_first(strutwork: Program, write: Write) -> None:
    content = {
        **{key: SAMPLE[key] for key in ("materials", "sections")},
        "nodes": {"A": [0, 0, 0], "B": ["300 mm", 0, 0]},
        "beams": SAMPLE["beams"][:1],
    }
    found = strutwork("modes", write(content), "-n", "2", "--json").result
    assert found["rigid_body_modes"] == 6
    assert found["frequencies"][:6] == [0.0] * 6
    assert found["frequencies"][6] > 100.0
    # the number asked for is that of elastic modes
    assert found["damping_ratios"] == [None] * 8
    assert "idle_motions" not in found


def test_modes_for_people(strutwork: Program) -> None:
    run = strutwork("modes", EXAMPLE["03_tripod"], "-n", "3")
    assert run.status == 0
    assert "Tripod of three driven struts" in run.out
    assert "Damping: viscous, ratio ζ = 0.01 in every mode, joints' dashpots" in run.out
    assert "stores most energy" in run.out


def test_response_of_one_mass(strutwork: Program, write: Write) -> None:
    found = strutwork(
        *("frf", write(oscillator()), "--input", "TCP:x", "--output", "TCP:x"),
        *("--from", "1", "--to", "201", "--lines", "101", "--json"),
    ).result
    assert set(found) == {
        "frequencies",
        "receptance",
        "minimum_dynamic_stiffness",
        "static_stiffness",
    }
    f = np.array(found["frequencies"])
    assert f == pytest.approx(np.linspace(1, 201, 101))
    w = 2 * np.pi * f
    wanted = 1 / (4e5 - 2.5 * w**2 + 2j * 0.02 * 1000.0 * w)
    got = np.array(found["receptance"]["real"]) + 1j * np.array(found["receptance"]["imag"])
    assert got == pytest.approx(wanted, rel=1e-10)
    least = found["minimum_dynamic_stiffness"]
    # 2ζ√(1−ζ²) k at ω₀√(1−2ζ²); the grid of 2 Hz misses the peak
    assert least["value"] == pytest.approx(0.04 * np.sqrt(1 - 0.0004) * 4e5, rel=1e-9)
    assert least["frequency"] == pytest.approx(400 / (2 * np.pi) * np.sqrt(1 - 0.0008), rel=1e-6)
    assert least["value"] < 0.99 * (1 / np.abs(got)).min()
    assert found["static_stiffness"] == pytest.approx(4e5, rel=1e-12)


def test_minimum_with_dashpots_is_that_of_the_curve(strutwork: Program, write: Write) -> None:
    def run(low: float, high: float, lines: int) -> Content:
        return strutwork(
            *("frf", write(SAMPLE), *TIP, "--from", str(low), "--to", str(high)),
            *("--lines", str(lines), "--json"),
        ).result

    coarse = run(1, 500, 20)["minimum_dynamic_stiffness"]
    place = coarse["frequency"]
    fine = run(place - 0.02, place + 0.02, 2001)
    got = np.hypot(fine["receptance"]["real"], fine["receptance"]["imag"])
    # the parabola about the minimum, 1e-5 Hz from a line at the most
    assert coarse["value"] == pytest.approx(1 / got.max(), rel=1e-9)
    assert fine["minimum_dynamic_stiffness"]["value"] == pytest.approx(coarse["value"], rel=1e-9)


def test_output_is_the_input_by_default(strutwork: Program, write: Write) -> None:
    file = write(SAMPLE)
    short = strutwork("frf", file, "--input", "TCP:z", *BAND, "--json").result
    assert short == strutwork("frf", file, *TIP, *BAND, "--json").result
    assert len(short["frequencies"]) == 1000


def test_cross_receptance_is_reciprocal(strutwork: Program, write: Write) -> None:
    file = write(SAMPLE)
    there = strutwork("frf", file, "--input", "TCP:x", "--output", "B:z", *BAND, "--json").result
    back = strutwork("frf", file, "--input", "B:z", "--output", "TCP:x", *BAND, "--json").result
    assert there["receptance"]["imag"] == pytest.approx(back["receptance"]["imag"], rel=1e-8)
    one, two = (r["minimum_dynamic_stiffness"] for r in (there, back))
    assert one["value"] == pytest.approx(two["value"], rel=1e-9)
    assert one["value"] <= 1 / np.hypot(*there["receptance"].values()).max()


def test_tool_by_its_name_and_motion_between_nodes(
    strutwork: Program, write: Write, tmp_path: Path
) -> None:
    content = sample(put("tool.tcp", "D"), drop("nodes.TCP"), put("bodies.0.nodes", ["C", "D"]))
    content.pop("loads")
    file = write(content)
    by_name = strutwork("frf", file, "--input", "TCP:z", *BAND, "--json").result
    assert by_name == strutwork("frf", file, "--input", "D:z", *BAND, "--json").result
    run = strutwork("frf", file, "--input", "B-D:z", *BAND, "-o", tmp_path / "o", "--json")
    assert "only CSV" in run.err
    assert [Path(p).name for p in run.result["data"]] == ["model-frf.csv"]


def test_files_of_a_response(strutwork: Program, write: Write, tmp_path: Path) -> None:
    found = strutwork("frf", write(SAMPLE), *TIP, *BAND, "-o", tmp_path / "o", "--json").result
    assert {Path(p).name for p in found["data"]} == {"model-frf.uff", "model-frf.csv"}
    (function,) = read_universal(tmp_path / "o" / "model-frf.uff").functions
    assert function.name == "TCP:z / TCP:z"
    assert function.frequencies.tolist() == found["frequencies"]
    assert function.values.imag.tolist() == found["receptance"]["imag"]
    with (tmp_path / "o" / "model-frf.csv").open(encoding="utf-8") as stream:
        head, *rows = csv.reader(stream)
    assert head == ["frequency, Hz", "real part, m/N", "imaginary part, m/N"]
    assert [float(row[2]) for row in rows] == found["receptance"]["imag"]


def test_damping_from_the_command_line(strutwork: Program, write: Write) -> None:
    file = write(oscillator(drop("damping")))
    found = strutwork("modes", file, "--loss-factor", "0.04", "--json").result
    assert found["damping_ratios"] == pytest.approx([0.02])
    found = strutwork(
        "frf", file, "--input", "TCP:x", *BAND, "--modal-ratio", "0.1", "--json"
    ).result
    least = found["minimum_dynamic_stiffness"]["value"]
    assert least == pytest.approx(0.2 * np.sqrt(0.99) * 4e5, rel=1e-9)


def test_machines_vibrate_by_their_name(strutwork: Program) -> None:
    name = f"{next(iter(CATALOGUE))}:calibrated"
    found = strutwork("modes", name, "-n", "3", "--json").result
    assert found["damping_ratios"] == [None] * 3
    assert found["frequencies"][0] > 1.0
    run = strutwork(
        *("frf", name, "--input", "TCP:x", "--from", "1", "--to", "500"),
        *("--modal-ratio", "0.01", "--json"),
    )
    # three equal legs: x and y are alike
    along_y = strutwork(
        *("frf", name, "--input", "TCP:y", "--from", "1", "--to", "500"),
        *("--modal-ratio", "0.01", "--json"),
    ).result
    least, other = (r["minimum_dynamic_stiffness"]["value"] for r in (run.result, along_y))
    assert least == pytest.approx(other, rel=1e-6)


WRONG: dict[str, tuple[list[Edit], list[str], list[str]]] = {
    "no damping": ([drop("damping"), put("joints.0.damping", {})], [], ["damping", "[damping]"]),
    "two kinds of damping": (
        [put("damping.loss_factor", 0.02)],
        [],
        ["damping", "modal_ratio and loss_factor", "exactly one"],
    ),
    "both on the command line": (
        [],
        ["--modal-ratio", "0.1", "--loss-factor", "0.1"],
        ["Give one of them"],
    ),
    "beyond critical": ([], ["--modal-ratio", "1.5"], ["1.5", "below 1"]),
    "ratio that is no number": ([], ["--modal-ratio", "nan"], ["nan"]),
    "no tool": ([drop("tool")], ["--input", "tool:x"], ["[tool]"]),
    "unknown node": ([], ["--input", "Q:x"], ['"Q"', "A, B, C"]),
    "unknown direction": ([], ["--input", "TCP:w"], ["unknown direction", "rx"]),
    "no direction": ([], ["--input", "TCP"], ['"TCP"', "NODE:x"]),
    "held node": ([], ["--input", "A:x"], ["A:x", "does not move"]),
    "band of no width": ([], ["--from", "5", "--to", "5"], ["5 to 5 Hz"]),
    "negative band": ([], ["--from", "-5"], ["-5 to 500 Hz"]),
    "band the wrong way": ([], ["--from", "600"], ["600 to 500 Hz"]),
    "band without end": ([], ["--to", "inf"], ["inf Hz"]),
    "no mass": (
        [drop("materials.steel.density"), drop("masses"), drop("bodies.0.mass"), drop("gravity")],
        [],
        ["material steel", "no density"],
    ),
}


@pytest.mark.parametrize("name", WRONG)
def test_wrong_input_of_a_response(strutwork: Program, write: Write, name: str) -> None:
    edits, options, words = WRONG[name]
    run = strutwork("frf", write(sample(*edits)), *TIP, *BAND, "--json", *options)
    assert (run.status, run.out) == (1, "")
    assert run.err.startswith("Error: ")
    assert run.err.count("Error") == 1
    assert all(word in run.err for word in words), run.err


@pytest.mark.parametrize("command", ["modes", "frf"])
@pytest.mark.parametrize("name", ["nowhere.toml", "no-machine"])
def test_neither_file_nor_machine(strutwork: Program, command: str, name: str) -> None:
    options = ("--input", "TCP:x", *BAND) if command == "frf" else ()
    run = strutwork(command, name, *options, "--json")
    assert (run.status, run.out) == (1, "")
    assert name in run.err


def test_everything_held(strutwork: Program, write: Write) -> None:
    content = {"nodes": {"A": [0, 0, 0]}, "masses": [{"node": "A", "mass": 1.0}]}
    content["supports"] = [{"node": "A", "fixed": "all"}]
    run = strutwork("modes", write(content), "--json")
    assert (run.status, run.out) == (1, "")
    assert "no degree of freedom" in run.err


@pytest.mark.parametrize(
    "arguments",
    [
        ("modes", "x.toml", "-n", "0"),
        ("frf", "x.toml", *BAND),
        ("frf", "x.toml", "--input", "TCP:x", "--from", "1"),
        ("frf", "x.toml", "--input", "TCP:x", *BAND, "--lines", "1"),
    ],
)
def test_wrong_usage(strutwork: Program, arguments: tuple[str, ...]) -> None:
    run = strutwork(*arguments)
    assert (run.status, run.out) == (2, "")


WIRE = ROOT / "tests" / "cases" / "models" / "f7_preload_ignored.toml"


@pytest.mark.filterwarnings("default::strutwork.machines.model.ModelWarning")
def test_a_load_that_would_stiffen_is_named(strutwork: Program) -> None:
    run = strutwork("modes", WIRE, "-n", "1", "--json")
    assert run.result["frequencies"] == pytest.approx([4.604], abs=1e-3)
    assert "load case load: its forces would change the first frequency from 4.604" in run.err
    assert '--preload "load"' in run.err


def test_modes_and_response_under_a_named_preload(strutwork: Program, write: Write) -> None:
    run = strutwork("modes", WIRE, "-n", "2", "--json", "--preload", "load")
    # the string's 63.7 Hz, and 2 % for its clamped ends
    assert run.result["frequencies"] == pytest.approx([65.18] * 2, abs=0.01)
    assert run.result["rigid_body_modes"] == 0
    assert run.err == ""
    in_file = write(tomllib.loads(WIRE.read_text()) | {"preload": "load"})
    assert strutwork("modes", in_file, "-n", "2", "--json").result == run.result
    ports = ("--input", "w/10:y", "--from", "1", "--to", "100", "--modal-ratio", "0.01", "--json")
    response = strutwork("frf", in_file, *ports).result
    assert response["minimum_dynamic_stiffness"]["frequency"] == pytest.approx(65.18, abs=0.02)
    assert strutwork("frf", WIRE, *ports, "--preload", "load").result == response


@pytest.mark.parametrize(
    ("force", "expected"),
    [
        (-100.0, ["buckles under its preload", "critical load is 0.00"]),
        (0.0, []),
    ],
)
def test_a_preload_beyond_buckling(
    strutwork: Program, write: Write, force: float, expected: list[str]
) -> None:
    content = tomllib.loads(WIRE.read_text()) | {"preload": "load"}
    content["loads"][0]["force"] = [force, 0, 0]
    run = strutwork("modes", write(content), "-n", "1", "--json")
    assert run.status == bool(expected)
    assert [part for part in expected if part not in run.err] == []


def test_an_unknown_preload(strutwork: Program, write: Write) -> None:
    run = strutwork("modes", WIRE, "--preload", "wind")
    assert run.status == 1
    assert 'preload: names the unknown load case "wind".\nCases: load.' in run.err
    content = tomllib.loads(WIRE.read_text()) | {"preload": "gravity"}
    assert "unknown load case" in strutwork("check", write(content)).err
    machine = strutwork("modes", "proposed-3pprs", "--preload", "gravity")
    assert "has no load cases" in machine.err
