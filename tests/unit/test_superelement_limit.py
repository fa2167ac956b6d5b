"""Up to which frequency a Krylov superelement holds: computed, stored, and used by every solver."""

import hashlib
import io
from dataclasses import replace
from functools import cache
from pathlib import Path

import numpy as np
import pytest
import scipy.linalg as sla

from strutwork.errors import ModelError, NumericalError, ValidityWarning
from strutwork.fea import modes
from strutwork.fea.interface import Interface
from strutwork.fea.reduce_solid import reduce_solid, tied
from strutwork.fea.solid import Solid
from strutwork.fea.superelement import Superelement, superelement
from strutwork.fea.superelement_file import read_superelement, write_superelement
from strutwork.fea.superelement_limit import FREQUENCY_SHARE
from strutwork.fea.tied_solid import TiedSolid
from strutwork.fea.validity import beyond, limits
from strutwork.kinematics import GROUND, Body, Joint, Linkage, Placement
from strutwork.meshes import block
from strutwork.msa import PlacedStructure, Structure
from strutwork.msa.materials import Material

STEEL = Material.isotropic(200e9, 0.3, density=7800.0, name="steel")
BAR = Solid(block((0.2, 0.3, 1.0), (2, 2, 6)), {"solid": STEEL}, order=1, name="bar")
ENDS = (Interface("a", "-z"), Interface("b", "+z"))


@cache
def whole() -> TiedSolid:
    return tied(BAR, ENDS)


@cache
def krylov(shapes: int) -> Superelement:
    return superelement(whole(), BAR.cells, modes=shapes, method="krylov")


def dynamic(
    stiffness: np.ndarray, mass: np.ndarray, ports: np.ndarray, square: float
) -> np.ndarray:
    """Inverse of the receptance at the ports, N/m and the like."""
    flexible = np.linalg.solve(stiffness - square * mass, ports)
    return np.asarray(np.linalg.inv(ports.T @ flexible))


def shift(element: Superelement, frequency: float) -> float:
    """Largest relative change of frequency that the reduction's dynamic stiffness amounts to.

    D' − D as a share of −λ dD/dλ, both of the full solid, halved.
    """
    full = whole().stiffness.toarray(), whole().mass.toarray(), whole().ports.toarray()
    own = element.local_stiffness, element.local_mass, np.eye(len(element.local_mass), 12)
    square, step = (2 * np.pi * frequency) ** 2, 1e-4
    slope = (dynamic(*full, square * (1 - step)) - dynamic(*full, square * (1 + step))) / (2 * step)
    error = dynamic(*own, square) - dynamic(*full, square)
    values = sla.eigh((error + error.T) / 2, (slope + slope.T) / 2, eigvals_only=True)
    return float(np.abs(values).max() / 2)


@pytest.mark.parametrize("shapes", [6, 12, 24])
def test_interface_stiffness_holds_up_to_the_limit_and_not_much_beyond(shapes: int) -> None:
    element = krylov(shapes)
    for part in (0.3, 0.7, 0.999):
        assert shift(element, part * element.accurate_to) <= FREQUENCY_SHARE
    # the limit is no idle caution: soon beyond it the share is exceeded
    beyond_it = [shift(element, f * element.accurate_to) for f in (1.2, 1.5, 2.0)]
    assert max(beyond_it) > FREQUENCY_SHARE


def test_more_shapes_hold_further() -> None:
    found = [krylov(shapes).accurate_to for shapes in (0, 6, 12, 24)]
    assert 0.0 < found[0] < found[1] < found[2] < found[3]
    assert f"accurate to {found[1]:.4g} Hz" in repr(krylov(6))


def test_a_larger_solid_is_slower_by_its_size() -> None:
    element = krylov(12)
    assert element.scaled(2.0).accurate_to == pytest.approx(element.accurate_to / 2.0, rel=1e-12)
    # of the same solid meshed at the double size
    large = Solid(block((0.4, 0.6, 2.0), (2, 2, 6)), {"solid": STEEL}, order=1, name="bar")
    made = superelement(tied(large, ENDS), large.cells, modes=12, method="krylov")
    assert made.accurate_to == pytest.approx(element.accurate_to / 2.0, rel=1e-3)


