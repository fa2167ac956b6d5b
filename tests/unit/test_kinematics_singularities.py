"""Kinds of singularities and ends of reach on linkages whose singular poses are known."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from numpy.typing import NDArray

from strutwork.errors import ModelError
from strutwork.kinematics import GROUND, Body, Joint, Linkage, Placement, axes_frame
from strutwork.kinematics.lost_motion import Kind
from strutwork.kinematics.motion import Motion
from strutwork.kinematics.pose_family import PoseFamily, TaskSection, joined
from strutwork.kinematics.singular_distance import singularity_distance
from strutwork.kinematics.singular_poses import Singularity, classify
from strutwork.kinematics.singularities import singularities_on_line
from strutwork.kinematics.singularity_curves import singularities_in_plane
from strutwork.kinematics.tool_drive_space import tool_drive_space
from tests.linkages import chain, slider_crank
from tests.planar_and_delta import biglide

Array = NDArray[np.float64]


def stacked(placements: list[Placement]) -> Placement:
    return joined([p[None] for p in placements])


def cranks(linkage: Linkage) -> PoseFamily:
    def place(parameters: Array) -> Placement:
        return stacked([slider_crank(float(t))[1] for t in parameters[:, 0]])

    return PoseFamily(linkage, place, ("turn",), 0.3)


def places(found: tuple[Singularity, ...], name: str) -> list[float]:
    return [one.parameters[name] for one in found]


def test_dead_centres_of_a_slider_crank() -> None:
    linkage, _ = slider_crank(0.0)
    found = singularities_on_line(cranks(linkage), np.linspace(-0.35, 3.5, 20))
    assert places(found, "turn") == pytest.approx([0.0, np.pi], abs=1e-9)
    assert {one.kind for one in found} == {Kind.END_EFFECTOR}
    for one in found:
        assert one.lost is not None
        assert one.lost.twist == pytest.approx([1.0, 0, 0, 0, 0, 0], abs=1e-6)
        assert ("crank", "rz") in one.lost.moving
        # the slider stands while crank and rod turn
        assert ("guide", "z") not in one.lost.moving
        assert "the motion in which it moves along x; without it move crank:rz" in (
            one.lost.description
        )


def test_the_same_linkage_driven_by_its_slider() -> None:
    """The crank with the tool turns at a held slider."""
    linkage, _ = slider_crank(0.0)
    joints = tuple(
        replace(j, driven={"crank": (), "guide": ("z",)}.get(j.name, j.driven))
        for j in linkage.joints
    )
    turned = Linkage(linkage.nodes, linkage.bodies, joints, "c1")
    found = singularities_on_line(cranks(turned), np.linspace(-0.35, 3.5, 20))
    assert places(found, "turn") == pytest.approx([0.0, np.pi], abs=1e-9)
    for one in found:
        assert one.kind is Kind.ACTUATOR
        assert one.lost is not None
        assert one.lost.continuous is False
        assert one.lost.twist is not None
        # the pin moves across the crank as the crank turns
        assert one.lost.twist[5] * 0.1 == pytest.approx(
            one.lost.twist[1] * np.cos(one.parameters["turn"]), rel=1e-6
        )


def test_a_parallelogram_branches_where_it_is_flat() -> None:
    linkage, _ = chain(np.zeros((4, 3)), np.tile([0.0, 0.0, 1.0], (4, 1)), driven=0)
    linkage = replace(linkage, tool="a2")

    def place(parameters: Array) -> Placement:
        made = []
        for turn in parameters[:, 0]:
            pin = 0.1 * np.array([np.cos(turn), np.sin(turn), 0.0])
            side = np.array([0.3, 0.0, 0.0])
            points = np.array([np.zeros(3), pin, pin + side, side])
            made.append(chain(points, np.tile([0.0, 0.0, 1.0], (4, 1)), driven=0)[1])
        return stacked(made)

    family = PoseFamily(linkage, place, ("turn",), 0.3)
    found = singularities_on_line(family, np.linspace(-0.4, 3.6, 21))
    assert places(found, "turn") == pytest.approx([0.0, np.pi], abs=1e-9)
    assert {one.kind for one in found} == {Kind.CONFIGURATION}
    assert found[0].lost is not None
    assert "joints that lose a constraint: R1, R2, R3, R4" in found[0].lost.description


def three_sliders() -> tuple[Linkage, PoseFamily]:
    """A plate in a plane on three equal rods, sliders along x; rods parallel at rz = 0."""
    seats = np.array([[-0.2, 0.0, 0.0], [0.2, 0.05, 0.0], [0.0, 0.2, 0.0]])
    legs = (1, 2, 3)
    nodes = tuple(
        f"{n}{i}" for i in legs for n in ("rail", "slider", "foot", "root", "end", "seat")
    )
    bodies = [Body(GROUND, ("rail1", "rail2", "rail3", "table"))]
    joints = []
    for i in legs:
        bodies += [
            Body(f"slider body{i}", (f"slider{i}", f"foot{i}")),
            Body(f"rod{i}", (f"root{i}", f"end{i}")),
        ]
        joints += [
            Joint(f"rail{i}", "prismatic", (f"rail{i}", f"slider{i}"), driven=("z",)),
            Joint(f"lower{i}", "revolute", (f"foot{i}", f"root{i}")),
            Joint(f"upper{i}", "revolute", (f"end{i}", f"seat{i}")),
        ]
    bodies.append(Body("plate", ("tool", "seat1", "seat2", "seat3")))
    joints.append(Joint("table", "planar", ("table", "tool")))
    linkage = Linkage((*nodes, "table", "tool"), tuple(bodies), tuple(joints), "tool")
    rail, up = axes_frame([1.0, 0.0, 0.0]), np.eye(3)

    def place(parameters: Array) -> Placement:
        made = []
        for turn in parameters[:, 0]:
            c, s = np.cos(turn), np.sin(turn)
            tool = np.array([0.1, 0.3, 0.0])
            seat = tool + seats @ np.array([[c, s, 0.0], [-s, c, 0.0], [0.0, 0.0, 1.0]])
            foot = seat.copy()
            foot[:, 1] = seats[:, 1]
            foot[:, 0] -= np.sqrt(0.5**2 - (seat - foot)[:, 1] ** 2)
            legs = np.stack([foot, foot, foot, foot, seat, seat], axis=1).reshape(-1, 3)
            points = np.concatenate([legs, [tool, tool]])
            made.append(Placement(points, np.stack([rail, up, up] * 3 + [up]), np.zeros(0)))
        return stacked(made)

    return linkage, PoseFamily(linkage, place, ("rz",), 0.3)


def test_a_motion_that_goes_on_at_held_drives_is_degenerate() -> None:
    """Parallel rods of one length carry the plate round a circle while the sliders are held."""
    _, family = three_sliders()
    found = singularities_on_line(family, np.linspace(-0.31, 0.37, 18))
    (one,) = [f for f in found if abs(f.parameters["rz"]) < 0.05]
    assert one.parameters["rz"] == pytest.approx(0.0, abs=1e-9)
    assert one.kind is Kind.ACTUATOR
    assert one.lost is not None
    assert one.lost.continuous is True
    # across the rods, (0.4, 0.3) of 0.5 m, without a turn
    assert one.lost.twist == pytest.approx([-0.6, 0.8, 0, 0, 0, 0], abs=1e-5)
    assert {name for name, _ in one.lost.moving} >= {"lower1", "upper1", "table"}


def test_poses_are_classified_where_they_stand() -> None:
    """On its circle both sliders of the biglide stand at the origin: the tool goes round."""
    machine = biglide()
    known = tool_drive_space(machine.linkage, machine.place(np.array([[0.1, 0.2, 0.0]]))).known
    half = np.sqrt(0.5)
    poses = machine.place(np.array([[half, half, 0.0], [1.0, 0.2, 0.0], [0.1, 0.2, 0.0]]))
    found, lost = classify(machine.linkage, poses, known)
    assert found == [Kind.ACTUATOR, Kind.END_EFFECTOR, None]
    assert lost[0] is not None
    assert lost[0].continuous is True
    assert lost[1] is not None
    assert lost[1].moving
    assert lost[2] is None
    assert [None if k is None else k.type for k in found] == [2, 1, None]


def moving_biglide(names: tuple[str, ...]) -> PoseFamily:
    # without the loop's redundant conditions: of these the motion keeps those of home
    machine = biglide("spherical")
    home = machine.place(np.array([[0.2, 0.1, 0.0]]))[0]
    motion = Motion(machine.linkage, replace(home, values=np.zeros(0), names=()))
    return PoseFamily.along(TaskSection.of(motion, names), 1.0)


def test_the_end_of_reach_is_found_along_the_motion() -> None:
    """By the joints alone, without formulas: rods end at X = ±1, to the rounding of the joints."""
    found = singularities_on_line(moving_biglide(("x",)), np.linspace(-1.3, 1.3, 14))
    ends = [one for one in found if one.reason]
    assert places(tuple(ends), "x") == pytest.approx([-1.0, 1.0], abs=1e-9)
    assert {one.kind for one in ends} == {Kind.END_EFFECTOR}
    inner = [one for one in found if not one.reason]
    # y stays at 0.1: the circle, where XY > 0
    assert places(tuple(inner), "x") == pytest.approx([np.sqrt(0.99)], abs=1e-9)


def test_curves_of_the_motion_are_those_of_the_formulas() -> None:
    axis = np.linspace(-1.2, 1.2, 10)
    found = singularities_in_plane(moving_biglide(("x", "y")), (axis, axis))
    arcs = [c.points for c in found.curves if not c.border]
    # on a coarse grid too they go on into the cells that hold the border
    assert len(arcs) == 2
    assert all(np.abs(arc[[0, -1]]).min() < 0.14 for arc in arcs)
    inner = np.concatenate(arcs)
    np.testing.assert_allclose((inner**2).sum(axis=1), 1.0, atol=1e-9)
    border = np.concatenate([c.points for c in found.curves if c.border])
    assert len(border) > 20
    np.testing.assert_allclose(np.abs(border).max(axis=1), 1.0, atol=1e-9)


def test_poses_singular_throughout_are_no_generic_ranks() -> None:
    """At a singular pose alone ranks are lower; those of others are given."""
    machine = biglide()
    half = np.sqrt(0.5)
    good = machine.place(np.array([[0.1, 0.2, 0.0]]))
    known = tool_drive_space(machine.linkage, good, 1.0).known
    assert (known.freedoms, known.tool, known.task) == (2, 2, (0, 1))
    found = singularity_distance(
        machine.linkage, machine.place(np.array([[half, half, 0.0]])), 1.0, known
    )
    assert found.parallel == pytest.approx([0.0], abs=1e-12)
    assert found.serial[0] > 0.1


@pytest.mark.parametrize("kept", [0, 1])
def test_fewer_drives_than_freedoms_are_refused(kept: int) -> None:
    machine = biglide()
    joints = tuple(
        j if j.name != "rail1" and kept else replace(j, driven=()) for j in machine.linkage.joints
    )
    linkage = replace(machine.linkage, joints=joints)
    wanted = "has 2 freedoms" if kept else "has no driven direction"
    with pytest.raises(ModelError, match=wanted):
        tool_drive_space(linkage, machine.place(np.array([[0.1, 0.2, 0.0]])))


def test_bad_input_is_named() -> None:
    family = moving_biglide(("x", "y"))
    with pytest.raises(ModelError, match="y does not increase"):
        singularities_in_plane(family, ([0.0, 1.0], [1.0, 0.0]))
    with pytest.raises(ModelError, match=r"4,000,000 poses.*minutes and .* GB"):
        singularities_in_plane(family, (np.linspace(0, 1, 2000), np.linspace(0, 1, 2000)))
    with pytest.raises(ModelError, match="no pose of the 4 can be reached"):
        singularities_in_plane(family, ([3.0, 4.0], [3.0, 4.0]))
    with pytest.raises(ModelError, match="1 poses"):
        singularities_on_line(moving_biglide(("x",)), [0.0])
    with pytest.raises(ModelError, match="names x twice"):
        TaskSection.of(family.section.motion, ("x",), {"x": 1.0})  # type: ignore[union-attr]
    machine = biglide()
    placement = machine.place(np.array([[0.1, 0.2, 0.0]]))
    with pytest.raises(ModelError, match="characteristic length"):
        tool_drive_space(machine.linkage, placement, -1.0)
