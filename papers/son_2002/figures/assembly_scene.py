"""What a worst case looks like: struts and machine at rest and with their misfits exaggerated."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from strutwork.machines import MitSS1
from strutwork.machines import mit_ss1_parts as parts
from strutwork.papers.son_2002 import strut_assembly as assembly_parts
from strutwork.papers.son_2002.figures.planar_machine import CAMERA
from strutwork.papers.son_2002.strut_assembly import StrutAssembly
from strutwork.reports.figures.assembly_scene import ARROW, AssembledShape
from strutwork.reports.figures.misfits import Lines3D, misfit_view

Array = NDArray[Any]

REST, MADE, STRAINED = "#9aa5b1", "#d55e00", "#0072b2"


def strut_assembly_view(assembly: StrutAssembly, shape: AssembledShape) -> dict[str, Any]:
    """Table 2's structure: struts on their tilted axes and the end-effector between them."""
    rest, made, strained = [], [], []
    for i in (1, 2, 3):
        base, wide = shape.at[assembly_parts.block(i)], np.array([0.0, assembly.width, 0.0])
        far, near = assembly_parts.joint(2 * i - 1), assembly_parts.joint(2 * i)
        ends = [shape.at[assembly_parts.strut_end(n)] for n in (2 * i - 1, 2 * i)]
        gap = [shape.factor * shape.misfits[n] for n in (far, near)]
        # the strut follows its axis: both of its ends turn alike
        corners = [base + wide, ends[0], ends[1], base]
        turned = [base + wide + gap[0] - gap[1], ends[0] + gap[0], ends[1] + gap[1], base]
        rest += _closed(corners)
        made += _closed(turned)
        strained += [
            (ends[k] + gap[k], shape.drawn(assembly_parts.seat(n)))
            for k, n in enumerate((2 * i - 1, 2 * i))
        ]
    seats = [[assembly_parts.seat(n) for n in numbers] for numbers in ((1, 3, 5), (2, 4, 6))]
    frame_rest, frame_moved = [], []
    for some in seats:
        frame_rest += _closed([shape.at[n] for n in some])
        frame_moved += _closed([shape.drawn(n) for n in some])
    for first, second in zip(*seats, strict=True):
        frame_rest.append((shape.at[first], shape.at[second]))
        frame_moved.append((shape.drawn(first), shape.drawn(second)))
    lines = [
        Lines3D("as designed", [*rest, *frame_rest], REST, 3),
        Lines3D("struts on their tilted axes, unassembled", made, MADE, 6),
        Lines3D("end-effector in equilibrium", frame_moved, STRAINED, 6),
        Lines3D("spring deflection of a joint", strained, "#000000", 4, "dot"),
    ]
    names = [assembly_parts.joint(n) for n in range(1, 7)]
    points = {name: shape.drawn(assembly_parts.seat(n)) for n, name in enumerate(names, start=1)}
    return misfit_view(lines, points, {n: shape.forces[n] for n in names}, ARROW * shape.size)


def machine_misfit_view(machine: MitSS1, shape: AssembledShape) -> dict[str, Any]:
    """The machine: pins as made, struts and housing strained between them."""
    rest = [(shape.at[a], shape.at[b]) for a, b in machine.skeleton()]
    strained = [(shape.drawn(a), shape.drawn(b)) for a, b in machine.skeleton()]
    made = []
    for i in parts.STRUTS:
        near, far = (
            shape.drawn(parts.block(i, s))
            + shape.factor * shape.misfits[parts.strut(i, "block", s)]
            for s in parts.SIDES
        )
        made.append(_extended(near, far))
        near, far = (
            shape.drawn(parts.seat(i, s))
            - shape.factor * shape.misfits[parts.strut(i, "housing", s)]
            for s in parts.SIDES
        )
        made.append(_extended(near, far))
    lines = [
        Lines3D("as designed", rest, REST, 3),
        Lines3D("axes of the pins as made", made, MADE, 8),
        Lines3D("struts and housing, assembled", strained, STRAINED, 5),
    ]
    names = parts.bearings()
    index = {j.name: j for j in machine.linkage.joints}
    points = {n: shape.drawn(index[n].between[1]) for n in names}
    figure = misfit_view(lines, points, {n: shape.forces[n] for n in names}, ARROW * shape.size)
    figure["layout"]["scene"]["camera"] = CAMERA
    return figure


def _closed(corners: list[Array]) -> list[tuple[Array, Array]]:
    return list(zip(corners, [*corners[1:], corners[0]], strict=True))


def _extended(near: Array, far: Array) -> tuple[Array, Array]:
    """An axis drawn a little beyond its bearings."""
    return near - 0.25 * (far - near), far + 0.25 * (far - near)
