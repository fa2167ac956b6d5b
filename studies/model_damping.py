"""Damping of a model file."""

from __future__ import annotations

import warnings

from strutwork.fea import Damping, LossFactor, ModalRatio, PartDamping, Rayleigh
from strutwork.fea.coupled import AnyDamping
from strutwork.machines.model import Model, ModelWarning


def model_damping(model: Model, given: Damping | None = None) -> AnyDamping | None:
    """Damping of a model: its [damping] or `given`, and the dashpots of its joints.

    The materials' loss factors act where no damping of the whole is given, which would hold
    them already. None where nothing damps.

    Parameters
    ----------
    model : Model
    given : Damping, optional
        In the place of the file's.

    Warns
    -----
    ModelWarning
        Materials whose loss factors are not used.
    """
    found = given
    table = model.damping
    if found is None and table is not None:
        if table.modal_ratio is not None:
            found = ModalRatio(table.modal_ratio)
        elif table.loss_factor is not None:
            found = LossFactor(table.loss_factor)
        elif table.rayleigh is not None:
            found = Rayleigh(*table.rayleigh)
    structure = model.structure
    lossy = {b.material.name: b.material.loss_factor for b in structure.beams}
    for solid in model.solids:
        lossy |= dict.fromkeys(solid.materials, solid.loss_factor)
    named = [name for name, factor in lossy.items() if factor]
    if found is not None and named:
        warnings.warn(
            f"material {', '.join(sorted(named))}: the loss factor is not used, since the damping "
            f"of the structure ({found}) already includes it. Remove [damping] to use the "
            "materials'.",
            ModelWarning,
            stacklevel=2,
        )
    dashpots = any(any(j.damping.values()) for j in structure.linkage.joints)
    materials = found is None and bool(named)
    if dashpots or materials:
        return PartDamping(found, materials=materials, dashpots=dashpots)
    return found
