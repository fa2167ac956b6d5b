"""The MIT-SS-1 larger and smaller: stiffness, frequencies, deflection at constant removal rate."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence

import numpy as np

from strutwork.papers.son_2002.size import mit_ss1_scale
from strutwork.papers.tables import numbers, texts
from strutwork.reports.content import Block, Chapter, Column, Figure, Note, Row, Table, Text
from strutwork.reports.data_files import DataFile, csv_file, json_file, netcdf_file
from strutwork.reports.figures.scaling import deflection_powers, frequency_powers, stiffness_powers
from strutwork.reports.numbers import fixed, micro, share, significant
from strutwork.reports.pivot import Entry, pivoted
from strutwork.studies.removal_rate import ACTUATOR_EXPONENTS, RemovalExponents
from strutwork.studies.scale import ScaleStudy

FILE = "size.csv"

#: Modes that the figure of the entire machine shows, from 0: beyond those of the mounts.
SHOWN = (6, 7, 8, 9)


def scale_chapter(moving: ScaleStudy | None = None, whole: ScaleStudy | None = None) -> Chapter:
    """Stiffness and frequencies of the MIT-SS-1 against its size.

    Parameters
    ----------
    moving, whole : ScaleStudy, optional
        Of the machine on rails that stand still, and on its granite; made where not given.
    """
    moving = moving or mit_ss1_scale()
    whole = whole or mit_ss1_scale(granite=True)
    both = {"rails held": moving, "on the granite": whole}
    blocks: list[Block] = [
        Text(
            "Chapter 3 of the thesis: a structure all of whose lengths are L times as large is L "
            "times as stiff (eqs 14 and 15), and its natural frequencies are divided by L (eq. "
            "24). That requires joints whose stiffness grows with L as well; roller bearings of "
            "a catalogue grow with L^0.8, which section 3.3 takes for L, and a machine that "
            "keeps its bearings has stiffer and stiffer struts between the same joints. At L = 1 "
            "the slope of the stiffness is 1 − s (1 − a), s the joints' share in the deflection "
            "and a the exponent of their stiffness; that of a frequency −1 − s (1 − a)/2, s "
            "their share in the mode's strain energy."
        ),
        Text(_finding(moving, whole)),
        Row(
            (
                Figure(
                    "size-stiffness",
                    "Stiffness at the tool against size, rails held, 1/Cᵢᵢ. Both axes are "
                    "logarithmic: a power is a straight line, and its exponent is given after "
                    "its name.",
                    stiffness_powers(moving),
                    "Lines of the stiffness in x, y and z over the size, for three laws of joints.",
                    FILE,
                    560,
                ),
                Figure(
                    "size-frequency",
                    "The lowest natural frequencies against size, rails held.",
                    frequency_powers(moving, (0, 1)),
                    "Lines of two frequencies over the size, for three laws of the joints.",
                    FILE,
                    560,
                ),
            ),
            420,
        ),
        _exponents(both),
        Figure(
            "size-frequency-whole",
            "Frequencies of the machine on its granite against size, counted from the lowest at "
            "every size; the first six, in which the granite moves on its mounts, are omitted.",
            frequency_powers(whole, tuple(k for k in SHOWN if k < whole.frequencies.shape[-1])),
            "Lines of four frequencies over the size, for three laws of the joints.",
            FILE,
            520,
        ),
        Text(
            "The same material removal rate with a machine of another size (eqs 16 to 23): the "
            "drives accelerate the machine's own mass, so that their force ~ Lⁿ allows the feed "
            "L^((n−3)/2); at a constant removal rate and width of cut the cutting force falls as "
            "the feed grows, and the deflection is that force over the stiffness, L^−(n−1)/2 for "
            "a similar machine. n is 3 for motors of similar shape and 3.5 for the industrial "
            "brushless motors of the thesis; with n = 1 the deflection is the same at any size."
        ),
        *_removal(both),
        Figure(
            "size-deflection",
            "Deflection in x at constant removal rate, rails held, relative to that at the "
            "machine's own size. Above 1 the machine of that size cuts less precisely.",
            deflection_powers(moving),
            "Lines of the deflection over the size for three laws of joints and three drives.",
            FILE,
            560,
        ),
        Note(
            "The thesis takes the exponent of a motor's torque for that of the drive's force: "
            "that holds for lead screws of one lead. Where the lead grows with the machine, n is "
            "less by one. Its model behind Fig. 9 is not published; the exponents of similar "
            "structures do not depend on it."
        ),
    ]
    return Chapter("size", "Size: stiffness and frequencies", tuple(blocks), _files(both))


def _finding(moving: ScaleStudy, whole: ScaleStudy) -> str:
    error = max(
        max(
            float(np.abs(s.stiffness_law(0).exponent - [1, 1, 1, 3, 3, 3]).max()),
            float(np.abs(s.frequency_law(0).exponent + 1).max()),
        )
        for s in (moving, whole)
    )
    own = int(np.abs(np.log(moving.factors)).argmin())
    k, f = moving.stiffness[0, own, 0], moving.frequencies[0, own, 0]
    rollers, same = (fixed(float(moving.stiffness_law(i).exponent[0]), 2) for i in (1, 2))
    slower, slowest = (fixed(float(moving.frequency_law(i).exponent[0]), 2) for i in (1, 2))
    return (
        f"The calibrated machine at home, {micro(float(k))} N/µm in x and {significant(float(f))} "
        "Hz with the rails held. With similar joints its exponents are 1 and −1 within "
        f"{significant(error, 1)}. Its bearings give {share(float(moving.joint_share[0]))} of the "
        f"deflection in x and {share(float(moving.joint_share[1]))} in y: with roller bearings "
        f"the stiffness in x varies as L^{rollers} and the lowest frequency with L^{slower}, with "
        f"the same bearings with L^{same} and L^{slowest}. A larger machine needs larger bearings."
    )


def _exponents(both: dict[str, ScaleStudy]) -> Table:
    rows = []
    for name, study in both.items():
        for i, law in enumerate(study.laws):
            stiffness, frequency = study.stiffness_law(i), study.frequency_law(i)
            off = max(float(stiffness.error[:3].max()), float(frequency.error[:4].max()))
            rows.append(
                [
                    f"{name}, {law}",
                    *(_power(v) for v in stiffness.exponent[:3]),
                    *(_power(v) for v in frequency.exponent[:4]),
                    "< 1e−6" if off < 1e-6 else share(off),
                ]
            )
    first = next(iter(both.values()))
    laws, (low, high) = first.laws, first.factors[[0, -1]]
    return Table(
        f"Exponents of the size, fitted from L = {low:g} to {high:g}; the largest distance from "
        "the fitted power. Joints: " + "; ".join(f"{law}, {law.formula}" for law in laws),
        (
            Column("machine and joints", "", False),
            *(Column(a, "", True, "stiffness") for a in "xyz"),
            *(Column(str(k + 1), "", True, "frequency") for k in range(4)),
            Column("off by"),
        ),
        rows,
        FILE,
    )


def _removal(both: dict[str, ScaleStudy]) -> tuple[Text, Table]:
    rows = [
        row
        for name, study in both.items()
        for i, law in enumerate(study.laws)
        for row in removal_rows(f"{name}, {law}", study.removal(i), _power)
    ]
    # feed and force follow from n alone
    given = {n: f"L^{feed} and L^{force}" for _, n, feed, force, *_ in rows}
    rates = "; ".join(f"for n = {n} with {powers}" for n, powers in given.items())
    return (
        Text(
            "At constant removal rate, with drives' force ~ Lⁿ, feed and cutting force go "
            f"{rates}, whatever the joints (eqs 19 to 23)."
        ),
        pivoted(
            "Exponents of the deflection at constant removal rate, drives' force ~ Lⁿ",
            texts("machine and joints"),
            numbers(*"xyz"),
            [Entry([name], f"n = {n}", some) for name, n, _, _, *some in rows],
            "size.json",
        ),
    )


def removal_rows(
    name: str, found: Mapping[str, Sequence[RemovalExponents]], shown: Callable[[float], str]
) -> list[list[str]]:
    """Exponents at constant removal rate by the drives' n: feed, cutting force, deflections."""
    return [
        [
            name,
            f"{n:g}",
            shown(some[0].feed),
            shown(some[0].cutting_force),
            *(shown(one.deflection) for one in some),
        ]
        for n, *some in zip(ACTUATOR_EXPONENTS, *found.values(), strict=True)
    ]


