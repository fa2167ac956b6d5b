"""Every result of Corbel et al. 2008 beside the computed values."""

from __future__ import annotations

from functools import partial

from strutwork.papers.corbel_2008.actuation import (
    ActuationStudy,
    square,
    turn_by_difference,
)
from strutwork.papers.corbel_2008.machine_chapters import table_1_rows, table_2_rows, text_rows
from strutwork.papers.corbel_2008.measuring import MeasuringStudy
from strutwork.papers.statements import Statement, stated

_FOLDER = "tests/verification/corbel_2008/"
_UNIT = "tests/unit/test_machines_corbel.py::"
_ACTUATION = _FOLDER + "test_actuation.py::"
_MEASURING = _FOLDER + "test_measuring.py::"

NAN = float("nan")


def statements(actuation: ActuationStudy, measuring: MeasuringStudy) -> tuple[Statement, ...]:
    """In the document's order, its numbers first."""
    return (*_numbers(), *_delta(actuation), *_platform(measuring))


def _numbers() -> tuple[Statement, ...]:
    test = _FOLDER + "test_published.py::test_the_machines_have_the_printed_dimensions"
    side, reach, short, long = text_rows()
    best = _ACTUATION + "test_best_reach_by_the_length_of_the_rods"
    legs = _MEASURING + "test_legs_keep_the_printed_range"
    return (
        *stated(table_1_rows(), "Table I", test),
        *stated(table_2_rows(), "Table II", test),
        *stated((side,), "section II-E, Fig. 5", test),
        *stated((reach,), "section III-B", best),
        *stated((short, long), "section IV-C", legs),
    )


def _delta(study: ActuationStudy) -> tuple[Statement, ...]:
    said = partial(Statement, unit="", status="predicted", reason="")
    factors = turn_by_difference(study.machine, square(study.machine))
    best = study.best
    return (
        said(
            place="section II-A",
            what="freedoms of the Delta",
            published="three translations, the orientation is constant",
            computed="mobility 3, no rotation, nothing constrained twice",
            test=_UNIT + "test_the_delta_moves_without_turning_and_nothing_is_held_twice",
        ),
        said(
            place="section II-A",
            what="manufacturing errors rotate the platform, and the tool's arm enlarges the effect",
            published="not possible to guarantee that no parasitic rotation occurs",
            computed=f"a difference δ of two rods rotates it by {factors.min():.3f} to "
            f"{factors.max():.3f} δ/d",
            test=_ACTUATION + "test_a_difference_of_two_rods_turns_the_platform",
        ),
        said(
            place="section II-A",
            what="another platform (MAST) has a singularity close to the workspace",
            published="its accuracy is decreased",
            computed=NAN,
            status="not reproducible",
            reason="its geometry is not printed",
            test=_FOLDER + "test_published.py::test_what_is_not_legible_has_no_number",
        ),
        said(
            place="eqs 2 to 4",
            what="Jacobian of the Delta",
            published="J = J_x⁻¹ J_z, row i: (a_i, z − q_i)",
            computed="the joints' rows give the same to 1e-10",
            test=_UNIT + "test_the_deltas_jacobian_is_that_of_its_paper",
        ),
        said(
            place="section III-A",
            what="isotropy of the Jacobian is sought",
            published="not stated where it is reached",
            computed="in the middle of the workspace at ΔR = √(2/3) L, with σ = 1/√3",
            test=_ACTUATION + "test_isotropy_in_the_middle",
        ),
        said(
            place="section III-B, Fig. 6",
            what="largest condition number over L and ΔR",
            published="a surface without legible numbers",
            computed=f"{study.corner:.4f} at L = 800, ΔR = 480 mm; {best[0].worst:.4f} at best for "
            f"L = 700 mm, {best[-1].worst:.4f} for 1000 mm",
            status="not reproducible",
            reason="the numbers of the figure are lost; the map shows the computed ones",
            test=_ACTUATION + "test_largest_condition_number_at_the_printed_dimensions",
        ),
        said(
            place="section III-B",
            what="arms",
            published="must not be too long: a compromise between performance and size",
            computed="longer arms have the smaller condition number",
            test=_ACTUATION + "test_best_reach_by_the_length_of_the_rods",
        ),
        said(
            place="section III-B",
            what="spacing d of the rods",
            published="as big as possible to decrease the orientation error",
            computed="the rotation falls as 1/d, the Jacobian does not contain d",
            test=_ACTUATION + "test_rotation_falls_with_the_spacing",
        ),
    )


