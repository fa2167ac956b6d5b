"""What stands in a structure besides beams and springs."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Protocol

from numpy.typing import NDArray

if TYPE_CHECKING:
    from strutwork.msa.structure import PlacedStructure

Array = NDArray[Any]


class Element(Protocol):
    """Any element of a structure: nodes and a stiffness between them.

    Only a rigid motion of its nodes may cost no energy.
    """

    @property
    def name(self) -> str:
        """Unique among the parts."""

    @property
    def nodes(self) -> tuple[str, ...]:
        """The k nodes it connects; all on one body of the linkage."""

    def stiffness(self, at: PlacedStructure) -> Array:
        """Stiffness in global axes at a batch of poses, (..., 6k, 6k), N/m, N, N·m/rad.

        Parameters
        ----------
        at : PlacedStructure
            The structure in which the element stands.
        """
