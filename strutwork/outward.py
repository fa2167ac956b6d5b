"""What a machine gives to other programs: a function of its numbers, and gradients."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    import xarray as xr
    from numpy.typing import ArrayLike

    from strutwork.studies.function import MachineFunction
    from strutwork.studies.parameter import Parameter


class Outward:
    """Methods of `strutwork.front.Machine` for other programs."""

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
