"""Gradients of stiffness, frequencies and least dynamic stiffness in closed form.

@article{fox1968,
  title   = {Rates of change of eigenvalues and eigenvectors},
  author  = {Fox, R. L. and Kapoor, M. P.},
  journal = {AIAA Journal},
  volume  = {6},
  number  = {12},
  pages   = {2426--2429},
  year    = {1968}
}

A cantilever with a heavy mass at its tip: k = 3EI/L³ and f = √(k/m)/(2π). Two masses on two springs
one behind the other: λ² m₁m₂ − λ (m₁k_b + m₂(k_a + k_b)) + k_a k_b = 0, and Fox and Kapoor's
λ' = φᵀ(K' − λM')φ. One mass with the damping ratio ζ: the least dynamic stiffness is 2ζ√(1 − ζ²) k.
"""

from __future__ import annotations

import numpy as np

from strutwork.studies.function import MachineFunction
from tests.gradients import CANTILEVER

#: Two sliders on springs, each with a mass; nothing else moves.
TWO_MASSES = """
[nodes]
root = [0, 0, 0]
middle = [0, 0, 0]
begin = [0, 0, 0]
tip = [0, 0, 0]
[[bodies]]
name = "first"
nodes = ["middle", "begin"]
[[joints]]
name = "a"
type = "prismatic"
between = ["root", "middle"]
axis = [1, 0, 0]
stiffness = { z = "2 N/um" }
[[joints]]
name = "b"
type = "prismatic"
between = ["begin", "tip"]
axis = [1, 0, 0]
stiffness = { z = "3 N/um" }
[[masses]]
node = "middle"
mass = "4 kg"
[[masses]]
node = "tip"
mass = "5 kg"
[[supports]]
node = "root"
fixed = "all"
[tool]
tcp = "tip"
"""

#: One mass on one spring.
ONE_MASS = """
[nodes]
root = [0, 0, 0]
tip = [0, 0, 0]
[[joints]]
name = "a"
type = "prismatic"
between = ["root", "tip"]
axis = [1, 0, 0]
stiffness = { z = "2 N/um" }
[[masses]]
node = "tip"
mass = "5 kg"
[[supports]]
node = "root"
fixed = "all"
[tool]
tcp = "tip"
[damping]
modal_ratio = 0.05
"""


def test_a_cantilever_with_a_heavy_tip() -> None:
    modulus, diameter, mass = (
        "materials.steel.youngs_modulus",
        "sections.bar.diameter",
        "masses[0].mass",
    )
    length = "nodes.tip.x"
    names = [modulus, diameter, length, mass]
    f = MachineFunction.of(CANTILEVER, names, ["stiffness_z", "frequency_1"])
    k = 3 * 210e9 * np.pi * 0.03**4 / 64 / 0.6**3
    frequency = np.sqrt(k / 8) / (2 * np.pi)
    sizes = np.array([210e9, 0.03, 0.6, 8.0])
    slopes = f.jacobian()
    # exponents of the formula; the elements hold the bar exactly under a force at its tip
    np.testing.assert_allclose(
        slopes["stiffness_z"] * sizes / k, [1, 4, -3, 0], rtol=1e-7, atol=1e-9
    )
    # the bar's own mass, 4e-10 of the tip's, is left out of the formula
    np.testing.assert_allclose(
        slopes["frequency_1"] * sizes / frequency, [0.5, 2, -1.5, -0.5], rtol=1e-6
    )


def test_two_masses_on_two_springs() -> None:
    names = ["joints.a.stiffness.z", "joints.b.stiffness.z", "masses[0].mass", "masses[1].mass"]
    f = MachineFunction.of(TWO_MASSES, names, ["frequency_1", "frequency_2"])
    a, b, one, two = 2e6, 3e6, 4.0, 5.0
    sum_ = one * b + two * (a + b)
    root = np.sqrt(sum_**2 - 4 * one * two * a * b)
    values = f()
    for mode, square in enumerate(
        ((sum_ - root) / (2 * one * two), (sum_ + root) / (2 * one * two))
    ):
        omega = np.sqrt(square)
        # rounding
        np.testing.assert_allclose(values[f"frequency_{mode + 1}"], omega / (2 * np.pi), rtol=1e-10)
        shape = np.array([(b - two * square) / b, 1.0])
        shape /= np.sqrt(one * shape[0] ** 2 + two * shape[1] ** 2)
        rates = np.array(
            [
                shape[0] ** 2,
                (shape[1] - shape[0]) ** 2,
                -square * shape[0] ** 2,
                -square * shape[1] ** 2,
            ]
        )
        # of ω²: that of f is 1/(8π² f) of it; the step of the mass differences leaves 1e-9
        np.testing.assert_allclose(
            f.jacobian()[f"frequency_{mode + 1}"], rates / (4 * np.pi * omega), rtol=1e-7
        )


def test_the_least_dynamic_stiffness_of_one_mass() -> None:
    names = ["joints.a.stiffness.z", "masses[0].mass"]
    f = MachineFunction.of(ONE_MASS, names, ["least_dynamic_stiffness_x"], band=(1.0, 500.0))
    share = 2 * 0.05 * np.sqrt(1 - 0.05**2)
    # rounding of the search for the least value
    np.testing.assert_allclose(f()["least_dynamic_stiffness_x"], share * 2e6, rtol=1e-9)
    # the mass moves the resonance and leaves its height
    np.testing.assert_allclose(
        f.jacobian()["least_dynamic_stiffness_x"], [share, 0.0], rtol=1e-6, atol=1e-3
    )
