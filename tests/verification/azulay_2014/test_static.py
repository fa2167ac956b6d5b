"""Static stiffness of four parallel machines, Tables 2 and 4 of the paper.

@article{azulay2014comparative,
  author  = {Azulay, Hay and Mahmoodi, Masih and Zhao, Ray and Mills, James K.
             and Benhabib, Beno},
  title   = {Comparative analysis of a new {3xPPRS} parallel kinematic mechanism},
  journal = {Robotics and Computer-Integrated Manufacturing},
  volume  = {30},
  year    = {2014}
}

The paper leaves out the height of the workpiece, the Eclipse's column, the pose of the Alizade's
strut and how a stiffness in N/µm acts on Glozman's turning drive; our machines fill these in so
that Table 4 is met best (calibrated). Two joint models are computed: true spherical joints, and
links clamped in the platform, which is wrong for the machine and comes close to the tables (the
apparent model). What is asserted of each, and why no more, stands at each test.

Every published number is read from `strutwork.papers.azulay_2014.published`.
"""

from __future__ import annotations

from math import pi

import numpy as np
import pytest

from strutwork.kinematics import Body, Joint, Linkage, Placement
from strutwork.machines import Eclipse3PPRS, ThreeLegs, hemisphere_poses, roll_angles
from strutwork.machines.three_legs import AISI_1018, TUBE_19_14
from strutwork.msa import (
    Beam,
    Structure,
    axis_stiffness_blocked,
    axis_stiffness_free,
    tool_compliance,
)
from strutwork.papers.azulay_2014.comparison import (
    DIRECTIONS,
    MODELS,
    AzulayComparison,
    Model,
    machines,
    published_ranking,
    variant,
)
from strutwork.papers.azulay_2014.published import TABLE_2, TABLE_4
from strutwork.papers.published_table import PublishedTable
from strutwork.studies import Filters, stiffness_map, summary

PROPOSED = "proposed-3pprs"
LENGTHS = tuple(f"{PROPOSED} L={length} mm" for length in (196, 216, 236))

#: The proposed machine's mean stiffness in the apparent model at 216 and 236 mm. Twice the floor
#: that the paper sets itself: Tables 2 and 4 print Kzz = 5.43 and 5.690 for one machine, 2.4 %
#: from their middle.
NEAR = 0.05

#: The same at 196 mm: at six of seven candidates a slider stands inside the guide's radius,
#: outside the stroke the paper gives, where the length of the first link is a guess.
SHORT = 0.12

#: Kxx + Kyy does not depend on how the roll is chosen as each of the two does.
IN_PLANE = 0.03

#: Machines with a dimension fitted to the very table, for which the paper leaves a choice.
CALIBRATED = 0.15


def mean(comparison: AzulayComparison, row: str, direction: str, model: Model) -> float:
    """N/µm."""
    return comparison.summaries[row, model].axis(direction).statistics.mean / 1e6


def published(table: PublishedTable, row: str, direction: str) -> float:
    """N/µm."""
    return table.value(row, f"K{direction * 2} mean")


@pytest.mark.parametrize("model", MODELS)
@pytest.mark.parametrize("direction", DIRECTIONS)
def test_machines_rank_as_in_table_4(
    comparison: AzulayComparison, direction: str, model: Model
) -> None:
    # Calibrated: Glozman's pole with spherical joints was chosen for its place by Kzz. The other
    # machines rank by themselves.
    assert comparison.ranking(direction, model) == published_ranking(direction)


def test_the_paper_ranks_as_it_says() -> None:
    # section 4: stiffest along x and y is the proposed machine, along z the Eclipse
    in_plane = (PROPOSED, "eclipse-3pprs", "alizade-3prps", "glozman-3prrs")
    assert published_ranking("x") == published_ranking("y") == in_plane
    assert published_ranking("z") == (
        *("eclipse-3pprs", PROPOSED, "glozman-3prrs", "alizade-3prps"),
    )


