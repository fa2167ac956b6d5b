"""The static answers of a model file, by the names of the file."""

from __future__ import annotations

import warnings
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from strutwork.errors import ModelError, StrutworkError
from strutwork.kinematics import NearMechanism, near_motions
from strutwork.machines.bearing_states import Equilibrium, joined
from strutwork.machines.model import Model, ModelWarning
from strutwork.msa import (
    PlacedStructure,
    Spring,
    StaticSolution,
    solve,
    tool_compliance,
    tool_stiffness,
)
from strutwork.reports.flexure_use import described_flexures, flexure_uses, warn_of_flexures
from strutwork.reports.near_mechanisms import near_mechanisms, warn_of_near

Array = NDArray[Any]

#: Joints named in a warning.
NAMED = 12


@dataclass(frozen=True)
class ModelSolution:
    """What `solve_model` found.

    Parameters
    ----------
    model : Model
    statics : StaticSolution
        Single pose; as many cases as the file has.
    compliance : (6, 6) or None
        At the tool, m/N, 1/N, rad/(N·m); None without a tool, or where it moves freely.
    stiffness : (6, 6) or None
        Inverse of the compliance; None where it has none.
    near : tuple of NearMechanism
        Motions that coordinates of few digits hold.
    equilibria : tuple of Equilibrium
        By case, of a model with bearings; empty without.
    """

    model: Model
    statics: StaticSolution
    compliance: Array | None
    stiffness: Array | None
    near: tuple[NearMechanism, ...] = ()
    equilibria: tuple[Equilibrium, ...] = ()

    def __repr__(self) -> str:
        return f"<ModelSolution: {self.statics!r}, tool {self.model.tool}>"

    @property
    def undetermined(self) -> Mapping[str, tuple[str, ...]]:
        """Joint directions whose force rigid parts alone leave open: withheld."""
        return self.statics.undetermined_names if self.statics.cases else {}

    def to_dict(self) -> dict[str, Any]:
        """Plain numbers in SI, by the names of the model file."""
        cases = {name: self._case(m) for m, name in enumerate(self.statics.cases)}
        supports = {joint: node for node, joint in self.model.supports.items()}
        named = self.undetermined
        joints = {j: list(d) for j, d in named.items() if j not in supports}
        reactions = {supports[j]: list(d) for j, d in named.items() if j in supports}
        beside = {
            "undetermined_joint_forces": joints,
            "undetermined_reactions": reactions,
            "near_mechanisms": near_mechanisms(self.model, self.near),
        }
        if self.model.flexures:
            beside["flexures"] = described_flexures(self.model)
        if self.compliance is None:
            return {"cases": cases, "tcp": None, **beside}
        against = self.model.structure.linkage.against
        return {
            "cases": cases,
            **beside,
            "tcp": {
                **({} if against is None else {"against": against}),
                "compliance": self.compliance.tolist(),
                "stiffness": None if self.stiffness is None else self.stiffness.tolist(),
            },
        }

    def _case(self, m: int) -> dict[str, Any]:
        model, s = self.model, self.statics
        linkage = model.structure.linkage
        nodes = linkage.node_index
        bent = {joint: use.to_dict() for joint, use in flexure_uses(model, s, m).items()}
        return {
            "displacements": {n: s.displacements[nodes[n], :, m].tolist() for n in model.nodes},
            # a support's joint has global axes, and its second node is the structure's
            "reactions": {node: self._force(joint, m) for node, joint in model.supports.items()},
            "joint_forces": {j: self._force(j, m) for j in model.joints},
            "spring_forces": {
                spring.name: _spring_force(
                    s.displacements[..., m], nodes, spring, model.placed
                ).tolist()
                for spring in model.structure.springs
            },
            "beam_forces": {
                beam.name: {
                    "from": s.beam_forces[b, 0, :, m].tolist(),
                    "to": s.beam_forces[b, 1, :, m].tolist(),
                }
                for b, beam in enumerate(model.structure.beams)
            },
            "strain_energy": float(s.strain_energy[m]),
            **({"flexures": bent} if bent else {}),
            **self._loaded(m),
        }

    def _loaded(self, m: int) -> dict[str, Any]:
        """Of a model with bearings: their state in a case, and the tool's stiffness there."""
        if not self.equilibria:
            return {}
        found = self.equilibria[m]
        states = {state.joint: state.to_dict() for state in found.states}
        result: dict[str, Any] = {"bearings": states, "bearing_steps": found.steps}
        if self.compliance is not None:
            compliance = tool_compliance(found.tangent)
            stiffness = None if self.stiffness is None else tool_stiffness(compliance).tolist()
            result["tcp"] = {"compliance": compliance.tolist(), "stiffness": stiffness}
        return result

    def _force(self, joint: str, m: int) -> list[float | None]:
        """Force of a joint, None in directions that are not determined."""
        index = self.model.structure.linkage.joint_index[joint]
        six = self.statics.joint_forces[index, :, m]
        open_ = self.statics.undetermined[index]
        if np.any(open_):
            # beside what is withheld nobody could tell rounding from a force
            largest = np.abs(self.statics.joint_forces[..., m]).max()
            six = np.where(np.abs(six) < 1e-12 * largest, 0.0, six)
        return list(np.ma.masked_array(six, open_).tolist())


