"""Force coefficients of a material, and the damping by the flank of the tool."""

from __future__ import annotations

from dataclasses import dataclass

from strutwork.cutting.numbers import not_negative, positive


@dataclass(frozen=True)
class ForceCoefficients:
    """Linear cutting force per width of cut: coefficient times chip thickness, plus edge force.

    Altintas, Manufacturing Automation, 2nd edition 2012, section 2.8: dF = (K h + K_e) db for the
    tangential, radial and axial direction. Edge forces load the machine; stability is a matter of
    the three coefficients of the chip alone.

    Parameters
    ----------
    tangential, radial, axial : float
        K_t, K_r, K_a, Pa; the radial one times the chip thickness is a force, not a share of K_t.
    edge_tangential, edge_radial, edge_axial : float
        Force per length of the edge, N/m.
    name : str
    source : str

    Raises
    ------
    ModelError
        A coefficient that is not finite, negative, or no tangential one.
    """

    tangential: float
    radial: float = 0.0
    axial: float = 0.0
    edge_tangential: float = 0.0
    edge_radial: float = 0.0
    edge_axial: float = 0.0
    name: str = ""
    source: str = ""

    def __post_init__(self) -> None:
        part = f"force coefficients {self.name}".rstrip()
        positive(part, "tangential coefficient", self.tangential)
        for name in ("radial", "axial", "edge_tangential", "edge_radial", "edge_axial"):
            not_negative(part, f"{name.replace('_', ' ')} coefficient", getattr(self, name))


@dataclass(frozen=True)
class ProcessDamping:
    """Damping by the flank of the tool, which ploughs into the wave on the surface.

    A force b C v/V against the normal velocity v of the edge, b the width and V the cutting speed,
    and friction times that along the cut: the linearised indentation force of Wu (1989) and
    Altintas, Eynian and Onozuka (CIRP Annals 57, 2008). It is left out unless it is given.

    Parameters
    ----------
    indentation : float
        C, N/m: half the specific indentation force (N/m³) times the square of the wear land (m).
    friction : float
        Coefficient of friction at the flank, no unit.

    Raises
    ------
    ModelError
        A coefficient that is negative or not finite.
    """

    indentation: float
    friction: float = 0.3

    def __post_init__(self) -> None:
        not_negative("process damping", "indentation coefficient", self.indentation)
        not_negative("process damping", "friction coefficient", self.friction)
