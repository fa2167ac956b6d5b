"""`strutwork correlate`: computed files against a synthetic measurement."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from strutwork.fea.uff import FrfRecord, ModeRecord, UniversalFile
from strutwork.fea.uff_read import read_universal
from strutwork.fea.uff_write import write_universal
from tests.cli.conftest import Program
from tests.model_files import EXAMPLES

TRIPOD = {path.stem: path for path in EXAMPLES}["03_tripod"]


def synthetic(path: Path, modes: Path, response: Path) -> Path:
    """Synthetic measurement: translations of some nodes, frequencies 4 % lower, noise."""
    rng = np.random.default_rng(5)
    computed, answer = read_universal(modes), read_universal(response)
    heard = ("TCP", "plate1", "plate2", "plate3", "head1", "inner2")
    found = []
    for mode in computed.modes:
        index = [mode.nodes.index(n) for n in heard]
        shape = np.zeros((len(heard), 6))
        shape[:, :3] = mode.shape[index, :3]
        shape[:, :3] += 0.01 * np.abs(shape).max() * rng.normal(size=(len(heard), 3))
        found.append(ModeRecord(0.96 * mode.frequency, 0.013, heard, shape))
    # any two of a doublet's plane are as good as the computed two
    one, two = found[0].shape, found[1].shape
    found[0] = ModeRecord(found[0].frequency, 0.013, heard, 0.6 * one + 0.8 * two)
    found[1] = ModeRecord(found[1].frequency * 1.002, 0.013, heard, 0.8 * one - 0.6 * two)
    (function,) = answer.functions
    slower = FrfRecord(
        function.output, function.input, 0.96 * function.frequencies, 2.0 * function.values
    )
    return write_universal(path, UniversalFile((slower,), tuple(found)))


@pytest.fixture
def files(strutwork: Program, tmp_path: Path) -> tuple[Path, Path]:
    """A computed file with modes and a response, and a synthetic measurement of both."""
    strutwork("modes", TRIPOD, "-n", "6", "-o", tmp_path)
    strutwork(*("frf", TRIPOD, "--input", "TCP:x", "--from", "20", "--to", "300", "-o", tmp_path))
    modes, response = tmp_path / "03_tripod-modes.uff", tmp_path / "03_tripod-frf.uff"
    whole = read_universal(modes), read_universal(response)
    both = UniversalFile(whole[1].functions, whole[0].modes, whole[0].positions, whole[0].lines)
    computed = write_universal(tmp_path / "computed.uff", both)
    return computed, synthetic(tmp_path / "measured.uff", modes, response)


def test_correlate(strutwork: Program, files: tuple[Path, Path]) -> None:
    found = strutwork("correlate", *files, "--json").result
    assert set(found) == {"modes", "functions", "only_computed", "only_measured", "notes"}
    assert [(p["computed"], p["measured"]) for p in found["modes"]] == [(i, i) for i in range(6)]
    assert [p["group"] for p in found["modes"]] == [2, 2, 1, 1, 2, 2]
    # 1 % of noise leaves far more than 0.99 of the shapes
    assert min(p["mac"] for p in found["modes"]) > 0.99
    assert found["modes"][2]["difference_percent"] == pytest.approx(100 * (1 / 0.96 - 1), rel=1e-3)
    assert found["modes"][2]["measured_damping"] == pytest.approx(0.013)
    (function,) = found["functions"]
    assert (function["output"], function["input"]) == ("TCP:x", "TCP:x")
    assert function["scale"] == pytest.approx(0.96, rel=1e-4)
    assert function["scaled_frac"] > 0.999
    assert function["frac"] < 0.5
    assert not function["at_limit"]
    table = strutwork("correlate", *files)
    assert table.status == 0
    assert "Paired modes" in table.out
    assert "2 modes" in table.out
    assert "best frequency scale" in table.out


@pytest.mark.parametrize(
    ("content", "words"),
    [
        (b"", "is empty"),
        (b"\x00\x01garbage", "not a universal file"),
        (b"    -1\n    58\nhalf\n", "cut short"),
    ],
)
def test_correlate_with_a_bad_file(
    strutwork: Program, files: tuple[Path, Path], tmp_path: Path, content: bytes, words: str
) -> None:
    bad = tmp_path / "bad.uff"
    bad.write_bytes(content)
    for pair in ((files[0], bad), (bad, files[1]), (files[0], tmp_path / "absent.uff")):
        run = strutwork("correlate", *pair, "--json")
        assert (run.status, run.out) == (1, "")
        assert run.err.startswith("Error: ")
    assert words in strutwork("correlate", bad, files[1], "--json").err


def test_correlate_options_that_make_no_sense(strutwork: Program, files: tuple[Path, Path]) -> None:
    for option in (("--window", "0"), ("--least", "2"), ("--doublet", "nan")):
        run = strutwork("correlate", *files, *option, "--json")
        assert (run.status, run.out) == (1, "")
        assert "pairing" in run.err


def test_correlate_needs_two_files(strutwork: Program) -> None:
    run = strutwork("correlate", "x.uff")
    assert (run.status, run.out) == (2, "")
