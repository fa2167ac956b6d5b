"""Modes of the MIT-SS-1 whole, named by what moves, beside the published ones."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from types import MappingProxyType
from typing import Any, get_args

import numpy as np
from numpy.typing import NDArray

from strutwork.fea.modes import Modes, searched_modes
from strutwork.fea.validity import warn_beyond
from strutwork.kinematics import GROUND, Poses
from strutwork.machines import mit_ss1_parts as parts
from strutwork.machines.mit_ss1_frame import RAILS, rail_foot
from strutwork.machines.mit_ss1_whole import MitSS1Whole
from strutwork.meshes.boundary import boundary
from strutwork.msa.structure import rigid_map
from strutwork.papers.published_rows import PublishedRow
from strutwork.papers.son_2002.calibrated import Which, calibrated_machine
from strutwork.papers.son_2002.published import MODES, MOUNT_MODES
from strutwork.studies.mode_matching import matched, pattern_shares

Array = NDArray[Any]

TILT, STRUTS, SCREW = "spindle housing tilt", "strut assembly bending", "ball screw"
BENDING, TWISTING = "granite bending", "granite twisting"

#: Directions in which the moving structure takes part in its modes: the housing tilts about the
#: tool tip, where the lines of struts 1 and 2 meet, so that its middle goes along x.
MOVING: Mapping[str, int] = MappingProxyType({TILT: 0, STRUTS: 1, SCREW: 2})

#: Published rigid-body modes and ours. The thesis shows their shapes in pictures only; 22.6 Hz
#: is read as the one of the two lowest modes that lies nearer, along y.
MOUNT_ROWS: Mapping[str, str] = MappingProxyType(
    {
        "rigid body 1": "rigid body 2",
        "rigid body 3": "rigid body 3",
        "rigid body 4": "rigid body 4",
    }
)

#: Modes that are searched for the patterns: to nearly 500 Hz.
COUNT = 18


@dataclass(frozen=True, repr=False)
class NamedModes:
    """Modes of the entire machine at one pose with names for those that have one.

    Parameters
    ----------
    whole : MitSS1Whole
    modes : Modes
    index : mapping of str to int
        Mode by name.
    shares : mapping of str to float
        How much of the name's pattern the mode holds, see `pattern_shares`.
    """

    whole: MitSS1Whole
    modes: Modes
    index: Mapping[str, int]
    shares: Mapping[str, float]

    def __repr__(self) -> str:
        return f"<NamedModes: {', '.join(f'{n} {f:.4g} Hz' for n, f in self.frequencies.items())}>"

    @property
    def frequencies(self) -> dict[str, float]:
        """Hz, by name, ascending."""
        found = {n: float(self.modes.frequencies[i]) for n, i in self.index.items()}
        return dict(sorted(found.items(), key=lambda item: item[1]))

    def energies(self, name: str, least: float = 0.05) -> dict[str, float]:
        """Shares of parts in the strain energy of a mode, largest first, from `least` on."""
        shares = self.modes.energy_shares[self.index[name]]
        pairs = zip(self.modes.energy_parts, shares.tolist(), strict=True)
        return dict(sorted(((p, s) for p, s in pairs if s >= least), key=lambda x: -x[1]))

    def to_dict(self) -> dict[str, Any]:
        """Frequency, pattern share and strain energy shares of each named mode."""
        return {
            name: {
                "frequency": frequency,
                "mode": int(self.index[name]) + 1,
                "share": self.shares[name],
                "strain_energy": self.energies(name),
            }
            for name, frequency in self.frequencies.items()
        }


def named_modes(
    whole: MitSS1Whole,
    pose: Poses | None = None,
    count: int = COUNT,
    granite: Mapping[str, Array] | None = None,
) -> NamedModes:
    """Modes at a pose, named by the patterns of motion that they hold most of.

    Patterns: the eight lowest modes of the granite alone on its mounts, and the moving structure
    along x (tilt), y (struts) and, where the drives are elastic, z (ball screws).

    Parameters
    ----------
    whole : MitSS1Whole
    pose : Poses, optional
        Default: home.
    count : int
        Modes that are searched.
    granite : mapping, optional
        `granite_patterns` of the same granite and mounts, where they are at hand.

    Returns
    -------
    NamedModes

    Warns
    -----
    ValidityWarning
        A mode with a name above the limit of a superelement.
    """
    placed = whole.structure.at(whole.place(whole.home() if pose is None else pose))
    found = searched_modes(placed, count)
    patterns = {**(granite or granite_patterns(whole)), **moving_patterns(whole)}
    shares = pattern_shares(found, np.stack(list(patterns.values())))
    chosen = matched(shares)
    warn_beyond(placed, float(found.frequencies[np.asarray(chosen, dtype=int)].max()))
    return NamedModes(
        whole,
        found,
        MappingProxyType({n: int(i) for n, i in zip(patterns, chosen, strict=True)}),
        MappingProxyType(
            {n: float(shares[k, i]) for k, (n, i) in enumerate(zip(patterns, chosen, strict=True))}
        ),
    )


def moving_patterns(whole: MitSS1Whole) -> dict[str, Array]:
    """Unit translations of housing, struts and blocks, the granite still, (n, 6) by name."""
    linkage = whole.linkage
    nodes = [
        linkage.node_index[n]
        for b in whole.machine.linkage.bodies
        if b.name != GROUND
        for n in b.nodes
    ]
    result = {}
    for name, direction in MOVING.items():
        if name == SCREW and whole.machine.drive_stiffness is None:
            continue
        pattern = np.zeros((len(whole.structure.mesh_nodes), 6))
        pattern[nodes, direction] = 1.0
        result[name] = pattern
    return result


def granite_patterns(whole: MitSS1Whole) -> dict[str, Array]:
    """The lowest modes of the granite alone on the nodes of the whole, (n, 6) by name."""
    # shapes by which modes are named; no frequency of these is shown
    alone = searched_modes(whole.granite_alone(), 12)
    node = alone.placed.structure.linkage.node_index
    # both rails move to the same side in bending
    sides = [alone.shapes[:, node[rail_foot(i)], 1] for i in (1, 2)]
    together = sides[0] * sides[1] > 0
    elastic = np.arange(6, len(together))
    chosen = {f"rigid body {i + 1}": i for i in range(6)}
    chosen[BENDING] = int(elastic[together[6:]][0])
    chosen[TWISTING] = int(elastic[~together[6:]][0])
    rows = whole.structure.mesh_index
    feet = {n: i for i, n in enumerate(whole.granite.nodes)}
    result = {}
    for name, mode in chosen.items():
        pattern = np.zeros((len(whole.structure.mesh_nodes), 6))
        pattern[[rows[n] for n in whole.granite.nodes]] = alone.shapes[mode][
            [node[n] for n in whole.granite.nodes]
        ]
        home = whole.place(whole.home()).positions
        for i in RAILS:
            rail, foot = rows[parts.rail(i)], rows[rail_foot(i)]
            arm = home[rail] - (whole.granite.positions[feet[rail_foot(i)]] - whole.origin)
            pattern[rail] = rigid_map(arm) @ pattern[foot]
        result[name] = pattern
    return result


@dataclass(frozen=True, repr=False)
class ModePicture:
    """A mode shape for drawing: the granite's outer surface and the mechanism's lines.

    Parameters
    ----------
    points : (n, 3)
        Corners of the granite's outer faces at rest in the machine's axes, m.
    faces : (f, 4) int
        Corners of each face.
    displacement : (n, 3)
        Of the points; the largest of granite and mechanism is one.
    nodes : (k, 3)
        Nodes of the mechanism at rest, m.
    node_displacement : (k, 3)
    lines : (l, 2) int
        Pairs of nodes to be connected.
    """

    points: Array
    faces: NDArray[np.int64]
    displacement: Array
    nodes: Array
    node_displacement: Array
    lines: NDArray[np.int64]

    def __repr__(self) -> str:
        return f"<ModePicture: {len(self.faces)} faces, {len(self.lines)} lines>"


def mode_picture(named: NamedModes, name: str) -> ModePicture:
    """The shape of a named mode on the granite's outer surface and on the mechanism's nodes."""
    whole, shape = named.whole, named.modes.shapes[named.index[name]]
    granite = whole.granite
    rows = whole.structure.mesh_index
    motion = shape[[rows[n] for n in granite.nodes]].ravel()
    mesh = whole.frame.mesh
    # the field's nodes begin with the corners of the cells
    field = (granite.shapes[: 3 * len(mesh.points)] @ motion).reshape(-1, 3)
    outer = np.concatenate([f.nodes for f in boundary(mesh).faces])
    used, faces = np.unique(outer, return_inverse=True)
    count = len(whole.machine.linkage.nodes)
    inner = shape[:count, :3]
    size = max(np.abs(field).max(), np.abs(inner).max())
    index = whole.machine.linkage.node_index
    return ModePicture(
        mesh.points[used] - whole.origin,
        faces.reshape(outer.shape),
        field[used] / size,
        named.modes.placed.placement.positions[:count],
        inner / size,
        np.array([[index[a], index[b]] for a, b in whole.skeleton()]),
    )


def mode_rows() -> tuple[PublishedRow, ...]:
    """Published frequencies beside the computed values at home, from the calibrated machines."""
    ours = {which: named_modes(calibrated_machine(which)).frequencies for which in get_args(Which)}
    rows = []
    for table in (MODES, MOUNT_MODES):
        for entry in table:
            set_ = SCREW if entry.row == SCREW else entry.quantity
            name = MOUNT_ROWS.get(entry.row, entry.row)
            rows.append(
                PublishedRow(
                    entry.row,
                    entry.quantity,
                    entry.unit,
                    entry.value,
                    ours[set_][name],
                    "calibrated",
                    _note(entry.row, entry.quantity, ours),
                )
            )
    return tuple(rows)


def _note(row: str, quantity: str, ours: Mapping[str, Mapping[str, float]]) -> str:
    """What a number was calibrated on."""
    if row.startswith("rigid body"):
        note = "stiffnesses of the mounts calibrated to 22.6, 39.3 and 62.0 Hz"
        if row == "rigid body 1":
            note += (
                "; compared with the second computed mode, along y, since the shapes are only in "
                "pictures"
            )
        return note
    if row.startswith("granite"):
        note = (
            "thicknesses of plate and base, which are not published, calibrated to the numerical "
            "269.4 and 320.9 Hz with the machine on the granite"
        )
        if row == TWISTING:
            note += (
                "; the twist splits into two modes with the strut assembly, of which the one "
                "with the larger part is shown"
            )
        return note
    if row == SCREW:
        return (
            "stiffness of the drives calibrated to this mode alone; the tilt would then fall to "
            f"{ours[SCREW][TILT]:.1f} Hz, so that one machine does not meet both"
        )
    if quantity == "numerical":
        return (
            "bearings and masses calibrated to 111.2 and 182.3 Hz, y stiffness 35 N/µm, x "
            "stiffness 150 N/µm and 118.3 kg; tilt interpreted as one about y"
        )
    return (
        "one factor on the far bearings, of the preloading side, calibrated to 79.2 and 154.12 Hz"
    )
