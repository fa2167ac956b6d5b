"""What is known of a machine's errors: gravity, temperatures and steady forces, and its servos."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import NDArray

from strutwork.kinematics import DIRECTIONS
from strutwork.machines.model import Model
from strutwork.msa.assembly import System, system_of
from strutwork.msa.loads import LoadCase
from strutwork.msa.nodal_response import nodal_displacements, relative_motion
from strutwork.msa.structure import PlacedStructure
from strutwork.msa.thermal_loads import thermal_loads
from strutwork.msa.weights import part_weights
from strutwork.overconstraint.unit_sets import Interval
from strutwork.studies.error_inputs import ErrorInputs
from strutwork.studies.error_milling import MillingForces, milling_forces
from strutwork.studies.error_servos import series_compliance, with_servos
from strutwork.studies.error_sheet import ErrorRow

Array = NDArray[Any]

#: Of what is known there is no range.
NONE = np.zeros((6, 0))


@dataclass(frozen=True)
class KnownCauses:
    """Displacements of the tool by loads and temperatures, where a machine stands.

    Parameters
    ----------
    model : Model
    inputs : ErrorInputs
    placed : PlacedStructure
        The model's structure at one pose, without its servos.
    """

    model: Model
    inputs: ErrorInputs
    placed: PlacedStructure

    def __repr__(self) -> str:
        return f"<KnownCauses of {self.model.title!r}>"

    @cached_property
    def system(self) -> System:
        """Of the machine without its servos, at one pose."""
        return system_of(self.placed)

    @cached_property
    def soft(self) -> PlacedStructure:
        """With its servos, at rest."""
        return self._with_servos(vibrating=False)

    @cached_property
    def vibrating(self) -> PlacedStructure:
        """With its servos, as far as they matter to vibration."""
        return self._with_servos(vibrating=True)

    def _with_servos(self, vibrating: bool) -> PlacedStructure:
        structure = with_servos(self.placed.structure, self.inputs.drives, vibrating=vibrating)
        if structure is self.placed.structure:
            return self.placed
        return structure.at(self.placed.placement)

    @cached_property
    def wanted(self) -> Array:
        """Relative motion of the tool per displacement of the nodes, (6, n, 6)."""
        return relative_motion(self.placed, self.inputs.against)

    @cached_property
    def milling(self) -> MillingForces | None:
        """Of the milling cut at this pose; None where there is none."""
        if self.inputs.milling is None:
            return None
        return milling_forces(self.model, self.inputs.milling, self.placed.placement)

    @property
    def gravity(self) -> tuple[float, float, float] | None:
        """Of the machine, where it counts, m/s²."""
        if not self.inputs.gravity:
            return None
        if self.inputs.acceleration is not None:
            return self.inputs.acceleration
        return next((c.gravity for c in self.model.cases if c.gravity is not None), None)

    @cached_property
    def _steady(self) -> tuple[list[tuple[str, str]], Array, Array, Array]:
        """What is known: causes and parts, loads, gaps and what moves within bodies, at one pose.

        Temperatures stand as they are after a long time.
        """
        names: list[tuple[str, str]] = []
        system = self.system
        shape = (1, len(self.placed.structure.mesh_nodes), 6, 0)
        loads, gaps = [np.zeros(shape)], [np.zeros((1, len(system.row_labels), 0))]
        moved = [np.zeros(shape)]

        def add(cause: str, parts: Sequence[str], load: Array) -> None:
            names.extend((cause, part) for part in parts)
            loads.append(load)
            gaps.append(np.zeros((1, len(system.row_labels), load.shape[-1])))
            moved.append(np.zeros_like(load))

        if self.gravity is not None:
            add("gravity", *part_weights(system, self.gravity))
        for force in self.inputs.cutting:
            if force.frequency is None:
                add("cutting", [force.name], self.at_tool(force.wrench))
        if self.milling is not None:
            add("cutting", ["milling, mean"], self.at_tool((*self.milling.mean, 0.0, 0.0, 0.0)))
        known = [e for t in self.inputs.temperatures for e in t.expansions()]
        if known:
            found = thermal_loads(system, known)
            names.extend(("thermal", e.part) for e in known)
            loads.append(found.loads)
            gaps.append(found.gaps)
            moved.append(found.moved)
        return (
            names,
            np.concatenate(loads, axis=-1),
            np.concatenate(gaps, axis=-1),
            np.concatenate(moved, axis=-1),
        )

    def at_tool(self, wrench: Sequence[float]) -> Array:
        """A wrench between tool and workpiece at the nodes, (1, n, 6, 1), N and N·m.

        Parameters
        ----------
        wrench : (6,)
            On the tool, N and N·m.
        """
        at = np.einsum("oni,o->ni", self.wanted, np.asarray(wrench, dtype=float))
        return np.asarray(at[None, ..., None])

    def _shares(self, time: float | None) -> Array:
        """Of every known cause at a moment, (m,), no unit."""
        named = self._steady[0]
        share = np.ones(len(named))
        first = sum(cause != "thermal" for cause, _ in named)
        heated = [t for t in self.inputs.temperatures for _ in t.parts]
        share[first:] = [t.share(time) for t in heated]
        return share

    @cached_property
    def _responses(self) -> Array:
        """Of the tool to every known cause, after a long time, (6, m)."""
        _, loads, gaps, moved = self._steady
        u = nodal_displacements(self.system.placed, loads, gaps) + moved
        return np.asarray(np.einsum("oni,nim->om", self.wanted, u[0]))

    def rows(self) -> list[ErrorRow]:
        """By every part, with what servos yield and what temperatures may differ."""
        named = self._steady[0]
        if not named:
            return []
        found = self._responses * self._shares(self.inputs.time)
        rows = [ErrorRow(cause, part, found[:, m], NONE) for m, (cause, part) in enumerate(named)]
        return [*_merged(rows), *self._spread(), *self._servos()]

    def _spread(self) -> list[ErrorRow]:
        """What temperatures may differ from what they are said to be."""
        rows = []
        for t in self.inputs.temperatures:
            if not t.spread:
                continue
            found = thermal_loads(self.system, t.spreads())
            u = nodal_displacements(self.system.placed, found.loads, found.gaps) + found.moved
            gain = np.einsum("oni,nim->o", self.wanted, u[0])[:, None]
            rows.append(
                ErrorRow("thermal", f"{t.name}, ± {t.spread:g} K", np.zeros(6), gain, (Interval(),))
            )
        return rows

    def _servos(self) -> list[ErrorRow]:
        """What servos yield to all that is known: the misfit F c of every drive is their share.

        With it the machine without servos does what the machine with them does.
        """
        rigid = self.placed.structure
        yields = {
            d: series_compliance(d, rigid)
            for d in self.inputs.drives
            if d.servo_stiffness is not None
        }
        given = [d for d, c in yields.items() if c]
        if not given:
            return []
        share = self._shares(self.inputs.time)
        _, loads, gaps, moved = self._steady
        total = [np.sum(x * share, axis=-1, keepdims=True) for x in (loads, gaps, moved)]
        soft = system_of(self.soft)
        # joints made elastic have no row, and take what moves within bodies as their stretch
        kept = [self.system.row_labels.index(label) for label in soft.row_labels]
        load = total[0].copy()
        stretched = self._stretch(total[2][0, ..., 0])
        extra = [d for d in given if f"{d.joint}:{d.direction}" in self.system.row_labels]
        structure = self.soft.structure.linkage
        closing = LoadCase(
            "within",
            gaps={(d.joint, d.direction): -float(stretched[d.joint, d.direction]) for d in extra},
        )
        _, elastic = soft.gaps([closing])
        load += soft.elastic_gap_loads(elastic)
        u = nodal_displacements(soft.placed, load, total[1][:, kept]) + total[2]
        now = self._stretch(u[0, ..., 0])
        columns = [(d.joint, d.direction) for d in given]
        matrix = self.transmission(self.placed, columns)
        rows = []
        for m, d in enumerate(given):
            joint = structure.joints[structure.joint_index[d.joint]]
            at = DIRECTIONS.index(d.direction)
            force = joint.stiffness_matrix[at, at] * now[d.joint, d.direction]
            part = f"servo of {d.joint}:{d.direction}"
            rows.append(ErrorRow("drives", part, matrix[:, m] * force * yields[d], NONE))
        return rows

    def _stretch(self, u: Array) -> dict[tuple[str, str], float]:
        """Motion of the second node against the first of every joint, joint axes, m and rad."""
        linkage = self.placed.structure.linkage
        found: dict[tuple[str, str], float] = {}
        for j, joint in enumerate(linkage.joints):
            first, second = (linkage.node_index[n] for n in joint.between)
            local = self.system.joint_frames[0, j].T @ (u[second] - u[first])
            found |= {(joint.name, d): float(v) for d, v in zip(DIRECTIONS, local, strict=True)}
        return found

    def transmission(self, placed: PlacedStructure, columns: Sequence[tuple[str, str]]) -> Array:
        """Relative displacement of the tool per unit misfit, (6, g): m/m, rad/m and the like.

        Parameters
        ----------
        placed : PlacedStructure
            At one pose.
        columns : sequence of (joint, direction)
            Locked or elastic.
        """
        system = system_of(placed)
        cases = [LoadCase(f"{j}:{d}", gaps={(j, d): 1.0}) for j, d in columns]
        on_rows, elastic = system.gaps(cases)
        u = nodal_displacements(system.placed, system.elastic_gap_loads(elastic), on_rows)
        return np.asarray(np.einsum("oni,nim->om", self.wanted, u[0]))

    def drift(self, moments: Sequence[float]) -> tuple[tuple[float, tuple[float, ...]], ...]:
        """Displacements by the temperatures at moments, (6,) each, m and rad.

        Parameters
        ----------
        moments : sequence of float
            After the temperatures began to change, s.
        """
        if not self.inputs.temperatures:
            return ()
        hot = np.array([cause == "thermal" for cause, _ in self._steady[0]], dtype=bool)
        drift = []
        for time in moments:
            u = (self._responses * self._shares(time))[:, hot].sum(axis=1)
            drift.append((float(time), tuple(float(v) for v in u)))
        return tuple(drift)


def _merged(rows: Sequence[ErrorRow]) -> list[ErrorRow]:
    """Rows of one cause and part added: two temperatures of one part, say."""
    found: dict[tuple[str, str], ErrorRow] = {}
    for row in rows:
        key = (row.cause, row.part)
        old = found.get(key)
        found[key] = row if old is None else replace(row, mean=old.mean + row.mean)
    return list(found.values())
