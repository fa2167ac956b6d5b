"""Universal files that others write: every one of the cases gives its right values."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from strutwork.errors import ModelError
from strutwork.fea.compare_files import compare_files
from strutwork.fea.uff_read import read_universal

CASES = Path(__file__).parents[1] / "cases"
UFF = CASES / "uff"
EXPECTED: list[dict[str, Any]] = [
    entry
    for entry in json.loads((CASES / "expected.json").read_text(encoding="utf-8"))
    if entry["what"] in {"uff", "names", "ratio"}
]


@pytest.mark.parametrize("case", EXPECTED, ids=lambda case: str(case["id"]))
def test_a_case_gives_its_right_values(case: dict[str, Any]) -> None:
    found, right = read_universal(CASES / case["file"]), case["right"]
    if "distinct" in right:
        assert len({f.name for f in found.functions}) == right["distinct"]
        return
    if "ratio" in right:
        computed = read_universal(UFF / "frf_computed.uff").functions[0].as_motion("acceleration")
        ratio = np.abs(found.functions[0].as_motion("acceleration")) / np.abs(computed)
        # six digits in the file
        assert np.median(ratio) == pytest.approx(right["ratio"], rel=1e-5)
        return
    pairs = compare_files(read_universal(UFF / "computed.uff"), found).modes
    if "pairs" in right:
        assert [p.mac for p in pairs] == pytest.approx(right["pairs"], abs=1e-6)
    else:
        assert len(found.modes) == len(pairs) == right["modes"]
        assert [p.group for p in pairs] == right["groups"]


def test_all_cases_are_here() -> None:
    assert len(EXPECTED) == 8


def test_what_was_left_out_is_said_once_with_its_count() -> None:
    measured = read_universal(UFF / "nx2414_reaction_stress.uff")
    notes = compare_files(read_universal(UFF / "computed.uff"), measured).notes
    assert "measured file: not used: data set 2414 of reaction force (3 times)" in notes
    assert "measured file: not used: data set 2414 of stress (3 times)" in notes


def test_a_coordinate_system_that_is_missing_is_asked_for(tmp_path: Path) -> None:
    lines = (UFF / "local_axes.uff").read_text().splitlines()
    start = lines.index("  2420") - 1
    kept = lines[:start] + lines[start + 17 :]
    file = tmp_path / "x.uff"
    file.write_text("\n".join(kept) + "\n")
    with pytest.raises(ModelError, match="coordinate system 2, which the file does not contain"):
        read_universal(file)


def test_a_place_goes_before_a_number(tmp_path: Path) -> None:
    # node numbers reversed with their places: by number the MAC would fall
    text = (UFF / "computed.uff").read_text()
    swapped = []
    for line in text.splitlines():
        number = line.strip()
        if line.startswith("         ") and number.split()[0] in "12345" and len(line) in (10, 40):
            line = f"{6 - int(number.split()[0]):10d}{line[10:]}"  # noqa: PLW2901
        swapped.append(line)
    file = tmp_path / "x.uff"
    file.write_text("\n".join(swapped) + "\n")
    found = compare_files(read_universal(UFF / "computed.uff"), read_universal(file))
    assert [p.mac for p in found.modes] == pytest.approx([1.0, 1.0, 1.0], abs=1e-9)
    assert any("4 of 5 nodes are matched by position" in note for note in found.notes)


def mutant(source: bytes, rng: np.random.Generator) -> bytes:
    """A file with one to three faults."""
    data = bytearray(source)
    for _ in range(int(rng.integers(1, 4))):
        at, kind = int(rng.integers(len(data))), int(rng.integers(6))
        if kind == 0:
            data[at] = int(rng.integers(256))
        elif kind == 1:
            del data[at : at + int(rng.integers(1, 90))]
        elif kind == 2:
            data[at:at] = data[at : at + int(rng.integers(1, 200))]
        elif kind == 3:
            words = (b"  NaN", b"1E+99", b"    0", b"   -1", b"1E300")
            data[at : at + 5] = words[int(rng.integers(len(words)))]
        elif kind == 4 and rng.random() < 0.3:
            del data[at + 1 :]
        else:
            data[at] = b"0123456789-+.ED "[int(rng.integers(16))]
        data = data or bytearray(b" ")
    return bytes(data)


@pytest.mark.parametrize("count", [120, pytest.param(1200, marks=pytest.mark.slow)])
def test_mutants_raise_only_our_own_errors(count: int, tmp_path: Path) -> None:
    rng = np.random.default_rng(15)
    sources = sorted(UFF.glob("*.uff"))
    file = tmp_path / "mutant.uff"
    refused = 0
    for k in range(count):
        file.write_bytes(mutant(sources[k % len(sources)].read_bytes(), rng))
        try:
            found = read_universal(file)
            other = "frf_computed.uff" if found.functions else "computed.uff"
            compare_files(read_universal(UFF / other), found)
        except ModelError:
            refused += 1
    assert 0 < refused < count
