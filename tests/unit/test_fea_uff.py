"""Universal files: what is written reads back, and every fault has its message."""

from __future__ import annotations

import re
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import pyuff
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays

from strutwork.errors import ModelError, OutputError
from strutwork.fea import uff_read
from strutwork.fea.uff import FrfRecord, ModeRecord, UniversalFile
from strutwork.fea.uff_read import read_universal
from strutwork.fea.uff_write import write_universal

RNG = np.random.default_rng(11)
LINES = np.linspace(1.0, 500.0, 333)
VALUES = RNG.normal(size=333) * 1e-7 + 1j * RNG.normal(size=333) * 1e-9
FUNCTION = FrfRecord(("TCP", "x"), ("leg1/first link/3", "rz"), LINES, VALUES)
NODES = ("TCP", "leg1/first link/3", "Spitze ö")
REAL = ModeRecord(45.846, 0.0125, NODES, RNG.normal(size=(3, 6)))
COMPLEX = ModeRecord(81.25, 0.031, NODES, RNG.normal(size=(3, 6)) + 1j * RNG.normal(size=(3, 6)))
POSITIONS = {name: RNG.normal(size=3) for name in NODES}
CONTENT = UniversalFile((FUNCTION,), (REAL, COMPLEX), POSITIONS, ((NODES[0], NODES[1]),))
QUICK = settings(
    max_examples=15, deadline=None, suppress_health_check=[HealthCheck.function_scoped_fixture]
)


@pytest.fixture
def path(tmp_path: Path) -> Path:
    return tmp_path / "out" / "test.uff"


@pytest.mark.parametrize("shapes_in", [55, 2414])
@pytest.mark.parametrize("text", [False, True])
def test_round_trip(path: Path, text: bool, shapes_in: Any) -> None:
    back = read_universal(write_universal(path, CONTENT, text=text, shapes_in=shapes_in))
    (function,) = back.functions
    assert (function.output, function.input) == (FUNCTION.output, FUNCTION.input)
    assert function.motion == "displacement"
    if text:
        # the format has 12 digits for a value and 6 for a frequency
        assert function.values == pytest.approx(VALUES, rel=1e-11)
        assert function.frequencies == pytest.approx(LINES, rel=1e-5)
    else:
        assert np.array_equal(function.values, VALUES)
        assert np.array_equal(function.frequencies, LINES)
    real, turning = back.modes
    # six digits
    assert (real.frequency, turning.frequency) == pytest.approx((45.846, 81.25), rel=1e-5)
    assert (real.damping_ratio, turning.damping_ratio) == pytest.approx((0.0125, 0.031), rel=1e-4)
    assert real.nodes == NODES
    assert real.shape == pytest.approx(REAL.shape, rel=1e-5)
    assert turning.shape[:, :3] == pytest.approx(COMPLEX.shape[:, :3], rel=1e-5)
    assert not np.any(turning.shape[:, 3:])
    assert back.lines == ((NODES[0], NODES[1]),)
    assert {n: tuple(p) for n, p in back.positions.items()} == {
        n: tuple(p) for n, p in POSITIONS.items()
    }
    assert back.ignored == ()


@given(
    arrays(float, (2, 9), elements=st.floats(-1e300, 1e300)),
    arrays(float, 9, elements=st.floats(1e-3, 1e3)),
    st.floats(0, 1e4),
)
@QUICK
def test_complex_double_is_exact(tmp_path: Path, parts: Any, steps: Any, start: float) -> None:
    lines = start + np.cumsum(steps)
    record = FrfRecord(("1", "x"), ("2", "y"), lines, parts[0] + 1j * parts[1])
    back = read_universal(write_universal(tmp_path / "x.uff", UniversalFile((record,))))
    assert np.array_equal(back.functions[0].values, record.values)
    assert np.array_equal(back.functions[0].frequencies, lines)
    # names that are numbers stay the numbers of the nodes
    assert (back.functions[0].output, back.functions[0].input) == (("1", "x"), ("2", "y"))


def test_binary_byte_count_is_that_of_the_data(path: Path) -> None:
    write_universal(path, UniversalFile((FUNCTION,)))
    header = re.search(rb" 58b(.*)\r?\n", path.read_bytes())
    assert header is not None
    # field 6: bytes after the header; a frequency and a complex value, 8 bytes each number
    assert int(header[1][24:36]) == 333 * 3 * 8


