"""Element types of Abaqus and CalculiX: what each is, and the order of its nodes and sides."""

from __future__ import annotations

import re

#: meshio's kind by the letters and the node count of a solid's type.
SOLIDS = {
    4: "tetra", 5: "pyramid", 6: "wedge", 8: "hexahedron", 10: "tetra10", 13: "pyramid13",
    15: "wedge15", 18: "wedge18", 20: "hexahedron20", 27: "hexahedron27",
}  # fmt: skip
#: Solids of stress analysis: C3D8, C3D8R, C3D10M, C3D20RH, C3D8I, C3D27, …
SOLID = re.compile(r"C3D(\d+)[A-Z]*$")
#: Faces: shells, membranes, surfaces, rigid and plane elements.
FACE = re.compile(r"(?:S|M3D|SFM3D|R3D|CPS|CPE|CPEG|CAX|DS|STRI|ACIN3D)([34689])[A-Z0-9]*$")
FACES = {"3": "triangle", "4": "quad", "6": "triangle6", "8": "quad8", "9": "quad9"}
#: Points and lines beside solids: masses, springs, dashpots, beams, trusses, connectors, …
POINT_OR_LINE = re.compile(
    r"(MASS|ROTARYI|HEATCAP|SPRING|DASHPOT|CONN[23]D2|JOINTC|ITSUNI|ITSCYL|GAP|DGAP|DCOUP[23]D|"
    r"B[23][123]|T[23]D[23]|PIPE[23]|ELBOW|FRAME[23]D|R2D2|RB[23]D2|RAX2|SFMAX|MCL|"
    r"DISTCOUP|KINCOUP|PSI|DC1D|AC1D|U\d*$|SAX|MAX|DSAX)"
)
#: Our faces in the order of Abaqus' S1, S2, …
FACE_ORDER = {"hexahedron": (4, 5, 2, 1, 3, 0), "tetra": (0, 1, 2, 3)}
#: Abaqus' place of each node of ours, where it is another: of 27 nodes the middle comes before
#: the middles of S1 to S6.
NODE_ORDER = {"hexahedron27": (*range(20), 26, 24, 23, 25, 21, 22, 20)}


def kind_of(type_: str) -> str | None:
    """Meshio's kind of an element type; empty for points and lines, None where unknown.

    Parameters
    ----------
    type_ : str
        As in `C3D8R`; capitals do not count.
    """
    name = type_.upper().strip()
    if match := SOLID.match(name):
        return SOLIDS.get(int(match[1]))
    if POINT_OR_LINE.match(name):
        return ""
    if match := FACE.match(name):
        return FACES[match[1]]
    return None
