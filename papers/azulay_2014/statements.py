"""Every result that Azulay et al. 2014 print, beside the computed values."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from math import degrees, nan, sqrt

from strutwork.papers.azulay_2014.comparison import DIRECTIONS, machines
from strutwork.papers.azulay_2014.dynamic import azulay_table_5
from strutwork.papers.azulay_2014.inputs import input_statements
from strutwork.papers.azulay_2014.machine_study import MODEL_NAMES, Comparison
from strutwork.papers.azulay_2014.published import TABLE_2, TABLE_3, TABLE_4
from strutwork.papers.azulay_2014.theory_statements import theory
from strutwork.papers.azulay_2014.tilt_study import RADII, TiltStudy, tilt_study
from strutwork.papers.statements import Statement, stated

TESTS = "tests/verification/azulay_2014"

#: Check points of a machine (section 3.3.1).
POINTS = 317
#: Of a two-tailed test at 99 %.
CRITICAL = 2.576


def significance(axis: str, other: str) -> float:
    """The test statistic of section 4.1 from the printed means and variances.

    Parameters
    ----------
    axis : "x", "y" or "z"
    other : str
        A machine that the proposed one is compared with.

    Returns
    -------
    float
        Difference of the means over its standard deviation; positive where the proposed machine
        is the stiffer one. Points of a grid are no independent samples: it is the paper's test.
    """
    quantity = f"K{axis * 2}"
    first, second = machines()[0], other
    apart = TABLE_4.value(first, f"{quantity} mean") - TABLE_4.value(second, f"{quantity} mean")
    variances = [TABLE_4.value(m, f"{quantity} variance") for m in (first, second)]
    return apart / sqrt(sum(variances) / POINTS)


def statements(study: Comparison) -> tuple[Statement, ...]:
    """All of them, in the order of the document."""
    tilted = tilt_study()
    return (
        *theory(),
        *input_statements(),
        *_tilts(tilted),
        *_lengths(tilted),
        *_ring(study),
        *_types(tilted),
        *_table(study, TABLE_2.key, "Table 2", "test_apparent_model_meets_table_2"),
        *_table(study, TABLE_4.key, "Table 4", "test_apparent_model_meets_table_4"),
        *_significance(),
        *_orders(study),
        *stated(
            azulay_table_5().table(),
            "Table 5",
            f"{TESTS}/test_dynamic.py::test_rows_say_what_they_are_worth",
        ),
        *_without_numbers(),
    )


def _table(study: Comparison, key: str, place: str, test: str) -> tuple[Statement, ...]:
    found: list[Statement] = []
    for model, words in MODEL_NAMES.items():
        rows = [replace(r, row=f"{r.row}, {words}") for r in study.azulay.rows[key, model]]
        for row in rows:
            held = "test_no_row_is_called_a_prediction"
            if row.quantity.endswith("mean"):
                held = test if model == "apparent" else "test_machines_rank_as_in_table_4"
            found += stated([row], place, f"{TESTS}/test_static.py::{held}")
    return tuple(found)


def _tilts(study: TiltStudy) -> tuple[Statement, ...]:
    found: list[Statement] = []
    for name in machines():
        ours = study.planes[name].largest
        found.append(
            Statement(
                "section 3.1, Table 3",
                f"{name}: largest tilt from the pole",
                "deg",
                TABLE_3.value(name, "platform tilt angle"),
                degrees(ours.connected),
                "not reproducible",
                "on the 4 mm hemisphere, by poses within the machine's own joint ranges; neutral "
                "directions of the spherical joints, poles, middles of strokes and the "
                "shapes that touch are not printed",
                f"{TESTS}/test_statements.py::test_tilts_are_nested",
            )
        )
        found.append(
            Statement(
                "section 3.1, Table 3",
                f"{name}: with gaps on the path; before the singular ring",
                "deg",
                "not distinguished",
                f"{degrees(ours.reached):.1f}; {degrees(ours.before_the_ring):.1f}",
                "not reproducible",
                "the paper checks each point alone and states neither; the first counts any roll "
                "whatever the path, the second is what six drives reach",
                f"{TESTS}/test_statements.py::test_tilts_are_nested",
            )
        )
    return tuple(found)


def _lengths(study: TiltStudy) -> tuple[Statement, ...]:
    """Fig. 3, and what the text takes from it."""
    test = f"{TESTS}/test_tilts.py::test_what_ends_the_tilt_of_each_length"
    at = int(abs(RADII - 4e-3).argmin())
    tilts = {length: degrees(found[at].connected) for length, found in study.by_radius.items()}
    why = (
        "what ends the tilt is a slider's stroke at 196 mm and a spherical joint at 216 mm: the "
        "pole's height and the neutral directions are assumed, and the figure's radii are not "
        "legible"
    )
    shown = "; ".join(f"{1e3 * length:g} mm {tilt:.1f}" for length, tilt in tilts.items())
    return (
        Statement(
            "Fig. 3",
            "tilt by link length and radius of the sphere",
            "deg",
            "a figure",
            f"a figure; at 4 mm {shown}",
            "not reproducible",
            why,
            test,
        ),
        Statement(
            "section 3.1",
            "links of 196 mm tilt more than those of 216 mm",
            "deg",
            "yes",
            f"no: {tilts[0.196]:.1f} and {tilts[0.216]:.1f}",
            "not reproducible",
            why,
            test,
        ),
    )


def _types(study: TiltStudy) -> tuple[Statement, ...]:
    """Types 1 and 3 of eq. 35, which the paper defines and does not show."""
    test = f"{TESTS}/test_tilts.py"
    found: list[Statement] = []
    for name, one in study.singular.items():
        axis = "out of reach" if one.on_axis is None else f"{degrees(one.on_axis):.1f}"
        end = (
            "none"
            if one.end_of_reach is None
            else f"{degrees(one.end_of_reach[0]):.1f} to {degrees(one.end_of_reach[1]):.1f}"
        )
        found.append(
            Statement(
                "section 3.2",
                f"{name}: type 1, a joint on the guide's axis; at the end of reach",
                "deg",
                "not shown",
                f"{axis}; {end}",
                "calibrated",
                "the first is the tilt whose tangent is R_p over the radius of the sphere, at "
                "one roll; whether both are reached depends on the pole, which is assumed",
                f"{test}::test_type_1_on_the_axis",
            )
        )
        found.append(
            Statement(
                "section 3.2",
                f"{name}: type 3",
                "",
                "not shown",
                "none" if one.both > 0 else "where the end of reach meets a ring",
                "calibrated",
                "no pose of type 1 on the 4 mm hemisphere is one of type 2, with the assumed pole",
                f"{test}::test_no_pose_is_of_type_3",
            )
        )
    return tuple(found)


def _orders(study: Comparison) -> tuple[Statement, ...]:
    """Which machine is stiffer than which, in the words of sections 4.1 and 4.2."""
    proposed, eclipse, alizade, glozman = machines()
    means = {
        (name, axis): study.azulay.summaries[name, "spherical"].axis(axis).statistics.mean
        for name in machines()
        for axis in DIRECTIONS
    }
    said = (
        (proposed, alizade, "xyz"),
        (proposed, eclipse, "xy"),
        (eclipse, proposed, "z"),
        (proposed, glozman, "xyz"),
    )
    return tuple(
        Statement(
            "section 4.1",
            f"{first} stiffer than {second} along {', '.join(axes)}",
            "",
            "yes",
            "yes" if all(means[first, a] > means[second, a] for a in axes) else "no",
            "calibrated",
            "means with true spherical joints; their dimensions were fitted to Table 4",
            f"{TESTS}/test_static.py::test_machines_rank_as_in_table_4",
        )
        for first, second, axes in said
    )


def _ring(study: Comparison) -> tuple[Statement, ...]:
    found: list[Statement] = []
    for name in study.names:
        low, high = study.barred[name, "spherical"].ring.extent
        first = name == study.names[0]
        found.append(
            Statement(
                "Fig. 4",
                f"{name}: type 2 singular poses on the 4 mm hemisphere",
                "mm",
                "about 2" if first else "not shown",
                f"{1e3 * low:.2f} to {1e3 * high:.2f}",
                "calibrated",
                "the height of the pole was chosen by Table 4",
                f"{TESTS}/test_barrier.py::test_ring",
            )
        )
    return tuple(found)


def _significance() -> tuple[Statement, ...]:
    names: Mapping[str, str] = {n: n for n in machines()[1:]}
    found: list[Statement] = []
    for axis in DIRECTIONS:
        for name in names:
            z = significance(axis, name)
            found.append(
                Statement(
                    "section 4.1",
                    f"K{axis * 2}: proposed stiffer than {name} beyond 99 %",
                    "",
                    "yes",
                    f"{'yes' if z > CRITICAL else 'no'}, statistic {z:.1f} from the printed table",
                    "predicted" if z > CRITICAL else "not reproducible",
                    "computed from the printed means and variances with 317 points each; points "
                    "of a grid are not independent samples, so the level means little"
                    if z > CRITICAL
                    else "by Table 4 itself the proposed machine is not the stiffer one along z",
                    f"{TESTS}/test_statements.py::test_significance",
                )
            )
    return tuple(found)


def _without_numbers() -> tuple[Statement, ...]:
    """Results that are drawn only."""
    test = f"{TESTS}/test_statements.py::test_every_result_is_there"
    drawn = "curves without numbers in the text; their data and dimensions are not printed"
    return tuple(
        Statement(place, what, "", "a figure", nan, "not reproducible", drawn, test)
        for place, what in (
            ("Fig. 8", "frequency responses by link length"),
            ("Fig. 10", "frequency responses of the four machines"),
            ("Fig. 12", "the prototype: measured and computed frequency responses"),
        )
    )
