"""The biglide with a third leg that turns its tool (Chablat et al. 2003, section 3.2)."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from math import radians
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from strutwork.kinematics import Poses, angle, rotation_y
from strutwork.kinematics.frames import frame, vector
from strutwork.kinematics.joint import BEND
from strutwork.machines import biglide_parts as parts
from strutwork.machines.biglide import PLANE, REACH, Biglide
from strutwork.machines.biglide import TURNED as TWO_DRIVES_TURNED
from strutwork.machines.dimensions import OR_ANY, check_positive
from strutwork.machines.legs import square_root
from strutwork.machines.limits import Limit
from strutwork.machines.variant import Variant
from strutwork.msa.sections import Section, box, tube
from strutwork.msa.springs import PointMass
from strutwork.msa.structure import Structure

Array = NDArray[Any]

#: Our choice: of the arm from the hinge to the third leg; 160 mm in the plane in which it turns.
ARM = box(0.160, 0.100, 0.008, name="box 160 x 100 x 8")
#: Our choice: of the third leg's rod.
THIRD = tube(0.100, 0.084, name="tube 100 x 8")


#: Axes of the hinge, z along y, and of the third guide, z downwards.
_HINGE = np.array([[1.0, 0.0, 0.0], [0.0, 0.0, 1.0], [0.0, -1.0, 0.0]])
_DOWN = np.diag([1.0, -1.0, -1.0])

TURNED = "the tool is rotated about an axis other than y"


@dataclass(frozen=True, kw_only=True)
class BiglideThirdLeg(Biglide):
    """The tool turns about y on the platform; a leg P U U on a rail across the plane holds it.

    The tool's arm, L₁ long, points along x at β = 0, and β is the tool's turn about y. The third
    rail stands upright through the arm's end with the tool at S (Fig. 7a), and its carriage above
    the plane: ρ₃ counts downwards from the plane. With X = x + L₁ (cos β − 1) and
    σ = √(L₂² − X² − y²), ρ₃ = L₁ sin β − σ. The paper's third rate is printed with the index 2.

    Parameters
    ----------
    arm_length : float
        L₁ = |B₃P|, m. Our choice: the range of β exceeds 180° from 1.65 m on.
    third_length : float
        L₂ = |A₃B₃|, m: 1.8 L₁, where the paper has the range largest (Fig. 8).
    arm_section, third_section : Section
        Of the arm and the third rod. Assumed.
    arm_mass : float
        Of what turns at the hinge beside the arm's beam, as the spindle, kg. Assumed.
    leg_bend : float or None
        Largest bend of the third leg's universal joints, rad; None for any. At the lower one it is
        the angle between leg and rail, at the upper one that between the leg and the normal of the
        arm in the plane of turning; section 3.4 bounds both by 78.5 degrees.
    """

    arm_length: float = 1.7
    third_length: float = 3.06
    arm_section: Section = ARM
    third_section: Section = THIRD
    arm_mass: float = 20.0
    leg_bend: float | None = None

    def __post_init__(self) -> None:
        super().__post_init__()
        check_positive(self, ["leg_bend"], OR_ANY)

    @cached_property
    def limits(self) -> tuple[Limit, ...]:
        """Joint ranges: the bend of the third leg's joints where it has one."""
        if self.leg_bend is None:
            return super().limits
        ends = (parts.rod(parts.THIRD, part=part) for part in ("foot", "end"))
        return tuple(Limit(name, BEND, 0.0, self.leg_bend, "universal") for name in ends)

    @property
    def lengths(self) -> tuple[str, ...]:
        """Fields that must be positive and in proportion."""
        return (*super().lengths, "arm_length", "third_length")

    @property
    def turning(self) -> bool:
        """Whether a third leg turns the tool."""
        return True

    @cached_property
    def structure(self) -> Structure:
        """The linkage with its flexible rods and arm."""
        beams = (
            *parts.beams(self.material, self.section),
            *parts.turning_beams(self.material, self.arm_section, self.third_section),
        )
        masses = (
            self._plate(f"{parts.PLATFORM}/hinge"),
            PointMass(parts.TOOL, self.arm_mass),
            *self._carriages((*parts.LEGS, parts.THIRD)),
        )
        return Structure(self.linkage, beams=beams, rigid=(parts.hub(),), masses=masses)

    @staticmethod
    def poses(x: ArrayLike, y: ArrayLike = 0.0, turn: ArrayLike = 0.0) -> Poses:
        """Poses of the tool; broadcast.

        Parameters
        ----------
        x, y : (...)
            Its place in the plane, m.
        turn : (...)
            β about y, rad.
        """
        x, y, turn = np.broadcast_arrays(*(np.asarray(v, dtype=float) for v in (x, y, turn)))
        return Poses(np.stack([x, y, np.zeros_like(x)], axis=-1), rotation_y(turn))

    def _placed(
        self, poses: Poses
    ) -> tuple[dict[str, Array], dict[str, Array], dict[tuple[str, str], Array], dict[str, Array]]:
        positions, frames, values, faults = super()._placed(poses)
        tool = poses.position
        out, up = poses.rotation[..., 0, 0], -poses.rotation[..., 2, 0]
        turn = angle(up, out)
        # from the carriage to the arm's end: in x, y and downwards
        ahead = tool[..., 0] + self.arm_length * (out - 1.0)
        aside = tool[..., 1]
        square = self.third_length**2 - ahead * ahead - aside * aside
        drop, missing = square_root(square, self.third_length)
        faults[f"leg {parts.THIRD}: {REACH}"] = missing
        place = self.arm_length * up - drop
        across = np.sqrt(ahead * ahead + drop * drop)
        lean, sway = angle(-ahead, drop), angle(aside, across)
        end = tool + self.arm_length * poses.rotation[..., :, 0]
        foot = vector(np.full_like(place, self.arm_length), 0.0, -place)
        pin = parts.carriage(parts.THIRD, "pin")
        slide = parts.carriage(parts.THIRD, "slide")
        rod = {part: parts.rod(parts.THIRD, part=part) for part in ("foot", "end")}
        positions |= dict.fromkeys((parts.rail(parts.THIRD), slide, pin, rod["foot"]), foot)
        positions |= {f"{parts.ARM}/end": end, rod["end"]: end}
        positions |= {f"{parts.PLATFORM}/hinge": tool, f"{parts.ARM}/root": tool}
        hinge = f"{parts.ARM}/hinge"
        values |= {
            (hinge, "rz"): turn,
            (parts.guide(parts.THIRD), "z"): place,
            (rod["foot"], "rx"): sway,
            (rod["foot"], "rz"): lean,
            (rod["end"], "rx"): turn - lean,
            (rod["end"], "rz"): -sway,
        }
        if self.leg_bend is not None:
            # cosines of the angles between leg and rail, and between leg and the arm's normal
            cosines = (drop, drop * out - ahead * up)
            values |= {
                (name, BEND): np.arccos(np.clip(c.real / self.third_length, -1.0, 1.0))
                for name, c in zip(rod.values(), cosines, strict=True)
            }
        # the lower universal joint turns about y first, then about `cross`, which is the rod's own;
        # the upper one the other way about
        axis = np.broadcast_to(np.array([0.0, 1.0, 0.0]), end.shape)
        cross = vector(drop / across, 0.0, ahead / across)
        normal = vector(-ahead / across, 0.0, drop / across)
        frames |= {
            hinge: np.broadcast_to(_HINGE, (*end.shape, 3)),
            parts.guide(parts.THIRD): np.broadcast_to(_DOWN, (*end.shape, 3)),
            rod["foot"]: frame(cross, -normal, axis),
            rod["end"]: frame(axis, normal, cross),
        }
        return positions, frames, values, faults

    def _faults(self, poses: Poses) -> dict[str, Array]:
        faults = super()._faults(poses)
        found = {reason: mask for reason, mask in faults.items() if reason != TWO_DRIVES_TURNED}
        turned = np.abs(poses.rotation[..., 1].real - np.array([0.0, 1.0, 0.0])).max(axis=-1)
        return found | {TURNED: np.broadcast_to(turned > PLANE, poses.position.shape[:-1])}


def models_by_legs(report: str) -> tuple[Variant, ...]:
    """The machine in its plane, and with the leg that turns its tool, which has its own report.

    Parameters
    ----------
    report : str
        What writes the turning machine's report, as `Variant.report`.
    """
    turning = {"x": (0.4, 5), "y": (0.4, 5), "ry": (radians(60.0), 5)}
    words = "a third drive across the plane rotates the tool"
    return (
        Variant("plane", "two drives, the tool does not rotate", Biglide),
        Variant("third-leg", words, BiglideThirdLeg, turning, report),
    )
