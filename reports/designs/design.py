"""One of two machines that are compared, and its answers; a question without one says why."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from functools import cached_property, partial
from typing import Any

import numpy as np
from numpy.typing import NDArray

from strutwork.errors import ModelError, StrutworkError
from strutwork.fea import Damping
from strutwork.fea.least_stiffness import least_dynamic_stiffness
from strutwork.fea.ports import tool_port, tool_ports
from strutwork.kinematics import DIRECTIONS
from strutwork.machines.extent import model_size
from strutwork.machines.model import Model
from strutwork.machines.naming import is_machine, named_machine, require_mass
from strutwork.msa import axis_stiffness_blocked, axis_stiffness_free, tool_compliance
from strutwork.names import listed, visible
from strutwork.reports.covering_band import covering_band
from strutwork.reports.designs.quantities import AXES, LISTED, of_question
from strutwork.reports.designs.row import Value
from strutwork.reports.freedom_words import tool_freedoms
from strutwork.reports.model_check import ModelCheck, check_model
from strutwork.reports.numbers import significant
from strutwork.reports.vibration import Target, model_target, target_modes
from strutwork.reports.vibration_study import has_mass
from strutwork.studies.tolerance_result import ToleranceStudy
from strutwork.studies.tolerance_study import StudyOptions, tolerance_study
from strutwork.studies.toleranced_machine import toleranced_machine

Array = NDArray[Any]

#: Answers by the key of their quantity.
Answers = dict[str, Value]


@dataclass(frozen=True)
class Design:
    """One of two machines that are compared.

    Parameters
    ----------
    name : str
        As it was asked for.
    model : Model
        At home.
    standing : Model
        Where it is asked: at home, or elsewhere.
    damping : Damping, optional
        In place of its own.
    """

    name: str
    model: Model
    standing: Model
    damping: Damping | None = None

    @property
    def title(self) -> str:
        """In words."""
        return visible(self.model.title or self.name)

    @property
    def moved(self) -> bool:
        """Whether it stands elsewhere than at home."""
        return self.standing is not self.model

    def answers(self) -> Answers:
        """All but those over the workspace."""
        asked: tuple[tuple[str, Callable[[], Answers]], ...] = (
            ("home", self._stiffness),
            ("mass", self._mass),
            ("mobility", self._mobility),
            ("forces", self._forces),
            ("counts", self._counts),
        )
        found: Answers = {}
        for question, ask in asked:
            found |= asked_of(question, ask)
        return found

    def vibration(self, band: tuple[float, float] | None) -> Answers:
        """Frequencies, and the least dynamic stiffness in a band.

        Parameters
        ----------
        band : (float, float) or None
            Hz; None where there is none.
        """
        found = asked_of("vibration", self._frequencies)
        for axis in AXES:
            found |= _or_why((f"least_dynamic_stiffness_{axis}",), partial(self._least, axis, band))
        return found

    @cached_property
    def check(self) -> ModelCheck:
        """Mobility, redundancy, mass."""
        return check_model(self.standing)

    @cached_property
    def target(self) -> Target:
        """As it vibrates.

        Raises
        ------
        StrutworkError
            It has no mass, or its preload cannot be solved.
        """
        if is_machine(self.name):
            require_mass(named_machine(self.name))
        if not has_mass(self.model):
            raise ModelError("mass", "is missing.", "Give densities or masses.")
        return model_target(self.standing, "compared", self.damping)

    def band(self) -> tuple[float, float] | None:
        """The frequencies that explain the compliance of its tool, Hz; None where it has none."""
        try:
            self.target.require_damping()
            self.standing.require_tool()
            ports = tool_ports(self.standing.structure.linkage)
            return covering_band(self.target.placed, ports)[0]
        except StrutworkError:
            return None

    def _stiffness(self) -> Answers:
        self.standing.require_tool()
        compliance = np.asarray(tool_compliance(self.standing.placed))
        free, blocked = axis_stiffness_free(compliance), axis_stiffness_blocked(compliance)
        return {
            f"home_stiffness_{meaning}_{d}": Value(float(values[i]))
            for meaning, values in (("free", free), ("blocked", blocked))
            for i, d in enumerate(DIRECTIONS)
        }

    def _frequencies(self) -> Answers:
        found = target_modes(self.target, LISTED).elastic.modes.frequencies
        none = Value(why=f"it has only {len(found)} elastic modes")
        return {
            f"frequency_{k + 1}": Value(float(found[k])) if k < len(found) else none
            for k in range(LISTED)
        }

    def _least(self, axis: str, band: tuple[float, float] | None) -> Answers:
        key = f"least_dynamic_stiffness_{axis}"
        damping = self.target.require_damping()
        port = tool_port(self.standing.structure.linkage, axis)
        if band is None:
            return {key: Value(why="no mode moves its tool, so there is no frequency band")}
        least = least_dynamic_stiffness(self.target.placed, port, port, damping, band)
        if least.uncoupled:
            return {key: Value(float("inf"))}
        return {key: Value(float(least.value), f"at {significant(least.frequency)} Hz")}

    def _mass(self) -> Answers:
        if is_machine(self.name):
            require_mass(named_machine(self.name))
        if self.check.mass is None:
            return {"mass": Value(why="a material has no density")}
        if not self.check.mass.total:
            return {"mass": Value(why="no part has a mass: give densities or masses")}
        return {"mass": Value(self.check.mass.total)}

    def _mobility(self) -> Answers:
        found = self.check.mobility
        return {
            "mobility": Value(float(found.mobility)),
            "tool_freedoms": self._tool_freedoms(),
            "mobility_locked": Value(float(found.mobility_locked)),
            "drives": Value(float(self.check.drives)),
            "surplus_drives": Value(float(self.check.surplus_drives)),
            "redundant_constraints": Value(float(found.redundant)),
        }

    def _tool_freedoms(self) -> Value:
        model = self.standing
        if model.tool is None:
            return Value(why="it has no tool: add [tool] with tcp")
        node = model.structure.linkage.node_index[model.tool]
        twists = np.array([m.nodes[node] for m in self.check.mobility.driven_motions])
        names = tool_freedoms(twists, model_size(model)) if len(twists) else []
        return Value(words=listed(names) or "none")

    def _forces(self) -> Answers:
        study = self._tolerances
        found: Answers = {}
        for key, unit in (("locked_force", "N"), ("locked_moment", "N*m")):
            of_unit = [
                (float(v), q.name)
                for v, q in zip(study.largest, study.quantities, strict=True)
                if q.joint is not None and q.unit == unit
            ]
            none = Value(why="no joint carries one")
            found[key] = Value(*max(of_unit)) if of_unit else none
        used = study.utilisation
        most = int(np.argmax(used)) if study.limits else 0
        found["limit_used"] = (
            Value(100.0 * float(used[most]), study.quantities[most].name)
            if study.limits
            else Value(why="it states no limits: add [[force_limits]]")
        )
        found["tool_deviation"] = (
            Value(why="it has no tool: add [tool] with tcp")
            if study.deviation is None
            else Value(float(study.deviation.largest.max()))
        )
        return found

    @cached_property
    def _tolerances(self) -> ToleranceStudy:
        """Worst case where it stands."""
        options = StudyOptions(samples=0)
        model = self.standing
        if model.tolerances or not is_machine(self.name):
            return tolerance_study(model.placed, model.tolerances, model.force_limits, options)
        known = toleranced_machine(named_machine(self.name).entry.name)
        if self.moved:
            raise ModelError(
                "tolerances",
                "of a machine from the literature are known at home only.",
                "Leave the pose out, or write a model file.",
            )
        return tolerance_study(
            known.placed[:1], known.tolerances, known.limits, options, quantities=known.quantities
        )

    @property
    def _tolerance_count(self) -> int:
        """Those of its document among them."""
        try:
            return len(self._tolerances.tolerances)
        except StrutworkError:
            return len(self.standing.tolerances)

    def _counts(self) -> Answers:
        model = self.standing
        structure, linkage = model.structure, model.structure.linkage
        numbers: Mapping[str, int] = {
            "bodies": len(linkage.bodies),
            "joints": len(model.joints),
            "nodes": len(model.nodes),
            "beams": len(structure.beams),
            "springs": len(structure.springs),
            "solids": len(model.solids),
            "tolerances": self._tolerance_count,
            "degrees_of_freedom": self.check.degrees_of_freedom,
        }
        return {key: Value(float(n)) for key, n in numbers.items()}


def asked_of(question: str, ask: Callable[[], Answers]) -> Answers:
    """The answers to a question; where it has none, why, for each of its quantities.

    Parameters
    ----------
    question : str
    ask : callable
        Raises a `StrutworkError` where there is no answer.
    """
    return _or_why(tuple(q.key for q in of_question(question)), ask)


def _or_why(keys: tuple[str, ...], ask: Callable[[], Answers]) -> Answers:
    try:
        found = ask()
    except StrutworkError as error:
        why = visible(" ".join(str(error).split()))
        return dict.fromkeys(keys, Value(why=why))
    return {key: _sound(value) for key, value in found.items()}


def _sound(value: Value) -> Value:
    """A value that is missing (NaN) has a reason."""
    if value.number is not None and np.isnan(value.number):
        return replace(value, number=None, why="it could not be determined")
    return value
