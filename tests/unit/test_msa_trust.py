"""The digits that a solution claims are there, and what cannot be sure is withheld."""

from fractions import Fraction

import numpy as np
import pytest

from strutwork.errors import MechanismError, NumericalError
from strutwork.kinematics import GROUND, Body, Joint, Linkage, Placement
from strutwork.machines.model_file import parse_model
from strutwork.msa import LoadCase, PlacedStructure, Structure, solve, system_of, tool_compliance
from strutwork.msa.compiled import compiled_compliance, program_of
from strutwork.msa.nodal import unbalanced
from strutwork.msa.trust import HELD, TRUSTED, solve_trusted

METHODS = ["saddle_point", "null_space", "condensed", "sparse"]

CANTILEVER = """
[materials.s]
youngs_modulus = 210e9
poissons_ratio = 0.3
[sections.r]
shape = "rectangle"
width_y = 0.0025
height_z = 0.0025
[nodes]
A = [0, 0, 0]
B = [{x}, {y}, {z}]
[[beams]]
name = "b"
from = "A"
to = "B"
material = "s"
section = "r"
elements = {elements}
shear = false
[[supports]]
node = "A"
fixed = "all"
[[loads]]
node = "B"
force = [{fx}, {fy}, {fz}]
[tool]
tcp = "B"
"""


def chain(stiffness: list[float]) -> PlacedStructure:
    """Rigid blocks in a row on bushings; the first stands on ground, the tool on the last."""
    n = len(stiffness)
    nodes = ("g", *(f"{side}{i}" for i in range(n) for side in "ab"))
    bodies = (Body(GROUND, ("g",)), *(Body(f"B{i}", (f"a{i}", f"b{i}")) for i in range(n)))
    joints = tuple(
        Joint(
            f"j{i}",
            "bushing",
            ("g" if i == 0 else f"b{i - 1}", f"a{i}"),
            stiffness={**dict.fromkeys("xyz", k), **dict.fromkeys(("rx", "ry", "rz"), k)},
        )
        for i, k in enumerate(stiffness)
    )
    places = [[0.0, 0.0, 0.0]]
    for i in range(n):
        places += [[float(i), 0.0, 0.0], [i + 1.0, 0.0, 0.0]]
    frames = np.broadcast_to(np.eye(3), (n, 3, 3))
    linkage = Linkage(nodes, bodies, joints, nodes[-1])
    return Structure(linkage).at(Placement(np.array(places), frames, np.zeros(0)))


def chain_compliance(stiffness: list[float]) -> float:
    """Sideways compliance of the chain's end: of every bushing, 1/k and arm²/k, exactly."""
    n = len(stiffness)
    return float(sum((1 + Fraction(n - i) ** 2) / Fraction(k) for i, k in enumerate(stiffness)))


@pytest.mark.parametrize("method", METHODS)
@pytest.mark.parametrize(
    "stiffness",
    [[1e6, 1e12], [1e12, 1.0], [1e3, 1e12, 1e6, 1e12, 1e4], [1e10 * 0.1**i for i in range(10)]],
    ids=["soft then stiff", "stiff then soft", "mixed", "falling"],
)
def test_stiffness_contrast(stiffness: list[float], method: str) -> None:
    found = tool_compliance(chain(stiffness), method)  # type: ignore[arg-type]
    exact = chain_compliance(stiffness)
    assert found[1, 1] == pytest.approx(exact, rel=1e-8)
    assert found[0, 0] == pytest.approx(float(sum(1 / Fraction(k) for k in stiffness)), rel=1e-7)