def _power(value: float) -> str:
    """An exponent with three decimals, and no zero with a sign."""
    return fixed(round(float(value), 3) + 0.0, 3)


def _files(both: dict[str, ScaleStudy]) -> tuple[DataFile, ...]:
    modes = max(s.frequencies.shape[-1] for s in both.values())
    rows: list[list[str | float | None]] = []
    for name, study in both.items():
        for i, law in enumerate(study.laws):
            for factor, k, f in zip(
                study.factors, study.stiffness[i], study.frequencies[i], strict=True
            ):
                rows.append([name, str(law), float(factor), *map(float, k), *map(float, f)])
                rows[-1] += [None] * (modes - len(f))
    heads = ["machine", "joints", "factor", *(f"stiffness_{a}_N_per_m" for a in "xyz")]
    heads += [f"stiffness_r{a}_Nm_per_rad" for a in "xyz"]
    heads += [f"frequency_{k + 1}_Hz" for k in range(modes)]
    return (
        csv_file(FILE, "stiffness at the tool and lowest frequencies against size", heads, rows),
        json_file(
            "size.json",
            "the same with fitted and local exponents and those at constant removal rate",
            {name: study.to_dict() for name, study in both.items()},
        ),
        netcdf_file(
            "size-granite.nc", "the machine on its granite", both["on the granite"].to_dataset()
        ),
    )
