"""`strutwork calibrate`: from a file to its result, the machine it writes, and wrong files."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from strutwork.fea import Port, frequency_response, modes
from strutwork.fea.uff import FrfRecord, UniversalFile, mode_file, node_positions
from strutwork.fea.uff_write import write_universal
from strutwork.machines.model_file import read_model
from strutwork.studies.model_damping import model_damping
from strutwork.studies.parametric import Parametric
from tests.cli.conftest import Program
from tests.gradients import CHAIN

TRUE = {"joints.elbow.stiffness.rz": 1.1e5, "masses[0].mass": 4.6}
FILE = """
machine = "chain.toml"
[[parameters]]
path = "joints.elbow.stiffness.rz"
range = ["2e4 N*m/rad", "4e5 N*m/rad"]
[[parameters]]
path = "masses[0].mass"
[[frequencies]]
file = "modes.uff"
modes = [1, 2, 3]
relative_scatter = "0.5 %"
[[frf]]
file = "hammer.uff"
points = { p7 = "tip" }
band = ["5 Hz", "60 Hz"]
scatter = "3 %"
[[deflections]]
load = { node = "tip", z = "-200 N" }
displacements = { tip = { z = "-1 mm" } }
scatter = "1 mm"
[fit]
starts = 2
"""


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A machine, and measurements of one that differs, written as universal files."""
    where = tmp_path_factory.mktemp("calibration")
    text = CHAIN.replace("loss_factor = 0.01\n", "")
    if "[damping]" not in text:
        text += "\n[damping]\nmodal_ratio = 0.02\n"
    (where / "chain.toml").write_text(text, encoding="utf-8")
    model = Parametric.of(where / "chain.toml").model(dict(TRUE))
    write_universal(where / "modes.uff", mode_file(modes(model.placed, 4)))
    lines = np.arange(2.0, 80.0, 1.0)
    port = Port("tip", "z")
    damping = model_damping(model)
    assert damping is not None
    found = frequency_response(model.placed, [port], [port], lines, damping, "all_modes")
    rng = np.random.default_rng(1)
    values = found.receptance[:, 0, 0] * np.exp(0.03 * rng.standard_normal(len(lines)))
    record = FrfRecord(("p7", "z"), ("p7", "z"), lines, values * (2j * np.pi * lines), "velocity")
    write_universal(where / "hammer.uff", UniversalFile(functions=(record,)))
    far = node_positions(["p1"], [[9.0, 9.0, 9.0]])
    other = FrfRecord(("p1", "z"), ("p1", "z"), lines, values)
    write_universal(where / "far.uff", UniversalFile(functions=(other,), positions=far))
    return where


def written(folder: Path, text: str) -> Path:
    path = folder / "calibration.toml"
    path.write_text(text, encoding="utf-8")
    return path


def test_the_machine_comes_back_and_is_written_with_its_comments(
    strutwork: Program, folder: Path
) -> None:
    text = (folder / "chain.toml").read_text(encoding="utf-8")
    (folder / "chain.toml").write_text("# my machine\n" + text, encoding="utf-8")
    out = folder / "calibrated.toml"
    found = strutwork("calibrate", written(folder, FILE), "-o", out, "--json").result
    for p in found["parameters"]:
        low, high = p["interval"]
        assert p["verdict"] == "identifiable"
        # three deviations where the interval has two
        wide = (high / low) ** 0.26
        assert low / wide < TRUE[p["name"]] < high * wide
    assert [m["kind"] for m in found["measurements"]] == ["frequencies", "frf", "deflections"]
    assert found["measurements"][0]["rms_after"] < found["measurements"][0]["rms_before"]
    assert any("by their shapes (MAC)" in note for note in found["notes"])
    assert found["probability"] > 1e-3
    new = out.read_text(encoding="utf-8")
    assert new.startswith("# my machine\n")
    assert new.count("# calibrated: calibration.toml") == 2
    # every other line is what it was
    old, lines = ("# my machine\n" + text).splitlines(), new.splitlines()
    assert len(old) == len(lines)
    assert sum(a != b for a, b in zip(old, lines, strict=True)) == 2
    assert read_model(out).structure.masses[0].mass == pytest.approx(
        found["calibrated"]["masses[0].mass"], rel=1e-12
    )