def mounted(element: Superelement) -> PlacedStructure:
    linkage = Linkage(
        (*element.nodes, "ground"),
        (Body("bar", element.nodes), Body(GROUND, ("ground",))),
        (Joint("mount", "bushing", ("ground", "a"), stiffness={"x": 1e8, "y": 1e8, "z": 1e8}),),
        "b",
    )
    positions = np.vstack([element.positions, element.positions[0]])
    structure = Structure(linkage, elements=(element,))
    return structure.at(Placement(positions, np.eye(3)[None], np.zeros(0)))


def test_modes_above_the_limit_are_warned_of() -> None:
    placed = mounted(krylov(6))
    assert limits(placed) == {"bar": krylov(6).accurate_to}
    with pytest.warns(ValidityWarning, match="computed limit of a solid .* bar .* Hz"):
        found = modes(placed, 8).frequencies
    assert found[-1] > krylov(6).accurate_to
    assert beyond(placed, 0.99 * krylov(6).accurate_to) == ""


def test_the_limit_is_stored_and_an_old_file_has_none(tmp_path: Path) -> None:
    first = reduce_solid(BAR, ENDS, modes=6, method="krylov", folder=tmp_path)
    again = reduce_solid(BAR, ENDS, modes=6, method="krylov", folder=tmp_path)
    assert again.limit == first.limit == pytest.approx(krylov(6).limit, rel=1e-6)
    path = tmp_path / "old"
    write_superelement(first, path)
    assert read_superelement(path).limit == first.limit
    write_old(first, path)
    old = read_superelement(path)
    assert old.limit is None
    assert old.accurate_to == 0.0
    with pytest.warns(ValidityWarning, match=r"No limit is stored .* bar 0 Hz\. Reduce the solid"):
        modes(mounted(old), 8)
    # modes with all residual vectors need no limit; without one of them nothing is known
    made = superelement(whole(), BAR.cells, modes=6)
    write_old(made, path)
    assert read_superelement(path).accurate_to == made.accurate_to == made.cutoff / 2.0
    more = np.append(made.fixed_frequencies, 9e3)
    write_old(replace(made, fixed_frequencies=more), path)
    assert read_superelement(path).accurate_to == 0.0


def write_old(element: Superelement, path: Path) -> None:
    """As files were written before they had a limit."""
    archive = io.BytesIO()
    keys = ("positions", "local_stiffness", "local_mass", "shapes", "fixed_frequencies")
    np.savez(
        archive,
        name=np.array(element.name),
        nodes=np.array(element.nodes),
        solver=np.array(element.solver),
        **{key: getattr(element, key) for key in keys},  # type: ignore[arg-type]
    )
    body = archive.getvalue()
    path.write_bytes(b"strutwork superelement 1\n" + hashlib.sha256(body).digest() + body)


def test_an_exchange_that_rounds_frequencies_is_refused() -> None:
    """Thirty shapes of so few cells: exchanged, the first frequency was wrong by 5 %."""
    plate = Solid(block((1.0, 0.0625, 1.0), (2, 2, 3)), {"solid": STEEL}, order=1, name="plate")
    for method, shapes in (("krylov", 30), ("craig_bampton", 36)):
        with pytest.raises(NumericalError, match=r"plate: rounding by the exchange .* changes a"):
            superelement(tied(plate, ENDS[:1]), plate.cells, modes=shapes, method=method)  # type: ignore[arg-type]
    fewer = superelement(tied(plate, ENDS[:1]), plate.cells, modes=18, method="krylov")
    assert fewer.accurate_to > 900.0


def test_a_cutoff_that_would_be_ignored_is_refused() -> None:
    with pytest.raises(ModelError, match="bar: has a cutoff, which a Krylov basis does not"):
        superelement(whole(), BAR.cells, cutoff=500.0, method="krylov")


def test_a_solid_that_its_interfaces_hold_entirely_is_exact() -> None:
    small = Solid(block((1, 1, 1), (1, 1, 1)), {"solid": STEEL}, order=1, name="cube")
    rigid = [replace(end, kind="rigid") for end in ENDS]
    made = superelement(tied(small, rigid), small.cells, modes=0, method="krylov")
    assert made.accurate_to == np.inf


@pytest.mark.parametrize("retained", [6, 12, 18])
def test_half_of_the_cutoff_holds_to_5e_4_with_the_worst_attachment(retained: int) -> None:
    """Fixed-interface modes: 1e-4 in usual structures, as documented, and this at most."""
    element = superelement(whole(), BAR.cells, modes=retained)
    found = [shift(element, part * element.accurate_to) for part in (0.5, 0.8, 0.97, 0.999)]
    assert element.limit is None
    assert found[0] <= 1e-5
    assert max(found) <= 5e-4
