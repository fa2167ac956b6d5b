"""The granite of the MIT-SS-1: an L of a vertical plate and a base, as a solid."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property, lru_cache
from math import isfinite
from pathlib import Path

from strutwork.errors import ModelError
from strutwork.fea.interface import Interface
from strutwork.fea.reduce_solid import reduce_solid
from strutwork.fea.solid import Solid
from strutwork.fea.superelement import Superelement
from strutwork.meshes import Mesh, l_frame, patch
from strutwork.msa.materials import Material

#: Son 2002, table of materials (section 8.1): 78 GPa and 3.0 t/m³. The thesis prints no
#: Poisson's ratio; 0.25 is our assumption.
GRANITE = Material.isotropic(78e9, 0.25, 3000.0, name="granite")

#: The four mounts, from the back to the front and from left to right.
MOUNTS = (1, 2, 3, 4)
RAILS = (1, 2, 3)

#: Modes with the interfaces held are retained beyond this, Hz: twice the 400 Hz to which the
#: machine's modes shall hold to 1e-4, and a little more.
CUTOFF = 900.0


def mount(i: int) -> str:
    """Node of the granite in the middle of a mount's footing.

    Parameters
    ----------
    i : int
        1 to 4.
    """
    return f"granite/mount{i}"


def rail_foot(i: int) -> str:
    """Node of the granite in the middle of a rail's footing.

    Parameters
    ----------
    i : int
        1 to 3.
    """
    return f"granite/rail{i}"


@dataclass(frozen=True, kw_only=True)
class GraniteFrame:
    """A base with a vertical plate at its back; rails stand on the plate's front.

    x runs along the width, y to the front, z up; the origin is the lower left corner at the
    back.

    Parameters
    ----------
    envelope : (width, depth, height)
        m (Son 2002, section 6.1).
    plate, base : float
        Thickness of the plate and of the base, m. The thesis prints neither; these bring the
        granite alone near its frequencies. With the machine on it, and calibrated, see
        `strutwork.papers.son_2002.calibrated`.
    rails : (3,) of float
        Where the rails stand along x, m.
    rail_foot : (low, high)
        Ends of the rails above the base, m. Our choice: the travel of the blocks.
    rail_width : float
        Of a rail's footing, m. Our choice: the IKO rail is 23 mm wide, its carriage 70 mm.
    mount_size : float
        Side of a mount's square footing, m. Our choice: the mount is a steel column of 100 mm
        diameter (section 9.2.2).
    mount_inset : float
        From the edges of the base to the footing, m. Our choice, near 0.07 m by the rigid-body
        frequencies.
    size : float
        Largest edge of a quadratic hexahedron, m. Its frequencies to 400 Hz lie within 0.6 % of
        those of cells of 0.10 m.
    material : Material

    Raises
    ------
    ModelError
        A dimension that is not positive; patches that do not fit on the frame.
    """

    envelope: tuple[float, float, float] = (0.9, 1.0, 1.5)
    plate: float = 0.223
    base: float = 0.162
    rails: tuple[float, float, float] = (0.1475, 0.7525, 0.6025)
    rail_foot: tuple[float, float] = (0.45, 1.05)
    rail_width: float = 0.050
    mount_size: float = 0.100
    mount_inset: float = 0.070
    size: float = 0.17
    material: Material = GRANITE

    def __post_init__(self) -> None:
        numbers = {
            "plate": self.plate,
            "base": self.base,
            "rail_width": self.rail_width,
            "mount_size": self.mount_size,
            "size": self.size,
        }
        for name, value in numbers.items():
            if not (isfinite(value) and value > 0):
                raise ModelError(
                    f"GraniteFrame.{name}", f"is {value!r}.", "Give a positive length, m."
                )
        low, high = self.rail_foot
        if not 0 <= low < high <= self.envelope[2] - self.base:
            raise ModelError(
                "GraniteFrame.rail_foot",
                f"is {self.rail_foot} m on a plate of {self.envelope[2] - self.base:.4g} m.",
                "Give the lower and upper end above the base.",
            )
        reach = self.mount_inset + self.mount_size
        if self.mount_inset < 0 or 2 * reach > min(self.envelope[:2]):
            raise ModelError(
                "GraniteFrame.mount_inset",
                f"{self.mount_inset!r} m leaves no room for footings of {self.mount_size:g} m.",
                "Move the mounts towards the corners.",
            )

    @property
    def mount_places(self) -> tuple[tuple[float, float], ...]:
        """Lower corners of the mounts' footings on the bottom, (x, y), m."""
        width, depth, _ = self.envelope
        near = self.mount_inset
        across, along = (length - near - self.mount_size for length in (width, depth))
        return (near, near), (across, near), (near, along), (across, along)

    @cached_property
    def mesh(self) -> Mesh:
        """Linear hexahedra, with the patches `mount1` to `mount4` and `rail1` to `rail3`."""
        side, half = self.mount_size, self.rail_width / 2
        low, high = (self.base + v for v in self.rail_foot)
        corners = self.mount_places
        stops = {
            "x": [
                *(x + s for x, _ in corners[:2] for s in (0.0, side)),
                *(x + s for x in self.rails for s in (-half, half)),
            ],
            "y": [y + s for _, y in corners[1:3] for s in (0.0, side)],
            "z": [low, high],
        }
        made = l_frame(
            self.envelope,
            self.plate,
            self.base,
            size=self.size,
            stops=stops,
            region="granite",
            name="granite",
        )
        for i, (x, y) in zip(MOUNTS, corners, strict=True):
            made = patch(made, f"mount{i}", (x, y, 0.0), (x + side, y + side, 0.0), (0, 0, -1))
        for i, x in zip(RAILS, self.rails, strict=True):
            made = patch(
                made,
                f"rail{i}",
                (x - half, self.plate, low),
                (x + half, self.plate, high),
                (0, 1, 0),
            )
        return made

    @cached_property
    def solid(self) -> Solid:
        """Quadratic hexahedra of granite."""
        return Solid(self.mesh, {"granite": self.material}, order=2, name="granite")

    @property
    def interfaces(self) -> tuple[Interface, ...]:
        """Mounts and rails; each reads its footing's mean motion and stiffens nothing."""
        return (
            *(Interface(mount(i), f"mount{i}") for i in MOUNTS),
            *(Interface(rail_foot(i), f"rail{i}") for i in RAILS),
        )

    def superelement(self, folder: Path | None = None) -> Superelement:
        """The granite reduced to its mounts and rails, kept on disk.

        Parameters
        ----------
        folder : Path, optional
            Of stored superelements; default the user's cache.
        """
        return _reduced(self, folder)


@lru_cache(maxsize=4)
def _reduced(frame: GraniteFrame, folder: Path | None) -> Superelement:
    return reduce_solid(frame.solid, frame.interfaces, cutoff=CUTOFF, folder=folder)