def test_what_is_printed(strutwork: Program, folder: Path) -> None:
    run = strutwork("calibrate", written(folder, FILE))
    assert run.status == 0, run.err
    assert "95 % interval" in run.out
    assert "identifiable" in run.out
    assert run.out.strip().splitlines()[-1].startswith("The residuals ")


@pytest.mark.parametrize(
    ("edit", "message"),
    [
        (("elbow.stiffness", "elbow.stifness"), "Did you mean"),
        (("chain.toml", "chian.toml"), 'Did you mean "chain.toml"'),
        (('p7 = "tip"', 'p7 = "tipp"'), 'Did you mean "tip"'),
        (('p7 = "tip"', 'p8 = "tip"'), "Points: p7."),
        (('points = { p7 = "tip" }\n', ""), "no point that is a node of the model"),
        (("hammer.uff", "far.uff"), "unknown measured point"),
        (("hammer.uff", "gone.uff"), "does not exist"),
        (("modes = [1, 2, 3]", "modes = [1, 2, 9]"), "asks for mode 9 of 4"),
        (('band = ["5 Hz", "60 Hz"]', 'band = ["500 Hz", "600 Hz"]'), "0 measured lines"),
        (('band = ["5 Hz", "60 Hz"]', 'band = ["2 Hz", "3 Hz"]'), "has no mode"),
        (('band = ["5 Hz", "60 Hz"]', 'band = ["60 Hz", "5 Hz"]'), "Give the lower first"),
        (('scatter = "3 %"', 'scatter = "-3 %"'), "is out of range"),
        (('scatter = "1 mm"', 'scatter = "-1 mm"'), "is out of range"),
        (('scatter = "1 mm"', ""), "deflections 1.scatter"),
        (('relative_scatter = "0.5 %"', ""), "has no scatter"),
        (('node = "tip", z', 'node = "tpi", z'), 'Did you mean "tip"'),
        (('z = "-200 N"', 'z = "0 N"'), "has no load"),
        (("displacements", "displacement"), 'Did you mean "displacements"'),
        (('file = "modes.uff"\nmodes = [1, 2, 3]', "values = [1, 2]\nmodes = [1]"), "2 values"),
        (('file = "modes.uff"\nmodes = [1, 2, 3]', "values = [9, 2]"), "do not ascend"),
        (('file = "modes.uff"\nmodes = [1, 2, 3]', "values = [9]\nmodes = [400]"), "elastic modes"),
        (('range = ["2e4 N*m/rad", "4e5 N*m/rad"]', 'range = ["1 N", "2 N"]'), "is a force"),
        (('range = ["2e4', 'range = ["3e5'), "a first guess within the range"),
    ],
)
def test_a_wrong_file_is_explained(
    strutwork: Program, folder: Path, edit: tuple[str, str], message: str
) -> None:
    text = FILE.replace(*edit)
    assert text != FILE
    run = strutwork("calibrate", written(folder, text))
    assert run.status == 1, run.out
    assert message in run.err
    assert run.out == ""


def test_wrong_usage(strutwork: Program, folder: Path) -> None:
    few = FILE[: FILE.index("[[frequencies]]")]
    assert "has no measurement" in strutwork("calibrate", written(folder, few)).err
    assert (
        "neither the calibration file"
        in strutwork("calibrate", written(folder, few), "--poses", "2").err
    )
    wrong = strutwork("calibrate", folder / "chain.toml")
    assert "is a model file, not a calibration file" in wrong.err
    assert (
        "does not end in .toml"
        in strutwork("calibrate", written(folder, FILE), "-o", folder / "a.txt").err
    )
