"""Assurance criteria, paired modes and the comparison of two universal files."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays

from strutwork.errors import ModelError
from strutwork.fea.assurance import frac, in_span, mac, subspace_mac
from strutwork.fea.compare_files import compare_files
from strutwork.fea.frac_scale import frac_with_scale
from strutwork.fea.pairing import ModeSet, groups_of, pair_modes
from strutwork.fea.uff import FrfRecord, ModeRecord, UniversalFile

ENTRIES = st.floats(-10, 10).map(lambda x: 0.0 if abs(x) < 1e-3 else x)
SHAPES = arrays(float, (2, 2, 7), elements=ENTRIES).map(lambda a: a[0] + 1j * a[1])
#: Arithmetic of a dozen terms; far above rounding, far below anything a MAC is read for.
NEAR = 1e-10


def whole(shapes: np.ndarray[Any, Any]) -> np.ndarray[Any, Any]:
    """Shapes none of which is zero and that span a plane."""
    return shapes + np.eye(2, 7) * (100.0 + 0j)


@given(SHAPES, SHAPES)
def test_mac_lies_between_zero_and_one(a: Any, b: Any) -> None:
    found = mac(whole(a), whole(b))
    assert found.shape == (2, 2)
    assert np.all((found >= 0) & (found <= 1))


@given(SHAPES, st.floats(0.01, 100), st.floats(0, 2 * np.pi))
def test_mac_knows_no_scale_and_no_phase(a: Any, size: float, phase: float) -> None:
    turned = whole(a) * size * np.exp(1j * phase)
    assert np.diag(mac(whole(a), turned)) == pytest.approx(1.0, abs=NEAR)
    assert mac(turned, whole(a)[:1]) == pytest.approx(mac(whole(a), whole(a)[:1]), abs=NEAR)


def test_mac_by_hand() -> None:
    # |1·1 + 1·0|² / (2 · 1) = 1/2; orthogonal shapes give nothing
    assert mac([[1.0, 1.0, 0.0]], [[1.0, 0.0, 0.0], [1.0, -1.0, 0.0]]) == pytest.approx(
        np.array([[0.5, 0.0]]), abs=1e-15
    )
    # a travelling shape against its own standing part
    assert mac([[1.0, 1j]], [[1.0, 0.0]])[0, 0] == pytest.approx(0.5, abs=1e-15)


def test_mac_of_tiny_shapes_does_not_vanish() -> None:
    assert mac([[1e-200, 2e-200]], [[1e200, 2e200]])[0, 0] == pytest.approx(1.0, abs=NEAR)


@given(SHAPES, st.floats(0.2, 1.3))
def test_a_doublet_turned_in_its_plane_is_the_same_span(a: Any, angle: float) -> None:
    pair = whole(a)
    turn = np.array([[np.cos(angle), np.sin(angle)], [-np.sin(angle), np.cos(angle)]])
    assert subspace_mac(pair, turn @ pair) == pytest.approx(1.0, abs=NEAR)
    # cos² of the turn where the shapes are orthogonal: the plain MAC sees another mode
    square = np.eye(2, 7)
    assert np.diag(mac(square, turn @ square)) == pytest.approx(np.cos(angle) ** 2, abs=NEAR)


@given(SHAPES)
def test_spans_of_single_shapes_have_the_mac(a: Any) -> None:
    one, two = whole(a)[:1], whole(a)[1:] + 3.0
    assert subspace_mac(one, two) == pytest.approx(mac(one, two)[0, 0], abs=NEAR)


def test_angle_between_planes() -> None:
    # planes x-y and x-(y cos θ + z sin θ): one common line, largest angle θ
    angle = 0.4
    second = [[1.0, 0, 0], [0, np.cos(angle), np.sin(angle)]]
    assert subspace_mac(np.eye(2, 3), second) == pytest.approx(np.cos(angle) ** 2, abs=1e-14)
    assert in_span([[1.0, 1, 1]], np.eye(2, 3)) == pytest.approx(2 / 3)


@pytest.mark.parametrize(
    ("first", "second", "word"),
    [
        ([[1.0, 2.0]], [[1.0, 2.0, 3.0]], "2 and 3 entries"),
        ([[0.0, 0.0]], [[1.0, 2.0]], "zero everywhere"),
        ([[1.0, np.nan]], [[1.0, 2.0]], "not finite"),
    ],
)
def test_shapes_that_cannot_be_compared(first: Any, second: Any, word: str) -> None:
    with pytest.raises(ModelError, match=word):
        mac(first, second)


def response(lines: Any, frequencies: Any = (60.0, 140.0), ratio: float = 0.02) -> Any:
    """Two modes with residues of opposite sign."""
    return sum(
        sign / (f**2 - lines**2 + 2j * ratio * f * lines)
        for f, sign in zip(frequencies, (1.0, -2.0), strict=True)
    )


LINES = np.linspace(10, 200, 800)


@given(st.floats(0.1, 10), st.floats(0, 2 * np.pi))
@settings(max_examples=20)
def test_frac_of_the_same_response_is_one(size: float, phase: float) -> None:
    h = response(LINES)
    assert frac(h, size * np.exp(1j * phase) * h) == pytest.approx(1.0, abs=NEAR)
    found = frac_with_scale((LINES, h), (LINES, h))
    assert (found.frac, found.scale) == (pytest.approx(1.0, abs=NEAR), pytest.approx(1.0, abs=1e-6))
    assert not found.at_limit


@given(st.floats(0.85, 1.2))
@settings(max_examples=20, deadline=None)
def test_the_scale_between_two_responses_is_found(scale: float) -> None:
    measured = response(LINES / scale)
    found = frac_with_scale((LINES, response(LINES)), (LINES, measured))
    # cubic interpolation of 0.24 Hz lines in a peak 2.4 Hz wide is good to 1e-4 of the height
    assert found.scale == pytest.approx(scale, rel=2e-5)
    assert found.scaled_frac > 0.9999
    assert found.scaled_frac >= found.frac


def test_a_scale_beyond_the_search_is_said_to_be() -> None:
    measured = response(LINES / 1.1)
    found = frac_with_scale((LINES, response(LINES)), (LINES, measured), (0.95, 1.05))
    assert found.at_limit


@pytest.mark.parametrize("limits", [(1.1, 1.2), (0.0, 1.2), (0.8, np.nan), (0.8, 0.9)])
def test_limits_without_one_are_refused(limits: tuple[float, float]) -> None:
    with pytest.raises(ModelError, match="Include one"):
        frac_with_scale((LINES, response(LINES)), (LINES, response(LINES)), limits)


def test_bands_apart_are_refused() -> None:
    with pytest.raises(ModelError, match="have too little of the band in common"):
        frac_with_scale((LINES, response(LINES)), (LINES + 300, response(LINES)))


def mode_set(frequencies: Any, shapes: Any, ratios: Any = ()) -> ModeSet:
    return ModeSet(np.array(frequencies), np.array(shapes), ratios)


def test_modes_are_paired_by_shape_across_a_crossing() -> None:
    eye = np.eye(3, 5)
    computed = mode_set([100.0, 110.0, 300.0], eye, (0.01, None, 0.02))
    # the two lower modes have changed places
    measured = mode_set([95.0, 105.0, 310.0], eye[[1, 0, 2]])
    found = pair_modes(computed, measured)
    assert [(p.computed, p.measured) for p in found.modes] == [(1, 0), (0, 1), (2, 2)]
    assert [p.difference_percent for p in found.modes] == pytest.approx(
        [100 * 15 / 95, -100 * 5 / 105, -100 * 10 / 310]
    )
    assert [p.computed_damping for p in found.modes] == [None, 0.01, 0.02]
    assert [p.mac for p in found.modes] == pytest.approx([1.0] * 3)
    assert {p.group for p in found.modes} == {1}


def test_window_and_least_leave_modes_alone() -> None:
    eye = np.eye(2, 4)
    computed = mode_set([100.0, 200.0], eye)
    measured = mode_set([150.0, 200.0], [eye[0], eye[1] + 2 * np.eye(4)[2]])
    found = pair_modes(computed, measured)
    assert found.modes == ()
    assert (found.only_computed, found.only_measured) == ((100.0, 200.0), (150.0, 200.0))
    # of the two left over, one pair has one shape and lies too far apart; the other has not
    (note,) = found.notes
    assert note.startswith("computed 100 Hz and measured 150 Hz have the same shape (MAC 1.000)")
    assert "33 % apart: a wider window" in note
    wide = pair_modes(computed, measured, window=0.5, least=0.1)
    assert [round(p.mac, 12) for p in wide.modes] == [1.0, 0.2]
    assert wide.notes == ()


@given(st.floats(0, np.pi))
@settings(max_examples=30)
def test_a_doublet_is_paired_as_a_span(angle: float) -> None:
    rng = np.random.default_rng(3)
    shapes = rng.normal(size=(3, 8))
    turn = np.array([[np.cos(angle), np.sin(angle)], [-np.sin(angle), np.cos(angle)]])
    turned = np.concatenate([turn @ shapes[:2], shapes[2:]])
    # equal frequencies computed; 3 % apart measured, which is no group of its own
    found = pair_modes(mode_set([50, 50, 90], shapes), mode_set([49, 50.5, 92], turned))
    assert [(p.computed, p.measured) for p in found.modes] == [(0, 0), (1, 1), (2, 2)]
    assert [p.group for p in found.modes] == [2, 2, 1]
    assert [p.mac for p in found.modes] == pytest.approx([1.0] * 3, abs=NEAR)


def test_half_of_a_doublet_is_measured() -> None:
    shapes = np.eye(2, 6)
    found = pair_modes(mode_set([50, 50], shapes), mode_set([51.0], [[0.6, 0.8, 0, 0, 0, 0]]))
    assert [(p.measured, p.group) for p in found.modes] == [(0, 2)]
    assert found.modes[0].mac == pytest.approx(1.0)
    assert found.only_computed == (50.0,)


def test_groups_are_of_neighbours() -> None:
    assert groups_of([0, 0, 10, 10.05, 10.1, 12], 0.01) == [[0, 1], [2, 3, 4], [5]]


def test_options_that_make_no_sense() -> None:
    one = mode_set([1.0], [[1.0]])
    for wrong in ({"window": 0.0}, {"least": 1.5}, {"doublet": -0.1}):
        with pytest.raises(ModelError, match="pairing"):
            pair_modes(one, one, **wrong)


@pytest.mark.parametrize(
    ("frequencies", "shapes"), [([], np.zeros((0, 2))), ([2.0, 1.0], np.eye(2)), ([1.0], np.eye(2))]
)
def test_sets_that_are_none(frequencies: Any, shapes: Any) -> None:
    with pytest.raises(ModelError, match="modes"):
        mode_set(frequencies, shapes)


def record(frequency: float, nodes: tuple[str, ...], shape: Any) -> ModeRecord:
    full = np.zeros((len(nodes), 6), dtype=np.asarray(shape).dtype)
    full[:, :3] = shape
    return ModeRecord(frequency, None, nodes, full)


PLACES = {"a": np.array([0.0, 0, 0]), "b": np.array([1.0, 0, 0]), "c": np.array([0, 1.0, 0])}
BENT = np.array([[1.0, 0, 0], [0.5, 2, 0], [0, 0.3, 1]])


def test_nodes_with_other_names_are_found_by_their_place() -> None:
    computed = UniversalFile(modes=(record(10, ("a", "b", "c"), BENT),), positions=PLACES)
    # measured at two of the nodes, numbered otherwise, in the other order, 0.2 mm off
    moved = {"7": PLACES["c"] + 2e-4, "3": PLACES["b"]}
    measured = UniversalFile(modes=(record(11, ("7", "3"), -3 * BENT[[2, 1]]),), positions=moved)
    (pair,) = compare_files(computed, measured).modes
    assert pair.mac == pytest.approx(1.0)
    nowhere = {"7": PLACES["c"] + 0.1, "3": PLACES["b"] + 0.1}
    apart = UniversalFile(modes=measured.modes, positions=nowhere)
    with pytest.raises(ModelError, match="no node in common: a, b, c computed, 7, 3 measured"):
        compare_files(computed, apart)


def test_directions_that_nobody_measured_do_not_count() -> None:
    computed = UniversalFile(modes=(record(10, ("a", "b", "c"), BENT),))
    seen = BENT * np.array([1.0, 0, 0])
    measured = UniversalFile(modes=(record(10, ("a", "b", "c"), seen),))
    assert compare_files(computed, measured).modes[0].mac == pytest.approx(1.0)


def test_responses_are_compared_across_motions_and_by_reciprocity() -> None:
    h = response(LINES)
    computed = UniversalFile((FrfRecord(("a", "x"), ("b", "y"), LINES, h),))
    w = 2 * np.pi * LINES
    swapped = FrfRecord(("b", "y"), ("a", "x"), LINES, -(w**2) * h, "acceleration")
    (pair,) = compare_files(computed, UniversalFile((swapped,))).functions
    assert (pair.output, pair.input, pair.motion) == ("b:y", "a:x", "acceleration")
    assert pair.found.frac == pytest.approx(1.0, abs=NEAR)


def test_files_with_nothing_in_common() -> None:
    h = FrfRecord(("a", "x"), ("b", "y"), LINES, response(LINES))
    other = FrfRecord(("a", "x"), ("c", "y"), LINES, response(LINES))
    with pytest.raises(ModelError, match=r"nothing in common.*a:x / b:y.*a:x / c:y"):
        compare_files(UniversalFile((h,)), UniversalFile((other,)))


def test_results_as_plain_numbers_and_as_a_table() -> None:
    found = pair_modes(mode_set([10.0], [[1.0, 2.0]], (0.02,)), mode_set([8.0], [[1.0, 2.0]]))
    (row,) = found.to_dict()["modes"]
    assert row["difference_percent"] == pytest.approx(25.0)
    table = found.to_dataframe()
    assert list(table["computed_damping"]) == [0.02]
    assert list(table["measured_frequency"]) == [8.0]
