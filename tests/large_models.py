"""Model files near the limits: long frames, many supports, many bushings, many joints."""

from __future__ import annotations

HEAD = """\
title = "{title}"
[materials.steel]
youngs_modulus = "210 GPa"
poissons_ratio = 0.3
density = 7850
[sections.bar]
shape = "rectangle"
width_y = "60 mm"
height_z = "80 mm"
[damping]
modal_ratio = 0.01
"""


def supported_frame(supports: int = 900, divided: int = 6) -> str:
    """Trestles in a row along x: two legs with feet on ground, and a rail along their heads.

    900 supports and six elements a beam make 10 800 nodes and a few: near both limits.
    """
    lines = [HEAD.format(title="trestles in a row")]
    count = supports // 2
    nodes, beams, held = ["[nodes]"], [], []
    for i in range(count):
        nodes += [
            f"L{i} = [{0.5 * i}, 0, 0]",
            f"R{i} = [{0.5 * i}, 1.0, 0]",
            f"T{i} = [{0.5 * i}, 0.5, 1.2]",
        ]
        beams += [_beam(f"l{i}", f"L{i}", f"T{i}", divided)]
        beams += [_beam(f"r{i}", f"R{i}", f"T{i}", divided)]
        if i:
            beams.append(_beam(f"t{i}", f"T{i - 1}", f"T{i}", 2 * divided))
        held += [_support(f"L{i}", "fixed"), _support(f"R{i}", "spherical")]
    load = _load(f"T{count // 2}", (100, 200, -1000))
    tool = f'[tool]\ntcp = "T{count // 2}"'
    return "\n".join([*lines, *nodes, *beams, *held, load, tool, ""])


def bushing_chain(count: int = 990, *, rigid: bool = True) -> str:
    """Bars in a row on bushings, every one to the one before and the first to ground."""
    lines = [HEAD.format(title="bars on bushings"), "[nodes]"]
    for i in range(count):
        lines += [f"a{i} = [{0.1 * i}, 0, 0]", f"b{i} = [{0.1 * i + 0.1}, 0, 0]"]
    # ground is a node held on all sides, for a joint has two nodes
    lines.append("base = [0, 0, 0]")
    joints = [_support("base", "fixed")]
    for i in range(count):
        joints += [
            f'[[bodies]]\nname = "bar{i}"\nnodes = ["a{i}", "b{i}"]\nmass = 3.8\n'
            "inertia = [[0.01, 0, 0], [0, 0.01, 0], [0, 0, 0.01]]"
            if rigid
            else _beam(f"bar{i}", f"a{i}", f"b{i}", 1)
        ]
        first = '"base"' if i == 0 else f'"b{i - 1}"'
        joints.append(
            f'[[joints]]\nname = "k{i}"\ntype = "bushing"\nbetween = [{first}, "a{i}"]\n'
            'stiffness = { x = "900 N/um", y = "900 N/um", z = "900 N/um", '
            "rx = 5e6, ry = 5e6, rz = 5e6 }"
        )
    load = _load(f"b{count - 1}", (0, 1, 0))
    tool = f'[tool]\ntcp = "b{count - 1}"'
    return "\n".join([*lines, *joints, load, tool, ""])


def _beam(name: str, start: str, end: str, elements: int) -> str:
    return (
        f'[[beams]]\nname = "{name}"\nfrom = "{start}"\nto = "{end}"\nmaterial = "steel"\n'
        f'section = "bar"\nelements = {elements}'
    )


def _support(node: str, kind: str) -> str:
    fixed = '"all"' if kind == "fixed" else '["x", "y", "z"]'
    return f'[[supports]]\nnode = "{node}"\nfixed = {fixed}'


def _load(node: str, force: tuple[float, float, float]) -> str:
    return f'[[loads]]\nnode = "{node}"\nforce = {list(force)}'


def toleranced(model: str, joints: list[str]) -> str:
    """A model with a flatness of 20 µm at each of the joints."""
    return model + "".join(
        f'[[tolerances]]\nname = "t{i}"\nkind = "flatness"\njoint = "{joint}"\n'
        'size = "20 um"\naxis = [0, 0, 1]\nlength = "50 mm"\nalong = [1, 0, 0]\nwidth = "50 mm"\n'
        for i, joint in enumerate(joints)
    )
