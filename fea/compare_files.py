"""Computed modes and responses against measured ones, from two universal files."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from strutwork.errors import ModelError
from strutwork.fea.comparison import Comparison, FunctionPair
from strutwork.fea.frac_scale import frac_with_scale
from strutwork.fea.pairing import ModeSet, pair_modes
from strutwork.fea.same_nodes import same_nodes
from strutwork.fea.uff import MOTIONS, FrfRecord, ModeRecord, UniversalFile

Array = NDArray[Any]


def compare_files(
    computed: UniversalFile,
    measured: UniversalFile,
    *,
    window: float = 0.3,
    least: float = 0.5,
    doublet: float = 0.01,
    scales: tuple[float, float] = (0.8, 1.25),
    progress: Callable[[int, int], object] | None = None,
) -> Comparison:
    """Compare the modes and responses that two files have in common.

    Nodes are the same by place where both files have places, else by name (`same_nodes`). Modes
    are compared in the translations that the measured shapes have; responses in the higher of
    their two motions (acceleration above velocity above displacement), and, as receptances are
    reciprocal, with output and input exchanged where only that exists. What was left out, assumed
    or changed on the way stands in the notes.

    Parameters
    ----------
    computed, measured : UniversalFile
    window, least, doublet : float
        Shares, as `pair_modes`.
    scales : (float, float)
        Least and largest frequency scale, no unit, as `frac_with_scale`.
    progress : callable, optional
        Called with how many responses are compared, and of how many.

    Raises
    ------
    ModelError
        Neither modes nor responses in common.
    """
    to_computed, notes = same_nodes(computed, measured)
    pairs = Comparison()
    if computed.modes and measured.modes:
        pairs = pair_modes(
            *_common_shapes(computed.modes, measured.modes, to_computed),
            window=window,
            least=least,
            doublet=doublet,
        )
    matched, said = _same_functions(computed.functions, measured.functions, to_computed)
    if not matched and not (computed.modes and measured.modes):
        raise ModelError(
            "comparison",
            f"the files have nothing in common: {_held(computed)} and {_held(measured)}."
            + "".join(f" Note: {note}." for note in notes),
            "Give both modes, or both responses between the same nodes and directions.",
        )
    found = []
    for done, (ours, theirs) in enumerate(matched):
        if progress is not None:
            progress(done, len(matched))
        found.append(_function_pair(ours, theirs, scales))
    if progress is not None and matched:
        progress(len(matched), len(matched))
    notes = (*_told("computed", computed), *_told("measured", measured), *notes, *said)
    return replace(pairs, functions=tuple(found), notes=notes)


def _told(which: str, content: UniversalFile) -> list[str]:
    """What was left out and assumed in reading, the same once with its count."""
    counts: dict[str, int] = {}
    for one in content.ignored:
        counts[one] = counts.get(one, 0) + 1
    left = [f"{one}{f' ({n} times)' if n > 1 else ''}" for one, n in counts.items()]
    return [f"{which} file: not used: {one}" for one in left] + [
        f"{which} file: {one}" for one in content.notes
    ]


def _same_functions(
    computed: Sequence[FrfRecord], measured: Sequence[FrfRecord], to_computed: dict[str, str]
) -> tuple[list[tuple[FrfRecord, FrfRecord]], list[str]]:
    """Computed and measured responses between the same ends, and what has no partner."""
    by_name: dict[tuple[tuple[str, str], tuple[str, str]], list[FrfRecord]] = {}
    for f in computed:
        by_name.setdefault((f.output, f.input), []).append(f)
    matched, alone = [], []
    several = 0
    for theirs in measured:
        ends = [(to_computed.get(node, ""), way) for node, way in (theirs.output, theirs.input)]
        ours = by_name.get((ends[0], ends[1])) or by_name.get((ends[1], ends[0]))
        if not ours:
            alone.append(theirs.name)
            continue
        same_run = [f for f in ours if f.run == theirs.run]
        several += len(ours) > 1 and not same_run
        matched.append(((same_run or ours)[0], theirs))
    notes = []
    if alone and computed:
        listed = ", ".join(alone[:3]) + (" …" if len(alone) > 3 else "")
        notes.append(f"{len(alone)} measured responses have no computed one: {listed}")
    if several:
        notes.append(
            f"{several} measured responses are compared with the first of several computed ones"
        )
    return matched, notes


def _held(content: UniversalFile) -> str:
    names = [f.name for f in content.functions[:3]]
    more = len(content.functions) - len(names)
    listed = ", ".join(names) + (f" and {more} more" if more > 0 else "")
    return f"{len(content.modes)} modes, responses {listed or 'none'}"


def _function_pair(ours: FrfRecord, theirs: FrfRecord, scales: tuple[float, float]) -> FunctionPair:
    motion = max(ours.motion, theirs.motion, key=MOTIONS.index)
    try:
        found = frac_with_scale(
            (ours.frequencies, ours.as_motion(motion)),
            (theirs.frequencies, theirs.as_motion(motion)),
            scales,
        )
    except ModelError as error:
        raise ModelError(
            f"function {theirs.name}, {error.part}", error.problem, error.remedy
        ) from None
    return FunctionPair(":".join(theirs.output), ":".join(theirs.input), motion, found, theirs.run)


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
