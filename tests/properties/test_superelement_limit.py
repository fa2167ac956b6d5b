"""A Krylov superelement up to its limit against the full solid, whatever is attached to both."""

import numpy as np
import scipy.linalg as sla
from hypothesis import given, reject, settings
from hypothesis import strategies as st

from strutwork.errors import NumericalError
from strutwork.fea.interface import Interface
from strutwork.fea.reduce_solid import tied
from strutwork.fea.solid import Solid
from strutwork.fea.superelement import Superelement, superelement
from strutwork.fea.superelement_limit import FREQUENCY_SHARE
from strutwork.fea.tied_solid import TiedSolid
from strutwork.meshes import block
from strutwork.msa.materials import Material

STEEL = Material.isotropic(200e9, 0.3, density=7800.0, name="steel")

lengths = st.floats(0.05, 1.0)
#: Springs from much softer to much stiffer than the solid, and masses likewise.
decades = st.floats(-3.0, 3.0)


def solid(
    size: tuple[float, float, float], sides: list[str], rigid: bool
) -> tuple[TiedSolid, Solid]:
    made = Solid(block(size, (2, 2, 3)), {"solid": STEEL}, order=1, name="part")
    # two rigid patches on neighbouring sides would share nodes
    kinds = ["rigid" if rigid and i == 0 else "average" for i in range(len(sides))]
    interfaces = [Interface(x, x, kind=kind) for x, kind in zip(sides, kinds, strict=True)]  # type: ignore[arg-type]
    return tied(made, interfaces), made


def frequencies(stiffness: np.ndarray, mass: np.ndarray) -> np.ndarray:
    """Hz, from positive definite matrices of very different units."""
    size = 1.0 / np.sqrt(mass.diagonal())
    scale = np.outer(size, size)
    return np.sqrt(np.maximum(sla.eigh(stiffness * scale, mass * scale)[0], 0.0)) / (2 * np.pi)


def attached(
    element: Superelement, whole: TiedSolid, spring: list[float], weight: list[float]
) -> tuple[np.ndarray, np.ndarray]:
    """Frequencies of the reduced and the full solid with the same springs and masses, Hz."""
    k = 6 * len(whole.patches)
    ports = whole.ports.toarray()
    length = float(np.ptp(whole.points, axis=0).max())
    units = np.tile(
        [STEEL.youngs_modulus * length] * 3 + [STEEL.youngs_modulus * length**3] * 3, k // 6
    )
    scale = 1e-2 * units * 10.0 ** np.resize(spring, k)
    load = element.local_mass.diagonal()[:k] * 10.0 ** np.resize(weight, k)
    stiffness, mass = element.local_stiffness.copy(), element.local_mass.copy()
    stiffness[range(k), range(k)] += scale
    mass[range(k), range(k)] += load
    full = (
        whole.stiffness.toarray() + ports @ np.diag(scale) @ ports.T,
        whole.mass.toarray() + ports @ np.diag(load) @ ports.T,
    )
    return frequencies(stiffness, mass), frequencies(*full)


@settings(max_examples=15, deadline=None)
@given(
    size=st.tuples(lengths, lengths, lengths),
    sides=st.sampled_from([["-z"], ["-z", "+z"], ["-x", "+z"]]),
    rigid=st.booleans(),
    shapes=st.integers(0, 30),
    spring=st.lists(decades, min_size=5, max_size=5),
    weight=st.lists(decades, min_size=5, max_size=5),
)
def test_no_frequency_below_the_limit_is_wrong_or_missing(
    size: tuple[float, float, float],
    sides: list[str],
    rigid: bool,
    shapes: int,
    spring: list[float],
    weight: list[float],
) -> None:
    whole, made = solid(size, sides, rigid)
    try:
        element = superelement(whole, made.cells, modes=shapes, method="krylov")
    except NumericalError:
        reject()  # more shapes than its few cells tell apart
    got, expected = attached(element, whole, spring, weight)
    below = expected[expected < element.accurate_to]
    # a mode that is missing moves all above it
    assert len(got) >= len(below)
    # springs so soft that rounding of the solid's own stiffness counts beside them
    rounding = 1e-9 * min(element.accurate_to, float(expected[-1])) ** 2
    np.testing.assert_allclose(
        got[: len(below)] ** 2, below**2, rtol=2.0 * FREQUENCY_SHARE, atol=rounding
    )
