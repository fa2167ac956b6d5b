"""What varies the numbers of a machine: studies, designs, calibrations."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    import xarray as xr

    from strutwork.studies.calibration_result import MachineCalibration
    from strutwork.studies.design_terms import Objective
    from strutwork.studies.parameter import Parameter

#: Names of the methods.
VARYING = ("calibrate", "design", "study")


class Varying:
    """Methods of `strutwork.front.Machine` that vary its numbers."""

    def calibrate(
        self, parameters: Mapping[str, Any] | Sequence[str], **measured: Any
    ) -> MachineCalibration:
        """The numbers of the machine that meet its measurements best.

        Parameters
        ----------
        parameters : mapping of path to (low, high), or sequence of str
        **measured
            Both as in `strutwork.studies.calibration.calibrate_machine`, whose errors it raises.
        """
        from strutwork.studies.calibration import calibrate_machine

        return calibrate_machine(self, parameters, **measured)

    def design(
        self,
        parameters: Mapping[str, Any] | Sequence[Parameter],
        *objectives: str | Objective,
        **options: Any,
    ) -> xr.Dataset:
        """Search the numbers that are best in several objectives: the Pareto front.

        Parameters
        ----------
        parameters : mapping of path to values
            Beside a path of `strutwork.studies.Parametric.paths` a list of values, or a pair for a
            range; SI, or texts with units.
        *objectives : str or Objective
            Names of `strutwork.studies.design_quantities.QUANTITIES`, as "stiffness_z", or of a
            joint, as "travel:JOINT:z".
        **options
            Of `strutwork.studies.machine_design.design_machine`: at_least, at_most, constraints,
            workspace, cost, band, out, resume, workers, progress, and of the search method,
            population, generations, starts and seed.

        Returns
        -------
        xarray.Dataset
            As `strutwork.studies.design_store.run_design`; `front` are the numbers of the machines
            that no other one beats.

        Raises
        ------
        StrutworkError
            The machine was changed or moved since it was loaded; else as
            `strutwork.studies.machine_design.design_machine`.
        """
        from strutwork.studies.machine_design import design_machine

        return design_machine(self, parameters, *objectives, **options)

    def study(
        self, parameters: Mapping[str, Any] | Sequence[Parameter], *answers: Any, **options: Any
    ) -> xr.Dataset:
        """Vary numbers of the machine and ask each machine that comes of it.

        Parameters
        ----------
        parameters : mapping of path to values
            Beside a path of `strutwork.studies.Parametric.paths` a list of values, or a pair for a
            range; SI, or texts with units.
        *answers : str or Answer
            "stiffness" where there is none; "vibration", "assembly", "accuracy", "stability",
            "transmission", "amplification", "mass", "frequency", "travel" or "travel:JOINT:z", or
            those of a survey.
        **options
            Of `strutwork.studies.study.Study.of` (sample, count, seed, workspace, reductions) and
            of `strutwork.studies.study.Study.run` (workers, progress, folder, executor); `out` and
            `resume` as `strutwork.studies.study_store.run_to_file`.

        Returns
        -------
        xarray.Dataset

        Raises
        ------
        StrutworkError
            The machine was changed or moved since it was loaded; else as `Study`.
        """
        from strutwork.studies.finished_parts import require_file
        from strutwork.studies.study import Study
        from strutwork.studies.study_store import run_to_file

        running = ("workers", "progress", "folder", "executor")
        how = {k: options.pop(k) for k in running if k in options}
        out, resume = options.pop("out", None), options.pop("resume", False)
        require_file(out, resume=resume)
        study = Study.of(self, parameters, *answers, **options)
        return study.run(**how) if out is None else run_to_file(study, out, resume=resume, **how)
