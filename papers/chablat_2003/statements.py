"""Every result that Chablat, Wenger and Majou 2003 print, beside the computed values."""

from __future__ import annotations

from math import asin, degrees

from strutwork.papers.chablat_2003.published import SQUARES, THIRD, THRESHOLD
from strutwork.papers.chablat_2003.squares import square_rows
from strutwork.papers.chablat_2003.third_leg import ARMS, SIDE, best_third
from strutwork.papers.chablat_2003.third_leg_design import STEP, designed_third
from strutwork.papers.published_rows import Status
from strutwork.papers.statements import Statement, stated

TESTS = "tests/verification/chablat_2003/test_published.py"


def _said(
    place: str, what: str, published: str, computed: str, status: Status, why: str, test: str
) -> Statement:
    return Statement(place, what, "", published, computed, status, why, f"{TESTS}::{test}")


def statements() -> tuple[Statement, ...]:
    """All of them, in the order of the document."""
    ridge = [best_third(arm)[0] / arm for arm in ARMS]
    widths = [degrees(best_third(arm)[1]) for arm in ARMS]
    gamma = degrees(asin(THRESHOLD))
    found = [
        _said(
            "eqs 2a, 2b",
            "rates of the two drives",
            "A ṗ = B ρ̇ from the legs' directions",
            "the rows of the joints are B⁻¹ A to 1e-11",
            "predicted",
            "",
            "test_the_rows_are_eqs_2_and_4",
        ),
        _said(
            "section 3.1",
            "parallel singularities",
            "legs in one line",
            "on x² + y² = 1 with x y > 0, where both legs lie in one line",
            "predicted",
            "",
            "test_parallel_singularities",
        ),
        _said(
            "section 3.1",
            "serial singularities",
            "a leg at right angles to its rail",
            "amplification falls to zero towards |x| = 1 and |y| = 1",
            "predicted",
            "",
            "test_serial_singularities",
        ),
        _said(
            "section 3.1",
            "isotropic configuration",
            "amplification factors of one where e₁ · e₂ = 0",
            "both are 1 at S",
            "predicted",
            "",
            "test_isotropic_at_home",
        ),
        _said(
            "eq. 4c",
            "rate of the third drive",
            "from the third leg's direction and β̇ j × (p − b₃)",
            "the third row of the joints to 1e-11",
            "predicted",
            "the printed vector of drive rates has ρ̇₂ twice; its third entry is ρ̇₃",
            "test_the_rows_are_eqs_2_and_4",
        ),
        _said(
            "section 3.2",
            "position and orientation are decoupled",
            "two drives place the tool, whatever β",
            "the first two rows do not contain β and the first two drives do not move with it",
            "predicted",
            "",
            "test_position_is_decoupled",
        ),
        _said(
            "section 3.2",
            "singularities of the third leg",
            "third leg and arm in one line; third leg at right angles to its rail",
            "the third row loses β with the first, and grows without bound towards the second",
            "predicted",
            "",
            "test_singularities_of_the_third_leg",
        ),
    ]
    place = "section 3.3"
    found += stated(square_rows(), place, f"{TESTS}::test_squares_about_s")
    found += [
        _said(
            place,
            "which square is larger",
            "(b) has the higher size; (b) is smaller than (a)",
            "sides at 45° to the rails, by 1.425",
            "not reproducible",
            SQUARES.note.rstrip("."),
            "test_squares_about_s",
        ),
        Statement(
            "section 3.4",
            THIRD.values[1].quantity,
            "deg",
            THIRD.values[1].value,
            gamma,
            "predicted",
            "",
            f"{TESTS}::test_bounds_as_angles",
        ),
        Statement(
            "section 3.4",
            THIRD.values[2].quantity,
            "deg",
            THIRD.values[2].value,
            90.0 - gamma,
            "predicted",
            "",
            f"{TESTS}::test_bounds_as_angles",
        ),
        *(
            Statement(
                "Fig. 8",
                f"L2/L1 of the largest range of beta at L1 = {arm:g} m",
                "",
                THIRD.values[0].value,
                ours,
                "predicted",
                f"over the printed square of solution (b), {SIDE:.3f} m wide",
                f"{TESTS}::test_ridge",
            )
            for arm, ours in zip(ARMS, ridge, strict=True)
        ),
        Statement(
            "Fig. 8",
            f"L2/L1 of the largest range of beta at L1 = {ARMS[0]:g} m, by a design",
            "",
            THIRD.values[0].value,
            designed_third(ARMS[0])[0],
            "predicted",
            f"objective reach_ry, the bend of the third leg's joints within the document's bounds; "
            f"ratios in steps of {STEP:g}, beta in steps of 1 deg",
            f"{TESTS.replace('test_published', 'test_third_leg_design')}::test_ridge_by_a_design",
        ),
        _said(
            "Fig. 8",
            "range of beta",
            "higher than 180° with a suitable choice",
            ", ".join(f"{w:.1f}° at L1 = {a:g} m" for a, w in zip(ARMS, widths, strict=True)),
            "predicted",
            f"over the printed square of solution (b), {SIDE:.3f} m wide",
            "test_ranges",
        ),
        _said(
            "section 3.4",
            "stricter bounds",
            "reduce the range",
            "with 0.3 for 0.2 it is smaller",
            "predicted",
            "",
            "test_stricter_bounds",
        ),
    ]
    return tuple(found)
