"""Every cause of an error sheet as a right-hand side of the machine's system."""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import NDArray

from strutwork.errors import ModelError
from strutwork.fea.coupled import AnyDamping
from strutwork.fea.damping import ModalRatio
from strutwork.fea.ground_vibration import GroundVibration, ground_vibration
from strutwork.fea.load_response import load_response
from strutwork.kinematics import DIRECTIONS, State
from strutwork.machines.model import Model
from strutwork.msa.loads import LoadCase
from strutwork.msa.solve import solve
from strutwork.msa.structure import PlacedStructure
from strutwork.overconstraint.accuracy import accuracy
from strutwork.overconstraint.joint_errors import JointError
from strutwork.overconstraint.sources import MisfitSources
from strutwork.overconstraint.unit_sets import Disc
from strutwork.studies.error_calibration import GeometryCalibration, turned
from strutwork.studies.error_inputs import ErrorInputs
from strutwork.studies.error_known import NONE, KnownCauses
from strutwork.studies.error_servos import servo_notes, with_loops
from strutwork.studies.error_sheet import CAUSES, PEAK, ErrorRow, ErrorSheet, NormalBall
from strutwork.studies.model_damping import model_damping

Array = NDArray[Any]


@dataclass(frozen=True)
class ErrorCauses:
    """The error sheet of a machine where it stands.

    Parameters
    ----------
    model : Model
    inputs : ErrorInputs
    placed : PlacedStructure
        The model's structure at one pose.
    """

    model: Model
    inputs: ErrorInputs
    placed: PlacedStructure

    def __repr__(self) -> str:
        return f"<ErrorCauses of {self.model.title!r}>"

    @cached_property
    def known(self) -> KnownCauses:
        """Gravity, temperatures, steady forces, and what servos yield to them."""
        return KnownCauses(self.model, self.inputs, self.placed)

    def sheet(self, *, forces: bool = True) -> ErrorSheet:
        """All rows, notes, what the drives carry, and the drift.

        Parameters
        ----------
        forces : bool
            Whether what the drives carry is wanted, which is a solution of its own.

        Raises
        ------
        ModelError
            No cause at all, or inputs that do not fit the machine.
        StrutworkError
            As the solvers.
        """
        geometry, drives = self._varied()
        before: tuple[ErrorRow, ...] = ()
        if self.inputs.calibrated is not None:
            before, geometry = tuple(geometry), self._after(geometry, self.inputs.calibrated)
        rows = [*geometry, *drives, *self.known.rows(), *self._periodic()]
        vibration = self.vibration
        notes = [s.note for t in self.inputs.temperatures for s in t.solids if s.note]
        notes += servo_notes(self.inputs, self.placed.structure)
        if vibration is not None:
            notes += [vibration.note] if vibration.note else []
            rows += self._ground(vibration)
        if not rows:
            raise ModelError(
                "error sheet",
                f"finds no cause of error in {self.model.title or 'the model'}.",
                "Add tolerances, gravity, drives with a resolution, or an errors file.",
            )
        rows.sort(key=lambda row: CAUSES.index(row.cause))
        return ErrorSheet(
            tuple(rows),
            tuple(notes),
            self._drive_forces() if forces else (),
            self.known.drift(self.inputs.moments),
            self.inputs.calibrated,
            before,
        )

    def _varied(self) -> tuple[list[ErrorRow], list[ErrorRow]]:
        """Tolerances, and the resolution and backlash of drives."""
        tolerances = self.inputs.all_tolerances(self.model)
        errors = self._joint_errors()
        if not tolerances and not errors:
            return [], []
        soft = self.known.soft
        if self.inputs.calibrated is not None:
            soft = turned(self.model, soft)
        found = accuracy(soft, tolerances, errors)
        rows = _rows(found.sources, found.gain, found.mean, len(tolerances))
        return (
            [row for row in rows if row.cause == "geometry"],
            [row for row in rows if row.cause != "geometry"],
        )

    def _after(self, rows: list[ErrorRow], calibrated: GeometryCalibration) -> list[ErrorRow]:
        """The geometry after its calibration; the middle of zones is known and compensated."""
        gain = np.concatenate([row.gain for row in rows], axis=1)
        left, noise = gain @ calibrated.keep, gain @ calibrated.noise
        cause = "geometry after calibration"
        found, start = [], 0
        for row in rows:
            stop = start + row.gain.shape[1]
            if stop > start:
                found.append(replace(row, cause=cause, mean=np.zeros(6), gain=left[:, start:stop]))
            start = stop
        if noise.shape[1]:
            part = "uncertainty of the measurement"
            root = _root(noise @ noise.T)
            found.append(
                ErrorRow(cause, part, np.zeros(6), PEAK * root, (NormalBall(6),), "surface")
            )
        return found

    def _joint_errors(self) -> tuple[JointError, ...]:
        given = {(d.joint, d.direction): d for d in self.inputs.drives}
        stated = {(d.joint, d.direction): d.resolution for d in self.model.drives}
        found = []
        for key in self.placed.structure.linkage.driven:
            drive = given.get(key)
            step = stated.get(key)
            if drive is not None and drive.resolution is not None:
                step = drive.resolution
            if step:
                found.append(JointError("drive error", *key, step / 2))
            if drive is not None and drive.backlash:
                found.append(JointError("play", *key, drive.backlash / 2))
        return tuple(found)

    @cached_property
    def damping(self) -> AnyDamping:
        """Of the machine.

        Raises
        ------
        ModelError
            It has none.
        """
        found = model_damping(self.model)
        process = self.model.process
        if found is None and process is not None and process.modal_ratio is not None:
            return ModalRatio(process.modal_ratio)
        if found is None:
            raise ModelError(
                "damping",
                "is missing, and a periodic force or a vibrating ground needs it.",
                "Add [damping] with modal_ratio to the model file.",
            )
        return found

    def _periodic(self) -> list[ErrorRow]:
        rows = []
        for force in self.inputs.cutting:
            if force.frequency is None:
                continue
            loads = self.known.at_tool(force.wrench)[0]
            response = load_response(self.known.vibrating, loads, self.damping, self.inputs.against)
            a = response.at(np.array([force.frequency]))[0, :, 0]
            gain = np.stack([a.real, -a.imag], axis=-1)
            rows.append(ErrorRow("cutting", force.name, np.zeros(6), gain, (Disc(),), "surface"))
        milling = self.known.milling
        if milling is not None:
            loads = np.concatenate([self.known.at_tool((*e, 0, 0, 0))[0] for e in np.eye(3)], -1)
            response = load_response(self.known.vibrating, loads, self.damping, self.inputs.against)
            moved = np.einsum("hom,hm->ho", response.at(milling.frequencies), milling.amplitudes)
            for a, f in zip(moved, milling.frequencies, strict=True):
                gain = np.stack([a.real, -a.imag], axis=-1)
                part = f"milling, {f:.4g} Hz"
                rows.append(ErrorRow("cutting", part, np.zeros(6), gain, (Disc(),), "surface"))
        return rows

    @cached_property
    def vibration(self) -> GroundVibration | None:
        """Of the tool by the ground; None where no spectrum is given."""
        if not self.inputs.ground:
            return None
        return ground_vibration(
            self.known.vibrating, self.inputs.ground, self.damping, self.inputs.against
        )

    def _ground(self, found: GroundVibration) -> list[ErrorRow]:
        rows = []
        for spectrum, covariance in zip(self.inputs.ground, found.covariance, strict=True):
            root = _root(covariance)
            rows.append(
                ErrorRow(
                    "ground",
                    f"along {spectrum.direction}",
                    np.zeros(6),
                    PEAK * root,
                    (NormalBall(6),),
                    "surface",
                )
            )
        return rows

    def _drive_forces(self) -> tuple[tuple[str, float], ...]:
        if self.known.gravity is None:
            return ()
        linkage = self.known.soft.structure.linkage
        found = solve(self.known.soft, [LoadCase("gravity", gravity=self.known.gravity)])
        states = linkage.states()
        forces = []
        for joint, direction in linkage.driven:
            d = DIRECTIONS.index(direction)
            if states[linkage.joint_index[joint], d] != State.FREE:
                force = found.joint_force(joint, "gravity")[d]
                # what rigid parts alone leave open has no number
                if not np.ma.is_masked(force):
                    forces.append((f"{joint}:{direction}", float(force)))
        return tuple(forces)


