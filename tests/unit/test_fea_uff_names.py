"""Names of nodes in universal files: every legal one is written, and none becomes another."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from strutwork.fea.uff import FrfRecord, ModeRecord, UniversalFile
from strutwork.fea.uff_names import LONGEST_NAME, fits, fitted_names
from strutwork.fea.uff_read import read_universal
from strutwork.fea.uff_write import write_universal

LINES = np.linspace(1.0, 50.0, 7)
VALUES = np.linspace(1.0, 2.0, 7) * (1 + 1j)
START = "n" * 99
HARD = (
    START + "a",
    START + "b",
    "ö" * 40,
    "東" * 100,
    "-1",
    "    -1",
    "007",
    "12345678901",
    "１１",  # noqa: RUF001 - digits of another script are digits to Python
    "11",
    "a.b/c:d",
    'it\'s "quoted"',
    "a\u00a0b",
    "a\nb",
    " a",
    "a",
    "",
)


@pytest.mark.parametrize("text", [False, True])
@pytest.mark.parametrize("shapes_in", [55, 2414])
def test_hard_names_come_back_each_as_one_node(tmp_path: Path, shapes_in: int, text: bool) -> None:
    shape = np.arange(6.0 * len(HARD)).reshape(-1, 6) + 1.0
    record = FrfRecord((HARD[0], "x"), (HARD[1], "x"), LINES, VALUES)
    places = {name: np.array([i, 2.0 * i, 0.5]) for i, name in enumerate(HARD)}
    content = UniversalFile(
        (record,), (ModeRecord(10.0, 0.01, HARD, shape),), places, ((HARD[0], HARD[1]),)
    )

    path = write_universal(tmp_path / "x.uff", content, text=text, shapes_in=shapes_in)  # type: ignore[arg-type]
    back = read_universal(path)

    written = fitted_names(HARD)
    (mode,) = back.modes
    assert dict(zip(mode.nodes, mode.shape[:, 0], strict=True)) == pytest.approx(
        {written[name]: shape[i, 0] for i, name in enumerate(HARD)}, rel=1e-5
    )
    assert back.functions[0].output[0] == written[HARD[0]] != back.functions[0].input[0]
    assert {n: p[0] for n, p in back.positions.items()} == {
        written[name]: float(i) for i, name in enumerate(HARD)
    }
    assert all(written[name] == name for name in HARD if fits(name))


def test_long_names_keep_their_start_and_differ_by_the_hash() -> None:
    written = fitted_names([START + "a", START + "b"])
    first, second = written.values()
    assert first[:31] == second[:31] == "n" * 31
    assert first != second
    # the first eight digits of `printf %s name | sha256sum`
    assert first == "n" * 31 + "~3c2aea11"


def test_a_name_that_looks_like_the_label_of_another_keeps_itself() -> None:
    label = fitted_names([START])[START]
    written = fitted_names([START, label])
    assert written[label] == label
    assert written[START] != label


@given(st.lists(st.text(max_size=100), unique=True, min_size=1, max_size=6))
@settings(
    max_examples=30, deadline=None, suppress_health_check=[HealthCheck.function_scoped_fixture]
)
def test_any_names_are_written_and_stay_apart(tmp_path: Path, names: list[str]) -> None:
    mode = ModeRecord(10.0, 0.01, tuple(names), np.ones((len(names), 6)))
    back = read_universal(write_universal(tmp_path / "x.uff", UniversalFile(modes=(mode,))))
    written = fitted_names(names)
    assert len(set(written.values())) == len(names)
    assert all(len(label) <= LONGEST_NAME for label in written.values())
    numbers = all(n.isascii() and n.isdigit() and n[0] != "0" and len(n) < 10 for n in names)
    assert numbers or back.modes[0].nodes == tuple(written[n] for n in names)
