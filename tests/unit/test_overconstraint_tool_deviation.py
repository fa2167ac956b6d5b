from __future__ import annotations

from dataclasses import replace
from importlib import import_module

import numpy as np
import pytest

from strutwork.errors import ModelError, NumericalError
from strutwork.overconstraint import (
    Disc,
    Interval,
    Responses,
    assembly_forces,
    tolerance_responses,
    tool_deviation,
    worst_case,
)
from strutwork.overconstraint.sources import Block
from strutwork.overconstraint.tool_deviation import _sphere
from tests.three_struts import case, one_of_each, three_struts, tilted_axes


def with_blocks(gain: np.ndarray, shapes: list[Disc | Interval]) -> Responses:
    """Responses whose tool moves by `gain` (3, k) z."""
    responses = case()
    columns = responses.influence.columns[:3]
    tool = np.zeros((6, 3))
    tool[:3] = np.eye(3)
    blocks, start = [], 0
    for shape in shapes:
        blocks.append(Block(0, shape, start))
        start += shape.dimension
    found = replace(
        responses.influence,
        columns=columns,
        forces=responses.influence.forces[..., :3],
        tool=tool,
    )
    sources = replace(
        responses.sources, blocks=tuple(blocks), columns=columns, map=gain, mean=np.zeros(3)
    )
    rows = np.zeros((len(responses.quantities), 2, start))
    return replace(responses, gain=rows, sources=sources, influence=found)


@pytest.mark.parametrize("tolerances", [tilted_axes(), one_of_each()])
def test_largest_displacement_is_above_a_dense_search_and_reached(tolerances: list) -> None:
    worst = worst_case(case(tolerances))
    found = tool_deviation(worst)
    responses = worst.responses
    first = responses.index(None, "displacement")
    gain, mean = responses.gain[first : first + 3, 0], responses.mean[first : first + 3, 0]
    e = np.random.default_rng(0).normal(size=(100_000, 3))
    e /= np.linalg.norm(e, axis=-1, keepdims=True)
    dense = (e @ mean + responses.sources.supports(e @ gain).sum(axis=-1)).max()
    assert dense * (1 - 1e-9) <= found.bound
    assert found.largest == pytest.approx(dense, rel=1e-3)
    assert found.bound <= found.largest * (1 + 1.1e-4)
    assert np.allclose(found.along, worst.value[first : first + 3], rtol=1e-9)
    moved = assembly_forces(responses.influence, found.misfits).tool[:3]
    assert np.allclose(moved, found.displacement, rtol=1e-12, atol=1e-18)
    assert np.linalg.norm(moved) == pytest.approx(float(found.largest), rel=1e-12)


def test_a_parallelepiped_is_farthest_at_a_corner() -> None:
    gain = np.array([[3.0, 1.0, 0.2], [0.5, -2.0, 1.0], [0.1, 0.4, 2.5]])
    found = tool_deviation(worst_case(with_blocks(gain, [Interval()] * 3)))
    corners = np.array([[a, b, c] for a in (-1, 1) for b in (-1, 1) for c in (-1, 1)])
    exact = np.linalg.norm(corners @ gain.T, axis=-1).max()
    assert found.largest == pytest.approx(exact, rel=1e-12)
    assert exact <= found.bound <= exact * (1 + 1.1e-4)


def test_an_ellipse_and_a_segment() -> None:
    ellipse = np.array([[2.0, 0.0], [0.0, 1.0], [1.0, 3.0]])
    found = tool_deviation(worst_case(with_blocks(ellipse, [Disc()])), 1e-6)
    exact = np.linalg.svd(ellipse, compute_uv=False)[0]
    assert found.largest <= exact * (1 + 1e-12)
    assert exact <= found.bound * (1 + 1e-12)
    segment = np.array([[1.0], [2.0], [2.0]])
    assert tool_deviation(worst_case(with_blocks(segment, [Interval()]))).largest == pytest.approx(
        3
    )


def test_a_still_tool_and_no_tolerance() -> None:
    still = tool_deviation(worst_case(with_blocks(np.zeros((3, 1)), [Interval()])))
    assert still.largest == 0
    assert still.bound == 0
    none = tool_deviation(worst_case(case([])))
    assert none.largest == 0


def test_a_certificate_that_cannot_be_had(monkeypatch: pytest.MonkeyPatch) -> None:
    # the package has a function of the module's name
    monkeypatch.setattr(import_module("strutwork.overconstraint.tool_deviation"), "MOST", 2000)
    worst = worst_case(with_blocks(np.eye(3), [Interval(), Disc()]))
    assert tool_deviation(worst, 1e-2).largest == pytest.approx(np.sqrt(2), rel=1e-9)
    with pytest.raises(NumericalError, match="larger tolerance"):
        tool_deviation(worst, 1e-9)


def test_starting_triangles_cover_the_sphere() -> None:
    triangles = _sphere()
    a, b, c = (triangles[:, i] for i in range(3))
    volume = np.abs(np.einsum("mi,mi->m", a, np.cross(b, c)))
    dots = [np.einsum("mi,mi->m", p, q) for p, q in ((a, b), (b, c), (c, a))]
    angle = 2 * np.arctan2(volume, 1 + sum(dots))
    assert len(triangles) == 320
    assert angle.sum() == pytest.approx(4 * np.pi)


def test_a_linkage_without_a_tool() -> None:
    placed = three_struts()
    linkage = replace(placed.structure.linkage, tool=None)
    placed = replace(placed.structure, linkage=linkage).at(placed.placement)
    worst = worst_case(tolerance_responses(placed, tilted_axes()))
    with pytest.raises(ModelError, match="the linkage has none"):
        tool_deviation(worst)


def test_what_it_writes_down() -> None:
    written = tool_deviation(worst_case(case())).to_dict()
    assert len(written["along"]) == 3
    assert written["bound"] >= written["largest"]