def _root(covariance: Array) -> Array:
    """A root of a covariance (6, 6), made with rotations at their own scale."""
    scale = np.sqrt(np.maximum(np.diag(covariance), 1e-300))
    values, vectors = np.linalg.eigh(covariance / np.outer(scale, scale))
    return np.asarray(scale[:, None] * vectors * np.sqrt(np.maximum(values, 0.0)))


def _rows(sources: MisfitSources, gain: Array, mean: Array, tolerances: int) -> list[ErrorRow]:
    """A row for every tolerance and drive error; the middle of asymmetric zones is known."""
    rows = []
    for t, tolerance in enumerate(sources.tolerances):
        blocks = [b for b in sources.blocks if b.tolerance == t]
        pick = [b.start + i for b in blocks for i in range(b.shape.dimension)]
        rows.append(
            ErrorRow(
                "geometry" if t < tolerances else "drives",
                tolerance.name,
                np.zeros(6),
                gain[:, pick],
                tuple(b.shape for b in blocks),
                tolerance.distribution,
            )
        )
    if np.any(mean):
        rows.append(ErrorRow("geometry", "middle of the tolerances", np.asarray(mean), NONE))
    return rows


def error_sheet(
    model: Model, inputs: ErrorInputs | None = None, placed: PlacedStructure | None = None
) -> ErrorSheet:
    """Displacement of the tool relative to the workpiece, by cause and part.

    Parameters
    ----------
    model : Model
        With a tool.
    inputs : ErrorInputs, optional
        What the model does not state.
    placed : PlacedStructure, optional
        Its structure at another pose; by default where it stands.

    Returns
    -------
    ErrorSheet

    Raises
    ------
    ModelError
        No tool, no cause, an unknown part, a part without an expansion coefficient, or no damping
        or mass where vibration needs it.
    StrutworkError
        As the solvers.
    """
    return error_causes(model, inputs, placed).sheet()


def error_causes(
    model: Model, inputs: ErrorInputs | None = None, placed: PlacedStructure | None = None
) -> ErrorCauses:
    """What `error_sheet` makes its sheet of.

    Parameters
    ----------
    model : Model
        With a tool.
    inputs : ErrorInputs, optional
    placed : PlacedStructure, optional

    Raises
    ------
    ModelError
        As `error_sheet`.
    """
    model.require_tool()
    here = model.placed if placed is None else placed
    given, linkage = with_loops(inputs or ErrorInputs(), model), here.structure.linkage
    if given.against is None:
        given = replace(given, against=linkage.against)
    if given.against != linkage.against:
        # all that is relative takes its node from the linkage
        structure = replace(here.structure, linkage=replace(linkage, against=given.against))
        model, here = replace(model, structure=structure), structure.at(here.placement)
    return ErrorCauses(model, given.computed(model), here)