def test_tiny_entries_keep_their_columns(path: Path) -> None:
    shape = np.array([[1.0, -3e-120, 0, 1e-200, -2.5, 0]])
    for shapes_in in (55, 2414):
        content = UniversalFile(modes=(ModeRecord(1.0, None, ("1",), shape),))
        write_universal(path, content, shapes_in=shapes_in)  # type: ignore[arg-type]
        assert read_universal(path).modes[0].shape == pytest.approx(
            np.array([[1.0, 0, 0, 0, -2.5, 0]])
        )


def test_another_program_reads_the_function(path: Path) -> None:
    write_universal(path, UniversalFile((FUNCTION,), positions=POSITIONS), text=True)
    sets = {int(s["type"]): s for s in pyuff.UFF(str(path)).read_sets()}
    assert set(sets) == {164, 2411, 2467, 58}
    function = sets[58]
    assert (function["func_type"], function["ord_data_type"]) == (4, 6)
    assert (function["rsp_node"], function["rsp_dir"]) == (1, 1)
    assert (function["ref_node"], function["ref_dir"]) == (2, 6)
    assert function["id4"] == "response TCP:x"
    assert function["id5"] == "reference leg1/first link/3:rz"
    assert (function["ordinate_axis_units_lab"], function["orddenom_axis_units_lab"]) == (
        "m",
        "N*m",
    )
    assert {g["group_name"]: int(g["entity_tag"][0]) for g in sets[2467]["groups"]} == {
        name: i for i, name in enumerate(NODES, 1)
    }


def test_nothing_to_write(path: Path) -> None:
    with pytest.raises(ModelError, match="would be empty"):
        write_universal(path, UniversalFile(positions=POSITIONS))


@pytest.mark.parametrize(
    ("change", "word"),
    [
        ({"values": VALUES[:-1]}, "333 frequencies and 332 values"),
        ({"values": np.where(LINES > 100, np.nan, VALUES)}, "not finite"),
        ({"frequencies": LINES[::-1]}, "do not ascend"),
        ({"frequencies": LINES[:1], "values": VALUES[:1]}, "fewer than two"),
        ({"output": ("a", "w")}, '"w"'),
        ({"motion": "jerk"}, "jerk"),
    ],
)
def test_functions_that_are_none(change: dict[str, Any], word: str) -> None:
    good = {"output": ("a", "x"), "input": ("b", "x"), "frequencies": LINES, "values": VALUES}
    with pytest.raises(ModelError, match=word):
        FrfRecord(**(good | change))


def test_motions_are_powers_of_frequency() -> None:
    w = 2 * np.pi * LINES
    assert FUNCTION.as_motion("acceleration") == pytest.approx(-(w**2) * VALUES, rel=1e-13)
    speed = FrfRecord(("a", "x"), ("b", "x"), LINES, 1j * w * VALUES, "velocity")
    assert speed.as_motion("displacement") == pytest.approx(VALUES, rel=1e-13)
    at_rest = FrfRecord(("a", "x"), ("b", "x"), LINES - 1.0, VALUES, "velocity")
    with pytest.raises(ModelError, match="0 Hz"):
        at_rest.as_motion("displacement")


def foreign(path: Path, **changes: Any) -> Path:
    """A function as another program may write it."""
    one = {
        "type": 58,
        "binary": 0,
        "func_type": 4,
        "rsp_node": 3,
        "rsp_dir": 1,
        "ref_node": 4,
        "ref_dir": -2,
        "abscissa_spacing": 1,
        "abscissa_spec_data_type": 18,
        "ordinate_spec_data_type": 12,
        "orddenom_spec_data_type": 13,
        "x": np.arange(1.0, 9.0),
        "data": np.arange(8) + 1j,
    }
    pyuff.UFF(str(path)).write_sets([one | changes], mode="add")
    return path


def units(path: Path, length: float, force: float) -> Path:
    one = {"type": 164, "units_code": 9, "length": length, "force": force}
    one |= {"temp": 1.0, "temp_offset": 0.0}
    pyuff.UFF(str(path)).write_sets([one], mode="add")
    return path