@pytest.mark.parametrize("model", MODELS)
@pytest.mark.parametrize("direction", DIRECTIONS)
def test_longer_links_are_softer_as_in_table_2(
    comparison: AzulayComparison, direction: str, model: Model
) -> None:
    printed = [published(TABLE_2, row, direction) for row in LENGTHS]
    found = [mean(comparison, row, direction, model) for row in LENGTHS]
    assert printed[0] > printed[1] > printed[2]
    assert found[0] > found[1] > found[2]


@pytest.mark.parametrize("direction", DIRECTIONS)
@pytest.mark.parametrize(
    ("row", "tolerance"),
    list(zip(LENGTHS, (SHORT, NEAR, NEAR), strict=True)),
)
def test_apparent_model_meets_table_2(
    comparison: AzulayComparison, row: str, direction: str, tolerance: float
) -> None:
    found = mean(comparison, row, direction, "apparent")
    assert found == pytest.approx(published(TABLE_2, row, direction), rel=tolerance)


@pytest.mark.parametrize("row", LENGTHS)
def test_apparent_model_meets_the_sum_in_the_plane_of_table_2(
    comparison: AzulayComparison, row: str
) -> None:
    found = sum(mean(comparison, row, d, "apparent") for d in "xy")
    assert found == pytest.approx(sum(published(TABLE_2, row, d) for d in "xy"), rel=IN_PLANE)


@pytest.mark.parametrize("direction", DIRECTIONS)
@pytest.mark.parametrize("row", machines())
def test_apparent_model_meets_table_4(
    comparison: AzulayComparison, row: str, direction: str
) -> None:
    tolerance = NEAR if row == PROPOSED else CALIBRATED
    found = mean(comparison, row, direction, "apparent")
    assert found == pytest.approx(published(TABLE_4, row, direction), rel=tolerance)


def test_every_point_of_the_proposed_machine_counts(comparison: AzulayComparison) -> None:
    # section 3.3.1: 317 check points, none said to be lost
    for model in MODELS:
        assert comparison.summaries[PROPOSED, model].points_kept == 317


def test_near_singular_poses_lie_in_the_ring_of_figure_4(comparison: AzulayComparison) -> None:
    # Fig. 4: "a circular area at about r = 2 mm", read to one step of the lattice, 0.4 mm.
    dataset = comparison.maps[PROPOSED, "spherical"]
    count = dataset["dropped"].sel(reason="near_singular").to_numpy()
    r = np.linalg.norm(dataset["position"].to_numpy()[:, :2], axis=1) * 1e3
    assert count.sum() > 0
    assert np.average(r, weights=count) == pytest.approx(2.0, abs=0.4)
    assert count[r < 1.0].sum() == 0
    assert count[r > 3.6].sum() == 0


def test_no_row_is_called_a_prediction(comparison: AzulayComparison) -> None:
    # heights, lengths and the model of the drives were chosen with these tables in view: a status
    # depends on that, not on how near a number came
    rows_of_all = [row for rows in comparison.rows.values() for row in rows]
    means = {row.status for row in rows_of_all if row.quantity.endswith("mean")}
    assert means == {"calibrated"}
    variances = [
        row
        for rows in comparison.rows.values()
        for row in rows
        if row.quantity.endswith("variance")
    ]
    assert len(variances) == len(rows_of_all) // 2
    # never fitted, and as a whole they miss: most by more than the 15 % that counts as fair
    assert {row.status for row in variances} == {"not reproducible"}
    assert np.median([abs(row.difference_percent) for row in variances]) > 15.0
    assert all("nothing was fitted to a variance" in row.note for row in variances)


def test_rows_hold_both_models_of_every_published_number(comparison: AzulayComparison) -> None:
    for table in (TABLE_2, TABLE_4):
        rows = comparison.table(table.key)
        assert len(rows) == 2 * len(table.values)
        assert len({(r.row, r.quantity) for r in rows}) == len(rows)
        assert all(r.note for r in rows)


