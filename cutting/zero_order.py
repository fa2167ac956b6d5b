"""Zero-order stability lobes from receptances (Altintas and Budak, CIRP Annals 44, 1995).

The directional matrix is replaced by its mean over a turn. At a chatter frequency ω the border is
det(1 − a (1 − exp(−iωT)) A₀ H(iω)) = 0: each eigenvalue of A₀H gives one depth and a phase, and
with them a speed for every number of waves between teeth. What it leaves out are the flip lobes of
interrupted cuts (`strutwork.cutting.limits` has them), the flank's damping, and nothing else.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from itertools import permutations
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from strutwork.cutting.numbers import positive_list
from strutwork.cutting.process import Process
from strutwork.cutting.tip_response import TipResponse
from strutwork.errors import ModelError

Array = NDArray[Any]

#: Corrections of the frequency between two lines.
CORRECTIONS = 3


@dataclass(frozen=True)
class Lobes:
    """The border of stability over the chatter frequency.

    Parameters
    ----------
    frequencies : (f,)
        Of chatter, Hz.
    depth : (f, e)
        Limiting depth of each of e families, m; infinite where a frequency has none.
    phase : (f, e)
        Between the waves of two teeth, rad, 0 to 2π.
    teeth : int
        Passes per turn.
    """

    frequencies: Array
    depth: Array
    phase: Array
    teeth: int

    def __repr__(self) -> str:
        depth, at = self.absolute
        return (
            f"<Lobes: {len(self.frequencies)} lines, absolute {1e3 * depth:.4g} mm at {at:.5g} Hz>"
        )

    @property
    def absolute(self) -> tuple[float, float]:
        """Depth that is stable at every speed, m, and its chatter frequency, Hz.

        Infinite and NaN where no line of the band limits the depth.
        """
        line, family = np.unravel_index(int(np.argmin(self.depth)), self.depth.shape)
        depth = float(self.depth[line, family])
        return depth, float(self.frequencies[line]) if np.isfinite(depth) else float("nan")

    @property
    def at_edge(self) -> bool:
        """Whether the absolute limit stands at an end of the band, beyond which it may be less."""
        line = int(np.argmin(self.depth.min(axis=1)))
        return line in (0, len(self.frequencies) - 1)

    def curve(self, family: int, waves: int) -> tuple[Array, Array]:
        """One lobe: speeds in rpm (f,) and depths in m (f,); infinite where it has none.

        Parameters
        ----------
        family : int
        waves : int
            Complete waves between teeth, from 0.
        """
        period = (self.phase[:, family] / (2.0 * np.pi) + waves) / self.frequencies
        return 60.0 / (self.teeth * period), self.depth[:, family]

    def at(self, speeds: ArrayLike) -> LobeLimits:
        """The limiting depth at spindle speeds.

        Between lines the inverse of the eigenvalue is linear, as is a mode's dynamic stiffness
        but for the square of the frequency.

        Parameters
        ----------
        speeds : (s,)
            rpm.

        Returns
        -------
        LobeLimits

        Raises
        ------
        ModelError
            A speed whose tooth frequency lies above the band.
        """
        rpm = positive_list("spindle speeds", speeds, "rpm")
        passing = rpm * self.teeth / 60.0
        end = float(self.frequencies[-1])
        if passing.max() > end:
            raise ModelError(
                f"lobes at {rpm[passing.argmax()]:g} rpm",
                f"need the response at the tooth frequency, {passing.max():g} Hz; its band ends "
                f"at {end:g} Hz.",
                "Give a response of a wider band, or ask for lower speeds.",
            )
        best = np.full(len(rpm), np.inf)
        at = np.full(len(rpm), np.nan)
        waves = np.full(len(rpm), -1)
        for family in range(self.depth.shape[1]):
            for rows, depth, frequency, whole in self._crossings(family, passing):
                better = depth < best[rows]
                kept = rows[better]
                best[kept], at[kept], waves[kept] = depth[better], frequency[better], whole[better]
        return LobeLimits(rpm, best, at, waves)

    def _crossings(
        self, family: int, passing: Array
    ) -> Iterator[tuple[Array, Array, Array, Array]]:
        """The least depth at speeds, its frequency and its complete waves, by two passes."""
        depth, turn = self.depth[:, family], self.phase[:, family] / (2.0 * np.pi)
        both = np.flatnonzero(np.isfinite(depth[:-1]) & np.isfinite(depth[1:]))
        if not len(both):
            return
        half = 0.5 * self.phase[:, family]
        size = 2.0 * np.where(np.isfinite(depth), depth, 0.0) * np.sin(half)
        inverse = size * (np.sin(half) + 1j * np.cos(half))
        x = self.frequencies / passing[:, None] - turn
        x0, x1 = x[:, both], x[:, both + 1]
        low, high = np.ceil(np.minimum(x0, x1)), np.floor(np.maximum(x0, x1))
        # of several whole numbers between two lines the first or the last has the least depth
        for whole, crossed in (
            (low, (low <= high) & (low >= 0)),
            (high, (low < high) & (high > 0)),
        ):
            rows, columns = np.nonzero(crossed)
            if not len(rows):
                continue
            k, line = whole[rows, columns], both[columns]
            first, last = x0[rows, columns], x1[rows, columns]
            gap = np.where(last == first, 1.0, last - first)
            share = np.where(last == first, 0.0, (k - first) / gap)
            lift = self.frequencies[line + 1] - self.frequencies[line]
            for _ in range(CORRECTIONS):
                between = inverse[line] + share * (inverse[line + 1] - inverse[line])
                wave = np.arctan2(between.real, between.imag) / np.pi
                # of a phase that passes a whole turn the branch near the line's
                wave = wave + np.round(turn[line] + share * (turn[line + 1] - turn[line]) - wave)
                frequency = self.frequencies[line] + share * lift
                off = frequency / passing[rows] - wave - k
                share = np.clip(share - off / gap, 0.0, 1.0)
            between = inverse[line] + share * (inverse[line + 1] - inverse[line])
            with np.errstate(divide="ignore", invalid="ignore"):
                value = np.abs(between) ** 2 / (2.0 * between.real)
            value = np.where(between.real > 0, value, np.inf)
            order = np.lexsort((value, rows))
            found = order[np.unique(rows[order], return_index=True)[1]]
            frequency = self.frequencies[line] + share * lift
            yield rows[found], value[found], frequency[found], k[found].astype(int)


@dataclass(frozen=True)
class LobeLimits:
    """Limiting depths at spindle speeds, by the zero-order method.

    Parameters
    ----------
    speeds : (s,)
        rpm.
    depth : (s,)
        m; infinite where no lobe of the band reaches the speed.
    frequencies : (s,)
        Of chatter, Hz; NaN where there is none.
    waves : (s,)
        Complete waves between teeth, int; −1 where there is none.
    """

    speeds: Array
    depth: Array
    frequencies: Array
    waves: Array


def zero_order_lobes(response: TipResponse, process: Process) -> Lobes:
    """Lobes of a process from the receptance at the tip.

    Parameters
    ----------
    response : TipResponse
        In the axes of the process: `turned` turns the feed.
    process : Process

    Returns
    -------
    Lobes

    Raises
    ------
    ModelError
        A process with damping by the flank, a response that moves the chip in no direction.
    """
    if process.damping is not None:
        raise ModelError(
            "zero-order lobes",
            "leave process damping out, and the process has it.",
            "Ask for exact limits, or give the process without its damping.",
        )
    keep = response.frequencies > 0
    lines = response.frequencies[keep]
    oriented = _families(process.directional.average, response.receptance[keep])
    if not np.any(oriented):
        raise ModelError(
            "receptance at the tip",
            "moves in no direction that changes the chip.",
            "Give the functions across the cut, or check the axes of the process.",
        )
    with np.errstate(divide="ignore", invalid="ignore", over="ignore"):
        inverse = 1.0 / oriented
        ratio = inverse.imag / inverse.real
        depth = 0.5 * inverse.real * (1.0 + ratio**2)
    good = np.isfinite(depth) & (depth > 0)
    phase = 2.0 * np.arctan2(np.where(good, inverse.real, 1.0), np.where(good, inverse.imag, 0.0))
    return Lobes(lines, np.where(good, depth, np.inf), phase, process.teeth)


def _families(average: Array, receptance: Array) -> Array:
    """Eigenvalues (f, e) of A₀H, each family continuous over the lines."""
    left, size, right = np.linalg.svd(average)
    rank = int(np.sum(size > 1e-12 * size[0]))
    # the eigenvalues other than zero are those of the smaller product
    both = np.einsum("ai,jb->ijab", right[:rank], left[:, :rank] * size[:rank])
    small = (receptance.reshape(-1, 9) @ both.reshape(9, -1)).reshape(-1, rank, rank)
    if rank == 1:
        return np.asarray(small[:, :, 0])
    if rank == 2:
        half = 0.5 * (small[:, 0, 0] + small[:, 1, 1])
        det = small[:, 0, 0] * small[:, 1, 1] - small[:, 0, 1] * small[:, 1, 0]
        root = np.sqrt(half**2 - det)
        # the root goes on where it turns least
        turned = (root[1:] * root[:-1].conj()).real < 0
        sign = np.where(np.concatenate([[False], np.cumsum(turned) % 2 == 1]), -1.0, 1.0)
        return np.stack([half + sign * root, half - sign * root], axis=1)
    found = np.linalg.eigvals(small)
    orders = np.array(list(permutations(range(3))))
    for line in range(1, len(found)):
        away = np.abs(found[line][orders] - found[line - 1]).sum(axis=1)
        found[line] = found[line][orders[away.argmin()]]
    return np.asarray(found)