def test_foreign_function_in_millimetres_with_a_negative_direction(tmp_path: Path) -> None:
    # 1000 mm in a metre: an accelerance of 1 mm/s² per newton is 0.001 1/kg, and -y turns it
    file = foreign(units(tmp_path / "mm.unv", 1000.0, 1.0))
    (function,) = read_universal(file).functions
    assert (function.output, function.input) == (("3", "x"), ("4", "y"))
    assert function.motion == "acceleration"
    assert function.frequencies == pytest.approx(np.arange(1.0, 9.0))
    assert function.values == pytest.approx(-1e-3 * (np.arange(8) + 1j), rel=1e-11)


@pytest.mark.parametrize(
    ("labels", "factor"),
    [
        (("g", "N"), 9.80665),
        (("mm/s^2", "kN"), 1e-6),
        (("m/s^2", "N"), 1.0),
        (("NONE", "NONE"), 1.0),
        (("G", "N"), 9.80665),
        (("MM/SEC2", "n"), 1e-3),
        (("g/lbf", "NONE"), 9.80665 / 4.4482216152605),
        (("(m/s²)/N", "NONE"), 1.0),
        (("1/kg", "NONE"), 1.0),
        (("in/sec^2", "mN"), 25.4),
        (("m/s/s", "MN"), 1e-6),
    ],
)
def test_labels_name_units(tmp_path: Path, labels: tuple[str, str], factor: float) -> None:
    changes = {"ordinate_axis_units_lab": labels[0], "orddenom_axis_units_lab": labels[1]}
    (function,) = read_universal(foreign(tmp_path / "x.unv", **changes)).functions
    assert function.values == pytest.approx(-factor * (np.arange(8) + 1j), rel=1e-11)


@pytest.mark.parametrize(
    ("labels", "words"),
    [
        (("strange", "N"), '"strange", an unknown unit of acceleration'),
        (("mm", "N"), '"mm", which is not a unit of acceleration'),
        (("m/s^2", "EU"), '"EU", an unknown unit of force'),
        (("m/s^2", "mn"), '"mn", which is not a unit of force'),
        (("g/N", "kN"), "per force and beside it"),
    ],
)
def test_unknown_labels_are_never_taken_as_si(
    tmp_path: Path, labels: tuple[str, str], words: str
) -> None:
    changes = {"ordinate_axis_units_lab": labels[0], "orddenom_axis_units_lab": labels[1]}
    with pytest.raises(ModelError, match=words):
        read_universal(foreign(tmp_path / "x.unv", **changes))


def test_a_unit_is_given_for_an_unknown_label(tmp_path: Path) -> None:
    file = foreign(tmp_path / "x.unv", ordinate_axis_units_lab="EU")
    (function,) = read_universal(file, {"EU": "mm/s^2"}).functions
    assert function.values == pytest.approx(-1e-3 * (np.arange(8) + 1j), rel=1e-11)


def test_moments_and_turns_have_their_units(tmp_path: Path) -> None:
    # rad per (N·mm) is a thousand rad per (N·m)
    file = units(tmp_path / "mm.unv", 1000.0, 1.0)
    foreign(file, rsp_dir=4, ref_dir=5, ordinate_spec_data_type=8)
    (function,) = read_universal(file).functions
    assert (function.output[1], function.input[1]) == ("rx", "ry")
    assert function.values == pytest.approx(1e3 * (np.arange(8) + 1j), rel=1e-11)


def test_what_is_no_response_is_ignored_and_said(tmp_path: Path) -> None:
    file = foreign(tmp_path / "x.unv")
    foreign(file, func_type=6, data=np.ones(8))
    foreign(file, orddenom_spec_data_type=12)
    found = read_universal(file)
    assert len(found.functions) == 1
    assert found.ignored == (
        "coherence (function of type 6)",
        "function that is not a motion per force in a direction",
    )


def lines_of(file: Path, keep: Any) -> None:
    """Leave only some lines of a file."""
    file.write_text("\n".join(keep(file.read_text().splitlines())) + "\n")


def swap(file: Path, old: str, new: str) -> None:
    text = file.read_text()
    assert old in text
    file.write_text(text.replace(old, new))


def cut(file: Path, count: int) -> None:
    file.write_bytes(file.read_bytes()[:-count])


LINE = "6.00000000000e+00"
FIRST = f"{REAL.shape[0, 0]:13.5e}"

