"""A dozen random space frames against OpenSees, both beam theories.

@misc{zhu2018,
  author = {Zhu, Minjie and McKenna, Frank and Scott, Michael H.},
  title  = {{OpenSeesPy}: {Python} library for the {OpenSees} finite element framework},
  note   = {SoftwareX 7 (2018) 6--11},
}

`elasticBeamColumn` is compared with Euler-Bernoulli beams, `ElasticTimoshenkoBeam` with
Timoshenko beams of the same shear areas. Both codes hold the exact stiffness of the same
element, so they differ by the round-off of frames of condition 1e6: 1e-9 of the largest part.
"""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from strutwork.msa import PlacedStructure, solve, tool_compliance
from tests.random_frames import random_frame, random_load

TOLERANCE = 1e-9
frames = pytest.mark.parametrize("seed", range(12))
theories = pytest.mark.parametrize("shear", [True, False], ids=["Timoshenko", "Euler-Bernoulli"])


@pytest.fixture(scope="module")
def ops() -> Any:
    try:
        from openseespy import opensees  # noqa: PLC0415 - an extra that may be missing
    except ImportError as error:
        pytest.fail(
            f"OpenSeesPy cannot be imported ({error}). These tests need the extra `bench`: "
            "pip install -e '.[bench]'."
        )
    return opensees


def build(ops: Any, placed: PlacedStructure) -> None:
    """The frame in OpenSees; node n of the mesh has tag n + 1."""
    structure = placed.structure
    ops.wipe()
    ops.model("basic", "-ndm", 3, "-ndf", 6)
    ground = set(np.flatnonzero(structure.linkage.body_of_node < 0).tolist())
    for n, point in enumerate(placed.positions):
        if n not in ground:
            ops.node(n + 1, *point.tolist())
    held = {structure.linkage.node_index[j.between[1]] for j in structure.linkage.joints}
    assert len(held) == 1
    ops.fix(held.pop() + 1, *([1] * 6))
    for s, (b, first, second) in enumerate(structure.segments.tolist()):
        beam = structure.beams[b]
        ops.geomTransf("Linear", s + 1, *beam.orientation)
        e, g, section = beam.material.youngs_modulus, beam.material.shear_modulus, beam.section
        bending = (section.torsion_constant, section.second_moment_y, section.second_moment_z)
        ends = (first + 1, second + 1)
        areas = section.shear_area(beam.material.poissons_ratio)
        if beam.shear and areas is not None:
            ops.element(
                "ElasticTimoshenkoBeam", s + 1, *ends, e, g, section.area, *bending, *areas, s + 1
            )
        else:
            ops.element("elasticBeamColumn", s + 1, *ends, section.area, e, g, *bending, s + 1)


def solved(ops: Any, loads: list[tuple[int, list[float]]], count: int) -> np.ndarray:
    """Displacements of the mesh nodes, (n, 6)."""
    ops.timeSeries("Constant", 1)
    ops.pattern("Plain", 1, 1)
    for tag, six in loads:
        ops.load(tag, *six)
    for command, kind in (
        (ops.system, "FullGeneral"),
        (ops.numberer, "Plain"),
        (ops.constraints, "Plain"),
        (ops.algorithm, "Linear"),
    ):
        command(kind)
    ops.integrator("LoadControl", 1.0)
    ops.analysis("Static")
    assert ops.analyze(1) == 0
    known = set(ops.getNodeTags())
    result = [ops.nodeDisp(n + 1) if n + 1 in known else [0.0] * 6 for n in range(count)]
    return np.asarray(result)


@frames
@theories
def test_displacements_and_end_forces(ops: Any, seed: int, shear: bool) -> None:
    model = random_frame(1000 + seed, nodes=7, shear=shear)
    load = random_load(seed, model)
    placed = model.place()
    found = solve(placed, [load])
    build(ops, placed)
    index = placed.structure.mesh_index
    nodal = [(index[node] + 1, list(six)) for node, six in load.wrenches]
    expected = solved(ops, nodal, len(index))
    gap = np.abs(found.displacements[..., 0] - expected)
    for part in (slice(0, 3), slice(3, 6)):
        assert gap[:, part].max() <= TOLERANCE * np.abs(expected[:, part]).max()
    largest = np.abs(found.beam_forces).max()
    for b, beam in enumerate(placed.structure.beams):
        tags = [s + 1 for s, (owner, _, _) in enumerate(placed.structure.segments) if owner == b]
        assert len(tags) == beam.elements
        first = np.asarray(ops.eleResponse(tags[0], "localForces"))[:6]
        last = np.asarray(ops.eleResponse(tags[-1], "localForces"))[6:]
        gap = np.abs(found.beam_forces[b, ..., 0] - [first, last])
        # forces are differences of displacements times large stiffnesses
        assert gap.max() <= 10 * TOLERANCE * largest


@frames
@theories
def test_compliance_at_the_tool(ops: Any, seed: int, shear: bool) -> None:
    model = random_frame(2000 + seed, nodes=5, shear=shear)
    placed = model.place()
    tool = placed.structure.mesh_index[model.tool or ""]
    columns = []
    for direction in range(6):
        build(ops, placed)
        six = [0.0] * 6
        six[direction] = 1.0
        columns.append(solved(ops, [(tool + 1, six)], tool + 1)[tool])
    expected = np.stack(columns, axis=-1)
    for method in ("saddle_point", "compiled"):
        gap = np.abs(tool_compliance(placed, method) - expected)  # type: ignore[arg-type]
        assert gap.max() <= TOLERANCE * np.abs(expected).max()
