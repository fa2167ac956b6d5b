"""What a model left out, and what was assumed in its place."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from strutwork.kinematics.joint import DIRECTIONS, State
from strutwork.machines.model import Model
from strutwork.names import listed
from strutwork.overconstraint.tolerance import TILTS
from strutwork.reports.alike import grouped
from strutwork.reports.inputs.parts import used_materials
from strutwork.reports.numbers import count

#: Groups of names that a sentence lists; the table has all.
NAMED = 6

SMALL = (
    "Displacements are small and linear, without friction or play, and contacts never open, "
    "except where a chapter says otherwise."
)
COLD = "The temperature is that at which the machine was assembled: no part expands."


def assumed(model: Model) -> tuple[str, ...]:
    """One sentence for each thing that the model does not say."""
    parts = (_beams, _joints, _heavy, _loads, _damped, _motion, _tolerances)
    return (*(sentence for part in parts for sentence in part(model)), SMALL, COLD)


def _beams(model: Model) -> Iterator[str]:
    stiff = {b.section.name for b in model.structure.beams if not b.shear}
    no_area = {
        b.section.name
        for b in model.structure.beams
        if b.shear and b.section.shear_areas is None and b.section.shear_coefficients is None
    }
    if no_area - stiff:
        yield (
            f"Shear does not deform beams of {_some(sorted(no_area - stiff))}: no shear areas are "
            "given."
        )
    if stiff:
        yield f"Shear is neglected, as the model requests, in beams of {_some(sorted(stiff))}."
    flexible = model.structure.flexible_bodies
    bodies = model.structure.linkage.body_names
    rigid = [name for i, name in enumerate(bodies) if i not in flexible]
    named = [name for name in rigid if name not in model.nodes]
    if named:
        one = len(named) == 1
        words = ("is", "it") if one else ("are", "them")
        yield f"{_some(named)} {words[0]} rigid: no beam or solid is part of {words[1]}."


def _joints(model: Model) -> Iterator[str]:
    linkage = model.structure.linkage
    own = [j for j in linkage.joints if j.name in model.joints]
    held = [j.name for j in own if State.LOCKED in j.states and not j.driven]
    if held:
        yield f"{_some(held)}: held directions without a given stiffness are rigid."
    stiff = [
        j.name for j in own if any(j.states[DIRECTIONS.index(d)] == State.LOCKED for d in j.driven)
    ]
    if stiff:
        verb = "holds its" if len(stiff) == 1 else "hold their"
        yield f"{_some(stiff)} {verb} driven direction rigidly: no stiffness of the drive is given."
    if any(entry.geometry is not None for entry in model.bearings.values()):
        yield "Bearings have the stiffness at their preload; in load cases it follows the load."
    if model.supports:
        yield "Supports are rigid."
    if own:
        yield "Joints have no mass and no size of their own."
    if model.flexures:
        yield "Flexures have the stiffness that they have without load, and no mass or damping."


def _heavy(model: Model) -> Iterator[str]:
    light = [name for name, m in used_materials(model).items() if m.density is None]
    if light:
        yield f"Parts of {_some(light)} have no mass: no density is given."
    if not model.structure.masses:
        yield "No node or body carries a mass of its own."


def _loads(model: Model) -> Iterator[str]:
    if not any(case.gravity is not None for case in model.cases):
        yield "No weight acts: gravity is not given."
    if model.preload is None:
        yield "The machine vibrates without preload: no load stiffens or softens it."
    else:
        yield f"It vibrates under the loads of the case “{model.preload}”."


def _damped(model: Model) -> Iterator[str]:
    damping = model.damping
    if damping is None:
        joints = model.structure.linkage.joints
        lossy = any(m.loss_factor for m in used_materials(model).values())
        if not lossy and not any(any(j.damping.values()) for j in joints):
            yield "Nothing is damped: no damping is given."
        return
    if damping.modal_ratio is not None:
        yield f"Every mode is damped by the viscous ratio {damping.modal_ratio:g}."
    if damping.loss_factor is not None:
        yield f"All parts have the structural loss factor {damping.loss_factor:g}."
    if damping.rayleigh is not None:
        alpha, beta = damping.rayleigh
        yield f"Damping is {alpha:g} 1/s times the mass plus {beta:g} s times the stiffness."
    lossy_names = [name for name, m in used_materials(model).items() if m.loss_factor]
    if lossy_names:
        yield (
            f"The loss factor of {_some(lossy_names)} is not used: the damping of the structure "
            "already includes it."
        )


def _motion(model: Model) -> Iterator[str]:
    linkage = model.structure.linkage
    limited = {(m.joint, m.coordinate) for m in model.limits}
    driven = [f"{j}:{d}" for j, d in linkage.driven if (j, d) not in limited]
    if driven:
        yield f"{_some(driven)} can move without limit: no limits are given."
    known = {(d.joint, d.direction): d for d in model.drives}
    silent = [f"{j}:{d}" for j, d in linkage.driven if (j, d) not in known]
    if silent:
        yield f"Speed, force and resolution of {_some(silent)} are not given and not checked."
    if linkage.driven and model.workspace is None:
        yield "No workspace is given: the machine is analysed only in the configuration given."


def _tolerances(model: Model) -> Iterator[str]:
    if not model.tolerances:
        return
    if not model.force_limits:
        yield "No limits of joint forces are given: forces are not checked."
    still = [
        t.name
        for t in model.tolerances
        if t.kind not in TILTS and t.kind in {"position", "coaxiality", "location"} and not t.length
    ]
    if still:
        yield f"The tolerances {_some(still)} allow no tilt: no length is given."
    by_default = [t.name for t in model.tolerances if t.datum is None]
    if by_default:
        yield f"Features of {_some(by_default)} rotate about the first node of their first joint."


def _some(names: Sequence[str]) -> str:
    """Names alike in groups; of many groups the first few and how many more."""
    labels = [g.label for g in grouped(dict.fromkeys(names, ()))]
    if len(labels) <= NAMED:
        return listed(labels)
    return f"{', '.join(labels[:NAMED])} and {count(len(labels) - NAMED, 'other')}"
