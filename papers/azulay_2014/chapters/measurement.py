"""A model beside a measurement that was calculated: the comparison's path, labelled synthetic."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from strutwork.fea import ModalRatio, Port, frequency_response, modes
from strutwork.fea.compare_files import compare_files
from strutwork.fea.mode_damping import damping_ratios
from strutwork.fea.uff import ModeRecord, UniversalFile, mode_file, node_positions, response_records
from strutwork.fea.uff_write import write_universal
from strutwork.machines import Prototype3PPPRS
from strutwork.papers.azulay_2014.synthetic_measurement import synthetic_measurement
from strutwork.papers.tables import numbers, texts
from strutwork.reports.content import Block, Chapter, Figure, Note, Row, Table, Text
from strutwork.reports.data_files import DataFile, csv_file, json_file
from strutwork.reports.figures.theme import PALETTE
from strutwork.reports.figures.vibration import responses
from strutwork.reports.numbers import percent, significant
from strutwork.studies.dynamic import at_home

#: Modes and damping of the model that is compared.
COUNT, DAMPING = 10, ModalRatio(0.01)

LABEL = "synthetic, not measured"


def measurement_chapter(machine: Prototype3PPPRS) -> Chapter:
    """Paired modes, FRAC with its frequency scale, and both responses."""
    measured = synthetic_measurement(machine, count=COUNT)
    response = measured.response
    placed = at_home(machine)
    ours = frequency_response(
        placed, response.inputs, response.outputs, response.frequencies, DAMPING, "all_modes"
    )
    found = modes(placed, COUNT)
    whole = mode_file(found, [float(r) for r in damping_ratios(found, DAMPING)])
    nodes = tuple(dict.fromkeys(p.node for p in response.outputs))
    shapes = measured.mode_shapes.reshape(len(measured.mode_shapes), len(nodes), 3)
    everywhere = node_positions(placed.structure.mesh_nodes, placed.positions)
    theirs = UniversalFile(
        response_records(response),
        tuple(
            ModeRecord(float(f), measured.damping_ratio, nodes, np.pad(s, ((0, 0), (0, 3))))
            for f, s in zip(measured.mode_frequencies, shapes, strict=True)
        ),
        positions={n: everywhere[n] for n in nodes},
    )
    computed = UniversalFile(response_records(ours), whole.modes, whole.positions, whole.lines)
    result = compare_files(computed, theirs)
    rows = [
        [
            significant(p.measured_frequency, 4),
            significant(p.computed_frequency, 4),
            percent(p.difference_percent),
            _share(p.measured_damping),
            _share(p.computed_damping),
            f"{p.mac:.3f}",
            "one mode" if p.group == 1 else f"span of {p.group}",
        ]
        for p in result.modes
    ]
    pairs = Table(
        f"Paired modes; measurement {LABEL}",
        (
            *numbers("synthetic", "computed", unit="Hz"),
            *numbers("difference", "synthetic damping", "computed damping", "MAC"),
            *texts("compared as"),
        ),
        rows,
        "comparison-synthetic.json",
    )
    driving = [f for f in result.functions if f.output == f.input]
    fits = Table(
        f"FRAC at the driving points; measurement {LABEL}",
        (*texts("at"), *numbers("FRAC as it is", "best frequency scale", "FRAC at that scale")),
        [
            [f.output, f"{f.found.frac:.3f}", f"{f.found.scale:.4f}", f"{f.found.scaled_frac:.3f}"]
            for f in driving
        ],
        "comparison-synthetic.json",
    )
    figures, columns = [], [response.frequencies]
    heads = ["frequency_Hz"]
    for i, port in enumerate(response.inputs):
        at = response.outputs.index(port)
        both = [np.abs(r.receptance[:, at, i]) for r in (response, ours)]
        columns += both
        heads += [f"synthetic_{_axis(port)}_m/N", f"computed_{_axis(port)}_m/N"]
        figures.append(
            Figure(
                f"measured-{_axis(port)}",
                f"Receptance at the tool along {_axis(port)}; orange, with noise: {LABEL}.",
                responses(
                    {
                        "synthetic measurement": (
                            response.frequencies,
                            both[0],
                            PALETTE[1],
                            "solid",
                        ),
                        "computed": (response.frequencies, both[1], PALETTE[0], "solid"),
                    },
                    [],
                ),
                f"Lines of the synthetic and the computed receptance along {_axis(port)}.",
                "comparison-synthetic-frf.csv",
            )
        )
    lone = [significant(f, 4) for f in (*result.only_measured, *result.only_computed)]
    blocks: list[Block] = [
        Note(
            "No measured data of this machine are printed. The synthetic data were calculated "
            "from the model with steel, drives, masses, damping and positions of the stages "
            f"changed at random (seed {measured.seed}) and {100 * measured.noise:g} % noise. They "
            "show how a measurement is compared and say nothing about the machine."
        ),
        pairs,
        Text(
            "MAC compares shapes, and one means equal; modes of equal frequency are compared as "
            "the span of their group. "
            + (f"Without a partner: {', '.join(lone)} Hz." if lone else "No mode is left over.")
        ),
        fits,
        Text(
            "FRAC compares entire responses, and one means equal up to a factor. A small shift "
            "of a frequency spoils it, so the best scale of the computed frequencies is given "
            "beside it."
        ),
        Row(tuple(figures), 420),
    ]

    def write(path: Path) -> object:
        return write_universal(path, theirs)

    files = (
        json_file(
            "comparison-synthetic.json",
            f"paired modes and FRAC of all pairs of ports; {LABEL}; the changes that made it",
            {"label": measured.label, "truth": dict(measured.truth), **result.to_dict()},
        ),
        csv_file(
            "comparison-synthetic-frf.csv",
            f"the drawn responses; {LABEL}",
            heads,
            np.column_stack(columns).tolist(),
        ),
        DataFile(
            "synthetic-measurement.uff", f"responses and modes as a universal file; {LABEL}", write
        ),
    )
    return Chapter("comparison", "Beside a synthetic measurement", tuple(blocks), files)


def _share(ratio: float | None) -> str:
    return "none" if ratio is None else f"{100 * ratio:.2f} %"


def _axis(port: Port) -> str:
    return str(port.direction)