def _platform(study: MeasuringStudy) -> tuple[Statement, ...]:
    said = partial(Statement, unit="", status="predicted", reason="")
    lost = _FOLDER + "test_published.py::test_what_is_not_legible_has_no_number"
    trend = _MEASURING + "test_small_angles_and_large_radii_are_better"
    box = "with the box of tool points that is assumed, since the document's is not legible"
    return (
        said(
            place="eq. 6",
            what="rows of the inverse Jacobian of the platform",
            published="(u, −u × BE)",
            computed="(u, u × BE)",
            status="not reproducible",
            reason="the sign of the second block is wrong as printed: it mirrors the tool, and "
            "100 mm ahead of the plate the amplification would be 8.28 and not 4.83",
            test=_MEASURING + "test_the_printed_sign_of_the_second_block_is_wrong",
        ),
        said(
            place="eqs 9 to 14",
            what="error of the tool point",
            published="Δp_T = (J_p − [EE_T]× J_r) Δl",
            computed="as a platform with its tool there, to 1e-10",
            test=_MEASURING + "test_errors_of_a_tool_point_are_those_of_a_platform_with_it",
        ),
        said(
            place="section IV-B-1, eq. 15",
            what="the worst case over encoder errors",
            published="at the 2⁶ combinations of ±ε",
            computed="at 32 of them and their negatives; none inside is worse",
            test=_MEASURING + "test_the_worst_case_is_at_vertices",
        ),
        said(
            place="section IV-B-2, eqs 20 and 21",
            what="Hessian of the squared error over the tool point",
            published="constant, eigenvalues 0 and 2(S₄² + S₅² + S₆²) twice",
            computed="the same",
            test=_MEASURING + "test_hessian_over_the_tool_point",
        ),
        said(
            place="section IV-B-2",
            what="the worst case over a box of tool points",
            published="on one of its eight corners",
            computed="on one of its eight corners, since the norm is convex",
            test=_MEASURING + "test_the_worst_case_is_at_vertices",
        ),
        said(
            place="section IV-C",
            what="distance between the centres of the two structures",
            published="the digits are lost",
            computed=NAN,
            status="not reproducible",
            reason="the digits are lost; each machine is modelled separately",
            test=lost,
        ),
        *(
            said(
                place="section IV-C",
                what=what,
                published=words,
                computed=ours,
                reason=box,
                test=trend,
            )
            for what, words, ours in (
                ("angle α_b", "small is better", "small is better"),
                (
                    "angle α_TP",
                    "small is better",
                    "small is better; in the box of tools all below 25° are equivalent",
                ),
                ("radius r_b", "big is better", "big is better"),
                (
                    "radius r_TP",
                    "big is better",
                    "big is better; at the plate's centre it hardly matters",
                ),
            )
        ),
        said(
            place="section IV-C, Table II",
            what="the optimum of the four dimensions",
            published="Table II",
            computed="no optimum inside: with the others as printed r_b could be "
            f"{1e3 * study.widest:.0f} mm, amplification {study.at_widest:.2f} for "
            f"{study.box:.2f}",
            status="not reproducible",
            reason="the deciding condition, that the parts do not collide, is not printed",
            test=_MEASURING + "test_the_leg_range_alone_would_allow_a_wider_base",
        ),
        said(
            place="section IV-C",
            what="resolution at the tool for a resolution of the encoders",
            published="the digits are lost",
            computed=f"{study.by_ahead[0]:.3f} times at the plate's centre, {study.box:.3f} times "
            "in the box of tools",
            status="not reproducible",
            reason="the digits and the box of tool points are lost",
            test=_MEASURING + "test_amplification_by_the_tool_point",
        ),
    )
