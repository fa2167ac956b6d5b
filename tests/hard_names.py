"""Legal names that are hard to write, and a model whose every part bears one."""

from __future__ import annotations

import json
from itertools import pairwise

#: As long as a name may be; two differ in the last character alone.
LONG = "n" * 99

#: Node, beam, joint, case, support: markup, formulas, fields of templates, ends of scripts, long.
NODES = (
    "<img src=x onerror=alert(1)>" + "<b>" * 24,
    LONG + "1",
    LONG + "2",
    '=HYPERLINK("http://x","y")',
    "+1+2",
    "@SUM(A1)",
    "-2+3",
    "[red]東京 %{x}</script>",
    "007",
)
BEAM = "'\"--><script>document.title='taken'</script>" + "x" * 55
JOINT = "=joint[/bold]" + "é" * 87
CASE = "</script><script>document.title='taken'</script> :smile: a.b/c"


def hard_model(title: str = "=title <i>") -> str:
    """A chain of beams with a joint at its end, as the text of a model file."""
    q = json.dumps
    lines = [
        f"title = {q(title)}",
        "[materials.steel]",
        'youngs_modulus = "210 GPa"',
        "poissons_ratio = 0.3",
        'density = "7850 kg/m^3"',
        '[sections."=bar"]',
        'shape = "rectangle"',
        'width_y = "20 mm"',
        'height_z = "30 mm"',
        "[nodes]",
    ]
    at = [0.1 * i for i in range(len(NODES) - 1)]
    # the last two stand at one place: the joint's
    lines += [f"{q(n)} = [{x}, 0, 0]" for n, x in zip(NODES, [*at, at[-1]], strict=True)]
    lines.append('end = [1.2, 0, "50 mm"]')
    chain = [*pairwise(NODES[:-1]), (NODES[-1], "end")]
    for i, (a, b) in enumerate(chain):
        name = BEAM[:98] + f"{i:02d}"
        lines += ["[[beams]]", f"name = {q(name)}", f"from = {q(a)}", f"to = {q(b)}"]
        lines += ['material = "steel"', 'section = "=bar"']
    lines += ["[[joints]]", f"name = {q(JOINT)}", 'type = "revolute"']
    lines += [f"between = [{q(NODES[-2])}, {q(NODES[-1])}]", "axis = [0, 1, 0]"]
    lines += ['driven = ["rz"]', 'stiffness = { rz = "1e4 N*m/rad" }']
    lines += ["[[supports]]", f"node = {q(NODES[0])}", 'fixed = "all"']
    lines += ["[[loads]]", f"case = {q(CASE)}", f"node = {q(NODES[1])}", "force = [0, 0, -100]"]
    lines += ["[tool]", f"tcp = {q(NODES[2])}", "[damping]", "modal_ratio = 0.02"]
    return "\n".join(lines) + "\n"
