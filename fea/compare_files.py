"""Computed modes and responses against measured ones, from two universal files."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from fea.assurance import frac_with_scale
from fea.comparison import Comparison, FunctionPair
from fea.pairing import ModeSet, pair_modes
from fea.uff import MOTIONS, FrfRecord, ModeRecord, UniversalFile
from strutwork.errors import ModelError

Array = NDArray[Any]

#: Nodes of two files nearer than this share of the larger extent are the same place.
SAME_PLACE = 1e-3


def compare_files(
    computed: UniversalFile,
    measured: UniversalFile,
    *,
    window: float = 0.3,
    least: float = 0.5,
    doublet: float = 0.01,
    scales: tuple[float, float] = (0.8, 1.25),
) -> Comparison:
    """Compare the modes and responses that two files have in common.

    Nodes are the same by name; where no name is common, by place. Modes are compared in the
    translations that the measured shapes have; responses in the higher of their two motions
    (acceleration above velocity above displacement), and, as receptances are reciprocal, with
    output and input exchanged where only that exists.

    Raises
    ------
    ModelError
        Neither modes nor responses in common.
    """
    to_computed = _same_nodes(computed, measured)
    pairs = Comparison()
    if computed.modes and measured.modes:
        pairs = pair_modes(
            *_common_shapes(computed.modes, measured.modes, to_computed),
            window=window,
            least=least,
            doublet=doublet,
        )
    found = []
    by_name = {(f.output, f.input): f for f in computed.functions}
    for theirs in measured.functions:
        ends = [(to_computed.get(node, ""), way) for node, way in (theirs.output, theirs.input)]
        ours = by_name.get((ends[0], ends[1])) or by_name.get((ends[1], ends[0]))
        if ours is not None:
            found.append(_function_pair(ours, theirs, scales))
    if not found and not (computed.modes and measured.modes):
        raise ModelError(
            "comparison",
            f"the files have nothing in common: {_held(computed)} and {_held(measured)}.",
            "Give both modes, or both responses between the same nodes and directions.",
        )
    return Comparison(pairs.modes, tuple(found), pairs.only_computed, pairs.only_measured)


def _held(content: UniversalFile) -> str:
    names = [f.name for f in content.functions[:3]]
    more = len(content.functions) - len(names)
    listed = ", ".join(names) + (f" and {more} more" if more > 0 else "")
    return f"{len(content.modes)} modes, responses {listed or 'none'}"


def _function_pair(ours: FrfRecord, theirs: FrfRecord, scales: tuple[float, float]) -> FunctionPair:
    motion = max(ours.motion, theirs.motion, key=MOTIONS.index)
    found = frac_with_scale(
        (ours.frequencies, ours.as_motion(motion)),
        (theirs.frequencies, theirs.as_motion(motion)),
        scales,
    )
    return FunctionPair(":".join(theirs.output), ":".join(theirs.input), motion, found)


def _same_nodes(computed: UniversalFile, measured: UniversalFile) -> dict[str, str]:
    """The computed file's node of each measured one."""
    common = set(computed.nodes) & set(measured.nodes)
    if common or not (computed.positions and measured.positions):
        return {name: name for name in common}
    names = list(computed.positions)
    places = np.array([computed.positions[n] for n in names])
    extent = float(np.ptp(places, axis=0).max())
    matched = {}
    for node, place in measured.positions.items():
        distances = np.linalg.norm(places - place, axis=1)
        nearest = int(distances.argmin())
        if distances[nearest] <= SAME_PLACE * extent:
            matched[node] = names[nearest]
    return matched


def _common_shapes(
    computed: Sequence[ModeRecord], measured: Sequence[ModeRecord], to_computed: dict[str, str]
) -> tuple[ModeSet, ModeSet]:
    everywhere = [
        node
        for node, ours in to_computed.items()
        if all(node in m.nodes for m in measured) and all(ours in m.nodes for m in computed)
    ]
    if not everywhere:
        raise ModelError(
            "comparison",
            "the modes of the two files have no node in common.",
            "Give the nodes the same names, or both files positions (data set 2411).",
        )
    ours = [_at(mode, [to_computed[n] for n in everywhere]) for mode in computed]
    theirs = [_at(mode, everywhere) for mode in measured]
    # directions that nobody measured are zero in the file
    present = np.any(np.array(theirs) != 0, axis=0)
    return _mode_set(computed, ours, present), _mode_set(measured, theirs, present)


def _at(mode: ModeRecord, nodes: Sequence[str]) -> Array:
    index = {node: i for i, node in enumerate(mode.nodes)}
    return mode.shape[[index[n] for n in nodes], :3].ravel()


def _mode_set(
    records: Sequence[ModeRecord], shapes: Sequence[Array], present: NDArray[np.bool_]
) -> ModeSet:
    seen = np.array(shapes)[:, present]
    order = np.argsort([r.frequency for r in records], kind="stable")
    # a mode that stands still where it was measured cannot be compared
    order = np.array([i for i in order if np.any(seen[i])], dtype=int)
    if not len(order):
        raise ModelError(
            "comparison", "no mode moves in a measured direction.", "Measure other directions."
        )
    return ModeSet(
        np.array([records[i].frequency for i in order]),
        seen[order],
        tuple(records[i].damping_ratio for i in order),
    )