@pytest.mark.parametrize(
    "seeds", [range(20), pytest.param(range(20, 400), marks=pytest.mark.slow)], ids=["few", "many"]
)
def test_random_chains_are_right_and_seldom_refused(seeds: range) -> None:
    """Two to 24 blocks, stiffness contrast up to 1e12, arms of a centimetre to ten metres.

    Compliance to 1e-8, which every displacement is held to; forces, which are one everywhere, to
    the 1e-6 of `HELD`. Extended precision has 19 digits: only where the tip moves more than 1e13
    times what the stiffest bushing gives may those six be refused.
    """
    for seed in seeds:
        rng = np.random.default_rng(seed)
        n, contrast = int(rng.integers(2, 25)), rng.uniform(0, 12)
        stiffness = [float(10 ** rng.uniform(12 - contrast, 12)) for _ in range(n)]
        step = float(10 ** rng.uniform(-2, 1))
        one = chain(stiffness)
        at = one.placement
        placed = one.structure.at(Placement(step * at.positions, at.frames, at.values))
        tip = one.structure.linkage.nodes[-1]
        exact = sum(
            (1 + (Fraction(step) * (n - i)) ** 2) / Fraction(k) for i, k in enumerate(stiffness)
        )
        for method in METHODS if seed < 20 else [list(METHODS)[seed % len(METHODS)]]:
            try:
                found = solve(placed, [LoadCase("push", ((tip, (0.0, 1.0, 0, 0, 0, 0)),))], method)  # type: ignore[arg-type]
            except NumericalError:
                assert float(exact) * max(stiffness) > 1e13, seed
                continue
            moved = found.displacement(tip, "push")[1]
            assert moved == pytest.approx(float(exact), rel=1e-8), seed
            assert np.abs(found.joint_forces[:, 1, 0]) == pytest.approx(1.0, rel=HELD), seed
            # moments grow with the arm: held to the largest of them
            turning = [step * (n - i) for i in range(n)]
            assert np.abs(found.joint_forces[:, 5, 0]) == pytest.approx(
                turning, abs=HELD * max(1.0, n * step)
            ), seed


def test_where_the_compiled_kernel_is_sure_it_is_right() -> None:
    """The same chains; what it doubts is solved by the rule above, what it trusts is held to it."""
    sure = 0
    for seed in range(300):
        rng = np.random.default_rng(seed)
        n, contrast = int(rng.integers(2, 25)), rng.uniform(0, 12)
        stiffness = [float(10 ** rng.uniform(12 - contrast, 12)) for _ in range(n)]
        step = float(10 ** rng.uniform(-2, 1))
        one = chain(stiffness)
        at = one.placement
        # two poses of one structure
        positions = np.stack([step * at.positions, 2.0 * step * at.positions])
        frames = np.broadcast_to(at.frames, (2, *at.frames.shape))
        placed = one.structure.at(Placement(positions, frames, np.zeros((2, 0))))
        system = system_of(placed)
        program = program_of(system)
        assert program is not None
        compliance, doubtful = compiled_compliance(system, program)
        for pose in np.flatnonzero(~doubtful):
            arm = (1 + pose) * step
            exact = sum(
                (1 + (Fraction(arm) * (n - i)) ** 2) / Fraction(k) for i, k in enumerate(stiffness)
            )
            assert compliance[pose, 1, 1] == pytest.approx(float(exact), rel=1e-8), seed
            sure += 1
    # a kernel that doubts everything would show nothing
    assert sure > 60


def test_beyond_extended_precision_it_is_right_or_withheld() -> None:
    """Forces of the stiff part would keep six digits only: no answer rather than that."""
    stiffness = [1.0, 1e12, 1e6, 1e12, 1e3]
    try:
        found = tool_compliance(chain(stiffness))
    except NumericalError:
        return
    assert found[1, 1] == pytest.approx(chain_compliance(stiffness), rel=1e-8)


def test_150_rigid_bodies_on_bushings() -> None:
    stiffness = [1e8] * 150
    placed = chain(stiffness)
    assert tool_compliance(placed)[1, 1] == pytest.approx(chain_compliance(stiffness), rel=1e-9)
    solution = solve(placed, [LoadCase("pull", (("b149", (1.0, 2.0, 3.0, 0.0, 0.0, 0.0)),))])
    np.testing.assert_allclose(solution.joint_forces[:, :3, 0], [[-1, -2, -3]] * 150, rtol=1e-8)


@pytest.mark.parametrize("elements", [1, 10, 100, 300, 1000])
@pytest.mark.parametrize("along", [(1.0, 0.0, 0.0), (0.6, 0.48, 0.64)])
def test_a_slender_cantilever_in_many_pieces(
    elements: int, along: tuple[float, float, float]
) -> None:
    """F L³ / 3EI of a beam 400 times as long as thick, in whatever direction it points."""
    side = np.cross(along, [0.0, 0.0, 1.0])
    side /= np.linalg.norm(side)
    model = parse_model(
        CANTILEVER.format(
            elements=elements,
            **dict(zip("xyz", along, strict=True)),
            **dict(zip(("fx", "fy", "fz"), 10 * side, strict=True)),
        )
    )
    exact = 10 / (3 * 210e9 * 0.0025**4 / 12)
    solution = solve(model.placed, model.cases)
    moved = solution.displacement("B", "load")[:3] @ side
    # the length that the coordinates give is rounded, nothing more
    assert moved == pytest.approx(exact, rel=1e-9)
    root = solution.beam_forces[0, 0, :, 0]
    assert np.linalg.norm(root[3:]) == pytest.approx(10.0, rel=1e-9)
    assert tool_compliance(model.placed)[:3, :3] @ side @ side == pytest.approx(
        exact / 10, rel=1e-9
    )