def solve_model(model: Model) -> ModelSolution:
    """Solve the load cases of a model, and the compliance at its tool if it has one.

    Parameters
    ----------
    model : Model

    Returns
    -------
    ModelSolution

    Raises
    ------
    ModelError
        Neither a load case nor a tool: there is nothing to solve.
    ContactError, NumericalError
        As `strutwork.machines.bearing_equilibrium.equilibrium`, of a model with bearings.
    MechanismError
        The structure moves freely under a load, or, when there is no load case, under a
        wrench at the tool.

    Warns
    -----
    ModelWarning
        The load cases can be solved, but the compliance at the tool cannot; forces that are
        not determined; motions that coordinates of few digits hold; flexures stressed or moved
        too far.
    """
    if not model.cases and model.tool is None:
        raise ModelError(
            "model",
            "has neither a load nor a tool: there is nothing to solve.",
            "Add loads, gravity, settlements or misfits, or a [tool].",
        )
    equilibria = _equilibria(model)
    statics = joined(equilibria) if equilibria else solve(model.placed, model.cases)
    compliance = stiffness = None
    if model.tool is not None:
        try:
            compliance = tool_compliance(model.placed)
            stiffness = tool_stiffness(compliance)
        except StrutworkError as error:
            if not model.cases and compliance is None:
                raise
            # an error of the tool itself says so
            where = "" if error.part == "tool" else "tool: "
            warnings.warn(f"{where}{error}", ModelWarning, stacklevel=2)
    near = near_motions(model.structure.linkage, model.placement)
    warn_of_near(near)
    found = ModelSolution(model, statics, compliance, stiffness, near, equilibria)
    warn_of_flexures(model, statics)
    _warn_of_undetermined(found.undetermined)
    return found


def _equilibria(model: Model) -> tuple[Equilibrium, ...]:
    if not model.bearings:
        return ()
    from strutwork.machines.bearing_equilibrium import equilibrium

    return tuple(equilibrium(model, case) for case in model.cases)


def _warn_of_undetermined(undetermined: Mapping[str, tuple[str, ...]]) -> None:
    if not undetermined:
        return
    shown = [f"{joint} in {', '.join(d)}" for joint, d in list(undetermined.items())[:NAMED]]
    more = len(undetermined) - len(shown)
    named = "; ".join(shown) + (f"; and {more} more" if more else "")
    warnings.warn(
        f"joint forces: those of {named} are indeterminate and are withheld: only rigid parts "
        "decide how they share a force. Give one of these joints or bodies its real stiffness.",
        ModelWarning,
        stacklevel=3,
    )


def _spring_force(
    displacements: Array, nodes: dict[str, int], spring: Spring, placed: PlacedStructure
) -> Array:
    """On the node of a spring to ground, or the second of one between two, global axes, (6,)."""
    last = displacements[nodes[spring.nodes[-1]]]
    first = displacements[nodes[spring.nodes[0]]] if len(spring.nodes) == 2 else 0.0
    axes = placed.spring_axes(spring)
    return np.asarray(-(axes * spring.diagonal) @ axes.T @ (last - first))