#: What makes a file with one fault.
SPOIL: dict[str, list[Any]] = {
    "absent": [],
    "empty": [lambda f: f.write_bytes(b"")],
    "blank": [lambda f: f.write_bytes(b" \n\n")],
    "garbage": [lambda f: f.write_bytes(RNG.bytes(5000))],
    "text": [lambda f: f.write_text("frequency,real,imag\n1,2,3\n")],
    "folder": [lambda f: f.mkdir()],
    "cut in a set": [lambda f: write_universal(f, CONTENT, text=True), lambda f: cut(f, 3000)],
    "cut in binary": [
        lambda f: write_universal(f, UniversalFile((FUNCTION,))),
        lambda f: cut(f, 100),
    ],
    "lines missing": [foreign, lambda f: lines_of(f, lambda a: [x for x in a if LINE not in x])],
    "header missing": [foreign, lambda f: lines_of(f, lambda a: a[:5] + a[-1:])],
    "only units": [lambda f: units(f, 1.0, 1.0)],
    "time response": [lambda f: foreign(f, func_type=1, data=np.ones(8))],
    "other sets": [lambda f: f.write_text("    -1\n  9999\n   stuff\n    -1\n")],
    "not a motion": [lambda f: foreign(f, ordinate_spec_data_type=0)],
    "NaN in a function": [
        foreign,
        lambda f: swap(f, "   3.00000000000e+00", "                 NaN"),
    ],
    "infinity in a mode": [
        lambda f: write_universal(f, UniversalFile(modes=(REAL,))),
        lambda f: swap(f, FIRST, "          inf"),
    ],
    "units of zero": [lambda f: units(f, 0.0, 1.0), foreign],
}


def spoiled(tmp_path: Path, name: str) -> Path:
    file = tmp_path / "x.uff"
    for step in SPOIL[name]:
        step(file)
    return file


@pytest.mark.parametrize(
    ("name", "words"),
    [
        ("absent", "does not exist"),
        ("empty", "is empty"),
        ("blank", "is empty"),
        ("garbage", "not a universal file: it is binary data"),
        ("text", "not a universal file: it is text"),
        ("folder", "not an ordinary file"),
        ("cut in a set", "cut short.*not closed"),
        ("cut in binary", r"cut short.*58.*not closed"),
        ("lines missing", "states 8 lines and has 6"),
        ("header missing", r"data set 1 \(type 58\).*cannot be read"),
        ("only units", "no function and no mode, only nodes and units"),
        ("time response", r"no function and no mode, only time response \(function of type 1"),
        ("other sets", "only data set 9999"),
        ("not a motion", "does not state displacement"),
        ("NaN in a function", "not finite"),
        ("infinity in a mode", "not finite"),
        ("units of zero", "unit factor"),
    ],
)
def test_faults_have_one_clear_message(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], name: str, words: str
) -> None:
    file = spoiled(tmp_path, name)
    capsys.readouterr()
    with pytest.raises(ModelError, match=words) as raised:
        read_universal(file)
    assert "x.uff" in raised.value.part
    assert raised.value.remedy
    # the library that reads prints: nothing of it may reach standard output
    assert capsys.readouterr().out == ""


def test_large_files_are_refused(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    file = foreign(tmp_path / "x.uff")
    monkeypatch.setattr(uff_read, "MAX_BYTES", 100)
    with pytest.raises(ModelError, match="more than"):
        read_universal(file)


@given(st.integers(0, 10_000), st.booleans())
@settings(
    max_examples=60, deadline=None, suppress_health_check=[HealthCheck.function_scoped_fixture]
)
def test_a_file_cut_anywhere_raises_or_loses_whole_sets(
    tmp_path: Path, at: int, text: bool
) -> None:
    file = tmp_path / "cut.uff"
    write_universal(file, CONTENT, text=text)
    data = file.read_bytes()
    file.write_bytes(data[: at % len(data)])
    try:
        found = read_universal(file)
    except ModelError:
        return
    for function in found.functions:
        assert len(function.values) == len(LINES)
    assert all(mode.shape.shape == (3, 6) for mode in found.modes)


def test_a_failed_write_leaves_the_old_file(path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    write_universal(path, CONTENT)
    before = path.read_bytes()

    def broken(_: Any) -> None:
        raise OSError("disk full")

    monkeypatch.setattr("strutwork.fea.uff_write.read_universal", broken)
    with pytest.raises(OutputError, match="disk full"):
        write_universal(path, UniversalFile((FUNCTION,)))
    assert path.read_bytes() == before
    assert list(path.parent.iterdir()) == [path]
