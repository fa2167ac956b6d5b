"""What a machine gives to other programs: functions, gradients, state spaces, closed loops."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    import xarray as xr
    from numpy.typing import ArrayLike

    from strutwork.fea.port_states import PortStates
    from strutwork.machines.servos import Servo
    from strutwork.servo import ClosedLoop
    from strutwork.studies.function import MachineFunction
    from strutwork.studies.parameter import Parameter

#: Names of the methods.
OUTWARD = ("closed_loop", "function", "gradient", "state_space")


class Outward:
    """Methods of `strutwork.front.Machine` for other programs."""

    def closed_loop(self, servos: Sequence[Servo] = (), **options: Any) -> ClosedLoop:
        """The drives' controllers around the machine where it stands.

        Parameters
        ----------
        servos : sequence of Servo
            The model's own where there is none.
        **options
            Of `strutwork.studies.servo_loop.loop_question`: ports, damping, band, modes.

        Raises
        ------
        StrutworkError
            No controllers, no damping; else as `strutwork.servo.closed_loop.closed_loop`.
        """
        from strutwork.studies.servo_loop import machine_loop

        return machine_loop(self, servos, **options)  # type: ignore[arg-type]

    def function(
        self,
        parameters: Mapping[str, Any] | Iterable[str | Parameter],
        answers: Sequence[str],
        **options: Any,
    ) -> MachineFunction:
        """A function of numbers of the machine, with gradients, for optimisers.

        Parameters
        ----------
        parameters : sequence of str or Parameter, or mapping of path to (low, high)
        answers : sequence of str
        **options
            All as `strutwork.studies.function.MachineFunction.of`: poses, reduction, band.

        Raises
        ------
        StrutworkError
            As `strutwork.studies.function.MachineFunction.of`.
        """
        from strutwork.studies.function import MachineFunction

        return MachineFunction.of(self, parameters, answers, **options)

    def gradient(
        self,
        *quantities: str,
        by: Sequence[str] = (),
        task: Mapping[str, ArrayLike] | None = None,
        band: tuple[float, float] = (1.0, 1000.0),
    ) -> xr.Dataset:
        """Gradients of quantities with respect to numbers of the machine.

        Parameters
        ----------
        *quantities : str
            As `strutwork.studies.gradient_quantities.FORMS`; the stiffnesses of the tool along
            x, y and z where there is none.
        by : sequence of str
            Paths; all sizes, materials, stiffnesses and masses where there is none.
        task : mapping of direction to (p,), optional
            Poses of the tool, m and rad; the machine as it is described without one.
        band : (float, float)
            Of a least dynamic stiffness, Hz.

        Returns
        -------
        xarray.Dataset
            As `strutwork.studies.gradient.gradient`.

        Raises
        ------
        StrutworkError
            The machine was changed or moved since it was loaded; else as
            `strutwork.studies.gradient.gradient`.
        """
        from strutwork.studies.gradient import machine_gradient

        return machine_gradient(self, quantities, by, task, band)

    def state_space(
        self, inputs: Sequence[Any], outputs: Sequence[Any], **options: Any
    ) -> PortStates:
        """State space between ports, where the machine stands; `to_control()` for python-control.

        Parameters
        ----------
        inputs : sequence of str, Port or Motor
            "NODE:x" for a force at a node, "motor JOINT:z" for that of a drive.
        outputs : sequence of str, Port, Motor, or pairs of one with a quantity
            Displacements, or "velocity" or "acceleration" of a pair.
        **options
            Of `strutwork.studies.servo_loop.machine_state_space`: damping, modes.

        Raises
        ------
        StrutworkError
            As `strutwork.studies.servo_loop.machine_state_space`.
        """
        from strutwork.studies.servo_loop import machine_state_space

        return machine_state_space(self, inputs, outputs, **options)  # type: ignore[arg-type]
