"""Studies: stiffness, vibration and assembly forces over poses, parameters and sizes."""

from strutwork.studies.budget_map import budget_map
from strutwork.studies.check_points import CheckPoints, area_weights, hemisphere
from strutwork.studies.dataset_files import (
    read_netcdf,
    to_json,
    write_csv,
    write_json,
    write_long_csv,
    write_netcdf,
)
from strutwork.studies.design import Design
from strutwork.studies.design_file import read_design
from strutwork.studies.design_pick import changes_of, write_machine
from strutwork.studies.design_store import read_design_result, run_design
from strutwork.studies.design_terms import Constraint, Cost, CostOf, Objective
from strutwork.studies.dynamic import dynamic_stiffness, frequency_responses
from strutwork.studies.dynamic_map import Vibration, dynamic_map
from strutwork.studies.executor import Executor, Threads, default_executor
from strutwork.studies.filters import Filters, PoseStatus
from strutwork.studies.function import MachineFunction
from strutwork.studies.parameter import Parameter
from strutwork.studies.parametric import Parametric
from strutwork.studies.plane_map import Fall, on_plane, plane_map, stiffness_falls
from strutwork.studies.progress import Lines, Progress
from strutwork.studies.removal_rate import RemovalExponents, removal_exponents
from strutwork.studies.scale import PowerLaw, ScaleStudy, power_law, scale_study
from strutwork.studies.similarity import ROLLERS, SIMILAR, UNSCALED, JointScaling, scaled
from strutwork.studies.statistics import (
    QUANTILES,
    AxisSummary,
    PoseValue,
    Statistics,
    Summary,
    statistics,
    summary,
)
from strutwork.studies.stiffness_map import stiffness_map
from strutwork.studies.study import Study
from strutwork.studies.study_file import read_study
from strutwork.studies.study_store import read_result, run_to_file
from strutwork.studies.sweep import sweep
from strutwork.studies.tolerance_result import ToleranceStudy
from strutwork.studies.tolerance_study import StudyOptions, tolerance_study
from strutwork.studies.toleranced_machine import TolerancedMachine, toleranced_machine

__all__ = [
    "QUANTILES",
    "ROLLERS",
    "SIMILAR",
    "UNSCALED",
    "AxisSummary",
    "CheckPoints",
    "Constraint",
    "Cost",
    "CostOf",
    "Design",
    "Executor",
    "Fall",
    "Filters",
    "JointScaling",
    "Lines",
    "MachineFunction",
    "Objective",
    "Parameter",
    "Parametric",
    "PoseStatus",
    "PoseValue",
    "PowerLaw",
    "Progress",
    "RemovalExponents",
    "ScaleStudy",
    "Statistics",
    "Study",
    "StudyOptions",
    "Summary",
    "Threads",
    "ToleranceStudy",
    "TolerancedMachine",
    "Vibration",
    "area_weights",
    "budget_map",
    "changes_of",
    "default_executor",
    "dynamic_map",
    "dynamic_stiffness",
    "frequency_responses",
    "hemisphere",
    "on_plane",
    "plane_map",
    "power_law",
    "read_design",
    "read_design_result",
    "read_netcdf",
    "read_result",
    "read_study",
    "removal_exponents",
    "run_design",
    "run_to_file",
    "scale_study",
    "scaled",
    "statistics",
    "stiffness_falls",
    "stiffness_map",
    "summary",
    "sweep",
    "to_json",
    "tolerance_study",
    "toleranced_machine",
    "write_csv",
    "write_json",
    "write_long_csv",
    "write_machine",
    "write_netcdf",
]
