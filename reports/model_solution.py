"""The static answers of a model file, by the names of the file."""

from __future__ import annotations

import warnings
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from machines.model import Model, ModelWarning
from msa import StaticSolution, solve, tool_compliance, tool_stiffness
from strutwork.errors import MechanismError, ModelError, SingularPoseError

Array = NDArray[Any]


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
    """

    model: Model
    statics: StaticSolution
    compliance: Array | None
    stiffness: Array | None

    def __repr__(self) -> str:
        return f"<ModelSolution: {self.statics!r}, tool {self.model.tool}>"

    def to_dict(self) -> dict[str, Any]:
        """Plain numbers in SI, by the names of the model file."""
        cases = {name: self._case(m) for m, name in enumerate(self.statics.cases)}
        if self.compliance is None:
            return {"cases": cases, "tcp": None}
        return {
            "cases": cases,
            "tcp": {
                "compliance": self.compliance.tolist(),
                "stiffness": None if self.stiffness is None else self.stiffness.tolist(),
            },
        }

    def _case(self, m: int) -> dict[str, Any]:
        model, s = self.model, self.statics
        linkage = model.structure.linkage
        nodes, joints = linkage.node_index, linkage.joint_index
        return {
            "displacements": {n: s.displacements[nodes[n], :, m].tolist() for n in model.nodes},
            # a support's joint has global axes, and its second node is the structure's
            "reactions": {
                node: s.joint_forces[joints[joint], :, m].tolist()
                for node, joint in model.supports.items()
            },
            "joint_forces": {j: s.joint_forces[joints[j], :, m].tolist() for j in model.joints},
            "spring_forces": {
                spring.name: _spring_force(s.displacements[..., m], nodes, spring).tolist()
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
        }


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
    MechanismError
        The structure moves freely under a load, or, when there is no load case, under a
        wrench at the tool.

    Warns
    -----
    ModelWarning
        The load cases can be solved, but the compliance at the tool cannot.
    """
    if not model.cases and model.tool is None:
        raise ModelError(
            "model",
            "has neither a load nor a tool: there is nothing to solve.",
            "Add loads, gravity, settlements or misfits, or a [tool].",
        )
    statics = solve(model.placed, model.cases)
    compliance = stiffness = None
    if model.tool is not None:
        try:
            compliance = tool_compliance(model.placed)
            stiffness = tool_stiffness(compliance)
        except (MechanismError, SingularPoseError) as error:
            if not model.cases and compliance is None:
                raise
            # an error of the tool itself says so
            where = "" if error.part == "tool" else "tool: "
            warnings.warn(f"{where}{error}", ModelWarning, stacklevel=2)
    return ModelSolution(model, statics, compliance, stiffness)


def _spring_force(displacements: Array, nodes: dict[str, int], spring: Any) -> Array:
    """On the node of a spring to ground, or the second node of one between two, (6,)."""
    last = displacements[nodes[spring.nodes[-1]]]
    first = displacements[nodes[spring.nodes[0]]] if len(spring.nodes) == 2 else 0.0
    return np.asarray(-spring.diagonal * (last - first))