@pytest.mark.parametrize("name", machines())
def test_mean_over_all_rolls_is_equal_along_x_and_y(name: str) -> None:
    # Exact: as the guide is a full circle, a pose turned by 90° about its axis has the stiffness
    # turned by 90°. That turn maps the lattice on itself and keeps every roll but the pole's,
    # which grow by 18 of the 24 steps. Only rounding is left; near-singular poses magnify it.
    machine = variant(name, "spherical")
    poses = hemisphere_poses(machine.pole_height)
    placement = machine.place(poses)
    placed = machine.structure.at(placement[placement.reachable])
    stiffness = axis_stiffness_blocked(tool_compliance(placed)).mean(axis=0)
    assert stiffness[0] == pytest.approx(stiffness[1], rel=1e-7)


def rigid_links(machine: ThreeLegs) -> Structure:
    """The machine with links that do not bend: only its drives give way."""
    return Structure(machine.linkage)


def test_eclipse_with_rigid_links_has_its_three_vertical_drives_in_parallel() -> None:
    # Exact at every pose: three drives of 3 N/µm carry a vertical force between them; the other
    # directions blocked, the links do not turn.
    machine = Eclipse3PPRS()
    poses = hemisphere_poses(machine.pole_height, lattice=5, rolls=7)
    structure = rigid_links(machine)
    stiffness = axis_stiffness_blocked(tool_compliance(structure.at(machine.place(poses))))
    # double precision, lessened by the condition of near-singular poses
    assert stiffness[..., 2] == pytest.approx(np.full(poses.batch, 9e6), rel=1e-6)


def test_one_link_as_a_cantilever_and_guided() -> None:
    # 3 E I / L³ = 0.275 and 12 E I / L³ = 1.101 N/µm at L = 216 mm, three digits
    length = 0.216
    linkage = Linkage(
        ("base", "root", "tip"),
        (Body("ground", ("base",)), Body("link", ("root", "tip"))),
        (Joint("clamp", "fixed", ("base", "root")),),
        "tip",
    )
    link = Beam("link", ("root", "tip"), AISI_1018, TUBE_19_14, shear=False)
    positions = np.array([[0.0, 0, 0], [0, 0, 0], [length, 0, 0]])
    placement = Placement(positions, np.eye(3)[None], np.zeros(0))
    compliance = tool_compliance(Structure(linkage, beams=(link,)).at(placement))
    inertia = pi / 64 * (0.019**4 - 0.014**4)
    cantilever = 3 * 205e9 * inertia / length**3
    assert cantilever == pytest.approx(0.275e6, abs=0.5e3)
    assert 4 * cantilever == pytest.approx(1.101e6, abs=0.5e3)
    # a beam element is exact for loads at its ends
    assert axis_stiffness_free(compliance)[1:3] == pytest.approx([cantilever] * 2, rel=1e-9)
    assert axis_stiffness_blocked(compliance)[1:3] == pytest.approx([4 * cantilever] * 2, rel=1e-9)


def test_the_condition_limit_hardly_matters_to_the_proposed_machine(
    comparison: AzulayComparison,
) -> None:
    # The paper drops poses "within the neighborhood of singularities" and does not say how near.
    machine = variant(PROPOSED, "apparent")
    for limit in (50.0, None):
        other = compare_one(machine, limit)
        for direction in DIRECTIONS:
            found = mean(comparison, PROPOSED, direction, "apparent")
            assert other[direction] == pytest.approx(found, rel=5e-3)


def compare_one(machine: ThreeLegs, limit: float | None) -> dict[str, float]:
    filters = Filters(joint_kinds=("revolute",), condition_limit=limit)
    found = summary(stiffness_map(machine, filters=filters))
    return {d: found.axis(d).statistics.mean / 1e6 for d in DIRECTIONS}


def test_rolls_cover_a_third_of_a_turn() -> None:
    assert roll_angles()[[0, 18]] == pytest.approx([0.0, pi / 2], abs=1e-15)