def test_a_wrong_inverse_is_corrected_or_withheld() -> None:
    """An inverse off by a part in a thousand converges; a useless one gives no answer."""
    system = system_of(chain([1e6, 1e9, 1e6]))
    load = np.zeros((1, 18, 1))
    load[0, 13] = 1.0
    inverse = np.linalg.inv(system.stiffness)
    empty = np.zeros((1, 0, 1))

    def off(share: float) -> object:
        def apply(force: np.ndarray, gap: np.ndarray, _: object) -> tuple[np.ndarray, np.ndarray]:
            return (1 + share) * inverse @ force, gap

        return apply

    exact = solve_trusted(system, off(0.0), load, empty)  # type: ignore[arg-type]
    near = solve_trusted(system, off(1e-3), load, empty)  # type: ignore[arg-type]
    np.testing.assert_allclose(near.displacements, exact.displacements, rtol=1e-9, atol=1e-16)
    with pytest.raises(NumericalError, match=r"the solution is withheld"):
        solve_trusted(system, off(1.5), load, empty)  # type: ignore[arg-type]


def test_poses_that_are_sure_are_not_solved_again() -> None:
    """Only the pose whose inverse is poor takes many steps; all are right."""
    one = chain([1e6, 1e9, 1e6])
    lengths = np.array([1.0, 1.5, 2.0, 3.0])
    places = lengths[:, None, None] * one.placement.positions
    frames = np.broadcast_to(np.eye(3), (4, 3, 3, 3))
    system = system_of(one.structure.at(Placement(places, frames, np.zeros((4, 0)))))
    share = np.array([1e-9, 1e-9, 3e-2, 1e-9])[:, None, None]
    inverse = np.linalg.inv(system.stiffness) * (1 + share)
    load = np.zeros((4, 18, 1))
    load[:, 13] = 1.0
    handed: list[int] = []

    def apply(force: np.ndarray, gap: np.ndarray, poses: object) -> tuple[np.ndarray, np.ndarray]:
        handed.append(len(force))
        return inverse[poses] @ force, gap

    found = solve_trusted(system, apply, load, np.zeros((4, 0, 1)))
    exact = np.linalg.solve(system.stiffness, load)
    np.testing.assert_allclose(found.displacements, exact, rtol=1e-9, atol=1e-16)
    assert np.all(found.error <= TRUSTED)
    # the first solution, its correction, then steps that the good poses leave at once
    assert handed[:2] == [4, 4]
    assert len(handed) > 6
    assert handed[-4:] == [1, 1, 1, 1]


def test_perturbed_solutions_are_out_of_balance() -> None:
    """Along the softest motion a wrong answer hides from the residual, not from the correction."""
    placed = chain([1.0, 1e9, 1e9])
    system = system_of(placed)
    load = np.zeros((1, 18, 1))
    load[0, 13] = 1.0
    right = np.linalg.solve(system.stiffness, load)
    empty = np.zeros((1, 0, 1))
    force, _, _ = unbalanced(system, right * (1 + 1e-5), empty, load, empty)
    correction = np.linalg.solve(system.stiffness, force)
    assert np.abs(correction).max() > 100 * TRUSTED * np.abs(right).max()


def test_a_true_mechanism_is_still_named() -> None:
    nodes, bodies = ("g", "a", "t"), (Body(GROUND, ("g",)), Body("arm", ("a", "t")))
    linkage = Linkage(nodes, bodies, (Joint("pin", "revolute", ("g", "a")),), "t")
    places = np.array([[0.0, 0, 0], [0, 0, 0], [1, 0, 0]])
    placed = Structure(linkage).at(Placement(places, np.eye(3)[None], np.zeros(0)))
    with pytest.raises(MechanismError, match="pin in rz"):
        solve(placed, [LoadCase("push", (("t", (0.0, 1.0, 0.0, 0.0, 0.0, 0.0)),))])
