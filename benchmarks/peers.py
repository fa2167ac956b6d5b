"""The same frame in other programs, driven as fast as they go."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from benchmarks.frame import SECTION, STEEL
from strutwork.msa import Structure

Array = NDArray[Any]


def opensees_compliance(structure: Structure, positions: Array) -> Array:
    """Tool compliance with OpenSeesPy at every geometry, (p, 6, 6).

    BandSPD with `algorithm Linear -factorOnce`: one factorisation a pose, six solutions; node
    coordinates as lists, not arrays, which the interface takes faster.
    """
    import openseespy.opensees as ops  # noqa: PLC0415 - a benchmark extra

    index = structure.linkage.node_index
    names = [n for n in structure.linkage.nodes if not n.startswith("ground")]
    tags = {name: k + 1 for k, name in enumerate(names)}
    rows = [index[n] for n in names]
    beams = [(k + 1, tags[b.nodes[0]], tags[b.nodes[1]]) for k, b in enumerate(structure.beams)]
    ups = [2 if b.nodes == ("T", "S") else 1 for b in structure.beams]
    clamped = [tags[f"{leg}.0"] for leg in range(3)]
    tool = tags["T"]
    unit = [[1.0 if i == k else 0.0 for i in range(6)] for k in range(6)]
    section = (
        SECTION.area,
        STEEL.youngs_modulus,
        STEEL.shear_modulus,
        SECTION.torsion_constant,
        SECTION.second_moment_y,
        SECTION.second_moment_z,
    )
    result = np.empty((len(positions), 6, 6))
    for pose, points in enumerate(positions[:, rows].tolist()):
        ops.wipe()
        ops.model("basic", "-ndm", 3, "-ndf", 6)
        for tag, point in enumerate(points, start=1):
            ops.node(tag, *point)
        for tag in clamped:
            ops.fix(tag, 1, 1, 1, 1, 1, 1)
        ops.geomTransf("Linear", 1, 0.0, 0.0, 1.0)
        ops.geomTransf("Linear", 2, 0.0, 1.0, 0.0)
        for (tag, first, second), up in zip(beams, ups, strict=True):
            ops.element("elasticBeamColumn", tag, first, second, *section, up)
        ops.timeSeries("Constant", 1)
        ops.constraints("Plain")
        ops.numberer("RCM")
        ops.system("BandSPD")
        ops.integrator("LoadControl", 1.0)
        ops.algorithm("Linear", "-factorOnce")
        ops.analysis("Static", "-noWarnings")
        for k in range(6):
            ops.pattern("Plain", k + 1, 1)
            ops.load(tool, *unit[k])
            if ops.analyze(1) != 0:
                message = f"OpenSees did not solve pose {pose}"
                raise RuntimeError(message)
            result[pose, :, k] = ops.nodeDisp(tool)
            ops.remove("loadPattern", k + 1)
    ops.wipe()
    return result


def opensees_frequencies(structure: Structure, positions: Array, count: int) -> Array:
    """Lowest frequencies with OpenSeesPy at every geometry, Hz, (p, count).

    Consistent mass without rotary inertia; `-fullGenLapack`, its faster solver at this size.
    """
    import openseespy.opensees as ops  # noqa: PLC0415 - a benchmark extra

    index = structure.linkage.node_index
    names = [n for n in structure.linkage.nodes if not n.startswith("ground")]
    tags = {name: k + 1 for k, name in enumerate(names)}
    rows = [index[n] for n in names]
    density = STEEL.density
    if density is None:
        message = "the benchmark's steel has no density"
        raise RuntimeError(message)
    per_length = density * SECTION.area
    section = (
        SECTION.area,
        STEEL.youngs_modulus,
        STEEL.shear_modulus,
        SECTION.torsion_constant,
        SECTION.second_moment_y,
        SECTION.second_moment_z,
    )
    result = np.empty((len(positions), count))
    for pose, points in enumerate(positions[:, rows].tolist()):
        ops.wipe()
        ops.model("basic", "-ndm", 3, "-ndf", 6)
        for tag, point in enumerate(points, start=1):
            ops.node(tag, *point)
        for leg in range(3):
            ops.fix(tags[f"{leg}.0"], 1, 1, 1, 1, 1, 1)
        ops.geomTransf("Linear", 1, 0.0, 0.0, 1.0)
        ops.geomTransf("Linear", 2, 0.0, 1.0, 0.0)
        for k, beam in enumerate(structure.beams):
            up = 2 if beam.nodes == ("T", "S") else 1
            ends = (tags[beam.nodes[0]], tags[beam.nodes[1]])
            ops.element(
                "elasticBeamColumn", k + 1, *ends, *section, up, "-mass", per_length, "-cMass"
            )
        result[pose] = np.sqrt(ops.eigen("-fullGenLapack", count)) / (2.0 * np.pi)
    ops.wipe()
    return result


def pynite_compliance(structure: Structure, positions: Array) -> Array:
    """Tool compliance with PyNite at every geometry, (p, 6, 6); one model, six combinations."""
    from Pynite import FEModel3D  # noqa: PLC0415 - a benchmark extra

    index = structure.linkage.node_index
    names = [n for n in structure.linkage.nodes if not n.startswith("ground")]
    directions = ("FX", "FY", "FZ", "MX", "MY", "MZ")
    result = np.empty((len(positions), 6, 6))
    for pose, points in enumerate(positions):
        model = FEModel3D()
        model.add_material("steel", STEEL.youngs_modulus, STEEL.shear_modulus, 0.29, 7870.0)
        model.add_section(
            "tube",
            SECTION.area,
            SECTION.second_moment_y,
            SECTION.second_moment_z,
            SECTION.torsion_constant,
        )
        for name in names:
            model.add_node(name, *(float(x) for x in points[index[name]]))
        for beam in structure.beams:
            model.add_member(beam.name, *beam.nodes, "steel", "tube")
        for leg in range(3):
            model.def_support(f"{leg}.0", True, True, True, True, True, True)
        for direction in directions:
            model.add_node_load("T", direction, 1.0, case=direction)
            model.add_load_combo(direction, {direction: 1.0})
        model.analyze_linear()
        node = model.nodes["T"]
        for k, combo in enumerate(directions):
            result[pose, :, k] = [
                node.DX[combo],
                node.DY[combo],
                node.DZ[combo],
                node.RX[combo],
                node.RY[combo],
                node.RZ[combo],
            ]
    return result
