"""Pairs of computed and measured modes."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray
from scipy.optimize import linear_sum_assignment

from strutwork.errors import ModelError
from strutwork.fea.assurance import in_span, mac, subspace_mac
from strutwork.fea.comparison import Comparison, ModePair

Array = NDArray[Any]

#: From this MAC on two modes are commonly held to be the same.
SURELY_ALIKE = 0.9


@dataclass(frozen=True)
class ModeSet:
    """Modes on some degrees of freedom.

    Parameters
    ----------
    frequencies : (m,)
        Hz, ascending.
    shapes : (m, k)
        Real or complex, any unit.
    damping_ratios : tuple of (float or None)
        ζ, no unit; empty where none is known.

    Raises
    ------
    ModelError
        No mode, lengths that differ, frequencies that fall or are not finite.
    """

    frequencies: Array
    shapes: Array
    damping_ratios: tuple[float | None, ...] = ()

    def __post_init__(self) -> None:
        frequencies = np.asarray(self.frequencies, dtype=float)
        shapes = np.atleast_2d(np.asarray(self.shapes))
        if not frequencies.size or shapes.shape[0] != len(frequencies):
            raise ModelError(
                "modes", "do not have one shape each.", "Give one shape per frequency."
            )
        if not np.all(np.isfinite(frequencies)) or np.any(np.diff(frequencies) < 0):
            raise ModelError("modes", "have frequencies that do not ascend.", "Sort them.")
        if not self.damping_ratios:
            object.__setattr__(self, "damping_ratios", (None,) * len(frequencies))
        elif len(self.damping_ratios) != len(frequencies):
            raise ModelError("modes", "have damping for some only.", "Give None where unknown.")
        object.__setattr__(self, "frequencies", frequencies)
        object.__setattr__(self, "shapes", shapes)

    def __repr__(self) -> str:
        return f"<ModeSet: {len(self.frequencies)} modes, {self.shapes.shape[1]} directions>"


def pair_modes(
    computed: ModeSet,
    measured: ModeSet,
    *,
    window: float = 0.3,
    least: float = 0.5,
    doublet: float = 0.01,
) -> Comparison:
    """Find for every measured mode the computed one that it is.

    Modes of one set whose neighbours lie within `doublet` of their frequency are a group: of
    symmetric machines any mix of their shapes is a mode, so a shape is held against the span of
    the group. The pairs are the assignment with the largest sum of these values among partners
    within `window`; inside a group they follow the frequencies.

    Parameters
    ----------
    computed, measured : ModeSet
        On the same directions.
    window : float
        Largest difference of frequencies, as a share of the measured one.
    least : float
        Pairs below this share, a MAC from 0 to 1, are no pairs.
    doublet : float
        Largest relative distance of neighbours in a group.

    Returns
    -------
    Comparison

    Raises
    ------
    ModelError
        Shapes on different directions, a zero shape.
    """
    if not (window > 0 and 0 <= least <= 1 and doublet >= 0):
        raise ModelError(
            "pairing",
            f"has window {window:g}, least {least:g}, doublet {doublet:g}.",
            "Give a positive window, a least value from 0 to 1 and a doublet of 0 or more.",
        )
    alike = mac(computed.shapes, measured.shapes)
    own, theirs = (groups_of(s.frequencies, doublet) for s in (computed, measured))
    for group in own:
        if len(group) > 1:
            spanned = in_span(measured.shapes, computed.shapes[group])
            alike[group] = np.maximum(alike[group], spanned[None, :])
    for group in theirs:
        if len(group) > 1:
            spanned = in_span(computed.shapes, measured.shapes[group])
            alike[:, group] = np.maximum(alike[:, group], spanned[:, None])
    f, g = computed.frequencies[:, None], measured.frequencies[None, :]
    allowed = (np.abs(f - g) <= window * np.maximum(g, 1e-12)) & (alike >= least)
    # among equal shapes the nearer frequency decides, by less than any real difference of MAC
    nearness = 1e-6 / (1.0 + np.abs(f - g) / np.maximum(g, 1e-12))
    rows, columns = linear_sum_assignment(-np.where(allowed, alike + nearness, 0.0))
    partner = {int(i): int(j) for i, j in zip(rows, columns, strict=True) if allowed[i, j]}
    pairs: list[ModePair] = []
    for together in _joined(partner, own, theirs):
        mine = sorted(together)
        others = sorted(partner[i] for i in mine)
        value = subspace_mac(
            computed.shapes[_with_neighbours(mine, own)],
            measured.shapes[_with_neighbours(others, theirs)],
        )
        for i, j in zip(mine, others, strict=True):
            ours, real = float(computed.frequencies[i]), float(measured.frequencies[j])
            pairs.append(
                ModePair(
                    i,
                    j,
                    ours,
                    real,
                    100.0 * (ours - real) / real if real else 0.0,
                    computed.damping_ratios[i],
                    measured.damping_ratios[j],
                    value,
                    len(_with_neighbours(mine, own)),
                )
            )
    pairs.sort(key=lambda p: p.measured)
    return Comparison(
        modes=tuple(pairs),
        only_computed=_rest(computed, {p.computed for p in pairs}),
        only_measured=_rest(measured, {p.measured for p in pairs}),
        notes=_alike_and_far(computed, measured, alike, pairs, max(least, SURELY_ALIKE)),
    )


def _alike_and_far(
    computed: ModeSet, measured: ModeSet, alike: Array, pairs: list[ModePair], least: float
) -> tuple[str, ...]:
    """Modes left over on both sides whose shapes are the same: the window kept them apart."""
    mine = sorted(set(range(len(computed.frequencies))) - {p.computed for p in pairs})
    theirs = sorted(set(range(len(measured.frequencies))) - {p.measured for p in pairs})
    notes = []
    for j in theirs:
        i = int(max(mine, key=lambda i: alike[i, j], default=-1))
        ours, real = float(computed.frequencies[i]), float(measured.frequencies[j])
        if i >= 0 and real > 0 and alike[i, j] >= least:
            notes.append(
                f"computed {ours:.4g} Hz and measured {real:.4g} Hz have the same shape (MAC "
                f"{alike[i, j]:.3f}) and are {100.0 * abs(ours - real) / real:.0f} % apart: a "
                "wider window pairs them"
            )
    return tuple(notes)


def _with_neighbours(members: list[int], groups: list[list[int]]) -> list[int]:
    """The members with all modes of their groups: a doublet is a span even if half is paired."""
    return [i for group in groups if not set(group).isdisjoint(members) for i in group]


def _rest(modes: ModeSet, taken: set[int]) -> tuple[float, ...]:
    return tuple(float(f) for i, f in enumerate(modes.frequencies) if i not in taken)


def groups_of(frequencies: ArrayLike, doublet: float) -> list[list[int]]:
    """Neighbours of nearly equal frequency, in lists of positions.

    Parameters
    ----------
    frequencies : (m,)
        Hz, ascending.
    doublet : float
        Largest distance of neighbours, as a share of the frequency.
    """
    groups: list[list[int]] = []
    values = np.asarray(frequencies, dtype=float)
    for i, f in enumerate(values):
        if groups and f - values[i - 1] <= doublet * f:
            groups[-1].append(i)
        else:
            groups.append([i])
    return groups


def _joined(
    partner: dict[int, int], own: list[list[int]], theirs: list[list[int]]
) -> list[list[int]]:
    """Computed modes that have a partner, together where either side has them in one group."""
    home = {i: k for k, group in enumerate(own) for i in group}
    away = {j: k for k, group in enumerate(theirs) for j in group}
    label = {i: i for i in partner}
    for _ in partner:
        for i in partner:
            for k in partner:
                if home[i] == home[k] or away[partner[i]] == away[partner[k]]:
                    label[i] = label[k] = min(label[i], label[k])
    return [[i for i in partner if label[i] == name] for name in dict.fromkeys(label.values())]
