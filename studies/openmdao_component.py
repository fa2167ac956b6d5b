"""A machine as a component of OpenMDAO, which needs the extra `openmdao`."""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

from strutwork.errors import ModelError, StrutworkError
from strutwork.names import visible
from strutwork.studies.function import MachineFunction

try:
    import openmdao.api as om
except ImportError as missing:
    raise ModelError(
        "component", "needs OpenMDAO, which is not installed.", 'pip install "strutwork[openmdao]"'
    ) from missing

#: What stands in an OpenMDAO name for what may not stand there.
INSTEAD = {".": ":", "[": ":", "]": "", "*": "all", "+": ":and:", "?": "_", "!": "_"}


def openmdao_name(name: str) -> str:
    """The name of a parameter or answer in OpenMDAO, which allows no dots, stars and brackets.

    Parameters
    ----------
    name : str

    Examples
    --------
    >>> openmdao_name("sections.ram.diameter"), openmdao_name("joints.ball*.stiffness.z")
    ('sections:ram:diameter', 'joints:ballall:stiffness:z')
    >>> openmdao_name("masses[0].mass")
    'masses:0:mass'
    """
    found = re.sub(r"\s+", "_", name.strip())
    return "".join(INSTEAD.get(letter, letter) for letter in found).strip(":")


def openmdao_unit(unit: str) -> str | None:
    """A unit as OpenMDAO writes it; None for a pure number.

    Parameters
    ----------
    unit : str
        SI.

    Examples
    --------
    >>> openmdao_unit("N m/rad"), openmdao_unit("kg/m^3"), openmdao_unit("1")
    ('N*m/rad', 'kg/m**3', None)
    """
    return None if unit in ("", "1") else unit.replace("^", "**").replace(" ", "*")


class MachineComponent(om.ExplicitComponent):  # type: ignore[misc] # OpenMDAO ships no types
    """Answers of a machine with their exact partial derivatives.

    Its options are `function`, a `strutwork.studies.function.MachineFunction`, and `names`, a
    mapping of parameters and answers to names of one's own. Others are named by `openmdao_name`.
    Inputs and outputs are in the units of the function. Where the machine cannot be built or take
    a pose, `AnalysisError` lets a driver try another point.
    """

    def initialize(self) -> None:
        """Declare the options, as OpenMDAO asks for."""
        self.options.declare("function", types=MachineFunction, desc="the machine and its answers")
        self.options.declare("names", types=dict, default={}, desc="names in place of paths")

    def setup(self) -> None:
        """Declare inputs, outputs and partial derivatives, as OpenMDAO asks for.

        Raises
        ------
        ModelError
            Two parameters or answers of one name, or names of what the function does not have.
        """
        function: MachineFunction = self.options["function"]
        self._named = _names(function, self.options["names"])
        units, start = function.units, function.start
        for name, value in zip(function.parameters, start, strict=True):
            self.add_input(self._named[name], val=value, units=openmdao_unit(units[name]))
        for name, value in function().items():
            self.add_output(
                self._named[name],
                val=value,
                units=openmdao_unit(units[name]),
                shape=np.shape(value),
            )
        self.declare_partials(
            [self._named[n] for n in function.answers],
            [self._named[n] for n in function.parameters],
        )

    def compute(self, inputs: Any, outputs: Any) -> None:
        """Answers, as OpenMDAO asks for.

        Parameters
        ----------
        inputs, outputs : OpenMDAO vectors
            By name.

        Raises
        ------
        AnalysisError
            The machine cannot be built, or take a pose.
        """
        function: MachineFunction = self.options["function"]
        try:
            found = function(self._point(inputs))
        except StrutworkError as error:
            raise om.AnalysisError(str(error)) from error
        for name, value in found.items():
            outputs[self._named[name]] = value

    def compute_partials(self, inputs: Any, partials: Any) -> None:
        """Partial derivatives, as OpenMDAO asks for.

        Parameters
        ----------
        inputs, partials : OpenMDAO vectors
            By name, and by pairs of names.

        Raises
        ------
        AnalysisError
            The machine cannot be built or take a pose, or has no derivative there.
        """
        function: MachineFunction = self.options["function"]
        try:
            found = function.jacobian(self._point(inputs))
        except StrutworkError as error:
            raise om.AnalysisError(str(error)) from error
        for name, rates in found.items():
            for i, parameter in enumerate(function.parameters):
                partials[self._named[name], self._named[parameter]] = rates[..., i]

    def _point(self, inputs: Any) -> list[float]:
        function: MachineFunction = self.options["function"]
        return [float(np.ravel(inputs[self._named[name]])[0]) for name in function.parameters]


def _names(function: MachineFunction, given: Mapping[str, str]) -> dict[str, str]:
    known: Sequence[str] = (*function.parameters, *function.answers)
    for name in given:
        if name not in known:
            raise ModelError(
                "names",
                f"name {visible(name)}, which is neither a parameter nor an answer.",
                f"There are {', '.join(map(visible, known))}.",
            )
    found: dict[str, str] = {}
    for name in known:
        made = given.get(name) or openmdao_name(name)
        for other, taken in found.items():
            if taken == made:
                raise ModelError(
                    "names",
                    f"call both {visible(other)} and {visible(name)} {visible(made)}.",
                    "Give one of them a name of its own by the option names.",
                )
        found[name] = made
    return found
